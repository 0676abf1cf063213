//! A point and a triangle, all four vertices on straight paths.
use super::linear::{Clearance, Line, Linear, clear_above};
use super::straight_test::{Inside, SeenAlong, StraightFeatures, StraightTest};
use super::triple_product::{Allowed, Seen};
use super::{Lines, larger, largest};
use crate::closest::{self, ClosestPair};
use crate::options::ContactOptions;
use crate::path::direction;
use crate::rounding::{UNDERFLOW, UP, length_up};
use core::marker::PhantomData;
use d2m_root::{Band, Piece};
use glam::DVec3;

/// With `a` from a vertex to the point and `e₁`, `e₂` from it to the others: `f = a·(e₁ × e₂)`. The vertex is the one across from
/// the side that is longest at the start.
pub(super) struct PointTriangle;

impl StraightTest<PointTriangle> {
    #[inline(always)]
    pub(super) fn of_point(lines: &Lines, options: &ContactOptions) -> Self {
        let Lines { start, velocity, .. } = lines;
        let square = |a: usize, b: usize| (start[a] - start[b]).length_squared();
        let squares = [square(2, 3), square(3, 1), square(1, 2)];
        let (vertex, first, second, square) = if squares[0] >= squares[1] && squares[0] >= squares[2] {
            (1, 2, 3, squares[0])
        } else if squares[1] >= squares[2] {
            (2, 3, 1, squares[1])
        } else {
            (3, 1, 2, squares[2])
        };
        let between = |a: usize, b: usize| Line { p: start[a] - start[b], v: velocity[a] - velocity[b] };
        let (a, e1, e2) = (between(0, vertex), between(first, vertex), between(second, vertex));
        let speeds = [a.v.length_squared(), (a.v - e1.v).length_squared(), (a.v - e2.v).length_squared()];
        let error = lines.error(48.0);
        Self {
            features: PhantomData,
            lines: [a, e1, e2],
            error,
            size: lines.magnitude,
            speed: largest(&speeds).sqrt() * UP + UNDERFLOW,
            tolerance: larger(options.wanted_tolerance(square.sqrt(), lines.magnitude), 4.0 * error),
            separation: options.separation(),
            inside: Piece::NONE,
        }
    }
}

impl PointTriangle {
    /// The vectors from the three vertices to the point.
    #[inline(always)]
    fn differences([a, e1, e2]: &[Line; 3]) -> [Line; 3] {
        [*a, *a - *e1, *a - *e2]
    }

    /// The triangle's vertices from the point, and its normal.
    #[inline(always)]
    fn triangle(lines: &[Line; 3]) -> ([DVec3; 3], DVec3) {
        let vertices = Self::differences(lines).map(|line| -line.p);
        (vertices, direction((vertices[1] - vertices[0]).cross(vertices[2] - vertices[0])))
    }
}

impl StraightFeatures for PointTriangle {
    /// Outside throughout, seen along the line from the mean of the vertices to the point.
    #[inline(always)]
    fn are_apart([a, e1, e2]: &[Line; 3], margin: f64, h: f64) -> bool {
        let away = a.p * 3.0 - (e1.p + e2.p);
        let margin = margin * length_up(away);
        let (a, e1, e2) = (a.along(away), e1.along(away), e2.along(away));
        let from = |e: Linear| Linear { value: a.value - e.value, slope: a.slope - e.slope };
        [a, from(e1), from(e2)].iter().all(|f| f.least(h) > margin)
    }

    /// Areas as parts of the triangle's: a = λ₁e₁ + λ₂e₂ gives n·(a × e₂) = λ₁·whole and n·(e₁ × a) = λ₂·whole; the third is what
    /// these leave of it.
    #[inline(always)]
    fn clip_inside([a, e1, e2]: &[Line; 3], seen: &SeenAlong, in_plane: Piece) -> Option<Inside> {
        let SeenAlong { normal: n, length, lengths: [la, l1, l2], allowed, padded } = *seen;
        let (across1, across2) = (e1.cross(-n), e2.cross(n));
        let total = Seen::new(e1, &across2, length, [l1, l2], Allowed { separation: 0.0, ..allowed });
        let mut part = in_plane;
        if !total.is_positive(padded) {
            return Some(Inside { part, is_certain: false });
        }
        let first = Seen::new(a, &across2, length, [la, l2], allowed);
        let second = Seen::new(a, &across1, length, [la, l1], allowed);
        let third = Seen {
            quadratic: total.quadratic - (first.quadratic + second.quadratic),
            margin: (total.margin + first.margin + second.margin) * UP,
        };
        let areas = [first, second, third];
        // A contact needs all three parts at least 0.
        for area in &areas {
            let positive = Band { lo: 0.0, hi: f64::INFINITY };
            // Its margin covers the evaluation: 46u of the 56u of each product, 12u of them of values and slopes and 24u
            // of half the curvature (features.md, "Straight paths"); the third has all three margins.
            part = area.quadratic.clip_beyond(positive, area.margin, part)?;
        }
        let is_certain = part == in_plane && areas.iter().all(|area| area.is_positive(padded));
        Some(Inside { part, is_certain })
    }

    #[inline(always)]
    fn closest(lines: &[Line; 3]) -> ClosestPair {
        let (vertices, normal) = Self::triangle(lines);
        closest::point_triangle(DVec3::ZERO, &vertices, normal)
    }

    #[inline(always)]
    fn clear_along(lines: &[Line; 3], n: DVec3, margin: f64) -> Clearance {
        clear_above(&Self::differences(lines).map(|line| line.along(n)), margin)
    }

    #[inline(always)]
    fn directions(lines: &[Line; 3], mut consider: impl FnMut(DVec3)) {
        let (vertices, normal) = Self::triangle(lines);
        consider(normal);
        consider(-normal);
        for i in 0..3 {
            consider(direction((vertices[(i + 1) % 3] - vertices[i]).cross(normal)));
        }
    }
}
