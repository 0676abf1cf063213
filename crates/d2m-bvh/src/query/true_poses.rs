//! Times at which two triangles certainly are near each other, where motions that enclose themselves place them.

use crate::moving::triangles_of;
use crate::{Moving, Window};
use d2m_feature::{TriangleDistance, TrianglesAt};
use d2m_mesh::margin::direction;

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
    fn is_near(&self, placed: &TrianglesAt, near: &TriangleDistance) -> bool {
        placed.bound_distance(near) <= self.separation + 0.5 * self.tolerance
    }

    /// Are two triangles certainly so near each other at this time?
    pub(super) fn are_near(&self, triangles: [u32; 2], time: f64) -> bool {
        let placed = TrianglesAt::new(&triangles_of(self.bodies, triangles), time);
        self.is_near(&placed, &placed.distance())
    }

    /// A time at which two triangles are certainly within the separation and half of the tolerance of each other; `None` when a
    /// few steps of Newton's method from `time` find none. No search of these motions can call that free: it would prove them
    /// apart by more than three quarters of the tolerance.
    pub(super) fn found_near(&self, triangles: [u32; 2], mut time: f64) -> Option<f64> {
        let (first, last) = (self.window.start(), self.window.end());
        for _ in 0..STEPS {
            time = time.clamp(first, last);
            let placed = TrianglesAt::new(&triangles_of(self.bodies, triangles), time);
            let near = placed.distance();
            if self.is_near(&placed, &near) {
                return Some(time);
            }
            let along = direction(near.point_b - near.point_a);
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
