//! Triangle meshes: the checked container, its edges and its quality counts.

mod adjacency;
mod closedness;
mod error;
mod topology;
mod tri_mesh;
mod validation;

#[cfg(test)]
mod tests;

pub(crate) use adjacency::{Adjacency, NONE};
pub(crate) use closedness::Closedness;
pub use error::MeshError;
pub use topology::{Edge, Topology};
pub use tri_mesh::{MAX_COORDINATE, TriMesh};
pub use validation::Validation;
