//! One joint of an arm: a fixed transform and what moves after it.
use crate::ball::{Ball, product_radius, up};
use crate::enclosed::Enclosed;
use crate::error::{fault, require_finite};
use crate::joint_value::{JointValue, ValueOverTime};
use crate::kinematics::two_sums;
use crate::rotation::{RotationDd, Spin, exponential_dd, rotate_dd};
use crate::rounding::UNIT;
use crate::sin_cos::{LARGEST_ANGLE, sin_cos};
use crate::span_motion::SpanMotion;
use crate::{Kinematics, MotionError};
use d2m_lanes::DoubleDouble;
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

/// How a joint moves the frame that follows it.
///
/// ```
/// use d2m_motion::{Chain, Joint, JointKind, JointValue, RigidMotion};
/// use glam::{DQuat, DVec3};
/// // Shifts by 2 units of length a unit of time.
/// let shift = JointKind::Prismatic { axis: DVec3::Z, value: JointValue::try_polynomial(vec![0.0, 2.0])? };
/// let slide = Chain::try_new(vec![Joint::try_new(DVec3::X, DQuat::IDENTITY, shift)?])?;
/// assert_eq!(slide.pose_and_twist(1.5).0.translation, DVec3::new(1.0, 0.0, 3.0));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum JointKind {
    /// Not at all.
    Fixed,
    /// It turns by the value (radians) about the axis through the joint frame's origin.
    Revolute {
        /// Direction in the joint frame, any length but zero.
        axis: DVec3,
        /// The angle over time.
        value: JointValue,
    },
    /// It shifts by the value (units of length) along the axis.
    Prismatic {
        /// Direction in the joint frame, any length but zero.
        axis: DVec3,
        /// The shift over time.
        value: JointValue,
    },
}

/// A fixed transform and the joint after it. Cheap to clone: the links of an arm share their joints.
///
/// ```
/// use d2m_motion::{Chain, Joint, JointKind, JointValue, RigidMotion};
/// use glam::{DQuat, DVec3};
/// // Turns about z by half a radian a unit of time; the next frame is one unit further out.
/// let turn = JointKind::Revolute { axis: DVec3::Z, value: JointValue::try_polynomial(vec![0.0, 0.5])? };
/// let shoulder = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, turn)?;
/// let hand = Joint::try_new(DVec3::X, DQuat::IDENTITY, JointKind::Fixed)?;
/// let arm = Chain::try_new(vec![shoulder, hand])?;
/// let place = arm.pose_and_twist(2.0).0.translation;
/// assert!((place - DVec3::new(1f64.cos(), 1f64.sin(), 0.0)).length() < 1e-14);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Joint(Arc<JointData>);

#[derive(Debug, PartialEq)]
struct JointData {
    position: DVec3,
    orientation: Orientation,
    kind: JointKind,
    /// The rotation, rounded once.
    turn: DMat3,
    /// Bound of its error: an entry is off by half a unit in the last place of numbers up to 1, √9·u in all.
    turn_radius: f64,
    /// The axis divided by its norm, within 4u of its direction (zero without).
    axis: DVec3,
    /// The axis in the frame before.
    axis_before: Ball,
}

/// How a joint stands in the frame before it.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Orientation {
    /// Divided by its norm.
    Quaternion(DQuat),
    /// Roll, pitch, yaw.
    Angles([f64; 3]),
}

impl Orientation {
    fn rotation(self) -> RotationDd {
        match self {
            Self::Quaternion(q) => rotate_dd(DVec3::ZERO, DoubleDouble::ZERO, q),
            Self::Angles([roll, pitch, yaw]) => {
                let about = |axis: DVec3, angle: f64| exponential_dd(axis, DoubleDouble::from_f64(angle));
                about(DVec3::Z, yaw) * about(DVec3::Y, pitch) * about(DVec3::X, roll)
            }
        }
    }

    /// Is it no turn at all, exactly?
    fn is_identity(self) -> bool {
        match self {
            Self::Quaternion(DQuat { x, y, z, .. }) => (x, y, z) == (0.0, 0.0, 0.0),
            Self::Angles(angles) => angles == [0.0; 3],
        }
    }
}

impl PartialEq for Joint {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl Joint {
    /// The transform (x, q) from the frame before, then the joint. The quaternion is divided by its norm, exactly, and the
    /// axis by its length.
    ///
    /// # Errors
    /// A component that is not finite, a quaternion that cannot be normalised, an axis of length zero.
    pub fn try_new(position: DVec3, orientation: DQuat, kind: JointKind) -> Result<Self, MotionError> {
        // The same checks as a motion's.
        let _checked = crate::ConstantTwist::try_new(position, orientation, DVec3::ZERO, DVec3::ZERO)
            .map_err(|error| error.within("pose"))?;
        Self::with_orientation(position, Orientation::Quaternion(orientation), kind)
    }

