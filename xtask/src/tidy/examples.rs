//! Examples: every item that a published library gives out by name has one in its documentation, where it is declared.
//!
//! That the example runs, and what it asserts, is what the documentation tests check.
use super::front::{Export, exports, libraries};
use std::fs;
use std::path::{Path, PathBuf};

/// The library that nobody but the others needs: its page says so.
const INTERNAL: &str = "d2m-lanes";
/// The library whose examples newcomers run.
const FACADE: &str = "crates/d2m";
/// What an item begins with.
const KINDS: [&str; 7] =
    ["pub struct ", "pub enum ", "pub trait ", "pub fn ", "pub const fn ", "pub type ", "pub const "];

/// One finding for each item without an example.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    for library in libraries(root)?.iter().filter(|library| !library.ends_with(INTERNAL)) {
        let page = library.join("src/lib.rs");
        for export in exports(&fs::read_to_string(&page)?) {
            let folder = declaring(root, library, &export)?;
            let mut documents = Vec::new();
            for path in super::sources::files(&folder)? {
                documents.extend(documents_of(&fs::read_to_string(path)?, &export.name));
            }
            // Whole crates come as modules; their examples are those of their own pages.
            let is_crate = documents.is_empty() && export.name.starts_with(char::is_lowercase);
            if !is_crate && !documents.iter().any(|document| has_example(document)) {
                let name = page.strip_prefix(root).unwrap_or(&page).display();
                findings.push(format!("{name}: {} of {} has no example", export.name, export.source));
            }
        }
    }
    findings.extend(unlisted_programs(root)?);
    Ok(findings)
}

/// The sources of the library that declares a name: this one, or another crate of the workspace, which may have it from a third.
fn declaring(root: &Path, library: &Path, export: &Export) -> std::io::Result<PathBuf> {
    let other = root.join("crates").join(export.source.replace('_', "-"));
    let page = other.join("src/lib.rs");
    if !page.exists() {
        return Ok(library.join("src"));
    }
    let further = exports(&fs::read_to_string(page)?).into_iter().find(|further| further.name == export.name);
    further.map_or_else(|| Ok(other.join("src")), |further| declaring(root, &other, &further))
}

/// One finding for each program of the facade's examples that its page does not name, or that does not say first what it shows.
fn unlisted_programs(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let page = fs::read_to_string(root.join(FACADE).join("README.md"))?;
    let mut findings = Vec::new();
    for path in super::sources::files(&root.join(FACADE).join("examples"))? {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if !page.contains(&format!("`{name}`")) {
            findings.push(format!("{FACADE}/README.md: the example {name} is not in its table"));
        }
        if !fs::read_to_string(&path)?.starts_with("//! ") {
            findings.push(format!("{}: does not say what it shows", path.display()));
        }
    }
    Ok(findings)
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
        let mut document: Vec<&str> = above.filter(|line| line.starts_with("///")).copied().collect();
        document.reverse();
        document.join("\n")
    };
    declared.map(before).collect()
}

/// Is there a block of Rust? Blocks of other languages name theirs, and end like one of Rust begins.
fn has_example(document: &str) -> bool {
    let mut is_inside = false;
    document.lines().filter(|line| line.starts_with("/// ```")).any(|fence| {
        is_inside = !is_inside;
        is_inside && fence == "/// ```"
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_are_seen_above_attributes() {
        let text = "/// One.\n///\n/// ```\n/// x\n/// ```\n#[derive(\n    Debug,\n)]\npub struct One;\n\n/// Two.\npub fn two() {}\n";
        assert!(documents_of(text, "One").iter().all(|document| has_example(document)));
        assert_eq!(documents_of(text, "two"), ["/// Two."]);
        assert!(documents_of(text, "On").is_empty());
    }

    #[test]
    fn a_figure_is_no_example() {
        let figure = "/// A figure.\n/// ```text\n/// o--o\n/// ```";
        assert!(!has_example(figure));
        assert!(has_example(&format!("{figure}\n///\n/// ```\n/// assert!(true);\n/// ```")));
    }
}
