//! Closest points of two triangles: an upper bound on their distance with the features that attain it.

use d2m_lanes::{Doubles, Quad, QuadVec};
use glam::DVec3;

/// Where on a triangle a closest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Corner, by number.
    Vertex(usize),
    /// The edge from this corner to the next.
    Edge(usize),
    /// Inside the triangle.
    Face,
}

/// Two points, one on each triangle, as close as the features allow (up to rounding).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Closest {
    pub(crate) distance_squared: f64,
    pub(crate) points: [DVec3; 2],
    pub(crate) places: [Place; 2],
    /// Along the shortest line from A to B, re-orthogonalised against the edges it ends on; not normalised.
    pub(crate) direction: DVec3,
}

impl Closest {
    /// The same with the bodies exchanged.
    #[inline(always)]
    fn swapped(self) -> Self {
        let ([p, q], [on_p, on_q]) = (self.points, self.places);
        Self { points: [q, p], places: [on_q, on_p], direction: -self.direction, ..self }
    }
}

/// Square of the least sine of the angle between two edges whose cross product is a direction. The product errs by
/// 2·2⁻⁵³|e||d|, so its angle by 2·2⁻⁵³ over the sine. What it has along the edges is taken off ([`across`]); the rest tilts
/// the direction by less than a per cent, about the edges, along which it then sees nothing of them but roundings. Below that
/// angle the line between the closest points serves, which is off by a rounding over the distance (at least 2·256·2⁻⁵³ of
/// the size where it matters) times the angle: less than a rounding.
const LEAST_SINE_SQUARED: f64 = 1.0 / 4_951_760_157_141_521_099_596_496_896.0; // 2⁻⁹²

/// A direction without what it has along an edge. Cross products of edges at a small angle are wrong by a rounding over
/// that angle, and what they have along the edges counts in full in the gap.
#[inline(always)]
pub(super) fn across(direction: DVec3, edge: DVec3) -> DVec3 {
    direction - edge * (direction.dot(edge) / edge.length_squared())
}

/// A triangle is a sliver when twice its area is below this part of the square of its longest edge: then its normal, which errs
/// by a rounding over that part, is made accurate.
const SLIVER: f64 = 1.0 / 1024.0;

/// The normal of a triangle, not normalised; at right angles to its longest edge up to a rounding, also for slivers.
#[inline(always)]
pub(super) fn face_normal(t: &[DVec3; 3]) -> DVec3 {
    let normal = (t[1] - t[0]).cross(t[2] - t[0]);
    let edges = [t[1] - t[0], t[2] - t[1], t[0] - t[2]];
    let squares = edges.map(DVec3::length_squared);
    let longest = squares[0].max(squares[1]).max(squares[2]);
    let is_sliver = normal.length_squared() < SLIVER * SLIVER * longest * longest;
    if is_sliver { sliver_normal(&edges, &squares) } else { normal }
}

#[cold]
#[inline(never)]
fn sliver_normal(edges: &[DVec3; 3], squares: &[f64; 3]) -> DVec3 {
    let longest = (0..3).max_by(|&i, &j| squares[i].total_cmp(&squares[j])).unwrap_or(0);
    let [next, other] = [1, 2].map(|k| edges[(longest + k) % 3]);
    across_all(next.cross(other), &[next, edges[longest]])
}

/// The direction across the edges, which are nearly parallel, the longest last: twice, since the first time leaves a rounding of
/// what it takes off. Zero where nothing is left.
pub(super) fn across_all(direction: DVec3, edges: &[DVec3; 2]) -> DVec3 {
    let mut n = direction;
    for edge in edges.iter().chain(edges).filter(|edge| **edge != DVec3::ZERO) {
        n = across(n, *edge);
    }
    n
}

/// Closest points of the two triangles' boundaries, and of corners against faces. For crossing triangles this is not
/// zero: a crossing has to be found by other means.
#[inline(always)]
pub(crate) fn closest<D: Doubles>(a: &[DVec3; 3], b: &[DVec3; 3]) -> Closest {
    let (i, j) = closest_edges::<D>(a, b);
    let mut best = edge_edge((a, i), (b, j));
    let faces = [(a, face_normal(a)), (b, face_normal(b))];
    for corner in 0..3 {
        if let Some(of_a) = corner_face((a, corner), faces[1], best.distance_squared) {
            best = of_a;
        }
        if let Some(of_b) = corner_face((b, corner), faces[0], best.distance_squared) {
            best = of_b.swapped();
        }
    }
    best
}

