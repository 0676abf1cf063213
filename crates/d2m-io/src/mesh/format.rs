//! The kinds of mesh files.

use std::path::Path;

/// A kind of mesh file.
///
/// ```
/// use d2m_io::MeshFormat;
/// assert_eq!(MeshFormat::from_path("part.STL"), Some(MeshFormat::Stl));
/// assert_eq!(MeshFormat::from_path("part.step"), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum MeshFormat {
    /// Wavefront OBJ: text.
    Obj,
    /// STL, text or binary: triangles without shared vertices.
    Stl,
    /// PLY, text or binary.
    Ply,
    /// OFF: text.
    Off,
    /// glTF 2.0: JSON with buffers in it or beside it.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
    /// COLLADA: XML.
    Dae,
    /// 3MF: zipped XML.
    ThreeMf,
}

impl MeshFormat {
    /// All kinds, as messages list them.
    pub const EXTENSIONS: &'static str = ".obj, .stl, .ply, .off, .gltf, .glb, .dae or .3mf";

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
            "off" => Some(Self::Off),
            "gltf" => Some(Self::Gltf),
            "glb" => Some(Self::Glb),
            "dae" => Some(Self::Dae),
            "3mf" => Some(Self::ThreeMf),
            _ => None,
        }
    }

    /// Have triangles of this kind of file vertices of their own where they meet (seams of normals or textures), so that reading merges them?
    pub(super) const fn splits_vertices(self) -> bool {
        matches!(self, Self::Stl | Self::Gltf | Self::Glb)
    }
}
