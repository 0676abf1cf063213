//! Project tasks: `cargo xtask ci` runs every check that must never be red; `cargo xtask bench` and
//! `cargo xtask report` print every figure that the documentation states.
mod ci;
mod random;
mod tidy;
mod trials;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// What a task answers: an error is printed and becomes exit code 1.
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
    /// Fails when the map in ARCHITECTURE.md, the folders and the order of the crates disagree.
    Tidy,
    /// Writes a file of random trials, 256 by default, by the law of the bench.
    Trials(trials::Options),
}

fn main() -> ExitCode {
    let result = match Arguments::parse().task {
        Task::Ci(options) => ci::run(&options),
        Task::Tidy => tidy::run(),
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

/// The root of the workspace.
fn workspace_root() -> std::path::PathBuf {
    let manifest =
        std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_else(|| env!("CARGO_MANIFEST_DIR").into());
    std::path::Path::new(&manifest).parent().expect("xtask lies in the workspace").to_path_buf()
}
