//! The evaluation: what the documentation states of accuracy and speed, measured. `cargo xtask bench` and its sisters
//! start this program, optimised.
#![forbid(unsafe_code)]
mod accuracy;
mod bench;
mod figure;
mod judge;
mod machine;
mod memory;
mod report;
mod statistics;
mod trials;
mod written_trials;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// The result of a task: an error is printed and becomes exit code 1.
type TaskResult = Result<(), Box<dyn std::error::Error>>;

#[derive(Parser)]
#[command(
    name = "cargo xtask",
    version,
    about = "The evaluation: every figure that the documentation states"
)]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Random families against slow oracles; fails on any contact missed or late.
    Accuracy(accuracy::Options),
    /// Time and accuracy of every method on ten pairs of shapes; each answer is judged before its time counts.
    Bench(bench::Options),
    /// Tables and figures in docs/results, from the newest results of the bench.
    Report(report::Options),
    /// The process in which a peer's query runs, so that it can be ended.
    #[command(hide = true)]
    ParryCast(bench::StoppedOptions),
    /// The program in which callgrind counts.
    #[command(hide = true)]
    Counted(bench::CountedOptions),
    /// Writes a file of random trials, 256 by default, by the law of the bench.
    Trials(written_trials::Options),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().task {
        Task::Accuracy(options) => accuracy::run(&options),
        Task::Bench(options) => bench::run(&options),
        Task::Report(options) => report::run(&options),
        Task::Counted(options) => bench::run_counted(&options),
        Task::ParryCast(options) => bench::run_stopped(&options),
        Task::Trials(options) => written_trials::run(&options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("d2m-evaluation: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Reads an option that must be a positive finite number.
fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err("not positive and finite".to_owned()) }
}

/// Reads a count that must not be 0: a run over nothing would pass.
fn at_least_one(text: &str) -> Result<usize, String> {
    let count: usize = text.parse().map_err(|_| "not a whole number".to_owned())?;
    if count > 0 { Ok(count) } else { Err("nothing would be done".to_owned()) }
}

/// The root of the workspace.
fn workspace_root() -> std::path::PathBuf {
    let manifest =
        std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    let folders = std::path::Path::new(&manifest).ancestors();
    folders.into_iter().nth(2).expect("crates/d2m-evaluation lies in the workspace").to_path_buf()
}

#[cfg(test)]
mod tests {
    use super::{Arguments, Task, accuracy};
    use clap::Parser;

    /// A gate without a query must not pass, and no number makes it panic.
    #[test]
    fn nothing_to_do_is_no_success() {
        let parse = |line: &str| Arguments::try_parse_from(line.split(' '));
        for line in [
            "xtask accuracy --count 0",
            "xtask accuracy --minutes nan",
            "xtask accuracy --minutes=-1",
            "xtask bench --count 0",
            "xtask bench --rounds 0",
            "xtask bench --tolerance 0",
            "xtask bench --cap inf",
            "xtask bench --minutes nan",
            "xtask trials --out x --count 0",
            "xtask trials --out x --speed nan",
        ] {
            assert!(parse(line).is_err(), "{line}");
        }
        let Ok(Arguments { task: Task::Accuracy(options) }) = parse("xtask accuracy --only nosuch") else {
            panic!("the name is judged later")
        };
        assert!(accuracy::run(&options).unwrap_err().to_string().contains("mesh: "));
    }

    #[test]
    fn arguments_are_consistent() {
        <super::Arguments as clap::CommandFactory>::command().debug_assert();
    }
}
