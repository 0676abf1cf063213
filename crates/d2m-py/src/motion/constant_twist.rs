//! Motions of constant twist.

use super::{Motion, instance};
use crate::arrays::Doubles;
use crate::arrays::vector;
use crate::fault::{Fault, OrRaise};
use crate::pose::{list, quat, quaternion, vec3_or_zero, wxyz};
use glam::{DQuat, DVec3};
use numpy::PyArray1;
use pyo3::prelude::*;

/// Constant linear and angular velocity.
///
/// At time `t` the body point `at` is at `x` and the body is turned by `q` (w, x, y, z); the point moves with `v`, the body turns
/// with `w` (radians per unit of time), world axes: x(s) = x + v·(s − t), R(s) = exp([w](s − t))·R(q).
///
/// Raises `InputError` with index and value for numbers that are not finite and a quaternion of length zero.
///
/// >>> import d2m_ccd
/// >>> d2m_ccd.ConstantTwist(x=[0, 0, 2], v=[0, 0, -4])
/// ConstantTwist(x=[0.0, 0.0, 2.0], q=[1.0, 0.0, 0.0, 0.0], v=[0.0, 0.0, -4.0], w=[0.0, 0.0, 0.0])
#[pyclass(frozen, extends = Motion, module = "d2m_ccd")]
pub(crate) struct ConstantTwist {
    twist: d2m::ConstantTwist,
}

impl ConstantTwist {
    /// The class of a motion.
    pub(crate) fn of(twist: d2m::ConstantTwist) -> PyClassInitializer<Self> {
        instance(Self { twist }, twist)
    }
}

#[pymethods]
impl ConstantTwist {
    #[new]
    #[pyo3(signature = (x=None, q=None, v=None, w=None, *, at=None, t=0.0))]
    fn new(
        x: Option<&Bound<'_, PyAny>>,
        q: Option<&Bound<'_, PyAny>>,
        v: Option<&Bound<'_, PyAny>>,
        w: Option<&Bound<'_, PyAny>>,
        at: Option<&Bound<'_, PyAny>>,
        t: f64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let q = q.map_or(Ok(DQuat::IDENTITY), |q| quaternion(q, "q"))?;
        let [x, v, w, at] =
            [vec3_or_zero(x, "x")?, vec3_or_zero(v, "v")?, vec3_or_zero(w, "w")?, vec3_or_zero(at, "at")?];
        let twist = d2m::ConstantTwist::try_new(x, q, v, w).or_raise()?;
        Ok(Self::of(twist.try_with_at(at).or_raise()?.try_with_reference_time(t).or_raise()?))
    }

    /// The motion of thirteen numbers, shape (13,): q (w, x, y, z), x, v, w, as in trials.
    ///
    /// Raises `InputError` with the index of a number that is not finite.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.ConstantTwist.from_array([1, 0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 0, 0]).x.tolist()
    /// [1.0, 2.0, 3.0]
    #[staticmethod]
    fn from_array<'py>(array: &Bound<'py, PyAny>) -> PyResult<Bound<'py, Self>> {
        let row = Doubles::new(array, "array", &[Some(13)])?;
        Bound::new(array.py(), Self::of(twist_of_row(row.slice()).or_raise()?))
    }

    /// The thirteen numbers of `from_array`, shape (13,).
    ///
    /// Raises `InputError` where `at` or `t` are not zero: they are not among them.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.ConstantTwist(x=[1, 2, 3]).to_array()[4:7].tolist()
    /// [1.0, 2.0, 3.0]
    fn to_array<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let twist = &self.twist;
        if twist.at() != DVec3::ZERO || twist.reference_time() != 0.0 {
            return Err(Fault::new("an array of 13 numbers has no reference point and no time").into());
        }
        let q = wxyz(twist.orientation());
        let vectors = [twist.position(), twist.linear_velocity(), twist.angular_velocity()];
        let numbers: Vec<f64> = q.into_iter().chain(vectors.into_iter().flat_map(|v| v.to_array())).collect();
        Ok(vector(py, &numbers))
    }

    /// Position of the body point `at` at the time `t`, shape (3,).
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.twist.position().to_array())
    }

    /// Turn at the time `t` as given, (w, x, y, z), shape (4,).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &wxyz(self.twist.orientation()))
    }

    /// Velocity of the body point `at`, world axes, shape (3,).
    #[getter]
    fn v<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.twist.linear_velocity().to_array())
    }

    /// Angular velocity, radians per unit of time, world axes, shape (3,).
    #[getter]
    fn w<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.twist.angular_velocity().to_array())
    }

    /// The reference point, body frame, shape (3,).
    #[getter]
    fn at<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.twist.at().to_array())
    }

    /// The time at which the pose is the given one.
    #[getter]
    fn t(&self) -> f64 {
        self.twist.reference_time()
    }

    fn __repr__(&self) -> String {
        let twist = &self.twist;
        let [x, v, w] = [twist.position(), twist.linear_velocity(), twist.angular_velocity()]
            .map(|vector| list(&vector.to_array()));
        let q = list(&wxyz(twist.orientation()));
        let at = match twist.at() {
            DVec3::ZERO => String::new(),
            at => format!(", at={}", list(&at.to_array())),
        };
        let t = match twist.reference_time() {
            0.0 => String::new(),
            t => format!(", t={t:?}"),
        };
        format!("ConstantTwist(x={x}, q={q}, v={v}, w={w}{at}{t})")
    }
}

/// Of (q, x, v, w).
///
/// # Errors
/// A number that is not finite, a quaternion of length zero.
pub(crate) fn twist_of_row(row: &[f64]) -> Result<d2m::ConstantTwist, Fault> {
    if let Some(index) = row.iter().position(|value| !value.is_finite()) {
        let value = row[index];
        let message = format!("number {index} of (q, x, v, w) is {value}, not a finite number");
        return Err(Fault::new(message).at(index).found(value));
    }
    let three = |from: usize| DVec3::new(row[from], row[from + 1], row[from + 2]);
    let orientation = quat([row[0], row[1], row[2], row[3]]);
    Ok(d2m::ConstantTwist::try_new(three(4), orientation, three(7), three(10))?)
}
