//! How a mesh was read.

use super::PolygonCounts;

/// How exactly a file stated a mesh, and what was cut or left out.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
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
}

/// An axis that points up.
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
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Precision {
    /// Doubles, or decimal numbers that are read as the nearest doubles.
    #[default]
    Double,
    /// Single precision, because this kind of file (named) has no more.
    Single(&'static str),
}
