//! Triangle meshes: the checked container, its edges and its quality counts.

mod error;
mod tri_mesh;

pub use error::MeshError;
pub use tri_mesh::{MAX_COORDINATE, TriMesh};
