#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod account;
mod body;
mod broad_phase;
mod clearance;
mod contact;
mod error;
mod faces;
mod group;
mod kinematic;
mod listener;
mod mass;
mod momenta;
mod options;
mod pairs;
mod parallel;
mod record;
mod rigid_body;
mod simulation;
mod sleep;
mod snapshot;
mod start;
mod step;
mod velocity;

pub use body::{Body, BodyId, Kind, Mass, Motion};
pub use contact::Material;
pub use error::{MassError, SimulationError, StepError};
pub use listener::ContactListener;
pub use mass::MassProperties;
pub use options::SimulationOptions;
pub use record::{ContactImpulse, Segment};
pub use simulation::{Simulation, StepReport};
pub use snapshot::Snapshot;
