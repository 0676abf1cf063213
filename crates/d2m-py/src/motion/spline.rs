//! Smooth motions through poses.

use super::{Form, Motion};
use crate::arrays::{Doubles, rows, vector};
use crate::fault::{Fault, OrRaise};
use crate::pose::{pose_list, wxyz};
use d2m::Twist;
use d2m::motion::SplineDegree;
use glam::DVec3;
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::Arc;

/// A smooth motion through poses at times: a Hermite spline.
///
/// `times` of shape (k,); `poses` as of `Keyframes`; `twists` of shape (k, 6) as (v, w), velocities of the body origin and angular
/// velocities at the poses, world axes; without them they are taken from the neighbours (Catmull and Rom). `degree` 3: velocities
/// are continuous; 5: accelerations too (they vanish at the poses).
///
/// Raises `InputError` with the pose's index: fewer than two poses, times that do not increase, numbers that are not finite,
/// a turn of half a circle between two poses.
///
/// >>> import d2m_ccd
/// >>> path = d2m_ccd.Spline([0, 1, 3], [[1, 0, 0, 0, x, x * x, 0] for x in (0, 1, 2)], degree=5)
/// >>> path.pose(1.0).x.tolist()
/// [1.0, 1.0, 0.0]
#[pyclass(frozen, extends = Motion, module = "d2m_ccd")]
pub(crate) struct Spline {
    keyframes: Vec<(f64, d2m::Pose)>,
    twists: Option<Vec<Twist>>,
    degree: SplineDegree,
}

#[pymethods]
impl Spline {
    #[new]
    #[pyo3(signature = (times, poses, twists=None, *, degree=3))]
    fn new(
        times: &Bound<'_, PyAny>,
        poses: &Bound<'_, PyAny>,
        twists: Option<&Bound<'_, PyAny>>,
        degree: i64,
    ) -> PyResult<PyClassInitializer<Self>> {
        let times = Doubles::new(times, "times", &[None])?;
        let poses = pose_list(poses, "poses")?;
        let degree = degree_of(degree).or_raise()?;
        let keyframes = super::keyframes::together(times.slice(), &poses).or_raise()?;
        let twists = twists.map(|any| twist_list(any, keyframes.len())).transpose()?;
        let spline = spline(&keyframes, twists.as_deref(), degree).or_raise()?;
        let base = Motion { form: Form::Spline(Arc::new(spline)) };
        Ok(PyClassInitializer::from(base).add_subclass(Self { keyframes, twists, degree }))
    }

    /// The times of the poses, shape (k,).
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let times: Vec<f64> = self.keyframes.iter().map(|(time, _)| *time).collect();
        vector(py, &times)
    }

    /// 3 or 5.
    #[getter]
    fn degree(&self) -> i64 {
        if self.degree == SplineDegree::Quintic { 5 } else { 3 }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, spline) = (slf.py(), slf.get());
        let times = spline.times(py);
        let pose = |(_, pose): &(f64, d2m::Pose)| {
            let ([w, x, y, z], p) = (wxyz(pose.rotation), pose.translation);
            [w, x, y, z, p.x, p.y, p.z]
        };
        let poses = rows(py, spline.keyframes.iter().map(pose))?;
        let six = |Twist { linear: v, angular: w }: &Twist| [v.x, v.y, v.z, w.x, w.y, w.z];
        let twists = spline.twists.as_ref().map(|twists| rows(py, twists.iter().map(six))).transpose()?;
        let rebuild = py.import("d2m_ccd._rebuild")?.getattr("spline")?;
        (rebuild, (times, poses, twists, spline.degree())).into_pyobject(py)
    }
}

/// With the twists, or with those of the neighbours.
fn spline(
    keyframes: &[(f64, d2m::Pose)],
    twists: Option<&[Twist]>,
    degree: SplineDegree,
) -> Result<d2m::motion::Spline, Fault> {
    let Some(twists) = twists else {
        return Ok(d2m::motion::Spline::try_through(keyframes, degree)?);
    };
    let all: Vec<_> =
        keyframes.iter().zip(twists).map(|(&(time, pose), &twist)| (time, pose, twist)).collect();
    Ok(d2m::motion::Spline::try_with_twists(&all, degree)?)
}

fn twist_list(any: &Bound<'_, PyAny>, count: usize) -> PyResult<Vec<Twist>> {
    let numbers = Doubles::new(any, "twists", &[Some(count), Some(6)])?;
    numbers.require_finite("twists").or_raise()?;
    let twist = |row: &[f64; 6]| Twist {
        linear: DVec3::new(row[0], row[1], row[2]),
        angular: DVec3::new(row[3], row[4], row[5]),
    };
    Ok(numbers.slice().as_chunks::<6>().0.iter().map(twist).collect())
}

/// 3 or 5.
pub(crate) fn degree_of(degree: i64) -> Result<SplineDegree, Fault> {
    match degree {
        3 => Ok(SplineDegree::Cubic),
        5 => Ok(SplineDegree::Quintic),
        other => Err(Fault::new(format!("degree is {other}: 3 or 5 is expected")).found(other as f64)),
    }
}
