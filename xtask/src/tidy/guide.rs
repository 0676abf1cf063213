//! The guide: every page is in its summary and among the tests, and every link of a document leads to a file.
use std::fs;
use std::path::{Path, PathBuf};

const GUIDE: &str = "docs/guide";
const SUMMARY: &str = "docs/guide/SUMMARY.md";
/// Where the blocks of the pages are compiled and run.
const TESTS: &str = "crates/d2m-guide/src/lib.rs";
/// What was done, with the names that files had then.
const HISTORY: [&str; 3] = ["docs/changes.md", "docs/experiments.md", "docs/results/mutants.md"];

/// One finding for each page that is not listed or not tested, and for each link that leads nowhere.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let summary = fs::read_to_string(root.join(SUMMARY))?;
    let tests = fs::read_to_string(root.join(TESTS))?;
    let mut findings = Vec::new();
    for entry in fs::read_dir(root.join(GUIDE))? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if !is_document(&path) || SUMMARY.ends_with(&name) {
            continue;
        }
        if !summary.contains(&format!("]({name})")) {
            findings.push(format!("{SUMMARY}: {name} is not in it"));
        }
        if !tests.contains(&format!("\"{GUIDE}/{name}\"")) {
            findings.push(format!("{TESTS}: the blocks of {name} are not run"));
        }
    }
    for page in documents(root)? {
        let folder = page.parent().unwrap_or(root);
        let text = fs::read_to_string(&page)?;
        let lost = links(&text).filter(|link| !folder.join(link).exists());
        let name = page.strip_prefix(root).unwrap_or(&page).display();
        findings.extend(lost.map(|link| format!("{name}: {link} does not exist")));
        if !HISTORY.iter().any(|past| page.ends_with(past)) {
            let lost = sources(&text).filter(|path| !root.join(path).exists());
            findings.extend(lost.map(|path| format!("{name}: {path} does not exist")));
        }
    }
    findings.sort();
    Ok(findings)
}

fn is_document(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "md")
}

/// The documents of the repository: at its root, below `docs`, and the page of each crate.
fn documents(root: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> = super::sources::files(&root.join("docs"))?;
    for entry in fs::read_dir(root)? {
        found.push(entry?.path());
    }
    for entry in fs::read_dir(root.join("crates"))? {
        found.push(entry?.path().join("README.md"));
    }
    found.retain(|path| path.is_file() && is_document(path));
    Ok(found)
}

/// The files that a document links to: what is on the net, within the page or the name of an item is not looked up.
fn links(text: &str) -> impl Iterator<Item = &str> {
    let outside_of_blocks = text.split("```").step_by(2);
    let targets = outside_of_blocks.flat_map(|part| part.split("](").skip(1));
    let ends = targets.filter_map(|rest| rest.split([')', ' ']).next());
    let files = ends.filter_map(|link| link.split('#').next());
    files.filter(|link| !link.is_empty() && !link.contains(':') && (link.contains('/') || link.contains('.')))
}

/// The files of source that a document names from the root of the repository, as `crates/d2m-motion/src/spline.rs`.
fn sources(text: &str) -> impl Iterator<Item = &str> {
    let named = text.split('`').filter_map(|code| code.split("::").next());
    named.filter(|path| {
        let is_source = Path::new(path).extension().is_some_and(|extension| extension == "rs");
        is_source && path.starts_with("crates/") && !path.contains(['*', '<', '{', ' '])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_source_are_seen() {
        let text = "in `crates/a/src/b.rs::c` and `crates/a/src/{b,d}.rs`, `mod.rs`,\n`crates/e.rs`";
        assert_eq!(sources(text).collect::<Vec<_>>(), ["crates/a/src/b.rs", "crates/e.rs"]);
    }

    #[test]
    fn links_to_files_are_seen() {
        let text = "[a](b.md#c), [d](https://e.org), [f](#g) ![h](i/j.svg)\n```rust\nlet x = y[0](z.md);\n```\n[k](l/)";
        assert_eq!(links(text).collect::<Vec<_>>(), ["b.md", "i/j.svg", "l/"]);
    }
}
