//! Runs one test of a program, with a fault or without.
use super::Error;
use super::copy::Copy;
use super::switch::VARIABLE;
use super::table::Mutant;
use std::fs::File;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What became of a test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    Passed,
    Failed,
    /// Still running after the limit.
    Hung,
}

/// Runs the test of a mutant; `switch` is the number of the fault that is switched on.
pub(super) fn run_test(
    copy: &Copy,
    program: &Path,
    mutant: &Mutant,
    switch: Option<usize>,
    limit: Duration,
) -> Result<End, Error> {
    let test = mutant.test().name;
    let folder = copy.root.join(mutant.package_folder());
    let path = copy.build.join("output.txt");
    let output = File::create(&path)?;
    let mut command = Command::new(program);
    command.arg(test).current_dir(&folder).env("CARGO_MANIFEST_DIR", &folder).env_remove(VARIABLE);
    if let Some(number) = switch {
        command.env(VARIABLE, number.to_string());
    }
    let mut child = command.stdout(output.try_clone()?).stderr(output).stdin(Stdio::null()).spawn()?;
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if begin.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(End::Hung);
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    if !status.success() {
        // A panic, or an abort (overflow of the stack, a panic while panicking).
        return Ok(End::Failed);
    }
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    // A test that should panic is named so between its name and the result.
    let ended = |line: &str| line.ends_with(" ... ok") && line.contains(&format!("{test} "));
    if text.lines().any(ended) {
        Ok(End::Passed)
    } else {
        Err(format!("{} is not among the tests of its target", mutant.test).into())
    }
}
