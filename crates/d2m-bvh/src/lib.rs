#![doc = include_str!("../README.md")]

mod enclosing_sphere;
mod mesh;
pub mod paper;
mod query;
#[cfg(test)]
#[path = "../tests/random/mod.rs"]
mod random;
mod search;
mod tree;

pub use enclosing_sphere::EnclosingSphere;
pub use mesh::{Edge, MAX_COORDINATE, MeshError, Topology, TriMesh, Validation};
#[doc(hidden)]
pub use query::last_search_counts;
pub use query::{
    Budget, Contact, Distance, DistanceOptions, Evidence, MeshPart, MeshParts, Mode, Moving, PairCache,
    Posed, Proximity, ProximityOptions, QueryError, QueryOptions, Solid, StartState, TimeOfContact, Window,
    collide, collide_within, colliding_pairs, contact_exists, distance, distance_within, proximities,
    proximities_with, reduce_proximities, time_of_contact, time_of_contact_batch, time_of_contact_with,
    try_colliding_pair,
};
pub use search::InstructionSet;
#[doc(hidden)]
pub use search::SearchCounts;
pub use tree::{MeshTree, TreeError, TreeFileError};
