//! A link of an articulated arm: fixed transforms and joints whose values are functions of time.
use crate::error::fault;
use crate::joint::Wanted;
use crate::{
    CertifiedState, IntervalPose, IntervalTwist, Joint, JointKind, Kinematics, MotionError, Pose,
    RigidMotion, Twist,
};
use d2m_interval::Interval;
use glam::DVec3;

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
        let mut chain = Self { joints: Vec::with_capacity(joints.len()), domain: Interval::ENTIRE };
        for joint in joints {
            chain.push(joint)?;
        }
        Ok(chain)
    }

    /// The link that one more joint carries.
    ///
    /// # Errors
    /// The joint's value has no time in common with those before.
    pub fn and(&self, joint: Joint) -> Result<Self, MotionError> {
        let mut chain = self.clone();
        chain.push(joint)?;
        Ok(chain)
    }

    fn push(&mut self, joint: Joint) -> Result<(), MotionError> {
        if let Some(value) = joint.value() {
            let (before, own) = (self.domain, value.domain());
            self.domain = before.intersection(own);
            if self.domain.is_empty() {
                let reason = format!(
                    "its times from {:?} to {:?} have none in common with those of the joints before, {:?} to {:?}",
                    own.lo(),
                    own.hi(),
                    before.lo(),
                    before.hi()
                );
                return Err(fault(format!("chain[{}], value", self.joints.len()), reason));
            }
        }
        self.joints.push(joint);
        Ok(())
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
        let placed = |joint: &Joint| joint.placed(lo, hi, Wanted::Rates);
        self.fold(placed, |frame, inner| frame.then_with::<true>(&inner))
    }

    /// At one time, without accelerations.
    fn state_at(&self, t: f64) -> Kinematics {
        self.fold(|joint| joint.placed(t, t, Wanted::Twist), |frame, inner| frame.then_with::<false>(&inner))
    }

    /// The pose alone.
    fn pose_over(&self, lo: f64, hi: f64) -> Kinematics {
        self.fold(|joint| joint.placed(lo, hi, Wanted::Pose), |frame, inner| frame.then_pose(&inner))
    }

    /// From the base to the link; at rest without joints.
    #[inline]
    fn fold(
        &self,
        placed: impl Fn(&Joint) -> Kinematics,
        then: impl Fn(&Kinematics, Kinematics) -> Kinematics,
    ) -> Kinematics {
        let mut joints = self.joints.iter();
        let first = joints.next().map_or(Kinematics::REST, &placed);
        joints.fold(first, |frame, joint| then(&frame, placed(joint)))
    }

    /// A span in parts in each of which the link turns by little.
    fn parts(&self, t: Interval) -> impl Iterator<Item = Interval> + '_ {
        /// Radians either way from the middle of a part.
        const LITTLE: f64 = 0.25;
        /// Most parts.
        const MANY: f64 = 64.0;
        let inside = t.intersection(self.domain);
        let (lo, hi) = if inside.is_empty() { (t.lo(), t.hi()) } else { (inside.lo(), inside.hi()) };
        let turn: f64 = if t.width() > 0.0 {
            let angular = |joint: &Joint| match joint.kind() {
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
        (0..count as usize).map(move |i| Interval::new(end(i as f64), end((i + 1) as f64)))
    }
}

impl RigidMotion for Chain {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let now = self.state_at(t);
        (now.middle_pose(), Twist { linear: now.linear.center, angular: now.angular.center })
    }

    /// Over long spans part by part.
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.parts(t)
            .map(|part| self.pose_over(part.lo(), part.hi()).to_pose())
            .reduce(IntervalPose::hull)
            .expect("at least one part")
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.parts(t)
            .map(|part| self.enclose_kinematics(part).to_twist())
            .reduce(IntervalTwist::hull)
            .expect("at least one part")
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.parts(t)
            .map(|part| self.enclose_kinematics(part).to_twist_rate())
            .reduce(IntervalTwist::hull)
            .expect("at least one part")
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
