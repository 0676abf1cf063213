//! The search for the first contact of two trees: best first on proven times.

#[cfg(feature = "rayon")]
mod ahead;
#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod base_pose;
mod closest;
mod crowd;
mod dispatch;
mod entry_time;
mod expansion;
mod frame;
mod helix;
mod instruction_set;
mod lanes;
mod local_motion;
mod node_test;
mod picture;
mod portable;
mod quad;
mod queue;
mod refined_directions;
mod scene;
mod swept;
#[cfg(test)]
mod tests;
mod triangle_pair;
mod two;
mod units;
mod window;

pub(crate) use base_pose::{Columns, Pair, given_relative_position};
pub(crate) use closest::{Closest, Place, closest};
#[cfg(test)]
pub(crate) use dispatch::run_on;
pub(crate) use dispatch::{Task, run};
pub(crate) use frame::{FRAME_REACH, Frame, RelativeMotion};
pub use instruction_set::InstructionSet;
pub(crate) use lanes::Lanes;
#[cfg(test)]
pub(crate) use portable::Portable;
pub(crate) use quad::{Doubles, Quad};
pub use scene::SearchCounts;
pub(crate) use scene::{Scene, Scratch};
pub(crate) use triangle_pair::{PairScale, place_a};
pub(crate) use units::Units;
pub(crate) use window::{Found, Outcome, Search};
