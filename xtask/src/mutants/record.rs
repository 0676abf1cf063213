//! What became of the faults when they were made last: `docs/results/mutants.md`.
use super::Error;
use super::table::Mutant;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Where the table is, seen from the root of the workspace.
const PATH: &str = "docs/results/mutants.md";

const HEAD: &str = "# Deliberate faults, and what noticed them

Written by `cargo xtask mutants`; do not edit. A row is what the last run made of a fault, rows of earlier runs stay. Killed by a *test*; by a
*verdict*, where the verifier refuses an answer; or by the *audit* of what the engine concludes on its way. Faults without a row have not been
made since the table is kept. What each of them changes: `xtask/mutants/`.
";

/// One result.
pub(super) struct Judged<'a> {
    pub(super) mutant: &'a Mutant,
    pub(super) word: &'static str,
}

/// What kind of test it is that notices a fault.
fn kind(test: &str) -> &'static str {
    let file = test.split("::").next().unwrap_or(test);
    if file.ends_with("audit.rs") {
        "audit"
    } else if file.starts_with("crates/d2m/tests/verify") || file.starts_with("crates/d2m-verify/") {
        "verdict"
    } else {
        "test"
    }
}

/// Brings the table up to date: rows of these are written anew, those of faults that are gone are dropped.
pub(super) fn record(root: &Path, all: &[Mutant], judged: &[Judged<'_>]) -> Result<(), Error> {
    let commit = Command::new("git")
        .args(["log", "-1", "--format=%h of %cs"])
        .current_dir(root)
        .output()
        .map_err(|e| format!("git: {e}"))?;
    let commit = String::from_utf8_lossy(&commit.stdout).trim().to_owned();
    let path = root.join(PATH);
    let before = fs::read_to_string(&path).unwrap_or_default();
    let mut rows: BTreeMap<&str, String> = BTreeMap::new();
    for mutant in all {
        let start = format!("| {} |", mutant.name);
        rows.extend(
            before.lines().find(|row| row.starts_with(&start)).map(|row| (&*mutant.name, row.into())),
        );
    }
    for Judged { mutant, word } in judged {
        let row =
            format!("| {} | {word} | {} | `{}` | {commit} |", mutant.name, kind(&mutant.test), mutant.test);
        rows.insert(&mutant.name, row);
    }
    let count = format!("{} of {} faults have a row.", rows.len(), all.len());
    let rows: Vec<String> = rows.into_values().collect();
    let title = "| fault | result | by | which | at commit |\n|---|---|---|---|---|";
    fs::write(&path, format!("{HEAD}\n{count}\n\n{title}\n{}\n", rows.join("\n")))?;
    Ok(())
}
