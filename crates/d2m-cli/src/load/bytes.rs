//! The bytes of an input.

use crate::failure::Failure;
use crate::inputs;
use d2m_io::{read_bytes, read_unsized};
use std::io;
use std::path::Path;

/// How messages name an input.
pub(crate) fn named(path: &Path) -> String {
    if path == Path::new("-") { STANDARD_INPUT.to_owned() } else { path.display().to_string() }
}

const STANDARD_INPUT: &str = "standard input";

/// The bytes of a file, or of standard input for `-`; there must be some.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    if path != Path::new("-") {
        inputs::remember(path);
        return Ok(read_bytes(path)?);
    }
    // It may be a file that the shell opened.
    inputs::remember(Path::new("/dev/stdin"));
    let bytes = read_unsized(io::stdin().lock()).map_err(|error| Failure::at(STANDARD_INPUT, error))?;
    if bytes.is_empty() { Err(Failure::at(STANDARD_INPUT, "is empty")) } else { Ok(bytes) }
}
