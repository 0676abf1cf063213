//! Trees of oriented boxes over a mesh.

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
