//! The search for the first contact of two trees: best first on proven times.

mod best_first;
#[cfg(feature = "audit")]
pub(crate) mod concluded;
#[cfg(feature = "audit")]
mod concluded_steps;
mod counts;
mod crowd;
mod effort;
pub(crate) mod motion;
mod node_pair;
mod over_time;
mod pairs;
#[cfg(feature = "rayon")]
mod parallel;
mod parting;
mod queue;
pub(crate) mod relative_trajectory;
mod scene;
mod scratch;
mod skip;
#[cfg(test)]
mod span_tests;
mod state;
#[cfg(test)]
mod tests;
mod time_split;
pub(crate) mod triangle_pair;
mod witness;

pub use counts::{Answered, SearchCounts};
pub(crate) use scene::{MovingScene, MovingTree};
pub(crate) use scratch::Scratch;
pub(crate) use state::{Found, Outcome, Search};
