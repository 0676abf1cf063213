//! A motion that hides what it is.
use d2m_interval::Interval;
use d2m_motion::{IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};

/// A motion known only by what every [`RigidMotion`] must say of itself.
#[derive(Debug, Clone, Copy)]
pub struct Opaque<M>(pub M);

impl<M: RigidMotion> RigidMotion for Opaque<M> {
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
}
