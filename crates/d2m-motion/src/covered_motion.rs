//! A motion, and times that it is known to cover.

use crate::ball::{length_up, up};
use crate::{Ball, IntervalPose, RigidMotion, SpanMotion};
use d2m_interval::Interval;

/// A motion does not cover the times that a query needs.
///
/// ```
/// use d2m_motion::{CoveredMotion, Keyframes, Pose, Span};
/// let motion = Keyframes::try_new(&[(0.0, Pose::IDENTITY), (1.0, Pose::IDENTITY)], Span::Linear)?;
/// let outside = CoveredMotion::try_new(&motion, 0.5, 2.0).unwrap_err();
/// assert_eq!((outside.start, outside.end, outside.to), (0.0, 1.0, 2.0));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the motion covers the times from {start:?} to {end:?}, not the whole window from {from:?} to {to:?}"
)]
pub struct OutsideDomain {
    /// First time of the motion; NaN if it covers none.
    pub start: f64,
    /// Last time of the motion; NaN if it covers none.
    pub end: f64,
    /// First time that was wanted.
    pub from: f64,
    /// Last time that was wanted.
    pub to: f64,
}

/// A motion with a span of times that lies within its [`RigidMotion::domain`].
///
/// Outside of its domain a motion promises nothing, so that a query which goes there proves nothing. Only
/// [`Self::try_new`] makes one of these, and every query of moving bodies takes one: none can forget to look.
///
/// ```
/// use d2m_motion::{CoveredMotion, Keyframes, Pose, Span};
/// let motion = Keyframes::try_new(&[(0.0, Pose::IDENTITY), (1.0, Pose::IDENTITY)], Span::Linear)?;
/// assert!(CoveredMotion::try_new(&motion, 0.0, 1.0).is_ok());
/// let outside = CoveredMotion::try_new(&motion, 0.5, 2.0).unwrap_err();
/// assert_eq!([outside.start, outside.end, outside.from, outside.to], [0.0, 1.0, 0.5, 2.0]);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Clone, Copy)]
#[must_use]
pub struct CoveredMotion<'m> {
    motion: &'m dyn RigidMotion,
    span: Interval,
}

impl<'m> CoveredMotion<'m> {
    /// The motion over the times from `from` to `to`, both included.
    ///
    /// # Errors
    /// [`OutsideDomain`] where the motion does not cover both, or one of them is not a number.
    pub fn try_new(motion: &'m dyn RigidMotion, from: f64, to: f64) -> Result<Self, OutsideDomain> {
        let domain = motion.domain();
        if domain.contains(from) && domain.contains(to) && from <= to {
            Ok(Self { motion, span: Interval::new(from, to) })
        } else {
            Err(OutsideDomain { start: domain.lo(), end: domain.hi(), from, to })
        }
    }

    /// The motion.
    pub const fn motion(self) -> &'m dyn RigidMotion {
        self.motion
    }

    /// The times.
    pub const fn span(self) -> Interval {
        self.span
    }

    /// Of the span what lies from `from` to `to`, both included; none if that is nothing.
    pub fn part(self, from: f64, to: f64) -> Option<Self> {
        let span = self.span.intersection(Interval::new(from, to));
        (!span.is_empty()).then_some(Self { span, ..self })
    }

    /// Encloses the pose over the whole span.
    pub fn enclose_pose(self) -> IntervalPose {
        self.motion.enclose_pose(self.span)
    }

    /// Pose and velocities, with the pose in `middle`, which is a time of the span; `None` where pieces of the motion meet
    /// inside the span, or nothing is known.
    pub fn span_motion(self, middle: f64) -> Option<SpanMotion> {
        let (span, of) = (self.span, self.motion);
        if of.smooth_until(span.lo()).is_some_and(|end| end.is_nan() || end < span.hi()) {
            return None;
        }
        let (now, over) = (of.enclose_state(middle), of.enclose_kinematics(span));
        if now.at != over.at {
            return None;
        }
        // The column norms bound the operator norm together.
        let turned = over.rotation + now.rotation * -1.0;
        let [x, y, z] = [turned.x_axis, turned.y_axis, turned.z_axis].map(length_up);
        let moved = Ball::point(over.position.center) - Ball::point(now.position)
            + Ball::new(over.position_tail, over.position.radius);
        let seen = SpanMotion {
            rotation: now.rotation,
            rotation_radius: now.rotation_radius,
            rotation_spread: up(over.rotation_radius + up(x + y + z)).max(now.rotation_radius),
            position: Ball::new(now.position, now.position_radius),
            position_spread: moved.bound_length().max(now.position_radius),
            linear: over.linear,
            angular: over.angular,
        };
        let is_known = seen.rotation_spread + seen.position_spread < f64::INFINITY;
        is_known.then(|| seen.following(-now.at))
    }
}

