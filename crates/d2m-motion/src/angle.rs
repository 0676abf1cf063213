//! The angle of a point about an axis, in doubles, with a proven error.
//!
//! atan(s/l) = atan c + atan r with r = (s − c l)/(l + c s), for the nearest c of 0, 1/8 … 1 to s/l ≤ 1: |r| ≤ 1/16 and a few roundings, so
//! the terms of the series from r¹⁵/15 on are below 2⁻⁶³.

use std::f64::consts::{FRAC_PI_2, PI};

/// atan(k/8), rounded to the nearest double.
const EIGHTHS: [f64; 9] = [
    0.0,
    f64::from_bits(0x3FBF_D5BA_9AAC_2F6E),
    f64::from_bits(0x3FCF_5B75_F92C_80DD),
    f64::from_bits(0x3FD6_F619_41E4_DEF1),
    f64::from_bits(0x3FDD_AC67_0561_BB4F),
    f64::from_bits(0x3FE1_E00B_ABDE_FEB4),
    f64::from_bits(0x3FE4_978F_A326_9EE1),
    f64::from_bits(0x3FE7_00A7_C578_4634),
    f64::from_bits(0x3FE9_21FB_5444_2D18),
];

/// arctan(y/x) in its quadrant; wrong by less than 8·2⁻⁵³. Zero for a point on the axis.
///
/// The roundings are counted in docs/theory/engine.md, "Screws". A quotient that underflows errs by less than any of them.
///
/// ```
/// use core::f64::consts::FRAC_PI_4;
/// assert!((d2m_motion::angle(-3.0, 3.0) + FRAC_PI_4).abs() < 1e-15);
/// ```
pub fn angle(y: f64, x: f64) -> f64 {
    let (wide, high) = (x.abs(), y.abs());
    let steep = high > wide;
    let (small, large) = if steep { (wide, high) } else { (high, wide) };
    if large == 0.0 {
        return 0.0;
    }
    let eighth = (8.0 * (small / large) + 0.5) as usize;
    let c = eighth as f64 * 0.125;
    let r = (small - c * large) / (large + c * small);
    let square = r * r;
    let series = [1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0];
    let sum = series.iter().fold(1.0 / 13.0, |sum, coefficient| coefficient - square * sum);
    let acute = EIGHTHS[eighth] + (r - r * square * sum);
    let acute = if steep { FRAC_PI_2 - acute } else { acute };
    let angle = if x < 0.0 { PI - acute } else { acute };
    if y < 0.0 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_interval::Interval;
    use d2m_lanes::UNIT as UNIT_F64;
    use d2m_testing::{Draw, KnuthRandom};

    /// Against the enclosures of the interval library, in all octants and next to their borders.
    #[test]
    fn angles_err_by_eight_units() {
        let mut random = KnuthRandom(3);
        let mut worst: f64 = 0.0;
        for round in 0..200_000 {
            let (mut y, mut x) = (random.signed(), random.signed());
            match round % 5 {
                0 => y *= 1e-9,
                1 => x *= 1e-9,
                2 => y = x.abs() * f64::from(round % 17) * 0.0625 * (1.0 + 1e-15 * random.signed()),
                _ => {}
            }
            let (found, exact) = (angle(y, x), Interval::point(y).atan2(Interval::point(x)));
            worst = worst.max(exact.lo() - found).max(found - exact.hi());
        }
        assert!((1.0 * UNIT_F64..8.0 * UNIT_F64).contains(&worst), "{}", worst / UNIT_F64);
        assert_eq!([angle(0.0, 0.0), angle(1.0, 0.0), angle(0.0, -2.0)], [0.0, FRAC_PI_2, PI]);
        assert_eq!([angle(f64::MIN_POSITIVE, 1.0), angle(-1e-300, 1e300)], [f64::MIN_POSITIVE, 0.0]);
    }
}
