#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! Add each [`Body`] to a [`Simulation`] and call [`Simulation::step`].
//!
//! ## Bodies
//! - [`Body`]: a shared tree, its [`Kind`], [`Mass`], [`Damping`], [`Material`], [`Groups`], [`Presence`]; a kinematic one follows a [`Motion`].
//!   [`BodyId`] is its name.
//! - [`Part`]: a mesh of a body of several ones. [`MassProperties`]: mass, center and inertia of a mesh.
//! - [`Joint`]: holds two bodies together, of a [`JointKind`], with a [`Motor`] (and its [`MotorTarget`]) or a
//!   [`Spring`].
//!
//! ## Running
//! - [`SimulationOptions`]: gravity, step, gap, accuracy.
//! - [`Simulation`]; [`Snapshot`] is its state, to come back to.
//! - [`Frozen`]: queries about the bodies where they are now, as which one a ray meets ([`RayAnswer`],
//!   [`RayError`]).
//!
//! ## What is reported
//! - [`StepReport`] of each step, with its [`Segment`]s (certified flights) and [`ContactImpulse`]s.
//! - [`TouchEvent`]: two bodies begin to touch, or stop ([`TouchChange`]).
//! - [`ContactListener`]: receives every impulse when it acts.
//!
//! ## Errors
//! [`SimulationError`] and [`MassError`]: bad input. [`StepError`]: why a simulation cannot go on.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is re-exported here.
#![doc(html_root_url = "https://docs.rs/d2m-dynamics")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod advance;
mod body;
mod error;
mod flight;
mod joint;
mod listener;
mod live;
mod numbers;
mod options;
mod pairs;
mod record;
mod rest;
mod shown;
mod simulation;
mod snapshot;
mod step;

pub use body::compound::Part;
pub use body::description::{Body, BodyId, Damping, Groups, Kind, Mass, Motion, Presence};
#[doc(inline)]
pub use d2m_contact::Material;
#[doc(inline)]
pub use d2m_mesh::{MassError, MassProperties};
pub use error::{SimulationError, StepError};
pub use glam;
pub use joint::description::{Joint, JointKind, Motor, MotorTarget, Spring};
pub use listener::ContactListener;
pub use live::frozen::{Frozen, RayAnswer, RayError};
pub use options::SimulationOptions;
pub use record::{ContactImpulse, Segment, TouchChange, TouchEvent};
pub use simulation::{Simulation, StepReport};
pub use snapshot::state::Snapshot;
