//! Poses.

use crate::arrays::{Doubles, small, vector};
use crate::fault::{Fault, OrRaise};
use d2m::motion::ConstantTwist;
use glam::{DMat3, DQuat, DVec3};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Largest entry of RᵀR − I, and difference of det R from 1, of a matrix that counts as a rotation: what matrices have that are
/// products of thousands, or were printed with nine digits. Refuses input, proves nothing.
const NO_ROTATION: f64 = 1e-8;

/// Where a body frame is in the world: the body point `at` is at `x`, the frame is turned by `q`.
///
/// A body point p is at R(q)·(p − at) + x. Lengths in the unit of the meshes; quaternions are (w, x, y, z), of any
/// length but zero. Arguments of functions that take poses may also be a homogeneous matrix of shape (4, 4), whose rotation becomes
/// the nearest quaternion, or seven numbers (q, x).
///
/// Raises `InputError` for numbers that are not finite and a quaternion of length zero.
///
/// >>> import d2m_ccd
/// >>> d2m_ccd.Pose(x=[1, 2, 3])
/// Pose(x=[1.0, 2.0, 3.0], q=[1.0, 0.0, 0.0, 0.0])
#[pyclass(frozen, module = "d2m_ccd", from_py_object)]
#[derive(Clone, Copy)]
pub(crate) struct Pose {
    pub(crate) pose: d2m::Pose,
}

#[pymethods]
impl Pose {
    #[new]
    #[pyo3(signature = (x=None, q=None, at=None))]
    fn new(
        x: Option<&Bound<'_, PyAny>>,
        q: Option<&Bound<'_, PyAny>>,
        at: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let translation = vec3_or_zero(x, "x")?;
        let rotation = q.map_or(Ok(DQuat::IDENTITY), |q| quaternion(q, "q"))?;
        Ok(Self { pose: d2m::Pose { translation, rotation, at: vec3_or_zero(at, "at")? } })
    }

    /// The pose of a homogeneous matrix of shape (4, 4). The rotation becomes the nearest quaternion.
    ///
    /// Raises `InputError` where the upper left part is no rotation to 1e-8, or the last row is not (0, 0, 0, 1).
    ///
    /// >>> import numpy, d2m_ccd
    /// >>> d2m_ccd.Pose.from_matrix(numpy.eye(4)) == d2m_ccd.Pose()
    /// True
    #[staticmethod]
    fn from_matrix(matrix: &Bound<'_, PyAny>) -> PyResult<Self> {
        let numbers = Doubles::new(matrix, "matrix", &[Some(4), Some(4)])?;
        numbers.require_finite("matrix").or_raise()?;
        Ok(Self { pose: pose_of_matrix(numbers.slice(), "matrix").or_raise()? })
    }

    /// The position of the body point `at`, shape (3,).
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.pose.translation.to_array())
    }

    /// The turn as given, (w, x, y, z), shape (4,).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &wxyz(self.pose.rotation))
    }

    /// The reference point, body frame, shape (3,).
    #[getter]
    fn at<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.pose.at.to_array())
    }

    /// The homogeneous matrix, shape (4, 4), rounded.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Pose(x=[1, 2, 3]).matrix()[:3, 3].tolist()
    /// [1.0, 2.0, 3.0]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let pose = d2m::Pose { rotation: self.pose.rotation.normalize(), ..self.pose };
        let columns = glam::DMat4::from(pose.to_affine()).transpose().to_cols_array();
        PyArray1::from_slice(py, &columns).reshape([4, 4])
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.pose == other.pose
    }

    fn __hash__(&self) -> u64 {
        hash_of(&numbers_of(&self.pose))
    }

    fn __repr__(&self) -> String {
        let d2m::Pose { rotation, translation, at } = self.pose;
        let [x, q] = [list(&translation.to_array()), list(&wxyz(rotation))];
        match at {
            DVec3::ZERO => format!("Pose(x={x}, q={q})"),
            at => format!("Pose(x={x}, q={q}, at={})", list(&at.to_array())),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let d2m::Pose { rotation, translation, at } = slf.get().pose;
        let arguments = (translation.to_array(), wxyz(rotation), at.to_array()).into_pyobject(slf.py())?;
        (slf.get_type(), arguments).into_pyobject(slf.py())
    }
}

fn numbers_of(pose: &d2m::Pose) -> Vec<f64> {
    let d2m::Pose { rotation, translation, at } = *pose;
    [&translation.to_array()[..], &wxyz(rotation), &at.to_array()].concat()
}

/// A hash of numbers that compare as they do: zeros of both signs are equal.
pub(crate) fn hash_of(numbers: &[f64]) -> u64 {
    use std::hash::{DefaultHasher, Hash, Hasher};
    let mut hasher = DefaultHasher::new();
    numbers.iter().for_each(|number| (number + 0.0).to_bits().hash(&mut hasher));
    hasher.finish()
}

/// Numbers as Python writes a list of them.
pub(crate) fn list(numbers: &[f64]) -> String {
    format!("{numbers:?}")
}

