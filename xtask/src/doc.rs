//! `cargo xtask doc`: the reference, with all links between the crates of the workspace.
//!
//! Pages are written side by side, and rustdoc links to another crate's pages on this machine only where they are there already;
//! otherwise to docs.rs. So crates whose front pages link there are written a second time.
use crate::{TaskResult, workspace_root};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A link that left this machine although the page is here.
const ELSEWHERE: &str = "href=\"https://docs.rs/d2m";

/// Writes the pages; an error when there is a warning, or a link of a crate's front page that leads away.
pub(crate) fn run() -> TaskResult {
    let root = workspace_root();
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let mut fronts = Vec::new();
    for entry in fs::read_dir(root.join("crates"))? {
        let name = entry?.file_name().to_string_lossy().replace('-', "_");
        fronts.push(target.join("doc").join(name).join("index.html"));
    }
    write(&root)?;
    for front in leading_away(&fronts)? {
        // Cargo writes again what is not there: one crate at a time, beside all others.
        fs::remove_file(front)?;
        write(&root)?;
    }
    if let Some(page) = leading_away(&fronts)?.first() {
        return Err(format!("{} links to docs.rs instead of the pages beside it", page.display()).into());
    }
    for front in published(&root, &target)? {
        for page in pages(&front)? {
            if let Some(name) = literal_link(&fs::read_to_string(&page)?) {
                return Err(format!("{}: [`{name}`] leads nowhere", page.display()).into());
            }
        }
    }
    Ok(())
}

/// The folders of the pages of published libraries. (Pages of programs show what a crate of others generates into them, with its links.)
fn published(root: &Path, target: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(root.join("crates"))? {
        let folder = entry?.path();
        let is_published = !fs::read_to_string(folder.join("Cargo.toml"))?.contains("publish = false");
        if is_published && folder.join("src/lib.rs").exists() {
            let name = folder.file_name().unwrap_or_default().to_string_lossy().replace('-', "_");
            found.push(target.join("doc").join(name));
        }
    }
    Ok(found)
}

/// All pages in a folder.
fn pages(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_path_buf()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|extension| extension == "html") {
                found.push(path);
            }
        }
    }
    Ok(found)
}

/// What a reader of a page sees in brackets because no page was found for it. A list of names in brackets is no link.
fn literal_link(page: &str) -> Option<&str> {
    page.split("[<code>").skip(1).find_map(|rest| {
        let (name, rest) = rest.split_once("</code>")?;
        (rest.starts_with(']') && !name.contains('<')).then_some(name)
    })
}

/// Writes the pages that are not up to date.
fn write(root: &Path) -> TaskResult {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(program)
        .args(["doc", "--workspace", "--no-deps", "--locked"])
        .env("RUSTDOCFLAGS", "-D warnings")
        .current_dir(root)
        .status()?;
    if status.success() { Ok(()) } else { Err("documentation: see above".into()) }
}

/// The front pages with such a link.
fn leading_away(fronts: &[PathBuf]) -> std::io::Result<Vec<&PathBuf>> {
    let mut found = Vec::new();
    for front in fronts.iter().filter(|front| front.exists()) {
        if fs::read_to_string(front)?.contains(ELSEWHERE) {
            found.push(front);
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_that_leads_nowhere_is_seen() {
        assert_eq!(literal_link("see [<code>World</code>] and"), Some("World"));
        assert_eq!(literal_link("<a href=\"w\"><code>World</code></a>"), None);
        assert_eq!(literal_link("in [<code>lo</code>, <code>hi</code>]"), None);
    }
}
