//! A link of an articulated arm: fixed transforms and joints whose values are functions of time.
use crate::ball::Ball;
use crate::error::{fault, require_finite};
use crate::joint_value::{Enclosed, JointValue, ValueOverTime};
use crate::rotation::{Spin, rotate_dd};
use crate::rounding::UNIT;
use crate::sin_cos::{LARGEST_ANGLE, sin_cos};
use crate::{CertifiedState, IntervalPose, IntervalTwist, Kinematics, MotionError, Pose, RigidMotion, Twist};
use d2m_interval::Interval;
use d2m_lanes::DoubleDouble;
use glam::{DMat3, DQuat, DVec3};

/// How a joint moves the frame that follows it.
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

/// A fixed transform and the joint after it.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    position: DVec3,
    orientation: DQuat,
    kind: JointKind,
    /// The orientation divided by its norm, rounded once.
    turn: DMat3,
    /// The axis divided by its norm (zero without).
    axis: DVec3,
}

impl Joint {
    /// The transform (x, q) from the frame before, then the joint. The quaternion is divided by its norm, exactly, and the
    /// axis by its length.
    ///
    /// # Errors
    /// A component that is not finite, a quaternion that cannot be normalised, an axis of length zero.
    pub fn try_new(position: DVec3, orientation: DQuat, kind: JointKind) -> Result<Self, MotionError> {
        // The same checks as a motion's.
        let pose = crate::ConstantTwist::try_new(position, orientation, DVec3::ZERO, DVec3::ZERO)
            .map_err(|error| error.within("pose"))?;
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
        let turn = rotate_dd(DVec3::ZERO, DoubleDouble::ZERO, pose.orientation()).to_mat3();
        Ok(Self { position, orientation, kind, turn, axis })
    }

    /// Position of the joint in the frame before it.
    pub const fn position(&self) -> DVec3 {
        self.position
    }

    /// Orientation of the joint in the frame before it, as given.
    pub const fn orientation(&self) -> DQuat {
        self.orientation
    }

    /// How it moves.
    pub const fn kind(&self) -> &JointKind {
        &self.kind
    }

    const fn value(&self) -> Option<&JointValue> {
        match &self.kind {
            JointKind::Fixed => None,
            JointKind::Revolute { value, .. } | JointKind::Prismatic { value, .. } => Some(value),
        }
    }

    /// The fixed transform. An entry of the matrix is off by half a unit in the last place of numbers up to 1: √9·u.
    fn transform(&self) -> Kinematics {
        let DQuat { x, y, z, .. } = self.orientation;
        let identity = (x, y, z) == (0.0, 0.0, 0.0);
        Kinematics { position: Ball::point(self.position), ..Kinematics::REST }
            .with_rotation(self.turn, if identity { 0.0 } else { 4.0 * UNIT })
    }

    /// The joint alone over a span of time; `None` when it does not move.
    ///
    /// exp([k]θ) with sine and cosine within 4u and an axis within 4u of its direction: 64u (docs/theory/motions.md). A
    /// rotation by θ differs from one by θ̃ by at most |θ − θ̃|.
    fn movement<const RATES: bool>(&self, lo: f64, hi: f64) -> Option<Kinematics> {
        let over: ValueOverTime = self.value()?.over(lo, hi);
        let along = |e: Enclosed| {
            // The axis is off by 4u of its length, and the second double of the value counts as error.
            let radius = e.radius + e.center.lo.abs() + 8.0 * UNIT * e.center.hi.abs();
            Ball::new(self.axis, 0.0).times(e.center.hi, crate::ball::up(radius))
        };
        let (rate, second) = (along(over.rate), if RATES { along(over.second) } else { Ball::ANY });
        if matches!(self.kind, JointKind::Prismatic { .. }) {
            let position = along(over.value);
            return Some(Kinematics { position, linear: rate, linear_rate: second, ..Kinematics::REST });
        }
        let (sin, cos) = sin_cos_of(over.value.center);
        let rotation = Spin { omega: self.axis, speed: 1.0, axis: self.axis }.rotation_of(sin, cos);
        let radius = crate::ball::up(over.value.radius + 64.0 * UNIT);
        let known = sin.is_finite();
        Some(
            Kinematics { angular: rate, angular_rate: second, ..Kinematics::REST }
                .with_rotation(rotation, if known { radius } else { f64::INFINITY }),
        )
    }
}

/// Sine and cosine of a pair of doubles, each within 4u; NaN beyond what can be reduced.
///
/// Angles of more than half a turn are reduced by whole turns in pairs of doubles, so that |r| ≤ 4 and what is left
/// out is below 2⁻⁷⁰; then sin(r + e) = sin r + e cos r, |e| ≤ 2⁻⁵¹.
fn sin_cos_of(angle: DoubleDouble) -> (f64, f64) {
    /// 2π to 2⁻¹⁰⁵.
    const TURN: DoubleDouble = DoubleDouble { hi: core::f64::consts::TAU, lo: 2.449_293_598_294_706_4e-16 };
    if angle.hi.is_nan() || angle.hi.abs() > LARGEST_ANGLE {
        return (f64::NAN, f64::NAN);
    }
    let turns = if angle.hi.abs() > 4.0 { (angle.hi / TURN.hi).round() } else { 0.0 };
    let r = if turns == 0.0 { angle } else { angle - TURN * turns };
    let (sin, cos) = sin_cos(r.hi);
    (sin + r.lo * cos, cos - r.lo * sin)
}

