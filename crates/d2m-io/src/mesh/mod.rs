//! Meshes from files: the one entry, and what every reader gives.

mod assembly;
mod collada;
mod format;
mod gltf;
mod obj;
mod off;
mod options;
mod ply;
mod polygon;
mod report;
mod stl;
mod strips;
#[cfg(test)]
mod tests;
mod three_mf;
mod xml;

pub use format::MeshFormat;
pub use options::{Merging, ReadOptions, Unit, UnknownUnit};
pub use polygon::PolygonCounts;
pub use report::{MeshReport, Precision, UpAxis};

use crate::bytes::read_bytes;
use crate::{IoError, Place};
use d2m_bvh::{MeshError, TriMesh};
use glam::DVec3;
use std::path::Path;

/// A mesh and how it was read.
///
/// ```
/// use d2m_io::{MeshFormat, ReadMesh, ReadOptions, parse_mesh};
/// let text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let ReadMesh { mesh, report } = parse_mesh(text, MeshFormat::Obj, &ReadOptions::new())?;
/// assert_eq!((mesh.triangle_count(), report.polygons.cut), (2, 1));
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ReadMesh {
    /// The mesh.
    pub mesh: TriMesh,
    /// How exactly it was stated, and what was cut or left out.
    pub report: MeshReport,
}

/// The mesh of a file, by its extension: [`read_mesh_with`] and no options.
///
/// ```
/// let folder = std::env::temp_dir().join(format!("d2m-io-read-mesh-{}", std::process::id()));
/// std::fs::create_dir_all(&folder)?;
/// std::fs::write(folder.join("square.obj"), "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nf 1 2 3 4\n")?;
/// let square = d2m_io::read_mesh(folder.join("square.obj"))?;
/// assert_eq!(square.mesh.triangle_count(), 2);
/// assert_eq!(square.mesh.vertices()[2].x, 0.1, "the nearest double, not the nearest float");
/// assert_eq!(square.report.polygons.cut, 1);
///
/// std::fs::write(folder.join("bad.obj"), "v 0 0 0\nv 0 NaN 0\n")?;
/// let fault = d2m_io::read_mesh(folder.join("bad.obj")).unwrap_err().to_string();
/// assert!(fault.ends_with("bad.obj, line 2: vertex 2: y is NaN, not a finite number"), "{fault}");
/// # std::fs::remove_dir_all(&folder)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IoError`] with the name of the file, its line or index, and the value found.
pub fn read_mesh(path: impl AsRef<Path>) -> Result<ReadMesh, IoError> {
    read_mesh_with(path, &ReadOptions::new())
}

/// The mesh of a file, by its extension, in the scale and unit that the options state.
///
/// ```
/// use d2m_io::{ReadOptions, Unit, read_mesh_with};
/// let file = std::env::temp_dir().join(format!("d2m-io-read-mesh-with-{}.obj", std::process::id()));
/// std::fs::write(&file, "v 0 0 0\nv 254 0 0\nv 0 127 0\nf 1 2 3\n")?;
/// let plate = read_mesh_with(&file, &ReadOptions::new().with_unit(Unit::Millimeter))?;
/// assert_eq!(plate.mesh.vertices()[1].x, 0.254); // metres
/// # std::fs::remove_file(&file)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`IoError`] with the name of the file, its line or index, and the value found.
pub fn read_mesh_with(path: impl AsRef<Path>, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    let path = path.as_ref();
    let name = || path.display().to_string();
    let format = MeshFormat::from_path(path).ok_or_else(|| IoError::UnknownFormat { file: name() })?;
    let bytes = read_bytes(path)?;
    let folder = Some(path.parent().unwrap_or(Path::new("")));
    let read = parse(&Source { bytes: &bytes, folder }, format, options);
    let mut read = read.map_err(|error| error.in_file(name()))?;
    read.report.files.insert(0, path.to_owned());
    Ok(read)
}

/// The mesh that the bytes of a file hold.
///
/// ```
/// use d2m_io::{MeshFormat, ReadOptions, Unit, parse_mesh};
/// let text = b"v 0 0 0\nv 254 0 0\nv 0 127 0\nf 1 2 3\n";
/// let plate = parse_mesh(text, MeshFormat::Obj, &ReadOptions::new().with_unit(Unit::Millimeter))?;
/// assert_eq!(plate.mesh.vertices()[1].x, 0.254);
/// # Ok::<(), d2m_io::IoError>(())
/// ```
///
/// # Errors
/// [`IoError`] with line or index and the value found.
pub fn parse_mesh(bytes: &[u8], format: MeshFormat, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    parse(&Source { bytes, folder: None }, format, options)
}

fn parse(source: &Source<'_>, format: MeshFormat, options: &ReadOptions) -> Result<ReadMesh, IoError> {
    options.check()?;
    let bytes = source.bytes;
    let raw = match format {
        MeshFormat::Obj => obj::parse(bytes),
        MeshFormat::Stl => stl::parse(bytes),
        MeshFormat::Ply => ply::parse(bytes),
        MeshFormat::Off => off::parse(bytes),
        MeshFormat::Gltf | MeshFormat::Glb => gltf::parse(source),
        MeshFormat::Dae => collada::parse(bytes),
        MeshFormat::ThreeMf => three_mf::parse(bytes),
    };
    let RawMesh { vertices, triangles, report } = raw.map_err(Fault::into_error)?;
    let mesh = TriMesh::try_new(vertices, triangles)
        .map_err(|source| IoError::Mesh { place: Place::default(), source })?;
    let merges = match options.merging {
        Merging::Always => true,
        Merging::ByFormat => format.splits_vertices(),
        Merging::Never => false,
    };
    let mesh = if merges { mesh.merged() } else { mesh };
    Ok(ReadMesh { mesh: options.apply_in(report.meters_per_unit, mesh)?, report })
}

/// The bytes of a file, and where the files are that it names.
struct Source<'a> {
    bytes: &'a [u8],
    folder: Option<&'a Path>,
}

/// What a reader gives: lists that are not yet checked.
#[derive(Debug, Default)]
struct RawMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    report: MeshReport,
}

/// Why a file holds no usable mesh.
#[derive(Debug, PartialEq)]
struct Fault {
    /// 1-based, for text.
    line: Option<usize>,
    reason: String,
}

impl Fault {
    fn new(reason: impl Into<String>) -> Self {
        Self { line: None, reason: reason.into() }
    }

    fn at_line(line: usize, reason: impl Into<String>) -> Self {
        Self { line: Some(line), reason: reason.into() }
    }

    fn into_error(self) -> IoError {
        IoError::Content { place: Place { line: self.line, ..Place::default() }, reason: self.reason }
    }
}

impl From<MeshError> for Fault {
    fn from(error: MeshError) -> Self {
        Self::new(error.to_string())
    }
}
