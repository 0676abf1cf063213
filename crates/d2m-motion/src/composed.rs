//! A motion inside a moving frame.
use crate::{CertifiedState, Composition, IntervalPose, IntervalTwist, Kinematics, Pose, RigidMotion, Twist};
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

    fn composition(&self) -> Option<Composition<'_>> {
        Some(Composition { outer: &self.outer, inner: &self.inner })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ConstantTwist, Keyframes, Span};

    /// A body that is far away is moved by little: both doubles of its place are kept.
    #[test]
    fn what_is_far_away_is_moved_without_loss() {
        let (far, by) = (DVec3::new(1e6, -3e6, 2e6), DVec3::new(1e-9, 2e-9, -3e-9));
        let pose = |x: f64| Pose { translation: far + DVec3::splat(x), ..Pose::IDENTITY };
        let path = Keyframes::try_new(&[(0.0, pose(0.0)), (1.0, pose(0.7))], Span::Linear).unwrap();
        let moved = Composed::new(ConstantTwist::REST.with_position(by), &path);
        for k in 0..=64 {
            let t = f64::from(k) / 64.0;
            let origin = moved.pose_and_twist(t).0.translation;
            let [alone, state] = [path.enclose_state_about(t, origin), moved.enclose_state_about(t, origin)];
            let known = alone.position_radius + state.position_radius;
            assert!(known < 1e-20 && (state.position - alone.position - by).length() <= known + 1e-23, "{k}");
        }
    }
}
