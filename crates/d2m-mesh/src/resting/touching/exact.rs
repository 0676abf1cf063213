//! Signs without rounding, for poses that only shift bodies.

use super::axis::{Axis, EdgeOf, TouchingPair};
use crate::Posed;
use d2m_feature::triple_product_sign;
use glam::DVec3;
use std::cmp::Ordering;

/// Two bodies whose vertices are sums of doubles in the axes of B: no rotation, half turns about the axes, or one pose for both.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactPlaces<'a> {
    bodies: [Posed<'a>; 2],
    /// What a half turn does to the axes of each body.
    signs: [DVec3; 2],
    /// What is added to each vertex of A and B besides.
    shifts: [[DVec3; 3]; 2],
}

impl<'a> ExactPlaces<'a> {
    pub(super) fn try_new(bodies: [Posed<'a>; 2]) -> Option<Self> {
        let [a, b] = bodies.map(|posed| posed.pose);
        if a.rotation == b.rotation && a.translation == b.translation {
            let shifts = [a, b].map(|pose| [-pose.at, DVec3::ZERO, DVec3::ZERO]);
            return Some(Self { bodies, signs: [DVec3::ONE; 2], shifts });
        }
        let half_turn = |pose: d2m_motion::Pose| {
            let q = pose.rotation;
            match [q.x, q.y, q.z, q.w].map(|c| c != 0.0) {
                [false, false, false, true] => Some(DVec3::ONE),
                [true, false, false, false] => Some(DVec3::new(1.0, -1.0, -1.0)),
                [false, true, false, false] => Some(DVec3::new(-1.0, 1.0, -1.0)),
                [false, false, true, false] => Some(DVec3::new(-1.0, -1.0, 1.0)),
                _ => None,
            }
        };
        let (of_a, of_b) = (half_turn(a)?, half_turn(b)?);
        // Signs of B's axes in the world are their own inverses.
        let signs = [of_a * of_b, DVec3::ONE];
        let shifts = [
            [-(a.at * signs[0]), a.translation * of_b, -(b.translation * of_b)],
            [-b.at, DVec3::ZERO, DVec3::ZERO],
        ];
        Some(Self { bodies, signs, shifts })
    }

    /// Do the triangles cross, with no plane between them? Not for triangles of no area, which are no part of an inside.
    pub(super) fn cross(&self, pair: &TouchingPair) -> bool {
        let is_parted = |axis: &Axis| axis.across.is_none() || self.is_parted_by(pair, axis);
        !pair.is_flat && !pair.axes.iter().any(is_parted) && self.no_axis_parts(pair.triangles)
    }

    /// Does none of the two normals and nine products of edges part the triangles, either way round? A pair's own axes are not all of these:
    /// those across edges that are nearly parallel are left out, since their rounded directions say nothing.
    fn no_axis_parts(&self, triangles: [u32; 2]) -> bool {
        let edges = [0, 1].map(|body| {
            [0, 1, 2].map(|corner| self.edge(EdgeOf { body, triangle: triangles[body], corner }))
        });
        let sides = |u: &[DVec3; 2], v: &[DVec3; 2]| {
            let mut seen = [false; 2];
            for p in self.corners(0, triangles[0]) {
                for q in self.corners(1, triangles[1]) {
                    match triple_product_sign(u, v, &self.between(p, q)) {
                        Ordering::Less => seen[0] = true,
                        Ordering::Greater => seen[1] = true,
                        Ordering::Equal => {}
                    }
                }
            }
            seen
        };
        // All vertices at one height above a face: it has no area, or both triangles are in one plane. Where neither face says so, nine
        // equal signs of a product of edges mean that these are parallel.
        edges.iter().all(|[u, v, _]| sides(u, v) == [true; 2])
            && edges[0]
                .iter()
                .all(|u| edges[1].iter().all(|v| matches!(sides(u, v), [true, true] | [false, false])))
    }

    /// Is it proven that a direction rises from a plane between the whole bodies, across one of these axes: none of A's vertices is above
    /// any of B's? Says what [`part_along`](Self::part_along) does of all pairs, where they are too many or not all known.
    pub(super) fn are_bodies_parted(&self, axes: &[Axis], n: DVec3, rise: f64) -> bool {
        axes.iter().filter(|axis| rises(axis, n, rise)).any(|axis| self.is_plane_between_bodies(axis))
    }

    fn is_plane_between_bodies(&self, axis: &Axis) -> bool {
        let Some((u, v, forbidden)) = self.product(axis) else { return false };
        let vertices = |body: usize| self.bodies[body].body.mesh().vertices().iter();
        // The lowest of B's vertices: what both are shifted by cancels.
        let lower = |low: DVec3, &q: &DVec3| {
            let is_lower = triple_product_sign(&u, &v, &[q, -low]) == forbidden;
            if is_lower { q } else { low }
        };
        let Some(&first) = vertices(1).next() else { return false };
        let lowest = vertices(1).fold(first, lower);
        vertices(0).all(|&p| triple_product_sign(&u, &v, &self.between(p, lowest)) != forbidden)
    }

    /// Does a direction rise, in exact signs, from a plane between the two triangles, along one of their axes or of these others? By at least
    /// half of this sine.
    pub(super) fn part_along(&self, pair: &TouchingPair, others: &[Axis], n: DVec3, rise: f64) -> bool {
        let mut rising = others.iter().chain(&pair.axes).filter(|axis| rises(axis, n, rise));
        rising.any(|axis| self.is_parted_by(pair, axis))
    }

    /// Is it proven that the triangles share no point of their relative interiors, since along the axis none of A's is above any of B's?
    pub(super) fn is_parted_by(&self, pair: &TouchingPair, axis: &Axis) -> bool {
        let Some((u, v, forbidden)) = self.product(axis) else { return false };
        self.corners(0, pair.triangles[0]).iter().all(|&p| {
            self.corners(1, pair.triangles[1])
                .iter()
                .all(|&q| triple_product_sign(&u, &v, &self.between(p, q)) != forbidden)
        })
    }

    /// The edges of an axis, and the sign that no difference from A to B may have along their exact product.
    fn product(&self, axis: &Axis) -> Option<([DVec3; 2], [DVec3; 2], Ordering)> {
        let [u, v] = axis.across?.map(|edge| self.edge(edge));
        // Which way round the exact product is: the direction is off by less than a right angle.
        let rough = (u[0] + u[1]).cross(v[0] + v[1]).dot(axis.direction);
        if rough == 0.0 || !rough.is_finite() {
            return None;
        }
        let forbidden = if rough > 0.0 { Ordering::Less } else { Ordering::Greater };
        Some((u, v, forbidden))
    }

    fn corners(&self, body: usize, triangle: u32) -> [DVec3; 3] {
        self.bodies[body].body.mesh().corners(triangle as usize)
    }

    /// From a vertex of A to one of B.
    fn between(&self, p: DVec3, q: DVec3) -> [DVec3; 8] {
        let [a, b] = &self.shifts;
        [q, -(p * self.signs[0]), b[0], b[1], b[2], -a[0], -a[1], -a[2]]
    }

    fn edge(&self, edge: EdgeOf) -> [DVec3; 2] {
        let corners = self.corners(edge.body, edge.triangle);
        let sign = self.signs[edge.body];
        [corners[(edge.corner + 1) % 3] * sign, -(corners[edge.corner] * sign)]
    }
}

/// Does a direction rise from the plane across an axis by at least half of this sine, for certain?
fn rises(axis: &Axis, n: DVec3, rise: f64) -> bool {
    axis.direction.dot(n) >= 0.5 * rise && axis.blur <= 0.125 * rise
}
