//! The collision bodies of links.

use crate::packages::resolve;
use crate::urdf::{Origin, UrdfCollision, UrdfShape};
use crate::{RobotError, RobotOptions};
use d2m_bvh::{MeshError, MeshTree, Solid, TriMesh};
use d2m_io::{Merging, ReadOptions, read_mesh_with};
use d2m_shapes::{Fit, Tessellation};
use glam::DVec3;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A mesh (with all that is within a radius of it) in the frame of a link.
#[derive(Debug, Clone)]
pub(crate) struct LinkBody {
    pub(crate) tree: Arc<MeshTree>,
    pub(crate) radius: f64,
    pub(crate) solid: Solid,
    pub(crate) origin: Origin,
    /// Of which file, if it is of one.
    pub(crate) mesh: Option<NamedMesh>,
}

/// A mesh as the URDF names it.
#[derive(Debug, Clone)]
pub(crate) struct NamedMesh {
    pub(crate) name: String,
    pub(crate) scale: DVec3,
}

/// Reads the shapes of links; each mesh file once.
pub(crate) struct ShapeReader<'a> {
    /// Of the URDF.
    pub(crate) file: &'a str,
    pub(crate) folder: &'a Path,
    pub(crate) options: &'a RobotOptions,
    meshes: HashMap<(PathBuf, [u64; 3]), Arc<MeshTree>>,
    /// What has to be said of shapes that are not exact.
    pub(crate) remarks: Vec<String>,
    /// The files of meshes that were read, with those that they name.
    pub(crate) files: Vec<PathBuf>,
}

/// Sides of the prism for a cylinder: it reaches 1/cos(π/96) − 1 = 0.054 % of the radius beyond it.
const SIDES: usize = 96;

fn prism(radius: f64, length: f64) -> Result<Tessellation, MeshError> {
    Tessellation::of_cylinder(radius, length, SIDES, Fit::Enclosing)
}

/// A tree and the radius about it.
struct Shape {
    tree: Arc<MeshTree>,
    radius: f64,
}

impl Shape {
    fn new(mesh: Result<TriMesh, MeshError>, radius: f64) -> Result<Self, MeshError> {
        Ok(Self { tree: Arc::new(MeshTree::new(mesh?)), radius })
    }
}

impl<'a> ShapeReader<'a> {
    pub(crate) fn new(file: &'a str, folder: &'a Path, options: &'a RobotOptions) -> Self {
        Self { file, folder, options, meshes: HashMap::new(), remarks: Vec::new(), files: Vec::new() }
    }

    pub(crate) fn body(&mut self, link: &str, collision: &UrdfCollision) -> Result<LinkBody, RobotError> {
        let UrdfCollision { line, origin, shape } = collision;
        let mesh = match shape {
            UrdfShape::Mesh { file, scale } => Some(NamedMesh { name: file.clone(), scale: *scale }),
            _ => None,
        };
        let shape = match shape {
            UrdfShape::Mesh { file, scale } => {
                Ok(Shape { tree: self.mesh(link, *line, file, *scale)?, radius: 0.0 })
            }
            UrdfShape::Box(size) => Shape::new(cuboid(*size * 0.5), 0.0),
            UrdfShape::Sphere { radius } => Shape::new(segment(0.0), *radius),
            UrdfShape::Capsule { radius, length } => Shape::new(segment(0.5 * length), *radius),
            UrdfShape::Cylinder { radius, length } => prism(*radius, *length).and_then(|prism| {
                let excess = prism.error;
                self.remarks.push(format!(
                    "{}, line {line}: link {link:?}: the cylinder is checked as a prism around it that is larger by at most {excess:.2e}",
                    self.file
                ));
                Shape::new(Ok(prism.mesh), 0.0)
            }),
        };
        let shape = shape.map_err(|source| RobotError::Shape {
            file: self.file.to_owned(),
            line: *line,
            link: link.to_owned(),
            source,
        })?;
        let solid = shape.tree.usual_solid();
        Ok(LinkBody { tree: shape.tree, radius: shape.radius, solid, origin: *origin, mesh })
    }

    fn mesh(&mut self, link: &str, line: u32, name: &str, scale: DVec3) -> Result<Arc<MeshTree>, RobotError> {
        let bits = scale.to_array().map(f64::to_bits);
        if let Some(tree) = self.options.meshes.get(&(name.to_owned(), bits)) {
            return Ok(Arc::clone(tree));
        }
        let path = resolve(name, self.folder, self.options).map_err(|reason| RobotError::Xml {
            file: self.file.to_owned(),
            line,
            reason: format!("link {link:?}: {reason}"),
        })?;
        let key = (path, bits);
        if let Some(tree) = self.meshes.get(&key) {
            return Ok(Arc::clone(tree));
        }
        // Equal vertices are one, whatever the format: else most collision meshes bound no solid.
        let options = ReadOptions::new().with_scale(scale).with_merging(Merging::Always);
        let read = read_mesh_with(&key.0, &options).map_err(|source| RobotError::MeshFile {
            file: self.file.to_owned(),
            line,
            link: link.to_owned(),
            source: Box::new(source),
        })?;
        self.files.extend(read.report.files);
        let tree = Arc::new(MeshTree::new(read.mesh));
        self.meshes.insert(key, Arc::clone(&tree));
        Ok(tree)
    }
}

/// A box about the origin, its corners exactly as given.
fn cuboid(half: DVec3) -> Result<TriMesh, MeshError> {
    let corner = |k: usize| {
        let side = |axis: usize| if k >> axis & 1 == 1 { half[axis] } else { -half[axis] };
        DVec3::new(side(0), side(1), side(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    TriMesh::try_new((0..8).map(corner).collect(), triangles.collect())
}

/// What a capsule is everything near: a segment of the z axis, or a point.
fn segment(half: f64) -> Result<TriMesh, MeshError> {
    TriMesh::try_new(vec![DVec3::Z * -half, DVec3::Z * half], vec![[0, 1, 1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_are_closed_and_outward() {
        let half = DVec3::new(0.1, 0.2, 0.3);
        let tree = MeshTree::new(cuboid(half).unwrap());
        assert!(tree.is_watertight());
        let volume: f64 = (0..12)
            .map(|k| {
                let [a, b, c] = tree.mesh().corners(k);
                a.cross(b).dot(c) / 6.0
            })
            .sum();
        assert!((volume - 8.0 * half.x * half.y * half.z).abs() < 1e-15);
        assert!(tree.mesh().vertices().iter().all(|v| v.abs() == half));
    }
}
