//! Powers and the cube root.
use super::{
    Ends, enclose, enclose_within,
    exp_log::{Scaled, exp_scaled, ln_value},
    increasing,
};
use crate::Interval;
use d2m_lanes::{Binary, DoubleDouble, power_of_two};

/// e^±800 is out of the range of doubles, also if the exponent is off by a few 2⁻⁵³ of itself.
const OUT_OF_RANGE: f64 = 800.0;
/// e^s with 0 < |s| < 10⁻¹⁸ lies between 1 and its neighbour on that side, 2⁻⁵³ = 1.1·10⁻¹⁶ away.
const NEXT_TO_ONE: f64 = 1e-18;

/// `x^n` for finite `x > 0`, `n ≥ 1`: relative error below `n·2⁻⁹⁸`.
fn power(x: f64, n: u32) -> Scaled {
    // x = m·2^e with 1 ≤ m < 2, and the same for every partial product.
    let Binary { mantissa: m, exponent: e } = Binary::from_f64(x);
    let (mut value, mut exponent) = (DoubleDouble::from_f64(m), i64::from(e));
    for bit in (0..n.ilog2()).rev() {
        value = value.sqr();
        exponent *= 2;
        if n >> bit & 1 == 1 {
            value = value * DoubleDouble::from_f64(m);
            exponent += i64::from(e);
        }
        while value.hi >= 2.0 {
            value = value.scaled(0.5);
            exponent += 1;
        }
    }
    Scaled { value, exponent: exponent.clamp(-100_000, 100_000) as i32 }
}

/// `x^n` for `x ≥ 0`, infinity included.
fn power_ends(x: f64, n: u32) -> Ends {
    if x == 0.0 {
        return (0.0, 0.0);
    }
    if x == f64::INFINITY {
        return (x, x);
    }
    let y = power(x, n);
    y.ends(if y.value.lo == 0.0 && n <= 64 && exact(x, n) {
        (y.value.hi, y.value.hi)
    } else {
        enclose(y.value)
    })
}

/// `x^−n` for `x ≥ 0`, infinity included; the limit at 0 from the right.
fn inverse_power_ends(x: f64, n: u32) -> Ends {
    if x == 0.0 {
        return (f64::INFINITY, f64::INFINITY);
    }
    if x == f64::INFINITY {
        return (0.0, 0.0);
    }
    let y = power(x, n);
    let y = Scaled { value: DoubleDouble::ONE / y.value, exponent: -y.exponent };
    y.ends(enclose(y.value))
}

/// Whether `x^n` certainly fits 53 bits: then the double-double value without a low part is exact.
fn exact(x: f64, n: u32) -> bool {
    let mantissa = x.to_bits() & ((1 << 52) - 1) | u64::from(x >= f64::MIN_POSITIVE) << 52;
    let length = 64 - mantissa.leading_zeros() - mantissa.trailing_zeros();
    length * n <= 53
}

/// `x^y` for `x ≥ 0`, limits at zero and infinity.
fn real_power(x: f64, y: f64) -> Ends {
    if y == 0.0 || x == 1.0 {
        return (1.0, 1.0);
    }
    let grows = (x > 1.0) == (y > 0.0);
    if x == 0.0 || x == f64::INFINITY || y.is_infinite() {
        let value = if grows { f64::INFINITY } else { 0.0 };
        return (value, value);
    }
    if y == 1.0 {
        return (x, x);
    }
    let ln = ln_value(x);
    // Products stay in range so.
    let size = ln.hi * y;
    if size > OUT_OF_RANGE {
        return (f64::MAX, f64::INFINITY);
    }
    if size < -OUT_OF_RANGE {
        return (0.0, f64::from_bits(1));
    }
    if size.abs() < NEXT_TO_ONE {
        return if grows { (1.0, 1.0_f64.next_up()) } else { (1.0_f64.next_down(), 1.0) };
    }
    // |ln x| ≥ 2⁻⁵⁴ here or x = 1, so |y| < 2⁶⁴ and all products stay in range.
    let result = exp_scaled(DoubleDouble::from_f64(y) * ln);
    let (lo, hi) = result.ends(enclose_within(result.value, power_of_two(-58)));
    // 1 is not crossed.
    if grows { (if lo < 1.0 { 1.0 } else { lo }, hi) } else { (lo, if hi > 1.0 { 1.0 } else { hi }) }
}

