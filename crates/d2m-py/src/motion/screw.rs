//! Screw motions.

use super::{Motion, instance};
use crate::arrays::vector;
use crate::fault::OrRaise;
use crate::pose::{pose_argument, vec3_or_zero};
use d2m::{ScrewMotion, Twist};
use numpy::PyArray1;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A turn at constant rate about an axis fixed in space, with a slide at constant speed along it.
///
/// `Screw(start, end, t0, t1)` takes the first pose at time `t0` to the second at `t1` by the shorter turn; poses are those of
/// `Pose`, matrices of shape (4, 4) or seven numbers (q, x).
///
/// Raises `InputError` for times that do not increase, numbers that are not finite, and a turn so small that its axis is
/// farther than 1e12 times the displacement (then use a `ConstantTwist`).
///
/// >>> import d2m_ccd
/// >>> half = 0.5 ** 0.5
/// >>> screw = d2m_ccd.Screw(d2m_ccd.Pose(), d2m_ccd.Pose(x=[1, 0, 2], q=[half, 0, 0, half]))
/// >>> screw.axis_direction.round(12).tolist()
/// [0.0, 0.0, 1.0]
#[pyclass(frozen, extends = Motion, module = "d2m_ccd")]
pub(crate) struct Screw {
    screw: ScrewMotion,
}

impl Screw {
    fn of(screw: ScrewMotion) -> PyClassInitializer<Self> {
        instance(Self { screw }, screw)
    }
}

#[pymethods]
impl Screw {
    #[new]
    #[pyo3(signature = (start, end, t0=0.0, t1=1.0))]
    fn new(
        start: &Bound<'_, PyAny>,
        end: &Bound<'_, PyAny>,
        t0: f64,
        t1: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let (start, end) = (pose_argument(Some(start), "start")?, pose_argument(Some(end), "end")?);
        Ok(Self::of(ScrewMotion::try_from_poses(start, end, t0, t1).or_raise()?))
    }

    /// The screw of a body that has this pose at time `t`, whose point `at` moves with `v` while it turns with `w` (world axes).
    ///
    /// Raises `InputError` for numbers that are not finite, and an axis farther away than numbers reach.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Screw.from_twist(None, [0, 1, 0], [0, 0, 1]).axis_point.tolist()
    /// [-1.0, 0.0, 0.0]
    #[staticmethod]
    #[pyo3(signature = (pose, v, w, t=0.0))]
    fn from_twist<'py>(
        pose: Option<&Bound<'py, PyAny>>,
        v: &Bound<'py, PyAny>,
        w: &Bound<'py, PyAny>,
        t: f64,
    ) -> PyResult<Bound<'py, Self>> {
        let twist = Twist { linear: vec3_or_zero(Some(v), "v")?, angular: vec3_or_zero(Some(w), "w")? };
        let screw = ScrewMotion::try_from_twist(pose_argument(pose, "pose")?, twist, t).or_raise()?;
        Bound::new(v.py(), Self::of(screw))
    }

    #[staticmethod]
    fn _from_motion<'py>(motion: &Bound<'py, Motion>) -> PyResult<Bound<'py, Self>> {
        let twist = motion.get().form.motion().constant_twist();
        let screw = ScrewMotion::try_from_constant_twist(twist.unwrap_or_default()).or_raise()?;
        Bound::new(motion.py(), Self::of(screw))
    }

    /// A point on the axis, world frame, shape (3,).
    #[getter]
    fn axis_point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.screw.axis_point().to_array())
    }

    /// Unit direction of the axis, shape (3,); zero at rest.
    #[getter]
    fn axis_direction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.screw.axis_direction().to_array())
    }

    /// Length of slide per radian; `None` without a turn.
    #[getter]
    fn pitch(&self) -> Option<f64> {
        self.screw.pitch()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let twist = super::ConstantTwist::of(*slf.get().screw.as_constant_twist());
        let read = slf.get_type().getattr(intern!(py, "_from_motion"))?;
        (read, (Bound::new(py, twist)?,)).into_pyobject(py)
    }
}
