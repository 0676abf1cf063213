//! Meshes from files and from built-in shapes.

mod bytes;
mod obj;
mod ply;
mod polygon;
mod stl;

pub(crate) use bytes::read;
pub(crate) use polygon::PolygonCounts;

use crate::failure::Failure;
use d2m::bvh::{MAX_COORDINATE, MeshError, TriMesh};
use d2m::shapes;
use std::path::Path;

/// A mesh with the name that the user gave it, and how it was read.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) mesh: TriMesh,
    pub(crate) polygons: PolygonCounts,
    pub(crate) precision: Precision,
}

/// What a file holds.
#[derive(Debug, PartialEq)]
struct MeshFile {
    mesh: TriMesh,
    polygons: PolygonCounts,
    precision: Precision,
}

/// How exactly a file states coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Precision {
    /// Doubles, or decimal numbers that are read as the nearest doubles.
    Double,
    /// Single precision, because this kind of file has no more.
    Single(&'static str),
}

/// Loads `shape:…` or a file by its extension.
pub(crate) fn load(source: &str) -> Result<Loaded, Failure> {
    let name = source.to_owned();
    if let Some(text) = source.strip_prefix("shape:") {
        let mesh = shapes::mesh(text).map_err(|error| Failure::Input(error.to_string()))?;
        return Ok(Loaded { name, mesh, polygons: PolygonCounts::default(), precision: Precision::Double });
    }
    let path = Path::new(source);
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let parse: fn(&[u8]) -> Result<MeshFile, LoadError> = match extension.as_str() {
        "obj" => obj::parse,
        "stl" => stl::parse,
        "ply" => ply::parse,
        _ => {
            return Err(Failure::at(source, "unknown kind of mesh: expected .obj, .stl, .ply or shape:NAME"));
        }
    };
    let bytes = read(path)?;
    let MeshFile { mesh, polygons, precision } = parse(&bytes).map_err(|error| match error.line {
        Some(line) => Failure::Input(format!("{source}, line {line}: {}", error.reason)),
        None => Failure::at(source, error.reason),
    })?;
    Ok(Loaded { name, mesh, polygons, precision })
}

/// Why a file holds no usable mesh.
#[derive(Debug, PartialEq)]
struct LoadError {
    /// 1-based, for text.
    line: Option<usize>,
    reason: String,
}

impl LoadError {
    fn new(reason: impl Into<String>) -> Self {
        Self { line: None, reason: reason.into() }
    }

    fn at_line(line: usize, reason: impl Into<String>) -> Self {
        Self { line: Some(line), reason: reason.into() }
    }
}

impl From<MeshError> for LoadError {
    fn from(error: MeshError) -> Self {
        Self::new(error.to_string())
    }
}

/// A coordinate of a text, correctly rounded whatever its number of digits.
fn coordinate(axis: &str, word: Option<&str>) -> Result<f64, String> {
    let word = word.ok_or_else(|| format!("{axis} is missing"))?;
    let value: f64 = word.parse().map_err(|_| format!("{axis} is {}, not a number", excerpt(word)))?;
    // In the words of the file: 1e999 and not infinity.
    if value.is_finite() {
        check_coordinate(axis, value)?;
        Ok(value)
    } else {
        Err(format!("{axis} is {word}, not a finite number"))
    }
}

fn check_coordinate(axis: &str, value: f64) -> Result<(), String> {
    if !value.is_finite() {
        return Err(format!("{axis} is {value}, not a finite number"));
    }
    if value.abs() > MAX_COORDINATE {
        return Err(format!("{axis} is {value:e}, larger than the limit of {MAX_COORDINATE:e}"));
    }
    Ok(())
}

/// Words of a file in quotes, as a message shows them: damaged files have long ones.
fn excerpt(text: &str) -> String {
    const MOST_CHARACTERS: usize = 60;
    match text.char_indices().nth(MOST_CHARACTERS) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}…", &text[..end]),
    }
}

#[cfg(test)]
mod tests;
