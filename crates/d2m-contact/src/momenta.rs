//! The momenta of a body.

use core::ops::{Add, Neg};
use glam::DVec3;

/// A momentum and an angular momentum about the center of mass, world axes.
///
/// ```
/// use d2m_contact::Momenta;
/// use glam::DVec3;
/// let pushed = Momenta::of_impulse(DVec3::Y * 3.0, DVec3::X * 0.5);
/// assert_eq!((pushed.linear, pushed.angular), (DVec3::Y * 3.0, DVec3::Z * 1.5));
/// assert_eq!(pushed.times(2.0) + -pushed, pushed);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Momenta {
    /// Mass times velocity.
    pub linear: DVec3,
    /// Inertia times angular velocity.
    pub angular: DVec3,
}

impl Momenta {
    /// So many times as much.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { linear: self.linear * factor, angular: self.angular * factor }
    }

    /// Without the part, in the direction of others, that is against these.
    #[must_use]
    pub fn without_less_of(self, other: Self) -> Self {
        let part = self.linear.dot(other.linear) / other.linear.length_squared();
        if part < 0.0 { self + other.times(-part) } else { self }
    }

    /// Of an impulse J that acts at `arm` r from the center of mass: J and r × J.
    #[must_use]
    pub fn of_impulse(impulse: DVec3, arm: DVec3) -> Self {
        Self { linear: impulse, angular: arm.cross(impulse) }
    }
}

impl Add for Momenta {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { linear: self.linear + other.linear, angular: self.angular + other.angular }
    }
}

impl Neg for Momenta {
    type Output = Self;

    fn neg(self) -> Self {
        Self { linear: -self.linear, angular: -self.angular }
    }
}
