//! Constants of the error counts, each with where it comes from.
use d2m_lanes::power_of_two;
pub(crate) use d2m_lanes::{UNIT, UP};
use glam::DVec3;

/// [`UP`] from below: at most 1 − 9.9e-15, so a product with it stays below the true value after 64 roundings.
pub(crate) const DOWN: f64 = 2.0 - UP;

/// 2⁻⁵⁰⁰: more than what a length loses to squares that underflow. Each of three squares loses at most 2⁻¹⁰⁷⁴, so the root
/// loses at most √3·2⁻⁵³⁷. In the units of a query ([`Units`](crate::units::Units)) features are at least 2⁻²⁰⁰, so this is
/// below 2⁻²⁰⁰ of every error bound.
pub(crate) const UNDERFLOW: f64 = power_of_two(-500);

/// Upper bound of the length of a computed vector.
#[inline(always)]
pub(crate) fn length_up(v: DVec3) -> f64 {
    v.length() * UP + UNDERFLOW
}

/// Distance, as a part of the features' size, below which the difference of the closest points is no good direction:
/// rounding of 2⁻⁵³ in positions turns it by 2⁻³³ there, and by more where it is smaller. The normal and the normals of the
/// sides are tried as well then. (Any direction is sound.)
pub(crate) const CLOSE: f64 = 1e-6;

/// 2⁻¹⁰⁰⁰: more than sums of fewer than 2²⁰ products lose to underflow, where all factors are at most 2¹⁶: 2⁻¹⁰⁷⁴ each, times
/// the factors that follow.
pub(crate) const PRODUCT_UNDERFLOW: f64 = power_of_two(-1000);

/// Part of the way over half a piece that counts as size where the features are small or far: a remainder of a quarter of
/// it still separates them. (Tuned; any value is sound.)
pub(crate) const PART_OF_WAY: f64 = 0.25;
