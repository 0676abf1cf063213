//! Poses at times, joined by motions of constant twist.
use crate::error::require_finite;
use crate::{ConstantTwist, MotionError, Pose, RigidMotion, ScrewMotion, Twist};
use glam::DVec3;

/// How two neighbouring keyframes are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Span {
    /// The followed point moves on a straight line while the body turns about it at a constant rate.
    #[default]
    Linear,
    /// The screw that joins the poses; spans that turn too little to have an axis are [`Span::Linear`].
    Screw,
}

/// Poses at increasing times, each span between two of them a motion of constant twist.
///
/// The motion is continuous up to rounding (a span ends within a few units in the last place of the next pose) but
/// its twist jumps, so it is no [`RigidMotion`]: query it span by span, through [`Keyframes::spans`].
///
/// ```
/// use d2m_motion::{Keyframes, Pose, Span};
/// use glam::DVec3;
/// let at = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
/// let path = Keyframes::try_new(&[(0.0, at(0.0)), (1.0, at(2.0)), (3.0, at(0.0))], Span::Linear)?;
/// assert_eq!(path.spans().count(), 2);
/// assert_eq!(path.pose_and_twist(2.0).unwrap().0.translation, DVec3::X);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Keyframes {
    times: Vec<f64>,
    motions: Vec<ConstantTwist>,
}

impl Keyframes {
    /// Joins poses at strictly increasing times.
    ///
    /// # Errors
    /// Fewer than two keyframes, times not finite or not increasing, or a pose that is no pose.
    pub fn try_new(keyframes: &[(f64, Pose)], span: Span) -> Result<Self, MotionError> {
        let times: Vec<f64> = keyframes.iter().map(|(time, _)| *time).collect();
        check_times(&times)?;
        let motions = keyframes
            .windows(2)
            .map(|pair| {
                let ((t0, start), (t1, end)) = (pair[0], pair[1]);
                require_finite("position", &end.translation.to_array())?;
                if span == Span::Screw
                    && let Ok(screw) = ScrewMotion::try_from_poses(start, end, t0, t1)
                {
                    return Ok(*screw.as_linear());
                }
                join_linear(start, end, t0, t1)
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { times, motions })
    }

    /// Puts spans together; `motions[i]` runs from `times[i]` to `times[i + 1]`.
    ///
    /// # Errors
    /// Times not finite or not increasing, or not one more than motions.
    pub fn try_from_spans(times: Vec<f64>, motions: Vec<ConstantTwist>) -> Result<Self, MotionError> {
        check_times(&times)?;
        if times.len() != motions.len() + 1 {
            let reason = "there must be one more time than spans";
            return Err(MotionError::Keyframes { index: motions.len(), time: f64::NAN, reason });
        }
        Ok(Self { times, motions })
    }

    /// The keyframe times, increasing.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The motions of the spans, one fewer than times.
    pub fn motions(&self) -> &[ConstantTwist] {
        &self.motions
    }

    /// Every span as (start time, end time, motion).
    pub fn spans(&self) -> impl Iterator<Item = (f64, f64, &ConstantTwist)> {
        self.times.windows(2).zip(&self.motions).map(|(times, motion)| (times[0], times[1], motion))
    }

    /// The span that holds time `t` (the later one at a keyframe), or `None` outside.
    pub fn span_at(&self, t: f64) -> Option<(f64, f64, &ConstantTwist)> {
        let index = self.times.partition_point(|&time| time <= t).min(self.motions.len()).checked_sub(1)?;
        let (start, end) = (self.times[index], self.times[index + 1]);
        (t <= end).then(|| (start, end, &self.motions[index]))
    }

    /// Pose and twist at a time inside the keyframes, in plain floating point.
    pub fn pose_and_twist(&self, t: f64) -> Option<(Pose, Twist)> {
        self.span_at(t).map(|(_, _, motion)| motion.pose_and_twist(t))
    }
}

fn check_times(times: &[f64]) -> Result<(), MotionError> {
    let error = |index: usize, reason| {
        Err(MotionError::Keyframes { index, time: times.get(index).copied().unwrap_or(f64::NAN), reason })
    };
    if times.len() < 2 {
        return error(times.len(), "at least two keyframes are needed");
    }
    for (index, time) in times.iter().enumerate() {
        if !time.is_finite() {
            return error(index, "the time is not finite");
        }
        if index > 0 && times[index - 1] >= *time {
            return error(index, "times must increase");
        }
    }
    Ok(())
}

fn join_linear(start: Pose, end: Pose, t0: f64, t1: f64) -> Result<ConstantTwist, MotionError> {
    let span = t1 - t0;
    let place = |w: DVec3| {
        let arrival = end.rotation.normalize() * (start.at - end.at) + end.translation;
        ConstantTwist::try_new(start.translation, start.rotation, (arrival - start.translation) / span, w)?
            .try_with_at(start.at)?
            .try_with_reference_time(t0)
    };
    // The turn comes from the screw of the pure rotations, so there is one formula for it.
    let turning = |pose: Pose| Pose { translation: DVec3::ZERO, at: DVec3::ZERO, ..pose };
    if let Ok(screw) = ScrewMotion::try_from_poses(turning(start), turning(end), t0, t1) {
        return place(screw.as_linear().angular_velocity());
    }
    // Below 1e-12 rad the vector part is half the turn to full precision.
    let mut turn = end.rotation.normalize() * start.rotation.normalize().conjugate();
    if turn.w < 0.0 {
        turn = -turn;
    }
    place(DVec3::new(turn.x, turn.y, turn.z) * (2.0 / span))
}
