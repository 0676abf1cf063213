//! Front pages: every name that a library's root exports is linked from its page, and the page has a picture.
//!
//! The page is README.md with the `//!` lines of `lib.rs`. A link is the name in backticks and brackets; that it leads somewhere is
//! what `cargo doc` checks.
use std::fs;
use std::path::Path;

/// Crates that are not published have no page for strangers.
const UNPUBLISHED: &str = "publish = false";

/// One finding for each name that is not linked, and for each page without a picture.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    for folder in libraries(root)? {
        let name = folder.strip_prefix(root).unwrap_or(&folder).display().to_string();
        let source = fs::read_to_string(folder.join("src/lib.rs"))?;
        let readme = fs::read_to_string(folder.join("README.md"))?;
        findings.extend(judge(&source, &readme).map(|what| format!("{name}/src/lib.rs: {what}")));
    }
    Ok(findings)
}

/// The folders of the published libraries of the workspace.
pub(super) fn libraries(root: &Path) -> Result<Vec<std::path::PathBuf>, Box<dyn std::error::Error>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root.join("crates"))? {
        let folder = entry?.path();
        let manifest = fs::read_to_string(folder.join("Cargo.toml"))?;
        if folder.join("src/lib.rs").exists() && !manifest.contains(UNPUBLISHED) {
            found.push(folder);
        }
    }
    found.sort();
    Ok(found)
}

fn judge(source: &str, readme: &str) -> impl Iterator<Item = String> {
    let page: String =
        source.lines().filter_map(|line| line.strip_prefix("//!")).collect::<Vec<_>>().join("\n");
    let page = format!("{readme}\n{page}");
    let picture = "#![doc = include_str!(\"../picture.svg\")]";
    let missing = (!source.contains(picture)).then(|| format!("its page has no picture: {picture}"));
    let is_linked =
        move |name: &String| ["", "()", "!"].iter().any(|end| page.contains(&format!("[`{name}{end}`]")));
    let names = exports(source).into_iter().map(|export| export.name);
    let unlinked = names.filter(move |name| !is_linked(name));
    missing.into_iter().chain(unlinked.map(|name| format!("{name} is exported and not linked from its page")))
}

/// A name that a root gives out, and the crate or module that it comes from.
#[derive(Debug, PartialEq)]
pub(super) struct Export {
    pub(super) source: String,
    pub(super) name: String,
}

/// What `pub use` gives out at the root, outside of what is hidden.
pub(super) fn exports(source: &str) -> Vec<Export> {
    let mut found = Vec::new();
    let mut is_hidden = false;
    let mut lines = source.lines();
    while let Some(line) = lines.next() {
        match line.strip_prefix("pub use ") {
            Some(rest) => {
                let mut text = rest.to_owned();
                while !text.ends_with(';') {
                    let Some(more) = lines.next() else { break };
                    text.push_str(more.trim());
                }
                if !is_hidden {
                    found.extend(exports_of(text.trim_end_matches(';')));
                }
                is_hidden = false;
            }
            None => is_hidden |= line == "#[doc(hidden)]",
        }
    }
    found
}

/// The ends of a tree of paths such as `a::{b, c::d}` or `e as f`.
fn exports_of(tree: &str) -> Vec<Export> {
    let inside = match (tree.find('{'), tree.rfind('}')) {
        (Some(open), Some(close)) => &tree[open + 1..close],
        _ => tree,
    };
    let source = tree.split([':', ' ']).next().unwrap_or_default();
    let last = |path: &str| path.rsplit([':', ' ']).next().unwrap_or_default().to_owned();
    let export = |path| Export { source: source.to_owned(), name: last(path) };
    inside.split(',').map(str::trim).filter(|path| !path.is_empty()).map(export).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const PICTURE: &str = "#![doc = include_str!(\"../picture.svg\")]\n";

    #[test]
    fn exports_are_read() {
        let source = "pub use a::b;\npub use c as d;\npub use e::{\n    F, g::H,\n};\n#[doc(hidden)]\npub use i;\npub use j;";
        let names: Vec<_> = exports(source).into_iter().map(|export| export.name).collect();
        assert_eq!(names, ["b", "d", "F", "H", "j"]);
        assert_eq!(exports("pub use e::{F};"), [Export { source: "e".into(), name: "F".into() }]);
    }

    #[test]
    fn what_is_not_linked_is_named() {
        let source = format!(
            "{PICTURE}//! [`One`], [`two()`], [`three!`], Four\npub use a::{{One, two, three, Four}};"
        );
        assert_eq!(judge(&source, "").collect::<Vec<_>>(), ["Four is exported and not linked from its page"]);
        assert_eq!(judge(&source, "[`Four`]").count(), 0);
        assert_eq!(judge("", "").count(), 1);
    }
}
