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
#![doc(html_root_url = "https://docs.rs/d2m-verify")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]

mod claim;
mod closest;
mod directions;
mod instant;
mod mesh;
mod moved;
mod prove;
mod rates;
mod solid;
mod surface;
mod verify;

pub use claim::{Body, Claim, Query, Reason, Solid, TimeSpan, Verdict};
pub use mesh::{Mesh, MeshFault};
pub use verify::verify;

#[cfg(test)]
mod tests;
