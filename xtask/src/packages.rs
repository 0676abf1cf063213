//! `cargo xtask packages`: what `cargo publish` would send, made and, with `--test`, built and tested without this repository.
//!
//! Packages are made without a network. To be tested they are unpacked into a workspace of their own, in which they are each other's
//! dependencies: nothing else of the repository is there. Tests that need what the repository's tests share are not in packages; what is
//! left are the examples of the documentation, and the tests under `tests` that are.
use crate::{TaskResult, workspace_root};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

#[derive(clap::Args, Default)]
pub(crate) struct Options {
    /// Unpack them, and run the tests that they hold.
    #[arg(long)]
    test: bool,
    /// Only these packages are tested.
    #[arg(long, requires = "test")]
    only: Vec<String>,
}

/// Makes the packages, and tests them if that is wanted.
pub(crate) fn run(options: &Options) -> TaskResult {
    let root = workspace_root();
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let names = published(&root)?;
    let mut call = vec!["package", "--no-verify", "--locked", "--offline", "--allow-dirty", "--quiet"];
    call.extend(names.iter().flat_map(|name| ["--package", name]));
    cargo(&root, &call)?;
    if options.test {
        let folder = target.join("packages");
        unpack(&root, &target.join("package"), &folder, &names)?;
        let chosen: Vec<&String> =
            names.iter().filter(|name| options.only.is_empty() || options.only.contains(name)).collect();
        for kind in ["--doc", "--tests"] {
            for name in &chosen {
                let has_library = folder.join(name).join("src/lib.rs").exists();
                let has_tests = folder.join(name).join("tests").exists();
                if kind == "--doc" && has_library {
                    cargo(&folder, &["test", "--all-features", "--package", name, "--doc"])?;
                } else if kind == "--tests" && has_tests {
                    cargo(&folder, &["test", "--all-features", "--package", name, "--test", "*"])?;
                }
            }
        }
    }
    Ok(())
}

/// The names of all packages of the workspace that are published.
fn published(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut names = Vec::new();
    let workspace: toml::Table = fs::read_to_string(root.join("Cargo.toml"))?.parse()?;
    let members = workspace["workspace"]["members"].as_array().cloned().unwrap_or_default();
    for member in members.iter().filter_map(toml::Value::as_str) {
        let manifest: toml::Table = fs::read_to_string(root.join(member).join("Cargo.toml"))?.parse()?;
        let package = &manifest["package"];
        if package.get("publish").and_then(toml::Value::as_bool) != Some(false) {
            names.push(package["name"].as_str().unwrap_or_default().to_owned());
        }
    }
    Ok(names)
}

/// Unpacks what is in `packed` into a workspace in `folder`, with the lock file of the repository.
fn unpack(root: &Path, packed: &Path, folder: &Path, names: &[String]) -> TaskResult {
    if folder.exists() {
        fs::remove_dir_all(folder)?;
    }
    fs::create_dir_all(folder)?;
    let mut patches = String::new();
    for name in names {
        let version = version_of(packed, name)?;
        let archive = packed.join(format!("{name}-{version}.crate"));
        let status = Command::new("tar").arg("xzf").arg(&archive).arg("-C").arg(folder).status()?;
        if !status.success() {
            return Err(format!("{} cannot be unpacked", archive.display()).into());
        }
        fs::rename(folder.join(format!("{name}-{version}")), folder.join(name))?;
        writeln!(patches, "{name} = {{ path = \"{name}\" }}")?;
    }
    let members = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
    let manifest = format!(
        "[workspace]\nresolver = \"3\"\nmembers = [{members}]\n\n[patch.crates-io]\n{patches}\n[profile.dev]\nopt-level = 1\n"
    );
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    Ok(())
}

/// The version of a package that was made.
fn version_of(packed: &Path, name: &str) -> Result<String, Box<dyn std::error::Error>> {
    let mut versions = Vec::new();
    for entry in fs::read_dir(packed)? {
        let file = entry?.file_name().to_string_lossy().into_owned();
        let version = file.strip_prefix(&format!("{name}-")).and_then(|rest| rest.strip_suffix(".crate"));
        versions
            .extend(version.filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit())).map(str::to_owned));
    }
    versions.sort();
    versions.pop().ok_or_else(|| format!("there is no package of {name}").into())
}

fn cargo(folder: &Path, arguments: &[&str]) -> TaskResult {
    eprintln!("xtask packages: cargo {}", arguments.join(" "));
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let status = Command::new(program).args(arguments).current_dir(folder).status()?;
    if status.success() { Ok(()) } else { Err(format!("cargo {} failed", arguments[0]).into()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_published_is_known() {
        let names = published(&workspace_root()).unwrap();
        assert!(["d2m", "d2m-cli", "d2m-lanes"].iter().all(|name| names.iter().any(|found| found == name)));
        assert!(
            !["d2m-testing", "d2m-guide", "xtask"].iter().any(|name| names.iter().any(|found| found == name))
        );
    }
}
