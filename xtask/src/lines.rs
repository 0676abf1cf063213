//! `cargo xtask lines`: lines of product code of each crate, without tests, comments and blank lines.
use crate::{TaskResult, workspace_root};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Folder of a checkout; this one by default.
    folder: Option<PathBuf>,
}

/// Prints a line for each folder that holds a crate, and the sum.
pub(crate) fn run(options: &Options) -> TaskResult {
    let root = options.folder.clone().unwrap_or_else(workspace_root);
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut open = vec![root.clone()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))? {
            let path = entry?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if path.is_dir() {
                if !name.starts_with('.') && name != "target" {
                    open.push(path);
                }
            } else if let Some(package) = product(path.strip_prefix(&root)?) {
                *counts.entry(package).or_default() += count(&fs::read_to_string(&path)?);
            }
        }
    }
    for (package, lines) in &counts {
        println!("{lines:>6}  {package}");
    }
    println!("{:>6}  in all", counts.values().sum::<usize>());
    Ok(())
}

/// The folder of the crate, if the file is a source of a published one and holds no tests only.
fn product(path: &Path) -> Option<String> {
    let parts: Vec<&str> = path.iter().filter_map(|part| part.to_str()).collect();
    let source = parts.iter().position(|&part| part == "src")?;
    let package = parts[..source].join("/");
    let file = parts.last()?.strip_suffix(".rs")?;
    let is_test = file == "tests" || file.ends_with("_tests") || parts.contains(&"tests");
    let is_tool =
        ["xtask", "benches", "crates/d2m-testing", "crates/d2m-evaluation"].contains(&package.as_str());
    (!is_test && !is_tool).then_some(package)
}

/// Lines up to the module of tests that are neither blank nor a comment.
fn count(text: &str) -> usize {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let tests = lines.windows(2).position(|pair| pair[0] == "#[cfg(test)]" && pair[1].ends_with('{'));
    let product = &lines[..tests.unwrap_or(lines.len())];
    product.iter().filter(|line| !line.is_empty() && !line.starts_with("//")).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_comments_and_blank_lines_do_not_count() {
        assert_eq!(count("//! Doc.\n\nfn f() {} // sum\n#[cfg(test)]\nmod tests {\n    fn g() {}\n}\n"), 1);
        assert_eq!(count("#[cfg(test)]\nmod tests;\nfn f() {}\n"), 3);
        let package = |path: &str| product(Path::new(path));
        assert_eq!(package("crates/d2m-x/src/a/b.rs").as_deref(), Some("crates/d2m-x"));
        assert_eq!(package("crates/d2m-x/src/a/tests.rs"), None);
        assert_eq!(package("crates/d2m-x/tests/a.rs"), None);
        assert_eq!(package("crates/d2m-testing/src/a.rs"), None);
    }
}
