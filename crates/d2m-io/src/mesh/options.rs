//! What a reader may do to a mesh.

use crate::{IoError, Place};
use d2m_bvh::{MeshArrays, TriMesh};
use glam::DVec3;

/// How a mesh is read.
///
/// ```
/// use d2m_io::{Merging, ReadOptions, Unit};
/// let options = ReadOptions::new().with_unit(Unit::Inch).with_merging(Merging::Always);
/// assert_eq!(options.scale, glam::DVec3::ONE);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ReadOptions {
    /// Factors of the three axes, finite and not zero. An odd number of negative ones mirrors the mesh; its triangles are
    /// turned round then, so that the outside stays outside. Each product is rounded to the nearest double.
    pub scale: DVec3,
    /// The unit of the numbers in the file: lengths are read as meters, correctly rounded from the doubles of the file,
    /// and scaled after that. None: the unit that the file states (COLLADA, 3MF, glTF), or else numbers as they are.
    pub unit: Option<Unit>,
    /// Which equal vertices become one.
    pub merging: Merging,
}

impl ReadOptions {
    /// Numbers as they are in the file.
    pub const fn new() -> Self {
        Self { scale: DVec3::ONE, unit: None, merging: Merging::ByFormat }
    }

    /// With other factors of the three axes.
    #[must_use]
    pub const fn with_scale(self, scale: DVec3) -> Self {
        Self { scale, ..self }
    }

    /// With a unit of the numbers in the file.
    #[must_use]
    pub const fn with_unit(self, unit: Unit) -> Self {
        Self { unit: Some(unit), ..self }
    }

    /// With another choice of the vertices that become one.
    #[must_use]
    pub const fn with_merging(self, merging: Merging) -> Self {
        Self { merging, ..self }
    }

    /// A mesh from elsewhere, whose numbers are in the stated unit, in meters and scaled.
    ///
    /// ```
    /// use d2m_io::{ReadOptions, Unit};
    /// let cube = d2m_shapes::mesh("box?x=10&y=10&z=10").unwrap();
    /// let small = ReadOptions::new().with_unit(Unit::Millimeter).apply(cube)?;
    /// assert_eq!(small.vertices()[0].abs().x, 0.01); // half of the box
    /// # Ok::<(), d2m_io::IoError>(())
    /// ```
    ///
    /// # Errors
    /// [`IoError::BadScale`], and [`IoError::Mesh`] for a vertex that becomes too large.
    pub fn apply(&self, mesh: TriMesh) -> Result<TriMesh, IoError> {
        self.apply_in(None, mesh)
    }

    pub(super) fn check(&self) -> Result<(), IoError> {
        let is_usable = self.scale.is_finite() && self.scale.abs().min_element() > 0.0;
        if is_usable { Ok(()) } else { Err(IoError::BadScale { scale: self.scale }) }
    }

    /// As [`Self::apply`]; `stated`: the meters of a unit of the file.
    pub(super) fn apply_in(&self, stated: Option<f64>, mesh: TriMesh) -> Result<TriMesh, IoError> {
        self.check()?;
        let meters = stated.unwrap_or(1.0);
        if self.unit.unwrap_or(Unit::Meter) == Unit::Meter && meters == 1.0 && self.scale == DVec3::ONE {
            return Ok(mesh);
        }
        // A thousandth is no double, a thousand is: the quotient is rounded once.
        let parts = (1.0 / meters).round();
        let in_meters = |x: f64| match self.unit {
            Some(unit) => unit.to_meters(x),
            None if parts * meters == 1.0 => x / parts,
            None => x * meters,
        };
        let MeshArrays { mut vertices, mut triangles } = mesh.into_arrays();
        for vertex in &mut vertices {
            *vertex = vertex.map(in_meters) * self.scale;
        }
        if self.scale.is_negative_bitmask().count_ones() % 2 == 1 {
            for [_, b, c] in &mut triangles {
                std::mem::swap(b, c);
            }
        }
        TriMesh::try_new(vertices, triangles)
            .map_err(|source| IoError::Mesh { place: Place::default(), source })
    }
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self::new()
    }
}

/// Which vertices at the same place become one.
///
/// ```
/// use d2m_io::{MeshFormat, Merging, ReadOptions, parse_mesh};
/// // Two triangles that repeat the vertices of the side between them.
/// let text = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
/// let vertices = |merging| {
///     let options = ReadOptions::new().with_merging(merging);
///     parse_mesh(text, MeshFormat::Obj, &options).map(|read| read.mesh.vertex_count())
/// };
/// assert_eq!((vertices(Merging::ByFormat)?, vertices(Merging::Always)?), (6, 4));
/// # Ok::<(), d2m_io::IoError>(())
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Merging {
    /// Those of formats that share no vertices (STL) or split them at seams (glTF), so that the mesh has a topology; elsewhere vertices keep the numbers of the file.
    #[default]
    ByFormat,
    /// Those of every format.
    Always,
    /// None.
    Never,
}

/// A unit of length.
///
/// ```
/// use d2m_io::Unit;
/// assert_eq!("mm".parse(), Ok(Unit::Millimeter));
/// assert_eq!(Unit::Millimeter.to_meters(3.0), 0.003);
/// assert_eq!(Unit::Inch.to_meters(10.0), 0.254);
/// assert_eq!("ft".parse::<Unit>().unwrap_err().to_string(), "\"ft\" is not a unit of length: mm, cm, m or in");
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Unit {
    /// mm
    Millimeter,
    /// cm
    Centimeter,
    /// m
    Meter,
    /// in: 25.4 mm
    Inch,
}

impl Unit {
    /// A length in meters: of millimeters and centimeters the correctly rounded quotient, of inches within one unit in the last place.
    pub fn to_meters(self, length: f64) -> f64 {
        match self {
            Self::Millimeter => length / 1000.0,
            Self::Centimeter => length / 100.0,
            Self::Meter => length,
            // 0.0254 is no double: dividing by the whole numbers 5000 and 127 rounds twice, each by half a unit.
            Self::Inch => length * 127.0 / 5000.0,
        }
    }

    /// The symbol.
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Millimeter => "mm",
            Self::Centimeter => "cm",
            Self::Meter => "m",
            Self::Inch => "in",
        }
    }
}

/// A text that is no unit.
///
/// ```
/// let error = "furlong".parse::<d2m_io::Unit>().unwrap_err();
/// assert!(error.to_string().contains("furlong") && error.to_string().ends_with("mm, cm, m or in"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{} is not a unit of length: mm, cm, m or in", crate::excerpt(.0))]
pub struct UnknownUnit(
    /// The text.
    pub String,
);

impl std::str::FromStr for Unit {
    type Err = UnknownUnit;

    fn from_str(text: &str) -> Result<Self, UnknownUnit> {
        let all = [Self::Millimeter, Self::Centimeter, Self::Meter, Self::Inch];
        all.into_iter().find(|unit| unit.symbol() == text).ok_or_else(|| UnknownUnit(text.to_owned()))
    }
}
