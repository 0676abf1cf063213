//! What can be wrong with the description of a motion.

/// A motion that was refused, with what and where.
///
/// ```
/// use d2m_motion::{ConstantTwist, MotionError};
/// use glam::{DQuat, DVec3};
/// let bad = DVec3::new(0.0, f64::NAN, 0.0);
/// let refused = ConstantTwist::try_new(bad, DQuat::IDENTITY, DVec3::ZERO, DVec3::ZERO).unwrap_err();
/// assert!(matches!(refused, MotionError::NotFinite { name: "position", index: 1, .. }));
/// assert_eq!(refused.to_string(), "position[1] is NaN: every component of a motion must be finite");
/// ```
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MotionError {
    /// A component is NaN or infinite.
    #[error("{name}[{index}] is {value}: every component of a motion must be finite")]
    NotFinite {
        /// Which quantity, e.g. `position`.
        name: &'static str,
        /// Which component of it.
        index: usize,
        /// The component.
        value: f64,
    },
    /// The orientation is the zero quaternion (or too small to be normalised: norm below 1e-150 or above 1e150).
    #[error(
        "orientation ({w:?}, {x:?}, {y:?}, {z:?}) cannot be normalised: its norm must lie in [1e-150, 1e150]"
    )]
    OrientationNorm {
        /// Scalar part.
        w: f64,
        /// First vector component.
        x: f64,
        /// Second vector component.
        y: f64,
        /// Third vector component.
        z: f64,
    },
    /// A text form could not be read.
    #[error("motion text, {key}: {reason}")]
    Text {
        /// The key whose value is wrong (or the piece of text without a key).
        key: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The angular velocity of a screw motion and its linear velocity on the axis are not as required.
    #[error("not a screw: {reason}")]
    Screw {
        /// What is wrong.
        reason: &'static str,
    },
    /// Keyframes need strictly increasing finite times.
    #[error("keyframe {index}, time {time:?}: {reason}")]
    Keyframes {
        /// Index of the offending keyframe.
        index: usize,
        /// Its time.
        time: f64,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// Two spans of a motion do not meet.
    #[error(
        "keyframe {index}, time {time:?}: the span that ends here and the one that begins are {gap:e} apart in {quantity}, more than {allowed:e}"
    )]
    Gap {
        /// Index of the time at which they should meet.
        index: usize,
        /// That time.
        time: f64,
        /// `position` (units of length) or `rotation` (radians).
        quantity: &'static str,
        /// How far apart they are.
        gap: f64,
        /// What would have counted as rounding.
        allowed: f64,
    },
    /// The turn between two keyframes is half a circle, which has no short way round.
    #[error(
        "keyframe {index}, time {time:?}: the turn from the keyframe before is half a circle, which has no short way round"
    )]
    HalfTurn {
        /// Index of the later keyframe.
        index: usize,
        /// Its time.
        time: f64,
    },
    /// A part of a motion that is made of several is not as it should be.
    #[error("{place}: {reason}")]
    Part {
        /// Which part, such as `chain[2], axis` (indices count from 0).
        place: String,
        /// What is wrong with it, with the value.
        reason: String,
    },
}

impl MotionError {
    /// The same fault of a part, with the place of what the part belongs to.
    pub(crate) fn within(self, outer: &str) -> Self {
        match self {
            Self::Part { place, reason } => Self::Part { place: format!("{outer}, {place}"), reason },
            other => Self::Part { place: outer.to_owned(), reason: other.to_string() },
        }
    }
}

/// A fault of a part.
pub(crate) fn fault(place: String, reason: String) -> MotionError {
    MotionError::Part { place, reason }
}

/// What is wrong with a list of times.
pub(crate) struct TimesFault {
    pub(crate) index: usize,
    pub(crate) reason: String,
}

/// The first fault of a list of times: fewer than two, one not finite, or not increasing.
pub(crate) fn find_times_fault(times: &[f64]) -> Option<TimesFault> {
    if times.len() < 2 {
        return Some(TimesFault { index: times.len(), reason: "at least two times are needed".to_owned() });
    }
    times.iter().enumerate().find_map(|(index, &time)| {
        if !time.is_finite() {
            return Some(TimesFault { index, reason: format!("{time} is not finite") });
        }
        let before = index.checked_sub(1).map(|i| times[i])?;
        let reason = || format!("{time:?} does not come after {before:?}: times must increase");
        (before >= time).then(|| TimesFault { index, reason: reason() })
    })
}

/// Refuses NaN and infinity.
///
/// # Errors
/// [`MotionError::NotFinite`] with the first offending index.
pub(crate) fn require_finite(name: &'static str, values: &[f64]) -> Result<(), MotionError> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => Err(MotionError::NotFinite { name, index, value: values[index] }),
    }
}
