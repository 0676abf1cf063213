//! Motions that hide what they are.
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
use std::sync::atomic::{AtomicU32, Ordering};

/// What every motion must say of itself but its enclosed pose, as the motion in the first field says it.
macro_rules! forward_all_but_pose {
    () => {
        fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
            self.0.pose_and_twist(t)
        }
        fn enclose_twist(&self, t: Interval) -> IntervalTwist {
            self.0.enclose_twist(t)
        }
        fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
            self.0.enclose_twist_rate(t)
        }
        fn smooth_until(&self, t: f64) -> Option<f64> {
            self.0.smooth_until(t)
        }
        fn domain(&self) -> Interval {
            self.0.domain()
        }
    };
}

/// A motion known only by what every [`RigidMotion`] must say of itself.
#[derive(Debug, Clone, Copy)]
pub struct Opaque<M>(pub M);

impl<M: RigidMotion> RigidMotion for Opaque<M> {
    forward_all_but_pose!();
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
}

/// As [`Opaque`], and the motion gives its own state at a time.
#[derive(Debug, Clone, Copy)]
pub struct OpaqueWithState<M>(pub M);

impl<M: RigidMotion> RigidMotion for OpaqueWithState<M> {
    forward_all_but_pose!();
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.0.enclose_state(t)
    }
}

/// A constant twist that says so, and of which nothing is known outside of some times.
#[derive(Debug, Clone, Copy)]
pub struct Bounded(pub ConstantTwist, pub Interval);

impl RigidMotion for Bounded {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.0.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist_rate(t)
    }
    fn domain(&self) -> Interval {
        self.1
    }
    fn constant_twist(&self) -> Option<ConstantTwist> {
        Some(self.0)
    }
}

/// As [`OpaqueWithState`], and it counts how often its state is queried.
#[derive(Debug)]
pub struct CountedStates<M>(M, AtomicU32);

impl<M> CountedStates<M> {
    /// Not yet queried.
    pub const fn new(motion: M) -> Self {
        Self(motion, AtomicU32::new(0))
    }

    /// How often its state was queried.
    ///
    /// ```
    /// use d2m_motion::{ConstantTwist, RigidMotion};
    /// let motion = d2m_testing::CountedStates::new(ConstantTwist::REST);
    /// motion.enclose_state(0.5);
    /// assert_eq!(motion.count(), 1);
    /// ```
    pub fn count(&self) -> u32 {
        self.1.load(Ordering::Relaxed)
    }
}

impl<M: RigidMotion> RigidMotion for CountedStates<M> {
    forward_all_but_pose!();
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.enclose_state(t)
    }
}

/// As [`Opaque`], with positions that are enclosed up to an addend only.
#[derive(Debug, Clone, Copy)]
pub struct Blurred<M>(M, IntervalVec3);

impl<M> Blurred<M> {
    /// With `blur`, which must contain zero, added to every enclosed position.
    ///
    /// # Panics
    /// If it does not contain zero: enclosures would be wrong.
    pub fn new(motion: M, blur: IntervalVec3) -> Self {
        assert!([blur.x, blur.y, blur.z].iter().all(|side| side.contains(0.0)), "{blur:?}");
        Self(motion, blur)
    }

    /// By up to `width` either way along each axis.
    ///
    /// ```
    /// use d2m_interval::Interval;
    /// use d2m_motion::{ConstantTwist, RigidMotion};
    /// let blurred = d2m_testing::Blurred::by(ConstantTwist::REST, 0.25);
    /// assert!(blurred.enclose_pose(Interval::ZERO).translation.x.contains(-0.25));
    /// ```
    pub fn by(motion: M, width: f64) -> Self {
        let side = Interval::new(-width, width);
        Self::new(motion, IntervalVec3::new(side, side, side))
    }
}

impl<M: RigidMotion> RigidMotion for Blurred<M> {
    forward_all_but_pose!();
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let pose = self.0.enclose_pose(t);
        IntervalPose { translation: pose.translation + self.1, ..pose }
    }
}
