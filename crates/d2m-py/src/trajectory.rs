//! Motions of many trials as arrays.

use crate::arrays::Doubles;
use crate::fault::{Fault, OrRaise};
use crate::motion::{Form, Joint, degree_of, joint_list, motion_argument, span_named, twist_of_row};
use crate::pose::{pose_of_matrix, pose_of_row};
use d2m::motion::{Chain, JointPoints, JointValue, Keyframes, RigidMotion, Span, Spline, SplineDegree};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PySlice, PyTuple};

/// Trajectories of many trials: poses at times, of shape (n, k, 7) as (q(w, x, y, z), x) or (n, k, 4, 4) as matrices.
///
/// `times` of shape (k,), the same for all, or (n, k). `join` "linear" or "screw" as of `Keyframes`; "cubic" or "quintic" makes
/// splines of degree 3 or 5 as of `Spline`. An argument for the motions of `batch`; the arrays are kept, not copied.
///
/// Raises `InputError` for other shapes and numbers that are not finite; what is wrong with one trajectory is raised by
/// `batch`, with its trial.
///
/// >>> import numpy, d2m_ccd
/// >>> poses = numpy.tile([1.0, 0, 0, 0, 0, 0, 0], (10, 3, 1))
/// >>> d2m_ccd.PoseTrajectories([0, 0.5, 1], poses)
/// PoseTrajectories(10 trials, 3 poses)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct PoseTrajectories {
    times: Py<PyAny>,
    poses: Py<PyAny>,
    join: Join,
    counts: [usize; 2],
}

/// What stands between two poses.
#[derive(Clone, Copy)]
pub(crate) enum Join {
    Keyframes(Span),
    Spline(SplineDegree),
}

#[pymethods]
impl PoseTrajectories {
    #[new]
    #[pyo3(signature = (times, poses, *, join="linear"))]
    fn new(times: &Bound<'_, PyAny>, poses: &Bound<'_, PyAny>, join: &str) -> PyResult<Self> {
        let py = times.py();
        let join = match join {
            "cubic" => Join::Spline(degree_of(3).or_raise()?),
            "quintic" => Join::Spline(degree_of(5).or_raise()?),
            other => Join::Keyframes(span_named(other).or_raise()?),
        };
        let array = py.import(intern!(py, "numpy"))?.getattr(intern!(py, "asarray"))?;
        let (times, poses) = (array.call1((times,))?, array.call1((poses,))?);
        let shape = {
            let numbers = Doubles::of_any_shape(&poses, "poses")?;
            numbers.require_finite("poses").or_raise()?;
            numbers.shape().to_vec()
        };
        let counts = match *shape {
            [n, k, 7] | [n, k, 4, 4] => [n, k],
            _ => {
                let message =
                    format!("poses has the shape {shape:?}: (n, k, 7) as (q, x) or (n, k, 4, 4) is expected");
                return Err(Fault::new(message).into());
            }
        };
        check_times(&times, counts)?;
        Ok(Self { times: times.unbind(), poses: poses.unbind(), join, counts })
    }

    fn __len__(&self) -> usize {
        self.counts[0]
    }

    /// Some of the trials, by a slice: views of the same arrays.
    fn __getitem__(&self, py: Python<'_>, trials: &Bound<'_, PySlice>) -> PyResult<Self> {
        let poses = self.poses.bind(py).get_item(trials)?;
        let counts = [poses.len()?, self.counts[1]];
        let times = times_of(self.times.bind(py), trials, self.counts)?;
        Ok(Self { times, poses: poses.unbind(), join: self.join, counts })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let join = match this.join {
            Join::Keyframes(Span::Screw) => "screw",
            Join::Keyframes(_) => "linear",
            Join::Spline(SplineDegree::Quintic) => "quintic",
            Join::Spline(_) => "cubic",
        };
        let rebuild = py.import("d2m_ccd._rebuild")?.getattr("pose_trajectories")?;
        (rebuild, (&this.times, &this.poses, join)).into_pyobject(py)
    }

    fn __repr__(&self) -> String {
        format!("PoseTrajectories({} trials, {} poses)", self.counts[0], self.counts[1])
    }
}

/// The times of some of the trials.
fn times_of(
    times: &Bound<'_, PyAny>,
    trials: &Bound<'_, PySlice>,
    [n, k]: [usize; 2],
) -> PyResult<Py<PyAny>> {
    let own = times.getattr(intern!(times.py(), "ndim"))?.extract::<usize>()? == 2;
    debug_assert!(own || n == 0 || times.len().is_ok_and(|length| length == k));
    Ok(if own { times.get_item(trials)?.unbind() } else { times.clone().unbind() })
}

