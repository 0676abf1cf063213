//! Tasks of the evaluation, which need what takes minutes to compile: this program once more, with everything in it.
use std::ffi::OsString;
use std::process::{Command, ExitCode};

/// Whatever follows the name of the task.
#[derive(clap::Args)]
pub(crate) struct Forwarded {
    /// Options of the task, read by the full program.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _rest: Vec<OsString>,
}

/// The same call, built with the feature `full` and optimised.
pub(crate) fn run() -> ExitCode {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(cargo)
        .args(["run", "--release", "--quiet", "--package", "xtask", "--features", "full", "--"])
        .args(std::env::args_os().skip(1))
        .status();
    match status {
        Ok(status) => status.code().map_or(ExitCode::FAILURE, |code| ExitCode::from(code as u8)),
        Err(error) => {
            eprintln!("xtask: cargo does not start: {error}");
            ExitCode::FAILURE
        }
    }
}
