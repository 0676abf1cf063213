//! Boxes about what bodies sweep, and which of them meet.

mod meeting;
mod neighbors;

pub(crate) use meeting::meeting;
pub(crate) use neighbors::Neighbors;

use crate::rigid_body::RigidBody;
use d2m_motion::Pose;
use glam::DVec3;

/// An axis-aligned box, world frame, rounded outward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Aabb {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

/// Roundings of a placed point, relative to the sizes of its terms: a rotation (norm of the quaternion, nine products of
/// three) and two sums, fewer than 40 operations of relative error 2⁻⁵³ each, doubled.
const PLACED: f64 = 40.0 * f64::EPSILON;

impl Aabb {
    /// Encloses the body at all times of its flight from its state's time to `end`, grown by `margin`.
    ///
    /// The center moves on a straight line and no point is further from it than the radius.
    pub(crate) fn swept(body: &RigidBody, end: f64, margin: f64) -> Self {
        let start = body.flight.position();
        let elapsed = end - body.flight.reference_time();
        let travel = body.flight.linear_velocity() * elapsed;
        if body.stands_still() {
            return Self::posed(body, &body.pose_at(end), margin);
        }
        let finish = start + travel;
        let lost = PLACED * (start.length() + travel.length() + body.radius + margin);
        let reach = DVec3::splat(body.radius + margin + lost);
        Self { low: start.min(finish) - reach, high: start.max(finish) + reach }
    }

    /// Encloses the body in one pose, grown by `margin`.
    pub(crate) fn posed(body: &RigidBody, pose: &Pose, margin: f64) -> Self {
        let lost = PLACED * (pose.translation.length() + body.radius + margin);
        let reach = DVec3::splat(margin + body.rounding + lost);
        if body.is_dynamic() {
            let reach = DVec3::splat(margin + body.radius + lost);
            return Self { low: pose.translation - reach, high: pose.translation + reach };
        }
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mesh = body.tree.mesh();
        for &vertex in mesh.triangles().iter().flatten() {
            let p = pose.transform_point(mesh.vertices()[vertex as usize]);
            (low, high) = (low.min(p), high.max(p));
        }
        Self { low: low - reach, high: high + reach }
    }

    /// Can the boxes share a point? Yes when a bound is not a number.
    #[inline]
    pub(crate) fn may_meet(&self, other: &Self) -> bool {
        !(self.low.cmpgt(other.high).any() || other.low.cmpgt(self.high).any())
    }

    /// Grown by this much on all sides.
    fn grown(&self, by: f64) -> Self {
        Self { low: self.low - by, high: self.high + by }
    }

    /// No when a bound is not a number.
    fn holds(&self, other: &Self) -> bool {
        self.low.cmple(other.low).all() && self.high.cmpge(other.high).all()
    }
}
