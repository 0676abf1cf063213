//! Triangle meshes, bounding-volume trees and certified tree-pair queries: time of contact, collide, distance.

mod enclosing_sphere;
mod mesh;
pub mod paper;
mod query;
mod search;
mod tree;

pub use enclosing_sphere::EnclosingSphere;
pub use mesh::{Edge, MAX_COORDINATE, MeshError, Topology, TriMesh, Validation};
pub use query::{
    Budget, Contact, Mode, Moving, QueryError, QueryOptions, Solid, StartState, TimeOfContact, Window,
    time_of_contact,
};
pub use tree::MeshTree;