fn cbrt_at(x: f64) -> Ends {
    if x == 0.0 {
        return (0.0, 0.0);
    }
    if x < 0.0 {
        let (lo, hi) = cbrt_at(-x);
        return (-hi, -lo);
    }
    let Binary { mantissa: m, exponent: e } = Binary::from_f64(x);
    // x = m·2^(3k), 1 ≤ m < 8.
    let k = e.div_euclid(3);
    let m = m * f64::from(1 << e.rem_euclid(3));
    let mut y = 1.0 + (m - 1.0) / 7.0;
    for _ in 0..7 {
        y = (2.0 * y + m / (y * y)) / 3.0;
    }
    // One step of Newton's method in double-double: the error of y is squared.
    let square = DoubleDouble::from_product(y, y);
    let rest = DoubleDouble::from_f64(m) - square * DoubleDouble::from_f64(y);
    // With at most 17 bits, y³ is a double, and so the rest is exact: y is the root.
    if rest.hi == 0.0 && y.to_bits().trailing_zeros() >= 36 {
        return Scaled { value: DoubleDouble::from_f64(y), exponent: k }.ends((y, y));
    }
    let value = DoubleDouble::from_sum(y, rest.hi / (3.0 * square.hi));
    let y = Scaled { value, exponent: k };
    y.ends(enclose(y.value))
}

impl Interval {
    /// `xⁿ`; for n < 0 over x ≠ 0 (empty for `[0, 0]`), and `x⁰ = 1`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let x = Interval::new(-2.0, 3.0);
    /// assert_eq!(x.powi(2).lo(), 0.0);
    /// assert!(x.powi(3).contains(-8.0) && x.powi(3).contains(27.0));
    /// assert!(x.powi(-1).is_entire());
    /// ```
    pub fn powi(self, n: i32) -> Self {
        if self.is_empty() {
            return self;
        }
        let k = n.unsigned_abs();
        if n == 0 {
            return Self::ONE;
        }
        if n == 1 {
            return self;
        }
        let even = k.is_multiple_of(2);
        if n > 0 {
            if even {
                return Self::raw(power_ends(self.mig(), k).0, power_ends(self.mag(), k).1);
            }
            let lo = if self.lo() < 0.0 { -power_ends(-self.lo(), k).1 } else { power_ends(self.lo(), k).0 };
            let hi = if self.hi() < 0.0 { -power_ends(-self.hi(), k).0 } else { power_ends(self.hi(), k).1 };
            return Self::raw(lo, hi);
        }
        if self == Self::ZERO {
            return Self::EMPTY;
        }
        if even {
            return Self::raw(inverse_power_ends(self.mag(), k).0, inverse_power_ends(self.mig(), k).1);
        }
        if self.lo() < 0.0 && self.hi() > 0.0 {
            return Self::ENTIRE;
        }
        if self.hi() <= 0.0 {
            return -((-self).powi(n));
        }
        Self::raw(inverse_power_ends(self.hi(), k).0, inverse_power_ends(self.lo(), k).1)
    }

    /// `x^y` for x > 0, and `0^y = 0` for y > 0 (the domain of IEEE 1788's `pow`).
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let p = Interval::new(2.0, 4.0).pow(Interval::point(0.5));
    /// assert!(p.contains(std::f64::consts::SQRT_2) && p.contains(2.0) && p.width() < 0.6);
    /// assert!(Interval::new(-2.0, -1.0).pow(Interval::ONE).is_empty());
    /// ```
    pub fn pow(self, y: Self) -> Self {
        let x = self.intersection(Self::raw(0.0, f64::INFINITY));
        if x.is_empty() || y.is_empty() {
            return Self::EMPTY;
        }
        if x.hi() == 0.0 {
            return if y.hi() > 0.0 { Self::ZERO } else { Self::EMPTY };
        }
        // Monotone in each argument: the extremes are at the corners.
        let (mut lo, mut hi) = (f64::INFINITY, 0.0);
        for (a, b) in [(x.lo(), y.lo()), (x.lo(), y.hi()), (x.hi(), y.lo()), (x.hi(), y.hi())] {
            let (l, h) = real_power(a, b);
            lo = if l < lo { l } else { lo };
            hi = if h > hi { h } else { hi };
        }
        Self::raw(if lo == f64::INFINITY { f64::MAX } else { lo }, hi)
    }

    /// `∛x`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!(Interval::new(-8.0, 27.0).cbrt().contains(-2.0));
    /// assert_eq!(Interval::point(27.0).cbrt(), Interval::point(3.0));
    /// ```
    pub fn cbrt(self) -> Self {
        increasing(self, cbrt_at, f64::NEG_INFINITY, f64::INFINITY)
    }
}
