#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`verify()`] takes a [`Query`] and a [`Claim`] about it, and answers with a [`Verdict`].
//!
//! ## The question
//! - [`Query`]: two bodies ([`Body`]: a [`Mesh`], its motion, what is [`Solid`] of it).
//! - [`Claim`] over a [`TimeSpan`].
//!
//! ## The answer
//! [`Verdict`]: verified, refuted, or unproven for a [`Reason`].
//!
//! ## Errors
//! [`MeshFault`]: vertices and triangles that are no mesh.
//!
//! Vectors and quaternions are those of [`glam`](https://docs.rs/glam), in the version that is given out here.
#![doc(html_root_url = "https://docs.rs/d2m-verify")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

// The question.
mod claim;
mod mesh;
mod surface;

// Guesses.
mod closest;
mod directions;

// One time, and what is between two of them.
mod instant;
mod rates;

// Proofs: surfaces, solids, claims.
mod prove;
mod solid;
mod units;
mod verify;

pub use claim::{Body, Claim, Query, Reason, Solid, TimeSpan, Verdict};
pub use glam;
pub use mesh::{Mesh, MeshFault};
pub use verify::verify;

#[cfg(test)]
mod tests;
