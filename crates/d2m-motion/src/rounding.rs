//! Constants of the error counts, each with where it comes from.
pub(crate) use d2m_lanes::{UNIT, UP};

/// 1 + 2⁻⁴⁶: more than ten times what the roundings of a remainder's bound, or of a sum and a product of non-negative
/// numbers, add up to.
pub(crate) const SUM_ROUNDING: f64 = 1.0 + 64.0 * f64::EPSILON;

/// More than what squares that underflow take from a length: below 2⁻⁵³⁷, the root of the least double.
pub(crate) const UNDERFLOW: f64 = 1e-150;
