//! Contacts of bodies that are close: rows, their solution, impacts.

mod accuracy;
mod block;
mod chosen;
mod common_turn;
mod convex;
mod impact;
mod infeasible;
mod lanes;
mod law;
mod newton;
mod point;
mod rows;
mod solve;
mod solver_body;
mod sweeps;
mod system;

pub(crate) use accuracy::{Accuracy, Company};
pub(crate) use common_turn::in_common_turn;
pub(crate) use impact::impact;
pub(crate) use infeasible::{ASKEW, CROSSING, LEVER, ROUNDED, Squeeze};
pub(crate) use law::Law;
pub(crate) use newton::Start;
pub use point::Material;
#[cfg(test)]
pub(crate) use point::upright;
pub(crate) use point::{ContactPoint, JointRow, add, tangents};
pub(crate) use rows::{HIT, LAST, NEAR, Room, Span, select};
pub(crate) use solve::LEFT_OVER;
pub(crate) use solver_body::SolverBody;
pub(crate) use system::{Present, System};
