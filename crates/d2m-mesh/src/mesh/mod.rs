//! Triangle meshes: the checked container, its edges and its quality counts.

mod adjacency;
mod closedness;
mod disjoint_sets;
mod error;
#[cfg(feature = "serde")]
mod exact_number;
mod first_equal;
mod made;
mod topology;
mod tri_mesh;
mod validation;

#[cfg(test)]
mod tests;

pub(crate) use adjacency::{Adjacency, NONE};
pub(crate) use closedness::{Closedness, part_roots};
pub use disjoint_sets::DisjointSets;
pub use error::MeshError;
#[cfg(feature = "serde")]
pub(crate) use exact_number::ExactNumber;
pub use topology::{Edge, Topology};
pub use tri_mesh::{MAX_COORDINATE, MeshArrays, TriMesh};
pub use validation::Validation;
