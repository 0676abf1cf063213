//! The paper's motion: constant linear and angular velocity.
use crate::ball::{length_up, times_up, up};
use crate::error::require_finite;
use crate::rotation::{RotationDd, Spin, from_quat_rounded, rotate_dd};
use crate::rounding::{SUM_ROUNDING, UNDERFLOW, UNIT};
use crate::sin_cos::LARGEST_ANGLE;
use crate::{
    Ball, CertifiedState, IntervalPose, IntervalTwist, Kinematics, MotionError, Pose, RigidMotion, Twist,
};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_lanes::{DoubleDouble, power_of_two};
use glam::{DMat3, DQuat, DVec3};

/// Norms of quaternions that are taken: their squares neither over- nor underflow.
const LEAST_NORM: f64 = 1e-150;
const MOST_NORM: f64 = 1e150;

/// Constant twist: `x(t) = x0 + v·(t − t_ref)`, `R(t) = exp([ω]·(t − t_ref))·R0`.
///
/// A body point `p` is at `R(t)·(p − at) + x(t)`. `ω` is in world axes, radians per unit of time. `R0` is the
/// rotation of the orientation quaternion divided by its norm, *exactly*: the quaternion as stored need not be unit.
///
/// ```
/// use d2m_motion::{ConstantTwist, RigidMotion};
/// use glam::{DMat3, DQuat, DVec3};
/// let motion = ConstantTwist::try_new(DVec3::X, DQuat::IDENTITY, DVec3::Y, DVec3::ZERO)?;
/// let (pose, _) = motion.pose_and_twist(2.0);
/// assert_eq!(pose.transform_point(DVec3::ZERO), DVec3::new(1.0, 2.0, 0.0));
/// assert_eq!("x=1,0,0;v=0,1,0".parse(), Ok(motion));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
///
/// Source: "Accurate and Efficient Continuous Collision Detection" (D2M), section III and Appendix A.
#[derive(Debug, Clone, Copy, PartialEq)]
#[doc(alias = "NonlinearRigidMotion")]
#[must_use]
pub struct ConstantTwist {
    position: DVec3,
    orientation: DQuat,
    linear_velocity: DVec3,
    angular_velocity: DVec3,
    reference_time: f64,
    at: DVec3,
}

impl Default for ConstantTwist {
    fn default() -> Self {
        Self::REST
    }
}

impl ConstantTwist {
    /// Rest, with body frame = world frame.
    pub const REST: Self = Self {
        position: DVec3::ZERO,
        orientation: DQuat::IDENTITY,
        linear_velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        reference_time: 0.0,
        at: DVec3::ZERO,
    };

    /// A motion from its pose at time 0 and its twist, following the body origin.
    ///
    /// # Errors
    /// A component that is not finite, or a quaternion whose norm is outside [1e-150, 1e150].
    pub fn try_new(
        position: DVec3,
        orientation: DQuat,
        linear_velocity: DVec3,
        angular_velocity: DVec3,
    ) -> Result<Self, MotionError> {
        let motion = Self { position, orientation, linear_velocity, angular_velocity, ..Self::REST };
        motion.validated()
    }

    fn validated(self) -> Result<Self, MotionError> {
        require_finite("position", &self.position.to_array())?;
        require_finite("orientation", &self.orientation.to_array())?;
        require_finite("linear_velocity", &self.linear_velocity.to_array())?;
        require_finite("angular_velocity", &self.angular_velocity.to_array())?;
        require_finite("reference_time", &[self.reference_time])?;
        require_finite("at", &self.at.to_array())?;
        let DQuat { x, y, z, w } = self.orientation;
        let largest = x.abs().max(y.abs()).max(z.abs()).max(w.abs());
        if !(LEAST_NORM..=MOST_NORM).contains(&largest) {
            return Err(MotionError::OrientationNorm { w, x, y, z });
        }
        Ok(self)
    }

