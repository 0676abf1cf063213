#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod answer;
mod check;
mod clearance;
mod cylinder;
mod error;
mod geometry;
mod limits;
mod options;
mod packages;
mod path_bodies;
mod robot;
mod scene;
mod srdf;
mod trajectory;
mod urdf;
mod values;
mod xml;

pub use answer::{PathAnswer, PathContact};
pub use check::EdgeChecker;
pub use clearance::PathClearance;
pub use error::RobotError;
pub use limits::{LimitKind, LimitWarning};
pub use options::RobotOptions;
pub use path_bodies::PathBodies;
pub use robot::{JointLimits, JointType, Mimic, Robot};
pub use scene::{Attached, Obstacle, RobotScene};
pub use srdf::Srdf;
pub use trajectory::{Interpolation, Trajectory, TrajectoryPoint};
