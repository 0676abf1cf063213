#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Names
//! - [`System`]: bodies ([`SolverBody`]) and the [`ContactPoint`]s between them; [`System::solve`] finds their impulses with an [`Accuracy`], among
//!   more or less [`Company`], from a [`Start`]. [`System::present`] is what to go back to ([`Present`]).
//! - [`ContactPoint`]: where two bodies touch, of a [`Material`]; with a [`JointRow`] it is a row of a [`JointPart`]. Each has its [`Law`].
//! - [`impact`]: restitution, passed on from body to body, that adds no energy.
//! - [`Squeeze`]: proofs that no motion keeps bodies apart, for contacts as [`ASKEW`], [`CROSSING`], [`LEVER`] and [`ROUNDED`] say.
//! - [`Velocity`] and [`Momenta`] of a body, which [`add_impulses`] changes; [`tangents`] and [`extreme_eigenvalues`] are what a frame and masses are made of.
//! - [`LEFT_OVER`]: what counts as a failure.
//!
//! Vectors and matrices are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-contact")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod accuracy;
mod block;
mod chosen;
mod convex;
mod impact;
mod infeasible;
mod lanes;
mod law;
mod momenta;
mod moments;
mod newton;
mod point;
mod solve;
mod solver_body;
mod sweeps;
mod system;
mod velocity;

pub use accuracy::{Accuracy, Company};
pub use glam;
pub use impact::impact;
pub use infeasible::{ASKEW, CROSSING, LEVER, ROUNDED, Squeeze};
pub use law::Law;
pub use momenta::Momenta;
pub use moments::extreme_eigenvalues;
pub use newton::Start;
pub use point::{ContactPoint, JointPart, JointRow, Material, add_impulses, tangents};
pub use solve::LEFT_OVER;
pub use solver_body::SolverBody;
pub use system::{Present, System};
pub use velocity::Velocity;
