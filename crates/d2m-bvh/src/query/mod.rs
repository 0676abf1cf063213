//! The queries of moving bodies: time of contact, existence of a contact, batches, and the data of a contact.

mod batch;
mod constant_twist;
mod fitted_twist;
mod general_motion;
mod proven_crossing;
mod report;
mod time_of_contact;
mod true_poses;
mod warm_start;

pub use batch::time_of_contact_batch;
pub use time_of_contact::{time_of_contact, time_of_contact_counted};
pub use warm_start::{contact_exists, time_of_contact_with};
