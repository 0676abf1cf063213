//! Doubles as mantissa and exponent, for formulas whose squares and products may leave the range of doubles.

/// 2ⁿ for −1022 ≤ n ≤ 1023.
pub(crate) const fn power_of_two(n: i32) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

/// `mantissa · 2^exponent` with 1 ≤ |mantissa| < 2; both zero for zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Binary {
    pub(crate) mantissa: f64,
    pub(crate) exponent: i32,
}

impl Binary {
    /// The finite number `x`, exactly, subnormal or not.
    pub(crate) fn of(x: f64) -> Self {
        if x == 0.0 {
            return Self { mantissa: 0.0, exponent: 0 };
        }
        let (x, shift) = if x.abs() < f64::MIN_POSITIVE { (x * power_of_two(64), 64) } else { (x, 0) };
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i32 - 1023 - shift;
        Self { mantissa: f64::from_bits(bits & !(0x7ff << 52) | 1.0_f64.to_bits()), exponent }
    }

    pub(crate) fn is_zero(self) -> bool {
        self.mantissa == 0.0
    }
}

/// `x·2ⁿ` for every n, rounded to nearest once: exact unless it over- or underflows.
pub(crate) fn scaled(mut x: f64, mut n: i32) -> f64 {
    // Steps of the same sign: what is subnormal before the last one vanishes in it.
    while n > 1000 {
        x *= power_of_two(1000);
        n -= 1000;
    }
    while n < -1000 {
        x *= power_of_two(-1000);
        n += 1000;
    }
    x * power_of_two(n)
}
