//! Project tasks: `cargo xtask ci` runs every check that must never be red.
use std::process::{Command, exit};

fn main() {
    let steps: [&[&str]; 5] = [
        &["fmt", "--all", "--", "--check"],
        &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"],
        &["test", "--workspace", "--locked"],
        &["test", "--workspace", "--locked", "--doc"],
        &["doc", "--workspace", "--no-deps", "--locked"],
    ];
    for step in steps {
        eprintln!("xtask ci: cargo {}", step.join(" "));
        let status = Command::new("cargo").args(step).status().expect("cargo starts");
        if !status.success() {
            exit(status.code().unwrap_or(1));
        }
    }
}
