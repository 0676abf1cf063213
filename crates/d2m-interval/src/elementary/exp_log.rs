//! Exponentials and logarithms to the bases e, 2 and 10.
use super::{
    Ends,
    constants::{INVERSE_FACTORIAL, INVERSE_ODD, LN_2, LN_2_PARTS, LN_10, LOG2_10, LOG2_E, LOG10_E},
    enclose, increasing,
    trig::MAGIC,
};
use crate::Interval;
use d2m_lanes::{Binary, DoubleDouble};

fn nearest_integer(x: f64) -> f64 {
    (x + MAGIC) - MAGIC
}

/// `value · 2^exponent` with 0.5 < value < 2 (or any moderate value).
#[derive(Clone, Copy)]
pub(super) struct Scaled {
    pub(super) value: DoubleDouble,
    pub(super) exponent: i32,
}

impl Scaled {
    /// Ends of an enclosure of a positive number, given ends of `value`; correct in the subnormal range and
    /// beyond the largest double, without rounding arithmetic.
    pub(super) fn ends(self, (lo, hi): Ends) -> Ends {
        (scaled(lo, self.exponent).0, scaled(hi, self.exponent).1)
    }
}

/// The greatest double not above `x·2^k` and the least not below it, for a normal `x > 0`; other `x` as they are.
fn scaled(x: f64, k: i32) -> Ends {
    if x.is_infinite() || x <= 0.0 {
        return (x, x);
    }
    let bits = x.to_bits();
    let exponent = (bits >> 52) as i32;
    let target = exponent.saturating_add(k);
    if target >= 2047 {
        return (f64::MAX, f64::INFINITY);
    }
    if target >= 1 {
        let exact = f64::from_bits((bits & ((1 << 52) - 1)) | (target as u64) << 52);
        return (exact, exact);
    }
    // Subnormal: shift the mantissa, carry the rest upwards.
    let mantissa = (bits & ((1 << 52) - 1)) | 1 << 52;
    let shift = (1 - target) as u32;
    let kept = mantissa.checked_shr(shift).unwrap_or(0);
    let lost = shift >= 64 || mantissa & ((1 << shift) - 1) != 0;
    (f64::from_bits(kept), f64::from_bits(kept + u64::from(lost)))
}

/// `e^x` for a double-double |x| < 800: relative error below 2⁻⁶⁸, plus that of `x`, absolute.
pub(super) fn exp_scaled(x: DoubleDouble) -> Scaled {
    let k = nearest_integer(x.hi * LOG2_E.hi);
    let [a, b, c] = LN_2_PARTS;
    // k·a and k·b are exact.
    let r = DoubleDouble::from_sum(x.hi, -k * a)
        + DoubleDouble::from_f64(x.lo)
        + DoubleDouble::from_sum(-k * b, -k * c);
    exp_reduced(r, k as i32)
}

/// `2^k e^r` for |r| ≤ 0.35.
fn exp_reduced(r: DoubleDouble, k: i32) -> Scaled {
    Scaled { value: DoubleDouble::polynomial(r, &INVERSE_FACTORIAL[..18], 9), exponent: k }
}

/// ln MAX = 709.782…: eˣ is greater than every double above.
const EXP_OVERFLOWS: f64 = 709.79;
/// ln 2⁻¹⁰⁷⁴ = −744.44…: eˣ is less than every positive double below.
const EXP_UNDERFLOWS: f64 = -745.2;
/// log₁₀ MAX = 308.254….
const EXP10_OVERFLOWS: f64 = 308.3;
/// log₁₀ 2⁻¹⁰⁷⁴ = −323.306….
const EXP10_UNDERFLOWS: f64 = -323.4;

fn exp_at(x: f64) -> Ends {
    if x == 0.0 {
        return (1.0, 1.0);
    }
    if x > EXP_OVERFLOWS {
        return (f64::MAX, f64::INFINITY);
    }
    if x < EXP_UNDERFLOWS {
        return (0.0, f64::from_bits(1));
    }
    let y = exp_scaled(DoubleDouble::from_f64(x));
    y.ends(enclose(y.value))
}

fn exp2_at(x: f64) -> Ends {
    if x >= 1024.0 {
        return (f64::MAX, f64::INFINITY);
    }
    if x < -1074.0 {
        return (0.0, f64::from_bits(1));
    }
    let k = nearest_integer(x);
    if x == k {
        return scaled(1.0, k as i32);
    }
    let y = exp_reduced(DoubleDouble::from_product(x - k, 1.0) * LN_2, k as i32);
    y.ends(enclose(y.value))
}

