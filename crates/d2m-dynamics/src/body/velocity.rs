//! The velocity of a body.

use core::ops::{Add, Mul, Neg, Sub};
use glam::DVec3;

/// A velocity of the center of mass and an angular velocity, world axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Velocity {
    pub(crate) linear: DVec3,
    pub(crate) angular: DVec3,
}

impl Velocity {
    /// Of the point at `arm` from the center of mass.
    #[inline]
    pub(crate) fn of_point(self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }

    /// Speed that no point within `radius` of the center of mass exceeds, before rounding.
    pub(crate) fn surface_speed(self, radius: f64) -> f64 {
        self.linear.length() + self.angular.length() * radius
    }
}

impl Add for Velocity {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { linear: self.linear + other.linear, angular: self.angular + other.angular }
    }
}

impl Sub for Velocity {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { linear: self.linear - other.linear, angular: self.angular - other.angular }
    }
}

impl Neg for Velocity {
    type Output = Self;

    fn neg(self) -> Self {
        Self { linear: -self.linear, angular: -self.angular }
    }
}

impl Mul<f64> for Velocity {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self { linear: self.linear * factor, angular: self.angular * factor }
    }
}
