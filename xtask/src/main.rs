//! Project tasks: `cargo xtask ci` runs every check that must never be red; `cargo xtask bench` and
//! `cargo xtask report` print every figure that the documentation states.
//!
//! Without the feature `full` only the checks are compiled, which takes seconds. A task of the evaluation starts this
//! program again, with the feature and optimised.
#![forbid(unsafe_code)]
#[cfg(feature = "full")]
mod accuracy;
#[cfg(feature = "full")]
mod bench;
mod ci;
#[cfg(feature = "full")]
mod figure;
#[cfg(feature = "full")]
mod judge;
mod lines;
#[cfg(feature = "full")]
mod machine;
#[cfg(feature = "full")]
mod memory;
mod mutants;
#[cfg(feature = "full")]
mod report;
#[cfg(feature = "full")]
mod statistics;
mod tidy;
#[cfg(feature = "full")]
mod trials;

#[cfg(not(feature = "full"))]
mod forwarded;

use clap::{Parser, Subcommand};
#[cfg(not(feature = "full"))]
use forwarded::Forwarded;
use std::process::ExitCode;
#[cfg(not(feature = "full"))]
use {
    Forwarded as Accuracy, Forwarded as Bench, Forwarded as Counted, Forwarded as Report,
    Forwarded as Stopped, Forwarded as Trials,
};
#[cfg(feature = "full")]
use {
    accuracy::Options as Accuracy,
    bench::{CountedOptions as Counted, Options as Bench, StoppedOptions as Stopped},
    report::Options as Report,
    trials::Options as Trials,
};

/// The result of a task: an error is printed and becomes exit code 1.
type TaskResult = Result<(), Box<dyn std::error::Error>>;

#[derive(Parser)]
#[command(name = "cargo xtask", version, about = "Project tasks: the gates and the figures")]
struct Arguments {
    #[command(subcommand)]
    task: Task,
}

#[derive(Subcommand)]
enum Task {
    /// Every check that must never be red: format, lints, tests, documentation, structure.
    Ci(ci::Options),
    /// Fails when documents and sources disagree (the map, the guarantees, the table of mutants) or a file breaks a rule.
    Tidy,
    /// Lines of product code of each crate, without tests, comments and blank lines.
    Lines(lines::Options),
    /// Deliberate faults in a copy of the sources, each of which a named test must notice; fails if one survives.
    Mutants(mutants::Options),
    /// Random families against slow oracles; fails on any contact missed or late.
    #[command(disable_help_flag = !cfg!(feature = "full"))]
    Accuracy(Accuracy),
    /// Time and accuracy of every method on ten pairs of shapes; each answer is judged before its time counts.
    #[command(disable_help_flag = !cfg!(feature = "full"))]
    Bench(Bench),
    /// Tables and figures in docs/results, from the newest results of the bench.
    #[command(disable_help_flag = !cfg!(feature = "full"))]
    Report(Report),
    /// The process in which a peer's query runs, so that it can be ended.
    #[command(hide = true)]
    ParryCast(Stopped),
    /// The program in which callgrind counts.
    #[command(hide = true)]
    Counted(Counted),
    /// Writes a file of random trials, 256 by default, by the law of the bench.
    #[command(disable_help_flag = !cfg!(feature = "full"))]
    Trials(Trials),
}

fn main() -> ExitCode {
    #[cfg(not(feature = "full"))]
    let result = match Arguments::parse().task {
        Task::Ci(options) => ci::run(&options),
        Task::Tidy => tidy::run(),
        Task::Lines(options) => lines::run(&options),
        Task::Mutants(options) => mutants::run(&options),
        Task::Accuracy(_)
        | Task::Bench(_)
        | Task::Report(_)
        | Task::Counted(_)
        | Task::ParryCast(_)
        | Task::Trials(_) => return forwarded::run(),
    };
    #[cfg(feature = "full")]
    let result = match Arguments::parse().task {
        Task::Ci(options) => ci::run(&options),
        Task::Tidy => tidy::run(),
        Task::Lines(options) => lines::run(&options),
        Task::Mutants(options) => mutants::run(&options),
        Task::Accuracy(options) => accuracy::run(&options),
        Task::Bench(options) => bench::run(&options),
        Task::Report(options) => report::run(&options),
        Task::Counted(options) => bench::run_counted(&options),
        Task::ParryCast(options) => bench::run_stopped(&options),
        Task::Trials(options) => trials::run(&options),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Reads an option that must be a positive finite number.
#[cfg(feature = "full")]
fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if number > 0.0 && number.is_finite() { Ok(number) } else { Err("not positive and finite".to_owned()) }
}

/// Reads a count that must not be 0: a run over nothing would pass.
#[cfg(feature = "full")]
fn at_least_one(text: &str) -> Result<usize, String> {
    let count: usize = text.parse().map_err(|_| "not a whole number".to_owned())?;
    if count > 0 { Ok(count) } else { Err("nothing would be done".to_owned()) }
}

/// The root of the workspace.
fn workspace_root() -> std::path::PathBuf {
    let manifest =
        std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    std::path::Path::new(&manifest).parent().expect("xtask lies in the workspace").to_path_buf()
}

#[cfg(all(test, feature = "full"))]
mod tests {
    use super::{Arguments, Task, accuracy, ci};
    use clap::Parser;

    /// A gate that is asked for nothing must not pass, and no number makes it panic.
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
        let Ok(Arguments { task: Task::Ci(options) }) = parse("xtask ci --only nosuch") else {
            panic!("the name is judged later")
        };
        assert!(ci::run(&options).unwrap_err().to_string().contains("doctests"));
    }

    #[test]
    fn arguments_are_consistent() {
        <super::Arguments as clap::CommandFactory>::command().debug_assert();
    }
}
