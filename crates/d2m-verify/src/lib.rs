#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]

mod claim;
mod closest;
mod directions;
mod instant;
mod mesh;
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
