//! Sine and cosine with the same bits on every platform and in every version, so that shapes never change.

use glam::DVec2;
use std::f64::consts::{FRAC_2_PI, TAU};

/// π/2 in two parts; the first has 33 bits, so small multiples of it are exact.
const QUARTER_HIGH: f64 = f64::from_bits(0x3ff9_21fb_5440_0000);
const QUARTER_LOW: f64 = f64::from_bits(0x3dd0_b461_1a62_6331);

/// (cos, sin) of an angle in radians, |angle| below a million, to about 2 units of rounding: Taylor's series after
/// taking off quarter turns. Additions, multiplications and a rounding only.
pub(crate) fn cos_sin(angle: f64) -> DVec2 {
    let quarters = (angle * FRAC_2_PI).round();
    let rest = (angle - quarters * QUARTER_HIGH) - quarters * QUARTER_LOW;
    let square = rest * rest;
    // |rest| ≤ π/4: the terms left out are below 2⁻⁶⁰.
    let (mut sin, mut cos) = (1.0, 1.0);
    for term in (1..=9).rev() {
        let even = f64::from(2 * term);
        sin = 1.0 - square * sin / (even * (even + 1.0));
        cos = 1.0 - square * cos / ((even - 1.0) * even);
    }
    let sin = rest * sin;
    match quarters.rem_euclid(4.0) as u8 {
        0 => DVec2::new(cos, sin),
        1 => DVec2::new(-sin, cos),
        2 => DVec2::new(-cos, -sin),
        _ => DVec2::new(sin, -cos),
    }
}

/// The point of the unit circle at `index` of `count` equal steps.
pub(crate) fn on_circle(index: usize, count: usize) -> DVec2 {
    cos_sin(TAU * (index % count) as f64 / count as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_platform() {
        for step in -20_000..20_000 {
            let angle = f64::from(step) * 0.003_7;
            let difference = cos_sin(angle) - DVec2::new(angle.cos(), angle.sin());
            assert!(difference.abs().max_element() < 4e-16, "{angle}: {difference}");
        }
        assert_eq!(on_circle(0, 4), DVec2::X);
    }
}
