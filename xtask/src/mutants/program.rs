//! Runs one test of a program, with a fault or without.
use super::Error;
use super::copy::Copy;
use super::switch::VARIABLE;
use super::table::Mutant;
use std::fs::File;
use std::path::Path;
use std::process::{Child, Command, Stdio};
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
    in_a_group(&mut command);
    let mut child = command.stdout(output.try_clone()?).stderr(output).stdin(Stdio::null()).spawn()?;
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if begin.elapsed() > limit {
            kill_group(&child);
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

/// What a test starts, as a command that hangs, ends with it.
fn in_a_group(command: &mut Command) {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    #[cfg(not(unix))]
    let _ = command;
}

/// Kills what a test has started. Where that cannot be done, only the test is killed.
fn kill_group(child: &Child) {
    if cfg!(unix) {
        let _ = Command::new("kill").args(["-KILL", "--", &format!("-{}", child.id())]).status();
    }
}
