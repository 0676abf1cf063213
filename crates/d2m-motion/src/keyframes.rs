//! Poses at times, joined by motions of constant twist.
use crate::error::{fault, require_finite};
use crate::rotation::rotation_vector;
use crate::sequence::Sequence;
use crate::{
    CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Kinematics, MotionError, Pose, RigidMotion,
    ScrewMotion, Twist, TwistPiece,
};
use d2m_interval::Interval;
use glam::DVec3;

/// How two neighbouring keyframes are joined.
///
/// ```
/// use d2m_motion::{Keyframes, Pose, RigidMotion, Span};
/// use glam::DVec3;
/// // A quarter of a turn about z, while the origin goes from x = 1 to y = 1.
/// let start = Pose { translation: DVec3::X, ..Pose::IDENTITY };
/// let end = Pose::from_axis_angle(DVec3::Y, DVec3::Z, std::f64::consts::FRAC_PI_2);
/// let halfway = |span| {
///     let path = Keyframes::try_new(&[(0.0, start), (1.0, end)], span)?;
///     Ok::<_, d2m_motion::MotionError>(path.pose_and_twist(0.5).0.transform_point(DVec3::ZERO))
/// };
/// assert!((halfway(Span::Linear)?.length() - 0.5f64.sqrt()).abs() < 1e-12); // on the chord
/// assert!((halfway(Span::Screw)?.length() - 1.0).abs() < 1e-12); // on the arc about the origin
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Span {
    /// The reference point moves on a straight line while the body turns about it at a constant rate.
    #[default]
    Linear,
    /// The screw that joins the poses.
    ///
    /// The axis of a small turn θ is about chord/θ away, and its place is rounded. Where that outweighs the bend of the arc,
    /// below about 8e-8 rad, the span is [`Span::Linear`]. Either way the motion, which is what queries are certified for,
    /// passes through the poses and stays by the exact screw to within 5e-8 of the chord (the way of the reference point)
    /// and the rounding of its coordinates; from 1e-4 rad on to within 5e-11 of the chord.
    Screw,
}

/// The motion between two neighbouring keyframes.
///
/// ```
/// use d2m_motion::{Keyframes, Pose, Span};
/// use glam::DVec3;
/// let at = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
/// let path = Keyframes::try_new(&[(0.0, at(0.0)), (1.0, at(2.0)), (3.0, at(0.0))], Span::Linear)?;
/// let back = path.span_at(2.0).expect("the path covers this time");
/// assert_eq!((back.start, back.end, back.motion.linear_velocity()), (1.0, 3.0, DVec3::NEG_X));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct KeyframeSpan<'a> {
    /// The time of the first keyframe.
    pub start: f64,
    /// The time of the second keyframe.
    pub end: f64,
    /// The motion from the first to the second.
    pub motion: &'a ConstantTwist,
}

/// Part of the body's size plus the distance moved up to which two spans that do not meet count as rounded; and the angle
/// (radians) up to which their rotations do.
///
/// ```
/// use d2m_motion::{ConstantTwist, Keyframes, LARGEST_GAP};
/// use glam::DVec3;
/// let at = |x: f64| ConstantTwist::REST.with_position(DVec3::X * x);
/// let spans = |gap: f64| Keyframes::try_from_spans(vec![0.0, 1.0, 2.0], vec![at(1.0), at(1.0 + gap)]);
/// assert!(spans(0.1 * LARGEST_GAP).is_ok() && spans(1e-3).is_err());
/// ```
pub const LARGEST_GAP: f64 = 1e-9;
/// A quaternion product of two unit quaternions rounds by less than this in each component: five roundings in each factor's
/// normalisation and four products that are added, of numbers whose squares sum to 1.
const PRODUCT_ROUNDING: f64 = 16.0 * 0.5 * f64::EPSILON;

/// Poses at increasing times, each span between two of them a motion of constant twist.
///
/// The motion is continuous up to rounding (a span ends within a few units in the last place of the next pose, or within
/// [`LARGEST_GAP`] where spans were given) and its twist jumps at the keyframes, which are its joints as a [`RigidMotion`].
/// At a keyframe the pose of the span before it belongs to the time before, that of the span after it to the time after.
///
/// ```
/// use d2m_motion::{Keyframes, Pose, RigidMotion, Span};
/// use glam::DVec3;
/// let at = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
/// let path = Keyframes::try_new(&[(0.0, at(0.0)), (1.0, at(2.0)), (3.0, at(0.0))], Span::Linear)?;
/// assert_eq!(path.spans().count(), 2);
/// assert_eq!(path.pose_and_twist(2.0).0.translation, DVec3::X);
/// assert_eq!((path.smooth_until(0.5), path.smooth_until(1.0)), (Some(1.0), None));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Keyframes {
    spans: Sequence<ConstantTwist>,
    widest: Option<WidestGap>,
}

/// The joint whose gap counts as rounding only for the largest body.
#[derive(Debug, Clone, Copy, PartialEq)]
struct WidestGap {
    index: usize,
    gap: f64,
    moved: f64,
}

