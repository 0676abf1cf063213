//! Constants of the error counts, each with where it comes from.

/// Unit roundoff of f64, 2⁻⁵³.
pub(crate) const UNIT: f64 = 0.5 * f64::EPSILON;

/// Covers the rounding of a bound that is made of fewer than 64 operations on non-negative numbers: (1 + 2⁻⁵³)⁶⁴ is below
/// 1 + 7.2e-15, and the product with this factor adds one more rounding.
pub(crate) const UP: f64 = 1.0 + 1e-14;

/// 1 + 2⁻⁴⁶: more than ten times what the roundings of a remainder's bound, or of a sum and a product of non-negative
/// numbers, add up to.
pub(crate) const SUM_ROUNDING: f64 = 1.0 + 64.0 * f64::EPSILON;

/// More than what squares that underflow take from a length: below 2⁻⁵³⁷, the root of the least double.
pub(crate) const UNDERFLOW: f64 = 1e-150;
