//! Outward rounding of what is stored in `f32`, and the constants of the node tests.
//!
//! u = 2⁻²⁴ and v = 2⁻⁵³ are the unit roundoffs of `f32` and `f64`. The derivations are in docs/theory/engine.md.

/// v = 2⁻⁵³.
pub(crate) use d2m_lanes::UNIT as UNIT_F64;

/// u = 2⁻²⁴.
pub(crate) const UNIT_F32: f64 = 1.0 / 16_777_216.0;

/// Factor that raises a positive number by more than some 2000 roundings of terms of one sign could have lowered it:
/// 2000·2⁻⁵³ < 2⁻⁴². Bounds that are used once a step, not once an operation, can afford it.
pub(crate) const UP: f64 = 1.0 + 1.0 / 1_099_511_627_776.0; // 1 + 2⁻⁴⁰
/// The same downwards.
pub(crate) const DOWN: f64 = 1.0 - 1.0 / 1_099_511_627_776.0;
/// Factor that covers sixteen roundings to `f32`.
pub(crate) const NARROW_UP: f64 = 1.0 + 16.0 * UNIT_F32;

/// The least `f32` that is not below `value`.
pub(crate) fn round_up(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}
