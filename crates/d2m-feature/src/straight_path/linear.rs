//! Vectors and functions that are linear in time; functions exclude a contact while they share a sign.
use crate::rounding::{UNIT, length_up};
use core::ops::Sub;
use d2m_root::Piece;
use glam::DVec3;

/// A vector that is linear in the time from some moment: `p + v·s`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) p: DVec3,
    pub(super) v: DVec3,
}

impl Line {
    /// The same line with the time counted from `at`.
    #[inline(always)]
    pub(super) fn from(&self, at: f64) -> Self {
        Self { p: self.p + self.v * at, v: self.v }
    }

    #[inline(always)]
    pub(super) fn along(&self, d: DVec3) -> Linear {
        Linear { value: d.dot(self.p), slope: d.dot(self.v) }
    }

    /// The line of the products with `n`: `p × n` and `v × n`.
    #[inline(always)]
    pub(super) fn cross(&self, n: DVec3) -> Self {
        Self { p: self.p.cross(n), v: self.v.cross(n) }
    }

    /// The lengths of `p` and `v`.
    #[inline(always)]
    pub(super) fn lengths(&self) -> Lengths {
        Lengths { p: length_up(self.p), v: length_up(self.v) }
    }
}

impl Sub for Line {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self { p: self.p - other.p, v: self.v - other.v }
    }
}

/// Lengths of a line's vectors.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lengths {
    p: f64,
    v: f64,
}

impl Lengths {
    /// Upper bound of the line's length for |s| ≤ h, up to rounding.
    #[inline(always)]
    pub(super) fn within(&self, h: f64) -> f64 {
        self.p + self.v * h
    }
}

/// `value + slope·s`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Linear {
    pub(super) value: f64,
    pub(super) slope: f64,
}

impl Linear {
    #[inline(always)]
    pub(super) fn at(&self, s: f64) -> f64 {
        self.value + self.slope * s
    }

    /// The least value for |s| ≤ h.
    #[inline(always)]
    pub(super) fn least(&self, h: f64) -> f64 {
        self.value - self.slope.abs() * h
    }
}

/// Keeps a proven time early: value 2, margin 1, quotient 1, this product 1, and the sums that the margin leaves to it are
/// fewer than 32 roundings of 2⁻⁵³.
const EARLY: f64 = 1.0 - 32.0 * UNIT;

/// How far from `s` in the direction `forward` (±1) all functions certainly keep the sign that they share at `s`.
#[inline(always)]
fn shared<const N: usize>(functions: &[Linear; N], margin: f64, s: f64, forward: f64) -> f64 {
    let values = functions.map(|f| f.at(s));
    let least = values.iter().fold(f64::INFINITY, |m, &v| m.min(v));
    let most = values.iter().fold(f64::NEG_INFINITY, |m, &v| m.max(v));
    let sign = if least > margin {
        1.0
    } else if most < -margin {
        -1.0
    } else {
        return 0.0;
    };
    let mut reach = f64::INFINITY;
    for (value, f) in values.iter().zip(functions) {
        let fall = -sign * forward * f.slope;
        if fall > 0.0 {
            reach = reach.min((sign * value - margin) / fall);
        }
    }
    reach * EARLY
}

/// By how much functions are above a margin at s = 0, and where around it they stay above.
#[derive(Debug, Clone, Copy)]
pub(super) struct Clearance {
    pub(super) gap: f64,
    pub(super) around: Piece,
}

impl Clearance {
    /// Not above at s = 0, as far as is known.
    pub(super) const NONE: Self = Self { gap: 0.0, around: Piece { lo: 0.0, hi: 0.0 } };
}

/// Around s = 0: how far to the left and right all functions certainly stay above `margin`.
pub(super) fn clear_above<const N: usize>(functions: &[Linear; N], margin: f64) -> Clearance {
    let gap = functions.iter().fold(f64::INFINITY, |m, f| m.min(f.value)) - margin;
    if gap > 0.0 && functions.iter().all(|f| f.slope.is_finite() && f.value.is_finite()) {
        let (hi, lo) = (shared(functions, margin, 0.0, 1.0), shared(functions, margin, 0.0, -1.0));
        Clearance { gap, around: Piece { lo: -lo, hi } }
    } else {
        Clearance::NONE
    }
}
