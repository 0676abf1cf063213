#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! Read a [`Robot`], put it into a [`RobotScene`], and ask [`RobotScene::check_path`] about a [`Trajectory`].
//!
//! ## Robots
//! - [`Robot`] from URDF, where its files are by [`RobotOptions`]; [`JointType`], [`JointLimits`], [`Mimic`]
//!   say what its joints are, [`Inertial`] and [`JointDynamics`] how heavy its links are and what brakes it, [`RobotMesh`] what files they are of.
//! - [`Srdf`]: pairs that are not checked.
//!
//! ## Scenes
//! [`RobotScene`], with an [`Obstacle`] or a body that is [`Attached`] to a link.
//!
//! ## Simulations
//! With the feature `dynamics`: [`RobotBodies`], on its [`Base`], become bodies and joints of a simulation, the [`SimulatedRobot`].
//!
//! ## Paths
//! - [`Trajectory`]: a [`TrajectoryPoint`] at each time, joined by an [`Interpolation`].
//! - [`EdgeChecker`]: straight edges of a sampling planner. [`PathBodies`]: the bodies of one path, for
//!   queries of your own.
//!
//! ## Answers
//! - [`PathAnswer`], with a [`PathContact`]; [`PathClearance`]: how near.
//! - [`LimitWarning`] of a [`LimitKind`]: a joint beyond its limit.
//!
//! ## Errors
//! [`RobotError`]: file, link or joint, and the value found.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![cfg_attr(not(feature = "dynamics"), doc = "")]
#![cfg_attr(not(feature = "dynamics"), doc = " [`RobotBodies`]: index.html#simulations")]
#![cfg_attr(not(feature = "dynamics"), doc = " [`Base`]: index.html#simulations")]
#![cfg_attr(not(feature = "dynamics"), doc = " [`SimulatedRobot`]: index.html#simulations")]
#![doc(html_root_url = "https://docs.rs/d2m-robot")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod answer;
mod body_box;
mod broad_phase;
mod check;
mod clearance;
mod error;
mod geometry;
mod inertial;
mod joints;
mod limit_kind;
mod limit_search;
mod limits;
mod link_tree;
mod obstacle;
mod options;
mod packages;
mod part;
mod path_bodies;
mod robot;
#[cfg(feature = "serde")]
mod ros_time;
mod scene;
#[cfg(feature = "dynamics")]
mod simulated;
mod srdf;
mod swept_box;
mod trajectory;
mod urdf;
mod values;
mod xml;

pub use answer::{PathAnswer, PathContact};
pub use check::EdgeChecker;
pub use clearance::PathClearance;
pub use error::RobotError;
pub use glam;
pub use inertial::{Inertial, JointDynamics};
pub use joints::{JointLimits, JointType, Mimic};
pub use limit_kind::LimitKind;
pub use limits::LimitWarning;
pub use obstacle::{Attached, Obstacle};
pub use options::RobotOptions;
pub use path_bodies::PathBodies;
pub use robot::{Robot, RobotMesh};
pub use scene::RobotScene;
#[cfg(feature = "dynamics")]
pub use simulated::{Base, RobotBodies, SimulatedRobot};
pub use srdf::Srdf;
pub use trajectory::{Interpolation, Trajectory, TrajectoryPoint};
