//! The bytes of an input.

use crate::failure::Failure;
use d2m_io::{read_bytes, read_unsized};
use std::io;
use std::path::Path;

/// The bytes of a file, or of standard input for `-`; there must be some.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    if path != Path::new("-") {
        return Ok(read_bytes(path)?);
    }
    let place = "standard input";
    let bytes = read_unsized(io::stdin().lock()).map_err(|error| Failure::at(place, error))?;
    if bytes.is_empty() { Err(Failure::at(place, "is empty")) } else { Ok(bytes) }
}
