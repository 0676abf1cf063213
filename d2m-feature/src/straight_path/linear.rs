//! Linear functions of time that exclude a contact while they share a sign.
use d2m_root::Piece;
use glam::DVec3;

/// A vector that is linear in the time from the middle of a piece: `p + v·s`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    pub(super) p: DVec3,
    pub(super) v: DVec3,
}

impl Line {
    #[inline(always)]
    pub(super) fn along(&self, d: DVec3) -> Linear {
        Linear { value: d.dot(self.p), slope: d.dot(self.v) }
    }

    /// Upper bound of the length for |s| ≤ h, up to rounding.
    #[inline(always)]
    pub(super) fn longest(&self, h: f64) -> f64 {
        self.p.length() + self.v.length() * h
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
}

/// Keeps a proven time early: more than the roundings of its formula.
const EARLY: f64 = 1.0 - 16.0 * f64::EPSILON;

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

/// Cuts off both ends of `part` where all functions certainly share a sign; `None` if that is all of it. `margin`
/// covers the error of the values and their change over 4·2⁻⁵³ of the piece. What is not finite excludes
/// nothing.
#[inline(always)]
pub(super) fn clip<const N: usize>(functions: &[Linear; N], margin: f64, part: Piece) -> Option<Piece> {
    if functions.iter().any(|f| !(f.value.is_finite() && f.slope.is_finite())) {
        return Some(part);
    }
    let Piece { mut lo, mut hi } = part;
    let advance = shared(functions, margin, lo, 1.0);
    if advance > 0.0 {
        if advance > hi - lo {
            return None;
        }
        lo += advance;
    }
    let retreat = shared(functions, margin, hi, -1.0);
    if retreat > 0.0 {
        if retreat > hi - lo {
            return None;
        }
        hi -= retreat;
    }
    Some(Piece { lo, hi })
}

/// Around s = 0: how far to the left and right all functions certainly stay above `margin`.
pub(super) fn clear_above<const N: usize>(functions: &[Linear; N], margin: f64) -> (f64, Piece) {
    let gap = functions.iter().fold(f64::INFINITY, |m, f| m.min(f.value)) - margin;
    if gap > 0.0 && functions.iter().all(|f| f.slope.is_finite() && f.value.is_finite()) {
        let (hi, lo) = (shared(functions, margin, 0.0, 1.0), shared(functions, margin, 0.0, -1.0));
        (gap, Piece { lo: -lo, hi })
    } else {
        (0.0, Piece { lo: 0.0, hi: 0.0 })
    }
}