    /// The same with another reference time (the time at which the pose is the given one).
    ///
    /// # Errors
    /// A time that is not finite.
    pub fn try_with_reference_time(self, reference_time: f64) -> Result<Self, MotionError> {
        Self { reference_time, ..self }.validated()
    }

    /// The same with another reference point: the *position* then is the position of that point.
    ///
    /// # Errors
    /// A component that is not finite.
    pub fn try_with_at(self, at: DVec3) -> Result<Self, MotionError> {
        Self { at, ..self }.validated()
    }

    /// The same with another position of `at` at the reference time.
    ///
    /// # Panics
    /// If a component is not finite.
    pub fn with_position(self, position: DVec3) -> Self {
        Self { position, ..self }.validated().unwrap_or_else(|error| panic!("{error}"))
    }

    /// The same with another orientation at the reference time (any quaternion but zero; normalised exactly).
    ///
    /// # Panics
    /// If a component is not finite or the norm is outside [1e-150, 1e150].
    pub fn with_orientation(self, orientation: DQuat) -> Self {
        Self { orientation, ..self }.validated().unwrap_or_else(|error| panic!("{error}"))
    }

    /// The same with another linear velocity.
    ///
    /// # Panics
    /// If a component is not finite.
    pub fn with_linear_velocity(self, linear_velocity: DVec3) -> Self {
        Self { linear_velocity, ..self }.validated().unwrap_or_else(|error| panic!("{error}"))
    }

    /// The same with another angular velocity (world axes).
    ///
    /// # Panics
    /// If a component is not finite.
    pub fn with_angular_velocity(self, angular_velocity: DVec3) -> Self {
        Self { angular_velocity, ..self }.validated().unwrap_or_else(|error| panic!("{error}"))
    }

    /// The same with another reference time.
    ///
    /// # Panics
    /// If it is not finite.
    pub fn with_reference_time(self, reference_time: f64) -> Self {
        self.try_with_reference_time(reference_time).unwrap_or_else(|error| panic!("{error}"))
    }

    /// The same with another reference point.
    ///
    /// # Panics
    /// If a component is not finite.
    pub fn with_at(self, at: DVec3) -> Self {
        self.try_with_at(at).unwrap_or_else(|error| panic!("{error}"))
    }

    /// World position of `at` at the reference time.
    pub const fn position(&self) -> DVec3 {
        self.position
    }

    /// Orientation at the reference time, as given (not normalised).
    pub const fn orientation(&self) -> DQuat {
        self.orientation
    }

    /// Velocity of `at`, world axes.
    pub const fn linear_velocity(&self) -> DVec3 {
        self.linear_velocity
    }

    /// Angular velocity, world axes.
    pub const fn angular_velocity(&self) -> DVec3 {
        self.angular_velocity
    }

    /// The time at which the pose is the given one.
    pub const fn reference_time(&self) -> f64 {
        self.reference_time
    }

    /// The reference point, body frame.
    pub const fn at(&self) -> DVec3 {
        self.at
    }

    /// The true position of `at` at time `t`, to about 2⁻¹⁰⁰ of its terms.
    pub(crate) fn position_dd(&self, t: f64) -> [DoubleDouble; 3] {
        let s = DoubleDouble::from_difference(t, self.reference_time);
        let one = |x0: f64, v: f64| (s * v).add_f64(x0);
        [
            one(self.position.x, self.linear_velocity.x),
            one(self.position.y, self.linear_velocity.y),
            one(self.position.z, self.linear_velocity.z),
        ]
    }

    /// The true rotation at time `t`, to about 2⁻⁹⁰ (relative to 1 + |ω||t − t_ref|).
    pub(crate) fn rotation_dd(&self, t: f64) -> RotationDd {
        rotate_dd(
            self.angular_velocity,
            DoubleDouble::from_difference(t, self.reference_time),
            self.orientation,
        )
    }

