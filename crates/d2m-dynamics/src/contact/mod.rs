//! Contacts of bodies that are close: rows, their solution, impacts.

mod directions;
mod impact;
mod point;
mod rows;
mod scope;
mod solver;

pub(crate) use impact::impact;
pub use point::Material;
pub(crate) use point::{ContactPoint, tangents};
pub(crate) use rows::{HIT, Span, select};
pub(crate) use scope::Scope;
pub(crate) use solver::{Solver, SolverBody, Sweeps};
