//! The search for the first contact of two trees: best first on proven times.

mod best_first;
mod crowd;
pub(crate) mod motion;
pub(crate) mod node_pair;
#[cfg(feature = "rayon")]
mod parallel;
pub(crate) mod queue;
mod scene;
mod skip;
#[cfg(test)]
mod tests;
pub(crate) mod triangle_pair;

pub(crate) use best_first::{Found, Outcome, Search};
pub use scene::SearchCounts;
pub(crate) use scene::{Scene, Scratch};
