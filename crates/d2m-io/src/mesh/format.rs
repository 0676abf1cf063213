//! The kinds of mesh files.

use std::path::Path;

/// A kind of mesh file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Wavefront OBJ: text.
    Obj,
    /// STL, text or binary: triangles without shared vertices.
    Stl,
    /// PLY, text or binary.
    Ply,
}

impl MeshFormat {
    /// All kinds, as messages list them.
    pub const EXTENSIONS: &'static str = ".obj, .stl or .ply";

    /// The kind that a file's extension states, in upper or lower case.
    ///
    /// ```
    /// use d2m_io::MeshFormat;
    /// assert_eq!(MeshFormat::from_path("part.STL"), Some(MeshFormat::Stl));
    /// assert_eq!(MeshFormat::from_path("part.txt"), None);
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let extension = path.as_ref().extension()?.to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            "ply" => Some(Self::Ply),
            _ => None,
        }
    }
}
