//! The checked triangle mesh.

use crate::MeshError;
use glam::DVec3;

/// Largest coordinate magnitude that a [`TriMesh`] accepts.
///
/// A product of five coordinate differences (the largest product that any test forms: area² times a length) stays
/// below (2e60)⁵ < 1e302, so nothing overflows.
///
/// ```
/// use d2m_mesh::{MAX_COORDINATE, TriMesh};
/// use glam::DVec3;
/// let triangle = |size: f64| TriMesh::try_new(vec![DVec3::ZERO, DVec3::X * size, DVec3::Y], vec![[0, 1, 2]]);
/// assert!(triangle(MAX_COORDINATE).is_ok() && triangle(2.0 * MAX_COORDINATE).is_err());
/// ```
pub const MAX_COORDINATE: f64 = 1e60;

/// The lists that a [`TriMesh`] is made of.
///
/// ```
/// use d2m_mesh::{MeshArrays, TriMesh};
/// use glam::DVec3;
/// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
/// let MeshArrays { vertices, triangles } = mesh.into_arrays(); // nothing is copied
/// assert_eq!((vertices.len(), triangles), (3, vec![[0, 1, 2]]));
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MeshArrays {
    /// Positions in the body frame.
    pub vertices: Vec<DVec3>,
    /// Three numbers of vertices each.
    pub triangles: Vec<[u32; 3]>,
}

/// An indexed triangle mesh in its body frame: `f64` vertices, `u32` triangles, checked once and immutable.
///
/// **Promise.** Every coordinate is finite with magnitude at most [`MAX_COORDINATE`], every index is in range and
/// there is at least one triangle. Nothing else is assumed: the mesh may be open, non-manifold or a soup, triangles may
/// be degenerate (they are the segment or the point that their vertices span) or duplicated, vertices may be unused
/// (an unused vertex is not part of the body). Vertex and triangle numbers are those of the input, so answers can name
/// them.
///
/// ```
/// use d2m_mesh::{MeshError, TriMesh};
/// use glam::DVec3;
///
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let tetrahedron = TriMesh::try_new(vertices.clone(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// assert_eq!(tetrahedron.triangle_count(), 4);
/// assert_eq!(tetrahedron.corners(3), [DVec3::X, DVec3::Y, DVec3::Z]);
///
/// let refused = TriMesh::try_new(vertices, vec![[0, 1, 4]]);
/// assert_eq!(refused, Err(MeshError::IndexOutOfRange { triangle: 0, index: 4, vertex_count: 4 }));
/// # Ok::<(), MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Parts", into = "Parts"))]
pub struct TriMesh {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl TriMesh {
    /// Checks and takes the two lists.
    ///
    /// # Errors
    /// [`MeshError`] with index and value: no triangles, a coordinate that is NaN, infinite or larger than
    /// [`MAX_COORDINATE`], an index out of range, more elements than a `u32` can number.
    pub fn try_new(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        for (what, count) in [("vertices", vertices.len()), ("triangles", triangles.len())] {
            if count > u32::MAX as usize {
                return Err(MeshError::TooMany { what, count });
            }
        }
        if triangles.is_empty() {
            return Err(MeshError::NoTriangles);
        }
        check_positions(&vertices)?;
        check_indices(&triangles, vertices.len())?;
        Ok(Self { vertices, triangles })
    }

    /// The same triangles with other vertices, checked as by [`Self::try_new`]. They are taken out of this mesh, where there is no error.
    pub(crate) fn try_move(&mut self, vertices: Vec<DVec3>) -> Result<Self, MeshError> {
        let count = vertices.len();
        if count > u32::MAX as usize {
            return Err(MeshError::TooMany { what: "vertices", count });
        }
        check_positions(&vertices)?;
        // Indices of the vertices until now are in range.
        if count < self.vertices.len() {
            check_indices(&self.triangles, count)?;
        }
        Ok(Self { vertices, triangles: core::mem::take(&mut self.triangles) })
    }

    /// Copies a mesh from plain arrays, checked as by [`TriMesh::try_new`].
    ///
    /// ```
    /// let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    /// let mesh = d2m_mesh::TriMesh::from_arrays(&vertices, &[[0, 1, 2]])?;
    /// assert_eq!((mesh.vertex_count(), mesh.triangle_count()), (3, 1));
    /// assert!(d2m_mesh::TriMesh::from_arrays(&vertices, &[[0, 1, 3]]).is_err());
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`TriMesh::try_new`].
    pub fn from_arrays(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> Result<Self, MeshError> {
        Self::try_new(vertices.iter().copied().map(DVec3::from_array).collect(), triangles.to_vec())
    }

    /// Lists that keep the promise because they come from a mesh.
    pub(super) fn from_checked(MeshArrays { vertices, triangles }: MeshArrays) -> Self {
        Self { vertices, triangles }
    }

    /// One point: with a radius (`Moving::with_radius` of `d2m-bvh`) a sphere.
    ///
    /// ```
    /// use d2m_mesh::TriMesh;
    /// use glam::DVec3;
    /// let point = TriMesh::point(DVec3::X)?;
    /// assert_eq!((point.vertex_count(), point.corners(0)), (1, [DVec3::X; 3]));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`TriMesh::try_new`].
    pub fn point(center: DVec3) -> Result<Self, MeshError> {
        Self::try_new(vec![center], vec![[0, 0, 0]])
    }

    /// The segment between two points: with a radius (`Moving::with_radius` of `d2m-bvh`) a capsule.
    ///
    /// ```
    /// use d2m_mesh::TriMesh;
    /// use glam::DVec3;
    /// let segment = TriMesh::segment(DVec3::ZERO, DVec3::Z)?;
    /// assert_eq!(segment.vertices(), [DVec3::ZERO, DVec3::Z]);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Errors
    /// Those of [`TriMesh::try_new`].
    pub fn segment(start: DVec3, end: DVec3) -> Result<Self, MeshError> {
        Self::try_new(vec![start, end], vec![[0, 1, 1]])
    }

    /// The vertices in the body frame, in input order.
    #[inline]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The triangles as triples of vertex indices, in input order and orientation (counter-clockwise from outside, if
    /// the mesh bounds a solid).
    #[inline]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// How many vertices there are, unused ones included.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// How many triangles there are, degenerate ones included.
    #[inline]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The three vertices of triangle number `triangle`.
    ///
    /// # Panics
    /// If `triangle` is not below [`triangle_count`](Self::triangle_count).
    #[inline]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        // Written out: a closure mapped over an array is not inlined into code for other instruction sets.
        let [a, b, c] = self.triangles[triangle];
        [self.vertices[a as usize], self.vertices[b as usize], self.vertices[c as usize]]
    }

    /// The least and the greatest coordinates of the corners of its triangles, body frame.
    ///
    /// ```
    /// use d2m_mesh::TriMesh;
    /// // The last vertex belongs to no triangle.
    /// let vertices = [[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [9.0, 9.0, 9.0]];
    /// let mesh = TriMesh::from_arrays(&vertices, &[[0, 1, 2]])?;
    /// assert_eq!(mesh.extent().map(|p| p.to_array()), [[0.0; 3], [3.0, 4.0, 0.0]]);
    /// assert_eq!(mesh.size(), 5.0);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    pub fn extent(&self) -> [DVec3; 2] {
        let corners = self.triangles.iter().flatten().map(|&vertex| self.vertices[vertex as usize]);
        corners.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
    }

    /// How large the body is: the diagonal of the box of its [`extent`](Self::extent), in its unit of length.
    pub fn size(&self) -> f64 {
        let [low, high] = self.extent();
        (high - low).length()
    }

    /// Gives the two lists back.
    ///
    /// ```
    /// use d2m_mesh::{MeshArrays, TriMesh};
    /// let mesh = TriMesh::from_arrays(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]])?;
    /// let MeshArrays { vertices, triangles } = mesh.into_arrays();
    /// assert_eq!((vertices.len(), triangles), (3, vec![[0, 1, 2]]));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    pub fn into_arrays(self) -> MeshArrays {
        let Self { vertices, triangles } = self;
        MeshArrays { vertices, triangles }
    }
}

