//! Sine and cosine with the same bits on every platform.

use d2m_interval::Interval;
use glam::DVec2;
use std::f64::consts::TAU;

/// (cos, sin) of an angle in radians, to about 4 units of rounding: the middle of the project's interval enclosure.
pub(crate) fn cos_sin(angle: f64) -> DVec2 {
    let (sin, cos) = Interval::point(angle).sin_cos();
    DVec2::new(cos.mid(), sin.mid())
}

/// The point of the unit circle at `index` of `count` equal steps.
pub(crate) fn on_circle(index: usize, count: usize) -> DVec2 {
    cos_sin(TAU * (index % count) as f64 / count as f64)
}
