//! Lengths in any unit.

use d2m_lanes::power_of_two;
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

/// The unit vector along v, to rounding, in any unit; zero of what has no direction: of zero, of what is infinite or no number.
///
/// ```
/// use glam::DVec3;
/// let tiny = DVec3::new(2e-200, -3e-200, 6e-200);
/// assert!((d2m_motion::direction(tiny) - DVec3::new(2.0, -3.0, 6.0) / 7.0).length() < 1e-15);
/// assert_eq!((tiny.normalize_or_zero(), d2m_motion::direction(DVec3::ZERO)), (DVec3::ZERO, DVec3::ZERO));
/// ```
#[inline]
pub fn direction(v: DVec3) -> DVec3 {
    let largest = v.abs().max_element();
    // Squares between these keep their digits.
    let is_plain = (power_of_two(-500)..power_of_two(500)).contains(&largest);
    if is_plain { v.normalize_or_zero() } else { (v / largest).normalize_or_zero() }
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

    #[test]
    fn directions_keep_their_digits_in_any_unit() {
        let v = DVec3::new(2.0, -3.0, 6.0);
        for exponent in -1010..1020 {
            assert!((direction(v * 2f64.powi(exponent)) - v / 7.0).length() < 1e-15, "{exponent}");
        }
        for nowhere in [
            DVec3::ZERO,
            DVec3::INFINITY,
            DVec3::new(1.0, f64::NAN, 2.0),
            DVec3::new(f64::INFINITY, 1.0, 0.0),
        ] {
            assert_eq!(direction(nowhere), DVec3::ZERO, "{nowhere}");
        }
    }
}
