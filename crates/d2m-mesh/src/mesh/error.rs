//! Why a mesh was refused.

use thiserror::Error;

/// Bad input to [`TriMesh::try_new`](crate::TriMesh::try_new): what is wrong, where, and the value found.
///
/// Indices are 0-based. Degenerate or duplicate triangles are *not* errors: they are kept, they are harmless and
/// they are counted.
///
/// ```
/// use d2m_mesh::{MeshError, TriMesh};
/// let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, f64::NAN, 0.0]];
/// let refused = TriMesh::from_arrays(&vertices, &[[0, 1, 2]]).unwrap_err();
/// assert!(matches!(refused, MeshError::NonFiniteVertex { vertex: 2, axis: 'y', .. }));
/// assert_eq!(refused.to_string(), "vertex 2: coordinate y is NaN, not a finite number");
/// ```
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// There is no triangle: nothing to collide with.
    #[error("the mesh has no triangles")]
    NoTriangles,
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex}: coordinate {axis} is {value}, not a finite number")]
    NonFiniteVertex {
        /// 0-based index of the vertex.
        vertex: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// The value found.
        value: f64,
    },
    /// A coordinate is finite but so large that squared areas would overflow.
    #[error("vertex {vertex}: coordinate {axis} is {value:e}, larger than the limit of 1e60")]
    VertexTooLarge {
        /// 0-based index of the vertex.
        vertex: usize,
        /// `x`, `y` or `z`.
        axis: char,
        /// The value found.
        value: f64,
    },
    /// A triangle names a vertex that does not exist.
    #[error(
        "triangle {triangle}: vertex index {index} is out of range, the mesh has {vertex_count} vertices"
    )]
    IndexOutOfRange {
        /// 0-based index of the triangle.
        triangle: usize,
        /// The vertex index found.
        index: u32,
        /// How many vertices there are.
        vertex_count: usize,
    },
    /// More vertices or triangles than a `u32` can number.
    #[error("the mesh has {count} {what}, more than the limit of {limit}", limit = u32::MAX)]
    TooMany {
        /// `"vertices"` or `"triangles"`.
        what: &'static str,
        /// How many there are.
        count: usize,
    },
}
