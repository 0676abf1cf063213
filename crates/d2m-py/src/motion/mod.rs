//! Motions as classes.

mod chain;
mod constant_twist;
mod keyframes;
mod screw;
mod spline;

pub(crate) use chain::{Chain, Joint, joint_list};
pub(crate) use constant_twist::{ConstantTwist, twist_of_row};
pub(crate) use keyframes::{Keyframes, span_named};
pub(crate) use screw::Screw;
pub(crate) use spline::{Spline, degree_of};

use crate::arrays::{Doubles, vector};
use crate::fault::{Fault, OrRaise};
use crate::pose::Pose;
use d2m::SharedMotion;
use d2m::bvh::MeshTree;
use d2m::motion::{AnyMotion, RigidMotion};
use d2m_io::check_keyframes;
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::sync::Arc;

type Vector<'py> = Bound<'py, PyArray1<f64>>;

/// How a body moves; the base class of all motions.
///
/// Subclasses: `ConstantTwist`, `Screw`, `Keyframes`, `Spline`, `Chain`. Motions are immutable and may be shared by threads
/// and bodies. Time in any unit, angles in radians. Arguments that take a motion also take thirteen numbers (q, x, v, w), a
/// dictionary of the JSON forms of the command line, and `None` for a body at rest whose frame is the world's.
///
/// >>> import d2m_ccd
/// >>> motion = d2m_ccd.Motion.from_json('{"x": [0, 0, 2], "v": [0, 0, -4]}')
/// >>> motion.pose(0.25).x.tolist()
/// [0.0, 0.0, 1.0]
#[pyclass(frozen, subclass, module = "d2m_ccd")]
pub(crate) struct Motion {
    pub(crate) form: Form,
}

/// What a motion holds.
#[derive(Clone)]
pub(crate) enum Form {
    Any(Arc<AnyMotion>),
    Spline(Arc<d2m::motion::Spline>),
}

impl Form {
    /// To be asked.
    pub(crate) fn motion(&self) -> &(dyn RigidMotion + Send + Sync) {
        match self {
            Self::Any(motion) => &**motion,
            Self::Spline(motion) => &**motion,
        }
    }

    /// To be kept.
    pub(crate) fn shared(&self) -> SharedMotion {
        match self {
            Self::Any(motion) => Arc::clone(motion) as SharedMotion,
            Self::Spline(motion) => Arc::clone(motion) as SharedMotion,
        }
    }

    /// Spans of keyframes must meet, to a part of the body's size.
    pub(crate) fn check_size(&self, tree: &MeshTree) -> Result<(), Fault> {
        let Self::Any(motion) = self else { return Ok(()) };
        Ok(check_keyframes(motion, tree.mesh())?)
    }

    /// The same for a body of this size, which may have several meshes.
    pub(crate) fn check_for(&self, size: f64) -> Result<(), Fault> {
        match self {
            Self::Any(motion) => Ok(motion.check_size(size)?),
            Self::Spline(_) => Ok(()),
        }
    }
}

impl<T: Into<AnyMotion>> From<T> for Form {
    fn from(motion: T) -> Self {
        Self::Any(Arc::new(motion.into()))
    }
}

/// An instance of a subclass.
pub(crate) fn instance<T>(class: T, form: impl Into<Form>) -> PyClassInitializer<T>
where
    T: pyo3::PyClass<BaseType = Motion>,
{
    PyClassInitializer::from(Motion { form: form.into() }).add_subclass(class)
}

