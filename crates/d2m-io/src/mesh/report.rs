//! How a mesh was read.

use super::PolygonCounts;
use std::path::PathBuf;

/// How exactly a file stated a mesh, and what was cut or left out.
///
/// ```
/// use d2m_io::{MeshFormat, Precision, ReadOptions, parse_mesh};
/// let square = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
/// let report = parse_mesh(square, MeshFormat::Obj, &ReadOptions::new())?.report;
/// assert_eq!((report.polygons.cut, report.precision, report.up_axis), (1, Precision::Double, None));
/// assert!(report.files.is_empty(), "it was read from bytes");
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct MeshReport {
    /// The polygons that were cut into triangles.
    pub polygons: PolygonCounts,
    /// How exactly coordinates were stated.
    pub precision: Precision,
    /// The meters of one unit of the file, where it states its unit: lengths were read as meters, unless the options say otherwise.
    pub meters_per_unit: Option<f64>,
    /// The axis that the file calls "up". Nothing is turned for it.
    pub up_axis: Option<UpAxis>,
    /// The files that were read: the one that was asked for, then those that it names, as buffers of glTF.
    pub files: Vec<PathBuf>,
}

/// An axis that points up.
///
/// ```
/// use d2m_io::{MeshFormat, ReadOptions, parse_mesh};
/// // An OBJ file does not say what is up.
/// let report = parse_mesh(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", MeshFormat::Obj, &ReadOptions::new())?.report;
/// assert_eq!(report.up_axis, None);
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum UpAxis {
    /// x
    X,
    /// y
    Y,
    /// z
    Z,
}

/// How exactly a file states coordinates.
///
/// ```
/// use d2m_io::{MeshFormat, Precision, ReadOptions, parse_mesh};
/// let text = b"v 0 0 0\nv 0.1 0 0\nv 0 1 0\nf 1 2 3\n";
/// assert_eq!(parse_mesh(text, MeshFormat::Obj, &ReadOptions::new())?.report.precision, Precision::Double);
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Precision {
    /// Doubles, or decimal numbers that are read as the nearest doubles.
    #[default]
    Double,
    /// Single precision, because this kind of file (named) has no more.
    Single(&'static str),
}
