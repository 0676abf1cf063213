//! What a query is asked and what it answers.

mod contact;
mod containment;
mod error;
mod moving;
mod options;
mod report;
mod time_of_contact;
mod window;

pub use contact::{Contact, StartState, TimeOfContact};
pub use error::QueryError;
pub use moving::Moving;
pub use options::{Budget, Mode, QueryOptions, Solid};
pub use time_of_contact::time_of_contact;
pub use window::Window;
