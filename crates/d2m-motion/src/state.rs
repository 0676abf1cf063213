//! Where a body is and how it moves at one time: plain numbers, each with a proven distance from the truth.
use crate::rotation::from_quat_rounded;
use crate::rounding::{UNDERFLOW, UNIT, UP};
use crate::{Ball, ConstantTwist, IntervalPose, IntervalTwist, Kinematics};
use glam::{DMat3, DQuat, DVec3};

/// Pose and twist at one time as middle values with radii: what jets of any motion are made of.
///
/// Promise: the true rotation differs from `rotation` by a matrix of operator norm at most `rotation_radius`, and the
/// true vectors lie within their radii of `position`, `linear` and `angular`. (One number a vector: the arithmetic on
/// top is plain floating point with one bound, instead of intervals in every coordinate.) A radius of infinity says
/// that nothing is known.
///
/// ```
/// use d2m_motion::{CertifiedState, ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// let motion = ConstantTwist::REST.with_angular_velocity(3.0 * DVec3::Z).with_linear_velocity(DVec3::X);
/// let state = motion.enclose_state(0.5);
/// assert!((state.rotation * DVec3::X - DVec3::new(1.5_f64.cos(), 1.5_f64.sin(), 0.0)).length() < 1e-13);
/// assert!(state.rotation_radius < 1e-13 && state.linear == DVec3::X && state.linear_radius == 0.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CertifiedState {
    /// Body frame to world frame; orthogonal up to the radius.
    pub rotation: DMat3,
    /// World position of the body point [`CertifiedState::at`].
    pub position: DVec3,
    /// The reference point (body frame, exact).
    pub at: DVec3,
    /// Velocity of the reference point, world axes.
    pub linear: DVec3,
    /// Angular velocity, world axes.
    pub angular: DVec3,
    /// Bound of the operator norm of the error of `rotation`.
    pub rotation_radius: f64,
    /// Bound of the error of `position` (length).
    pub position_radius: f64,
    /// Bound of the error of `linear` (length per time).
    pub linear_radius: f64,
    /// Bound of the error of `angular` (radians per time).
    pub angular_radius: f64,
}

/// A motion of constant twist through the middle of a [`CertifiedState`].
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_motion::{CertifiedState, ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// let flying = ConstantTwist::REST.with_linear_velocity(DVec3::X);
/// let now = Interval::point(2.0);
/// let state = CertifiedState::from_enclosures(&flying.enclose_pose(now), &flying.enclose_twist(now));
/// let through = state.to_constant_twist(2.0).expect("it is finite");
/// assert!((through.motion.position() - DVec3::X * 2.0).length() < 1e-12 && through.motion.reference_time() == 2.0);
/// assert!(through.rotation_radius < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct StateTwist {
    /// The motion.
    pub motion: ConstantTwist,
    /// Bound on the operator norm of the difference between its rotation at the time of the state and the true one.
    pub rotation_radius: f64,
}

impl CertifiedState {
    /// The middles of enclosures at one time, with radii that reach their corners.
    ///
    /// The rotation's radius is the Frobenius norm of the half-widths. Unbounded enclosures give infinite radii.
    pub fn from_enclosures(pose: &IntervalPose, twist: &IntervalTwist) -> Self {
        let [row0, row1, row2] = pose.rotation.rows();
        let rows = [row0, row1, row2].map(Ball::around_box);
        let [r0, r1, r2] = rows.map(|row| row.radius * row.radius);
        let position = Ball::around_box(pose.translation);
        let (linear, angular) = (Ball::around_box(twist.linear), Ball::around_box(twist.angular));
        Self {
            rotation: DMat3::from_cols(rows[0].center, rows[1].center, rows[2].center).transpose(),
            position: position.center,
            at: pose.at,
            linear: linear.center,
            angular: angular.center,
            rotation_radius: (r0 + r1 + r2).sqrt() * UP + UNDERFLOW,
            position_radius: position.radius,
            linear_radius: linear.radius,
            angular_radius: angular.radius,
        }
    }

    /// The same state expressed by another body point.
    #[must_use]
    pub fn following(&self, at: DVec3) -> Self {
        Kinematics::from_state(self).following(at).state_about(DVec3::ZERO)
    }

    /// The same state with lengths times `factor`, a power of two: see [`Kinematics::in_unit_of_length`].
    ///
    /// ```
    /// use d2m_motion::{ConstantTwist, RigidMotion};
    /// use glam::DVec3;
    /// let moving = ConstantTwist::REST.with_position(DVec3::X).with_linear_velocity(DVec3::Y);
    /// let half = moving.enclose_state(0.0).in_unit_of_length(0.5);
    /// assert!((half.position - DVec3::X * 0.5).length() <= half.position_radius && half.position_radius < 1e-15);
    /// assert!((half.linear - DVec3::Y * 0.5).length() <= half.linear_radius);
    /// ```
    #[must_use]
    pub fn in_unit_of_length(&self, factor: f64) -> Self {
        Kinematics::from_state(self).in_unit_of_length(factor).state_about(DVec3::ZERO)
    }

    /// The motion that has this state (its middle) at time `t` and keeps its twist. `None` where the middle is not finite.
    ///
    /// The rotation of the quaternion is known within 36u (Frobenius norm), and so is how far it is from the middle.
    ///
    /// ```
    /// use d2m_motion::{ConstantTwist, RigidMotion};
    /// use glam::DVec3;
    /// let spin = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
    /// let again = spin.enclose_state(0.5).to_constant_twist(0.5).unwrap();
    /// assert!(again.rotation_radius < 1e-13 && again.motion.angular_velocity() == DVec3::Z);
    /// ```
    pub fn to_constant_twist(&self, t: f64) -> Option<StateTwist> {
        let motion = ConstantTwist::try_new(
            self.position,
            DQuat::from_mat3(&self.rotation).normalize(),
            self.linear,
            self.angular,
        )
        .and_then(|motion| motion.try_with_at(self.at)?.try_with_reference_time(t))
        .ok()?;
        let known = from_quat_rounded(motion.orientation())?;
        let [x, y, z] =
            [0, 1, 2].map(|column| (known.col(column) - self.rotation.col(column)).length_squared());
        let radius = (x + y + z).sqrt() + 40.0 * UNIT + self.rotation_radius;
        (radius < f64::INFINITY).then_some(StateTwist { motion, rotation_radius: radius * UP })
    }
}
