#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod body;
mod box_tree;
mod moving_sphere;
mod parallel;
mod swept_bounds;
mod world;

pub use body::{Body, Group, SharedMotion};
pub use world::{BodyId, FirstContact, PairContact, PairProximities, PlannedMotion, World, WorldError};
