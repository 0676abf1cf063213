//! Any of the motions that have a JSON form.
use crate::rigid_motion::forward;
use crate::{Chain, ConstantTwist, Keyframes, MotionError, RigidMotion, ScrewMotion, Spline};

/// A constant twist, keyframes, a spline or a chain: what the JSON forms of motions hold (feature `serde`).
///
/// The JSON forms: `{"x", "q", "v", "w", "at", "t"}`, all optional; `{"times", "poses": [{"x", "q"}, …], "join": "linear" |
/// "screw"}` or `{"times", "spans": [constant twist, …]}`; `{"times", "poses", "join": "cubic" | "quintic"}` for a [`Spline`], with
/// `"twists": [{"v", "w"}, …]` of the body origin at the poses where these are not to follow from the neighbors; `{"chain": [{"x", "q", "joint", "axis", "value"}, …]}` with
/// `joint` one of `fixed`, `revolute`, `prismatic` and `value` a polynomial `[c0, c1, …]`, `{"times", "pieces"}` or
/// `{"times", "positions", "velocities", "accelerations"}` (see [`JointPoints`](crate::JointPoints)); `"rpy"` may stand for `"q"`.
/// Compositions and retimed motions have no JSON form.
#[cfg_attr(feature = "serde", doc = "```")]
#[cfg_attr(not(feature = "serde"), doc = "```ignore")]
/// use d2m_motion::{AnyMotion, RigidMotion};
/// let arm: AnyMotion = serde_json::from_str(
///     r#"{"chain": [{"joint": "revolute", "axis": [0, 0, 1], "value": [0, 2]}, {"x": [1, 0, 0], "joint": "fixed"}]}"#,
/// ).unwrap();
/// assert_eq!(arm.pose_and_twist(0.0).1.linear, glam::DVec3::Y * 2.0);
/// let fault = serde_json::from_str::<AnyMotion>(r#"{"times": [0, 0], "poses": [{}, {}]}"#).unwrap_err();
/// assert!(fault.to_string().contains("keyframe 1, time 0.0: times must increase"));
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum AnyMotion {
    /// Constant linear and angular velocity.
    ConstantTwist(ConstantTwist),
    /// Poses at times, joined.
    Keyframes(Keyframes),
    /// A link of an articulated arm.
    Chain(Chain),
    /// A smooth motion through poses.
    Spline(Spline),
}

impl AnyMotion {
    fn motion(&self) -> &dyn RigidMotion {
        match self {
            Self::ConstantTwist(motion) => motion,
            Self::Keyframes(motion) => motion,
            Self::Chain(motion) => motion,
            Self::Spline(motion) => motion,
        }
    }

    /// [`Keyframes::check_size`]; other motions have no gaps.
    ///
    /// # Errors
    /// Spans of keyframes that do not meet, for a body of this size.
    pub fn check_size(&self, size: f64) -> Result<(), MotionError> {
        match self {
            Self::Keyframes(keyframes) => keyframes.check_size(size),
            _ => Ok(()),
        }
    }
}

impl From<ConstantTwist> for AnyMotion {
    fn from(motion: ConstantTwist) -> Self {
        Self::ConstantTwist(motion)
    }
}

impl From<ScrewMotion> for AnyMotion {
    fn from(motion: ScrewMotion) -> Self {
        Self::ConstantTwist(*motion.as_constant_twist())
    }
}

impl From<Keyframes> for AnyMotion {
    fn from(motion: Keyframes) -> Self {
        Self::Keyframes(motion)
    }
}

impl From<Chain> for AnyMotion {
    fn from(motion: Chain) -> Self {
        Self::Chain(motion)
    }
}

impl From<Spline> for AnyMotion {
    fn from(motion: Spline) -> Self {
        Self::Spline(motion)
    }
}

impl RigidMotion for AnyMotion {
    forward!(|any| any.motion());
}
