//! How a body moves: linear and angular velocity, as numbers and as enclosures.
use crate::Pose;
use d2m_interval::IntervalVec3;
use glam::DVec3;

/// A twist: the linear velocity of the body point `at` and the angular velocity, both in world axes.
///
/// ```
/// use d2m_motion::Twist;
/// use glam::DVec3;
/// let spin = Twist { linear: DVec3::X, angular: DVec3::Z };
/// assert_eq!(spin.velocity_of(DVec3::X), DVec3::new(1.0, 1.0, 0.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twist {
    /// Velocity of the body point that the pose's translation follows, world axes, length per unit of time.
    pub linear: DVec3,
    /// Angular velocity, world axes, radians per unit of time.
    pub angular: DVec3,
}

impl Twist {
    /// No motion.
    pub const ZERO: Self = Self { linear: DVec3::ZERO, angular: DVec3::ZERO };

    /// The twist whose parts are given in body axes.
    ///
    /// ```
    /// use d2m_motion::{Pose, Twist};
    /// use glam::DVec3;
    /// let pose = Pose::from_axis_angle(DVec3::ZERO, DVec3::Z, std::f64::consts::FRAC_PI_2);
    /// let ahead = Twist::from_body_axes(&pose, DVec3::X, DVec3::Z);
    /// assert!((ahead.linear - DVec3::Y).length() < 1e-15 && (ahead.angular - DVec3::Z).length() < 1e-15);
    /// assert!((ahead.to_body_axes(&pose).linear - DVec3::X).length() < 1e-15);
    /// ```
    pub fn from_body_axes(pose: &Pose, linear: DVec3, angular: DVec3) -> Self {
        Self { linear: pose.transform_vector(linear), angular: pose.transform_vector(angular) }
    }

    /// The same velocities expressed in body axes.
    pub fn to_body_axes(&self, pose: &Pose) -> BodyTwist {
        let back = pose.rotation.conjugate();
        BodyTwist { linear: back * self.linear, angular: back * self.angular }
    }

    /// Velocity of the point at `arm` (world axes) from the reference point: `linear + angular × arm`.
    pub fn velocity_of(&self, arm: DVec3) -> DVec3 {
        self.linear + self.angular.cross(arm)
    }
}

/// The velocities of a [`Twist`] expressed in body axes.
///
/// ```
/// use d2m_motion::{Pose, Twist};
/// use glam::DVec3;
/// // A body that faces along y moves along y: ahead, seen from itself.
/// let pose = Pose::from_axis_angle(DVec3::ZERO, DVec3::Z, std::f64::consts::FRAC_PI_2);
/// let seen = Twist { linear: DVec3::Y, angular: DVec3::ZERO }.to_body_axes(&pose);
/// assert!((seen.linear - DVec3::X).length() < 1e-15 && seen.angular == DVec3::ZERO);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BodyTwist {
    /// Velocity of the reference point, body axes, length per unit of time.
    pub linear: DVec3,
    /// Angular velocity, body axes, radians per unit of time.
    pub angular: DVec3,
}

/// A set of twists (or of twist rates) that contains the true one at every time of some interval.
///
/// ```
/// use d2m_interval::{Interval, IntervalVec3};
/// use d2m_motion::{ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// let spin = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 2.0);
/// let twist = spin.enclose_twist(Interval::UNIT);
/// // A point at (1, 0, 0) from the reference point moves along y by 2 a unit of time.
/// assert!((twist.linear + twist.angular.cross(IntervalVec3::point(DVec3::X))).y.contains(2.0));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IntervalTwist {
    /// Encloses the linear part, world axes.
    pub linear: IntervalVec3,
    /// Encloses the angular part, world axes.
    pub angular: IntervalVec3,
}

impl IntervalTwist {
    /// A set that contains this one and another.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { linear: self.linear.hull(other.linear), angular: self.angular.hull(other.angular) }
    }
}
