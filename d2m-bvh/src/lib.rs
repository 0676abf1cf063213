//! Triangle meshes, bounding-volume trees and certified tree-pair queries: time of contact, collide, distance.

mod mesh;
mod query;

pub use mesh::{MAX_COORDINATE, MeshError, TriMesh};
pub use query::{Budget, Contact, Mode, QueryError, QueryOptions, Solid, StartState, TimeOfContact, Window};
