#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod attempt;
mod directions;
mod instant;
mod meeting;
mod mesh;
mod nearest;
mod prove;
mod query;
mod solid;
mod span;
mod verify;

pub use mesh::{Mesh, MeshFault};
pub use query::{Body, Claim, Query, Reason, Solid, TimeSpan, Verdict};
pub use verify::verify;

#[cfg(test)]
mod tests;
