//! Two edges, all four vertices on straight paths.
use super::Lines;
use super::linear::{Clearance, Line, clear_above};
use super::point_triangle::vertices;
use super::triple_product::{Allowed, Seen, TripleProduct};
use crate::accurate_cross::{Difference, accurate_cross};
use crate::closest;
use crate::options::ContactOptions;
use crate::path::{around, direction, global, local, padded};
use crate::point_triangle::cleared;
use crate::rounding::{CLOSE, UP, length_up};
use d2m_root::{Measurement, Piece, PieceTest, Verdict};
use glam::DVec3;

/// The piece test. With the difference `w` of the midpoints and the half edges `e`, `d`: `f = w·(e × d)`, a cubic.
pub(super) struct StraightEdgeEdge {
    /// `w`, `e`, `d` from t = 0.
    lines: [Line; 3],
    error: f64,
    speed: f64,
    size: f64,
    tolerance: f64,
    separation: f64,
    /// A piece throughout which the edges, where they lie in a plane, cross inside both.
    inside: Piece,
}

impl StraightEdgeEdge {
    #[inline(always)]
    pub(super) fn new(lines: &Lines, options: &ContactOptions) -> Self {
        let combine = |points: &[DVec3; 4]| {
            let w = (points[0] - points[2] + (points[1] - points[3])) * 0.5;
            (w, (points[1] - points[0]) * 0.5, (points[3] - points[2]) * 0.5)
        };
        let (w0, e0, d0) = combine(&lines.start);
        let (w1, e1, d1) = combine(&lines.velocity);
        let error = lines.error(64.0);
        let size = lines.magnitude;
        let tolerance = options
            .wanted_tolerance(2.0 * e0.length_squared().max(d0.length_squared()).sqrt(), lines.magnitude)
            .max(4.0 * error);
        let speed = length_up(w1) + length_up(e1) + length_up(d1);
        let separation = options.separation();
        let lines = [Line { p: w0, v: w1 }, Line { p: e0, v: e1 }, Line { p: d0, v: d1 }];
        Self { lines, error, speed, size, tolerance, separation, inside: Piece::NONE }
    }

    #[inline(always)]
    fn lines(&self, at: f64) -> [Line; 3] {
        let [w, e, d] = &self.lines;
        [w.from(at), e.from(at), d.from(at)]
    }

    /// All four vertices `w ± e ± d` on one side throughout, seen along the line of the midpoints.
    #[inline(always)]
    fn apart(&self, [w, e, d]: &[Line; 3], h: f64) -> bool {
        let n = w.p;
        let margin = (self.error + self.separation) * length_up(n);
        let (w, e, d) = (w.along(n), e.along(n), d.along(n));
        let clear = |s: f64| w.at(s) - e.at(s).abs() - d.at(s).abs() > margin;
        clear(-h) && clear(h)
    }
}

impl PieceTest for StraightEdgeEdge {
    fn too_wide(&self, _: f64) -> bool {
        false
    }

    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn resolution(&self) -> f64 {
        let resolution = self.tolerance / (2.0 * self.speed);
        if resolution.is_nan() { f64::INFINITY } else { resolution }
    }

    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let at = piece.mid();
        let lines = self.lines(at);
        let whole = local(piece, at);
        let h = whole.reach();
        let known_inside = self.inside.holds(piece);
        if !known_inside && self.apart(&lines, h) {
            return Verdict::Clear;
        }
        let [w, e, d] = &lines;
        let lengths = [w.lengths(), e.lengths(), d.lengths()];
        let allowed = Allowed { error: self.error, separation: self.separation };
        let volume = TripleProduct::new(&lines, &lengths, h, allowed);
        let Some(mut part) = volume.clip(whole) else {
            return Verdict::Clear;
        };
        let mut certain = known_inside;
        if !known_inside {
            // n = e × d, frozen in the middle. w + se = td gives s·N = −n·(w × d) and t·N = −n·(w × e), N = n·(e × d).
            let n = volume.normal;
            let length = length_up(n);
            let padded = padded(part, at, whole);
            let s = padded.reach();
            let (lw, le, ld) = (lengths[0].within(s), lengths[1].within(s), lengths[2].within(s));
            let (across_d, across_e) = (d.cross(n), e.cross(n));
            let total = Seen::new(e, &across_d, length, [le, ld], Allowed { separation: 0.0, ..allowed });
            let meeting = part;
            let mut inside = true;
            for seen in [
                Seen::new(w, &across_d, length, [lw, ld], allowed),
                Seen::new(w, &across_e, length, [lw, le], allowed),
            ] {
                let margin = (total.margin + seen.margin) * UP;
                let (above, below) = (total.quadratic + seen.quadratic, seen.quadratic - total.quadratic);
                let Some(beside) = above.clip_shared_sign_beyond(&below, margin, part) else {
                    return Verdict::Clear;
                };
                part = beside;
                inside = inside && above.exceeds(margin, padded) && (-below).exceeds(margin, padded);
            }
            if inside && part == meeting && total.is_positive(padded) {
                certain = true;
                self.inside = global(part, at, piece);
            }
        }
        let certain = certain && (volume.changes_sign(whole) || volume.changes_sign(around(part, whole)));
        Verdict::Within { part: global(part, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let [w, e, d] = self.lines(at);
        let pair = closest::segment_segment(w.p, e.p, d.p);
        let distance = length_up(pair.difference) + self.error - self.separation;
        let whole = local(piece, at);
        let margin = self.error + self.separation;
        let mut best = Clearance::NONE;
        let mut consider = |n: DVec3| {
            let found = clear_above(&vertices(&w, &e, &d, n), margin);
            if found.gap > best.gap {
                best = found;
            }
        };
        consider(direction(pair.separating));
        if distance < CLOSE * self.size {
            let k = direction(accurate_cross(Difference::from(e.p), Difference::from(d.p)));
            consider(k);
            consider(-k);
            for edge in [e.p, d.p] {
                let n = direction(direction(edge).cross(k));
                consider(n);
                consider(-n);
            }
        }
        cleared(best.around, whole, at, piece, distance)
    }
}
