//! Copies of the workspace in target/mutants, in which sources may be spoilt.
use super::Error;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The copy; what is built of it lies beside it.
pub(super) struct Copy {
    pub(super) root: PathBuf,
    pub(super) build: PathBuf,
}

impl Copy {
    /// Brings the copy of a worker up to date; the files of `texts` get these.
    pub(super) fn new(source: &Path, worker: usize, texts: &BTreeMap<String, String>) -> Result<Self, Error> {
        let base = source.join(format!("target/mutants/{worker}"));
        let copy = Self { root: base.join("workspace"), build: base.join("build") };
        let files = listed(source)?;
        for file in &files {
            match texts.get(file) {
                Some(text) => copy.write(file, text.as_bytes())?,
                None => copy.write(file, &fs::read(source.join(file))?)?,
            }
        }
        remove_others(&copy.root, &copy.root, &files)?;
        Ok(copy)
    }

    /// Writes a file. One that is the same already keeps its time, so that cargo need not build again.
    pub(super) fn write(&self, file: &str, wanted: &[u8]) -> std::io::Result<()> {
        let to = self.root.join(file);
        if fs::read(&to).is_ok_and(|found| found == wanted) {
            return Ok(());
        }
        fs::create_dir_all(to.parent().unwrap_or(&self.root))?;
        fs::write(to, wanted)
    }
}

/// The files of the project, those not yet committed included.
fn listed(source: &Path) -> Result<BTreeSet<String>, Error> {
    let output = Command::new("git")
        .args(["ls-files", "-z", "--cached", "--others", "--exclude-standard"])
        .current_dir(source)
        .output()
        .map_err(|e| format!("git: {e}"))?;
    if !output.status.success() {
        return Err(format!("git ls-files: {}", String::from_utf8_lossy(&output.stderr)).into());
    }
    let text = String::from_utf8(output.stdout)?;
    let files = text.split('\0').filter(|file| !file.is_empty() && source.join(file).is_file());
    Ok(files.map(String::from).collect())
}

/// Removes what an older copy held and the project no longer does.
fn remove_others(root: &Path, folder: &Path, files: &BTreeSet<String>) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            remove_others(root, &path, files)?;
        } else {
            let name = path.strip_prefix(root).unwrap_or(&path).display().to_string().replace('\\', "/");
            if !files.contains(&name) {
                fs::remove_file(&path)?;
            }
        }
    }
    Ok(())
}
