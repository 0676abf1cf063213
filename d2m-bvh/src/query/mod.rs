//! What a query is asked and what it answers.

mod contact;
mod error;
mod options;
mod window;

pub use contact::{Contact, StartState, TimeOfContact};
pub use error::QueryError;
pub use options::{Budget, Mode, QueryOptions, Solid};
pub use window::Window;
