//! A motion whose positions are moved by a vector of the world.
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{CertifiedState, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
use glam::DVec3;

/// The same motion elsewhere: velocities do not change.
pub(crate) struct Moved<'m> {
    pub(crate) motion: &'m dyn RigidMotion,
    pub(crate) by: DVec3,
}

impl RigidMotion for Moved<'_> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let (mut pose, twist) = self.motion.pose_and_twist(t);
        pose.translation += self.by;
        (pose, twist)
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let pose = self.motion.enclose_pose(t);
        IntervalPose { translation: pose.translation + IntervalVec3::point(self.by), ..pose }
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist(t)
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist_rate(t)
    }

    fn domain(&self) -> Interval {
        self.motion.domain()
    }

    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.motion.smooth_until(t)
    }

    /// Near the origin that is asked for nothing is lost but the rounding of three sums, each half a unit in the last place.
    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        let mut state = self.motion.enclose_state_about(t, origin);
        state.position += self.by;
        let rounding = f64::EPSILON * state.position.abs().element_sum();
        state.position_radius = (state.position_radius + rounding).next_up();
        state
    }
}
