//! Poses at times.

use super::{Motion, instance};
use crate::arrays::{Doubles, vector};
use crate::fault::{Fault, OrRaise, Value};
use crate::pose::pose_list;
use d2m::motion::{AnyMotion, Span};
use numpy::PyArray1;
use pyo3::prelude::*;

/// Poses at strictly increasing times.
///
/// `times` of shape (k,), `poses` of shape (k, 7) as (q(w, x, y, z), x), of shape (k, 4, 4) as homogeneous matrices, or a
/// sequence of `Pose`. Between two poses the body origin moves straight while the body turns at a constant rate the short way round
/// (`join="linear"`), or the body follows the screw that joins them (`join="screw"`).
///
/// Raises `InputError` with the keyframe's index: fewer than two, times that do not increase, numbers that are not finite, a
/// turn of half a circle, which has no short way round.
///
/// >>> import d2m_ccd
/// >>> path = d2m_ccd.Keyframes([0, 1, 3], [[1, 0, 0, 0, x, 0, 0] for x in (0, 2, 0)])
/// >>> path.pose(2.0).x.tolist()
/// [1.0, 0.0, 0.0]
#[pyclass(frozen, extends = Motion, module = "d2m_ccd")]
pub(crate) struct Keyframes;

#[pymethods]
impl Keyframes {
    #[new]
    #[pyo3(signature = (times, poses, *, join="linear"))]
    fn new(
        times: &Bound<'_, PyAny>,
        poses: &Bound<'_, PyAny>,
        join: &str,
    ) -> PyResult<PyClassInitializer<Self>> {
        let times = Doubles::new(times, "times", &[None])?;
        let poses = pose_list(poses, "poses")?;
        let span = span_named(join).or_raise()?;
        let frames = together(times.slice(), &poses).or_raise()?;
        Ok(instance(Self, d2m::Keyframes::try_new(&frames, span).or_raise()?))
    }

    /// The times of the poses, shape (k,).
    #[getter]
    fn times<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<f64>> {
        match &slf.as_super().get().form {
            super::Form::Any(motion) => match &**motion {
                AnyMotion::Keyframes(keyframes) => vector(slf.py(), keyframes.times()),
                _ => vector(slf.py(), &[]),
            },
            super::Form::Spline(_) => vector(slf.py(), &[]),
        }
    }
}

/// Each pose with its time.
pub(crate) fn together(times: &[f64], poses: &[d2m::Pose]) -> Result<Vec<(f64, d2m::Pose)>, Fault> {
    if times.len() != poses.len() {
        return Err(Fault::new(format!("{} times for {} poses", times.len(), poses.len())));
    }
    Ok(times.iter().copied().zip(poses.iter().copied()).collect())
}

/// `linear` or `screw`.
pub(crate) fn span_named(name: &str) -> Result<Span, Fault> {
    match name {
        "linear" => Ok(Span::Linear),
        "screw" => Ok(Span::Screw),
        other => Err(Fault::new(format!("join is {other:?}: \"linear\" or \"screw\" is expected"))
            .with_value(Value::Text(other.to_owned()))),
    }
}
