//! Packages: what `cargo publish` would send stands by itself, and says what it is.
use super::front::libraries;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What every manifest states, each in its own words.
const STATED: [&str; 5] = ["description", "documentation", "readme", "keywords", "categories"];
/// What every package holds besides its code.
const HELD: [&str; 3] = ["README.md", "LICENSE-APACHE", "LICENSE-MIT"];
/// Generators and oracles of the tests of this repository; no package can need them.
const TESTING: &str = "d2m_testing";

/// One finding for each thing that a package lacks, and for each file in it that reads one outside.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    let mut keywords = Vec::new();
    for folder in libraries(root)? {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let manifest: toml::Table = fs::read_to_string(folder.join("Cargo.toml"))?.parse()?;
        let package = manifest.get("package");
        let stated =
            |key: &str| package.and_then(|package| package.get(key)).filter(|value| !value.is_table());
        let missing = STATED.iter().filter(|key| stated(key).is_none());
        findings.extend(missing.map(|key| format!("{name}/Cargo.toml: no {key} of its own")));
        let words = stated("keywords").cloned();
        if keywords.contains(&words) {
            findings.push(format!("{name}/Cargo.toml: the keywords are those of another crate"));
        }
        keywords.push(words);
        let files = listed(root, &name)?;
        let lacking = HELD.iter().filter(|held| !files.iter().any(|file| file == *held));
        findings.extend(lacking.map(|held| format!("{name}: the package has no {held}")));
        for file in files.iter().filter(|file| Path::new(file).extension().is_some_and(|end| end == "rs")) {
            let text = fs::read_to_string(folder.join(file))?;
            findings.extend(judge(file, &text).map(|what| format!("{name}/{what}")));
        }
    }
    Ok(findings)
}

/// The files of a package.
fn listed(root: &Path, name: &str) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["package", "--list", "--allow-dirty", "--locked", "--quiet", "--package", name])
        .current_dir(root)
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    Ok(String::from_utf8(output.stdout)?.lines().map(str::to_owned).collect())
}

/// What a file of a package needs that is not in it. `file` is its path from the folder of the crate.
fn judge(file: &str, text: &str) -> impl Iterator<Item = String> {
    let depth = file.matches('/').count();
    let is_test = ["tests/", "examples/"].iter().any(|folder| file.starts_with(folder));
    let needs_testing = is_test && text.contains(TESTING);
    let leaving = text.lines().enumerate().filter(move |(_, line)| {
        let from = match line {
            line if line.contains("CARGO_MANIFEST_DIR") => Some(0),
            line if ["include_str!", "include_bytes!", "#[path"].iter().any(|word| line.contains(word)) => {
                Some(depth)
            }
            _ => None,
        };
        let up = line.split_once("\"../").map_or(0, |(_, rest)| 1 + rest.matches("../").count());
        from.is_some_and(|from| up > from)
    });
    let outside =
        leaving.map(|(at, _)| format!("line {} reads a file that the package does not hold", at + 1));
    let all: Vec<String> = outside
        .chain(needs_testing.then(|| format!("needs {TESTING}, which is not published: exclude it")))
        .map(|what| format!("{file}: {what}"))
        .collect();
    all.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leaves_the_package_is_found() {
        let inside = "#![doc = include_str!(\"../README.md\")]\nlet up = \"../../x\";";
        assert_eq!(judge("src/lib.rs", inside).count(), 0);
        assert_eq!(judge("src/lib.rs", "include_str!(\"../../README.md\")").count(), 1);
        assert_eq!(judge("src/a/b.rs", "#[path = \"../../c.rs\"]").count(), 0);
        assert_eq!(judge("tests/a.rs", "Path::new(env!(\"CARGO_MANIFEST_DIR\")).join(\"../x\")").count(), 1);
        assert_eq!(judge("tests/a.rs", "use d2m_testing::Draw;").count(), 1);
        assert_eq!(judge("src/a.rs", "use d2m_testing::Draw;").count(), 0);
    }
}
