//! A motion, and times that it is known to cover.

use crate::{IntervalPose, RigidMotion};
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
}

impl core::fmt::Debug for CoveredMotion<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("CoveredMotion").field("span", &self.span).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Chain, ConstantTwist, Joint, JointKind, JointValue, Pose, Twist};
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
}