impl core::fmt::Debug for CoveredMotion<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("CoveredMotion").field("span", &self.span).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Chain, ConstantTwist, Joint, JointKind, JointPoints, JointValue, Pose, Twist};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::{DQuat, DVec3};

    /// Covers no time at all.
    struct Never;

    impl RigidMotion for Never {
        fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
            ConstantTwist::REST.pose_and_twist(t)
        }
        fn enclose_pose(&self, t: Interval) -> IntervalPose {
            ConstantTwist::REST.enclose_pose(t)
        }
        fn enclose_twist(&self, t: Interval) -> crate::IntervalTwist {
            ConstantTwist::REST.enclose_twist(t)
        }
        fn enclose_twist_rate(&self, t: Interval) -> crate::IntervalTwist {
            ConstantTwist::REST.enclose_twist_rate(t)
        }
        fn domain(&self) -> Interval {
            Interval::EMPTY
        }
    }

    #[test]
    fn only_times_within_the_domain_are_covered() {
        let value = JointValue::try_pieces(vec![0.0, 1.0], vec![vec![0.0, 1.0]]).unwrap();
        let kind = JointKind::Prismatic { axis: DVec3::X, value };
        let chain =
            Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap();
        let (before, after) = (0.0_f64.next_down(), 1.0_f64.next_up());
        for (from, to, covered) in [
            (0.0, 1.0, true),
            (1.0, 1.0, true),
            (before, 1.0, false),
            (0.0, after, false),
            (2.0, 3.0, false),
            (0.6, 0.4, false),
            (f64::NAN, 1.0, false),
            (0.0, f64::NAN, false),
            (f64::NEG_INFINITY, f64::INFINITY, false),
        ] {
            assert_eq!(CoveredMotion::try_new(&chain, from, to).is_ok(), covered, "{from} {to}");
            assert!(CoveredMotion::try_new(&Never, from, to).is_err(), "{from} {to}");
            let always = CoveredMotion::try_new(&ConstantTwist::REST, from, to).is_ok();
            assert_eq!(always, from <= to && from.is_finite() && to.is_finite(), "{from} {to}");
        }
        let covered = CoveredMotion::try_new(&chain, 0.0, 1.0).unwrap();
        assert_eq!(covered.part(-1.0, 0.25).unwrap().span(), Interval::new(0.0, 0.25));
        assert_eq!(covered.part(0.5, 9.0).unwrap().span(), Interval::new(0.5, 1.0));
        assert!(covered.part(1.5, 9.0).is_none());
        let reached = covered.enclose_pose().translation.x;
        assert!(reached.contains(0.0) && reached.contains(1.0) && reached.hi() < 1.0 + 1e-9);
    }

    /// At samples of the span: where the origin is, how it is turned, and that both lie where the span says.
    fn check(seen: &SpanMotion, span: Interval, middle: f64, pose: impl Fn(f64) -> Pose) {
        for k in 0..=20 {
            let t = (span.lo() + span.width() * f64::from(k) / 20.0).clamp(span.lo(), span.hi());
            let pose = pose(t);
            let place = pose.transform_point(DVec3::ZERO);
            let tiny = 1e-13;
            let way = seen.linear.center * (t - middle);
            let off = place - (seen.position.center + way);
            assert!(off.length() <= seen.position.radius + (t - middle).abs() * seen.linear.radius + tiny);
            assert!((place - seen.position.center).length() <= seen.position_spread + tiny);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let off = pose.transform_vector(axis) - seen.rotation * axis;
                assert!(off.length() <= seen.rotation_spread + tiny, "{off:?} {seen:?}");
                if t == middle {
                    assert!(off.length() <= seen.rotation_radius + tiny && seen.rotation_radius < 1e-12);
                }
            }
            if t == middle {
                assert!(way.length() == 0.0 && seen.position.radius < 1e-12);
            }
        }
    }

    #[test]
    fn any_smooth_motion_is_where_its_span_says() {
        let mut random = KnuthRandom(3);
        for _ in 0..50 {
            let at = random.vector();
            let twist = ConstantTwist::REST
                .with_position(random.vector())
                .with_linear_velocity(random.vector())
                .with_angular_velocity(random.vector())
                .with_at(at);
            let value =
                JointValue::try_polynomial(vec![random.unit(), random.unit(), -random.unit()]).unwrap();
            let kind = JointKind::Revolute { axis: random.vector(), value };
            let joint = Joint::try_new(random.vector(), DQuat::IDENTITY, kind).unwrap();
            let chain = Chain::try_new(vec![joint.clone(), joint]).unwrap();
            let span = Interval::new(-0.25, 0.75);
            for motion in [&twist as &dyn RigidMotion, &chain] {
                let covered = CoveredMotion::try_new(motion, span.lo(), span.hi()).unwrap();
                let seen = covered.span_motion(0.25).unwrap();
                check(&seen, span, 0.25, |t| motion.pose_and_twist(t).0);
            }
        }
    }

    #[test]
    fn where_pieces_meet_nothing_is_known_of_any_motion() {
        let points = JointPoints::new(vec![0.0, 1.0, 2.0], vec![0.0, 1.0, -1.0]);
        let kind = JointKind::Prismatic { axis: DVec3::X, value: JointValue::through(points).unwrap() };
        let chain =
            Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap();
        let covered = |from, to| CoveredMotion::try_new(&chain, from, to).unwrap();
        assert!(covered(0.5, 1.5).span_motion(1.0).is_none());
        assert!(covered(0.5, 1.0).span_motion(0.75).is_some());
    }
}
