//! The open trait: any twice differentiable rigid motion that can enclose itself.
use crate::{CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Pose, Twist};
use d2m_interval::{Interval, IntervalVec3};

/// A rigid motion with a continuous acceleration (C²), and proven enclosures of it over intervals of time.
///
/// Promise of an implementation, for every interval `t` inside the domain of the motion:
/// * `enclose_pose(t)` contains the true pose, `enclose_twist(t)` the true twist and `enclose_twist_rate(t)` the
///   true derivative of the twist (acceleration of the followed point, angular acceleration) at every time of `t`;
/// * the enclosures shrink towards the values as `t` shrinks (otherwise queries get slow, never wrong);
/// * the body point `at` is the same at all times;
/// * [`RigidMotion::pose_and_twist`] is the same motion up to rounding. It proves nothing.
///
/// A motion that is only piecewise C² (keyframes) is to be queried span by span.
pub trait RigidMotion: Sync {
    /// Pose and twist at one time, in plain floating point.
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist);

    /// Encloses the pose over an interval of time.
    fn enclose_pose(&self, t: Interval) -> IntervalPose;

    /// Encloses the twist (world axes) over an interval of time.
    fn enclose_twist(&self, t: Interval) -> IntervalTwist;

    /// Encloses the time derivative of the twist (world axes) over an interval of time.
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist;

    /// Pose and twist at one time with proven radii: what first contacts of single features are made of, once for each
    /// time that a search looks at.
    ///
    /// The default takes the middles of the enclosures at `t`, which is right for every motion. A motion that knows
    /// its own rounding can do it in plain floating point ([`ConstantTwist`] does, three times as fast).
    fn enclose_state(&self, t: f64) -> CertifiedState {
        let now = Interval::point(t);
        CertifiedState::from_enclosures(&self.enclose_pose(now), &self.enclose_twist(now))
    }

    /// Bounds the length of the acceleration of every body point within `radius` of `at`, over an interval of
    /// time: `|v′| + (|ω′| + |ω|²)·radius`, rounded up.
    fn bound_acceleration(&self, t: Interval, radius: f64) -> f64 {
        let (twist, rate) = (self.enclose_twist(t), self.enclose_twist_rate(t));
        let length = |v: IntervalVec3| v.norm();
        let spin = length(rate.angular) + length(twist.angular).sqr();
        (length(rate.linear) + spin * Interval::point(radius)).hi()
    }

    /// The same motion as a [`ConstantTwist`] if its twist is constant, for the closed-form tests.
    fn constant_twist(&self) -> Option<ConstantTwist> {
        None
    }
}

impl<M: RigidMotion + ?Sized> RigidMotion for &M {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        (**self).pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        (**self).enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        (**self).enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        (**self).enclose_twist_rate(t)
    }
    fn enclose_state(&self, t: f64) -> CertifiedState {
        (**self).enclose_state(t)
    }
    fn bound_acceleration(&self, t: Interval, radius: f64) -> f64 {
        (**self).bound_acceleration(t, radius)
    }
    fn constant_twist(&self) -> Option<ConstantTwist> {
        (**self).constant_twist()
    }
}
