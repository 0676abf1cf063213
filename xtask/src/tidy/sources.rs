//! Rules for single files: length, names, and what must not be written down.
use std::fs;
use std::path::{Path, PathBuf};

/// No file of code is longer.
const LINES: usize = 600;
/// Names that say nothing about what lives in a file.
const EMPTY_NAMES: [&str; 8] = ["util", "utils", "helper", "helpers", "misc", "common", "stuff", "tools"];
/// Absolute paths of somebody's machine.
const MACHINE_PATHS: [&str; 4] =
    [concat!("/ho", "me/"), concat!("/ro", "ot/"), concat!("/wo", "rk/"), concat!("/Us", "ers/")];

/// What breaks a rule.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    for path in files(root)? {
        let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        if let Ok(text) = fs::read_to_string(&path) {
            findings.extend(judge(&name, &text));
        }
    }
    Ok(findings)
}

fn judge(name: &str, text: &str) -> Vec<String> {
    let mut findings = Vec::new();
    if let Some(stem) = name.strip_suffix(".rs") {
        let lines = text.lines().count();
        if lines > LINES {
            findings.push(format!("{name}: {lines} lines, more than {LINES}: split it"));
        }
        if let Some(part) = stem.split('/').find(|part| EMPTY_NAMES.contains(part)) {
            findings.push(format!("{name}: a module called {part} does not say what it holds"));
        }
    }
    for (index, line) in text.lines().enumerate() {
        if let Some(path) = MACHINE_PATHS.iter().find(|path| names_a_machine(line, path)) {
            findings.push(format!("{name}:{}: {path} is a path of one machine", index + 1));
        }
    }
    findings
}

/// `path` at the start of a path in the line, rather than in the middle of a link.
fn names_a_machine(line: &str, path: &str) -> bool {
    line.match_indices(path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        before.is_none_or(|c| !(c.is_alphanumeric() || "._-/~".contains(c)))
    })
}

/// Text files of the project: everything but hidden folders, build output and generated results.
pub(super) fn files(root: &Path) -> std::io::Result<Vec<PathBuf>> {
    let (mut found, mut open) = (Vec::new(), vec![root.to_path_buf()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if path.is_dir() {
                if !name.starts_with('.') && name != "target" {
                    open.push(path);
                }
            } else if ["rs", "md", "toml", "py"].iter().any(|end| path.extension().is_some_and(|e| e == *end))
            {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules() {
        assert_eq!(judge("a/src/pose.rs", "//! Poses.\n"), [""; 0]);
        assert_eq!(judge("a/src/util.rs", "").len(), 1);
        assert_eq!(judge("a/src/util/pose.rs", "").len(), 1);
        assert_eq!(judge("a/src/long.rs", &"x\n".repeat(601)).len(), 1);
        assert_eq!(judge("a/README.md", &format!("see {}me/files", "/ho")).len(), 1);
        assert_eq!(judge("a/README.md", "see https://example.org/home/x").len(), 0);
    }
}
