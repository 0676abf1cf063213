//! The momenta of a body.

use core::ops::{Add, Neg};
use glam::DVec3;

/// A momentum and an angular momentum about the center of mass, world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Momenta {
    pub(crate) linear: DVec3,
    pub(crate) angular: DVec3,
}

impl Momenta {
    /// So many times as much.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { linear: self.linear * factor, angular: self.angular * factor }
    }

    /// Without the part, in the direction of others, that is against these.
    pub(crate) fn without_less_of(self, other: Self) -> Self {
        let part = self.linear.dot(other.linear) / other.linear.length_squared();
        if part < 0.0 { self + other.times(-part) } else { self }
    }

    /// Of an impulse that acts at `arm` from the center of mass.
    pub(crate) fn of_impulse(impulse: DVec3, arm: DVec3) -> Self {
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
