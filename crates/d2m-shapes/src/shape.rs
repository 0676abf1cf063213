//! A shape with its parameters, and its text form.

use crate::catalog::{COMMON, Parameter, SHAPES, ShapeInfo};
use crate::error::ShapeError;
use crate::values::Values;
use d2m_mesh::TriMesh;
use std::fmt;
use std::str::FromStr;

/// A shape with its parameters, not yet built.
///
/// ```
/// use d2m_shapes::Shape;
///
/// let gear: Shape = "gear?teeth=24&triangles=1000".parse()?;
/// assert_eq!(gear.to_string(), "gear?triangles=1000&teeth=24");
/// let finer = gear.with("triangles", 100_000.0)?;
/// assert!(finer.build().triangle_count() > 90_000);
/// # Ok::<(), d2m_shapes::ShapeError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Shape {
    info: &'static ShapeInfo,
    given: Vec<Option<f64>>,
}

/// Other names under which shapes are looked for.
const OTHER_NAMES: [(&str, &str); 10] = [
    ("cube", "box"),
    ("cuboid", "box"),
    ("sphere", "icosphere"),
    ("ball", "icosphere"),
    ("cylinder", "shaft"),
    ("ring", "torus"),
    ("knot", "torus-knot"),
    ("link", "chain-link"),
    ("bolt", "screw"),
    ("plane", "plate"),
];

/// The shape that somebody who wrote this name probably wants: it is called so elsewhere, or a third of its letters is wrong.
fn meant(name: &str) -> Option<&'static str> {
    let other =
        OTHER_NAMES.iter().find(|(other, _)| other.eq_ignore_ascii_case(name)).map(|&(_, shape)| shape);
    let mistakes = |shape: &str| strsim::damerau_levenshtein(shape, &name.to_ascii_lowercase());
    let nearest = || SHAPES.iter().map(|info| info.name).min_by_key(|shape| mistakes(shape));
    other.or_else(|| nearest().filter(|shape| 3 * mistakes(shape) <= shape.len()))
}

impl Shape {
    /// The shape of that name with default parameters.
    ///
    /// # Errors
    /// [`ShapeError::UnknownShape`], which lists the known ones.
    pub fn new(name: &str) -> Result<Self, ShapeError> {
        let info = SHAPES.iter().find(|info| info.name == name).ok_or_else(|| ShapeError::UnknownShape {
            name: name.to_owned(),
            meant: meant(name),
            known: join(SHAPES.iter().map(|info| info.name)),
        })?;
        Ok(Self { info, given: vec![None; info.parameters.len() + COMMON.len()] })
    }

    /// With another value of a parameter.
    ///
    /// # Errors
    /// The parameter does not exist or the value is out of its range.
    pub fn with(mut self, name: &str, value: f64) -> Result<Self, ShapeError> {
        let slot = self.slot(name)?;
        self.set(slot, value)?;
        self.check()?;
        Ok(self)
    }

