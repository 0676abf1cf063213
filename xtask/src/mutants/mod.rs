//! `cargo xtask mutants`: the table of deliberate faults, each of which a named test must notice.
mod build;
mod copy;
mod planted;
mod program;
mod record;
mod round;
mod run;
mod switch;
mod table;
mod target;

use crate::{TaskResult, workspace_root};
use table::{Change, Mutant};

/// Workers hand theirs to the thread that started them.
type Error = Box<dyn std::error::Error + Send + Sync>;

pub(crate) use run::Options;

/// `cargo xtask mutants`.
pub(crate) fn run(options: &Options) -> TaskResult {
    run::run(options, &workspace_root()).map_err(|error| error.to_string().into())
}

/// Texts to be replaced that do not occur exactly once in their file, and tests that do not exist.
pub(crate) fn check(root: &std::path::Path) -> Vec<String> {
    match table::read(root) {
        Ok(mutants) => mutants.iter().flat_map(|mutant| judge(root, mutant)).collect(),
        Err(error) => vec![error.to_string()],
    }
}

fn judge(root: &std::path::Path, mutant: &Mutant) -> Vec<String> {
    let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap_or_default();
    let mut findings = Vec::new();
    let test = mutant.test();
    if !text(test.file).contains(&format!("fn {}(", test.name)) {
        findings.push(format!("mutant \"{}\": there is no test {}", mutant.name, mutant.test));
    }
    if let Change::Patch { file, from, .. } = &mutant.change {
        let found = text(file).matches(from.as_str()).count();
        if found != 1 {
            findings.push(format!(
                "mutant \"{}\": {file} holds its text {found} times instead of once: {from}",
                mutant.name
            ));
        }
    }
    findings
}
