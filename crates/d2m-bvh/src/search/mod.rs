//! The search for the first contact of two trees: best first on proven times.

mod best_first;
mod crowd;
pub(crate) mod motion;
mod nearest_point;
mod node_pair;
mod over_time;
mod pairs;
#[cfg(feature = "rayon")]
mod parallel;
mod queue;
pub(crate) mod relative_trajectory;
mod scene;
mod skip;
#[cfg(test)]
mod span_tests;
mod state;
#[cfg(test)]
mod tests;
mod time_split;
pub(crate) mod triangle_pair;

pub use scene::SearchCounts;
pub(crate) use scene::{Scene, Scratch};
pub(crate) use state::{Found, Outcome, Search};
