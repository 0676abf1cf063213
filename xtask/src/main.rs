//! Project tasks: `cargo xtask ci` runs every check that must never be red; `cargo xtask bench` and
//! `cargo xtask report` print every figure that the documentation states.
//!
//! Only the checks are compiled here, which takes seconds. The tasks of the evaluation are those of `d2m-evaluation`.
#![forbid(unsafe_code)]
mod ci;
mod comparison;
mod doc;
mod forwarded;
mod lines;
mod mutants;
mod packages;
mod tidy;

use clap::{Parser, Subcommand};
use forwarded::Forwarded;
use std::process::ExitCode;

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
    /// The reference in target/doc; fails on warnings and on front pages whose links lead away from it.
    Doc,
    /// The table of docs/guide/migrating.md that sets this library beside others, from its facts and docs/results.
    Comparison,
    /// Lines of product code of each crate, without tests, comments and blank lines.
    Lines(lines::Options),
    /// The packages that would be published, made without a network; with --test built and tested without this repository.
    Packages(packages::Options),
    /// Deliberate faults in a copy of the sources, each of which a named test must notice; fails if one survives.
    Mutants(mutants::Options),
    /// Random families against slow oracles; fails on any contact missed or late.
    #[command(disable_help_flag = true)]
    Accuracy(Forwarded),
    /// Time and accuracy of every method on ten pairs of shapes; each answer is judged before its time counts.
    #[command(disable_help_flag = true)]
    Bench(Forwarded),
    /// Tables and figures in docs/results, from the newest results of the bench.
    #[command(disable_help_flag = true)]
    Report(Forwarded),
    /// Writes a file of random trials, 256 by default, by the law of the bench.
    #[command(disable_help_flag = true)]
    Trials(Forwarded),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().task {
        Task::Ci(options) => ci::run(&options),
        Task::Tidy => tidy::run(),
        Task::Doc => doc::run(),
        Task::Comparison => comparison::run(),
        Task::Packages(options) => packages::run(&options),
        Task::Lines(options) => lines::run(&options),
        Task::Mutants(options) => mutants::run(&options),
        Task::Accuracy(_) | Task::Bench(_) | Task::Report(_) | Task::Trials(_) => return forwarded::run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The root of the workspace.
fn workspace_root() -> std::path::PathBuf {
    let manifest =
        std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    std::path::Path::new(&manifest).parent().expect("xtask lies in the workspace").to_path_buf()
}

#[cfg(test)]
mod tests {
    use super::{Arguments, Task, ci};
    use clap::Parser;

    /// A gate that is asked for nothing must not pass.
    #[test]
    fn nothing_to_do_is_no_success() {
        let Ok(Arguments { task: Task::Ci(options) }) =
            Arguments::try_parse_from(["xtask", "ci", "--only", "nosuch"])
        else {
            panic!("the name is judged later")
        };
        assert!(ci::run(&options).unwrap_err().to_string().contains("doctests"));
    }

    #[test]
    fn arguments_are_consistent() {
        <Arguments as clap::CommandFactory>::command().debug_assert();
    }
}
