//! What a query is asked and what it answers.

mod batch;
mod cache;
mod collide;
mod contact;
mod containment;
mod course;
mod distance;
mod error;
mod evidence;
mod fitted_twist;
mod general_motion;
mod moving;
mod options;
mod posed;
mod proven_crossing;
mod proximities;
mod report;
mod static_pair;
mod time_of_contact;
mod warm_start;
mod window;

pub use batch::time_of_contact_batch;
pub use cache::PairCache;
pub use collide::{collide, colliding_pairs, try_colliding_pair};
pub use contact::{Contact, StartState, TimeOfContact};
pub use distance::{Distance, DistanceOptions, distance, distance_within};
pub use error::QueryError;
pub use evidence::Evidence;
pub use moving::Moving;
pub use options::{Budget, Mode, QueryOptions, Solid};
pub use posed::Posed;
pub use proximities::{Proximity, ProximityOptions, proximities, proximities_with, reduce_proximities};
pub use time_of_contact::{last_search_counts, time_of_contact};
pub use warm_start::{contact_exists, time_of_contact_with};
pub use window::Window;
