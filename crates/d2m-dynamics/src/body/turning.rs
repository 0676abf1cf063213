//! Turns, moments of inertia, and what brakes turning.

use d2m_interval::Interval;
use glam::{DMat3, DQuat, DVec3};

/// What brakes the change of a body's spin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pull {
    /// How far its oscillation leads in a flight: the square of an angle.
    pub(crate) speed: f64,
    /// The angular impulse by change of spin, world axes.
    pub(crate) stiffness: DMat3,
    /// The spin without impulses.
    pub(crate) free: DVec3,
}

/// The least and the greatest eigenvalue of a symmetric matrix, by the roots of its characteristic polynomial (Smith 1961).
pub(crate) fn extreme_eigenvalues(m: DMat3) -> [f64; 2] {
    let mean = (m.x_axis.x + m.y_axis.y + m.z_axis.z) / 3.0;
    let rest = m - DMat3::from_diagonal(DVec3::splat(mean));
    let square: f64 = rest.to_cols_array().iter().map(|x| x * x).sum();
    let size = (square / 6.0).sqrt();
    // Rounding of the elements of a sphere's.
    if size.is_nan() || size <= 1e-12 * mean {
        return [mean, mean];
    }
    let half = (0.5 * (rest * (1.0 / size)).determinant()).clamp(-1.0, 1.0);
    let third = Interval::point((1.0 - half * half).max(0.0).sqrt()).atan2(Interval::point(half)).mid() / 3.0;
    let cos = |x: f64| Interval::point(x).cos().mid();
    let most = mean + 2.0 * size * cos(third);
    let least = mean + 2.0 * size * cos(third + 2.0 * core::f64::consts::FRAC_PI_3);
    [least.max(0.0), most]
}

/// Axis times angle in [0, π] of a rotation, world axes; the same bits on every platform.
pub(crate) fn rotation_vector(q: DQuat) -> DVec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let axis = DVec3::new(q.x, q.y, q.z);
    let sine = axis.length();
    if sine == 0.0 {
        return DVec3::ZERO;
    }
    let half = Interval::point(sine).atan2(Interval::point(q.w)).mid();
    axis * (2.0 * half / sine)
}
