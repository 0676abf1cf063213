//! Trees of oriented boxes over a mesh.

mod build;
mod fit;
pub(crate) mod margin;
mod mesh_tree;
pub(crate) mod node;

pub use mesh_tree::MeshTree;
