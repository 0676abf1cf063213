//! Why a file could not be used.

use d2m_bvh::MeshError;
use glam::DVec3;
use std::fmt;
use thiserror::Error;

/// Bad input: which file, where in it, what is wrong and the value found.
///
/// ```
/// use d2m_io::{IoError, MeshFormat, ReadOptions, parse_mesh};
/// let fault = parse_mesh(b"v 0 zero 0\n", MeshFormat::Obj, &ReadOptions::new()).unwrap_err();
/// assert!(matches!(fault, IoError::Content { .. }) && fault.to_string().starts_with("line 1: "), "{fault}");
/// ```
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum IoError {
    /// The file cannot be read at all.
    #[error("{file}: {source}")]
    File {
        /// Its name.
        file: String,
        /// Why not.
        source: std::io::Error,
    },
    /// The name does not say what is in the file.
    #[error("{file}: unknown kind of mesh: expected {}", crate::MeshFormat::EXTENSIONS)]
    UnknownFormat {
        /// Its name.
        file: String,
    },
    /// Something in the file is not as its format wants it.
    #[error("{place}{reason}")]
    Content {
        /// Where.
        place: Place,
        /// What, with the value found.
        reason: String,
    },
    /// What was read is no usable mesh.
    #[error("{place}{source}")]
    Mesh {
        /// Which file.
        place: Place,
        /// What is wrong with the mesh.
        source: MeshError,
    },
    /// A scale that would leave nothing of a mesh.
    #[error("scale {:?} has to be finite and not zero", scale.to_array())]
    BadScale {
        /// The factors of the three axes.
        scale: DVec3,
    },
}

/// A file and a part of it, as far as they are known. It is written with a colon behind it, or as nothing.
///
/// ```
/// use d2m_io::Place;
/// let line = Place { line: Some(3), ..Place::default() };
/// assert_eq!(line.to_string(), "line 3: ");
/// assert_eq!(Place { file: Some("cube.obj".into()), ..line }.to_string(), "cube.obj, line 3: ");
/// assert_eq!(Place::default().to_string(), "");
/// ```
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Place {
    /// The name of the file; none for bytes.
    pub file: Option<String>,
    /// The line, from 1; none for binary formats and for what concerns the whole file.
    pub line: Option<usize>,
    /// The item, such as `body 2, scale`; none where a line says it.
    pub item: Option<String>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let line = self.line.map(|line| format!("line {line}"));
        let parts = [self.file.as_deref(), line.as_deref(), self.item.as_deref()];
        let known: Vec<&str> = parts.into_iter().flatten().collect();
        if known.is_empty() { Ok(()) } else { write!(f, "{}: ", known.join(", ")) }
    }
}

impl IoError {
    /// The same fault of bytes that came from a file.
    #[must_use]
    pub fn in_file(self, name: impl Into<String>) -> Self {
        let named = |place: Place| Place { file: Some(name.into()), ..place };
        match self {
            Self::Content { place, reason } => Self::Content { place: named(place), reason },
            Self::Mesh { place, source } => Self::Mesh { place: named(place), source },
            other => other,
        }
    }
}
