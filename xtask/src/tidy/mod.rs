//! `cargo xtask tidy`: the structure that the documents promise, held against the tree.
mod arrows;
mod examples;
mod front;
mod guarantees;
mod guide;
mod literals;
mod map;
mod packages;
mod sources;
mod top;

use crate::{TaskResult, workspace_root};

/// Prints every disagreement; an error when there is one.
pub(crate) fn run() -> TaskResult {
    let root = workspace_root();
    let mut findings = top::check(&root)?;
    findings.extend(map::check(&root)?);
    findings.extend(arrows::check(&root)?);
    findings.extend(sources::check(&root)?);
    findings.extend(crate::lines::check(&root)?);
    findings.extend(guarantees::check(&root)?);
    findings.extend(literals::check(&root)?);
    findings.extend(front::check(&root)?);
    findings.extend(examples::check(&root)?);
    findings.extend(packages::check(&root)?);
    findings.extend(guide::check(&root)?);
    findings.extend(crate::comparison::check(&root)?);
    findings.extend(crate::mutants::check(&root));
    for finding in &findings {
        eprintln!("tidy: {finding}");
    }
    if findings.is_empty() { Ok(()) } else { Err(format!("tidy: {} finding(s)", findings.len()).into()) }
}
