//! Meshes made of other meshes and of plain lists.

use super::first_equal::first_at_position;
use crate::{MeshArrays, MeshError, TriMesh};
use d2m_feature::orient3d;
use glam::{DAffine3, DVec3};
use std::cmp::Ordering;

impl TriMesh {
    /// The mesh of triangles that share no vertices ("soup", as in STL files): equal corners become one vertex, so that the mesh
    /// has edges and may be watertight. Triangles keep their order.
    ///
    /// ```
    /// use d2m_mesh::{Topology, TriMesh};
    /// use glam::DVec3;
    /// let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = TriMesh::from_soup(&[[o, y, x], [o, x, z], [o, z, y], [x, y, z]])?;
    /// assert_eq!(mesh.vertex_count(), 4);
    /// assert!(Topology::new(&mesh).is_watertight());
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`TriMesh::try_new`]; vertex 3 k + c is corner c of triangle k in them.
    pub fn from_soup(triangles: &[[DVec3; 3]]) -> Result<Self, MeshError> {
        let count = 3 * triangles.len();
        if count > u32::MAX as usize {
            return Err(MeshError::TooMany { what: "vertices", count });
        }
        let numbers = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        Ok(Self::try_new(triangles.concat(), numbers)?.merged())
    }

    /// Copies a mesh from arrays in single precision, as graphics libraries have them. Every `f32` is a double, so nothing is rounded.
    ///
    /// ```
    /// let mesh = d2m_mesh::TriMesh::try_from_f32(&[[0.1, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]])?;
    /// assert_eq!(mesh.vertices()[0].x, f64::from(0.1_f32));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`TriMesh::try_new`].
    pub fn try_from_f32(vertices: &[[f32; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        let exact = |vertex: &[f32; 3]| DVec3::from_array(vertex.map(f64::from));
        Self::try_new(vertices.iter().map(exact).collect(), triangles.to_vec())
    }

    /// The mesh with equal vertices (−0 = 0) made one: the first of them stays. Vertices are numbered anew, without the others; triangles keep
    /// their order and their corners' places.
    ///
    /// ```
    /// use d2m_mesh::TriMesh;
    /// let twice = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    /// let mesh = TriMesh::from_arrays(&twice, &[[0, 1, 2], [0, 4, 3]])?.merged();
    /// assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 3, 1]]);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn merged(self) -> Self {
        let MeshArrays { vertices, mut triangles } = self.into_arrays();
        let first = first_at_position(&vertices);
        let mut kept = Vec::new();
        let mut number: Vec<u32> = Vec::with_capacity(vertices.len());
        for (vertex, position) in vertices.into_iter().enumerate() {
            let first = first[vertex] as usize;
            if first == vertex {
                number.push(kept.len() as u32);
                kept.push(position);
            } else {
                number.push(number[first]); // the first comes before
            }
        }
        for corner in triangles.iter_mut().flatten() {
            *corner = number[*corner as usize];
        }
        Self::from_checked(MeshArrays { vertices: kept, triangles })
    }

    /// The mesh with every vertex p mapped to M·p + t, in doubles: nearest numbers of products and sums, so a vertex is off the exact image by
    /// at most 4·2⁻⁵³·(|M|·|p| + |t|) an axis (absolute values entry by entry). What comes out is a body of its own, exactly as its
    /// numbers say. Where M mirrors (its determinant, decided exactly, is negative), triangles are turned round, so that the outside stays outside.
    ///
    /// ```
    /// use d2m_mesh::{TriMesh, Validation};
    /// use glam::{DAffine3, DVec3};
    /// let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let mesh = TriMesh::from_soup(&[[o, y, x], [o, x, z], [o, z, y], [x, y, z]])?;
    /// let mirrored = mesh.transformed(&DAffine3::from_scale(DVec3::new(-6.0, 1.0, 1.0)))?;
    /// assert_eq!(Validation::new(&mirrored).signed_volume, 1.0);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// [`MeshError`] with the vertex, where an image is not finite or larger than [`MAX_COORDINATE`](crate::MAX_COORDINATE).
    pub fn transformed(self, map: &DAffine3) -> Result<Self, MeshError> {
        let MeshArrays { mut vertices, mut triangles } = self.into_arrays();
        for vertex in &mut vertices {
            *vertex = map.transform_point3(*vertex);
        }
        if mirrors(map) {
            for [_, b, c] in &mut triangles {
                core::mem::swap(b, c);
            }
        }
        Self::try_new(vertices, triangles)
    }
}

/// Is the determinant of the linear part negative? The sign is exact.
fn mirrors(map: &DAffine3) -> bool {
    let axes = map.matrix3;
    axes.is_finite() && orient3d(DVec3::ZERO, axes.x_axis, axes.y_axis, axes.z_axis) == Ordering::Less
}
