//! Triangle meshes, bounding-volume trees and certified tree-pair queries: time of contact, collide, distance.

mod mesh;

pub use mesh::{MAX_COORDINATE, MeshError, TriMesh};