fn check_times(times: &Bound<'_, PyAny>, [n, k]: [usize; 2]) -> PyResult<()> {
    let times = Doubles::of_any_shape(times, "times")?;
    if *times.shape() == [k] || *times.shape() == [n, k] {
        return times.require_finite("times").or_raise();
    }
    let message = format!("times has the shape {:?}, ({k},) or ({n}, {k}) is expected", times.shape());
    Err(Fault::new(message).into())
}

/// Trajectories of the joints of one arm in many trials: values of shape (n, k, j).
///
/// `joints`: the joints of the arm from the base on, as `Chain` takes them; the j of them that move and have no value of their
/// own get `values`, angles in radians and lengths. `times` of shape (k,) or (n, k). Between times values are linear, or
/// cubic (Hermite) with `velocities` of shape (n, k, j), quintic with `accelerations` too. The motion is that of the last frame; for a link before it give the
/// joints up to it. An argument for the motions of `batch`; the arrays are kept, not copied.
///
/// Raises `InputError` for other shapes and numbers that are not finite.
///
/// >>> import numpy, d2m_ccd
/// >>> joints = [d2m_ccd.Joint("revolute", axis=[0, 0, 1]), d2m_ccd.Joint(x=[1, 0, 0])]
/// >>> d2m_ccd.JointTrajectories(joints, [0, 1], numpy.zeros((100, 2, 1)))
/// JointTrajectories(100 trials, 2 points, 1 joint values)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct JointTrajectories {
    joints: Vec<Joint>,
    times: Py<PyAny>,
    values: Py<PyAny>,
    velocities: Option<Py<PyAny>>,
    accelerations: Option<Py<PyAny>>,
    counts: [usize; 3],
}

