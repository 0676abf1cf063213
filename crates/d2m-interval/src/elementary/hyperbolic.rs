//! Hyperbolic functions and their inverses.
use super::{
    Ends,
    constants::INVERSE_FACTORIAL,
    enclose,
    exp_log::{Scaled, exp_scaled, ln_dd, ln_ratio},
    increasing, odd,
};
use crate::Interval;
use d2m_lanes::{DoubleDouble, power_of_two};

/// Below, `sinh x` and its relatives are `x` within a relative 2⁻⁶²: x² < 2⁻⁶⁶.
const LINEAR: f64 = 1e-10;
/// Above, asinh x and acosh x are ln 2x within 1/(4x²) < 10⁻³⁶/4.
const LARGE: f64 = 1e18;

const fn odd_factorials() -> [DoubleDouble; 11] {
    let mut out = [DoubleDouble::ZERO; 11];
    let mut i = 0;
    while i < 11 {
        out[i] = INVERSE_FACTORIAL[2 * i + 1];
        i += 1;
    }
    out
}

/// `sinh x` for |x| ≤ 0.5, by its series.
fn sinh_series(x: DoubleDouble) -> DoubleDouble {
    const COEFFICIENTS: [DoubleDouble; 11] = odd_factorials();
    x * DoubleDouble::polynomial(x.sqr(), &COEFFICIENTS, 5)
}

/// `(e^x ± e^−x)/2` for 0.3 < x < 711.
fn half_sum(x: f64, sign: f64) -> Scaled {
    let Scaled { value, exponent } = exp_scaled(DoubleDouble::from_f64(x));
    if exponent > 45 {
        // The other term is below a relative 2⁻⁸⁸.
        return Scaled { value, exponent: exponent - 1 };
    }
    let back = power_of_two(-2 * exponent);
    let other = (DoubleDouble::from_f64(sign) / value).scaled(back);
    Scaled { value: value + other, exponent: exponent - 1 }
}

fn sinh_at(x: f64) -> Ends {
    odd(x, |x| {
        if x < LINEAR {
            (x, x.next_up())
        } else if x < 0.5 {
            enclose(sinh_series(DoubleDouble::from_f64(x)))
        } else if x > 710.5 {
            (f64::MAX, f64::INFINITY)
        } else {
            let y = half_sum(x, -1.0);
            y.ends(enclose(y.value))
        }
    })
}

fn cosh_at(x: f64) -> Ends {
    let x = x.abs();
    if x == 0.0 {
        (1.0, 1.0)
    } else if x < LINEAR {
        (1.0, 1.0_f64.next_up())
    } else if x > 710.5 {
        (f64::MAX, f64::INFINITY)
    } else {
        let y = half_sum(x, 1.0);
        let (lo, hi) = y.ends(enclose(y.value));
        (if lo < 1.0 { 1.0 } else { lo }, hi)
    }
}

fn tanh_at(x: f64) -> Ends {
    odd(x, |x| {
        if x < LINEAR {
            return (x.next_down(), x);
        }
        if x > 40.0 {
            return (1.0_f64.next_down(), 1.0);
        }
        let y = if x < 0.25 {
            let s = sinh_series(DoubleDouble::from_f64(x));
            // cosh² = 1 + sinh²
            s / (DoubleDouble::ONE + s.sqr()).sqrt()
        } else {
            // 1 − 2/(e^2x + 1)
            let Scaled { value, exponent } = exp_scaled(DoubleDouble::from_f64(2.0 * x));
            let square = value.scaled(power_of_two(exponent));
            DoubleDouble::ONE - DoubleDouble::from_f64(2.0) / (square + DoubleDouble::ONE)
        };
        let (lo, hi) = enclose(y);
        (lo, if hi > 1.0 { 1.0 } else { hi })
    })
}

/// `ln(1 + w)` for a double-double w > −0.3.
fn ln_one_plus(w: DoubleDouble) -> DoubleDouble {
    if w.hi < 0.4 { ln_ratio(w, w + DoubleDouble::from_f64(2.0)) } else { ln_dd(w + DoubleDouble::ONE) }
}

fn asinh_at(x: f64) -> Ends {
    odd(x, |x| {
        if x < LINEAR {
            return (x.next_down(), x);
        }
        if x > LARGE {
            // ln(2x) + 1/(4x²) − …
            return enclose(ln_dd(DoubleDouble::from_f64(x)) + super::constants::LN_2);
        }
        // x + √(x² + 1) − 1 = x + x²/(1 + √(x² + 1))
        let square = DoubleDouble::from_product(x, x);
        let root = (square + DoubleDouble::ONE).sqrt();
        enclose(ln_one_plus(DoubleDouble::from_f64(x) + square / (root + DoubleDouble::ONE)))
    })
}

fn acosh_at(x: f64) -> Ends {
    if x == 1.0 {
        return (0.0, 0.0);
    }
    if x > LARGE {
        return enclose(ln_dd(DoubleDouble::from_f64(x)) + super::constants::LN_2);
    }
    // w = (x − 1) + √((x − 1)(x + 1)), acosh x = ln(1 + w)
    let less = DoubleDouble::from_sum(x, -1.0);
    let root = (less * DoubleDouble::from_sum(x, 1.0)).sqrt();
    enclose(ln_one_plus(less + root))
}

fn atanh_at(x: f64) -> Ends {
    odd(x, |x| {
        if x < LINEAR {
            return (x, x.next_up());
        }
        let (less, more) = (DoubleDouble::from_sum(1.0, -x), DoubleDouble::from_sum(1.0, x));
        let y = if x < 0.17 {
            ln_ratio(DoubleDouble::from_f64(2.0 * x), DoubleDouble::from_f64(2.0))
        } else {
            ln_dd(more / less)
        };
        enclose(y.scaled(0.5))
    })
}

impl Interval {
    /// `sinh x`.
    pub fn sinh(self) -> Self {
        increasing(self, sinh_at, f64::NEG_INFINITY, f64::INFINITY)
    }

    /// `cosh x`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let c = Interval::new(-1.0, 2.0).cosh();
    /// assert!(c.lo() == 1.0 && c.contains(2.0_f64.cosh()));
    /// ```
    pub fn cosh(self) -> Self {
        let size = self.abs();
        increasing(size, cosh_at, 1.0, f64::INFINITY)
    }

    /// `tanh x`.
    pub fn tanh(self) -> Self {
        increasing(self, tanh_at, -1.0, 1.0)
    }

    /// The inverse of `sinh`.
    pub fn asinh(self) -> Self {
        increasing(self, asinh_at, f64::NEG_INFINITY, f64::INFINITY)
    }

    /// The inverse of `cosh` over the part of the interval in `[1, ∞)`.
    pub fn acosh(self) -> Self {
        let domain = self.intersection(Self::raw(1.0, f64::INFINITY));
        increasing(domain, acosh_at, 0.0, f64::INFINITY)
    }

    /// The inverse of `tanh` over the part of the interval in `(−1, 1)`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::new(0.5, 2.0).atanh().contains(0.5_f64.atanh()));
    /// assert!(Interval::new(1.0, 2.0).atanh().is_empty());
    /// ```
    pub fn atanh(self) -> Self {
        if self.is_empty() || self.lo() >= 1.0 || self.hi() <= -1.0 {
            return Self::EMPTY;
        }
        let lo = if self.lo() <= -1.0 { f64::NEG_INFINITY } else { atanh_at(self.lo()).0 };
        let hi = if self.hi() >= 1.0 { f64::INFINITY } else { atanh_at(self.hi()).1 };
        Self::from_ends(lo, hi)
    }
}
