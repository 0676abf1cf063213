//! Trees of oriented boxes over a mesh.
//!
//! What a box is stands in [`node`], the slabs that cut its edges off in [`slabs`]. Another bounding volume is a field of a node: fitted in
//! `bottom_up` (for construction and refit), checked in `validate`, written in `file`, and of use in the tests of pairs, of bodies at rest in
//! [`box_pair`] and `resting/node_pair`, of moving ones in `d2m-bvh`, `pair/boxes`.

mod bottom_up;
pub(crate) mod box_pair;
mod build;
mod enclosures;
mod file;
mod fit;
mod frame;
mod mesh_tree;
pub(crate) mod node;
pub(crate) mod normal_cones;
mod parts;
mod placed_bounds;
mod plan;
mod principal;
mod refine;
mod refit;
mod siblings;
pub(crate) mod slabs;
mod split;
mod surface;
#[cfg(test)]
mod tests;
mod tree_error;
mod validate;
mod wide_boxes;

pub use file::TreeFileError;
pub use mesh_tree::{MeshTree, TreeId};
pub use tree_error::TreeError;
