//! Vertices and triangles while a shape is being built.

use d2m_mesh::TriMesh;
use glam::DVec3;

/// A surface under construction.
#[derive(Default)]
pub(crate) struct Surface {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Appends a vertex and returns its number.
    pub(crate) fn vertex(&mut self, position: DVec3) -> u32 {
        self.vertices.push(position);
        self.vertices.len() as u32 - 1
    }

    /// Two triangles; the diagonal runs from the first vertex to the third.
    pub(crate) fn quad(&mut self, [a, b, c, d]: [u32; 4]) {
        self.triangles.push([a, b, c]);
        self.triangles.push([a, c, d]);
    }

    fn signed_volume(&self) -> f64 {
        let position = |vertex: u32| self.vertices[vertex as usize];
        self.triangles.iter().map(|&[a, b, c]| position(a).dot(position(b).cross(position(c)))).sum()
    }

    /// Turns the surface so that its volume is positive.
    pub(crate) fn outward(mut self) -> Self {
        if self.signed_volume() < 0.0 {
            self = self.reversed();
        }
        self
    }

    /// The other side out.
    pub(crate) fn reversed(mut self) -> Self {
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        self
    }

    /// Both surfaces together.
    pub(crate) fn and(mut self, other: Self) -> Self {
        let offset = self.vertices.len() as u32;
        self.vertices.extend(other.vertices);
        self.triangles
            .extend(other.triangles.into_iter().map(|triangle| triangle.map(|vertex| vertex + offset)));
        self
    }

    /// Scaled about the origin.
    pub(crate) fn scaled(mut self, factor: f64) -> Self {
        for vertex in &mut self.vertices {
            *vertex *= factor;
        }
        self
    }

    /// Scaled so that the farthest vertex is at distance 1 from the origin (to rounding).
    pub(crate) fn normalized(self) -> Self {
        let farthest = self.vertices.iter().map(|vertex| vertex.length()).fold(0.0, f64::max);
        self.scaled(1.0 / farthest)
    }

    /// The checked mesh. Every builder makes finite vertices and valid indices.
    pub(crate) fn into_mesh(self) -> TriMesh {
        TriMesh::try_new(self.vertices, self.triangles).expect("builders make finite, indexed triangles")
    }
}
