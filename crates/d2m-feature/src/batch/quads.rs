//! Four features side by side, placed for one pair of bodies and one window.
use crate::pair_motion::PairMotion;
use crate::point_triangle::TrianglePlanes;
use d2m_motion::Remainder;
use glam::DVec3;

const UP: f64 = 1.0 + 1e-14;

/// Four numbers side by side.
pub(super) type Four = [f64; 4];
/// Four vectors, coordinate by coordinate.
pub(super) type Four3 = [Four; 3];

fn gather(v: [DVec3; 4]) -> Four3 {
    [v.map(|v| v.x), v.map(|v| v.y), v.map(|v| v.z)]
}

/// Four points of A, placed by [`PairMotion::place_points`].
#[derive(Debug, Clone)]
pub struct PointQuad {
    pub(super) arm: Four3,
    /// How far the point strays from where it is in the middle: V·h and the rounding of a position.
    pub(super) stray: Four,
    /// Remainder of the jets about the middle, at the ends of the window.
    pub(super) margin: Four,
}

/// Four triangles of B, placed by [`PairMotion::place_triangles`].
#[derive(Debug, Clone)]
pub struct TriangleQuad {
    pub(super) centre: Four3,
    pub(super) radius: Four,
    /// The face normals and the side normals, with their supports (least, greatest).
    pub(super) planes: [(Four3, Four, Four); 4],
    /// Rounding of the comparison with the vertices.
    pub(super) margin: Four,
}

/// Four edges of A or B, placed by [`PairMotion::place_edges_a`] or [`PairMotion::place_edges_b`].
#[derive(Debug, Clone)]
pub struct EdgeQuad {
    pub(super) middle: Four3,
    pub(super) half: Four3,
    /// Half lengths, rounded up.
    pub(super) length: Four,
    /// How far a midpoint of A strays from where it is in the middle, as for points.
    pub(super) stray: Four,
    /// How far a half edge of A turns from where it is in the middle of the window: w·length·h.
    pub(super) turn: Four,
    /// What the second-order term adds: ½K2·length·h².
    pub(super) bend: Four,
    pub(super) margin: Four,
}

impl PairMotion {
    /// Half the window, rounded up.
    pub(super) fn half_window(&self) -> f64 {
        0.5 * self.forward().motion.duration() * UP
    }

    /// Rounding of a comparison with points of B within `extent`: what they add to a point's remainder, which is
    /// that of a direction without its third derivative.
    fn comparison_margin(&self, extent: f64) -> f64 {
        let remainder = self.forward().motion.direction_remainder(extent);
        Remainder { m3: 0.0, ..remainder }.bound(self.half_window())
    }

    /// `V·h + e0`: how far a point of A within `radius` is from its computed place in the middle, at any time.
    fn stray(&self, radius: f64) -> f64 {
        let motion = &self.forward().motion;
        (motion.bound_speed(radius) * self.half_window() + motion.point_remainder(radius, 0.0).e0) * UP
    }

    /// Four points of A (body frame) for [`PairMotion::reject_points`].
    pub fn place_points(&self, points: &[DVec3; 4]) -> PointQuad {
        let motion = &self.forward().motion;
        let arms = points.map(|point| motion.place_a(point));
        let margin = arms.map(|r| motion.point_remainder(r.length() * UP, 0.0).bound(self.half_window()));
        let stray = arms.map(|r| self.stray(r.length() * UP));
        PointQuad { arm: gather(arms), stray, margin }
    }

    /// Four triangles of B (body frame) for [`PairMotion::reject_points`].
    pub fn place_triangles(&self, triangles: &[[DVec3; 3]; 4]) -> TriangleQuad {
        let planes =
            triangles.map(|triangle| TrianglePlanes::new(triangle.map(|v| self.forward().motion.place_b(v))));
        let plane = |normals: [DVec3; 4], supports: [(f64, f64); 4]| {
            (gather(normals), supports.map(|s| s.0), supports.map(|s| s.1))
        };
        let side = |k: usize| {
            plane([0, 1, 2, 3].map(|i| planes[i].sides[k]), [0, 1, 2, 3].map(|i| planes[i].side_support[k]))
        };
        let face = plane([0, 1, 2, 3].map(|i| planes[i].normal), [0, 1, 2, 3].map(|i| planes[i].slab));
        TriangleQuad {
            centre: gather([0, 1, 2, 3].map(|i| planes[i].centre)),
            radius: [0, 1, 2, 3].map(|i| planes[i].radius),
            margin: [0, 1, 2, 3].map(|i| self.comparison_margin(planes[i].extent)),
            planes: [face, side(0), side(1), side(2)],
        }
    }

    /// Four edges of A (body frame) for [`PairMotion::reject_edges`].
    pub fn place_edges_a(&self, edges: &[[DVec3; 2]; 4]) -> EdgeQuad {
        let motion = &self.forward().motion;
        let h = self.half_window();
        let halves = edges.map(|[p, q]| motion.turn_a((q - p) * 0.5));
        let middles = [0, 1, 2, 3].map(|i| motion.place_a(edges[i][0]) + halves[i]);
        let length = halves.map(|e| e.length() * UP);
        // Rounding of the point and of the direction; what the direction does beyond is in `turn` and `bend`.
        let margin = [0, 1, 2, 3].map(|i| {
            let reach = (middles[i].length() + length[i]) * UP;
            (motion.point_remainder(reach, 0.0).bound(h) + self.comparison_margin(length[i])) * UP
        });
        let turned = |order: u32, factor: f64| {
            length.map(|l| motion.bound_direction_derivative(order) * l * factor * UP)
        };
        EdgeQuad {
            middle: gather(middles),
            half: gather(halves),
            length,
            stray: middles.map(|r| self.stray(r.length() * UP)),
            turn: turned(1, h),
            bend: turned(2, 0.5 * h * h),
            margin,
        }
    }

    /// Four edges of B (body frame) for [`PairMotion::reject_edges`].
    pub fn place_edges_b(&self, edges: &[[DVec3; 2]; 4]) -> EdgeQuad {
        let motion = &self.forward().motion;
        let halves = edges.map(|[p, q]| motion.turn_b((q - p) * 0.5));
        let middles = [0, 1, 2, 3].map(|i| motion.place_b(edges[i][0]) + halves[i]);
        let length = halves.map(|d| d.length() * UP);
        let margin = [0, 1, 2, 3].map(|i| self.comparison_margin((middles[i].length() + length[i]) * UP));
        EdgeQuad {
            middle: gather(middles),
            half: gather(halves),
            length,
            stray: [0.0; 4],
            turn: [0.0; 4],
            bend: [0.0; 4],
            margin,
        }
    }
}
