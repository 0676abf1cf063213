//! Paths of single points over a span of time, as lines and what accelerations take from them.

use crate::pair::motion::frame::Frame;
use crate::pair::scene::MovingScene;
use crate::pair::triangles::separating_axis::place_point;
use d2m_lanes::F64x4;
use d2m_mesh::margin::UP;
use glam::DVec3;

/// One of the two bodies.
#[derive(Clone, Copy, Debug)]
pub(super) enum Side {
    A,
    B,
}

/// How the points of one body move over a span that begins at the time of a frame, in the frame of B at that time.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyPaths<'f> {
    frame: &'f Frame,
    side: Side,
    /// From the point on the axis of the spin that moves evenly to the center of the tree.
    arm: DVec3,
    omega: DVec3,
    span: f64,
}

/// The path of a point: from `now` to `later` at the rate of its first end, less what accelerations take from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    pub(super) now: DVec3,
    pub(super) later: DVec3,
    /// |ω × e| T²/2, e from the axis of the spin: times |n × ω|, the point is no further from `later` along n. It is as
    /// much less at earlier times s as s² is less than T².
    pub(super) bend: f64,
}

impl<'f> BodyPaths<'f> {
    pub(super) fn new(scene: &MovingScene<'_>, frame: &'f Frame, side: Side, span: f64) -> Self {
        let [arm_a, arm_b] = scene.pair.arms;
        let (arm, omega) = match side {
            Side::A => (frame.rotation.transform(arm_a), frame.omega_a.to_vec()),
            Side::B => (arm_b, frame.omega_b.to_vec()),
        };
        Self { frame, side, arm, omega, span }
    }

    /// Of a point that is given relative to the tree's center.
    pub(super) fn of(&self, point: DVec3) -> Path {
        let (now, from_center, drift) = match self.side {
            Side::A => {
                let now = place_point::<F64x4>(self.frame, point);
                (now, now - self.frame.apart.to_vec(), self.frame.velocity.to_vec())
            }
            Side::B => (point, point, DVec3::ZERO),
        };
        let later = now + (drift + self.omega.cross(from_center)) * self.span;
        let speed = self.omega.cross(from_center + self.arm).length();
        Path { now, later, bend: 0.5 * speed * self.span * self.span * UP }
    }

    /// How much of what is bent counts along a direction: |n × ω|.
    pub(super) fn turn(&self, n: DVec3) -> f64 {
        n.cross(self.omega).length() * UP
    }

    /// Where the end of a path may be that is the furthest along `n`: |ω × x| for |x| ≤ 1 reaches |n × ω| along n.
    pub(super) fn furthest_end(&self, path: &Path, n: DVec3) -> DVec3 {
        let across = n.cross(self.omega).normalize_or_zero();
        path.later + self.omega.cross(across) * path.bend
    }
}

impl Path {
    /// How far the point reaches along a direction at both ends of the span, with `turn` of that direction.
    pub(super) fn along(&self, n: DVec3, turn: f64) -> [f64; 2] {
        [n.dot(self.now), n.dot(self.later) + turn * self.bend]
    }
}