    /// What kind of shape it is.
    pub fn info(&self) -> &'static ShapeInfo {
        self.info
    }

    /// The value of a parameter; none if the shape has no such parameter.
    pub fn value(&self, name: &str) -> Option<f64> {
        Some(self.value_in(self.slot(name).ok()?))
    }

    fn value_in(&self, slot: usize) -> f64 {
        self.given[slot].unwrap_or(self.parameter(slot).default)
    }

    /// Makes the mesh.
    pub fn build(&self) -> TriMesh {
        let names = self.parameters().map(|parameter| parameter.name).enumerate();
        let values = Values(names.map(|(slot, name)| (name, self.value_in(slot))).collect());
        let surface = (self.info.build)(&values);
        let scale = values.get("scale");
        if scale == 1.0 { surface.into_mesh() } else { surface.scaled(scale).into_mesh() }
    }

    /// The shape's own parameters, then the common ones.
    fn parameters(&self) -> impl Iterator<Item = &'static Parameter> + use<> {
        self.info.parameters.iter().chain(COMMON)
    }

    fn parameter(&self, slot: usize) -> &'static Parameter {
        let own = self.info.parameters;
        if slot < own.len() { &own[slot] } else { &COMMON[slot - own.len()] }
    }

    fn slot(&self, name: &str) -> Result<usize, ShapeError> {
        self.parameters().position(|parameter| parameter.name == name).ok_or_else(|| {
            ShapeError::UnknownParameter {
                shape: self.info.name,
                name: name.to_owned(),
                known: join(self.parameters().map(|parameter| parameter.name)),
            }
        })
    }

    fn set(&mut self, slot: usize, value: f64) -> Result<(), ShapeError> {
        let &Parameter { name, low, high, integer, .. } = self.parameter(slot);
        if !(low..=high).contains(&value) || (integer && value.fract() != 0.0) {
            return Err(ShapeError::OutOfRange { shape: self.info.name, name, value, low, high, integer });
        }
        self.given[slot] = Some(value);
        Ok(())
    }

    /// What ranges alone cannot say.
    fn check(&self) -> Result<(), ShapeError> {
        let conflict = |reason: String| Err(ShapeError::Conflict { shape: self.info.name, reason });
        if self.info.name == "torus-knot" {
            let [p, q, tube] = ["p", "q", "tube"].map(|name| self.value(name).unwrap_or(1.0));
            let (mut larger, mut smaller) = (p as u32, q as u32);
            while smaller != 0 {
                (larger, smaller) = (smaller, larger % smaller);
            }
            if larger != 1 {
                return conflict(format!("p={p} and q={q} have the common divisor {larger}"));
            }
            let limit = (0.9 / p.max(q)).min(0.45);
            if tube > limit {
                return conflict(format!("tube={tube} is too thick for p={p}, q={q}: at most {limit:.4}"));
            }
        }
        Ok(())
    }
}

/// Reads `name` or `name?parameter=value&parameter=value`.
impl FromStr for Shape {
    type Err = ShapeError;

    fn from_str(text: &str) -> Result<Self, ShapeError> {
        let (name, query) = text.split_once('?').unwrap_or((text, ""));
        let mut shape = Self::new(name)?;
        for part in query.split('&').filter(|part| !part.is_empty()) {
            let Some((name, text)) = part.split_once('=') else {
                return Err(ShapeError::MissingValue { shape: shape.info.name, text: part.to_owned() });
            };
            let slot = shape.slot(name)?;
            let name = shape.parameter(slot).name;
            if shape.given[slot].is_some() {
                return Err(ShapeError::GivenTwice { shape: shape.info.name, name });
            }
            let not_a_number =
                |_| ShapeError::NotANumber { shape: shape.info.name, name, text: text.to_owned() };
            let value = text.parse().map_err(not_a_number)?;
            shape.set(slot, value)?;
        }
        shape.check()?;
        Ok(shape)
    }
}

/// The text form, with the given parameters only.
impl fmt::Display for Shape {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.info.name)?;
        let mut separator = '?';
        for (parameter, value) in self.parameters().zip(&self.given) {
            if let Some(value) = value {
                write!(formatter, "{separator}{}={value}", parameter.name)?;
                separator = '&';
            }
        }
        Ok(())
    }
}

/// The mesh of a shape's text form, such as `torus-knot?triangles=70000`.
///
/// ```
/// let ring = d2m_shapes::mesh("torus?triangles=1000&tube=0.2")?;
/// assert!(ring.triangle_count() > 900 && ring.triangle_count() < 1100);
/// # Ok::<(), d2m_shapes::ShapeError>(())
/// ```
///
/// # Errors
/// [`ShapeError`]: no such shape or parameter, a value that is no number or out of range.
pub fn mesh(text: &str) -> Result<TriMesh, ShapeError> {
    Ok(text.parse::<Shape>()?.build())
}

fn join<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
