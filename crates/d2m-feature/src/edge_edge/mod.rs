//! A moving edge against an edge that is fixed in B's frame.
mod lines;
mod meeting;
mod products;

use crate::accurate_cross::{Difference, accurate_cross};
use crate::closest;
use crate::path::{
    FeaturePath, HalfEdge, along, around, direction, global, local, padded, resolution, widened,
    without_third,
};
use crate::point_triangle::cleared;
use crate::rounding::{CLOSE, PART_OF_WAY, UNIT, UP, length_up};
use d2m_lanes::{F64x2, power_of_two};
use d2m_motion::{EdgeJets, TwoJets, TwoVec3};
use d2m_root::{Band, Cubic, Measurement, NearbyQuadratic, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;
use lines::LinesMeet;
use meeting::{Bounds, Meeting, Within};
use products::TwoQuadratics;

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

    #[inline(always)]
    fn bounds(&self) -> Bounds {
        Bounds {
            half_lengths: self.half_lengths,
            speeds: [self.path.speed(), self.path.direction_speed()],
            touching: self.size() + self.separation,
        }
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
        resolution(self.tolerance, self.speed())
    }

    #[inline]
    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let at = piece.mid();
        let EdgeJets { jets, half_b: d } = self.jets(piece, at);
        let whole = local(piece, at);
        let h = whole.reach();
        let remainders = [widened(jets.remainders[0], self.separation), jets.remainders[1]];
        let known_inside = self.inside.holds(piece);
        let mut searched = whole;
        if !known_inside && self.speed() * h > NEARBY * self.size() {
            let Some(near) = self.near(&jets, d, whole, h) else {
                return Verdict::Clear;
            };
            searched = near;
        }
        let bounds = self.bounds();
        let lines = LinesMeet::new(&jets, d, remainders, h, &bounds);
        let Some(part) = lines.f.clip(Band { lo: 0.0, hi: 0.0 }, |s| lines.margin(s), searched) else {
            return Verdict::Clear;
        };
        let mut within = Within { part, certain: known_inside };
        if !known_inside {
            // About the middle of what is left.
            let meeting = Meeting::new(&jets, d, &remainders, [part, padded(part, at, whole)], &bounds);
            let Some(found) = meeting.within_edges(&jets) else {
                return Verdict::Clear;
            };
            within = found;
            if within.certain {
                self.inside = global(within.part, at, piece);
            }
        }
        let Within { part, certain } = within;
        let certain = certain
            && self.fine(part, piece)
            && (lines.change_sign(searched) || lines.change_sign(around(part, searched)));
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
