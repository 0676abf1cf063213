//! A moving edge against an edge that is fixed in B's frame.
use crate::closest;
use crate::path::{FeaturePath, along, direction, global, local, reach, widened};
use crate::point_triangle::cleared;
use d2m_motion::PathJet;
use d2m_root::{Band, Measurement, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;

/// The piece test of two edges: the path is the midpoint of A's edge minus the midpoint of B's, and A's half edge.
pub(crate) struct EdgeEdgeTest<P> {
    pub(crate) path: P,
    /// Midpoint of B's edge.
    pub(crate) middle: DVec3,
    /// Half edge of B.
    pub(crate) half: DVec3,
    /// Upper bounds of the half lengths of A and B.
    pub(crate) half_lengths: (f64, f64),
    pub(crate) tolerance: f64,
    pub(crate) separation: f64,
}

/// Part of the feature's size that a remainder may reach before a piece is worth an evaluation (tuned like the one
/// of vertex/face).
const PATIENCE: f64 = 0.4;
const UP: f64 = 1.0 + 1e-14;

/// `a·b` of two jets as a quadratic, and a bound of what the cubic and quartic terms add.
#[inline(always)]
fn product(a: [DVec3; 3], b: [DVec3; 3]) -> (Quadratic, f64, f64) {
    let quadratic = Quadratic {
        value: a[0].dot(b[0]),
        slope: a[0].dot(b[1]) + a[1].dot(b[0]),
        curvature: a[0].dot(b[2]) + a[2].dot(b[0]) + 2.0 * a[1].dot(b[1]),
    };
    (quadratic, 0.5 * (a[1].dot(b[2]) + a[2].dot(b[1])).abs(), 0.25 * a[2].dot(b[2]).abs())
}

impl<P: FeaturePath> EdgeEdgeTest<P> {
    fn size(&self) -> f64 {
        self.half_lengths.0 + self.half_lengths.1
    }

    fn speed(&self) -> f64 {
        self.path.speed() + self.path.direction_speed()
    }

    /// Jets of the difference of the midpoints and of A's half edge.
    #[inline(always)]
    fn jets(&mut self, piece: Piece, at: f64) -> (PathJet, PathJet) {
        let (mut w, e) = self.path.point_and_direction(piece, at);
        w.p -= self.middle;
        (w, e)
    }
}

impl<P: FeaturePath> PieceTest for EdgeEdgeTest<P> {
    #[inline(always)]
    fn too_wide(&self, h: f64) -> bool {
        self.path.jerk() * (h * h * h) > 6.0 * PATIENCE * (self.size() + 0.25 * self.speed() * h)
    }

    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn resolution(&self) -> f64 {
        let resolution = self.tolerance / (2.0 * self.speed());
        if resolution.is_nan() { f64::INFINITY } else { resolution }
    }

    #[inline]
    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let at = piece.mid();
        let (w, e) = self.jets(piece, at);
        let d = self.half;
        let (half_a, half_b) = self.half_lengths;
        let whole = local(piece, at);
        let h = reach(whole);
        let remainder = widened(w.remainder, self.separation);
        let wide = remainder.bound(h);

        // Along the line of the midpoints: all four corners w ± e ± d on one side.
        let distance = w.p.length();
        let (away, reach_a) = (along(&w, w.p), along(&e, w.p));
        let sum = |a: &Quadratic, b: &Quadratic, sign: f64| Quadratic {
            value: a.value + sign * b.value,
            slope: a.slope + sign * b.slope,
            curvature: a.curvature + sign * b.curvature,
        };
        let wide_e = e.remainder.bound(h);
        let needed = (w.p.dot(d).abs() + distance * (wide + wide_e)) * UP;
        if sum(&away, &reach_a, 1.0).bound_below(whole) > needed
            && sum(&away, &reach_a, -1.0).bound_below(whole) > needed
        {
            return Verdict::Clear;
        }

        // f = w·(e × d), zero when the lines meet.
        let ws = [w.p, w.v, w.a];
        let es = [e.p, e.v, e.a];
        let ks = es.map(|e| e.cross(d));
        let (f, cubic, quartic) = product(ws, ks);
        // |w| over the piece, from the speed that its jet admits.
        let length = distance + h * (w.v.length() + 0.5 * h * w.a.length());
        let margin_f = |s: f64| {
            let product = remainder.bound(s) * half_a + length * e.remainder.bound(s);
            ((cubic + quartic * s) * s * s * s + half_b * product) * UP
        };
        let wide_f = margin_f(h);
        let Some(meeting) = f.clip(Band { lo: -wide_f, hi: wide_f }, whole) else {
            return Verdict::Clear;
        };

        // Γ with directions frozen in the middle: k = e × d, u = d × k.
        let k = ks[0];
        let u = d.cross(k);
        let k_length = k.length() * UP;
        // At least |u|, and of the size of its rounding when k is all rounding.
        let u_length = half_b * k_length * UP;
        let (w_u, e_u) = (along(&w, u), along(&e, u));
        let (first_a, second_a) = (sum(&w_u, &e_u, 1.0), sum(&w_u, &e_u, -1.0));
        let margin_a = |s: f64| u_length * (remainder.bound(s) + e.remainder.bound(s)) * UP;
        // The first exclusion alone decides most pieces.
        let Some(beside) = first_a.clip_shared_sign(&second_a, margin_a(reach(meeting)), meeting) else {
            return Verdict::Clear;
        };
        let js = es.map(|e| e.cross(k));
        let (w_j, cubic_j, quartic_j) = product(ws, js);
        let (first_b, second_b) = (sum(&w_j, &e_u, 1.0), sum(&w_j, &e_u, -1.0));
        let margin_b = |s: f64| {
            let product = remainder.bound(s) * half_a + length * e.remainder.bound(s);
            ((cubic_j + quartic_j * s) * s * s * s + k_length * product + u_length * e.remainder.bound(s))
                * UP
        };
        let Some(inside) = first_b.clip_shared_sign(&second_b, margin_b(reach(beside)), beside) else {
            return Verdict::Clear;
        };
        let overlap = |part: Piece| {
            let s = reach(part);
            let part = first_a.clip_shared_sign(&second_a, margin_a(s), part)?;
            first_b.clip_shared_sign(&second_b, margin_b(s), part)
        };
        // The same jets again with the remainder of the contracted piece.
        let margin = margin_f(reach(inside));
        let Some(meeting_again) = f.clip(Band { lo: -margin, hi: margin }, inside) else {
            return Verdict::Clear;
        };
        let Some(part) = overlap(meeting_again) else {
            return Verdict::Clear;
        };
        // A true crossing: only f has cut, it changes sign, and throughout the rest the lines are certainly not
        // parallel and meet certainly inside both edges.
        let certain = inside == meeting && part == meeting_again && {
            let (at_lo, at_hi) = (f.at(whole.lo), f.at(whole.hi));
            let changes = (at_lo > wide_f && at_hi < -wide_f) || (at_lo < -wide_f && at_hi > wide_f);
            let s = reach(part);
            let (a, b) = (margin_a(s), margin_b(s));
            changes
                && e_u.bound_below(part) > u_length * e.remainder.bound(s) * UP
                && first_a.bound_below(part) > a
                && (-second_a).bound_below(part) > a
                && first_b.bound_below(part) > b
                && (-second_b).bound_below(part) > b
        };
        Verdict::Within { part: global(part, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let (w, e) = self.jets(piece, at);
        let d = self.half;
        let pair = closest::segment_segment(w.p, e.p, d);
        let distance =
            pair.difference.length() * UP + w.remainder.bound(0.0) + e.remainder.bound(0.0) - self.separation;
        let whole = local(piece, at);
        let s = reach(whole);
        let margin = (widened(w.remainder, self.separation).bound(s) + e.remainder.bound(s)) * UP;
        let mut clear = Piece { lo: 0.0, hi: 0.0 };
        let mut best = 0.0;
        let mut consider = |n: DVec3| {
            let (w_n, e_n) = (along(&w, n), along(&e, n));
            let support = n.dot(d).abs() + margin;
            let mut gap = f64::INFINITY;
            let mut radii = Piece { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
            for sign in [-1.0, 1.0] {
                let value = w_n.value + sign * e_n.value - support;
                let slope = w_n.slope + sign * e_n.slope;
                let curvature = w_n.curvature + sign * e_n.curvature;
                // Also NaN ends here: f64::min would drop it.
                if value.is_nan() || value <= 0.0 {
                    return;
                }
                gap = value.min(gap);
                radii.lo = radii.lo.max(-Quadratic::bound_first_zero(value, -slope, curvature));
                radii.hi = radii.hi.min(Quadratic::bound_first_zero(value, slope, curvature));
            }
            if gap > best {
                best = gap;
                clear = radii;
            }
        };
        consider(direction(pair.separating));
        if distance < 1e-6 * self.size() {
            let k = direction(e.p.cross(d));
            consider(if k.dot(pair.difference) < 0.0 { -k } else { k });
            // In the common plane, across either edge.
            for edge in [d, e.p] {
                let across = direction(direction(edge).cross(k));
                consider(across);
                consider(-across);
            }
        }
        cleared(clear, whole, at, piece, distance)
    }
}
