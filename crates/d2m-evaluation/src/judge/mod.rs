//! The judge: an independent static distance and a check of answers by it. Nothing here uses the engine's trees,
//! bounds or kernels, so that a fault there cannot hide itself.
mod answer;
mod placement;
mod separation;
mod triangle;

pub(crate) use answer::{Claim, Judge, MOST_LEFT, advance};
pub(crate) use placement::{Placement, place};
pub(crate) use separation::{BoxTree, Hint, bound_separation, cross, separation};
pub(crate) use triangle::distance;

#[cfg(test)]
mod tests;
