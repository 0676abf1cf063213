//! What rounding to nearest costs.

/// Unit roundoff of `f64`, 2⁻⁵³: a rounded result is (1 + δ) times the exact one, |δ| ≤ `UNIT`, unless it underflows or
/// overflows.
pub const UNIT: f64 = 0.5 * f64::EPSILON;

/// Covers the rounding of a bound that is made of fewer than 64 operations on non-negative numbers: (1 + 2⁻⁵³)⁶⁴ is below
/// 1 + 7.2e-15, and the product with this factor adds one more rounding.
pub const UP: f64 = 1.0 + 1e-14;
