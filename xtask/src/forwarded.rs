//! Tasks of the evaluation, which need what takes minutes to compile: the program of `d2m-evaluation`.
use std::ffi::OsString;
use std::process::{Command, ExitCode};

/// Whatever follows the name of the task.
#[derive(clap::Args)]
pub(crate) struct Forwarded {
    /// Options of the task, read by the evaluation.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    _rest: Vec<OsString>,
}

/// The same call, to the evaluation, optimised.
pub(crate) fn run() -> ExitCode {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let call: Vec<OsString> = std::env::args_os().skip(1).collect();
    // An engine that reports what it concludes is another program.
    let audits = call.get(1).is_some_and(|word| word == "audit");
    let features: &[&str] = if audits { &["--features", "audit"] } else { &[] };
    let status = Command::new(cargo)
        .args(["run", "--release", "--quiet", "--package", "d2m-evaluation"])
        .args(features)
        .arg("--")
        .args(call)
        .status();
    match status {
        Ok(status) => status.code().map_or(ExitCode::FAILURE, |code| ExitCode::from(code as u8)),
        Err(error) => {
            eprintln!("xtask: cargo does not start: {error}");
            ExitCode::FAILURE
        }
    }
}
