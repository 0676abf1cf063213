//! Triangles that certainly stay near each other for a while.

mod curved;
mod straight;

use curved::CurvedPair;
use d2m_motion::RigidMotion;
use glam::DVec3;
use straight::StraightPair;

/// A triangle, and the motion of its body.
///
/// ```
/// use d2m_feature::{MovingTriangle, stay_within};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let resting = MovingTriangle { corners: [DVec3::ZERO, DVec3::X, DVec3::Y], motion: &ConstantTwist::REST };
/// assert!(stay_within(&[resting, resting], 0.0, 1.0, 1e-9)); // they are the same
/// ```
#[derive(Clone, Copy)]
pub struct MovingTriangle<'m> {
    /// Its corners, in the frame of the body.
    pub corners: [DVec3; 3],
    /// How the body moves.
    pub motion: &'m dyn RigidMotion,
}

impl core::fmt::Debug for MovingTriangle<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("MovingTriangle").field("corners", &self.corners).finish_non_exhaustive()
    }
}

/// Proof that two triangles are within `level` of each other at every time from `from` to `to`, without a joint of their motions between;
/// false proves nothing. O(1): halve a span that is not proven.
///
/// An edge that passes through a triangle, two material points or a vertex above a face are shown to stay near, by states at the middle of the
/// span and bounds on accelerations; then points that wander on both triangles (docs/theory/questions.md, "Staying in contact").
///
/// ```
/// use d2m_feature::{MovingTriangle, stay_within};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let sliding = ConstantTwist::REST.with_position(DVec3::Z * 0.1).with_linear_velocity(DVec3::X * 0.5);
/// let triangles = [&ConstantTwist::REST, &sliding].map(|motion| MovingTriangle { corners, motion });
/// assert!(stay_within(&triangles, 0.0, 1.0, 0.1001) && !stay_within(&triangles, 0.0, 1.0, 0.0999));
/// ```
pub fn stay_within(triangles: &[MovingTriangle<'_>; 2], from: f64, to: f64, level: f64) -> bool {
    StraightPair::new(triangles, from, to).stay_within(level)
        || to > from && CurvedPair::new(triangles, from, to).stay_within(level)
}
