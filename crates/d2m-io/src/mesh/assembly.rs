//! Meshes put together from parts that are placed by maps, one part perhaps many times.

use super::{Fault, RawMesh};
use d2m_bvh::{MeshArrays, TriMesh};
use glam::{DAffine3, DMat3, DVec3};

/// Vertices and triangles that any file may ask for by naming a part again and again, besides those that its bytes may hold:
/// files that name each other ten times over ten levels would otherwise fill any memory.
const MOST_COPIES: usize = 1 << 25;

/// Elements that may still be made.
#[derive(Debug)]
pub(super) struct Allowance {
    left: usize,
    all: usize,
}

impl Allowance {
    /// For a file of a number of bytes.
    pub(super) fn new(bytes: usize) -> Self {
        let all = bytes.saturating_add(MOST_COPIES);
        Self { left: all, all }
    }

    /// Takes some of what is left.
    pub(super) fn spend(&mut self, count: usize) -> Result<(), Fault> {
        match self.left.checked_sub(count) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(Fault::new(format!(
                "its parts are used so often that more than {} vertices and triangles would come of it",
                self.all
            ))),
        }
    }
}

/// The parts placed so far.
#[derive(Debug)]
pub(super) struct Assembly {
    pub(super) allowance: Allowance,
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Assembly {
    /// Nothing yet, of a file of a number of bytes.
    pub(super) fn new(bytes: usize) -> Self {
        Self { allowance: Allowance::new(bytes), vertices: Vec::new(), triangles: Vec::new() }
    }

    /// Adds a part in its place.
    pub(super) fn add(&mut self, part: &TriMesh, map: &DAffine3) -> Result<(), Fault> {
        self.allowance.spend(part.vertex_count() + part.triangle_count())?;
        let placed = if *map == DAffine3::IDENTITY { part.clone() } else { part.clone().transformed(map)? };
        let MeshArrays { vertices, triangles } = placed.into_arrays();
        let first = self.vertices.len();
        if first + vertices.len() > u32::MAX as usize {
            return Err(Fault::new("more vertices than numbers of 32 bits can count"));
        }
        self.vertices.extend(vertices);
        self.triangles.extend(triangles.into_iter().map(|corners| corners.map(|index| index + first as u32)));
        Ok(())
    }

    /// What was put together.
    pub(super) fn finish(self) -> RawMesh {
        RawMesh { vertices: self.vertices, triangles: self.triangles, ..RawMesh::default() }
    }
}

/// The map with these columns and this translation.
pub(super) fn affine([x, y, z, translation]: [[f64; 3]; 4]) -> DAffine3 {
    let columns = DMat3::from_cols(DVec3::from_array(x), DVec3::from_array(y), DVec3::from_array(z));
    DAffine3::from_mat3_translation(columns, DVec3::from_array(translation))
}
