//! A moving edge against an edge that is fixed in B's frame.
use crate::closest;
use crate::path::{
    FeaturePath, along, around, cubic_along, direction, global, local, padded, reach, widened, without_third,
};
use crate::point_triangle::cleared;
use d2m_motion::PathJet;
use d2m_root::{Band, Cubic, Measurement, Piece, PieceTest, Quadratic, Verdict};
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
    /// A piece throughout which the lines certainly meet, if they do, inside both edges.
    pub(crate) inside: Piece,
}

/// Part of the edges' size that they must move in half a piece for the line of the midpoints to be worth a look.
const NEARBY: f64 = 1.0;

/// Part of the feature's size that a remainder may reach before a piece is worth an evaluation (tuned like the one
/// of vertex/face).
const PATIENCE: f64 = 0.06;
const UP: f64 = 1.0 + 1e-14;

/// `a·b` of two jets as a quadratic, and a bound of what the cubic and quartic terms add.
#[inline(always)]
fn product_of(a: [DVec3; 3], b: [DVec3; 3]) -> (Quadratic, f64, f64) {
    let quadratic = Quadratic {
        value: a[0].dot(b[0]),
        slope: a[0].dot(b[1]) + a[1].dot(b[0]),
        curvature: a[0].dot(b[2]) + a[2].dot(b[0]) + 2.0 * a[1].dot(b[1]),
    };
    (quadratic, 0.5 * (a[1].dot(b[2]) + a[2].dot(b[1])).abs(), 0.25 * a[2].dot(b[2]).abs())
}

impl<P: FeaturePath> EdgeEdgeTest<P> {
    /// The part of a piece in which the edges may be near: as a whole all four corners w ± e ± d on one side along
    /// the line of the midpoints, from either end |w| ≤ |e| + |d| along the velocity.
    #[inline(always)]
    fn near(&self, w: &PathJet, e: &PathJet, d: DVec3, whole: Piece, h: f64) -> Option<Piece> {
        let of_w = widened(w.remainder, self.separation).bound(h);
        let of_e = e.remainder.bound(h);
        let distance = w.p.length();
        if distance > self.half_lengths.0 {
            let (away, left_out) = cubic_along(w, w.p).quadratic_near(0.0, h);
            let (reach_a, left_out_e) = cubic_along(e, w.p).quadratic_near(0.0, h);
            let needed = (w.p.dot(d).abs() + distance * (of_w + of_e) + left_out + left_out_e) * UP;
            if away.plus(&reach_a).bound_below(whole) > needed
                && away.minus(&reach_a).bound_below(whole) > needed
            {
                return None;
            }
        }
        let (forth, left_out) = cubic_along(w, w.v).quadratic_near(0.0, h);
        let reach = w.v.length() * (self.half_lengths.0 + of_w) + w.v.dot(d).abs() + left_out;
        forth.clip(Band { lo: -reach * UP, hi: reach * UP }, whole)
    }

    /// True if a certain crossing in the part would be the answer.
    #[inline(always)]
    fn fine(&self, part: Piece, piece: Piece) -> bool {
        let width = part.width();
        width * (2.0 * self.speed()) <= self.tolerance || width <= 1e-15 * reach(piece)
    }

    fn size(&self) -> f64 {
        self.half_lengths.0 + self.half_lengths.1
    }

    fn speed(&self) -> f64 {
        self.path.speed() + self.path.direction_speed()
    }

    /// Jets of the difference of the midpoints and of A's half edge, and B's half edge.
    #[inline(always)]
    fn jets(&mut self, piece: Piece, at: f64) -> (PathJet, PathJet, DVec3) {
        self.path.edges(piece, at, (self.middle, self.half))
    }
}

