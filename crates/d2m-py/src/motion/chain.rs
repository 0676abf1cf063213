//! Links of articulated arms.

use super::{Motion, instance};
use crate::arrays::{Doubles, small, vector};
use crate::fault::{Fault, OrRaise, Value};
use crate::pose::{list, quaternion, vec3_or_zero, wxyz};
use d2m::motion::{JointKind, JointValue};
use glam::{DQuat, DVec3};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// A joint of an arm: a fixed transform (x, q) from the frame before, then the joint.
///
/// `kind` is "fixed", "revolute" (turns by the value, in radians, about the axis) or "prismatic" (shifts by the value along
/// it); the axis, shape (3,), is normalised. `value` is a polynomial in time, coefficients of shape (c,) from the constant on, or
/// pieces: a tuple (times, pieces) with times of shape (m + 1,) and m lists of coefficients, each in t − times[i]. Without
/// a value the joint is open, for `JointTrajectories` to give it one.
///
/// Raises `InputError` for numbers that are not finite, an axis of length zero, pieces that do not meet to 1e-9.
///
/// >>> import d2m_ccd
/// >>> d2m_ccd.Joint("revolute", x=[0, 0, 1], axis=[0, 0, 1], value=[0, 2])
/// Joint('revolute', x=[0.0, 0.0, 1.0], q=[1.0, 0.0, 0.0, 0.0], axis=[0.0, 0.0, 1.0], value=[[0.0, 2.0]])
#[pyclass(frozen, module = "d2m_ccd", from_py_object)]
#[derive(Clone)]
pub(crate) struct Joint {
    x: DVec3,
    q: DQuat,
    pub(crate) moving: Option<Moving>,
}

/// What a joint does that is not fixed.
#[derive(Clone)]
pub(crate) struct Moving {
    turns: bool,
    axis: DVec3,
    value: Option<JointValue>,
}

impl Joint {
    /// The joint with its own value, or with this one.
    ///
    /// # Errors
    /// Neither has one, or both do; an axis of length zero.
    pub(crate) fn with_value(&self, given: Option<JointValue>) -> Result<d2m::motion::Joint, Fault> {
        let kind = match &self.moving {
            None => JointKind::Fixed,
            Some(Moving { turns, axis, value }) => {
                let value = given.or_else(|| value.clone());
                let value = value.ok_or_else(|| Fault::new("value: a joint that moves needs one"))?;
                let axis = *axis;
                if *turns {
                    JointKind::Revolute { axis, value }
                } else {
                    JointKind::Prismatic { axis, value }
                }
            }
        };
        Ok(d2m::motion::Joint::try_new(self.x, self.q, kind)?)
    }

    /// Does it wait for a value?
    pub(crate) fn is_open(&self) -> bool {
        self.moving.as_ref().is_some_and(|moving| moving.value.is_none())
    }
}

#[pymethods]
impl Joint {
    #[new]
    #[pyo3(signature = (kind="fixed", *, x=None, q=None, axis=None, value=None))]
    fn new(
        kind: &str,
        x: Option<&Bound<'_, PyAny>>,
        q: Option<&Bound<'_, PyAny>>,
        axis: Option<&Bound<'_, PyAny>>,
        value: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let x = vec3_or_zero(x, "x")?;
        let q = q.map_or(Ok(DQuat::IDENTITY), |q| quaternion(q, "q"))?;
        let turns = match kind {
            "fixed" => {
                if let Some(name) = axis.map(|_| "axis").or(value.map(|_| "value")) {
                    return Err(Fault::new(format!("{name}: a fixed joint has none")).into());
                }
                return Ok(Self { x, q, moving: None });
            }
            "revolute" => true,
            "prismatic" => false,
            other => {
                let message =
                    format!("kind is {other:?}: \"fixed\", \"revolute\" or \"prismatic\" is expected");
                return Err(Fault::new(message).with_value(Value::Text(other.to_owned())).into());
            }
        };
        let Some(axis) = axis else {
            return Err(Fault::new(format!("axis: a {kind} joint needs one")).into());
        };
        let axis = DVec3::from_array(small(axis, "axis")?);
        let value = value.map(joint_value).transpose()?;
        let joint = Self { x, q, moving: Some(Moving { turns, axis, value }) };
        joint.with_value(Some(JointValue::try_constant(0.0).or_raise()?)).or_raise()?;
        Ok(joint)
    }

