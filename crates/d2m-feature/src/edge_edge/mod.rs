//! A moving edge against an edge that is fixed in B's frame.
mod products;

use crate::accurate_cross::{Difference, accurate_cross};
use crate::closest;
use crate::path::{
    FeaturePath, HalfEdge, along, around, direction, global, local, padded, widened, without_third,
};
use crate::point_triangle::cleared;
use crate::rounding::{CLOSE, PART_OF_WAY, UNDERFLOW, UNIT, UP, length_up};
use d2m_lanes::{F64x2, power_of_two};
use d2m_motion::{EdgeJets, TwoJets, TwoVec3};
use d2m_root::{Band, Cubic, Measurement, NearbyQuadratic, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;
use products::{TripleProduct, TwoQuadratics};

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

/// Part of the edges' size that they must move in half a piece for the line of the midpoints for that test to be worth its time.
const NEARBY: f64 = 1.0;

/// Part of the feature's size that a remainder may reach before a piece is worth an evaluation (tuned like the one
/// of vertex/face).
const PATIENCE: f64 = 0.045;
/// Shortest half length that bounds are made for, as a part of the rounding of positions: shorter edges have the bounds of
/// this one, 2⁻⁶⁰ of what is noticed. Products of a rounding (at least 2⁻²⁵⁰ in the units of a query) with two lengths then
/// stay far above what underflows.
const SHORTEST: f64 = power_of_two(-60);
/// Part of the latest time of a piece to which a crossing's bracket may shrink when no shorter one can be proven: some four
/// units in the last place.
const FEW_UNITS: f64 = 8.0 * UNIT;

impl<P: FeaturePath> EdgeEdgeTest<P> {
    /// `half_a` and `half` are the half edges of A and B, `middle` is the midpoint of B's edge.
    #[inline(always)]
    pub(crate) fn new(path: P, middle: DVec3, half: DVec3, half_a: DVec3, separation: f64) -> Self {
        let (length_a, length_b) = (length_up(half_a), length_up(half));
        let shortest = SHORTEST * path.rounding();
        let half_lengths = (length_a.max(shortest), length_b.max(shortest));
        Self { path, middle, half, half_lengths, tolerance: 0.0, separation, inside: Piece::NONE }
    }

    /// The part of a piece in which the edges may be near: as a whole all four points w ± e ± d on one side along
    /// the line of the midpoints, from either end |w| ≤ |e| + |d| along the velocity.
    #[inline(always)]
    fn near(&self, jets: &TwoJets, d: DVec3, whole: Piece, h: f64) -> Option<Piece> {
        let of_w = widened(jets.remainders[0], self.separation).bound(h);
        let of_e = jets.remainders[1].bound(h);
        let (w, v) = (jets.p.first(), jets.v.first());
        let distance = length_up(w);
        if distance > self.half_lengths.0 {
            // Along w, of w and of e.
            let axis = TwoVec3::splat(w);
            let jerk = jets.j.dot(axis);
            let away = TwoQuadratics {
                value: jets.p.dot(axis),
                slope: jets.v.dot(axis) + jerk * F64x2::splat(0.125 * (h * h)),
                curvature: jets.a.dot(axis),
            };
            let left_out = (jerk.first().abs() + jerk.second().abs()) * ((1.0 / 24.0) * (h * h * h));
            let needed = (w.dot(d).abs() + distance * (of_w + of_e) + left_out) * UP;
            if away.sum_and_difference().exceed(needed, whole) {
                return None;
            }
        }
        let along_v = Cubic {
            value: w.dot(v),
            slope: v.dot(v),
            curvature: jets.a.first().dot(v),
            jerk: jets.j.first().dot(v),
        };
        let NearbyQuadratic { quadratic: forth, left_out } = along_v.quadratic_about_center(h);
        let reach = length_up(v) * (self.half_lengths.0 + of_w) + v.dot(d).abs() + left_out;
        // of_w covers the evaluation along v, times |v|: 12u of |w|, |v|h and |a|h² are the last row of features.md, section 3, and
        // the jerk's share of the slope adds 1.5u of |j|h³, of which 45u of 64u are counted.
        forth.clip_beyond(Band { lo: 0.0, hi: 0.0 }, reach * UP, whole)
    }

    /// True if a certain crossing in the part would be the answer.
    #[inline(always)]
    fn fine(&self, part: Piece, piece: Piece) -> bool {
        let width = part.width();
        width * (2.0 * self.speed()) <= self.tolerance || width <= FEW_UNITS * piece.reach()
    }

    fn size(&self) -> f64 {
        self.half_lengths.0 + self.half_lengths.1
    }

    fn speed(&self) -> f64 {
        self.path.speed() + self.path.direction_speed()
    }

    /// Jets of the difference of the midpoints and of A's half edge, and B's half edge.
    #[inline(always)]
    fn jets(&mut self, piece: Piece, at: f64) -> EdgeJets {
        self.path.edges(piece, at, HalfEdge { middle: self.middle, half: self.half })
    }
}

impl<P: FeaturePath> PieceTest for EdgeEdgeTest<P> {
    #[inline(always)]
    fn too_wide(&self, h: f64) -> bool {
        self.path.left_out(h) > PATIENCE * (self.size() + PART_OF_WAY * self.speed() * h)
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
        let EdgeJets { jets, half_b: d } = self.jets(piece, at);
        let (half_a, half_b) = self.half_lengths;
        let whole = local(piece, at);
        let h = whole.reach();
        let (remainder, remainder_e) = (widened(jets.remainders[0], self.separation), jets.remainders[1]);

        let known_inside = self.inside.holds(piece);
        let mut searched = whole;
        if !known_inside && self.speed() * h > NEARBY * self.size() {
            let Some(near) = self.near(&jets, d, whole, h) else {
                return Verdict::Clear;
            };
            searched = near;
        }

        // f = w·(e × d), zero when the lines meet.
        let TripleProduct { cubic: f, fourth, fifth, sixth } = TripleProduct::new(&jets, d);
        // |w| is at most what its speed admits, and at a contact both half edges and the separation; its jet adds its
        // remainder.
        let (there, touching) =
            (length_up(jets.p.first()) + h * self.path.speed(), self.size() + self.separation);
        let apart = (if there < touching { there } else { touching }) + remainder.bound(h);
        let (of_w, of_e) = (half_b * half_a * UP, half_b * apart * UP);
        let e0 = remainder.e0 * of_w + remainder_e.e0 * of_e;
        let e1 = remainder.e1 * of_w + remainder_e.e1 * of_e;
        let e2 = remainder.e2 * of_w + remainder_e.e2 * of_e;
        let third = (1.0 / 6.0) * (remainder.m3 * of_w + remainder_e.m3 * of_e);
        let fourth_sum = (1.0 / 24.0) * (remainder.m4 * of_w + remainder_e.m4 * of_e) + fourth;
        let margin_f = |s: f64| {
            (e0 + s * (e1 + s * (e2 + s * (third + s * (fourth_sum + s * (fifth + s * sixth)))))) * UP
        };
        let Some(mut part) = f.clip(Band { lo: 0.0, hi: 0.0 }, margin_f, searched) else {
            return Verdict::Clear;
        };
        let mut certain = known_inside;
        if !known_inside {
            // About the middle of what is left.
            let meeting = padded(part, at, whole);
            let m = part.mid();
            let s = meeting.reach();
            let meeting = Piece { lo: meeting.lo - m, hi: meeting.hi - m };
            let r = meeting.reach() * UP;
            // Γ with directions frozen there: k = e × d, u = d × k.
            let there = jets.at(m);
            let (w_m, e_m) = (there.first(), there.second());
            let k = e_m.cross(d);
            let u = d.cross(k);
            let k_length = length_up(k);
            // At least |u|, and of the size of its rounding when k is all rounding.
            let u_length = half_b * k_length * UP;
            let along_u = there.dot(TwoVec3::splat(u));
            let (w_u, e_u, w_j) = (along_u.first(), along_u.second(), w_m.dot(e_m.cross(k)));
            let (of_w, of_e) = (remainder.bound(s), remainder_e.bound(s));
            // What the speeds admit.
            let (displacement_w, displacement_e) =
                (self.path.speed() * r + of_w, self.path.direction_speed() * r + of_e);
            let margin_a = u_length * (displacement_w + displacement_e) * UP;
            let product = displacement_w * half_a + (length_up(w_m) + displacement_w) * displacement_e;
            let margin_b = (k_length * product + u_length * displacement_e) * UP;
            let (a, b) = ([w_u + e_u, w_u - e_u], [w_j + e_u, w_j - e_u]);
            let shared =
                |[f, g]: [f64; 2], margin: f64| (f > margin && g > margin) || (f < -margin && g < -margin);
            if shared(a, margin_a) || shared(b, margin_b) {
                return Verdict::Clear;
            }
            // The lines are certainly not parallel, and meet certainly inside both edges, for good.
            certain = e_u > u_length * displacement_e * UP
                && a[0] > margin_a
                && a[1] < -margin_a
                && b[0] > margin_b
                && b[1] < -margin_b;
            if certain {
                self.inside = global(part, at, piece);
            } else {
                // The same with jets.
                let cube = (1.0 / 6.0) * (r * r * r);
                let bent = jets.j.dot(jets.j).sqrt();
                let margin_w = (of_w + cube * bent.first() + UNDERFLOW) * UP;
                let margin_e = (of_e + cube * bent.second() + UNDERFLOW) * UP;
                let moved = jets.moved(m);
                let before = Piece { lo: part.lo - m, hi: part.hi - m };
                let along_u = TwoQuadratics::along(&moved, u);
                let e_u = along_u.second();
                let first_a = along_u.first() + e_u;
                let second_a = along_u.first() - e_u;
                let margin_a = u_length * (margin_w + margin_e) * UP;
                // The evaluation is covered: of values 122u of the 128u in margin_e and 121u in margin_w, of slopes 182u of 256u
                // (features.md, section 5, "Γ"), each with all 12u of `Quadratic::bound_evaluation` that concern it.
                let Some(beside) = first_a.clip_shared_sign_beyond(&second_a, margin_a, before) else {
                    return Verdict::Clear;
                };
                let TripleProduct { cubic: w_j, fourth: quartic_j, .. } = TripleProduct::new(&moved, k);
                let cubic_j = (1.0 / 6.0) * w_j.jerk.abs();
                let w_j = Quadratic { value: w_j.value, slope: w_j.slope, curvature: w_j.curvature };
                let (first_b, second_b) = (w_j + e_u, w_j - e_u);
                // |w| there, up to what its jet admits.
                let length =
                    length_up(w_m) + r * (length_up(moved.v.first()) + 0.5 * r * length_up(moved.a.first()));
                let product = margin_w * half_a + length * margin_e;
                let margin_b =
                    ((cubic_j + quartic_j * r) * (r * r * r) + k_length * product + u_length * margin_e) * UP;
                // Covered: w_j rounds by 117u of the 128u in margin_w (there), e_u as above.
                let Some(inside) = first_b.clip_shared_sign_beyond(&second_b, margin_b, beside) else {
                    return Verdict::Clear;
                };
                if inside != before {
                    part = Piece { lo: m + inside.lo, hi: m + inside.hi };
                } else if e_u.exceeds(u_length * margin_e * UP, meeting)
                    && first_a.exceeds(margin_a, meeting)
                    && (-second_a).exceeds(margin_a, meeting)
                    && first_b.exceeds(margin_b, meeting)
                    && (-second_b).exceeds(margin_b, meeting)
                {
                    // Only f has cut.
                    certain = true;
                    self.inside = global(part, at, piece);
                }
            }
        }
        // A true crossing: f changes sign.
        let changes = |between: Piece| {
            let s = between.reach();
            let (of_w, of_e) = (remainder.bound(s), remainder_e.bound(s));
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
        let EdgeJets { jets, half_b: d } = self.jets(piece, at);
        let [w, e] = jets.split();
        let pair = closest::segment_segment(w.p, e.p, d);
        let distance =
            length_up(pair.difference) + w.remainder.bound(0.0) + e.remainder.bound(0.0) - self.separation;
        let whole = local(piece, at);
        let s = whole.reach();
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
        if distance < CLOSE * self.size() {
            let k = direction(accurate_cross(Difference::from(e.p), Difference::from(d)));
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
