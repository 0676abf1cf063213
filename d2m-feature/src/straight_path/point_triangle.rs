//! A point and a triangle, all four vertices on straight paths.
use super::Lines;
use super::linear::{Line, Linear, clear_above, clip};
use super::triple_product::TripleProduct;
use crate::closest;
use crate::options::ContactOptions;
use crate::path::{direction, global, local, reach};
use crate::point_triangle::cleared;
use d2m_root::{Measurement, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;

const UP: f64 = 1.0 + 1e-14;
const UNIT: f64 = 0.5 * f64::EPSILON;

/// The piece test. `f = (p − b₀)·((b₁ − b₀) × (b₂ − b₀))` is a cubic, known exactly up to rounding.
pub(super) struct StraightPointTriangle<'a> {
    lines: &'a Lines,
    error: f64,
    speed: f64,
    tolerance: f64,
    separation: f64,
}

impl<'a> StraightPointTriangle<'a> {
    pub(super) fn new(lines: &'a Lines, options: &ContactOptions) -> Self {
        let v = &lines.velocity;
        let speed = (1..4).map(|i| (v[0] - v[i]).length_squared()).fold(0.0, f64::max).sqrt() * UP;
        let square = |a: usize, b: usize| (lines.start[a] - lines.start[b]).length_squared();
        let length = square(1, 2).max(square(2, 3)).max(square(1, 3)).sqrt();
        let error = lines.error(24.0);
        let tolerance = options.wanted_tolerance(length, lines.magnitude).max(4.0 * error);
        Self { lines, error, speed, tolerance, separation: options.separation() }
    }

    /// The vectors from the three vertices to the point, at a time.
    #[inline(always)]
    fn differences(&self, at: f64) -> [Line; 3] {
        let Lines { start, velocity, .. } = self.lines;
        let now = [0, 1, 2, 3].map(|i| start[i] + velocity[i] * at);
        [1, 2, 3].map(|i| Line { p: now[0] - now[i], v: velocity[0] - velocity[i] })
    }
}

/// `a − b`.
fn minus(a: &Line, b: &Line) -> Line {
    Line { p: a.p - b.p, v: a.v - b.v }
}

impl PieceTest for StraightPointTriangle<'_> {
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
        let lines = self.differences(at);
        let whole = local(piece, at);
        let h = reach(whole);
        let margin = self.error + self.separation;

        // Along the line from the vertices' mean to the point.
        let away = lines[0].p + lines[1].p + lines[2].p;
        let length = away.length() * UP;
        let apart = lines.map(|line| line.along(away));
        if clip(&apart, margin * length, whole).is_none() {
            return Verdict::Clear;
        }

        // The cubic: a·(e₁ × e₂) with e_i = b_i − b₀ = (p − b₀) − (p − b_i).
        let a = lines[0];
        let (e1, e2) = (minus(&a, &lines[1]), minus(&a, &lines[2]));
        let volume = TripleProduct::new(&a, &e1, &e2, h, (self.error, self.separation));
        let (f, n0) = (volume.quadratic, volume.normal);
        let Some(meeting) = f.clip(volume.band(h), whole) else {
            return Verdict::Clear;
        };
        // In-plane side normals, frozen in the middle.
        let sides = [e1.p, e2.p - e1.p, -e2.p].map(|edge| direction(edge.cross(n0)));
        let families = sides.map(|side| lines.map(|line| line.along(side)));
        let beside = |mut part: Piece| {
            for family in &families {
                part = clip(family, margin, part)?;
            }
            Some(part)
        };
        let Some(inside) = beside(meeting) else {
            return Verdict::Clear;
        };
        let Some(meeting_again) = f.clip(volume.band(reach(inside)), inside) else {
            return Verdict::Clear;
        };
        let Some(last) = beside(meeting_again) else {
            return Verdict::Clear;
        };
        // A true crossing: f changes sign, only f has cut, and along n0 the point is seen inside throughout.
        let certain = inside == meeting && last == meeting_again && {
            let wide = volume.band(h).hi;
            let (first, second) = (f.at(whole.lo), f.at(whole.hi));
            let changes = (first > wide && second < -wide) || (first < -wide && second > wide);
            changes && self.seen_inside(&lines, n0, last)
        };
        Verdict::Within { part: global(last, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let lines = self.differences(at);
        let corners = lines.map(|line| -line.p);
        let normal = direction((corners[1] - corners[0]).cross(corners[2] - corners[0]));
        let pair = closest::point_triangle(DVec3::ZERO, &corners, normal);
        let distance = pair.difference.length() * UP + self.error - self.separation;
        let whole = local(piece, at);
        let margin = self.error + self.separation;
        let mut clear = Piece { lo: 0.0, hi: 0.0 };
        let mut best = 0.0;
        let mut consider = |d: DVec3| {
            let (gap, radii) = clear_above(&lines.map(|line| line.along(d)), margin);
            if gap > best {
                best = gap;
                clear = radii;
            }
        };
        consider(direction(pair.separating));
        if distance < 1e-6 * self.lines.magnitude {
            consider(normal);
            consider(-normal);
            for i in 0..3 {
                consider(direction((corners[(i + 1) % 3] - corners[i]).cross(normal)));
            }
        }
        cleared(clear, whole, at, piece, distance)
    }
}

impl StraightPointTriangle<'_> {
    /// Along the fixed direction n the point is certainly inside the triangle throughout the part: the three areas
    /// `n·((b_i − p) × (b_j − p))`, quadratics in time, are certainly positive.
    fn seen_inside(&self, lines: &[Line; 3], n: DVec3, part: Piece) -> bool {
        let s = reach(part);
        let length = n.length() * UP;
        (0..3).all(|i| {
            let (x, y) = (&lines[i], &lines[(i + 1) % 3]);
            let area = Quadratic {
                value: n.dot(x.p.cross(y.p)),
                slope: n.dot(x.p.cross(y.v) + x.v.cross(y.p)),
                curvature: 2.0 * n.dot(x.v.cross(y.v)),
            };
            let (lx, ly) = (x.longest(s), y.longest(s));
            let margin = length * (32.0 * UNIT * lx * ly + self.error * (lx + ly + self.error)) * UP;
            area.bound_below(part) > margin
        })
    }
}

/// Used by the edge test as well: the functions `w ± e ± d` along a direction.
pub(super) fn corners(w: &Line, e: &Line, d: &Line, n: DVec3) -> [Linear; 4] {
    let (w, e, d) = (w.along(n), e.along(n), d.along(n));
    let corner = |s: f64, t: f64| Linear {
        value: w.value + s * e.value + t * d.value,
        slope: w.slope + s * e.slope + t * d.slope,
    };
    [corner(1.0, 1.0), corner(1.0, -1.0), corner(-1.0, 1.0), corner(-1.0, -1.0)]
}
