//! Files of motions.

use crate::{IoError, parse_json, read_bytes};
use d2m_motion::AnyMotion;
use std::path::Path;

/// The motion of a JSON file: a constant twist, keyframes or a chain of joints, in the forms of [`AnyMotion`].
///
/// ```
/// use d2m_motion::RigidMotion;
/// let path = std::env::temp_dir().join(format!("d2m-io-motion-{}.json", std::process::id()));
/// std::fs::write(&path, r#"{"times": [0, 2], "poses": [{}, {"x": [1, 0, 0]}]}"#)?;
/// let motion = d2m_io::read_motion(&path)?;
/// assert_eq!(motion.domain().hi(), 2.0);
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IoError`] with the name of the file, line and column or index, and the value found.
pub fn read_motion(path: impl AsRef<Path>) -> Result<AnyMotion, IoError> {
    let path = path.as_ref();
    parse_json(&read_bytes(path)?).map_err(|error| error.in_file(path.display().to_string()))
}
