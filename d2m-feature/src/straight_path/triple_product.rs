//! The cubic of four points on straight paths: zero when they lie in a plane.
use super::linear::Line;
use d2m_root::{Band, Quadratic};
use glam::DVec3;

const UP: f64 = 1.0 + 1e-14;
const UNIT: f64 = 0.5 * f64::EPSILON;

/// `a·(b × c)` of three lines over |s| ≤ h: its quadratic part, and a bound on what that leaves out.
pub(super) struct TripleProduct {
    /// The cubic without its s³ term.
    pub(super) quadratic: Quadratic,
    /// `b × c` at s = 0.
    pub(super) normal: DVec3,
    /// |coefficient of s³|.
    cubic: f64,
    /// What the value may be at a contact: the wanted separation along `b × c`, and roundings.
    far: f64,
}

impl TripleProduct {
    /// `error` bounds the error of each line's points; contact begins at a distance of `separation`.
    #[inline(always)]
    pub(super) fn new(a: &Line, b: &Line, c: &Line, h: f64, (error, separation): (f64, f64)) -> Self {
        let n0 = b.p.cross(c.p);
        let n1 = b.p.cross(c.v) + b.v.cross(c.p);
        let n2 = b.v.cross(c.v);
        let quadratic = Quadratic {
            value: a.p.dot(n0),
            slope: a.p.dot(n1) + a.v.dot(n0),
            curvature: 2.0 * (a.p.dot(n2) + a.v.dot(n1)),
        };
        let cubic = a.v.dot(n2).abs();
        let (la, lb, lc) = (a.longest(h), b.longest(h), c.longest(h));
        let rounding = 32.0 * UNIT * la * lb * lc + error * (lb * lc + la * lc + la * lb);
        Self { quadratic, normal: n0, cubic, far: separation * lb * lc + rounding }
    }

    /// The values of the quadratic that a contact at a time |t| ≤ s may have.
    #[inline(always)]
    pub(super) fn band(&self, s: f64) -> Band {
        let margin = (self.cubic * s * s * s + self.far) * UP;
        Band { lo: -margin, hi: margin }
    }
}