/// A link of an articulated arm: pose(t) = ∏ T(xᵢ, qᵢ)·Jᵢ(valueᵢ(t)), from the base to the link.
///
/// ```
/// use d2m_motion::{Chain, Joint, JointKind, JointValue, RigidMotion};
/// use glam::{DQuat, DVec3};
/// // A quarter turn in unit time about the vertical axis, then out along the turned arm.
/// let value = JointValue::try_polynomial(vec![0.0, std::f64::consts::FRAC_PI_2])?;
/// let turn = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, JointKind::Revolute { axis: DVec3::Z, value })?;
/// let tip = Joint::try_new(DVec3::X, DQuat::IDENTITY, JointKind::Fixed)?;
/// let link = Chain::try_new(vec![turn, tip])?;
/// let (pose, twist) = link.pose_and_twist(1.0);
/// assert!((pose.translation - DVec3::Y).length() < 1e-15);
/// assert!((twist.linear + DVec3::X * std::f64::consts::FRAC_PI_2).length() < 1e-15);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
///
/// Source: R. Featherstone, "Rigid Body Dynamics Algorithms", 2008, DOI 10.1007/978-1-4899-7560-7, for the recursion.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    joints: Vec<Joint>,
    domain: Interval,
}

impl Chain {
    /// The joints from the base to the link.
    ///
    /// # Errors
    /// No joint, or joints whose values have no time in common.
    pub fn try_new(joints: Vec<Joint>) -> Result<Self, MotionError> {
        if joints.is_empty() {
            return Err(fault("chain".into(), "it is empty: at least one joint is needed".into()));
        }
        let mut domain = Interval::ENTIRE;
        for (index, value) in joints.iter().enumerate().filter_map(|(i, joint)| Some((i, joint.value()?))) {
            let (before, own) = (domain, value.domain());
            domain = domain.intersection(own);
            if domain.is_empty() {
                let reason = format!(
                    "its times from {:?} to {:?} have none in common with those of the joints before, {:?} to {:?}",
                    own.lo(),
                    own.hi(),
                    before.lo(),
                    before.hi()
                );
                return Err(fault(format!("chain[{index}], value"), reason));
            }
        }
        Ok(Self { joints, domain })
    }

    /// The joints from the base to the link.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// How many joints from the base on are the same in both chains: the links move together up to there.
    pub fn common_joints(&self, other: &Self) -> usize {
        self.joints.iter().zip(&other.joints).take_while(|(a, b)| a == b).count()
    }

    /// The first joints alone: the motion of the frame that they carry.
    #[must_use]
    pub fn only_first(&self, count: usize) -> Self {
        let joints = self.joints[..count.min(self.joints.len())].to_vec();
        Self { joints, domain: self.domain }
    }

    /// The chain without its first joints, as seen from the frame that they carry: at rest if none is left.
    #[must_use]
    pub fn without_first(&self, count: usize) -> Self {
        let joints = self.joints.get(count..).unwrap_or_default().to_vec();
        Self { joints, domain: self.domain }
    }

    fn over(&self, lo: f64, hi: f64) -> Kinematics {
        self.over_with::<true>(lo, hi)
    }

    /// At one time, without accelerations.
    fn state_at(&self, t: f64) -> Kinematics {
        self.over_with::<false>(t, t)
    }

    fn over_with<const RATES: bool>(&self, lo: f64, hi: f64) -> Kinematics {
        self.joints.iter().fold(Kinematics::REST, |frame, joint| {
            let placed = frame.then_with::<RATES>(&joint.transform());
            let movement = joint.movement::<RATES>(lo, hi);
            movement.map_or(placed, |movement| placed.then_with::<RATES>(&movement))
        })
    }

    /// A span in parts in each of which the link turns by little.
    fn parts(&self, t: Interval) -> impl Iterator<Item = Kinematics> + '_ {
        /// Radians either way from the middle of a part.
        const LITTLE: f64 = 0.25;
        /// Most parts.
        const MANY: f64 = 64.0;
        let inside = t.intersection(self.domain);
        let (lo, hi) = if inside.is_empty() { (t.lo(), t.hi()) } else { (inside.lo(), inside.hi()) };
        let turn: f64 = if t.width() > 0.0 {
            let angular = |joint: &Joint| match &joint.kind {
                JointKind::Revolute { value, .. } => value.over(lo, hi).rate_magnitude(),
                _ => 0.0,
            };
            self.joints.iter().map(angular).sum::<f64>() * t.width()
        } else {
            0.0
        };
        // Also what is no number is many.
        let count = if turn <= 2.0 * LITTLE { 1.0 } else { (turn / (2.0 * LITTLE)).ceil().min(MANY) };
        let end = move |i: f64| if i >= count { hi } else { (lo + (hi - lo) * (i / count)).max(lo).min(hi) };
        (0..count as usize).map(move |i| self.over(end(i as f64), end((i + 1) as f64)))
    }
}

impl RigidMotion for Chain {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let now = self.state_at(t);
        let pose = Pose {
            rotation: DQuat::from_mat3(&now.rotation).normalize(),
            translation: now.position.center + now.position_tail,
            at: DVec3::ZERO,
        };
        (pose, Twist { linear: now.linear.center, angular: now.angular.center })
    }

    /// Over long spans part by part.
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.parts(t).map(|part| part.to_pose()).reduce(IntervalPose::hull).expect("at least one part")
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.parts(t).map(|part| part.to_twist()).reduce(IntervalTwist::hull).expect("at least one part")
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.parts(t).map(|part| part.to_twist_rate()).reduce(IntervalTwist::hull).expect("at least one part")
    }

    fn domain(&self) -> Interval {
        self.domain
    }

    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.joints.iter().filter_map(|joint| joint.value()?.next_time(t)).min_by(f64::total_cmp)
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.state_at(t).state_about(DVec3::ZERO)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.state_at(t).state_about(origin)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        self.over(t.lo(), t.hi())
    }

    fn chain(&self) -> Option<&Chain> {
        Some(self)
    }
}
