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
//! - [`PairClearance`]: how near two bodies come ([`World::nearest_pair`], [`World::clearances_below`]); [`PairsOfBodies`] asks the same
//!   without a world, with [`PairDistance`] and [`PairFault`].
//! - [`PairSpans`]: when two bodies are clear of each other ([`World::contact_spans`]); [`join_spans`]: when all are.
//!
//! ## Broad phase
//! - [`Aabb`]: a box that is rounded outward; [`BoxTree`]: which of many may meet. Worlds and simulations use them.
//!
//! ## Errors
//! [`WorldError`]: bad input, with the names of the bodies.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-world")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod aabb;
mod batches;
mod body;
mod box_tree;
mod moving_sphere;
mod nearest;
mod swept_bounds;
mod world;

pub use aabb::Aabb;
pub use body::{Body, Group, SharedMotion};
pub use box_tree::BoxTree;
pub use glam;
pub use nearest::{PairDistance, PairFault, PairsOfBodies};
pub use world::{
    BodyId, Candidate, FirstContact, PairClearance, PairContact, PairProximities, PairSpans, PlannedMotion,
    Threads, World, WorldError, join_spans,
};
