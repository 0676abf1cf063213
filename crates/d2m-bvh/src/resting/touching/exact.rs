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
        !pair.is_flat && !pair.axes.iter().any(|axis| axis.across.is_none() || self.is_parted_by(pair, axis))
    }

    /// Does a direction rise, in exact signs, from a plane between the two triangles, along one of their axes or of these others? By at least
    /// half of this sine.
    pub(super) fn part_along(&self, pair: &TouchingPair, others: &[Axis], n: DVec3, rise: f64) -> bool {
        let rises = |axis: &&Axis| axis.direction.dot(n) >= 0.5 * rise && axis.blur <= 0.125 * rise;
        others.iter().chain(&pair.axes).filter(rises).any(|axis| self.is_parted_by(pair, axis))
    }

    /// Is it proven that the triangles share no point of their relative interiors, since along the axis none of A's is above any of B's?
    pub(super) fn is_parted_by(&self, pair: &TouchingPair, axis: &Axis) -> bool {
        let Some(edges) = axis.across else { return false };
        let [u, v] = edges.map(|edge| self.edge(edge));
        // Which way round the exact product is: the direction is off by less than a right angle.
        let rough = (u[0] + u[1]).cross(v[0] + v[1]).dot(axis.direction);
        if rough == 0.0 || !rough.is_finite() {
            return false;
        }
        let forbidden = if rough > 0.0 { Ordering::Less } else { Ordering::Greater };
        let corners = |body: usize| self.bodies[body].body.mesh().corners(pair.triangles[body] as usize);
        corners(0).iter().all(|&p| {
            corners(1).iter().all(|&q| triple_product_sign(&u, &v, &self.between(p, q)) != forbidden)
        })
    }

    /// From a vertex of A to one of B.
    fn between(&self, p: DVec3, q: DVec3) -> [DVec3; 8] {
        let [a, b] = &self.shifts;
        [q, -(p * self.signs[0]), b[0], b[1], b[2], -a[0], -a[1], -a[2]]
    }

    fn edge(&self, edge: EdgeOf) -> [DVec3; 2] {
        let corners = self.bodies[edge.body].body.mesh().corners(edge.triangle as usize);
        let sign = self.signs[edge.body];
        [corners[(edge.corner + 1) % 3] * sign, -(corners[edge.corner] * sign)]
    }
}