#[pymethods]
impl JointTrajectories {
    #[new]
    #[pyo3(signature = (joints, times, values, velocities=None, accelerations=None))]
    fn new(
        joints: &Bound<'_, PyAny>,
        times: &Bound<'_, PyAny>,
        values: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
        accelerations: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let py = times.py();
        let joints = joint_list(joints)?;
        let open = joints.iter().filter(|joint| joint.is_open()).count();
        let array = py.import(intern!(py, "numpy"))?.getattr(intern!(py, "asarray"))?;
        let (times, values) = (array.call1((times,))?, array.call1((values,))?);
        let shape = {
            let numbers = Doubles::new(&values, "values", &[None, None, Some(open)])?;
            numbers.require_finite("values").or_raise()?;
            numbers.shape().to_vec()
        };
        let counts = [shape[0], shape[1], open];
        let rates = |any: Option<&Bound<'_, PyAny>>, name: &str| {
            let Some(any) = any else { return Ok(None) };
            let any = array.call1((any,))?;
            let numbers = Doubles::new(&any, name, &counts.map(Some))?;
            numbers.require_finite(name).or_raise()?;
            Ok::<_, PyErr>(Some(any.unbind()))
        };
        let velocities = rates(velocities, "velocities")?;
        let accelerations = rates(accelerations, "accelerations")?;
        if accelerations.is_some() && velocities.is_none() {
            return Err(Fault::new("accelerations need velocities").into());
        }
        check_times(&times, [counts[0], counts[1]])?;
        Ok(Self { joints, times: times.unbind(), values: values.unbind(), velocities, accelerations, counts })
    }

    fn __len__(&self) -> usize {
        self.counts[0]
    }

    /// Some of the trials, by a slice: views of the same arrays.
    fn __getitem__(&self, py: Python<'_>, trials: &Bound<'_, PySlice>) -> PyResult<Self> {
        let [n, k, j] = self.counts;
        let part = |any: &Py<PyAny>| any.bind(py).get_item(trials).map(Bound::unbind);
        let values = part(&self.values)?;
        let counts = [values.bind(py).len()?, k, j];
        Ok(Self {
            joints: self.joints.clone(),
            times: times_of(self.times.bind(py), trials, [n, k])?,
            values,
            velocities: self.velocities.as_ref().map(part).transpose()?,
            accelerations: self.accelerations.as_ref().map(part).transpose()?,
            counts,
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let arguments =
            (this.joints.clone(), &this.times, &this.values, &this.velocities, &this.accelerations);
        (slf.get_type(), arguments).into_pyobject(py)
    }

    fn __repr__(&self) -> String {
        let [n, k, j] = self.counts;
        format!("JointTrajectories({n} trials, {k} points, {j} joint values)")
    }
}

/// Motions of a batch, with hold of their arrays.
pub(crate) enum Motions<'py> {
    Same(Form),
    Each(Vec<Form>),
    Rows(Doubles<'py>),
    Poses {
        times: Doubles<'py>,
        poses: Doubles<'py>,
        join: Join,
        counts: [usize; 2],
    },
    Joints {
        joints: Vec<Joint>,
        times: Doubles<'py>,
        values: Doubles<'py>,
        velocities: Option<Doubles<'py>>,
        accelerations: Option<Doubles<'py>>,
        counts: [usize; 3],
    },
}

impl<'py> Motions<'py> {
    /// A motions argument of `batch`: one motion for all trials, a sequence of motions, an array of shape (n, 13), or
    /// trajectories.
    pub(crate) fn new(any: Option<&Bound<'py, PyAny>>, name: &str) -> PyResult<Self> {
        let Some(given) = any else { return Ok(Self::Same(motion_argument(None, name)?)) };
        let py = given.py();
        if let Ok(trajectories) = given.cast::<PoseTrajectories>() {
            let PoseTrajectories { times, poses, join, counts } = trajectories.get();
            return Ok(Self::Poses {
                times: Doubles::of_any_shape(times.bind(py), "times")?,
                poses: Doubles::of_any_shape(poses.bind(py), "poses")?,
                join: *join,
                counts: *counts,
            });
        }
        if let Ok(trajectories) = given.cast::<JointTrajectories>() {
            let JointTrajectories { joints, times, values, velocities, accelerations, counts } =
                trajectories.get();
            let rates = |any: &Option<Py<PyAny>>| {
                any.as_ref().map(|any| Doubles::of_any_shape(any.bind(py), "rates")).transpose()
            };
            return Ok(Self::Joints {
                joints: joints.clone(),
                times: Doubles::of_any_shape(times.bind(py), "times")?,
                values: Doubles::of_any_shape(values.bind(py), "values")?,
                velocities: rates(velocities)?,
                accelerations: rates(accelerations)?,
                counts: *counts,
            });
        }
        if is_several(given)? {
            let motions = given.try_iter()?.enumerate().map(|(index, any)| {
                let any = any?;
                motion_argument((!any.is_none()).then_some(&any), &format!("{name}[{index}]"))
            });
            return Ok(Self::Each(motions.collect::<PyResult<_>>()?));
        }
        if given.cast::<crate::motion::Motion>().is_err() && !given.is_instance_of::<pyo3::types::PyDict>() {
            let rows = Doubles::of_any_shape(given, name)?;
            match *rows.shape() {
                [13] => {}
                [_, 13] => return Ok(Self::Rows(rows)),
                ref shape => {
                    let message =
                        format!("{name} has the shape {shape:?}, (n, 13) as (q, x, v, w) is expected");
                    return Err(Fault::new(message).into());
                }
            }
        }
        Ok(Self::Same(motion_argument(any, name)?))
    }

    /// How many trials there are; none if one motion serves all.
    pub(crate) fn count(&self) -> Option<usize> {
        match self {
            Self::Same(_) => None,
            Self::Each(motions) => Some(motions.len()),
            Self::Rows(rows) => rows.shape().first().copied(),
            Self::Poses { counts, .. } => Some(counts[0]),
            Self::Joints { counts, .. } => Some(counts[0]),
        }
    }

    /// To be used by several threads.
    pub(crate) fn view(&self) -> MotionsView<'_> {
        match self {
            Self::Same(form) => MotionsView::Same(form),
            Self::Each(forms) => MotionsView::Each(forms),
            Self::Rows(rows) => MotionsView::Rows(rows.slice()),
            Self::Poses { times, poses, join, counts } => MotionsView::Poses {
                times: times.slice(),
                poses: poses.slice(),
                join: *join,
                points: counts[1],
                is_matrix: poses.shape().len() == 4,
            },
            Self::Joints { joints, times, values, velocities, accelerations, counts } => {
                MotionsView::Joints {
                    joints,
                    times: times.slice(),
                    values: values.slice(),
                    velocities: velocities.as_ref().map(Doubles::slice),
                    accelerations: accelerations.as_ref().map(Doubles::slice),
                    points: counts[1],
                    open: counts[2],
                }
            }
        }
    }
}

/// A list or tuple whose first element is a motion: `Motion`, a dictionary or `None`.
fn is_several(any: &Bound<'_, PyAny>) -> PyResult<bool> {
    if !(any.is_instance_of::<pyo3::types::PyList>() || any.is_instance_of::<PyTuple>()) {
        return Ok(false);
    }
    // No motions are no row of numbers either.
    let Ok(first) = any.get_item(0) else { return Ok(true) };
    Ok(first.is_none()
        || first.is_instance_of::<pyo3::types::PyDict>()
        || first.cast::<crate::motion::Motion>().is_ok())
}

