//! How a mesh was read.

use super::PolygonCounts;

/// How exactly a file stated a mesh, and what was cut or left out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MeshReport {
    /// The polygons that were cut into triangles.
    pub polygons: PolygonCounts,
    /// How exactly coordinates were stated.
    pub precision: Precision,
}

/// How exactly a file states coordinates.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Precision {
    /// Doubles, or decimal numbers that are read as the nearest doubles.
    #[default]
    Double,
    /// Single precision, because this kind of file (named) has no more.
    Single(&'static str),
}
