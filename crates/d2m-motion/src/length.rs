//! Lengths in any unit.

use glam::DVec3;

/// |v| within 8·2⁻⁵³ of itself, and less than the smallest normal number beside that, in any unit: squares of components that are divided
/// by the largest one are not lost to underflow, nor do they overflow. Zero only for zero.
///
/// ```
/// use glam::DVec3;
/// let tiny = DVec3::new(2e-200, -3e-200, 6e-200);
/// assert!((d2m_motion::length(tiny) / 7e-200 - 1.0).abs() < 1e-15 && tiny.length() == 0.0);
/// ```
#[inline]
pub fn length(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    // What is zero, infinite or no number is its own length.
    let is_divisor = largest > 0.0 && largest < f64::INFINITY;
    if is_divisor { largest * (v / largest).length() } else { largest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_keep_their_digits_in_any_unit() {
        for exponent in -1010..1020 {
            let unit = 2f64.powi(exponent);
            let v = DVec3::new(2.0, -3.0, 6.0) * unit;
            assert!((length(v) / unit - 7.0).abs() < 1e-14, "{exponent}");
        }
        assert_eq!(length(DVec3::ZERO), 0.0);
        assert_eq!(length(DVec3::INFINITY), f64::INFINITY);
        assert!(length(DVec3::new(1.0, f64::NAN, 2.0)).is_nan());
    }
}