impl<P: FeaturePath> PieceTest for EdgeEdgeTest<P> {
    #[inline(always)]
    fn too_wide(&self, h: f64) -> bool {
        self.path.left_out(h) > PATIENCE * (self.size() + 0.25 * self.speed() * h)
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
        let (w, e, d) = self.jets(piece, at);
        let (half_a, half_b) = self.half_lengths;
        let whole = local(piece, at);
        let h = reach(whole);
        let remainder = widened(w.remainder, self.separation);

        let known_inside = self.inside.holds(piece);
        let mut searched = whole;
        if !known_inside && self.speed() * h > NEARBY * self.size() {
            let Some(near) = self.near(&w, &e, d, whole, h) else {
                return Verdict::Clear;
            };
            searched = near;
        }

        // f = w·(e × d), zero when the lines meet: Taylor polynomials multiplied out to third order.
        let (k0, k1, k2, k3) = (e.p.cross(d), e.v.cross(d), e.a.cross(d), e.j.cross(d));
        let f = Cubic {
            value: w.p.dot(k0),
            slope: w.p.dot(k1) + w.v.dot(k0),
            curvature: w.p.dot(k2) + w.a.dot(k0) + 2.0 * w.v.dot(k1),
            jerk: w.p.dot(k3) + w.j.dot(k0) + 3.0 * (w.v.dot(k2) + w.a.dot(k1)),
        };
        // What the products of higher order add.
        let fourth = ((1.0 / 6.0) * (w.v.dot(k3) + w.j.dot(k1)) + 0.25 * w.a.dot(k2)).abs();
        let fifth = ((1.0 / 12.0) * (w.a.dot(k3) + w.j.dot(k2))).abs();
        let sixth = ((1.0 / 36.0) * w.j.dot(k3)).abs();
        // |w| is at most what its speed admits, and at a contact both half edges and the separation; its jet adds its
        // remainder.
        let (there, touching) = (w.p.length() + h * self.path.speed(), self.size() + self.separation);
        let apart = (if there < touching { there } else { touching }) + remainder.bound(h);
        let sum = remainder.scaled(half_a).plus(e.remainder.scaled(apart)).scaled(half_b * UP);
        let (third, fourth_sum) = ((1.0 / 6.0) * sum.m3, (1.0 / 24.0) * sum.m4 + fourth);
        let margin_f = |s: f64| {
            let high = third + s * (fourth_sum + s * (fifth + s * sixth));
            (sum.e0 + s * (sum.e1 + s * (sum.e2 + s * high))) * UP
        };
        let Some(mut part) = f.clip(Band { lo: 0.0, hi: 0.0 }, margin_f, searched) else {
            return Verdict::Clear;
        };
        let mut certain = known_inside;
        if !known_inside {
            // About the middle of what is left.
            let meeting = padded(part, at, whole);
            let m = part.mid();
            let s = reach(meeting);
            let meeting = Piece { lo: meeting.lo - m, hi: meeting.hi - m };
            let r = reach(meeting) * UP;
            // Γ with directions frozen there: k = e × d, u = d × k.
            let (w_m, e_m) = (w.at(m), e.at(m));
            let k = e_m.cross(d);
            let u = d.cross(k);
            let k_length = k.length() * UP;
            // At least |u|, and of the size of its rounding when k is all rounding.
            let u_length = half_b * k_length * UP;
            let (w_u, e_u, w_j) = (w_m.dot(u), e_m.dot(u), w_m.dot(e_m.cross(k)));
            let (of_w, of_e) = (remainder.bound(s), e.remainder.bound(s));
            // What the speeds admit.
            let (stray_w, stray_e) = (self.path.speed() * r + of_w, self.path.direction_speed() * r + of_e);
            let margin_a = u_length * (stray_w + stray_e) * UP;
            let product = stray_w * half_a + (w_m.length() + stray_w) * stray_e;
            let margin_b = (k_length * product + u_length * stray_e) * UP;
            let (a, b) = ([w_u + e_u, w_u - e_u], [w_j + e_u, w_j - e_u]);
            let shared =
                |[f, g]: [f64; 2], margin: f64| (f > margin && g > margin) || (f < -margin && g < -margin);
            if shared(a, margin_a) || shared(b, margin_b) {
                return Verdict::Clear;
            }
            // The lines are certainly not parallel, and meet certainly inside both edges, for good.
            certain = e_u > u_length * stray_e * UP
                && a[0] > margin_a
                && a[1] < -margin_a
                && b[0] > margin_b
                && b[1] < -margin_b;
            if certain {
                self.inside = global(part, at, piece);
            } else {
                // The same with jets.
                let cube = (1.0 / 6.0) * (r * r * r);
                let margin_w = (of_w + cube * w.j.length()) * UP;
                let margin_e = (of_e + cube * e.j.length()) * UP;
                let (w, e) = (w.moved(m), e.moved(m));
                let before = Piece { lo: part.lo - m, hi: part.hi - m };
                let (w_u, e_u) = (along(&w, u), along(&e, u));
                let (first_a, second_a) = (w_u.plus(&e_u), w_u.minus(&e_u));
                let margin_a = u_length * (margin_w + margin_e) * UP;
                let Some(beside) = first_a.clip_shared_sign(&second_a, margin_a, before) else {
                    return Verdict::Clear;
                };
                let js = [e.p.cross(k), e.v.cross(k), e.a.cross(k)];
                let (w_j, cubic_j, quartic_j) = product_of([w.p, w.v, w.a], js);
                let (first_b, second_b) = (w_j.plus(&e_u), w_j.minus(&e_u));
                // |w| there, up to what its jet admits.
                let length = w.p.length() + r * (w.v.length() + 0.5 * r * w.a.length());
                let product = margin_w * half_a + length * margin_e;
                let margin_b =
                    ((cubic_j + quartic_j * r) * (r * r * r) + k_length * product + u_length * margin_e) * UP;
                let Some(inside) = first_b.clip_shared_sign(&second_b, margin_b, beside) else {
                    return Verdict::Clear;
                };
                if inside != before {
                    part = Piece { lo: m + inside.lo, hi: m + inside.hi };
                } else if e_u.bound_below(meeting) > u_length * margin_e * UP
                    && first_a.bound_below(meeting) > margin_a
                    && (-second_a).bound_below(meeting) > margin_a
                    && first_b.bound_below(meeting) > margin_b
                    && (-second_b).bound_below(meeting) > margin_b
                {
                    // Only f has cut.
                    certain = true;
                    self.inside = global(part, at, piece);
                }
            }
        }
        // A true crossing: f changes sign.
        let changes = |between: Piece| {
            let s = reach(between);
            let (of_w, of_e) = (remainder.bound(s), e.remainder.bound(s));
            let product = half_b * (of_w * half_a + (there + of_w) * of_e);
            let higher = s * s * s * s * (fourth + s * (fifth + s * sixth));
            let margin = (product + higher) * UP;
            let (first, last) = (f.at(between.lo), f.at(between.hi));
            (first > margin && last < -margin) || (first < -margin && last > margin)
        };
        let certain =
            certain && self.fine(part, piece) && (changes(searched) || changes(around(part, searched)));
        Verdict::Within { part: global(part, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let (w, e, d) = self.jets(piece, at);
        let pair = closest::segment_segment(w.p, e.p, d);
        let distance =
            pair.difference.length() * UP + w.remainder.bound(0.0) + e.remainder.bound(0.0) - self.separation;
        let whole = local(piece, at);
        let s = reach(whole);
        let margin = (widened(without_third(&w), self.separation).bound(s) + without_third(&e).bound(s)) * UP;
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