    /// As [`Joint::try_new`], with the orientation in angles: roll about x, then pitch about y, then yaw about z, all fixed
    /// axes (the convention of URDF), R = R_z(yaw)·R_y(pitch)·R_x(roll). The angles are taken as the doubles that they are: 1.5708
    /// is not a quarter of a turn.
    ///
    /// ```
    /// use d2m_motion::{Chain, Joint, JointKind, RigidMotion};
    /// use glam::DVec3;
    /// let quarter = std::f64::consts::FRAC_PI_2;
    /// let joint = Joint::try_with_rpy(DVec3::X, [quarter, 0.0, quarter], JointKind::Fixed)?;
    /// let pose = Chain::try_new(vec![joint])?.pose_and_twist(0.0).0;
    /// assert!((pose.transform_point(DVec3::Y) - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-15);
    /// # Ok::<(), d2m_motion::MotionError>(())
    /// ```
    ///
    /// # Errors
    /// A component that is not finite, an angle of more than 1e9, an axis of length zero.
    pub fn try_with_rpy(position: DVec3, angles: [f64; 3], kind: JointKind) -> Result<Self, MotionError> {
        require_finite("position", &position.to_array())?;
        require_finite("rpy", &angles)?;
        if let Some(index) = angles.iter().position(|angle| angle.abs() > LARGEST_ANGLE) {
            let reason = format!("{:?} is more than {LARGEST_ANGLE:?} radians", angles[index]);
            return Err(fault(format!("rpy[{index}]"), reason));
        }
        Self::with_orientation(position, Orientation::Angles(angles), kind)
    }

    fn with_orientation(
        position: DVec3,
        orientation: Orientation,
        kind: JointKind,
    ) -> Result<Self, MotionError> {
        let axis = match kind {
            JointKind::Fixed => DVec3::ZERO,
            JointKind::Revolute { axis, .. } | JointKind::Prismatic { axis, .. } => {
                require_finite("axis", &axis.to_array())?;
                if axis == DVec3::ZERO {
                    return Err(fault("axis".into(), "[0, 0, 0] has no direction".into()));
                }
                Spin::new(axis).axis
            }
        };
        let turn = orientation.rotation().to_mat3();
        let turn_radius = if orientation.is_identity() { 0.0 } else { 4.0 * UNIT };
        let axis_before = Ball::new(axis, 8.0 * UNIT).turned(&turn, turn_radius);
        Ok(Self(Arc::new(JointData { position, orientation, kind, turn, turn_radius, axis, axis_before })))
    }

    /// The same joint with another value; a fixed one stays as it is. Costs no trigonometry: a planner's edges differ in this only.
    #[must_use]
    pub fn with_value(&self, value: JointValue) -> Self {
        let JointData { position, orientation, turn, turn_radius, axis, axis_before, .. } = *self.0;
        let kind = match self.0.kind {
            JointKind::Fixed => return self.clone(),
            JointKind::Revolute { axis, .. } => JointKind::Revolute { axis, value },
            JointKind::Prismatic { axis, .. } => JointKind::Prismatic { axis, value },
        };
        Self(Arc::new(JointData { position, orientation, kind, turn, turn_radius, axis, axis_before }))
    }

    /// Position of the joint in the frame before it.
    pub fn position(&self) -> DVec3 {
        self.0.position
    }

    /// Orientation of the joint in the frame before it: as given, or near the angles that were given.
    pub fn orientation(&self) -> DQuat {
        match self.0.orientation {
            Orientation::Quaternion(orientation) => orientation,
            Orientation::Angles(_) => DQuat::from_mat3(&self.0.turn).normalize(),
        }
    }

    /// Roll, pitch and yaw in the frame before it, if the joint was given so.
    pub fn rpy(&self) -> Option<[f64; 3]> {
        match self.0.orientation {
            Orientation::Quaternion(_) => None,
            Orientation::Angles(angles) => Some(angles),
        }
    }

    /// How it moves.
    pub fn kind(&self) -> &JointKind {
        &self.0.kind
    }

    pub(crate) fn value(&self) -> Option<&JointValue> {
        match &self.0.kind {
            JointKind::Fixed => None,
            JointKind::Revolute { value, .. } | JointKind::Prismatic { value, .. } => Some(value),
        }
    }

