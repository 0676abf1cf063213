//! The bytes of an input.

use crate::failure::Failure;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Most bytes of an input that does not know its length (a pipe, a device): such a one may never end.
const MOST_BYTES: u64 = 1 << 30;

/// The bytes of a file, or of standard input for `-`; there must be some.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let is_stdin = path == Path::new("-");
    let place = if is_stdin { "standard input".to_owned() } else { path.display().to_string() };
    if path.is_dir() {
        return Err(Failure::at(place, "is a folder, not a file"));
    }
    let bytes = if is_stdin {
        read_bounded(io::stdin().lock())
    } else if path.is_file() {
        std::fs::read(path)
    } else {
        File::open(path).and_then(read_bounded)
    };
    let bytes = bytes.map_err(|error| Failure::at(&place, error))?;
    if bytes.is_empty() {
        let what = if is_stdin { "is empty" } else { "the file is empty" };
        return Err(Failure::at(place, what));
    }
    Ok(bytes)
}

fn read_bounded(source: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if source.take(MOST_BYTES + 1).read_to_end(&mut bytes)? as u64 > MOST_BYTES {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("more than {MOST_BYTES} bytes")));
    }
    Ok(bytes)
}
