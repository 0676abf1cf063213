//! Two triangles where motions that enclose themselves place them, and what that proves.

use crate::{Moving, Window};
use d2m_feature::proven_crossing;
use d2m_feature::{TriangleDistance, triangle_distance};
use d2m_lanes::UP;
use d2m_mesh::margin::length;
use d2m_motion::{CertifiedState, Twist};
use glam::DVec3;

/// Corners of a triangle of each body, placed by plain arithmetic.
pub(super) struct PlacedTriangles {
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

impl PlacedTriangles {
    /// At a time, relative to a point near the bodies.
    pub(super) fn new(bodies: &[Moving<'_>; 2], triangles: [u32; 2], time: f64) -> Self {
        let origin = bodies[1].motion.pose_and_twist(time).0.translation;
        let states = bodies.map(|body| body.motion.enclose_state_about(time, origin));
        let given = [0, 1].map(|k| bodies[k].body.mesh().corners(triangles[k] as usize));
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
    pub(super) fn world(&self, point: DVec3) -> DVec3 {
        self.origin + point
    }

    pub(super) fn distance(&self) -> TriangleDistance {
        triangle_distance(&self.corners[0], &self.corners[1])
    }

    /// The true triangles are within this of each other; what is not a number says nothing.
    pub(super) fn bound_distance(&self, near: &TriangleDistance) -> f64 {
        (near.upper + (self.errors[0] + self.errors[1])) * UP
    }

    /// The speed at which the closest points come together along a direction.
    pub(super) fn closing_speed(&self, near: &TriangleDistance, along: DVec3) -> f64 {
        let speed = |k: usize, point: DVec3| {
            let (from, twist) = self.moving[k];
            twist.velocity_of(point - from)
        };
        (speed(0, near.point_a) - speed(1, near.point_b)).dot(along)
    }

    /// Proof that the true triangles share a point; false proves nothing.
    pub(super) fn certainly_cross(&self) -> bool {
        proven_crossing(&self.corners[0], &self.corners[1], self.errors[0].max(self.errors[1]))
    }
}

/// Steps of Newton's method towards the time at which two triangles meet.
const STEPS: u32 = 8;
/// Part of a tolerance that triangles are brought to.
const AIM: f64 = 0.25;

/// What two triangles are to come to: within so much of each other, at a time of a window.
pub(super) struct Meeting<'m> {
    pub(super) bodies: &'m [Moving<'m>; 2],
    pub(super) window: Window,
    pub(super) separation: f64,
    pub(super) tolerance: f64,
}

impl Meeting<'_> {
    fn is_near(&self, placed: &PlacedTriangles, near: &TriangleDistance) -> bool {
        placed.bound_distance(near) <= self.separation + 0.5 * self.tolerance
    }

    /// Are two triangles certainly so near each other at this time?
    pub(super) fn are_near(&self, triangles: [u32; 2], time: f64) -> bool {
        let placed = PlacedTriangles::new(self.bodies, triangles, time);
        self.is_near(&placed, &placed.distance())
    }

    /// A time at which two triangles are certainly within the separation and half of the tolerance of each other; `None` when a
    /// few steps of Newton's method from `time` find none. No search of these motions can call that free: it would prove them
    /// apart by more than three quarters of the tolerance.
    pub(super) fn found_near(&self, triangles: [u32; 2], mut time: f64) -> Option<f64> {
        let (first, last) = (self.window.start(), self.window.end());
        for _ in 0..STEPS {
            time = time.clamp(first, last);
            let placed = PlacedTriangles::new(self.bodies, triangles, time);
            let near = placed.distance();
            if self.is_near(&placed, &near) {
                return Some(time);
            }
            let along = (near.point_b - near.point_a).normalize_or_zero();
            let target = self.separation + AIM * self.tolerance;
            // Also backwards: triangles that have passed each other were together at some time.
            let next = time + (near.upper - target) / placed.closing_speed(&near, along);
            if next.is_nan() || next.clamp(first, last) == time {
                return None;
            }
            time = next;
        }
        None
    }
}
