//! Meshes from files, from saved trees and from built-in shapes.

mod bytes;
mod obj;
mod ply;
mod polygon;
mod stl;

pub(crate) use bytes::read;
pub(crate) use polygon::PolygonCounts;

use crate::failure::Failure;
use crate::output::progress_bar;
use d2m::bvh::{MAX_COORDINATE, MeshArrays, MeshError, MeshTree, TriMesh};
use d2m::shapes;
use glam::DVec3;
use std::path::Path;

/// A mesh with the name that the user gave it, and how it was read.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) polygons: PolygonCounts,
    pub(crate) precision: Precision,
    geometry: Geometry,
}

/// What an argument names.
#[derive(Debug)]
enum Geometry {
    Mesh(TriMesh),
    Tree(Box<MeshTree>),
}

impl Geometry {
    fn into_mesh(self) -> TriMesh {
        match self {
            Self::Mesh(mesh) => mesh,
            Self::Tree(tree) => tree.into_mesh(),
        }
    }
}

impl Loaded {
    fn exact(name: String, geometry: Geometry) -> Self {
        Self { name, polygons: PolygonCounts::default(), precision: Precision::Double, geometry }
    }

    /// The mesh, as it is numbered in its file.
    pub(crate) fn mesh(&self) -> &TriMesh {
        match &self.geometry {
            Geometry::Mesh(mesh) => mesh,
            Geometry::Tree(tree) => tree.mesh(),
        }
    }

    /// The mesh alone.
    pub(crate) fn into_mesh(self) -> TriMesh {
        self.geometry.into_mesh()
    }

    /// The mesh with each axis scaled. Mirrored triangles are turned round, so that the outside stays outside.
    pub(crate) fn scaled(self, scale: DVec3) -> Result<Self, MeshError> {
        if scale == DVec3::ONE {
            return Ok(self);
        }
        let Self { name, polygons, precision, geometry } = self;
        let MeshArrays { vertices, triangles } = geometry.into_mesh().into_arrays();
        let is_mirrored = scale.is_negative_bitmask().count_ones() % 2 == 1;
        let turn = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let vertices = vertices.into_iter().map(|vertex| vertex * scale).collect();
        let mesh = TriMesh::try_new(vertices, triangles.into_iter().map(turn).collect())?;
        Ok(Self { name, polygons, precision, geometry: Geometry::Mesh(mesh) })
    }

    /// The mesh with its tree, built if the file holds none. What takes a second or more shows how far it is.
    pub(crate) fn into_tree(self) -> MeshTree {
        const LARGE: usize = 500_000;
        match self.geometry {
            Geometry::Tree(tree) => *tree,
            Geometry::Mesh(mesh) if mesh.triangle_count() < LARGE => MeshTree::new(mesh),
            Geometry::Mesh(mesh) => {
                let bar = progress_bar(mesh.triangle_count(), "triangles in the tree");
                let tree = MeshTree::with_progress(mesh, &|done, _| bar.set_position(done as u64));
                bar.finish_and_clear();
                tree
            }
        }
    }
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
        return Ok(Loaded::exact(name, Geometry::Mesh(mesh)));
    }
    let path = Path::new(source);
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let parse: fn(&[u8]) -> Result<MeshFile, LoadError> = match extension.as_str() {
        "obj" => obj::parse,
        "stl" => stl::parse,
        "ply" => ply::parse,
        "d2mtree" => {
            let tree = MeshTree::try_from_bytes(&read(path)?).map_err(|error| Failure::at(source, error))?;
            return Ok(Loaded::exact(name, Geometry::Tree(Box::new(tree))));
        }
        _ => {
            let expected = "expected .obj, .stl, .ply, .d2mtree or shape:NAME";
            return Err(Failure::at(source, format!("unknown kind of mesh: {expected}")));
        }
    };
    let bytes = read(path)?;
    let MeshFile { mesh, polygons, precision } = parse(&bytes).map_err(|error| match error.line {
        Some(line) => Failure::Input(format!("{source}, line {line}: {}", error.reason)),
        None => Failure::at(source, error.reason),
    })?;
    Ok(Loaded { name, polygons, precision, geometry: Geometry::Mesh(mesh) })
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
        Err(format!("{axis} is {}, not a finite number", excerpt(word).trim_matches('"')))
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
pub(crate) fn excerpt(text: &str) -> String {
    const MOST_CHARACTERS: usize = 60;
    match text.char_indices().nth(MOST_CHARACTERS) {
        None => format!("{text:?}"),
        Some((end, _)) => format!("{:?}…", &text[..end]),
    }
}

#[cfg(test)]
mod tests;
