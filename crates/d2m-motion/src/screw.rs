//! Screw motion: a turn about an axis fixed in space plus a slide along it (Mozzi–Chasles).
use crate::rigid_motion::forward;
use crate::rotation::rotation_vector;
use crate::{ConstantTwist, MotionError, Pose, RigidMotion, Twist};
use glam::DVec3;

/// Sine of half the smallest turn that is given an axis: it lies up to 1e12 displacements away, documented. It refuses and
/// proves nothing.
const LEAST_SINE: f64 = 1e-12;
/// Sine of the angle up to which velocities count as parallel, documented. The motion is used as it is given.
const PARALLEL: f64 = 1e-14;

/// A rotation at constant rate about an axis fixed in space with a translation at constant speed along it.
///
/// It is the [`ConstantTwist`] of a body point on the axis with `v` parallel to `ω`, and is queried as that motion.
/// Without rotation it is a plain translation. `v` equals `pitch·ω` up to one rounding a component; the motion with
/// the rounded `v` is the one that is queried exactly.
///
/// ```
/// use d2m_motion::{Pose, RigidMotion, ScrewMotion};
/// use glam::{DQuat, DVec3};
/// // A quarter turn about the vertical axis through (1, 0, 0), rising by 2, in unit time.
/// let start = Pose::IDENTITY;
/// let turn = DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2);
/// let end = Pose { rotation: turn, translation: DVec3::new(1.0, -1.0, 2.0), at: DVec3::ZERO };
/// let screw = ScrewMotion::try_from_poses(start, end, 0.0, 1.0)?;
/// assert!((screw.axis_point() - DVec3::X).length() < 1e-15);
/// assert!((screw.pitch().unwrap() * std::f64::consts::FRAC_PI_2 - 2.0).abs() < 1e-14);
/// let (pose, _) = screw.pose_and_twist(1.0);
/// assert!((pose.transform_point(DVec3::ZERO) - end.translation).length() < 1e-14);
/// # Ok::<(), d2m_motion::MotionError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ScrewMotion {
    motion: ConstantTwist,
}

impl ScrewMotion {
    /// The screw with the given pose and twist at time `t0`. Every pose and twist has one.
    ///
    /// The twist's linear part is the velocity of the pose's point `at`. Axis: `x + ω × v/|ω|²`; pitch:
    /// `ω·v/|ω|²` (length per radian). Points at a distance r from the axis are placed to a few r·2⁻⁵³, so a motion whose axis is far
    /// away keeps more digits as a [`ConstantTwist`].
    ///
    /// # Errors
    /// A component that is not finite, an orientation that cannot be normalised, or an axis farther away than numbers reach.
    pub fn try_from_twist(pose: Pose, twist: Twist, t0: f64) -> Result<Self, MotionError> {
        let given = ConstantTwist::try_new(pose.translation, pose.rotation, twist.linear, twist.angular)?
            .try_with_at(pose.at)?
            .try_with_reference_time(t0)?;
        let Some(Scaled { vector: w, size }) = Scaled::of(twist.angular) else {
            return Ok(Self { motion: given });
        };
        let square = w.length_squared();
        let arm = w.cross(twist.linear) / square / size;
        let slide = w * (w.dot(twist.linear) / square);
        if !(pose.translation + arm).is_finite() {
            return Err(MotionError::Screw { reason: "its axis is farther away than numbers reach" });
        }
        let at = pose.at + pose.rotation.normalize().conjugate() * arm;
        let motion = given.try_with_at(at)?.with_position(pose.translation + arm).with_linear_velocity(slide);
        Ok(Self { motion })
    }

    /// The screw that takes the start pose at `t0` to the end pose at `t1` by the shorter turn.
    ///
    /// # Errors
    /// A component that is not finite, times not increasing, or a turn so small that its axis is farther than
    /// 1e12 times the displacement (then use a [`ConstantTwist`]).
    pub fn try_from_poses(start: Pose, end: Pose, t0: f64, t1: f64) -> Result<Self, MotionError> {
        if !(t0 < t1 && (t1 - t0).is_finite()) {
            return Err(MotionError::Screw { reason: "the two times must be finite and increasing" });
        }
        let (q0, q1) = (start.rotation.normalize(), end.rotation.normalize());
        let mut turn = q1 * q0.conjugate();
        if turn.w < 0.0 {
            turn = -turn;
        }
        let imaginary = DVec3::new(turn.x, turn.y, turn.z);
        let sine = imaginary.length();
        // The end position of the point that the start pose follows.
        let displacement = q1 * (start.at - end.at) + end.translation - start.translation;
        let span = t1 - t0;
        let place = |at: DVec3, position: DVec3, v: DVec3, w: DVec3| {
            ConstantTwist::try_new(position, start.rotation, v, w)?
                .try_with_at(at)?
                .try_with_reference_time(t0)
        };
        if sine == 0.0 {
            let motion = place(start.at, start.translation, displacement / span, DVec3::ZERO)?;
            return Ok(Self { motion });
        }
        if sine < LEAST_SINE {
            return Err(MotionError::Screw { reason: "the turn is too small to have an axis" });
        }
        let axis = imaginary / sine;
        let along = axis * axis.dot(displacement);
        let across = displacement - along;
        let arm = 0.5 * (across + axis.cross(across) * (turn.w / sine));
        let at = start.at + q0.conjugate() * arm;
        let motion = place(at, start.translation + arm, along / span, rotation_vector(turn) / span)?;
        Ok(Self { motion })
    }

    /// Takes a constant twist that is a screw already: its reference point is on the axis.
    ///
    /// # Errors
    /// If `|v × ω| > 1e-14·|v||ω|`: some fifty units of rounding. The motion that is queried is the given one all the same.
    pub fn try_from_constant_twist(motion: ConstantTwist) -> Result<Self, MotionError> {
        let (v, w) = (motion.linear_velocity(), motion.angular_velocity());
        if v.cross(w).length() > PARALLEL * v.length() * w.length() {
            return Err(MotionError::Screw { reason: "linear and angular velocity are not parallel" });
        }
        Ok(Self { motion })
    }

    /// The motion that is queried.
    pub const fn as_constant_twist(&self) -> &ConstantTwist {
        &self.motion
    }

    /// A world point on the axis (where it crosses at the reference time; the axis is fixed).
    pub const fn axis_point(&self) -> DVec3 {
        self.motion.position()
    }

    /// Unit direction of the axis, along ω; without rotation along v; zero at rest.
    pub fn axis_direction(&self) -> DVec3 {
        let (v, w) = (self.motion.linear_velocity(), self.motion.angular_velocity());
        if w == DVec3::ZERO { v.normalize_or_zero() } else { w.normalize_or_zero() }
    }

    /// Translation per radian of turn, positive for a right-handed screw; `None` without rotation.
    pub fn pitch(&self) -> Option<f64> {
        let (v, w) = (self.motion.linear_velocity(), self.motion.angular_velocity());
        Scaled::of(w).map(|Scaled { vector, size }| v.dot(vector) / vector.length_squared() / size)
    }
}

/// A vector as one whose largest coordinate is one, times a size: squares are not lost to underflow.
struct Scaled {
    vector: DVec3,
    size: f64,
}

impl Scaled {
    /// `None` for zero.
    fn of(v: DVec3) -> Option<Self> {
        let size = v.abs().max_element();
        (size > 0.0).then(|| Self { vector: v / size, size })
    }
}

impl RigidMotion for ScrewMotion {
    forward!(|screw| screw.motion);
}
