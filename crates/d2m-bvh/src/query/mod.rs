//! The queries of moving bodies: time of contact, existence of a contact, batches, and the data of a contact.

mod at_start;
mod batch;
mod carried_pair;
mod clearance;
#[cfg(feature = "audit")]
mod concluded;
mod constant_twist;
mod general_motion;
mod kept_motion;
mod leave;
mod meshes;
mod report;
mod rounded;
mod spans;
mod staying_inside;
mod staying_walk;
mod time_of_contact;
mod true_poses;
mod warm_start;

pub use batch::time_of_contact_batch;
pub use clearance::{Clearance, ClearanceOptions, ClearanceStatus, clearance, clearance_batch};
pub use leave::{Departure, departure};
pub use spans::{ContactSpan, SpanStatus, contact_spans};
pub use time_of_contact::{time_of_contact, time_of_contact_counted};
pub use warm_start::{contact_exists, time_of_contact_with};
