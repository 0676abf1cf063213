//! A point and a triangle, all four vertices on straight paths.
use super::linear::{Clearance, Line, Linear, clear_above};
use super::triple_product::{Allowed, Seen, TripleProduct};
use super::{Lines, larger, largest};
use crate::closest;
use crate::options::ContactOptions;
use crate::path::{around, direction, global, local, padded};
use crate::point_triangle::cleared;
use crate::rounding::{CLOSE, UNDERFLOW, UP, length_up};
use d2m_root::{Band, Measurement, Piece, PieceTest, Verdict};
use glam::DVec3;

/// The piece test. With `a` from a vertex to the point and `e₁`, `e₂` from it to the others: `f = a·(e₁ × e₂)`, a cubic,
/// known exactly up to rounding.
pub(super) struct StraightPointTriangle {
    /// From t = 0: `a`, `e₁`, `e₂`. The vertex is the one across from the side that is longest at the start.
    lines: [Line; 3],
    error: f64,
    size: f64,
    speed: f64,
    tolerance: f64,
    separation: f64,
    /// A piece throughout which the point is inside the triangle where it is in its plane.
    inside: Piece,
}

impl StraightPointTriangle {
    #[inline(always)]
    pub(super) fn new(lines: &Lines, options: &ContactOptions) -> Self {
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
        let speed = largest(&speeds).sqrt() * UP + UNDERFLOW;
        let error = lines.error(48.0);
        let tolerance = larger(options.wanted_tolerance(square.sqrt(), lines.magnitude), 4.0 * error);
        Self {
            lines: [a, e1, e2],
            error,
            size: lines.magnitude,
            speed,
            tolerance,
            separation: options.separation(),
            inside: Piece::NONE,
        }
    }

    /// The vectors from the three vertices to the point.
    #[inline(always)]
    fn differences([a, e1, e2]: &[Line; 3]) -> [Line; 3] {
        [*a, *a - *e1, *a - *e2]
    }

    /// Outside throughout, seen along the line from the mean of the vertices to the point.
    #[inline(always)]
    fn apart(&self, [a, e1, e2]: &[Line; 3], h: f64) -> bool {
        let away = a.p * 3.0 - (e1.p + e2.p);
        let margin = (self.error + self.separation) * length_up(away);
        let (a, e1, e2) = (a.along(away), e1.along(away), e2.along(away));
        let from = |e: Linear| Linear { value: a.value - e.value, slope: a.slope - e.slope };
        [a, from(e1), from(e2)].iter().all(|f| f.least(h) > margin)
    }
}

impl PieceTest for StraightPointTriangle {
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
        let [a, e1, e2] = &self.lines;
        let lines = [a.from(at), e1.from(at), e2.from(at)];
        let whole = local(piece, at);
        let h = whole.reach();
        let known_inside = self.inside.holds(piece);
        if !known_inside && self.apart(&lines, h) {
            return Verdict::Clear;
        }
        let [a, e1, e2] = &lines;
        let lengths = [a.lengths(), e1.lengths(), e2.lengths()];
        let allowed = Allowed { error: self.error, separation: self.separation };
        let volume = TripleProduct::new(&lines, &lengths, h, allowed);
        let Some(mut part) = volume.clip(whole) else {
            return Verdict::Clear;
        };
        let mut certain = known_inside;
        if !known_inside {
            // Areas seen along n = e₁ × e₂, frozen in the middle, as parts of the triangle's: a = λ₁e₁ + λ₂e₂ gives
            // n·(a × e₂) = λ₁·whole and n·(e₁ × a) = λ₂·whole; the third is what these leave of it.
            let n = volume.normal;
            let length = length_up(n);
            let s = padded(part, at, whole).reach();
            let (la, l1, l2) = (lengths[0].within(s), lengths[1].within(s), lengths[2].within(s));
            let (across1, across2) = (e1.cross(-n), e2.cross(n));
            let total = Seen::new(e1, &across2, length, [l1, l2], Allowed { separation: 0.0, ..allowed });
            let first = Seen::new(a, &across2, length, [la, l2], allowed);
            let second = Seen::new(a, &across1, length, [la, l1], allowed);
            let third = Seen {
                quadratic: total.quadratic - (first.quadratic + second.quadratic),
                margin: (total.margin + first.margin + second.margin) * UP,
            };
            let areas = [first, second, third];
            let in_plane = part;
            let facing = total.is_positive(padded(part, at, whole));
            if facing {
                // A contact needs all three parts at least 0.
                for area in &areas {
                    let positive = Band { lo: 0.0, hi: f64::INFINITY };
                    // Its margin covers the evaluation: 46u of the 56u of each product, 12u of them of values and slopes and 24u
                    // of half the curvature (features.md, "Straight paths"); the third has all three margins.
                    let Some(beside) = area.quadratic.clip_beyond(positive, area.margin, part) else {
                        return Verdict::Clear;
                    };
                    part = beside;
                }
            }
            let padded = padded(part, at, whole);
            if facing && part == in_plane && areas.iter().all(|area| area.is_positive(padded)) {
                certain = true;
                self.inside = global(part, at, piece);
            }
        }
        let certain = certain && (volume.changes_sign(whole) || volume.changes_sign(around(part, whole)));
        Verdict::Within { part: global(part, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let lines = Self::differences(&self.lines.map(|line| line.from(at)));
        let vertices = lines.map(|line| -line.p);
        let normal = direction((vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]));
        let pair = closest::point_triangle(DVec3::ZERO, &vertices, normal);
        let distance = length_up(pair.difference) + self.error - self.separation;
        let whole = local(piece, at);
        let margin = self.error + self.separation;
        let mut best = Clearance::NONE;
        let mut consider = |d: DVec3| {
            let found = clear_above(&lines.map(|line| line.along(d)), margin);
            if found.gap > best.gap {
                best = found;
            }
        };
        consider(direction(pair.separating));
        if distance < CLOSE * self.size {
            consider(normal);
            consider(-normal);
            for i in 0..3 {
                consider(direction((vertices[(i + 1) % 3] - vertices[i]).cross(normal)));
            }
        }
        cleared(best.around, whole, at, piece, distance)
    }
}

/// Used by the edge test: the functions `w ± e ± d` along a direction.
pub(super) fn vertices(w: &Line, e: &Line, d: &Line, n: DVec3) -> [Linear; 4] {
    let (w, e, d) = (w.along(n), e.along(n), d.along(n));
    let vertex = |s: f64, t: f64| Linear {
        value: w.value + s * e.value + t * d.value,
        slope: w.slope + s * e.slope + t * d.slope,
    };
    [vertex(1.0, 1.0), vertex(1.0, -1.0), vertex(-1.0, 1.0), vertex(-1.0, -1.0)]
}
