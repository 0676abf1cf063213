//! `cargo xtask lines`: lines of product code of each crate, without tests, comments and blank lines.
use crate::{TaskResult, workspace_root};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Files of capabilities that came after the count of 40 178 lines, relative to the root.
const CAPABILITIES: &str = "xtask/capabilities.toml";

#[derive(clap::Args)]
pub(crate) struct Options {
    /// Folder of a checkout; this one by default.
    folder: Option<PathBuf>,
    /// A line for each capability of xtask/capabilities.toml and one for the rest, instead of one a crate.
    #[arg(long)]
    capabilities: bool,
    /// Comments count, too.
    #[arg(long)]
    comments: bool,
}

/// No crate has more lines of code and comments.
const MOST: usize = 13_000;

/// The crates that have.
pub(crate) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for (package, lines) in counted(root, with_comments)?.into_values() {
        *counts.entry(package).or_default() += lines;
    }
    let too_large = counts.into_iter().filter(|(_, lines)| *lines > MOST);
    Ok(too_large
        .map(|(package, lines)| {
            format!("{package}: {lines} lines of code and comments, more than {MOST}: move some")
        })
        .collect())
}

/// Prints a line for each folder that holds a crate, or for each capability, and the sum.
pub(crate) fn run(options: &Options) -> TaskResult {
    let root = options.folder.clone().unwrap_or_else(workspace_root);
    let files = counted(&root, if options.comments { with_comments } else { without_comments })?;
    let capabilities = if options.capabilities {
        toml::from_str(&fs::read_to_string(root.join(CAPABILITIES))?)?
    } else {
        BTreeMap::new()
    };
    let places = by_place(&capabilities, |path| root.join(path).exists())?;
    let group = |path: &Path, package: &str| -> String {
        if !options.capabilities {
            return package.to_owned();
        }
        let of = places.iter().find(|(place, _)| path.starts_with(place));
        of.map_or("the rest", |(_, name)| name).to_owned()
    };
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for (path, (package, lines)) in &files {
        *counts.entry(group(path, package)).or_default() += lines;
    }
    for (name, lines) in &counts {
        println!("{lines:>6}  {name}");
    }
    println!("{:>6}  in all", counts.values().sum::<usize>());
    Ok(())
}

/// Every file of product code below a folder, with its crate and its lines.
fn counted(
    root: &Path,
    count: fn(&str) -> usize,
) -> Result<BTreeMap<PathBuf, (String, usize)>, Box<dyn std::error::Error>> {
    let mut files = BTreeMap::new();
    let mut open = vec![root.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))? {
            let path = entry?.path();
            let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
            if path.is_dir() {
                if !name.starts_with('.') && name != "target" {
                    open.push(path);
                }
                continue;
            }
            let inside = path.strip_prefix(root)?;
            if let Some(package) = product(inside) {
                files.insert(inside.to_path_buf(), (package, count(&fs::read_to_string(&path)?)));
            }
        }
    }
    Ok(files)
}

/// The capability of each file and folder; each must be there, and none below another.
fn by_place(
    capabilities: &BTreeMap<String, Vec<PathBuf>>,
    is_there: impl Fn(&Path) -> bool,
) -> Result<BTreeMap<&Path, &str>, String> {
    let mut places: BTreeMap<&Path, &str> = BTreeMap::new();
    for (name, paths) in capabilities {
        for path in paths {
            if !is_there(path) {
                return Err(format!("{CAPABILITIES}: {} is not there", path.display()));
            }
            if places.keys().any(|other| other.starts_with(path) || path.starts_with(other)) {
                return Err(format!("{CAPABILITIES}: {} counts twice", path.display()));
            }
            places.insert(path, name);
        }
    }
    Ok(places)
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

/// Lines up to the module of tests that are not blank.
fn product_lines(text: &str) -> impl Iterator<Item = &str> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let tests = lines.windows(2).position(|pair| pair[0] == "#[cfg(test)]" && pair[1].ends_with('{'));
    let most = tests.unwrap_or(lines.len());
    lines.into_iter().take(most).filter(|line| !line.is_empty())
}

fn with_comments(text: &str) -> usize {
    product_lines(text).count()
}

fn without_comments(text: &str) -> usize {
    product_lines(text).filter(|line| !line.starts_with("//")).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tests_comments_and_blank_lines_do_not_count() {
        let text = "//! Doc.\n\nfn f() {} // sum\n#[cfg(test)]\nmod tests {\n    fn g() {}\n}\n";
        assert_eq!((without_comments(text), with_comments(text)), (1, 2));
        assert_eq!(without_comments("#[cfg(test)]\nmod tests;\nfn f() {}\n"), 3);
        let package = |path: &str| product(Path::new(path));
        assert_eq!(package("crates/d2m-x/src/a/b.rs").as_deref(), Some("crates/d2m-x"));
        assert_eq!(package("crates/d2m-x/src/a/tests.rs"), None);
        assert_eq!(package("crates/d2m-x/tests/a.rs"), None);
        assert_eq!(package("crates/d2m-testing/src/a.rs"), None);
    }

    #[test]
    fn each_file_of_the_table_is_there() {
        run(&Options { folder: None, capabilities: true, comments: false }).unwrap();
    }

    #[test]
    fn a_capability_is_there_and_counts_once() {
        let of = |paths: &[&str]| {
            let capabilities =
                BTreeMap::from([("a".to_owned(), paths.iter().map(PathBuf::from).collect::<Vec<_>>())]);
            by_place(&capabilities, |path| path.starts_with("crates")).map(|places| places.len())
        };
        assert_eq!(of(&["crates/a/src/b", "crates/a/src/b.rs"]), Ok(2));
        assert!(of(&["gone/a.rs"]).is_err());
        assert!(of(&["crates/a", "crates/a/src/b.rs"]).is_err());
    }
}
