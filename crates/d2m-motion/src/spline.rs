//! Smooth motions through poses: cubic and quintic Hermite splines, each span a chain of joints.
use crate::error::fault;
use crate::joint_points::{LONGEST, SHORTEST, is_length};
use crate::rotation::rotation_vector;
use crate::sequence::Sequence;
use crate::{
    CertifiedState, Chain, IntervalPose, IntervalTwist, Joint, JointKind, JointValue, Kinematics,
    MotionError, Pose, RigidMotion, Twist,
};
use d2m_interval::Interval;
use glam::{DQuat, DVec3};

/// How smooth a [`Spline`] is at its poses.
///
/// ```
/// use d2m_motion::{Pose, RigidMotion, Spline, SplineDegree};
/// use glam::DVec3;
/// let at = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
/// let poses = [(0.0, at(0.0)), (1.0, at(1.0)), (2.0, at(4.0))];
/// for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
///     let path = Spline::try_through(&poses, degree)?;
///     assert!((path.pose_and_twist(1.0).0.translation - DVec3::X).length() < 1e-12);
/// }
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum SplineDegree {
    /// Velocities are continuous (C¹), accelerations jump.
    #[default]
    Cubic,
    /// Accelerations are continuous too (C²): they vanish at every pose, against the body itself.
    Quintic,
}

/// A smooth motion through poses at times.
///
/// Between two poses the body origin follows the Hermite polynomial of the velocities at both ends, and the body turns by
/// R₀·∏ exp(\[kᵢ\]βᵢ(u)), with βᵢ the cumulative Bernstein polynomials of the degree and kᵢ chosen so that poses and angular
/// velocities at both ends are the wanted ones. Each span is a [`Chain`] of three prismatic and three or five
/// revolute joints, so everything is enclosed as there.
///
/// ```
/// use d2m_motion::{Pose, RigidMotion, Spline, SplineDegree};
/// use glam::{DQuat, DVec3};
/// let pose = |x: f64, turn: f64| Pose {
///     translation: DVec3::new(x, x * x, 0.0),
///     rotation: DQuat::from_rotation_z(turn),
///     at: DVec3::ZERO,
/// };
/// let path = Spline::try_through(&[(0.0, pose(0.0, 0.0)), (1.0, pose(1.0, 0.5)), (3.0, pose(2.0, 2.0))], SplineDegree::Cubic)?;
/// let (there, _) = path.pose_and_twist(1.0);
/// assert!((there.translation - DVec3::new(1.0, 1.0, 0.0)).length() < 1e-15);
/// assert_eq!(path.smooth_until(0.0), Some(1.0));
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
///
/// Source: M.-J. Kim, M.-S. Kim, S. Y. Shin, "A general construction scheme for unit quaternion curves with simple high order
/// derivatives", SIGGRAPH 1995, DOI 10.1145/218380.218486.
#[derive(Debug, Clone, PartialEq)]
pub struct Spline {
    spans: Sequence<Chain>,
    /// What it goes through, of the body origin: another spline through the same is the same to the last bit.
    knots: Vec<Knot>,
    degree: SplineDegree,
}

/// Where the body origin is at a time of a spline, and how it moves there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Knot {
    pub(crate) pose: Pose,
    pub(crate) twist: Twist,
}

impl Knot {
    fn of_origin(pose: Pose, twist: Twist) -> Self {
        let arm = pose.rotation.normalize() * (DVec3::ZERO - pose.at);
        let linear = twist.velocity_of(arm);
        let pose = Pose { translation: pose.translation + arm, at: DVec3::ZERO, ..pose };
        Self { pose, twist: Twist { linear, ..twist } }
    }
}

