//! `cargo xtask ci`: every check that must never be red, each with its time.
use crate::{TaskResult, doc, packages, tidy, workspace_root};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Go on after a failed step, and fail at the end.
    #[arg(long)]
    keep_going: bool,
    /// Only the steps whose name contains this.
    #[arg(long)]
    only: Option<String>,
}

struct Step {
    name: &'static str,
    arguments: &'static [&'static str],
}

const fn step(name: &'static str, arguments: &'static [&'static str]) -> Step {
    Step { name, arguments }
}

/// In order of cost: what fails fast comes first. `locks` holds the lock of the Python package, which is no member of the workspace, against the
/// manifests of the crates that it is built from. `features` stands for a check of each library. `audit` names the whole workspace, so that
/// what others wrote has the features that it has in `tests`, and is not compiled again; of the workspace only what the test needs is.
const STEPS: &[Step] = &[
    step("format", &["fmt", "--all", "--", "--check"]),
    step("locks", &["fetch", "--locked", "--manifest-path=crates/d2m-py/Cargo.toml"]),
    step("lints", &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"]),
    step("features", &["check", "--locked", "--all-features", "-p=d2m"]),
    step("tests", &["test", "--workspace", "--locked", "--lib", "--bins", "--tests", "--examples"]),
    step("audit", &["test", "--workspace", "--locked", "--features=d2m/audit", "--test=audit"]),
    step("doctests", &["test", "--workspace", "--locked", "--doc"]),
];

/// Libraries that have default features. Without them each must still compile, each in a call of its own: in one call cargo
/// would join the features that any of them needs.
fn libraries_with_defaults(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut names = Vec::new();
    for entry in fs::read_dir(root.join("crates"))? {
        let folder = entry?.path();
        let manifest: toml::Table = fs::read_to_string(folder.join("Cargo.toml"))?.parse()?;
        let has_defaults = manifest.get("features").is_some_and(|all| all.get("default").is_some());
        if has_defaults && folder.join("src/lib.rs").exists() {
            names.push(folder.file_name().unwrap_or_default().to_string_lossy().into_owned());
        }
    }
    names.sort();
    Ok(names)
}

/// Runs the steps; an error names those that failed.
pub(crate) fn run(options: &Options) -> TaskResult {
    let wanted = |name: &str| options.only.as_ref().is_none_or(|only| name.contains(only.as_str()));
    let names = || STEPS.iter().map(|step| step.name).chain(["documentation", "packages", "tidy"]);
    if !names().any(wanted) {
        return Err(format!("no such step: {}", names().collect::<Vec<_>>().join(", ")).into());
    }
    let mut failed = Vec::new();
    let mut times = Vec::new();
    let start = Instant::now();
    let mut note = |name: &'static str, ok: bool, seconds: f64| {
        times.push(format!("  {name:<14} {seconds:>7.1} s  {}", if ok { "ok" } else { "FAILED" }));
        if !ok {
            failed.push(name);
        }
        ok || options.keep_going
    };
    'steps: {
        if wanted("tidy") {
            let begin = Instant::now();
            let ok = tidy::run().map_err(|error| eprintln!("{error}")).is_ok();
            if !note("tidy", ok, begin.elapsed().as_secs_f64()) {
                break 'steps;
            }
        }
        for step in STEPS.iter().filter(|step| wanted(step.name)) {
            let begin = Instant::now();
            let mut ok = true;
            if step.name == "features" {
                for name in libraries_with_defaults(&workspace_root())? {
                    ok &= cargo(&["check", "--locked", "--no-default-features", "-p", &name])?;
                }
            }
            ok &= cargo(step.arguments)?;
            if !note(step.name, ok, begin.elapsed().as_secs_f64()) {
                break 'steps;
            }
        }
        if wanted("documentation") {
            let begin = Instant::now();
            let ok = doc::run().map_err(|error| eprintln!("{error}")).is_ok();
            if !note("documentation", ok, begin.elapsed().as_secs_f64()) {
                break 'steps;
            }
        }
        if wanted("packages") {
            let begin = Instant::now();
            let made = packages::run(&packages::Options::default());
            let ok = made.map_err(|error| eprintln!("{error}")).is_ok();
            note("packages", ok, begin.elapsed().as_secs_f64());
        }
    }
    eprintln!("xtask ci: {:.1} s in total\n{}", start.elapsed().as_secs_f64(), times.join("\n"));
    if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", ")).into()) }
}

/// Calls cargo; does it succeed?
fn cargo(arguments: &[&str]) -> std::io::Result<bool> {
    eprintln!("xtask ci: cargo {}", arguments.join(" "));
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(program).args(arguments).current_dir(workspace_root()).status()?;
    Ok(status.success())
}
