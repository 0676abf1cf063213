//! Flights: constant twists between events, how their velocities are solved for, and how long they are.
pub(crate) mod account;
pub(crate) mod attempt;
pub(crate) mod common_turn;
pub(crate) mod group;
pub(crate) mod length;
pub(crate) mod path;
pub(crate) mod problem;
pub(crate) mod rows;
pub(crate) mod solved_body;
pub(crate) mod turning_energy;
