//! The boxes of a tree, for those who write a query of their own.
//!
//! [`MeshTree::nodes`](crate::MeshTree::nodes) are the nodes: up to eight boxes each, lane by lane, below box
//! `8·node + lane` of another one. A query begins at box 0, and asks of a box whether it can be left out, or what is
//! [below](WideNode::below) it. What each box promises stands at [`WideNode`].
//!
//! ```
//! use d2m_mesh::node::{Below, NodeBox, WIDTH};
//! use d2m_mesh::{MeshTree, TriMesh};
//! use glam::DVec3;
//! let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let tree = MeshTree::new(TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?);
//! // All triangles, box by box.
//! let (mut open, mut found) = (vec![0], Vec::new());
//! while let Some(index) = open.pop() {
//!     let NodeBox { node, lane } = NodeBox::new(tree.nodes(), index);
//!     match node.below(lane) {
//!         Below::Triangle(triangle) => found.push(triangle),
//!         Below::Node(below) => {
//!             let first = below * WIDTH as u32;
//!             open.extend(first..first + tree.nodes()[below as usize].used);
//!         }
//!     }
//! }
//! found.sort_unstable();
//! assert_eq!(found, [0, 1, 2, 3]);
//! # Ok::<(), d2m_mesh::MeshError>(())
//! ```

pub use crate::tree::TreeId;
pub use crate::tree::box_pair::{Axis, BoxPair, GAP_ERROR, PlacedBox, opposite};
pub use crate::tree::node::{Below, LEAF, LEAST_SIZE, NodeBox, OrientedBox, WIDTH, WideNode};
pub use crate::tree::slabs::{Slabs, reach};
