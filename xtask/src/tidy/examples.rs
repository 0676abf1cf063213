//! Examples: every item that the facade gives out by name has one in its documentation, where it is declared.
//!
//! That the example runs, and what it asserts, is what the documentation tests check.
use super::front::exports;
use std::fs;
use std::path::Path;

/// The crate whose names most people use.
const FACADE: &str = "crates/d2m/src/lib.rs";
/// What an item begins with.
const KINDS: [&str; 6] = ["pub struct ", "pub enum ", "pub trait ", "pub fn ", "pub const fn ", "pub type "];

/// One finding for each item without an example.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    for export in exports(&fs::read_to_string(root.join(FACADE))?) {
        let folder = root.join("crates").join(export.source.replace('_', "-")).join("src");
        // Whole crates come as modules; their examples are those of their own pages.
        if !folder.exists() || export.name.starts_with(char::is_lowercase) && is_module(root, &export.name) {
            continue;
        }
        let mut documents = Vec::new();
        for path in super::sources::files(&folder)? {
            documents.extend(documents_of(&fs::read_to_string(path)?, &export.name));
        }
        if !documents.iter().any(|document| has_example(document)) {
            findings.push(format!("{FACADE}: {} of {} has no example", export.name, export.source));
        }
    }
    Ok(findings)
}

/// Is it the name that the facade gives to a crate?
fn is_module(root: &Path, name: &str) -> bool {
    root.join("crates").join(format!("d2m-{name}")).exists()
}

/// The documentation of each item of that name, declared at the outer level of a file.
fn documents_of(text: &str, name: &str) -> Vec<String> {
    let lines: Vec<&str> = text.lines().collect();
    let is_named = |line: &str| {
        KINDS.iter().filter_map(|kind| line.strip_prefix(kind)).any(|rest| {
            rest.strip_prefix(name)
                .is_some_and(|end| !end.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        })
    };
    let declared = (0..lines.len()).filter(|&at| is_named(lines[at]));
    let before = |at: usize| {
        // Attributes of several lines end with a closing bracket at the margin.
        let above = lines[..at].iter().rev().take_while(|line| !line.is_empty() && !line.starts_with('}'));
        above.filter(|line| line.starts_with("///")).copied().collect::<Vec<_>>().join("\n")
    };
    declared.map(before).collect()
}

fn has_example(document: &str) -> bool {
    document.lines().any(|line| line == "/// ```")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_are_seen_above_attributes() {
        let text = "/// One.\n///\n/// ```\n/// x\n/// ```\n#[derive(\n    Debug,\n)]\npub struct One;\n\n/// Two.\npub fn two() {}\n";
        assert!(documents_of(text, "One").iter().all(|document| has_example(document)));
        assert_eq!(documents_of(text, "two"), ["/// Two."]);
        assert!(documents_of(text, "On").is_empty() && !has_example("/// ```text"));
    }
}