    /// The same motion with the reference time `t0`: the pose is evaluated in extended precision and rounded once, so the
    /// new motion differs from the old one by at most a few units in the last place of the pose at `t0`, also when
    /// `t0` is far from the old reference time. (The certified feature tests do not use it: they carry the rounding.)
    pub fn rebase(&self, t0: f64) -> Self {
        let position = self.position_dd(t0);
        Self {
            position: DVec3::new(position[0].hi, position[1].hi, position[2].hi),
            orientation: self.rotation_dd(t0).to_quat(),
            reference_time: t0,
            ..*self
        }
    }
}

/// Radians either way over which a rotation is enclosed about its middle: from there on interval arithmetic is tighter.
const LITTLE: f64 = 1e-3;

impl ConstantTwist {
    /// Is the orientation the identity, exactly?
    fn has_no_turn(&self) -> bool {
        let DQuat { x, y, z, .. } = self.orientation;
        (x, y, z) == (0.0, 0.0, 0.0)
    }

    /// Upper bound of the radians that it turns in a time, also where squares of its rate are lost to underflow; infinite where that is no
    /// number.
    fn bound_turn(&self, time: f64) -> f64 {
        up(length_up(self.angular_velocity) * time.abs()) + f64::MIN_POSITIVE
    }

    /// In plain floating point: `u(96 + 8|ω||t − t_ref|)` for the rotation, and no more than 4u after many turns, from double-double;
    /// `4u(|x0| + |v(t − t_ref)|)` for the position, u = 2⁻⁵³ (docs/theory/features.md, "Any C² motion"). `None` where that is not proven.
    fn plain_state(&self, t: f64) -> Option<CertifiedState> {
        let s = t - self.reference_time;
        let angle = self.bound_turn(s);
        // Also NaN is not proven.
        let start = from_quat_rounded(self.orientation).filter(|_| angle < 0.5 * LARGEST_ANGLE)?;
        let (rotation, rotation_radius) = if angle > SOME_TURNS {
            (self.rotation_dd(t).to_mat3(), ROUNDED_ONCE)
        } else {
            (Spin::new(self.angular_velocity).rotation(s) * start, UNIT * (96.0 + 8.0 * angle))
        };
        let travelled = self.linear_velocity * s;
        Some(CertifiedState {
            rotation,
            position: self.position + travelled,
            at: self.at,
            linear: self.linear_velocity,
            angular: self.angular_velocity,
            rotation_radius,
            position_radius: 4.0 * UNIT * (self.position.length() + travelled.length()) + UNDERFLOW,
            linear_radius: 0.0,
            angular_radius: 0.0,
        })
    }
}

/// All matrices whose entries are within `radius` of those of a rotation: that of the operator norm holds for each.
fn around(m: &DMat3, radius: f64) -> IntervalMat3 {
    // One rounding of an end, of numbers up to 1 + radius.
    let radius = radius + 2.0 * f64::EPSILON;
    let entry = |x: f64| Interval::new(x - radius, x + radius);
    let t = m.transpose();
    let row = |v: DVec3| IntervalVec3::new(entry(v.x), entry(v.y), entry(v.z));
    IntervalMat3::from_rows([row(t.x_axis), row(t.y_axis), row(t.z_axis)])
}

/// Radians from which a rotation is made in double-double where its rounding is counted: from there on that of the angle, 8u a radian, is worth twenty
/// times as long.
const SOME_TURNS: f64 = 1024.0;
/// What rounding the entries of such a rotation once leaves (Frobenius norm √3 of them: √3 u), with the errors of double-double before it: 2⁻¹⁰⁰ of
/// the angle, which is below 2³⁰, and less than 2⁻⁹⁵ besides.
const ROUNDED_ONCE: f64 = 4.0 * UNIT;
/// Radians from which a pose is worth more than double precision: the rounding of the angle grows with it.
const FEW_TURNS: f64 = 64.0;
/// Radians up to which the extended sine and cosine are good: 2³⁰.
const MANY_TURNS: f64 = 1_073_741_824.0;

