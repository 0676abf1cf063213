//! ARCHITECTURE.md against the workspace: names, folders, invariants and the order of the layers.
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// A crate as cargo sees it: folder, and the crates of the workspace that it needs to run.
struct Package {
    folder: String,
    needs: Vec<String>,
}

/// What disagrees.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let text =
        std::fs::read_to_string(root.join("ARCHITECTURE.md")).map_err(|e| format!("ARCHITECTURE.md: {e}"))?;
    Ok(compare(&text, &packages(root)?))
}

fn packages(root: &Path) -> Result<BTreeMap<String, Package>, Box<dyn std::error::Error>> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["metadata", "--no-deps", "--format-version=1", "--locked"])
        .current_dir(root)
        .output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    let metadata: Value = serde_json::from_slice(&output.stdout)?;
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let mut packages = BTreeMap::new();
    for package in list(&metadata["packages"]) {
        let manifest = Path::new(package["manifest_path"].as_str().unwrap_or_default());
        let folder = manifest.parent().and_then(|folder| folder.strip_prefix(root).ok()).unwrap_or(manifest);
        let needs = list(&package["dependencies"])
            .iter()
            .filter(|d| d["path"].is_string() && d["kind"].as_str() != Some("dev"))
            .filter_map(|d| d["name"].as_str().map(String::from))
            .collect();
        let name = package["name"].as_str().unwrap_or_default().to_string();
        packages.insert(name, Package { folder: folder.display().to_string(), needs });
    }
    Ok(packages)
}

/// The rows `| `name` | `folder/` | … |` of the first table, in order.
fn rows(text: &str) -> Vec<(String, String)> {
    let code = |cell: &str| {
        let cell = cell.trim();
        cell.strip_prefix('`')?.strip_suffix('`').map(|inner| inner.trim_end_matches('/').to_string())
    };
    text.lines()
        .filter_map(|line| {
            let mut cells = line.strip_prefix('|')?.split('|');
            Some((code(cells.next()?)?, code(cells.next()?)?))
        })
        .collect()
}

fn compare(text: &str, packages: &BTreeMap<String, Package>) -> Vec<String> {
    let rows = rows(text);
    let place: BTreeMap<&str, usize> =
        rows.iter().enumerate().map(|(i, (name, _))| (name.as_str(), i)).collect();
    let mut findings = Vec::new();
    let mut find = |finding: String| findings.push(format!("ARCHITECTURE.md: {finding}"));
    for (name, folder) in &rows {
        match packages.get(name) {
            None => find(format!("{name} is on the map but not in the workspace")),
            Some(package) if package.folder != *folder => {
                find(format!("{name} lies in {}/, the map says {folder}/", package.folder));
            }
            Some(_) => {}
        }
    }
    for (name, package) in packages {
        let Some(own) = place.get(name.as_str()) else {
            find(format!("{name} is missing on the map"));
            continue;
        };
        for need in &package.needs {
            if place.get(need.as_str()).is_some_and(|other| other >= own) {
                find(format!(
                    "{name} depends on {need}, which stands below it: dependencies only point up the map"
                ));
            }
        }
        let sentences =
            text.lines().filter(|line| line.contains(&format!("**Invariant** (`{name}`):"))).count();
        if sentences != 1 {
            find(format!("{sentences} **Invariant** sentences for {name} instead of one"));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "| crate | folder |\n|---|---|\n| `low` | `low/` | x |\n| `high` | `high/` | y |\n\
        - **Invariant** (`low`): is low.\n- **Invariant** (`high`): is high.\n";

    fn packages(list: &[(&str, &str, &[&str])]) -> BTreeMap<String, Package> {
        let package = |folder: &str, needs: &[&str]| Package {
            folder: folder.into(),
            needs: needs.iter().map(ToString::to_string).collect(),
        };
        list.iter().map(|(name, folder, needs)| ((*name).to_string(), package(folder, needs))).collect()
    }

    #[test]
    fn agreement_has_no_finding() {
        assert_eq!(compare(TEXT, &packages(&[("low", "low", &[]), ("high", "high", &["low"])])), [""; 0]);
    }

    #[test]
    fn each_disagreement_is_found() {
        let only = |list, word: &str| {
            let findings = compare(TEXT, &packages(list));
            assert_eq!(findings.len(), 1, "{findings:?}");
            assert!(findings[0].contains(word), "{findings:?}");
        };
        only(&[("low", "low", &["high"]), ("high", "high", &[])], "stands below");
        only(&[("low", "elsewhere", &[]), ("high", "high", &[])], "lies in elsewhere/");
        only(&[("low", "low", &[])], "not in the workspace");
        let extra =
            compare(TEXT, &packages(&[("low", "low", &[]), ("high", "high", &[]), ("new", "new", &[])]));
        assert_eq!(extra.len(), 1);
        let silent = TEXT.replace("(`low`)", "");
        assert_eq!(compare(&silent, &packages(&[("low", "low", &[]), ("high", "high", &[])])).len(), 1);
    }
}
