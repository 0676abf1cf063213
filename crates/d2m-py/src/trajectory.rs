//! Motions of many trials as arrays.

use crate::arrays::Doubles;
use crate::fault::{Fault, OrRaise};
use crate::motion::{Joint, Form, degree_of, joint_list, motion_argument, span_named, twist_of_row};
use crate::pose::{pose_of_row, pose_of_matrix};
use d2m::motion::{Chain, JointValue, Keyframes, RigidMotion, Span, Spline, SplineDegree};
use pyo3::intern;
use pyo3::prelude::*;

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

    fn __repr__(&self) -> String {
        format!("PoseTrajectories({} trials, {} poses)", self.counts[0], self.counts[1])
    }
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
/// cubic (Hermite) with `velocities` of shape (n, k, j). The motion is that of the last frame; for a link before it give the
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
    counts: [usize; 3],
}

#[pymethods]
impl JointTrajectories {
    #[new]
    #[pyo3(signature = (joints, times, values, velocities=None))]
    fn new(
        joints: &Bound<'_, PyAny>,
        times: &Bound<'_, PyAny>,
        values: &Bound<'_, PyAny>,
        velocities: Option<&Bound<'_, PyAny>>,
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
        let velocities = velocities.map(|any| array.call1((any,))).transpose()?;
        if let Some(velocities) = &velocities {
            let numbers = Doubles::new(velocities, "velocities", &counts.map(Some))?;
            numbers.require_finite("velocities").or_raise()?;
        }
        check_times(&times, [counts[0], counts[1]])?;
        let velocities = velocities.map(Bound::unbind);
        Ok(Self { joints, times: times.unbind(), values: values.unbind(), velocities, counts })
    }

    fn __len__(&self) -> usize {
        self.counts[0]
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
    Poses { times: Doubles<'py>, poses: Doubles<'py>, join: Join, counts: [usize; 2] },
    Joints {
        joints: Vec<Joint>,
        times: Doubles<'py>,
        values: Doubles<'py>,
        velocities: Option<Doubles<'py>>,
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
            let JointTrajectories { joints, times, values, velocities, counts } = trajectories.get();
            let velocities = velocities.as_ref().map(|any| Doubles::of_any_shape(any.bind(py), "velocities"));
            return Ok(Self::Joints {
                joints: joints.clone(),
                times: Doubles::of_any_shape(times.bind(py), "times")?,
                values: Doubles::of_any_shape(values.bind(py), "values")?,
                velocities: velocities.transpose()?,
                counts: *counts,
            });
        }
        if is_several(given)? {
            let motions = given.try_iter()?.enumerate().map(|(index, any)| {
                motion_argument(Some(&any?), &format!("{name}[{index}]"))
            });
            return Ok(Self::Each(motions.collect::<PyResult<_>>()?));
        }
        if given.cast::<crate::motion::Motion>().is_err() && !given.is_instance_of::<pyo3::types::PyDict>() {
            let rows = Doubles::of_any_shape(given, name)?;
            match *rows.shape() {
                [13] => {}
                [_, 13] => return Ok(Self::Rows(rows)),
                ref shape => {
                    let message = format!("{name} has the shape {shape:?}, (n, 13) as (q, x, v, w) is expected");
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
            Self::Joints { joints, times, values, velocities, counts } => MotionsView::Joints {
                joints,
                times: times.slice(),
                values: values.slice(),
                velocities: velocities.as_ref().map(Doubles::slice),
                points: counts[1],
                open: counts[2],
            },
        }
    }
}

/// A list or tuple whose first element is a motion: `Motion`, a dictionary or `None`.
fn is_several(any: &Bound<'_, PyAny>) -> PyResult<bool> {
    if !(any.is_instance_of::<pyo3::types::PyList>() || any.is_instance_of::<pyo3::types::PyTuple>()) {
        return Ok(false);
    }
    let Ok(first) = any.get_item(0) else { return Ok(false) };
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
    Poses { times: &'a [f64], poses: &'a [f64], join: Join, points: usize, is_matrix: bool },
    Joints {
        joints: &'a [Joint],
        times: &'a [f64],
        values: &'a [f64],
        velocities: Option<&'a [f64]>,
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
            Self::Joints { joints, times, values, velocities, points, open } => {
                let block = points * open * trial..points * open * (trial + 1);
                let path = JointPath {
                    times: of_trial(times, points, trial),
                    values: &values[block.clone()],
                    velocities: velocities.map(|all| &all[block]),
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
        let at = |numbers: &[f64], point: usize| numbers[point * self.open + joint];
        let piece = |index: usize| {
            let h = self.times[index + 1] - self.times[index];
            let (from, to) = (at(self.values, index), at(self.values, index + 1));
            let slope = (to - from) / h;
            match self.velocities {
                None => vec![from, slope],
                Some(velocities) => {
                    let (v0, v1) = (at(velocities, index), at(velocities, index + 1));
                    vec![from, v0, (3.0 * slope - 2.0 * v0 - v1) / h, (v0 + v1 - 2.0 * slope) / (h * h)]
                }
            }
        };
        let pieces = (0..self.times.len().saturating_sub(1)).map(piece).collect();
        JointValue::try_pieces(self.times.to_vec(), pieces).map_err(Fault::from)
    }
}
