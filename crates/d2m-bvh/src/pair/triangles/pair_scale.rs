//! What the tests of triangle pairs of one search have in common.

use glam::DVec3;

/// Distances and bounds of one search, in the units of the scene.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct PairScale {
    /// Distance that is to be reached: wanted separation plus δ.
    pub(crate) level: f64,
    /// Bound on the error of a projected gap, for a unit direction.
    pub(crate) error: f64,
    /// Contact when the distance is at most this: level + δ + error.
    pub(crate) stop: f64,
    /// Pairs are advanced to this much above the level, so that others that meet at the same features can be proven
    /// apart at the time of the contact.
    pub(crate) slack: f64,
    /// Bound on the acceleration between the bodies.
    pub(crate) acceleration: f64,
    /// From the reference point to the center of the tree, body axes.
    pub(crate) arms: [DVec3; 2],
    /// Bounds on the centripetal accelerations: |ω|²ρ of each body, ρ the largest distance from the reference point.
    pub(crate) centripetal: [f64; 2],
}

impl PairScale {
    /// The distance down to which pairs are advanced.
    #[inline(always)]
    pub(crate) fn target(&self) -> f64 {
        self.level + self.slack
    }
}