#[pymethods]
impl Motion {
    /// The motion of a JSON text as the command line reads it: a constant twist, keyframes or a chain.
    ///
    /// Raises `InputError` with the place of what cannot be used.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Motion.from_json('{"v": [1, 0, 0]}')
    /// ConstantTwist(x=[0.0, 0.0, 0.0], q=[1.0, 0.0, 0.0, 0.0], v=[1.0, 0.0, 0.0], w=[0.0, 0.0, 0.0])
    #[staticmethod]
    fn from_json<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
        let motion: AnyMotion =
            serde_json::from_str(text).map_err(|error| Fault::new(format!("motion: {error}")))?;
        object(py, motion)
    }

    /// The motion as a JSON text that `from_json` and the command line read, to the last bit.
    ///
    /// Raises `InputError` for splines, which have no such form.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Chain([d2m_ccd.Joint("revolute", axis=[0, 0, 1], value=[0, 2])]).to_json()
    /// '{"chain":[{"x":[0.0,0.0,0.0],"q":[1.0,0.0,0.0,0.0],"joint":"revolute","axis":[0.0,0.0,1.0],"value":[0.0,2.0]}]}'
    fn to_json(&self) -> PyResult<String> {
        match &self.form {
            Form::Any(motion) => {
                serde_json::to_string(&**motion).map_err(|error| Fault::new(error.to_string()).into())
            }
            Form::Spline(_) => Err(Fault::new("a spline has no JSON form").into()),
        }
    }

    /// The pose at a time, rounded. It proves nothing.
    ///
    /// Raises `InputError` for a time at which the motion is not defined.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.ConstantTwist(v=[1, 2, 3]).pose(2.0).x.tolist()
    /// [2.0, 4.0, 6.0]
    fn pose(&self, time: f64) -> PyResult<Pose> {
        self.check_time(time)?;
        Ok(Pose { pose: self.form.motion().pose_and_twist(time).0 })
    }

    /// Velocity of the body point `at` and angular velocity at a time, world axes, rounded: a list of two arrays of shape (3,).
    ///
    /// Raises `InputError` for a time at which the motion is not defined.
    ///
    /// >>> import d2m_ccd
    /// >>> v, w = d2m_ccd.ConstantTwist(v=[1, 2, 3]).twist(2.0)
    /// >>> v.tolist()
    /// [1.0, 2.0, 3.0]
    fn twist<'py>(&self, py: Python<'py>, time: f64) -> PyResult<[Vector<'py>; 2]> {
        self.check_time(time)?;
        let twist = self.form.motion().pose_and_twist(time).1;
        Ok([vector(py, &twist.linear.to_array()), vector(py, &twist.angular.to_array())])
    }

    /// First and last time at which the motion is defined; infinite where there is none.
    #[getter]
    fn domain(&self) -> (f64, f64) {
        let domain = self.form.motion().domain();
        (domain.lo(), domain.hi())
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let (start, end) = slf.get().domain();
        Ok(format!("{}({start:?} to {end:?})", slf.get_type().name()?))
    }

    fn __eq__(&self, other: &Self) -> bool {
        match (&self.form, &other.form) {
            (Form::Any(one), Form::Any(other)) => one == other,
            (Form::Spline(one), Form::Spline(other)) => one == other,
            _ => false,
        }
    }

    fn __hash__(&self) -> u64 {
        let motion = self.form.motion();
        let domain = motion.domain();
        let start = domain.lo().max(domain.hi().min(0.0));
        let pose = motion.pose_and_twist(start).0;
        crate::pose::hash_of(&[pose.translation.to_array(), pose.rotation.xyz().to_array()].concat())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let read = py.get_type::<Self>().getattr(intern!(py, "from_json"))?;
        (read, (slf.get().to_json()?,)).into_pyobject(py)
    }
}

impl Motion {
    fn check_time(&self, time: f64) -> PyResult<()> {
        let domain = self.form.motion().domain();
        if time.is_finite() && domain.contains(time) {
            return Ok(());
        }
        let message =
            format!("time {time:?} is not within [{:?}, {:?}] of the motion", domain.lo(), domain.hi());
        Err(Fault::new(message).found(time).into())
    }
}

/// The motion as an instance of its class.
fn object(py: Python<'_>, motion: AnyMotion) -> PyResult<Bound<'_, PyAny>> {
    let form = Form::from(motion);
    let Form::Any(motion) = &form else { unreachable!("it was made of one") };
    Ok(match &**motion {
        AnyMotion::ConstantTwist(twist) => Bound::new(py, ConstantTwist::of(*twist))?.into_any(),
        AnyMotion::Keyframes(_) => Bound::new(py, instance(Keyframes, form.clone()))?.into_any(),
        AnyMotion::Chain(_) => Bound::new(py, instance(Chain, form.clone()))?.into_any(),
        _ => Bound::new(py, Motion { form: form.clone() })?.into_any(),
    })
}

/// The argument of [`motion_argument`] as a `Motion`, which nothing changes and which pickles.
pub(crate) fn motion_object<'py>(any: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    if any.is_instance_of::<Motion>() {
        return Ok(any.clone());
    }
    match motion_argument(Some(any), name)? {
        Form::Any(motion) => object(any.py(), (*motion).clone()),
        form @ Form::Spline(_) => Ok(Bound::new(any.py(), Motion { form })?.into_any()),
    }
}

/// A motion argument: a `Motion`, thirteen numbers, a dictionary of the JSON forms, or nothing.
///
/// # Errors
/// Anything else, and numbers that are no motion.
pub(crate) fn motion_argument(any: Option<&Bound<'_, PyAny>>, name: &str) -> PyResult<Form> {
    let Some(any) = any else { return Ok(d2m::ConstantTwist::REST.into()) };
    if let Ok(motion) = any.cast::<Motion>() {
        return Ok(motion.get().form.clone());
    }
    if any.is_instance_of::<PyDict>() {
        let text = json_text(any, name)?;
        let motion: AnyMotion =
            serde_json::from_str(&text).map_err(|error| Fault::new(format!("{name}: {error}")))?;
        return Ok(motion.into());
    }
    if any.hasattr(intern!(any.py(), "__len__"))? {
        let row = Doubles::new(any, name, &[Some(13)])?;
        return Ok(twist_of_row(row.slice()).map_err(|fault| fault.within(name)).or_raise()?.into());
    }
    Err(PyTypeError::new_err(format!(
        "{name} is a {}: a Motion, 13 numbers (q, x, v, w), a dictionary or None is expected",
        any.get_type().name()?
    )))
}

/// A dictionary, which may hold arrays, as JSON.
fn json_text(any: &Bound<'_, PyAny>, name: &str) -> PyResult<String> {
    let py = any.py();
    let text = py.import(intern!(py, "d2m_ccd._json"))?.call_method1("dumps", (any,));
    text.map_err(|error| Fault::new(format!("{name}: {}", error.value(py))))?.extract()
}
