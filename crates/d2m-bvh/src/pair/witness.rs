//! Two triangles that are about the closest, and the line between them.

use super::scene::MovingScene;
use crate::pair::motion::frame::Frame;
use crate::pair::triangles::closest::closest;
use crate::pair::triangles::separating_axis::place_a;
use d2m_lanes::F64x4;
use glam::DVec3;

/// Two triangles whose line is tried.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Witness {
    /// Corners of the one of A and of the one of B, from the trees' centers, body axes.
    a: [DVec3; 3],
    b: [DVec3; 3],
}

impl Witness {
    pub(crate) fn new(scene: &MovingScene<'_>, [a, b]: [u32; 2]) -> Self {
        Self { a: scene.a.corners(a), b: scene.b.corners(b) }
    }

    /// The unit vector between their closest points, by the axes of B; zero, along which nothing is apart, where they meet.
    pub(crate) fn line(&self, frame: &Frame) -> DVec3 {
        closest::<F64x4>(&place_a::<F64x4>(frame, &self.a), &self.b).direction.normalize_or_zero()
    }
}
