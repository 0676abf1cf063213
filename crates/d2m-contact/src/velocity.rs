//! The velocity of a body.

use core::ops::{Add, Mul, Neg, Sub};
use glam::DVec3;

/// A velocity of the center of mass and an angular velocity, world axes.
///
/// ```
/// use d2m_contact::Velocity;
/// use glam::DVec3;
/// let rolling = Velocity { linear: DVec3::X * 2.0, angular: DVec3::Z * -2.0 };
/// assert_eq!(rolling.of_point(DVec3::NEG_Y), DVec3::ZERO); // where a wheel of radius one stands on the ground
/// assert_eq!(rolling.surface_speed(1.0), 4.0); // and at its top
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// Of the center of mass.
    pub linear: DVec3,
    /// Axis times rate, in radians a unit of time.
    pub angular: DVec3,
}

impl Velocity {
    /// Of the point at `arm` from the center of mass: v + ω × r.
    #[inline]
    #[must_use]
    pub fn of_point(self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }

    /// Speed that no point within `radius` of the center of mass exceeds, before rounding: |v| + |ω| r.
    #[must_use]
    pub fn surface_speed(self, radius: f64) -> f64 {
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
