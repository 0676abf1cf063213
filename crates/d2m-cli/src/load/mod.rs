//! Meshes from files, from saved trees and from built-in shapes.

mod bytes;

pub(crate) use bytes::{named, read};

use crate::failure::Failure;
use crate::inputs;
use crate::output::{note, progress_bar, short};
use d2m::bvh::{MeshTree, TriMesh};
use d2m::shapes::{self, SHAPES};
use d2m_io::{MeshFormat, MeshReport, ReadMesh, ReadOptions, Unit, read_mesh_with};
use std::path::Path;

/// A mesh with the name that the user gave it, and how it was read.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) report: MeshReport,
    /// The unit that the user gave for its numbers.
    pub(crate) unit: Option<Unit>,
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
        Self { name, report: MeshReport::default(), unit: None, geometry }
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

/// Loads `shape:…` or a file by its extension.
pub(crate) fn load(source: &str) -> Result<Loaded, Failure> {
    load_with(source, &ReadOptions::new())
}

/// As [`load`], in the scale and unit that the options state.
pub(crate) fn load_with(source: &str, options: &ReadOptions) -> Result<Loaded, Failure> {
    let name = source.to_owned();
    let resized = |mesh: TriMesh| options.apply(mesh).map_err(|error| Failure::at(source, error));
    if let Some(text) = source.strip_prefix("shape:") {
        let mesh = shapes::mesh(text).map_err(|error| Failure::Input(error.to_string()))?;
        return Ok(Loaded { unit: options.unit, ..Loaded::exact(name, Geometry::Mesh(resized(mesh)?)) });
    }
    let path = Path::new(source);
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("d2mtree")) {
        let tree = MeshTree::try_from_bytes(&read(path)?).map_err(|error| Failure::at(source, error))?;
        let geometry = if *options == ReadOptions::new() {
            Geometry::Tree(Box::new(tree))
        } else {
            Geometry::Mesh(resized(tree.into_mesh())?)
        };
        return Ok(Loaded { unit: options.unit, ..Loaded::exact(name, geometry) });
    }
    if MeshFormat::from_path(path).is_none() {
        let hint = match source.split('?').next() {
            Some(shape) if SHAPES.iter().any(|known| known.name == shape) => {
                format!("; is the built-in shape:{source} meant?")
            }
            _ if path.extension().is_some_and(|extension| extension == "json") => {
                "; scenes are for d2m scene, d2m simulate and d2m view".to_owned()
            }
            _ if source == "-" => "; a mesh is read from a file: its kind is known by its name".to_owned(),
            _ => String::new(),
        };
        let expected = format!("expected {}, .d2mtree or shape:NAME", MeshFormat::EXTENSIONS);
        return Err(Failure::at(source, format!("unknown kind of mesh: {expected}{hint}")));
    }
    let ReadMesh { mesh, report } = read_mesh_with(path, options)?;
    for file in &report.files {
        inputs::remember(file);
    }
    if let (Some(unit), Some(stated)) = (options.unit, report.meters_per_unit)
        && unit.to_meters(1.0) != stated
    {
        let (symbol, stated) = (unit.symbol(), short(stated));
        note(&format!(
            "d2m: warning: {source}: the file states a unit of {stated} m; its numbers are taken as {symbol} all the same"
        ));
    }
    Ok(Loaded { name, report, unit: options.unit, geometry: Geometry::Mesh(mesh) })
}
