//! What lies at the root of the repository is meant to lie there.
use std::fs;
use std::path::Path;

const FILES: [&str; 13] = [
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "SECURITY.md",
    "deny.toml",
    "rust-toolchain.toml",
    "rustfmt.toml",
];

/// One finding for each file beside these; those that begin with a dot are tools' own.
pub(super) fn check(root: &Path) -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let mut findings = Vec::new();
    for entry in fs::read_dir(root)? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        if entry.file_type()?.is_file() && !name.starts_with('.') && !FILES.contains(&name.as_str()) {
            findings.push(format!("{name}: is this file meant to lie at the root of the repository?"));
        }
    }
    Ok(findings)
}
