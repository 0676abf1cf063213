//! Powers of two: scaling by them rounds nothing.

/// 2ⁿ for −1022 ≤ n ≤ 1023.
///
/// ```
/// assert_eq!((d2m_lanes::power_of_two(-2), d2m_lanes::power_of_two(3)), (0.25, 8.0));
/// ```
#[inline(always)]
pub const fn power_of_two(n: i32) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

/// The bits of the exponent.
const EXPONENT: u64 = 0x7ff << 52;

/// The power of two 2ᵏ with |x| in [2ᵏ, 2ᵏ⁺¹), for x not zero; the least normal number for smaller ones.
///
/// ```
/// use d2m_lanes::power_of_two_below;
/// assert_eq!((power_of_two_below(5.0), power_of_two_below(-4.0)), (4.0, 4.0));
/// assert_eq!(power_of_two_below(5e-324), f64::MIN_POSITIVE);
/// ```
#[inline]
pub fn power_of_two_below(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
}

/// The least power of two that is not below a normal positive number; infinite above 2¹⁰²³.
///
/// ```
/// use d2m_lanes::power_of_two_above;
/// assert_eq!((power_of_two_above(5.0), power_of_two_above(4.0)), (8.0, 4.0));
/// ```
#[inline]
pub fn power_of_two_above(x: f64) -> f64 {
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    if power < x { 2.0 * power } else { power }
}
