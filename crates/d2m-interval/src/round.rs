//! The one rounding formula. Proofs are in `docs/theory/interval.md`.
//!
//! For a double `x` that is the correctly rounded value of a real number `r`,
//! `up(x) = max(x, −MAX) + (|max(x, −MAX)|·2⁻⁵³(1 + 2⁻⁵²) + 2⁻⁵⁰¹) ≥ r`, evaluated as written in doubles.
//! A lower end point is kept negated, so that both ends round upwards, by the same instructions.
//! Vector paths drop the `max` and check instead that increment and operands are finite; if they are not, they
//! fall back to [`up`] on scalars, which also knows that 0·∞ is 0.
use d2m_lanes::{F64x2, fast_two_sum, power_of_two, two_sum};

/// `2⁻⁵³(1 + 2⁻⁵²)`: half an ulp, and a little.
pub(crate) const HALF_ULP: f64 = f64::from_bits(0x3CA0_0000_0000_0001);
/// `2⁻⁵⁰¹`: absorbs every underflow, and keeps products of such ends out of the subnormal range.
/// (Half of the 2⁻⁵⁰⁰ that results may be too wide by: the other half is for the last place.)
pub(crate) const TINY: f64 = power_of_two(-501);
/// `3·2⁻⁵³(1 + 2⁻⁴⁰)`: a difference of two products (`cross`).
#[cfg(feature = "glam")]
pub(crate) const TWO_PRODUCTS: f64 = f64::from_bits(0x3CB8_0000_0000_1800);
/// `4·2⁻⁵³(1 + 2⁻⁴⁰)`: a sum of three products (`dot`).
#[cfg(feature = "glam")]
pub(crate) const THREE_PRODUCTS: f64 = f64::from_bits(0x3CC0_0000_0000_1000);

/// A number not below any real number whose correctly rounded value is `x`; NaN gives NaN.
#[inline(always)]
pub(crate) fn up(x: f64) -> f64 {
    let x = if -f64::MAX > x { -f64::MAX } else { x };
    x + (x.abs() * HALF_ULP + TINY)
}

/// The mirror image of [`up`].
#[inline(always)]
pub(crate) fn down(x: f64) -> f64 {
    -up(-x)
}

/// What [`up`] adds to both numbers.
#[inline(always)]
pub(crate) fn increment(x: F64x2) -> F64x2 {
    x.abs() * F64x2::splat(HALF_ULP) + F64x2::splat(TINY)
}

/// Whether no number is NaN or +∞ (increments are never negative).
#[inline(always)]
pub(crate) fn finite(increment: F64x2) -> bool {
    increment.lt(F64x2::splat(f64::INFINITY)).sign_bits() == 3
}

/// [`finite`], and no operand of a product has an infinite end: `largest` is the maximum of the operands.
/// (The maximum of four products may hide the NaN that 0·∞ gives; it cannot hide it where an operand is empty,
/// because then every product is infinite or NaN.)
#[inline(always)]
pub(crate) fn finite_with(largest: F64x2, increment: F64x2) -> bool {
    // `max` returns its second operand when one is NaN.
    finite(largest.max(increment))
}

/// Whether `a − b < c − d`, exactly, for finite numbers with a ≥ b and c ≥ d.
pub(crate) fn difference_is_less(a: f64, b: f64, c: f64, d: f64) -> bool {
    if a - b == f64::INFINITY && c - d == f64::INFINITY {
        // a, c > 0 > b, d: then a − c and b − d do not overflow.
        return exact_difference(a, c) < exact_difference(b, d);
    }
    // At most one overflows, and is the larger one.
    exact_difference(a, b) < exact_difference(c, d)
}

/// `a − b` as its rounded value and the rest, which compare like the exact differences; (∞, 0) when it overflows.
fn exact_difference(a: f64, b: f64) -> (f64, f64) {
    // Dekker's sum of the larger and the smaller one cannot overflow after its first step.
    let (s, e) = if a.abs() >= b.abs() { fast_two_sum(a, -b) } else { fast_two_sum(-b, a) };
    if s.is_infinite() { (s, 0.0) } else { (s, e) }
}

/// `a − b` rounded upwards as IEEE 754 would: the least double that is not below it.
pub(crate) fn difference_up(a: f64, b: f64) -> f64 {
    let (s, e) = two_sum(a, -b);
    if s.is_infinite() || s.is_nan() {
        return if s == f64::NEG_INFINITY { -f64::MAX } else { s };
    }
    if e > 0.0 { s.next_up() } else { s }
}
