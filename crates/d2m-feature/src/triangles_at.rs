//! Two triangles where motions that enclose themselves place them, and what that proves.

use crate::staying::MovingTriangle;
use crate::{TriangleDistance, proven_crossing, triangle_distance};
use d2m_lanes::UP;
use d2m_motion::{CertifiedState, Twist, length};
use glam::DVec3;

/// Two triangles at one time, placed by plain arithmetic, and how far they may be from where they truly are.
///
/// ```
/// use d2m_feature::{MovingTriangle, TrianglesAt};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let rising = ConstantTwist::REST.with_linear_velocity(DVec3::Z);
/// let triangles = [&ConstantTwist::REST, &rising].map(|motion| MovingTriangle { corners, motion });
/// let placed = TrianglesAt::new(&triangles, 0.25);
/// let near = placed.distance();
/// assert!((0.25..0.25 + 1e-9).contains(&placed.bound_distance(&near)));
/// assert!((placed.closing_speed(&near, DVec3::Z) + 1.0).abs() < 1e-9 && !placed.certainly_cross());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TrianglesAt {
    corners: [[DVec3; 3]; 2],
    /// How far a corner of each may be from where it truly is.
    errors: [f64; 2],
    /// The point that all is relative to.
    origin: DVec3,
    /// The reference points, and how they move.
    moving: [(DVec3, Twist); 2],
}

/// Factor of the rounding of a placed corner: a difference, a product with a matrix (3u in each coordinate of the sum of magnitudes, so
/// 3√3·√3 u of the length) and a sum are below 16u of the lengths.
const PLACED: f64 = 8.0 * f64::EPSILON;

impl TrianglesAt {
    /// At a time, relative to a point near the bodies.
    pub fn new(triangles: &[MovingTriangle<'_>; 2], time: f64) -> Self {
        let origin = triangles[1].motion.pose_and_twist(time).0.translation;
        let states = triangles.map(|triangle| triangle.motion.enclose_state_about(time, origin));
        let given = triangles.map(|triangle| triangle.corners);
        let place = |state: &CertifiedState, p: DVec3| state.rotation * (p - state.at) + state.position;
        let error = |state: &CertifiedState, corners: &[DVec3; 3]| {
            let far = corners.iter().map(|&p| length(p - state.at)).fold(0.0, f64::max) * UP;
            let rounding = PLACED * (far + length(state.position));
            (state.position_radius + state.rotation_radius * far + rounding) * UP + f64::MIN_POSITIVE
        };
        let twist = |state: &CertifiedState| Twist { linear: state.linear, angular: state.angular };
        Self {
            corners: [0, 1].map(|k| given[k].map(|p| place(&states[k], p))),
            errors: [0, 1].map(|k| error(&states[k], &given[k])),
            origin,
            moving: [0, 1].map(|k| (states[k].position, twist(&states[k]))),
        }
    }

    /// A point of these coordinates in the world, rounded.
    pub fn world(&self, point: DVec3) -> DVec3 {
        self.origin + point
    }

    /// How far apart the placed ones are, and where.
    pub fn distance(&self) -> TriangleDistance {
        triangle_distance(&self.corners[0], &self.corners[1])
    }

    /// The true triangles are within this of each other; what is not a number says nothing.
    pub fn bound_distance(&self, near: &TriangleDistance) -> f64 {
        (near.upper + (self.errors[0] + self.errors[1])) * UP
    }

    /// The speed at which the closest points come together along a direction.
    pub fn closing_speed(&self, near: &TriangleDistance, along: DVec3) -> f64 {
        let speed = |k: usize, point: DVec3| {
            let (from, twist) = self.moving[k];
            twist.velocity_of(point - from)
        };
        (speed(0, near.point_a) - speed(1, near.point_b)).dot(along)
    }

    /// Proof that the true triangles share a point; false proves nothing.
    pub fn certainly_cross(&self) -> bool {
        let [a, b] = self.errors;
        // The greater of a number and of what is none is the number: nothing would be known of the other triangle.
        (a + b).is_finite() && proven_crossing(&self.corners[0], &self.corners[1], a.max(b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_interval::Interval;
    use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion};

    /// At rest, and known at one time within so much of its place and of its rotation.
    struct Known([f64; 2]);

    impl RigidMotion for Known {
        fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
            ConstantTwist::REST.pose_and_twist(t)
        }
        fn enclose_pose(&self, t: Interval) -> IntervalPose {
            ConstantTwist::REST.enclose_pose(t)
        }
        fn enclose_twist(&self, t: Interval) -> IntervalTwist {
            ConstantTwist::REST.enclose_twist(t)
        }
        fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
            ConstantTwist::REST.enclose_twist_rate(t)
        }
        fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
            let [position_radius, rotation_radius] = self.0;
            let state = ConstantTwist::REST.enclose_state_about(t, origin);
            CertifiedState { position_radius, rotation_radius, ..state }
        }
    }

    /// Triangles cross only where both are known, whichever of them is not.
    #[test]
    fn what_is_placed_anywhere_crosses_nothing() {
        let flat = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
        let upright = flat.map(|p| DVec3::new(0.1, p.x, p.y));
        let crossing = |radii: [[f64; 2]; 2]| {
            let motions = radii.map(Known);
            let triangle = |k: usize, corners| MovingTriangle { corners, motion: &motions[k] };
            TrianglesAt::new(&[triangle(0, flat), triangle(1, upright)], 0.0).certainly_cross()
        };
        assert!(crossing([[0.0; 2]; 2]) && crossing([[1e-3; 2]; 2]));
        for unknown in [f64::NAN, f64::INFINITY, 10.0] {
            for radii in [[unknown, 0.0], [0.0, unknown]] {
                assert!(!crossing([radii, [0.0; 2]]) && !crossing([[0.0; 2], radii]), "{radii:?}");
            }
        }
    }
}
