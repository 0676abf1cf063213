//! Closest points of point/triangle and segment/segment at one time, made for certifying directions.
use crate::accurate_cross::{Difference, accurate_cross};
use glam::DVec3;

/// A closest pair: weights and the difference vector from B to A.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ClosestPair {
    /// Weights of A's vertices (edge) or `[1, 0, 0]` (point).
    pub(crate) a: [f64; 3],
    /// Weights of B's vertices.
    pub(crate) b: [f64; 3],
    /// Point of A minus point of B.
    pub(crate) difference: DVec3,
    /// The same, made orthogonal to the edges in whose interior the closest points lie: the better direction.
    pub(crate) separating: DVec3,
}

/// Parameter in [0, 1] of the point of `a + s·(b − a)` closest to the origin, and that point.
fn on_segment(a: DVec3, b: DVec3) -> (f64, DVec3) {
    let edge = b - a;
    let square = edge.length_squared();
    let s = if square > 0.0 { (-a.dot(edge) / square).clamp(0.0, 1.0) } else { 0.0 };
    // From the nearer end, so that a far end does not spoil the digits.
    if s <= 0.5 { (s, a + edge * s) } else { (s, b - edge * (1.0 - s)) }
}

/// Makes `v` orthogonal to `edge`, twice, so that cancellation in the first pass is repaired.
fn orthogonal(v: DVec3, edge: DVec3) -> DVec3 {
    let square = edge.length_squared();
    if square == 0.0 {
        return v;
    }
    let once = v - edge * (v.dot(edge) / square);
    once - edge * (once.dot(edge) / square)
}

/// Weights of the corners of a triangle for its point closest to another one, to rounding: a guess, which proves nothing. Not negative, with a sum
/// of one to rounding.
///
/// ```
/// use d2m_feature::estimate_closest_weights;
/// use glam::{DVec3, dvec3};
/// let triangle = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
/// assert_eq!(estimate_closest_weights(dvec3(1.0, 1.0, 3.0), &triangle), [0.5, 0.25, 0.25]);
/// assert_eq!(estimate_closest_weights(dvec3(5.0, -1.0, 0.0), &triangle), [0.0, 1.0, 0.0]);
/// ```
pub fn estimate_closest_weights(point: DVec3, triangle: &[DVec3; 3]) -> [f64; 3] {
    let [a, b, c] = *triangle;
    point_triangle(point, triangle, (b - a).cross(c - a)).b
}

/// The point of a triangle closest to another one: of the triangle to rounding, the closest of it by a guess, which proves nothing.
///
/// ```
/// use d2m_feature::estimate_closest_point;
/// use glam::{DVec3, dvec3};
/// let triangle = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
/// assert_eq!(estimate_closest_point(dvec3(1.0, 1.0, 3.0), &triangle), dvec3(1.0, 1.0, 0.0));
/// ```
pub fn estimate_closest_point(point: DVec3, triangle: &[DVec3; 3]) -> DVec3 {
    let [a, b, c] = *triangle;
    let weights = estimate_closest_weights(point, triangle);
    a + (b - a) * weights[1] + (c - a) * weights[2]
}