    /// Transform and joint together over a span of time: T(x, q)·J(value), with q as the matrix Q.
    ///
    /// exp([k]θ) with sine and cosine within 4u and an axis within 4u of its direction: 64u (docs/theory/motions.md). A
    /// rotation by θ differs from one by θ̃ by at most |θ − θ̃|, and the product Q·exp([k]θ) is that of
    /// [`Kinematics::then`]. The axis in the frame before is Qk, which is Q exp([k]θ)k: velocities and shifts are
    /// multiples of it. Without [`Wanted::Pose`] it says how the joint moves, with [`Wanted::Rates`] how that changes too.
    #[inline]
    pub(crate) fn placed(&self, lo: f64, hi: f64, wanted: Wanted) -> Kinematics {
        let data = &*self.0;
        let place = Kinematics { position: Ball::point(data.position), ..Kinematics::REST };
        let (turn, turn_radius) = (data.turn, data.turn_radius);
        let Some(value) = self.value() else { return place.with_rotation(turn, turn_radius) };
        let over: ValueOverTime = value.over(lo, hi);
        let along = |e: Enclosed| {
            // The second double of the value counts as error.
            data.axis_before.times(e.center.hi, up(e.radius + e.center.lo.abs()))
        };
        let rate = if wanted == Wanted::Pose { Ball::ANY } else { along(over.rate) };
        let second = if wanted == Wanted::Rates { along(over.second) } else { Ball::ANY };
        if matches!(data.kind, JointKind::Prismatic { .. }) {
            let shift = along(over.value);
            let (sum, lost) = two_sums(data.position, shift.center);
            let position = Ball::new(sum, shift.radius);
            let position_tail = if lost.is_finite() { lost } else { DVec3::ZERO };
            let moved = Kinematics { position, position_tail, linear: rate, linear_rate: second, ..place };
            return moved.with_rotation(turn, turn_radius);
        }
        let (spin, spin_error) = spin_about(data.axis, over.value.center);
        let spin_radius = up(over.value.radius + spin_error);
        let turning = Kinematics { angular: rate, angular_rate: second, ..place };
        if data.orientation.is_identity() {
            return turning.with_rotation(spin, spin_radius);
        }
        turning.with_rotation(turn * spin, product_radius(turn_radius, spin_radius))
    }
}

/// A joint over a span of time, on its own.
impl Joint {
    /// As [`Joint::placed`] from one time to another, with the middle of the span apart from all of it. Of a value that may jump
    /// inside the span no rate is known.
    pub(crate) fn over(&self, lo: f64, hi: f64) -> SpanMotion {
        let data = &*self.0;
        let place = SpanMotion {
            rotation: data.turn,
            rotation_radius: data.turn_radius,
            rotation_spread: data.turn_radius,
            position: Ball::point(data.position),
            ..SpanMotion::REST
        };
        let Some(value) = self.value() else { return place };
        let over: ValueOverTime = value.over(lo, hi);
        let Enclosed { center, radius } = over.value;
        let rate = if value.is_continuous(lo, hi) {
            data.axis_before.times(over.rate.center.hi, up(over.rate.radius + over.rate.center.lo.abs()))
        } else {
            Ball::ANY
        };
        if matches!(data.kind, JointKind::Prismatic { .. }) {
            // The second double of the value counts as error.
            let along = |radius: f64| data.axis_before.times(center.hi, up(radius + center.lo.abs()));
            let position = place.position + along(over.middle_radius);
            let position_spread = (place.position + along(radius)).radius;
            return SpanMotion { position, position_spread, linear: rate, ..place };
        }
        let (spin, spin_error) = spin_about(data.axis, center);
        let (middle, whole) = (up(over.middle_radius + spin_error), up(radius + spin_error));
        let (rotation, rotation_radius, rotation_spread) = if data.orientation.is_identity() {
            (spin, middle, whole)
        } else {
            let product = |radius: f64| product_radius(data.turn_radius, radius);
            (data.turn * spin, product(middle), product(whole))
        };
        let angular = rate;
        SpanMotion { rotation, rotation_radius, rotation_spread, angular, ..place }
    }
}

/// What is wanted of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// Where it is: of velocities nothing is known.
    Pose,
    /// Velocities too.
    Twist,
    /// Accelerations too.
    Rates,
}

/// exp([k]θ) and how far it is from that at most: 64u with sine and cosine within 4u; any rotation for angles beyond what can be reduced.
///
/// Angles of more than half a turn are reduced by whole turns in pairs of doubles, so that |r| ≤ 4 and what is left
/// out is below 2⁻⁷⁰; then sin(r + e) = sin r + e cos r, |e| ≤ 2⁻⁵¹.
fn spin_about(axis: DVec3, angle: DoubleDouble) -> (DMat3, f64) {
    /// 2π to 2⁻¹⁰⁵.
    const TURN: DoubleDouble = DoubleDouble { hi: core::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16 };
    if angle.hi.is_nan() || angle.hi.abs() > LARGEST_ANGLE {
        return (DMat3::IDENTITY, f64::INFINITY);
    }
    let turns = if angle.hi.abs() > 4.0 { (angle.hi / TURN.hi).round() } else { 0.0 };
    let r = if turns == 0.0 { angle } else { angle - TURN * turns };
    let (sin, cos) = sin_cos(r.hi);
    let spin = Spin { omega: axis, speed: 1.0, axis };
    (spin.rotation_of(sin + r.lo * cos, cos - r.lo * sin), 64.0 * UNIT)
}
