#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! Put each [`Body`] into a [`World`] and ask [`World::first_contact`].
//!
//! ## Bodies
//! - [`Body`]: a shared tree and a [`SharedMotion`], solid or surface, in a [`Group`] or in none. [`BodyId`]
//!   is its name in the world.
//! - [`PlannedMotion`]: what a body might do, for [`World::first_contact_of`].
//! - [`Candidate`]: a pair that another broad phase has left, for [`World::first_contact_among`]; [`Threads`]: which of them answer.
//!
//! ## Answers
//! - [`FirstContact`]: separated, the first contact, or undecided. [`PairContact`]: what is known of one
//!   pair.
//! - [`PairProximities`]: where two bodies at rest are locally closest.
//!
//! ## Errors
//! [`WorldError`]: bad input, with the names of the bodies.
#![doc(html_root_url = "https://docs.rs/d2m-world")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod body;
mod box_tree;
mod moving_sphere;
mod parallel;
mod swept_bounds;
mod world;

pub use body::{Body, Group, SharedMotion};
pub use world::{
    BodyId, Candidate, FirstContact, PairContact, PairProximities, PlannedMotion, Threads, World, WorldError,
};
