//! Time that is skipped at once: swept volumes of bodies, and what a screw motion leaves unchanged.

mod axis_distance;
mod orbits;
mod projection;
mod projection_tree;
mod screw;
pub(crate) mod screw_search;
mod swept_body;
pub(crate) mod swept_volume;

use d2m_mesh::Stop;
use d2m_mesh::margin::DOWN;

/// What a skip must give, and what it may cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SkipLimits {
    /// Bodies that are apart for less than this are not worth it.
    pub(crate) least_gain: f64,
    /// Pairs that may be tested.
    pub(crate) most_work: u64,
    /// So many more for each triangle that was projected.
    pub(crate) most_a_triangle: u64,
    /// Pairs that may be tested before the bodies are measured.
    pub(crate) most_before: u64,
    /// What is left of the query's budget, in pairs, for all that the attempt does.
    pub(crate) budget: u64,
    /// The attempt fails when this has come.
    pub(crate) stop: Stop,
    /// Triangles of A and of B that may be the reason for gaining too little: they are tested first.
    pub(crate) witnesses: [u32; 2],
}

/// What a skip gave.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Skip {
    /// The offset up to which the bodies stay further apart than the level; none when nothing is gained.
    pub(crate) clear_until: Option<f64>,
    /// Pairs that were tested.
    pub(crate) work: u64,
}

/// The offset up to which bodies are apart that are so for `clear` from `start` on: the end if that is `length`; none
/// when no time is gained.
fn later_offset(start: f64, clear: f64, length: f64, end: f64) -> Option<f64> {
    if clear >= length {
        return Some(end);
    }
    let until = (start + clear * DOWN).next_down();
    (until > start).then_some(until.min(end))
}