fn exp10_at(x: f64) -> Ends {
    if x == 0.0 {
        return (1.0, 1.0);
    }
    if x > EXP10_OVERFLOWS {
        return (f64::MAX, f64::INFINITY);
    }
    if x < EXP10_UNDERFLOWS {
        return (0.0, f64::from_bits(1));
    }
    let k = nearest_integer(x * LOG2_10.hi);
    let [a, b, c] = LN_2_PARTS;
    let r = DoubleDouble::from_f64(x) * LN_10
        + DoubleDouble::from_f64(-k * a)
        + DoubleDouble::from_sum(-k * b, -k * c);
    let y = exp_reduced(r, k as i32);
    y.ends(enclose(y.value))
}

/// `ln(n/d) = 2 atanh((n − d)/(n + d))` for `0.7 < n/d < 1.42`, given difference and sum.
pub(super) fn ln_ratio(difference: DoubleDouble, sum: DoubleDouble) -> DoubleDouble {
    let s = difference / sum;
    s.scaled(2.0) * DoubleDouble::polynomial(s.sqr(), &INVERSE_ODD[..15], 6)
}

/// Positive `x` as `m·2^e` with √½ ≤ m < √2 (nearly).
fn split(x: f64) -> (f64, i32) {
    let Binary { mantissa: m, exponent: e } = Binary::from_f64(x);
    if m > core::f64::consts::SQRT_2 { (0.5 * m, e + 1) } else { (m, e) }
}

/// `ln x` for a positive double-double away from overflow: relative error below 2⁻⁶⁸.
pub(super) fn ln_dd(x: DoubleDouble) -> DoubleDouble {
    let (m, e) = split(x.hi);
    // The power of two that made m out of x, applied to the low part.
    let low = x.lo / x.hi * m;
    ln_parts(DoubleDouble::new(m, low), e)
}

fn ln_parts(m: DoubleDouble, e: i32) -> DoubleDouble {
    let ln_m = ln_ratio(
        DoubleDouble::from_sum(m.hi, -1.0) + DoubleDouble::from_f64(m.lo),
        DoubleDouble::from_sum(m.hi, 1.0) + DoubleDouble::from_f64(m.lo),
    );
    if e == 0 { ln_m } else { LN_2 * DoubleDouble::from_f64(f64::from(e)) + ln_m }
}

/// `ln x` for a positive double, subnormals included.
pub(super) fn ln_value(x: f64) -> DoubleDouble {
    let (m, e) = split(x);
    ln_parts(DoubleDouble::from_f64(m), e)
}

fn ln_at(x: f64) -> Ends {
    if x == 1.0 { (0.0, 0.0) } else { enclose(ln_value(x)) }
}

fn log2_at(x: f64) -> Ends {
    let (m, e) = split(x);
    if m == 1.0 {
        return (f64::from(e), f64::from(e));
    }
    enclose(ln_parts(DoubleDouble::from_f64(m), 0) * LOG2_E + DoubleDouble::from_f64(f64::from(e)))
}

fn log10_at(x: f64) -> Ends {
    if x == 1.0 { (0.0, 0.0) } else { enclose(ln_value(x) * LOG10_E) }
}

/// A logarithm over the positive part of an interval.
fn logarithm(x: Interval, at: impl Fn(f64) -> Ends) -> Interval {
    if x.is_empty() || x.hi() <= 0.0 {
        return Interval::EMPTY;
    }
    let lo = if x.lo() <= 0.0 { f64::NEG_INFINITY } else { at(x.lo()).0 };
    let hi = if x.hi() == f64::INFINITY { f64::INFINITY } else { at(x.hi()).1 };
    Interval::from_ends(lo, hi)
}

impl Interval {
    /// `eˣ`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let e = Interval::ONE.exp();
    /// assert!(e.contains(std::f64::consts::E) && e.width() < 1e-15);
    /// ```
    pub fn exp(self) -> Self {
        increasing(self, exp_at, 0.0, f64::INFINITY)
    }

    /// `2ˣ`.
    pub fn exp2(self) -> Self {
        increasing(self, exp2_at, 0.0, f64::INFINITY)
    }

    /// `10ˣ`.
    pub fn exp10(self) -> Self {
        increasing(self, exp10_at, 0.0, f64::INFINITY)
    }

    /// `ln x` over the positive part; empty when there is none.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::point(2.0).ln().contains(std::f64::consts::LN_2));
    /// assert_eq!(Interval::new(-1.0, 1.0).ln(), Interval::new(f64::NEG_INFINITY, 0.0));
    /// assert!(Interval::new(-1.0, 0.0).ln().is_empty());
    /// ```
    pub fn ln(self) -> Self {
        logarithm(self, ln_at)
    }

    /// `log₂ x` over the positive part; exact at powers of two.
    pub fn log2(self) -> Self {
        logarithm(self, log2_at)
    }

    /// `log₁₀ x` over the positive part.
    pub fn log10(self) -> Self {
        logarithm(self, log10_at)
    }
}
