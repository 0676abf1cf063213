//! What is wrong with a tree that came from elsewhere.

use thiserror::Error;

/// Why a tree is not one.
///
/// ```
/// use d2m_mesh::{MeshTree, TreeError, TriMesh};
/// use glam::DVec3;
/// let tree = MeshTree::new(TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?);
/// let checked: Result<(), TreeError> = tree.validate();
/// assert_eq!(checked, Ok(())); // as every tree that was built here
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TreeError {
    /// Center, radius or unit do not fit the mesh.
    #[error("center, radius or unit of the tree do not fit its mesh")]
    Extent,
    /// A node does not exist, is below two boxes or none, or its number of boxes is wrong.
    #[error("node {node}: not linked into one tree")]
    Link {
        /// Number of the node.
        node: usize,
    },
    /// A triangle does not exist, or is not in exactly one leaf.
    #[error("triangle {triangle}: not in exactly one leaf")]
    Triangle {
        /// Number of the triangle.
        triangle: usize,
    },
    /// The axes of a box are not orthonormal to the rounding of `f32`, or its numbers are not consistent.
    #[error("box {lane} of node {node}: axes or extents are inconsistent")]
    Shape {
        /// Number of the node.
        node: usize,
        /// Number of the box in the node.
        lane: usize,
    },
    /// A box is not proven to enclose a triangle that is below it.
    #[error("box {lane} of node {node} does not enclose triangle {triangle}")]
    Enclosure {
        /// Number of the node.
        node: usize,
        /// Number of the box in the node.
        lane: usize,
        /// Number of the triangle.
        triangle: usize,
    },
}
