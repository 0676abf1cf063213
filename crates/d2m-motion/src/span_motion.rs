//! How a body moves over a span of time: where it is in the middle, and how fast it is at most on either side.
use crate::ball::{Ball, length_up, product_radius, up};
use crate::rounding::UNIT;
use glam::{DMat3, DVec3};

/// The pose of a body in the middle of a span of time, and its velocities over the whole span.
///
/// Promise, for a span with the middle m: at m the true rotation is within `rotation_radius` (operator norm) of `rotation`
/// and the true position of the body frame's origin in the ball `position`. At every time of the span they are within
/// `rotation_spread` and `position_spread` of the same middle values, and velocity and angular velocity are in `linear` and
/// `angular`. The motion is continuous, so that (mean value) at m + τ the origin is at x(m) + τ·v with v in `linear`: what two bodies
/// share of their ways costs nothing, and what is lost is of second order in the length of the span.
///
/// ```
/// use d2m_motion::{Arm, ArmSpan, Joint, JointKind, JointValue};
/// use glam::{DQuat, DVec3};
/// let value = JointValue::try_polynomial(vec![0.0, 2.0])?; // slides by two a unit of time
/// let mut arm = Arm::default();
/// let slide = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, JointKind::Prismatic { axis: DVec3::X, value })?;
/// let link = arm.add("slide", None, slide)?;
/// let mut span = ArmSpan::new(&arm);
/// span.move_to(1.0, 1.5);
/// let seen = span.link(link, None);
/// // In the middle of the span, 1.25, it is at 2.5; at the ends half a unit away from there.
/// assert!((seen.position.center - DVec3::X * 2.5).length() < 1e-15);
/// assert!(seen.position_spread >= 0.5 && seen.position_spread < 0.5 + 1e-12);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct SpanMotion {
    /// Body frame to the frame that it is seen from.
    pub rotation: DMat3,
    /// Bound of the error of `rotation` in the middle of the span.
    pub rotation_radius: f64,
    /// The same at all times of the span.
    pub rotation_spread: f64,
    /// Where the body frame's origin is in the middle of the span.
    pub position: Ball,
    /// Bound of its distance from the center of `position` at all times of the span.
    pub position_spread: f64,
    /// Velocity of the origin at all times of the span.
    pub linear: Ball,
    /// Angular velocity at all times of the span.
    pub angular: Ball,
}

impl SpanMotion {
    /// At rest in the frame that it is seen from.
    pub const REST: Self = Self {
        rotation: DMat3::IDENTITY,
        rotation_radius: 0.0,
        rotation_spread: 0.0,
        position: Ball::ZERO,
        position_spread: 0.0,
        linear: Ball::ZERO,
        angular: Ball::ZERO,
    };

    /// The motion of a body in a frame that itself moves so, over the same span: `outer(t)·inner(t)`.
    ///
    /// With e = R_o x_i: R = R_o R_i, x = x_o + e, v = v_o + ω_o × e + R_o v_i, ω = ω_o + R_o ω_i, with the spreads where something
    /// holds over the whole span. The product of the rotations is that of [`Kinematics::then`](crate::Kinematics::then).
    #[must_use]
    pub fn then(&self, inner: &Self) -> Self {
        let moved = self.carrying(inner);
        if inner.rotation_spread == 0.0 && inner.rotation == DMat3::IDENTITY {
            return moved;
        }
        Self {
            rotation: self.rotation * inner.rotation,
            rotation_radius: product_radius(self.rotation_radius, inner.rotation_radius),
            rotation_spread: product_radius(self.rotation_spread, inner.rotation_spread),
            ..moved
        }
    }

    /// The motion of this body with another body point as its origin.
    #[must_use]
    pub fn following(&self, at: DVec3) -> Self {
        self.carrying(&Self { position: Ball::point(at), ..Self::REST })
    }

    /// Everything but the rotation of `inner`.
    #[inline]
    fn carrying(&self, inner: &Self) -> Self {
        let now = |b: Ball| b.turned(&self.rotation, self.rotation_radius);
        let always = |b: Ball| b.turned(&self.rotation, self.rotation_spread);
        let arm = now(inner.position);
        // The same middle as that of the arm, at all times.
        let swept = always(Ball::new(inner.position.center, inner.position_spread));
        let position = self.position + arm;
        let rounded = UNIT * length_up(position.center);
        Self {
            position,
            position_spread: up(self.position_spread + swept.radius + rounded),
            linear: self.linear + self.angular.cross(swept) + always(inner.linear),
            angular: self.angular + always(inner.angular),
            ..*self
        }
    }
}
