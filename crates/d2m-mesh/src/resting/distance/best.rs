//! The closest pair of triangles so far.

use crate::margin::UNIT_F64;
use crate::resting::node_pair::RestingScene;
use d2m_feature::TriangleDistance;

/// Width of the enclosures of triangle distances that is expected, relative to the size of the scene; wider ones are
/// met and cost only the width of the answer.
pub(super) const EXPECTED_WIDTH: f64 = 128.0 * UNIT_F64;

/// The closest pair of triangles, working units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    pub(super) distance: TriangleDistance,
    pub(super) triangles: [u32; 2],
    /// Lower bound over all pairs of placed triangles.
    pub(super) lower: f64,
}

impl Best {
    /// Are the bodies proven apart?
    pub(super) fn is_apart(&self, scene: &RestingScene<'_>) -> bool {
        self.lower > scene.error
    }
}
