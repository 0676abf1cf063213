//! The d2m command: certified time of contact of two meshes from the command line.
//!
//! Exit codes: 0 answered, 2 bad usage, 3 bad input (with file, line, index and value on stderr).

mod arguments;
mod commands;
mod engine;
mod failure;
mod load;
mod motion;
mod output;
mod report;
mod trials;

use arguments::{Arguments, Command};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match &arguments.command {
        Command::Toc(arguments) => commands::toc::run(arguments),
        Command::Batch(arguments) => commands::batch::run(arguments),
        Command::Features(arguments) => commands::features::run(arguments),
        Command::Info(arguments) => commands::info::run(arguments),
        Command::Demo => commands::demo::run(),
    };
    match outcome {
        // A reader that closed the pipe has what it wanted.
        Ok(()) | Err(Failure::ClosedPipe) => ExitCode::SUCCESS,
        Err(failure) => {
            output::note(&format!("d2m: {failure}"));
            ExitCode::from(3)
        }
    }
}
