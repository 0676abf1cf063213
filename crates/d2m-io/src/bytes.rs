//! The bytes of an input.

use crate::IoError;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// Most bytes of an input that does not know its length (a pipe, a device): such a one may never end.
const MOST_BYTES: u64 = 1 << 30;

/// The bytes of a file, of which there must be some.
///
/// ```
/// let missing = d2m_io::read_bytes(std::path::Path::new("no-such.stl")).unwrap_err();
/// assert!(missing.to_string().starts_with("no-such.stl: "));
/// ```
///
/// # Errors
/// [`IoError::File`] with the name of the file: it is absent, a folder, not readable or empty, or a pipe or device that
/// gives more than 2³⁰ bytes.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, IoError> {
    let bytes = if path.is_dir() {
        Err(io::Error::new(ErrorKind::IsADirectory, "is a folder, not a file"))
    } else if path.is_file() {
        std::fs::read(path)
    } else {
        File::open(path).and_then(read_unsized)
    };
    let some = bytes.and_then(|bytes| {
        if bytes.is_empty() {
            return Err(io::Error::new(ErrorKind::UnexpectedEof, "the file is empty"));
        }
        Ok(bytes)
    });
    some.map_err(|source| IoError::File { file: path.display().to_string(), source })
}

/// The bytes of an input that does not know its length, at most 2³⁰ of them.
///
/// ```
/// assert_eq!(d2m_io::read_unsized(&b"from a pipe"[..])?, b"from a pipe");
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// Those of the input, and [`ErrorKind::FileTooLarge`] for one that gives more.
pub fn read_unsized(source: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    if source.take(MOST_BYTES + 1).read_to_end(&mut bytes)? as u64 > MOST_BYTES {
        return Err(io::Error::new(ErrorKind::FileTooLarge, format!("more than {MOST_BYTES} bytes")));
    }
    Ok(bytes)
}
