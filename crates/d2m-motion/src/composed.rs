//! A motion inside a moving frame.
use crate::error::fault;
use crate::{CertifiedState, IntervalPose, IntervalTwist, Kinematics, MotionError, Pose, RigidMotion, Twist};
use d2m_interval::Interval;
use glam::DVec3;

/// `pose(t) = outer(t)·inner(t)`: the inner motion as seen in the body frame of the outer one.
///
/// A fixed transform before or after a motion is a [`ConstantTwist`](crate::ConstantTwist) at rest on that side.
///
/// ```
/// use d2m_motion::{Composed, ConstantTwist, RigidMotion};
/// use glam::DVec3;
/// // A car that turns on a merry-go-round.
/// let round = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
/// let slide = ConstantTwist::REST.with_position(DVec3::X).with_linear_velocity(DVec3::X);
/// let (pose, twist) = Composed::new(round, slide).pose_and_twist(0.0);
/// assert_eq!((pose.translation, twist.linear, twist.angular), (DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Z));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Composed<Outer, Inner> {
    outer: Outer,
    inner: Inner,
}

impl<Outer: RigidMotion, Inner: RigidMotion> Composed<Outer, Inner> {
    /// The inner motion in the frame that the outer one carries; defined where both are.
    pub const fn new(outer: Outer, inner: Inner) -> Self {
        Self { outer, inner }
    }

    /// The motion that carries the frame.
    pub const fn outer(&self) -> &Outer {
        &self.outer
    }

    /// The motion in the frame.
    pub const fn inner(&self) -> &Inner {
        &self.inner
    }
}

impl<Outer: RigidMotion, Inner: RigidMotion> RigidMotion for Composed<Outer, Inner> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let ((o, outer), (i, inner)) = (self.outer.pose_and_twist(t), self.inner.pose_and_twist(t));
        let e = o.transform_vector(i.translation - o.at);
        let pose = Pose {
            rotation: (o.rotation * i.rotation).normalize(),
            translation: o.translation + e,
            at: i.at,
        };
        let linear = outer.velocity_of(e) + o.transform_vector(inner.linear);
        (pose, Twist { linear, angular: outer.angular + o.transform_vector(inner.angular) })
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let (o, i) = (self.outer.enclose_pose(t), self.inner.enclose_pose(t));
        let one = Interval::SIGNED_UNIT;
        let entry = |e: d2m_interval::IntervalVec3| {
            d2m_interval::IntervalVec3::new(
                e.x.intersection(one),
                e.y.intersection(one),
                e.z.intersection(one),
            )
        };
        IntervalPose {
            rotation: d2m_interval::IntervalMat3::from_rows(o.rotation.mul_mat(i.rotation).rows().map(entry)),
            translation: o.rotation.mul_vec(i.translation - o.at) + o.translation,
            at: i.at,
        }
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.enclose_kinematics(t).to_twist()
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.enclose_kinematics(t).to_twist_rate()
    }

    fn domain(&self) -> Interval {
        self.outer.domain().intersection(self.inner.domain())
    }

    fn smooth_until(&self, t: f64) -> Option<f64> {
        let ends = [self.outer.smooth_until(t), self.inner.smooth_until(t)];
        ends.into_iter().flatten().min_by(f64::total_cmp)
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.enclose_state_about(t, DVec3::ZERO)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.enclose_kinematics(Interval::point(t)).state_about(origin)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        self.outer.enclose_kinematics(t).then(&self.inner.enclose_kinematics(t))
    }
}

/// A smooth motion at another pace: at time t where the given one is at `rate·t + offset`.
///
/// A negative rate runs it backwards. Motions with joints are refused: their joints would fall between two doubles (retime
/// [`Keyframes`](crate::Keyframes) and the values of a [`Chain`](crate::Chain) instead).
///
/// ```
/// use d2m_motion::{ConstantTwist, Retimed, RigidMotion};
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_linear_velocity(-DVec3::Z);
/// let rising = Retimed::try_reversed(falling, 0.0, 2.0)?;
/// let (pose, twist) = rising.pose_and_twist(0.5);
/// assert_eq!((pose.translation, twist.linear), (DVec3::Z * -1.5, DVec3::Z));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Retimed<M> {
    motion: M,
    rate: f64,
    offset: f64,
}

impl<M: RigidMotion> Retimed<M> {
    /// At time t where `motion` is at `rate·t + offset`.
    ///
    /// # Errors
    /// A rate that is zero or not finite, an offset that is not finite, a motion with joints.
    pub fn try_new(motion: M, rate: f64, offset: f64) -> Result<Self, MotionError> {
        if !(rate.is_finite() && rate != 0.0) {
            return Err(fault("rate".into(), format!("{rate} is not a finite number other than zero")));
        }
        if !offset.is_finite() {
            return Err(fault("offset".into(), format!("{offset} is not finite")));
        }
        let (start, end) = (motion.domain().lo(), motion.domain().hi());
        if let Some(joint) = motion.smooth_until(start).filter(|&joint| joint < end) {
            let reason =
                format!("it has a joint at the time {joint:?}, and only smooth motions can be retimed");
            return Err(fault("motion".into(), reason));
        }
        Ok(Self { motion, rate, offset })
    }

    /// The motion between `start` and `end` run backwards: at t where the given one is at `start + end − t` (the sum
    /// rounded once).
    ///
    /// # Errors
    /// As [`Retimed::try_new`].
    pub fn try_reversed(motion: M, start: f64, end: f64) -> Result<Self, MotionError> {
        Self::try_new(motion, -1.0, start + end)
    }

    /// The given motion's time.
    fn time(&self, t: Interval) -> Interval {
        t * self.rate + Interval::point(self.offset)
    }
}

impl<M: RigidMotion> RigidMotion for Retimed<M> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let (pose, twist) = self.motion.pose_and_twist(self.rate * t + self.offset);
        (pose, Twist { linear: twist.linear * self.rate, angular: twist.angular * self.rate })
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.motion.enclose_pose(self.time(t))
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let twist = self.motion.enclose_twist(self.time(t));
        let rate = Interval::point(self.rate);
        IntervalTwist { linear: twist.linear * rate, angular: twist.angular * rate }
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let twist = self.motion.enclose_twist_rate(self.time(t));
        let square = Interval::point(self.rate).sqr();
        IntervalTwist { linear: twist.linear * square, angular: twist.angular * square }
    }

    fn domain(&self) -> Interval {
        let inner = self.motion.domain();
        if inner.is_entire() {
            return inner;
        }
        // Inwards: the times that certainly lie within.
        let ends = [inner.lo(), inner.hi()].map(|end| {
            if end.is_finite() {
                (Interval::point(end) - Interval::point(self.offset)) / Interval::point(self.rate)
            } else {
                Interval::point(end * self.rate.signum())
            }
        });
        let (first, last) = if self.rate > 0.0 { (ends[0], ends[1]) } else { (ends[1], ends[0]) };
        Interval::try_new(
            if first.is_bounded() { first.hi() } else { f64::NEG_INFINITY },
            if last.is_bounded() { last.lo() } else { f64::INFINITY },
        )
        .unwrap_or(Interval::EMPTY)
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.enclose_state_about(t, DVec3::ZERO)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.enclose_kinematics(Interval::point(t)).state_about(origin)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        let inner = self.motion.enclose_kinematics(self.time(t));
        let once = |ball: crate::Ball| ball.times(self.rate, 0.0);
        Kinematics {
            linear: once(inner.linear),
            angular: once(inner.angular),
            linear_rate: once(once(inner.linear_rate)),
            angular_rate: once(once(inner.angular_rate)),
            ..inner
        }
    }
}
