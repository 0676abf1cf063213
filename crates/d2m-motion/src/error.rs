//! What can be wrong with the description of a motion.

/// A motion that was refused, with what and where.
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
    /// Keyframes need at least two poses at strictly increasing finite times.
    #[error("keyframe {index}, time {time:?}: {reason}")]
    Keyframes {
        /// Index of the offending keyframe.
        index: usize,
        /// Its time.
        time: f64,
        /// What is wrong with it.
        reason: &'static str,
    },
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