impl RigidMotion for ConstantTwist {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let s = t - self.reference_time;
        let angle = self.bound_turn(s);
        let rotation = if angle > FEW_TURNS && angle < MANY_TURNS {
            self.rotation_dd(t).to_quat()
        } else {
            (crate::rotation::quat_of(self.angular_velocity, s) * self.orientation.normalize()).normalize()
        };
        let pose = Pose { rotation, translation: self.position + self.linear_velocity * s, at: self.at };
        (pose, Twist { linear: self.linear_velocity, angular: self.angular_velocity })
    }

    /// Where the body turns little over `t`, the rotation in its middle in plain floating point and as far around it as it
    /// turns: a fifth of the instructions of interval arithmetic.
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let s = t - Interval::point(self.reference_time);
        let translation = IntervalVec3::point(self.linear_velocity) * s + self.position;
        // (No times at all: a NaN, which is not little.)
        let turn = self.bound_turn(t.rad());
        let plain = if turn <= LITTLE { self.plain_state(t.mid()) } else { None };
        let rotation = if let Some(state) = plain {
            around(&state.rotation, (state.rotation_radius + turn) * SUM_ROUNDING)
        } else {
            let start = IntervalMat3::from_quat_normalized(self.orientation);
            if self.angular_velocity == DVec3::ZERO {
                start
            } else {
                IntervalMat3::rotation(self.angular_velocity, s).mul_mat(start)
            }
        };
        IntervalPose { rotation, translation, at: self.at }
    }

    fn enclose_twist(&self, _: Interval) -> IntervalTwist {
        IntervalTwist {
            linear: IntervalVec3::point(self.linear_velocity),
            angular: IntervalVec3::point(self.angular_velocity),
        }
    }

    fn enclose_twist_rate(&self, _: Interval) -> IntervalTwist {
        let zero = IntervalVec3::point(DVec3::ZERO);
        IntervalTwist { linear: zero, angular: zero }
    }

    /// In plain floating point where that is proven ([`CertifiedState`] says how far off it is).
    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.plain_state(t).unwrap_or_else(|| {
            let now = Interval::point(t);
            CertifiedState::from_enclosures(&self.enclose_pose(now), &self.enclose_twist(now))
        })
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.enclose_kinematics(Interval::point(t)).state_about(origin)
    }

    /// The state in the middle of the span; from there the body turns by at most |ω| and goes by at most |v| times half of it.
    /// The position is kept as a pair of doubles, proven to 2⁻⁹⁸ of |x0| + |v s| (five operations of less than 2⁻¹⁰¹).
    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        /// 2⁻⁹⁸.
        const PAIR: f64 = power_of_two(-98);
        let Some(state) = self.plain_state(t.mid()) else {
            return Kinematics::from_enclosures(
                &self.enclose_pose(t),
                &self.enclose_twist(t),
                &self.enclose_twist_rate(t),
            );
        };
        let half = t.rad();
        let [x, y, z] = self.position_dd(t.mid());
        let center = DVec3::new(x.hi, y.hi, z.hi);
        let travelled = self.linear_velocity * (t.mid() - self.reference_time);
        let size = length_up(self.position) + length_up(travelled);
        let gone = times_up(length_up(self.linear_velocity), half);
        let turn = self.bound_turn(half);
        let rotation_radius = if self.angular_velocity == DVec3::ZERO && self.has_no_turn() {
            0.0
        } else {
            up(state.rotation_radius + turn)
        };
        Kinematics {
            position: Ball::new(center, up(gone + times_up(size, PAIR))),
            position_tail: if center.is_finite() { DVec3::new(x.lo, y.lo, z.lo) } else { DVec3::ZERO },
            at: self.at,
            linear: Ball::point(self.linear_velocity),
            angular: Ball::point(self.angular_velocity),
            ..Kinematics::REST
        }
        .with_rotation(state.rotation, rotation_radius)
    }

    fn constant_twist(&self) -> Option<ConstantTwist> {
        Some(*self)
    }
}