/// The unchecked form that serde reads; [`TriMesh::try_new`] checks it.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
struct Parts {
    vertices: Vec<[super::ExactNumber; 3]>,
    triangles: Vec<[u32; 3]>,
}

#[cfg(feature = "serde")]
impl TryFrom<Parts> for TriMesh {
    type Error = MeshError;

    fn try_from(parts: Parts) -> Result<Self, MeshError> {
        let position = |vertex: [super::ExactNumber; 3]| DVec3::from_array(vertex.map(|number| number.0));
        Self::try_new(parts.vertices.into_iter().map(position).collect(), parts.triangles)
    }
}

#[cfg(feature = "serde")]
impl From<TriMesh> for Parts {
    fn from(mesh: TriMesh) -> Self {
        let TriMesh { vertices, triangles } = mesh;
        let exact = |vertex: DVec3| vertex.to_array().map(super::ExactNumber);
        Self { vertices: vertices.into_iter().map(exact).collect(), triangles }
    }
}

fn check_positions(vertices: &[DVec3]) -> Result<(), MeshError> {
    for (vertex, position) in vertices.iter().enumerate() {
        for (axis, value) in ['x', 'y', 'z'].into_iter().zip(position.to_array()) {
            if !value.is_finite() {
                return Err(MeshError::NonFiniteVertex { vertex, axis, value });
            }
            if value.abs() > MAX_COORDINATE {
                return Err(MeshError::VertexTooLarge { vertex, axis, value });
            }
        }
    }
    Ok(())
}

fn check_indices(triangles: &[[u32; 3]], vertex_count: usize) -> Result<(), MeshError> {
    for (triangle, corners) in triangles.iter().enumerate() {
        for &index in corners {
            if index as usize >= vertex_count {
                return Err(MeshError::IndexOutOfRange { triangle, index, vertex_count });
            }
        }
    }
    Ok(())
}
