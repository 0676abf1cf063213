#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod cancel;
mod contact;
mod covered_pair;
mod enclosing_sphere;
mod error;
mod evidence;
mod length;
mod mesh;
mod meter;
mod moving;
mod nearest_point;
mod options;
mod pair_cache;
mod parallel;
mod posed;
mod query;
mod resting;
mod search;
mod tree;
mod window;

pub use cancel::{CancelFlag, Canceller};
pub use contact::{Contact, StartState, TimeBracket, TimeOfContact};
pub use d2m_lanes::InstructionSet;
pub use enclosing_sphere::EnclosingSphere;
pub use error::QueryError;
pub use evidence::Evidence;
pub use mesh::{Edge, MAX_COORDINATE, MeshArrays, MeshError, Topology, TriMesh, Validation};
pub use meter::{Exhausted, Meter};
pub use moving::Moving;
pub use options::{Budget, Mode, QueryOptions, Solid, Start};
pub use pair_cache::PairCache;
pub use posed::Posed;
pub use query::{
    Clearance, ClearanceOptions, ClearanceStatus, ContactSpan, Departure, SpanStatus, clearance,
    clearance_batch, contact_exists, contact_spans, departure, time_of_contact, time_of_contact_batch,
    time_of_contact_counted, time_of_contact_with,
};
pub use resting::collide::{collide, collide_within, colliding_pairs, try_colliding_pair};
pub use resting::distance::{
    Distance, DistanceBounds, DistanceOptions, bound_distance, distance, distance_within,
};
pub use resting::parts::{MeshPart, MeshParts};
pub use resting::proximities::{
    Proximity, ProximityOptions, proximities, proximities_with, proximities_within, reduce_proximities,
};
pub use search::{Answered, SearchCounts};
pub use tree::{MeshTree, TreeError, TreeFileError};
pub use window::Window;