impl Keyframes {
    /// Joins poses at strictly increasing times.
    ///
    /// # Errors
    /// Fewer than two keyframes, times not finite or not increasing, a pose that is no pose, or a turn of half a circle
    /// between two poses, which has no short way round.
    pub fn try_new(keyframes: &[(f64, Pose)], span: Span) -> Result<Self, MotionError> {
        let times: Vec<f64> = keyframes.iter().map(|(time, _)| *time).collect();
        check_times(&times)?;
        for (index, (_, pose)) in keyframes.iter().enumerate() {
            check_pose(pose).map_err(|error| error.within(&format!("poses[{index}]")))?;
        }
        let pieces = keyframes
            .windows(2)
            .enumerate()
            .map(|(index, pair)| {
                let ((t0, start), (t1, end)) = (pair[0], pair[1]);
                if is_half_turn(&start, &end) {
                    return Err(MotionError::HalfTurn { index: index + 1, time: t1 });
                }
                let linear = join_linear(start, end, t0, t1)?;
                Ok(match span {
                    Span::Linear => linear,
                    Span::Screw => join_screw(start, end, [t0, t1]).unwrap_or(linear),
                })
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { spans: Sequence { times, pieces }, widest: None })
    }

    /// Puts spans together; `motions[i]` runs from `times[i]` to `times[i + 1]`.
    ///
    /// Spans have to meet. What counts as rounding depends on the body ([`Keyframes::check_size`]); as long as that is not
    /// known, its coordinates stand for its size.
    ///
    /// # Errors
    /// Times not finite or not increasing, or not one more than motions; spans that do not meet.
    pub fn try_from_spans(times: Vec<f64>, motions: Vec<ConstantTwist>) -> Result<Self, MotionError> {
        check_times(&times)?;
        if times.len() != motions.len() + 1 {
            let reason = format!("{} times for {} spans: one more is needed", times.len(), motions.len());
            return Err(fault("times".into(), reason));
        }
        let mut path = Self { spans: Sequence { times, pieces: motions }, widest: None };
        path.find_gaps()?;
        Ok(path)
    }

    /// Measures the gaps at all joints, refuses those that are rounding for no body and keeps the one that is for the largest only.
    fn find_gaps(&mut self) -> Result<(), MotionError> {
        let Sequence { times, pieces } = &self.spans;
        let mut moved = 0.0;
        let mut widest: Option<(f64, WidestGap)> = None;
        for index in 1..pieces.len() {
            let (time, before, after) = (times[index], &pieces[index - 1], &pieces[index]);
            let v = before.linear_velocity().length();
            moved +=
                (v + before.angular_velocity().length() * before.at().length()) * (time - times[index - 1]);
            let [p, q] = [before, after].map(|motion| {
                Kinematics::following(&motion.enclose_kinematics(Interval::point(time)), DVec3::ZERO)
            });
            let turn = (p.rotation + q.rotation * -1.0).to_cols_array().iter().map(|x| x * x).sum::<f64>();
            // The Frobenius norm of a difference of rotations by a small angle is √2 of it.
            let angle = (0.5 * turn).sqrt() - p.rotation_radius - q.rotation_radius;
            let error = |quantity, gap, allowed| MotionError::Gap { index, time, quantity, gap, allowed };
            // Also what is no number is refused.
            if angle.is_nan() || angle > LARGEST_GAP {
                return Err(error("rotation", angle, LARGEST_GAP));
            }
            let apart = (p.position.center - q.position.center) + (p.position_tail - q.position_tail);
            let gap = apart.length() - p.position.radius - q.position.radius;
            let coordinates = [before, after].map(|m| m.position().length().max(m.at().length()));
            let allowed = LARGEST_GAP * (coordinates[0].max(coordinates[1]) + moved);
            if gap.is_nan() || gap > allowed {
                return Err(error("position", gap, allowed));
            }
            let size = gap / LARGEST_GAP - moved;
            if size > 0.0 && widest.is_none_or(|(largest, _)| size > largest) {
                widest = Some((size, WidestGap { index, gap, moved }));
            }
        }
        self.widest = widest.map(|(_, gap)| gap);
        Ok(())
    }

    /// Do the spans meet, for a body of this size (a length)? Gaps of at most [`LARGEST_GAP`] of the size plus the distance
    /// moved until then are rounding.
    ///
    /// # Errors
    /// The joint with the widest gap.
    pub fn check_size(&self, size: f64) -> Result<(), MotionError> {
        let Some(WidestGap { index, gap, moved }) = self.widest else { return Ok(()) };
        let allowed = LARGEST_GAP * (size + moved);
        if gap <= allowed {
            return Ok(());
        }
        Err(MotionError::Gap { index, time: self.spans.times[index], quantity: "position", gap, allowed })
    }

    /// The keyframe times, increasing.
    pub fn times(&self) -> &[f64] {
        &self.spans.times
    }

    /// The motions of the spans, one fewer than times.
    pub fn motions(&self) -> &[ConstantTwist] {
        &self.spans.pieces
    }

    /// Every span, in the order of time.
    pub fn spans(&self) -> impl Iterator<Item = KeyframeSpan<'_>> {
        (0..self.spans.pieces.len()).map(|index| self.span(index))
    }

