//! The one rounding formula.

/// Half an ulp, relative, with one part in 2⁵² to spare.
pub(crate) const HALF_ULP: f64 = f64::from_bits(0x3CA0_0000_0000_0001);
/// 2⁻⁵⁰⁰: absorbs every underflow.
pub(crate) const TINY: f64 = f64::from_bits((1023 - 500) << 52);

/// A number not below any real number whose correctly rounded value is `x`.
#[inline(always)]
pub(crate) fn up(x: f64) -> f64 {
    let clamped = if -f64::MAX > x { -f64::MAX } else { x };
    clamped + (clamped.abs() * HALF_ULP + TINY)
}

/// The mirror image of [`up`].
#[inline(always)]
pub(crate) fn down(x: f64) -> f64 {
    -up(-x)
}