impl Spline {
    /// Through poses, with velocities from the neighbours: the weighted mean of the mean velocities before and after (Catmull
    /// and Rom), at the ends that of the only span.
    ///
    /// # Errors
    /// As [`Spline::try_with_twists`].
    pub fn try_through(keyframes: &[(f64, Pose)], degree: SplineDegree) -> Result<Self, MotionError> {
        check(keyframes.iter().map(|(time, pose)| (*time, *pose)))?;
        let mean: Vec<Twist> = keyframes
            .windows(2)
            .map(|pair| {
                let ((t0, start), (t1, end)) = (pair[0], pair[1]);
                let h = t1 - t0;
                let linear = (end.transform_point(DVec3::ZERO) - start.transform_point(DVec3::ZERO)) / h;
                // In the axes of either body, where it is the same.
                let turn = start.rotation.normalize().conjugate() * end.rotation.normalize();
                Twist { linear, angular: rotation_vector(turn) / h }
            })
            .collect();
        let last = mean.len();
        let twists: Vec<(f64, Pose, Twist)> = keyframes
            .iter()
            .enumerate()
            .map(|(i, &(time, pose))| {
                let twist = if i == 0 {
                    mean[0]
                } else if i == last {
                    mean[last - 1]
                } else {
                    let (before, after) = (time - keyframes[i - 1].0, keyframes[i + 1].0 - time);
                    let part = after / (before + after);
                    Twist {
                        linear: mean[i - 1].linear * part + mean[i].linear * (1.0 - part),
                        angular: mean[i - 1].angular * part + mean[i].angular * (1.0 - part),
                    }
                };
                (time, pose, Twist { angular: pose.rotation.normalize() * twist.angular, ..twist })
            })
            .collect();
        Self::try_with_twists(&twists, degree)
    }

    /// Through poses with the given twists there (world axes; the linear part is the velocity of the pose's point `at`).
    ///
    /// # Errors
    /// Fewer than two poses, times not finite, not increasing, or less than 1e-50 or more than 1e50 apart, a pose or twist that is
    /// not finite, or between two poses a turn of half a circle that is left to be made.
    pub fn try_with_twists(
        keyframes: &[(f64, Pose, Twist)],
        degree: SplineDegree,
    ) -> Result<Self, MotionError> {
        check(keyframes.iter().map(|(time, pose, _)| (*time, *pose)))?;
        for (index, (.., twist)) in keyframes.iter().enumerate() {
            for (name, vector) in [("linear", twist.linear), ("angular", twist.angular)] {
                if let Some(value) = vector.to_array().into_iter().find(|value| !value.is_finite()) {
                    return Err(fault(
                        format!("twists[{index}], {name}"),
                        format!("{value:?} is not finite"),
                    ));
                }
            }
        }
        let times: Vec<f64> = keyframes.iter().map(|(time, ..)| *time).collect();
        let knots: Vec<Knot> =
            keyframes.iter().map(|&(_, pose, twist)| Knot::of_origin(pose, twist)).collect();
        let piece = |k: usize| {
            span([times[k], times[k + 1]], [knots[k], knots[k + 1]], degree)
                .map_err(|error| error.within(&format!("poses[{}]", k + 1)))
        };
        let pieces = (0..knots.len() - 1).map(piece).collect::<Result<_, _>>()?;
        Ok(Self { spans: Sequence { times, pieces }, knots, degree })
    }

    /// How smooth it is at its poses.
    pub const fn degree(&self) -> SplineDegree {
        self.degree
    }

    #[cfg(feature = "serde")]
    pub(crate) fn knots(&self) -> &[Knot] {
        &self.knots
    }

    /// The times of the poses.
    pub fn times(&self) -> &[f64] {
        &self.spans.times
    }
}

fn check(keyframes: impl Iterator<Item = (f64, Pose)>) -> Result<(), MotionError> {
    let frames: Vec<(f64, Pose)> = keyframes.collect();
    // The same times and poses that keyframes take.
    crate::Keyframes::try_new(&frames, crate::Span::Linear)?;
    let lengths = frames.windows(2).map(|pair| pair[1].0 - pair[0].0);
    match lengths.enumerate().find(|(_, length)| !is_length(*length)) {
        Some((index, length)) => {
            let reason = format!(
                "{length:?} after the one before: spans of a spline are {SHORTEST:?} to {LONGEST:?} long"
            );
            Err(fault(format!("times[{}]", index + 1), reason))
        }
        None => Ok(()),
    }
}

