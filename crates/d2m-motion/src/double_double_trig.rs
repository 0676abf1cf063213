//! Sine and cosine in double-double arithmetic, for poses at an epoch and for far reference points.

use d2m_lanes::DoubleDouble;

/// π/2 to 2⁻¹⁰⁷.
const HALF_PI: DoubleDouble = DoubleDouble::new(core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);
/// What [`HALF_PI`] leaves out.
const HALF_PI_TAIL: f64 = -1.497_384_904_859_17e-33;

/// Reduction by multiples of π/2 (2⁻¹⁶⁰ left out), then 27 Taylor terms in double-double.
/// Absolute error below 2⁻⁹⁸ + |x|·2⁻¹⁰⁵ for |x| < 2³⁰.
pub(crate) fn sin_cos_double(x: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let turns = (x.hi / HALF_PI.hi).round();
    let r = (x - HALF_PI * turns).add_f64(-turns * HALF_PI_TAIL);
    let square = -(r * r);
    let (mut sin, mut cos) = (r, DoubleDouble::ONE);
    let (mut odd, mut even) = (r, DoubleDouble::ONE);
    let mut k = 1.0;
    while k < 28.0 {
        even = (even * square).div_accurately(DoubleDouble::from_f64(k * (k + 1.0)));
        odd = (odd * square).div_accurately(DoubleDouble::from_f64((k + 1.0) * (k + 2.0)));
        cos = cos + even;
        sin = sin + odd;
        k += 2.0;
    }
    match turns.rem_euclid(4.0) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}
