//! Rotation vectors, and brakes on rotation.

use d2m_interval::Interval;
use glam::{DMat3, DQuat, DVec3};

/// A brake on the change of a body's spin ([`crate::joint::pull`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pull {
    /// How far the body's oscillation advances in a flight: the square of an angle.
    pub(crate) speed: f64,
    /// Angular impulse divided by change of spin, world axes.
    pub(crate) stiffness: DMat3,
    /// The spin without impulses.
    pub(crate) free: DVec3,
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
