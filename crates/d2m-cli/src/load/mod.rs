//! Meshes from files and from built-in shapes.

mod obj;
mod ply;
mod polygon;
mod stl;

use crate::failure::Failure;
use d2m::bvh::{MeshError, TriMesh};
use d2m::shapes;
use std::path::Path;

/// A mesh with the name that the user gave it.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) mesh: TriMesh,
}

/// Loads `shape:…` or a file by its extension.
pub(crate) fn load(source: &str) -> Result<Loaded, Failure> {
    let name = source.to_owned();
    if let Some(text) = source.strip_prefix("shape:") {
        let mesh = shapes::mesh(text).map_err(|error| Failure::Input(error.to_string()))?;
        return Ok(Loaded { name, mesh });
    }
    let path = Path::new(source);
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let parse: fn(&[u8]) -> Result<TriMesh, LoadError> = match extension.as_str() {
        "obj" => obj::parse,
        "stl" => stl::parse,
        "ply" => ply::parse,
        _ => {
            return Err(Failure::at(source, "unknown kind of mesh: expected .obj, .stl, .ply or shape:NAME"));
        }
    };
    let bytes = read(path)?;
    let mesh = parse(&bytes).map_err(|error| match error.line {
        Some(line) => Failure::Input(format!("{source}, line {line}: {}", error.reason)),
        None => Failure::at(source, error.reason),
    })?;
    Ok(Loaded { name, mesh })
}

/// The bytes of a file that must not be empty.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    if path.is_dir() {
        return Err(Failure::at(path.display(), "is a folder, not a file"));
    }
    let bytes = std::fs::read(path).map_err(|error| Failure::at(path.display(), error))?;
    if bytes.is_empty() {
        return Err(Failure::at(path.display(), "the file is empty"));
    }
    Ok(bytes)
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

#[cfg(test)]
mod tests;
