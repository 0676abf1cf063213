//! The search for the first contact of two trees in a sub-window: pairs of boxes, best first on proven times.

pub(crate) mod best_first;
#[cfg(feature = "audit")]
mod concluded_steps;
pub(crate) mod counts;
mod crowd;
pub(crate) mod effort;
pub(crate) mod expansion;
mod pairs;
mod parting;
#[cfg(test)]
mod passing_tests;
pub(crate) mod queue;
pub(crate) mod scratch;
#[cfg(test)]
mod span_tests;
pub(crate) mod state;
#[cfg(test)]
mod tests;