/// The edges, by number, that come closest: one of A against three of B at a time, in four lanes. The numbers are all
/// that counts of the result; [`edge_edge`] says where on them.
#[inline(always)]
fn closest_edges<D: Doubles>(a: &[DVec3; 3], b: &[DVec3; 3]) -> (usize, usize) {
    let from = QuadVec::<D>::new([b[0], b[1], b[2], b[0]]);
    let to = QuadVec::<D>::new([b[1], b[2], b[0], b[1]]);
    let d = to - from;
    let dd = d.length_squared();
    let mut squares = [Quad([0.0; 4]); 3];
    for (i, square) in squares.iter_mut().enumerate() {
        let e = a[(i + 1) % 3] - a[i];
        let w = from - QuadVec::new([a[i]; 4]);
        let k = d.crossed_by(e);
        let (ee, we, de, wd) = (D::splat(e.length_squared()), w.dot(e), d.dot(e), w.dots(&d));
        // As in `edge_edge`.
        let s = clamp_ratios(w.crossed(&d).dots(&k), k.length_squared());
        let t = clamp_ratios(s * de - wd, dd);
        let s = clamp_ratios(we + t * de, ee);
        let t = clamp_ratios(s * de - wd, dd);
        let line = w + d * t - QuadVec::new([e; 4]) * s;
        *square = line.length_squared().store();
    }
    let mut best = (0, 0);
    for i in 0..3 {
        for j in 0..3 {
            if squares[i].0[j] < squares[best.0].0[best.1] {
                best = (i, j);
            }
        }
    }
    best
}

#[inline(always)]
fn clamp_ratios<D: Doubles>(numerator: D, denominator: D) -> D {
    let zero = D::splat(0.0);
    let ratio = (numerator / denominator).max(zero).min(D::splat(1.0));
    D::if_greater(denominator, zero, ratio, zero)
}

#[inline(always)]
fn clamp_ratio(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 { (numerator / denominator).clamp(0.0, 1.0) } else { 0.0 }
}

#[inline(always)]
fn edge_edge((a, i): (&[DVec3; 3], usize), (b, j): (&[DVec3; 3], usize)) -> Closest {
    let (a0, a1, b0, b1) = (a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
    let (e, d, w) = (a1 - a0, b1 - b0, b0 - a0);
    let k = e.cross(d);
    let (ee, dd, kk) = (e.length_squared(), d.length_squared(), k.length_squared());
    // (w + t·d − s·e) ⟂ e, d gives s = (w × d)·k/|k|²: no cancellation for nearly parallel edges.
    let mut s = clamp_ratio(w.cross(d).dot(k), kk);
    let t = clamp_ratio((e * s - w).dot(d), dd);
    s = clamp_ratio((w + d * t).dot(e), ee);
    let t = clamp_ratio((e * s - w).dot(d), dd);
    let point = |p: DVec3, q: DVec3, v: DVec3, x: f64| {
        if x == 0.0 {
            p
        } else if x == 1.0 {
            q
        } else {
            p + v * x
        }
    };
    let (p, q) = (point(a0, a1, e, s), point(b0, b1, d, t));
    let line = q - p;
    let distance_squared = line.length_squared();
    let place = |index: usize, x: f64| {
        if x == 0.0 {
            Place::Vertex(index)
        } else if x == 1.0 {
            Place::Vertex((index + 1) % 3)
        } else {
            Place::Edge(index)
        }
    };
    let places = [place(i, s), place(j, t)];
    let direction = match (places[0], places[1]) {
        (Place::Edge(_), Place::Edge(_)) if kk > LEAST_SINE_SQUARED * ee * dd => {
            let k = across(k, if ee > dd { e } else { d });
            if k.dot(line) < 0.0 { -k } else { k }
        }
        (Place::Edge(_), _) => across(line, e),
        (_, Place::Edge(_)) => across(line, d),
        _ => line,
    };
    Closest { distance_squared, points: [p, q], places, direction }
}

/// A corner and a face of the other body, where their squared distance is below `most`.
#[inline(always)]
fn corner_face(
    (corners, i): (&[DVec3; 3], usize),
    (face, normal): (&[DVec3; 3], DVec3),
    most: f64,
) -> Option<Closest> {
    let p = corners[i];
    let nn = normal.length_squared();
    let height = (p - face[0]).dot(normal);
    if nn.is_nan() || nn <= 0.0 || height * height >= most * nn {
        return None;
    }
    for k in 0..3 {
        let edge = face[(k + 1) % 3] - face[k];
        if edge.cross(p - face[k]).dot(normal) < 0.0 {
            return None;
        }
    }
    Some(Closest {
        distance_squared: height * height / nn,
        points: [p, p - normal * (height / nn)],
        places: [Place::Vertex(i), Place::Face],
        direction: if height < 0.0 { normal } else { -normal },
    })
}
