//! Simulations: scene files in, run files out.

mod fields;
mod joints;
mod run_file;
mod scene;
mod thinning;

pub(crate) use fields::{Fields, short};
pub(crate) use run_file::{Line, header, segment};
pub(crate) use scene::{SimulatedScene, are_told_apart, read_scene};
pub(crate) use thinning::Thinner;