    /// The span that holds time `t` (the later one at a keyframe), or `None` outside.
    ///
    /// ```
    /// use d2m_motion::{Keyframes, Pose, Span};
    /// use glam::DVec3;
    /// let at = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
    /// let path = Keyframes::try_new(&[(0.0, at(0.0)), (1.0, at(2.0)), (3.0, at(0.0))], Span::Linear)?;
    /// let span = path.span_at(1.5).unwrap();
    /// assert_eq!((span.start, span.end), (1.0, 3.0));
    /// assert_eq!(span.motion.linear_velocity(), -DVec3::X);
    /// assert!(path.span_at(3.5).is_none());
    /// # Ok::<(), d2m_motion::MotionError>(())
    /// ```
    pub fn span_at(&self, t: f64) -> Option<KeyframeSpan<'_>> {
        self.domain().contains(t).then(|| self.span(self.spans.index_from(t)))
    }

    fn span(&self, index: usize) -> KeyframeSpan<'_> {
        let Sequence { times, pieces } = &self.spans;
        KeyframeSpan { start: times[index], end: times[index + 1], motion: &pieces[index] }
    }

    /// The reference point of all spans.
    fn at(&self) -> DVec3 {
        self.spans.pieces[0].at()
    }
}

impl RigidMotion for Keyframes {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let (pose, twist) = self.spans.piece_from(t).pose_and_twist(t);
        let at = self.at();
        let arm = pose.rotation * (at - pose.at);
        let translation = pose.translation + arm;
        (Pose { translation, at, ..pose }, Twist { linear: twist.velocity_of(arm), ..twist })
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let at = self.at();
        let one = |motion: &ConstantTwist, t: Interval| {
            let pose = motion.enclose_pose(t);
            IntervalPose { translation: pose.enclose_point(at), at, ..pose }
        };
        self.spans.over(t, one, IntervalPose::hull)
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let twist = |motion: &ConstantTwist, t| motion.enclose_kinematics(t).following(self.at()).to_twist();
        self.spans.over(t, twist, IntervalTwist::hull)
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let rate =
            |motion: &ConstantTwist, t| motion.enclose_kinematics(t).following(self.at()).to_twist_rate();
        self.spans.over(t, rate, IntervalTwist::hull)
    }

    fn domain(&self) -> Interval {
        self.spans.domain()
    }

    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.spans.next_joint(t)
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.enclose_state_about(t, DVec3::ZERO)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.enclose_kinematics(Interval::point(t)).state_about(origin)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        let place = |motion: &ConstantTwist, t| motion.enclose_kinematics(t).following(self.at());
        self.spans.over(t, place, |a, b| a.hull(&b))
    }

    fn constant_twist_from(&self, t: f64) -> Option<TwistPiece> {
        let motion = *self.spans.piece_from(t);
        Some(TwistPiece { motion, until: self.smooth_until(t) })
    }
}

fn check_times(times: &[f64]) -> Result<(), MotionError> {
    let error = |index: usize, reason| Err(MotionError::Keyframes { index, time: times[index], reason });
    if times.len() < 2 {
        return Err(fault("times".into(), format!("there are {}, and at least two are needed", times.len())));
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

fn check_pose(pose: &Pose) -> Result<(), MotionError> {
    require_finite("at", &pose.at.to_array())?;
    ConstantTwist::try_new(pose.translation, pose.rotation, DVec3::ZERO, DVec3::ZERO).map(|_| ())
}

/// Does the turn from one pose to the other have the scalar part zero, up to the rounding of the quaternions?
fn is_half_turn(start: &Pose, end: &Pose) -> bool {
    let turn = end.rotation.normalize() * start.rotation.normalize().conjugate();
    turn.w.abs() <= PRODUCT_ROUNDING
}

fn join_linear(start: Pose, end: Pose, t0: f64, t1: f64) -> Result<ConstantTwist, MotionError> {
    let span = t1 - t0;
    let arrival = end.rotation.normalize() * (start.at - end.at) + end.translation;
    let turn = end.rotation.normalize() * start.rotation.normalize().conjugate();
    let [v, w] = [arrival - start.translation, rotation_vector(turn)].map(|way| way / span);
    ConstantTwist::try_new(start.translation, start.rotation, v, w)?
        .try_with_at(start.at)?
        .try_with_reference_time(t0)
}

/// The screw between two poses; `None` where the line is closer to it than its rounding.
///
/// An axis at the distance d moves the body by some units in the last place of d, and the arc of a small turn θ over the
/// chord c is c·θ/8 away from it.
fn join_screw(start: Pose, end: Pose, [t0, t1]: [f64; 2]) -> Option<ConstantTwist> {
    let screw = *ScrewMotion::try_from_poses(start, end, t0, t1).ok()?.as_constant_twist();
    let angle = screw.angular_velocity().length() * (t1 - t0);
    let chord = (end.transform_point(start.at) - start.translation).length();
    let arm = (screw.at() - start.at).length();
    (4.0 * f64::EPSILON * arm <= chord * angle / 8.0 || chord == 0.0 || angle == 0.0).then_some(screw)
}
