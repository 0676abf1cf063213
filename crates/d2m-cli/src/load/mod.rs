//! Meshes from files, from saved trees and from built-in shapes.

mod bytes;

pub(crate) use bytes::read;

use crate::failure::Failure;
use crate::output::progress_bar;
use d2m::bvh::{MeshArrays, MeshError, MeshTree, TriMesh};
use d2m::shapes;
use d2m_io::{MeshFormat, MeshReport, ReadMesh, read_mesh};
use glam::DVec3;
use std::path::Path;

/// A mesh with the name that the user gave it, and how it was read.
#[derive(Debug)]
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) report: MeshReport,
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
        Self { name, report: MeshReport::default(), geometry }
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
        let Self { name, report, geometry } = self;
        let MeshArrays { vertices, triangles } = geometry.into_mesh().into_arrays();
        let is_mirrored = scale.is_negative_bitmask().count_ones() % 2 == 1;
        let turn = |[a, b, c]: [u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let vertices = vertices.into_iter().map(|vertex| vertex * scale).collect();
        let mesh = TriMesh::try_new(vertices, triangles.into_iter().map(turn).collect())?;
        Ok(Self { name, report, geometry: Geometry::Mesh(mesh) })
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
    let name = source.to_owned();
    if let Some(text) = source.strip_prefix("shape:") {
        let mesh = shapes::mesh(text).map_err(|error| Failure::Input(error.to_string()))?;
        return Ok(Loaded::exact(name, Geometry::Mesh(mesh)));
    }
    let path = Path::new(source);
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("d2mtree")) {
        let tree = MeshTree::try_from_bytes(&read(path)?).map_err(|error| Failure::at(source, error))?;
        return Ok(Loaded::exact(name, Geometry::Tree(Box::new(tree))));
    }
    if MeshFormat::from_path(path).is_none() {
        let expected = format!("expected {}, .d2mtree or shape:NAME", MeshFormat::EXTENSIONS);
        return Err(Failure::at(source, format!("unknown kind of mesh: {expected}")));
    }
    let ReadMesh { mesh, report } = read_mesh(path)?;
    Ok(Loaded { name, report, geometry: Geometry::Mesh(mesh) })
}
