//! Cross products whose direction is right also for nearly parallel factors.
use d2m_lanes::{two_product, two_sum};
use glam::DVec3;

/// A difference of two vectors without error: `high + low`, component by component.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Difference {
    high: DVec3,
    low: DVec3,
}

impl Difference {
    /// `p − q`.
    pub(crate) fn new(p: DVec3, q: DVec3) -> Self {
        let [(x, dx), (y, dy), (z, dz)] = [two_sum(p.x, -q.x), two_sum(p.y, -q.y), two_sum(p.z, -q.z)];
        Self { high: DVec3::new(x, y, z), low: DVec3::new(dx, dy, dz) }
    }
}

impl From<DVec3> for Difference {
    fn from(high: DVec3) -> Self {
        Self { high, low: DVec3::ZERO }
    }
}

/// `a × b` within 2⁻⁵² of itself and 2⁻¹⁰² of |a||b|, component by component: its direction is right to some 2⁻⁵⁰ for angles
/// down to 2⁻⁵⁰. Plain arithmetic loses 2⁻⁵³ of |a||b|: half of the digits at an angle of 2⁻²⁶.
///
/// The products of the high parts are exact; what their difference loses, the errors of the products and the products with
/// the low parts (rounded: 2⁻⁵³ of 2⁻⁵³) are added at the end. For components between 2⁻⁴⁰⁰ and 2⁴⁰⁰.
pub(crate) fn accurate_cross(a: Difference, b: Difference) -> DVec3 {
    let minor = |i: usize, j: usize| {
        let ((p, p_error), (q, q_error)) =
            (two_product(a.high[i], b.high[j]), two_product(a.high[j], b.high[i]));
        let (difference, lost) = two_sum(p, -q);
        let low =
            (a.high[i] * b.low[j] + a.low[i] * b.high[j]) - (a.high[j] * b.low[i] + a.low[j] * b.high[i]);
        difference + (lost + ((p_error - q_error) + low))
    };
    DVec3::new(minor(1, 2), minor(2, 0), minor(0, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearly_parallel_vectors_have_an_exact_normal() {
        for angle in [1e-3, 1e-8, 1e-12, 1e-15] {
            let (p, q) = (DVec3::new(0.1, 0.7, -0.3), DVec3::new(-0.9, 0.2, 0.4));
            let a = Difference::new(p, q);
            let b = Difference::from((p - q) * 1.3 + DVec3::new(0.5, -0.25, 1.0) * angle);
            let n = accurate_cross(a, b).normalize();
            let along = |v: &Difference| (n.dot(v.high) + n.dot(v.low)).abs();
            assert!(along(&a) < 6e-16 && along(&b) < 6e-16, "{angle}: {:e} {:e}", along(&a), along(&b));
        }
    }
}
