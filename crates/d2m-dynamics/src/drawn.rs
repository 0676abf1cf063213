//! Numbers that tests draw.

use glam::DVec3;

/// The next number in [−1, 1) of Knuth's linear congruential generator.
pub(crate) fn draw(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Each coordinate drawn.
pub(crate) fn vector(state: &mut u64) -> DVec3 {
    DVec3::new(draw(state), draw(state), draw(state))
}
