//! The files that the command has read: no result replaces one of them.
//!
//! A process answers one command, and all that it reads is remembered here, also what files name in turn: meshes of scenes and robots, buffers of
//! meshes. So no command can forget one of its inputs.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

static READ: Mutex<Vec<FileIdentity>> = Mutex::new(Vec::new());

/// What tells two files apart, whatever they are called.
#[derive(Debug, Clone, PartialEq, Eq)]
struct FileIdentity {
    path: PathBuf,
    /// The device and the number of the file on it: hard links have the same.
    #[cfg(unix)]
    number: [u64; 2],
}

impl FileIdentity {
    /// Of a file that is there; pipes and devices hold nothing that could be lost.
    fn of(path: &Path) -> Option<Self> {
        let path = path.canonicalize().ok()?;
        let metadata = path.metadata().ok().filter(std::fs::Metadata::is_file)?;
        #[cfg(unix)]
        let number =
            [std::os::unix::fs::MetadataExt::dev(&metadata), std::os::unix::fs::MetadataExt::ino(&metadata)];
        #[cfg(not(unix))]
        let _ = metadata;
        Some(Self {
            path,
            #[cfg(unix)]
            number,
        })
    }

    fn is_same(&self, other: &Self) -> bool {
        #[cfg(unix)]
        if self.number == other.number {
            return true;
        }
        self.path == other.path
    }
}

/// Remembers that a file is read.
pub(crate) fn remember(path: &Path) {
    if let Some(file) = FileIdentity::of(path) {
        let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
        if !read.contains(&file) {
            read.push(file);
        }
    }
}

/// Was this file read, perhaps by another name?
pub(crate) fn was_read(path: &Path) -> bool {
    let read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    FileIdentity::of(path).is_some_and(|file| read.iter().any(|other| other.is_same(&file)))
}