/// The point of a triangle closest to `p`. Sound for any triangle: the face is used only if the projection is inside
/// by exact-sign-free tests and closer than all three edges.
pub(crate) fn point_triangle(p: DVec3, triangle: &[DVec3; 3], normal: DVec3) -> ClosestPair {
    let local = [triangle[0] - p, triangle[1] - p, triangle[2] - p];
    let mut best = (
        f64::INFINITY,
        ClosestPair {
            a: [1.0, 0.0, 0.0],
            b: [1.0, 0.0, 0.0],
            difference: DVec3::ZERO,
            separating: DVec3::ZERO,
        },
    );
    for i in 0..3 {
        let j = (i + 1) % 3;
        let (s, point) = on_segment(local[i], local[j]);
        let square = point.length_squared();
        if square < best.0 {
            let mut b = [0.0; 3];
            b[i] = 1.0 - s;
            b[j] = s;
            let separating =
                if s > 0.0 && s < 1.0 { orthogonal(-point, local[j] - local[i]) } else { -point };
            best = (square, ClosestPair { a: [1.0, 0.0, 0.0], b, difference: -point, separating });
        }
    }
    if normal != DVec3::ZERO {
        // Weights from the areas seen along the normal; all positive means that the foot is inside.
        let area = |i: usize, j: usize| local[i].cross(local[j]).dot(normal);
        let (u, v, w) = (area(1, 2), area(2, 0), area(0, 1));
        let sum = u + v + w;
        if u > 0.0 && v > 0.0 && w > 0.0 && sum > 0.0 && sum.is_finite() {
            let mut b = [u / sum, v / sum, w / sum];
            let mut point = local[0] * b[0] + local[1] * b[1] + local[2] * b[2];
            // Areas of a sliver are mostly rounding, which moves the point along it: back to the foot on the longest side's
            // direction. Across it a wrong weight does little.
            let edges = [local[1] - local[0], local[2] - local[1], local[0] - local[2]];
            let squares = edges.map(DVec3::length_squared);
            let i = (0..3).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
            let s = -point.dot(edges[i]) / squares[i];
            b[i] -= s;
            b[(i + 1) % 3] += s;
            point += edges[i] * s;
            if b.iter().all(|&weight| weight >= 0.0) && point.length_squared() <= best.0 {
                let side = if normal.dot(point) > 0.0 { -normal } else { normal };
                return ClosestPair { a: [1.0, 0.0, 0.0], b, difference: -point, separating: side };
            }
        }
    }
    best.1
}

/// Squared sine of the angle between two edges below which their common normal is made with twice the digits.
const SLIGHT: f64 = 1e-4;
/// Squared sine of the angle between two edges from which they have a common normal: below 10⁻¹⁵ rad the edges themselves
/// are rounded by more. The closest points from the ends serve then.
const SIN_SQUARED: f64 = 1e-30;

/// Closest points of the segments `w ± e` (A) and `± d` (B).
pub(crate) fn segment_segment(w: DVec3, e: DVec3, d: DVec3) -> ClosestPair {
    let mut best = (f64::INFINITY, 0.0, 0.0, DVec3::ZERO, DVec3::ZERO);
    let mut offer = |s: f64, t: f64, difference: DVec3, separating: DVec3| {
        let square = difference.length_squared();
        if square < best.0 {
            best = (square, s, t, difference, separating);
        }
    };
    // Ends of A against B, ends of B against A: the parameter runs over [−1, 1].
    for s in [-1.0, 1.0] {
        let end = w + e * s;
        let (x, foot) = on_segment(-d - end, d - end);
        let inside = x > 0.0 && x < 1.0;
        offer(s, 2.0 * x - 1.0, -foot, if inside { orthogonal(-foot, d) } else { -foot });
        let end = d * s;
        let (x, foot) = on_segment(w - e - end, w + e - end);
        let inside = x > 0.0 && x < 1.0;
        offer(2.0 * x - 1.0, s, foot, if inside { orthogonal(foot, e) } else { foot });
    }
    let (e_squared, d_squared) = (e.length_squared(), d.length_squared());
    let mut k = e.cross(d);
    if k.length_squared() < SLIGHT * e_squared * d_squared {
        // Rounding of e × d turns it by 2⁻⁵³ over the sine of the angle: with twice the digits by nothing that matters.
        k = accurate_cross(Difference::from(e), Difference::from(d));
    }
    let square = k.length_squared();
    if square > SIN_SQUARED * e_squared * d_squared && square.is_normal() {
        // (w + s e − t d) ∥ k: s = −(w × d)·k/|k|². For lines that are nearly parallel s is poor, but the closest point of
        // the other line to any point of this one is not, and it is as close up to the square of the angle.
        let s = -w.cross(d).dot(k) / square;
        let t = (w + e * s).dot(d) / d_squared;
        let s = (d * t - w).dot(e) / e_squared;
        if s.abs() < 1.0 && t.abs() < 1.0 {
            let difference = w + e * s - d * t;
            let side = if difference.dot(k) < 0.0 { -k } else { k };
            offer(s, t, difference, side);
        }
    }
    let (_, s, t, difference, separating) = best;
    ClosestPair {
        a: [0.5 - 0.5 * s, 0.5 + 0.5 * s, 0.0],
        b: [0.5 - 0.5 * t, 0.5 + 0.5 * t, 0.0],
        difference,
        separating,
    }
}