/// [`Motions`] without the interpreter.
#[derive(Clone, Copy)]
pub(crate) enum MotionsView<'a> {
    Same(&'a Form),
    Each(&'a [Form]),
    Rows(&'a [f64]),
    Poses {
        times: &'a [f64],
        poses: &'a [f64],
        join: Join,
        points: usize,
        is_matrix: bool,
    },
    Joints {
        joints: &'a [Joint],
        times: &'a [f64],
        values: &'a [f64],
        velocities: Option<&'a [f64]>,
        accelerations: Option<&'a [f64]>,
        points: usize,
        open: usize,
    },
}

/// The motion of one trial.
pub(crate) enum TrialMotion<'a> {
    Form(&'a Form),
    Twist(d2m::ConstantTwist),
    Keyframes(Keyframes),
    Spline(Spline),
    Chain(Chain),
}

impl TrialMotion<'_> {
    /// To be asked.
    pub(crate) fn motion(&self) -> &dyn RigidMotion {
        match self {
            Self::Form(form) => form.motion(),
            Self::Twist(motion) => motion,
            Self::Keyframes(motion) => motion,
            Self::Spline(motion) => motion,
            Self::Chain(motion) => motion,
        }
    }
}

impl<'a> MotionsView<'a> {
    /// The motion of a trial.
    ///
    /// # Errors
    /// Numbers that are no motion.
    pub(crate) fn of_trial(&self, trial: usize) -> Result<TrialMotion<'a>, Fault> {
        match *self {
            Self::Same(form) => Ok(TrialMotion::Form(form)),
            Self::Each(forms) => Ok(TrialMotion::Form(&forms[trial])),
            Self::Rows(rows) => Ok(TrialMotion::Twist(twist_of_row(&rows[13 * trial..13 * (trial + 1)])?)),
            Self::Poses { times, poses, join, points, is_matrix } => {
                let times = of_trial(times, points, trial);
                let width = if is_matrix { 16 } else { 7 };
                let rows = &poses[width * points * trial..width * points * (trial + 1)];
                let pose = |(index, row): (usize, &[f64])| {
                    let pose = if is_matrix { pose_of_matrix(row, "matrix") } else { pose_of_row(row) };
                    pose.map_err(|fault| fault.within(&format!("poses[{index}]")))
                };
                let poses = rows.chunks_exact(width).enumerate().map(pose).collect::<Result<Vec<_>, _>>()?;
                let frames: Vec<_> = times.iter().copied().zip(poses).collect();
                Ok(match join {
                    Join::Keyframes(span) => TrialMotion::Keyframes(Keyframes::try_new(&frames, span)?),
                    Join::Spline(degree) => TrialMotion::Spline(Spline::try_through(&frames, degree)?),
                })
            }
            Self::Joints { joints, times, values, velocities, accelerations, points, open } => {
                let block = points * open * trial..points * open * (trial + 1);
                let path = JointPath {
                    times: of_trial(times, points, trial),
                    values: &values[block.clone()],
                    velocities: velocities.map(|all| &all[block.clone()]),
                    accelerations: accelerations.map(|all| &all[block]),
                    open,
                };
                Ok(TrialMotion::Chain(path.chain(joints)?))
            }
        }
    }
}

/// The times of one trial, where each has its own or all have the same.
fn of_trial(times: &[f64], points: usize, trial: usize) -> &[f64] {
    if times.len() == points { times } else { &times[points * trial..points * (trial + 1)] }
}

/// The values of one trial, point after point.
struct JointPath<'a> {
    times: &'a [f64],
    values: &'a [f64],
    velocities: Option<&'a [f64]>,
    accelerations: Option<&'a [f64]>,
    open: usize,
}

impl JointPath<'_> {
    fn chain(&self, joints: &[Joint]) -> Result<Chain, Fault> {
        let mut next = 0;
        let joint = |(index, joint): (usize, &Joint)| {
            let value = if joint.is_open() {
                next += 1;
                Some(self.value(next - 1)?)
            } else {
                None
            };
            joint.with_value(value).map_err(|fault| fault.within(&format!("joints[{index}]")))
        };
        let joints = joints.iter().enumerate().map(joint).collect::<Result<Vec<_>, _>>()?;
        Ok(Chain::try_new(joints)?)
    }

    fn value(&self, joint: usize) -> Result<JointValue, Fault> {
        let of = |numbers: &[f64]| numbers.iter().skip(joint).step_by(self.open).copied().collect();
        let mut points = JointPoints::new(self.times.to_vec(), of(self.values));
        if let Some(velocities) = self.velocities {
            points = points.with_velocities(of(velocities));
        }
        if let Some(accelerations) = self.accelerations {
            points = points.with_accelerations(of(accelerations));
        }
        Ok(JointValue::through(points)?)
    }
}