    /// "fixed", "revolute" or "prismatic".
    #[getter]
    fn kind(&self) -> &'static str {
        match &self.moving {
            None => "fixed",
            Some(Moving { turns: true, .. }) => "revolute",
            Some(_) => "prismatic",
        }
    }

    /// Position of the joint in the frame before it, shape (3,).
    #[getter]
    fn x<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.x.to_array())
    }

    /// Turn of the joint in the frame before it, (w, x, y, z), shape (4,).
    #[getter]
    fn q<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &wxyz(self.q))
    }

    /// The axis as given, shape (3,); `None` of a fixed joint.
    #[getter]
    fn axis<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        Some(vector(py, &self.moving.as_ref()?.axis.to_array()))
    }

    fn __repr__(&self) -> String {
        let place = format!("x={}, q={}", list(&self.x.to_array()), list(&wxyz(self.q)));
        let rest = match &self.moving {
            None => String::new(),
            Some(Moving { axis, value, .. }) => {
                let value = value.as_ref().map(|value| format!("{:?}", value.pieces().collect::<Vec<_>>()));
                let value = value.map_or_else(String::new, |value| format!(", value={value}"));
                format!(", axis={}{value}", list(&axis.to_array()))
            }
        };
        format!("Joint('{}', {place}{rest})", self.kind())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let value = self.moving.as_ref().and_then(|moving| moving.value.as_ref());
        let value = value.map(serde_json::to_string).transpose();
        let value = value.map_err(|error| Fault::new(error.to_string()))?;
        let rebuild = py.import("d2m_ccd._rebuild")?.getattr("joint")?;
        let arguments = (self.kind(), self.x(py), self.q(py), self.axis(py), value);
        (rebuild, arguments).into_pyobject(py)
    }
}

/// A polynomial, a tuple (times, pieces), or a dictionary of the JSON form.
fn joint_value(any: &Bound<'_, PyAny>) -> PyResult<JointValue> {
    let (times, pieces) = if any.is_instance_of::<PyDict>() {
        let text = crate::motion::json_text(any, "value")?;
        return serde_json::from_str(&text).map_err(|error| Fault::new(format!("value: {error}")).into());
    } else if let Ok(tuple) = any.cast::<PyTuple>()
        && tuple.len() == 2
        && tuple.get_item(1)?.hasattr(intern!(any.py(), "__len__"))?
    {
        (tuple.get_item(0)?, tuple.get_item(1)?)
    } else {
        let numbers = Doubles::new(any, "value", &[None])?;
        return JointValue::try_polynomial(numbers.slice().to_vec()).or_raise();
    };
    let times = Doubles::new(&times, "value, times", &[None])?.slice().to_vec();
    let piece = |piece: PyResult<Bound<'_, PyAny>>| {
        Ok(Doubles::new(&piece?, "value, pieces", &[None])?.slice().to_vec())
    };
    let pieces = pieces.try_iter()?.map(piece).collect::<PyResult<Vec<_>>>()?;
    JointValue::try_pieces(times, pieces).or_raise()
}

/// The joints of a sequence of `Joint` or of dictionaries of the JSON form.
pub(crate) fn joint_list(any: &Bound<'_, PyAny>) -> PyResult<Vec<Joint>> {
    let joint = |any: PyResult<Bound<'_, PyAny>>| {
        let any = any?;
        if let Ok(joint) = any.cast::<Joint>() {
            return Ok(joint.get().clone());
        }
        let Ok(given) = any.cast::<PyDict>() else {
            return Err(PyTypeError::new_err("joints: each must be a Joint or a dictionary"));
        };
        let keywords = given.copy()?;
        let kind = keywords.get_item("joint")?;
        if kind.is_some() {
            keywords.del_item("joint")?;
        }
        let kind = kind.map_or(Ok("fixed".to_owned()), |kind| kind.extract::<String>())?;
        let class = any.py().get_type::<Joint>();
        Ok(class.call((kind,), Some(&keywords))?.cast_into::<Joint>()?.get().clone())
    };
    any.try_iter()?.map(joint).collect()
}

/// A link of an articulated arm: its pose is the product of all joints from the base on.
///
/// Takes a sequence of `Joint`, or of dictionaries {"x", "q", "joint", "axis", "value"} as in the JSON form.
///
/// Raises `InputError` with the joint's index: no joints, one without a value, values that share no times.
///
/// >>> import d2m_ccd
/// >>> arm = d2m_ccd.Chain([d2m_ccd.Joint("revolute", axis=[0, 0, 1], value=[0, 2]), d2m_ccd.Joint(x=[1, 0, 0])])
/// >>> arm.twist(0.0)[0].tolist()
/// [0.0, 2.0, 0.0]
#[pyclass(frozen, extends = Motion, module = "d2m_ccd")]
pub(crate) struct Chain;

#[pymethods]
impl Chain {
    #[new]
    fn new(joints: &Bound<'_, PyAny>) -> PyResult<PyClassInitializer<Self>> {
        let joints = joint_list(joints)?.into_iter().enumerate().map(|(index, joint)| {
            joint.with_value(None).map_err(|fault| fault.within(&format!("chain[{index}]")).at(index))
        });
        let joints = joints.collect::<Result<Vec<_>, Fault>>().or_raise()?;
        Ok(instance(Self, d2m::motion::Chain::try_new(joints).or_raise()?))
    }
}
