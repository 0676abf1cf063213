//! Doubles as mantissa and exponent, for formulas whose squares and products may leave the range of doubles.
use crate::power_of_two;

/// `mantissa · 2^exponent` with 1 ≤ |mantissa| < 2; both zero for zero.
///
/// ```
/// use d2m_lanes::Binary;
/// assert_eq!(Binary::from_f64(-6.0), Binary { mantissa: -1.5, exponent: 2 });
/// assert_eq!(Binary::from_f64(5e-324), Binary { mantissa: 1.0, exponent: -1074 });
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Binary {
    /// The digits, with the sign.
    pub mantissa: f64,
    /// The power of two.
    pub exponent: i32,
}

impl Binary {
    /// The finite number `x`, exactly, subnormal or not.
    pub fn from_f64(x: f64) -> Self {
        if x == 0.0 {
            return Self { mantissa: 0.0, exponent: 0 };
        }
        let (x, shift) = if x.abs() < f64::MIN_POSITIVE { (x * power_of_two(64), 64) } else { (x, 0) };
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as i32 - 1023 - shift;
        Self { mantissa: f64::from_bits(bits & !(0x7ff << 52) | 1.0_f64.to_bits()), exponent }
    }

    /// Whether it is zero.
    pub fn is_zero(self) -> bool {
        self.mantissa == 0.0
    }
}

/// `x·2ⁿ` for every n, rounded to nearest once: exact unless it over- or underflows.
///
/// ```
/// assert_eq!(d2m_lanes::scaled(3.0, -1074), 1.5e-323);
/// ```
pub fn scaled(mut x: f64, mut n: i32) -> f64 {
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
