//! Moments of inertia.

use d2m_interval::Interval;
use glam::{DMat3, DVec3};

/// Eigenvalues are mean + 2 s cos φ with the size s of what is left without the mean. Below this part of the mean s is rounding (fewer than 2¹²
/// operations of 2⁻⁵³ each made the matrix), which has no direction: the mean stands for all three, off by 2 s at most.
const ROUND: f64 = 1e-12;

/// The least and the greatest eigenvalue of a symmetric matrix, by the roots of its characteristic polynomial (Smith 1961,
/// [doi:10.1145/355578.366316](https://doi.org/10.1145/355578.366316)), to 2e-12 of their mean, and no less than zero; the same bits
/// on every platform. In the units of the matrix.
///
/// ```
/// use glam::{DMat3, DVec3};
/// let [least, most] = d2m_contact::extreme_eigenvalues(DMat3::from_diagonal(DVec3::new(2.0, 1.0, 5.0)));
/// assert!((least - 1.0).abs() < 1e-14 && (most - 5.0).abs() < 1e-14);
/// ```
#[must_use]
pub fn extreme_eigenvalues(m: DMat3) -> [f64; 2] {
    let mean = (m.x_axis.x + m.y_axis.y + m.z_axis.z) / 3.0;
    let rest = m - DMat3::from_diagonal(DVec3::splat(mean));
    let square: f64 = rest.to_cols_array().iter().map(|x| x * x).sum();
    let size = (square / 6.0).sqrt();
    if size.is_nan() || size <= ROUND * mean {
        return [mean, mean];
    }
    let half = (0.5 * (rest * (1.0 / size)).determinant()).clamp(-1.0, 1.0);
    let third = Interval::point((1.0 - half * half).max(0.0).sqrt()).atan2(Interval::point(half)).mid() / 3.0;
    let cos = |x: f64| Interval::point(x).cos().mid();
    let most = mean + 2.0 * size * cos(third);
    let least = mean + 2.0 * size * cos(third + 2.0 * core::f64::consts::FRAC_PI_3);
    [least.max(0.0), most]
}
