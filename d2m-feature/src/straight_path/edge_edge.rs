//! Two edges, all four vertices on straight paths.
use super::Lines;
use super::linear::{Line, clear_above, clip};
use super::point_triangle::corners;
use super::triple_product::TripleProduct;
use crate::closest;
use crate::options::ContactOptions;
use crate::path::{direction, global, local, reach};
use crate::point_triangle::cleared;
use d2m_root::{Measurement, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;

const UP: f64 = 1.0 + 1e-14;
const UNIT: f64 = 0.5 * f64::EPSILON;

/// The piece test. With the difference `w` of the midpoints and the half edges `e`, `d`: `f = w·(e × d)`, a cubic.
pub(super) struct StraightEdgeEdge {
    w: (DVec3, DVec3),
    e: (DVec3, DVec3),
    d: (DVec3, DVec3),
    error: f64,
    speed: f64,
    size: f64,
    tolerance: f64,
    separation: f64,
}

impl StraightEdgeEdge {
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
        let speed = (w1.length() + e1.length() + d1.length()) * UP;
        let separation = options.separation();
        Self { w: (w0, w1), e: (e0, e1), d: (d0, d1), error, speed, size, tolerance, separation }
    }

    #[inline(always)]
    fn lines(&self, at: f64) -> [Line; 3] {
        [self.w, self.e, self.d].map(|(p, v)| Line { p: p + v * at, v })
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
        let [w, e, d] = self.lines(at);
        let whole = local(piece, at);
        let h = reach(whole);
        let margin = self.error + self.separation;

        // Along the line of the midpoints.
        let length = w.p.length() * UP;
        if clip(&corners(&w, &e, &d, w.p), margin * length, whole).is_none() {
            return Verdict::Clear;
        }

        let volume = TripleProduct::new(&w, &e, &d, h, (self.error, self.separation));
        let (f, k0) = (volume.quadratic, volume.normal);
        let Some(meeting) = f.clip(volume.band(h), whole) else {
            return Verdict::Clear;
        };
        // Across either edge in the plane of both, frozen in the middle.
        let across = [direction(d.p.cross(k0)), direction(e.p.cross(k0))];
        let families = across.map(|n| corners(&w, &e, &d, n));
        let overlap = |part: Piece| {
            let part = clip(&families[0], margin, part)?;
            clip(&families[1], margin, part)
        };
        let Some(inside) = overlap(meeting) else {
            return Verdict::Clear;
        };
        let Some(meeting_again) = f.clip(volume.band(reach(inside)), inside) else {
            return Verdict::Clear;
        };
        let Some(last) = overlap(meeting_again) else {
            return Verdict::Clear;
        };
        let certain = inside == meeting && last == meeting_again && {
            let wide = volume.band(h).hi;
            let (first, second) = (f.at(whole.lo), f.at(whole.hi));
            let changes = (first > wide && second < -wide) || (first < -wide && second > wide);
            changes && self.seen_crossing(&w, &e, &d, k0, last)
        };
        Verdict::Within { part: global(last, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let [w, e, d] = self.lines(at);
        let pair = closest::segment_segment(w.p, e.p, d.p);
        let distance = pair.difference.length() * UP + self.error - self.separation;
        let whole = local(piece, at);
        let margin = self.error + self.separation;
        let mut clear = Piece { lo: 0.0, hi: 0.0 };
        let mut best = 0.0;
        let mut consider = |n: DVec3| {
            let (gap, radii) = clear_above(&corners(&w, &e, &d, n), margin);
            if gap > best {
                best = gap;
                clear = radii;
            }
        };
        consider(direction(pair.separating));
        if distance < 1e-6 * self.size {
            let k = direction(e.p.cross(d.p));
            consider(k);
            consider(-k);
            for edge in [e.p, d.p] {
                let n = direction(direction(edge).cross(k));
                consider(n);
                consider(-n);
            }
        }
        cleared(clear, whole, at, piece, distance)
    }
}

impl StraightEdgeEdge {
    /// Along the fixed direction n the two edges certainly cross in their interiors throughout the part: seen along
    /// n, the ends of each lie on opposite sides of the other's line.
    fn seen_crossing(&self, w: &Line, e: &Line, d: &Line, n: DVec3, part: Piece) -> bool {
        let s = reach(part);
        let length = n.length() * UP;
        let triple = |x: &Line, y: &Line, sign: f64| {
            let q = Quadratic {
                value: n.dot(x.p.cross(y.p)),
                slope: n.dot(x.p.cross(y.v) + x.v.cross(y.p)),
                curvature: 2.0 * n.dot(x.v.cross(y.v)),
            };
            let (lx, ly) = (x.longest(s), y.longest(s));
            let margin = length * (32.0 * UNIT * lx * ly + self.error * (lx + ly + self.error)) * UP;
            let oriented = if sign < 0.0 { -q } else { q };
            oriented.bound_below(part) > margin
        };
        let plus = |a: &Line, b: &Line, s: f64| Line { p: a.p + b.p * s, v: a.v + b.v * s };
        // n·((w ± e) × d): ends of A against B's line; n·((w ∓ d) × e): ends of B against A's line.
        let (a0, a1) = (plus(w, e, 1.0), plus(w, e, -1.0));
        let (b0, b1) = (plus(w, d, 1.0), plus(w, d, -1.0));
        ((triple(&a0, d, 1.0) && triple(&a1, d, -1.0)) || (triple(&a0, d, -1.0) && triple(&a1, d, 1.0)))
            && ((triple(&b0, e, 1.0) && triple(&b1, e, -1.0))
                || (triple(&b0, e, -1.0) && triple(&b1, e, 1.0)))
    }
}