/// exp of a rotation vector.
fn quaternion(v: DVec3) -> DQuat {
    crate::rotation::quat_of(v, 1.0)
}

/// Coefficients in u of the cumulative Bernstein polynomials Σ_{j ≥ i} C(n, j) u^j (1 − u)^(n − j), i from 1 to n.
fn cumulative(degree: SplineDegree) -> Vec<Vec<f64>> {
    match degree {
        SplineDegree::Cubic => {
            vec![vec![0.0, 3.0, -3.0, 1.0], vec![0.0, 0.0, 3.0, -2.0], vec![0.0, 0.0, 0.0, 1.0]]
        }
        SplineDegree::Quintic => vec![
            vec![0.0, 5.0, -10.0, 10.0, -5.0, 1.0],
            vec![0.0, 0.0, 10.0, -20.0, 15.0, -4.0],
            vec![0.0, 0.0, 0.0, 10.0, -15.0, 6.0],
            vec![0.0, 0.0, 0.0, 0.0, 5.0, -4.0],
            vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
        ],
    }
}

fn span([t0, t1]: [f64; 2], knots: [Knot; 2], degree: SplineDegree) -> Result<Chain, MotionError> {
    let [Knot { pose: start, twist: v0 }, Knot { pose: end, twist: v1 }] = knots;
    let h = t1 - t0;
    let (q0, q1) = (start.rotation.normalize(), end.rotation.normalize());
    let curves = cumulative(degree);
    let n = curves.len() as f64;
    // Over [t0, t1] as polynomials in t − t0.
    let in_time = |scale: f64, u: &[f64]| {
        let mut unit = scale;
        let coefficients = u
            .iter()
            .map(|c| {
                let value = c * unit;
                unit /= h;
                value
            })
            .collect();
        JointValue::try_pieces(vec![t0, t1], vec![coefficients])
    };
    // Positions: control points P0, P0 + v0 h/n (twice for no acceleration), and the same from the end.
    let [(p0, s0), (p1, s1)] = knots.map(|knot| (knot.pose.translation, knot.twist.linear));
    let (first, last) = (s0 * (h / n), s1 * (h / n));
    let steps: Vec<DVec3> = match degree {
        SplineDegree::Cubic => vec![first, p1 - p0 - first - last, last],
        SplineDegree::Quintic => vec![first, first, p1 - p0 - (first + last) * 2.0, last, last],
    };
    let mut joints = Vec::new();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        let mut sum = vec![0.0; curves[0].len()];
        for (step, curve) in steps.iter().zip(&curves) {
            sum.iter_mut().zip(curve).for_each(|(s, c)| *s += step.dot(axis) * c);
        }
        let position = if axis == DVec3::X { p0 } else { DVec3::ZERO };
        joints.push(Joint::try_new(
            position,
            DQuat::IDENTITY,
            JointKind::Prismatic { axis, value: in_time(1.0, &sum)? },
        )?);
    }
    // Turns, in body axes.
    let (first, last) = (q0.conjugate() * v0.angular * (h / n), q1.conjugate() * v1.angular * (h / n));
    let (before, after) = match degree {
        SplineDegree::Cubic => (quaternion(first), quaternion(last)),
        SplineDegree::Quintic => (quaternion(first) * quaternion(first), quaternion(last) * quaternion(last)),
    };
    let left = before.conjugate() * q0.conjugate() * q1 * after.conjugate();
    if left.w.abs() <= 16.0 * f64::EPSILON {
        return Err(fault(
            "rotation".into(),
            "what is left to turn is half a circle, which has no short way round".into(),
        ));
    }
    let middle = rotation_vector(left);
    let turns: Vec<DVec3> = match degree {
        SplineDegree::Cubic => vec![first, middle, last],
        SplineDegree::Quintic => vec![first, first, middle, last, last],
    };
    let mut orientation = q0;
    for (turn, curve) in turns.iter().zip(&curves) {
        let angle = turn.length();
        if angle == 0.0 {
            continue;
        }
        let kind = JointKind::Revolute { axis: *turn, value: in_time(angle, curve)? };
        joints.push(Joint::try_new(DVec3::ZERO, orientation, kind)?);
        orientation = DQuat::IDENTITY;
    }
    if orientation != DQuat::IDENTITY {
        joints.push(Joint::try_new(DVec3::ZERO, orientation, JointKind::Fixed)?);
    }
    Chain::try_new(joints)
}