/// (w, x, y, z).
pub(crate) fn wxyz(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

/// Of (w, x, y, z).
pub(crate) fn quat([w, x, y, z]: [f64; 4]) -> DQuat {
    DQuat::from_xyzw(x, y, z, w)
}

/// Three finite numbers; zero if there are none.
pub(crate) fn vec3_or_zero(any: Option<&Bound<'_, PyAny>>, name: &str) -> PyResult<DVec3> {
    any.map_or(Ok(DVec3::ZERO), |any| Ok(DVec3::from_array(small(any, name)?)))
}

/// A quaternion (w, x, y, z) that can be normalised.
pub(crate) fn quaternion(any: &Bound<'_, PyAny>, name: &str) -> PyResult<DQuat> {
    let q = quat(small(any, name)?);
    check_quaternion(q).map_err(|fault| fault.within(name)).or_raise()?;
    Ok(q)
}

fn check_quaternion(q: DQuat) -> Result<(), Fault> {
    Ok(ConstantTwist::try_new(DVec3::ZERO, q, DVec3::ZERO, DVec3::ZERO).map(|_| ())?)
}

/// The pose of sixteen numbers, row after row.
pub(crate) fn pose_of_matrix(rows: &[f64], name: &str) -> Result<d2m::Pose, Fault> {
    if let Some(column) = (0..4).find(|&column| rows[12 + column] != f64::from(u8::from(column == 3))) {
        let value = rows[12 + column];
        let message = format!("{name}[3, {column}] is {value:?}: the last row must be (0, 0, 0, 1)");
        return Err(Fault::new(message).at_places(vec![3, column]).found(value));
    }
    let row = |i: usize| DVec3::new(rows[4 * i], rows[4 * i + 1], rows[4 * i + 2]);
    let turn = DMat3::from_cols(row(0), row(1), row(2)).transpose();
    let difference = turn.transpose() * turn - DMat3::IDENTITY;
    let worst = difference.to_cols_array().into_iter().map(f64::abs).fold(0.0, f64::max);
    let determinant = turn.determinant();
    // A comparison with NaN refuses.
    if !(worst <= NO_ROTATION && (determinant - 1.0).abs() <= NO_ROTATION) {
        let message = format!(
            "{name} is no rotation with a translation: RᵀR differs from the identity by {worst:.3e}, its determinant is {determinant:.9}"
        );
        return Err(Fault::new(message).found(determinant));
    }
    let translation = DVec3::new(rows[3], rows[7], rows[11]);
    Ok(d2m::Pose { rotation: DQuat::from_mat3(&turn), translation, at: DVec3::ZERO })
}

/// Of seven finite numbers (q, x).
pub(crate) fn pose_of_row(row: &[f64]) -> Result<d2m::Pose, Fault> {
    let rotation = quat([row[0], row[1], row[2], row[3]]);
    check_quaternion(rotation)?;
    Ok(d2m::Pose { rotation, translation: DVec3::new(row[4], row[5], row[6]), at: DVec3::ZERO })
}

/// A pose argument: a `Pose`, a matrix, seven numbers, or nothing.
pub(crate) fn pose_argument(any: Option<&Bound<'_, PyAny>>, name: &str) -> PyResult<d2m::Pose> {
    let Some(any) = any else { return Ok(d2m::Pose::IDENTITY) };
    if let Ok(pose) = any.cast::<Pose>() {
        return Ok(pose.get().pose);
    }
    let numbers = Doubles::of_any_shape(any, name)?;
    numbers.require_finite(name).or_raise()?;
    match numbers.shape() {
        [4, 4] => pose_of_matrix(numbers.slice(), name).or_raise(),
        [7] => pose_of_row(numbers.slice()).map_err(|fault| fault.within(name)).or_raise(),
        shape => {
            let message =
                format!("{name} has the shape {shape:?}: a Pose, (4, 4) or (7,) as (q, x) is expected");
            Err(Fault::new(message).into())
        }
    }
}

/// Poses in rows (q, x) of shape (k, 7), or matrices of shape (k, 4, 4), or a sequence of `Pose`.
pub(crate) fn pose_list(any: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<d2m::Pose>> {
    if let Ok(poses) = any.extract::<Vec<Pose>>() {
        return Ok(poses.into_iter().map(|pose| pose.pose).collect());
    }
    let numbers = Doubles::of_any_shape(any, name)?;
    numbers.require_finite(name).or_raise()?;
    let within = |(index, pose): (usize, Result<d2m::Pose, Fault>)| {
        pose.map_err(|fault| fault.within(&format!("{name}[{index}]")).at(index)).or_raise()
    };
    match *numbers.shape() {
        [_, 7] => numbers.slice().chunks_exact(7).map(pose_of_row).enumerate().map(within).collect(),
        [_, 4, 4] => {
            let poses = numbers.slice().chunks_exact(16).map(|rows| pose_of_matrix(rows, "matrix"));
            poses.enumerate().map(within).collect()
        }
        ref shape => {
            let message =
                format!("{name} has the shape {shape:?}: (k, 7) as (q, x) or (k, 4, 4) is expected");
            Err(Fault::new(message).into())
        }
    }
}
