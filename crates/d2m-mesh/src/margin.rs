//! Outward rounding of what is stored in `f32`, and the constants of the node tests.
//!
//! u = 2⁻²⁴ and v = 2⁻⁵³ are the unit roundoffs of `f32` and `f64`. The derivations are in docs/theory/engine.md.

/// v = 2⁻⁵³.
pub use d2m_lanes::UNIT as UNIT_F64;
#[doc(no_inline)]
pub use d2m_motion::{direction, length};

/// u = 2⁻²⁴.
pub const UNIT_F32: f64 = 1.0 / 16_777_216.0;

/// Factor that raises a positive number by more than some 2000 roundings of terms of one sign could have lowered it:
/// 2000·2⁻⁵³ < 2⁻⁴². Bounds that are used once a step, not once an operation, can afford it.
pub const UP: f64 = 1.0 + 1.0 / 1_099_511_627_776.0; // 1 + 2⁻⁴⁰
/// The same downwards.
pub const DOWN: f64 = 1.0 - 1.0 / 1_099_511_627_776.0;
/// Factor that covers sixteen roundings to `f32`.
pub const NARROW_UP: f64 = 1.0 + 16.0 * UNIT_F32;

/// Two radii: not more and not less than their sum, which is exact where one of them is zero.
#[inline]
pub fn sum_of_radii([a, b]: [f64; 2]) -> [f64; 2] {
    let sum = a + b;
    if a == 0.0 || b == 0.0 { [sum; 2] } else { [sum.next_down(), sum.next_up()] }
}

/// The least `f32` that is not below `value`.
#[inline]
pub fn round_up(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value { rounded.next_up() } else { rounded }
}

/// Sums of a few products of cosines, bytes and sizes that are not above 2¹²⁸ over this are finite: at most three of 126 times
/// a size, and as much again.
const ROOM_BELOW_OVERFLOW: f32 = 1024.0;

/// The product of an error's factor and the size that it is a part of: infinite where sums of such sizes may overflow, so that
/// nothing is proven from them. The bits of `factor * size` otherwise.
#[inline(always)]
pub fn error_of(factor: f32, size: f32) -> f32 {
    (factor * (1.0 / ROOM_BELOW_OVERFLOW)) * (size * ROOM_BELOW_OVERFLOW)
}

#[cfg(test)]
mod tests {
    use super::{ROOM_BELOW_OVERFLOW, UNIT_F32, error_of};

    #[test]
    fn errors_are_infinite_where_sums_of_sizes_may_overflow() {
        let factor = 48.0 * UNIT_F32 as f32;
        for power in -80..118 {
            let size = 1.7 * f64::from(power).exp2() as f32;
            assert_eq!(error_of(factor, size).to_bits(), (factor * size).to_bits());
        }
        for size in [f32::MAX / ROOM_BELOW_OVERFLOW * 1.001, 1e36, f32::MAX, f32::INFINITY] {
            assert!((size * 126.0 * 3.0).is_finite() || error_of(factor, size) == f32::INFINITY);
            assert_eq!(error_of(factor, size), f32::INFINITY);
        }
        assert!((f32::MAX / ROOM_BELOW_OVERFLOW * (3.0 * 126.0)).is_finite());
        assert!(error_of(factor, f32::NAN).is_nan());
    }
}