impl RigidMotion for Spline {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.spans.piece_from(t).pose_and_twist(t)
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.spans.over(t, RigidMotion::enclose_pose, IntervalPose::hull)
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.spans.over(t, RigidMotion::enclose_twist, IntervalTwist::hull)
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.spans.over(t, RigidMotion::enclose_twist_rate, IntervalTwist::hull)
    }

    fn domain(&self) -> Interval {
        self.spans.domain()
    }

    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.spans.next_joint(t)
    }

    fn enclose_state(&self, t: f64) -> CertifiedState {
        self.spans.piece_from(t).enclose_state(t)
    }

    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        self.spans.piece_from(t).enclose_state_about(t, origin)
    }

    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        self.spans.over(t, RigidMotion::enclose_kinematics, |a, b| a.hull(&b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::random_motion;
    use d2m_testing::{Draw, Random};

    #[test]
    fn splines_pass_through_poses_with_their_twists() {
        let mut random = Random(21);
        for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
            for _ in 0..60 {
                let frames: Vec<(f64, Pose, Twist)> = (0..5)
                    .map(|i| {
                        let (pose, _) = random_motion(&mut random, 1.0).pose_and_twist(0.0);
                        let twist = Twist { linear: random.vector(), angular: random.vector() };
                        (f64::from(i) + 0.3 * random.unit(), pose, twist)
                    })
                    .collect();
                let path = Spline::try_with_twists(&frames, degree).unwrap();
                for (i, (time, pose, twist)) in frames.iter().enumerate() {
                    let sides = [*time, if i == 0 { *time } else { time.next_down() }];
                    for t in sides {
                        let state = path.enclose_state(t).following(pose.at);
                        assert!((state.position - pose.translation).length() < 1e-11, "{degree:?} {i}");
                        assert!((state.rotation * DVec3::X - pose.rotation * DVec3::X).length() < 1e-11);
                        assert!(
                            (state.linear - twist.linear).length() < 1e-9,
                            "{degree:?} {i} {}",
                            state.linear
                        );
                        assert!((state.angular - twist.angular).length() < 1e-9);
                    }
                    if degree == SplineDegree::Quintic {
                        let rate = path.enclose_kinematics(Interval::point(*time));
                        assert!(
                            rate.angular_rate.center.length() < 1e-9
                                && rate.linear_rate.center.length() < 1e-9
                        );
                    }
                }
                let (start, end) = (frames[0].0, frames[4].0);
                let faults = crate::check_motion(&path, Interval::new(start, end), 30);
                assert!(faults.is_empty(), "{}", faults[0]);
            }
        }
    }

    #[test]
    fn velocities_come_from_the_neighbours() {
        let frame = |t: f64| (t, Pose { translation: DVec3::new(t * t, 1.0, -t), ..Pose::IDENTITY });
        let path = Spline::try_through(&[frame(0.0), frame(1.0), frame(3.0)], SplineDegree::Cubic).unwrap();
        // Of a parabola the weighted mean of chords is the tangent.
        assert!((path.pose_and_twist(1.0).1.linear - DVec3::new(2.0, 0.0, -1.0)).length() < 1e-14);
        let half = Pose { rotation: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0), ..Pose::IDENTITY };
        let fault = Spline::try_through(&[(0.0, Pose::IDENTITY), (1.0, half)], SplineDegree::Cubic);
        assert!(fault.unwrap_err().to_string().contains("half a circle"));
        assert!(Spline::try_through(&[(0.0, Pose::IDENTITY)], SplineDegree::Cubic).is_err());
    }
}
