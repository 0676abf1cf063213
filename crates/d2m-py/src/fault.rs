//! Errors as Python sees them: `InputError` with message, index and value.

use d2m::WorldError;
use d2m::bvh::{MeshError, QueryError, TreeFileError};
use d2m::motion::{MotionError, OutsideDomain};
use d2m::shapes::ShapeError;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// Bad input, before it becomes an exception: made on any thread, without Python.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    message: String,
    index: Index,
    value: Value,
}

/// Where the fault is.
#[derive(Clone, Debug, Default)]
pub(crate) enum Index {
    /// Nowhere in particular.
    #[default]
    None,
    /// In a list.
    Place(usize),
    /// In an array of several dimensions.
    Places(Vec<usize>),
}

/// What was found there.
#[derive(Clone, Debug, Default)]
pub(crate) enum Value {
    /// Nothing to be shown.
    #[default]
    None,
    /// A number.
    Number(f64),
    /// A whole number.
    Whole(i128),
    /// Several numbers.
    Numbers(Vec<f64>),
    /// A word.
    Text(String),
}

impl Fault {
    /// With nothing but a message.
    pub(crate) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into(), index: Index::None, value: Value::None }
    }

    /// At this place of a list.
    pub(crate) fn at(self, index: usize) -> Self {
        Self { index: Index::Place(index), ..self }
    }

    /// At this place of an array.
    pub(crate) fn at_places(self, places: Vec<usize>) -> Self {
        Self { index: Index::Places(places), ..self }
    }

    /// Where this number was found.
    pub(crate) fn found(self, value: f64) -> Self {
        Self { value: Value::Number(value), ..self }
    }

    /// Where this value was found.
    pub(crate) fn with_value(self, value: Value) -> Self {
        Self { value, ..self }
    }

    /// The same as a fault of a trial of a batch: its place is the trial.
    pub(crate) fn of_trial(self, trial: usize) -> Self {
        let message = format!("trial {trial}: {}", self.message);
        Self { message, index: Index::Place(trial), ..self }
    }

    /// The same with the name of the argument in front.
    pub(crate) fn within(self, name: &str) -> Self {
        Self { message: format!("{name}: {}", self.message), ..self }
    }
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        Python::attach(|py| exception(py, fault).unwrap_or_else(|error| error))
    }
}

fn exception(py: Python<'_>, fault: Fault) -> PyResult<PyErr> {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let Fault { message, index, value } = fault;
    let index = match index {
        Index::None => py.None(),
        Index::Place(place) => place.into_py_any(py)?,
        Index::Places(places) => pyo3::types::PyTuple::new(py, places)?.into_py_any(py)?,
    };
    let value = match value {
        Value::None => py.None(),
        Value::Number(number) => number.into_py_any(py)?,
        Value::Whole(number) => number.into_py_any(py)?,
        Value::Numbers(numbers) => pyo3::types::PyTuple::new(py, numbers)?.into_py_any(py)?,
        Value::Text(text) => text.into_py_any(py)?,
    };
    let class = CLASS.import(py, "d2m_ccd._errors", "InputError")?;
    Ok(PyErr::from_value(class.call1((message, index, value))?))
}

impl From<MeshError> for Fault {
    fn from(error: MeshError) -> Self {
        let fault = Self::new(error.to_string());
        match error {
            MeshError::NonFiniteVertex { vertex, axis, value }
            | MeshError::VertexTooLarge { vertex, axis, value } => {
                let axis = ['x', 'y', 'z'].into_iter().position(|name| name == axis);
                fault.at_places(vec![vertex, axis.unwrap_or_default()]).found(value)
            }
            MeshError::IndexOutOfRange { triangle, index, .. } => {
                fault.at(triangle).with_value(Value::Whole(index.into()))
            }
            MeshError::TooMany { count, .. } => fault.with_value(Value::Whole(count as i128)),
            _ => fault,
        }
    }
}

impl From<QueryError> for Fault {
    fn from(error: QueryError) -> Self {
        let fault = Self::new(error.to_string());
        match error {
            QueryError::BadWindow { start, end } => fault.with_value(Value::Numbers(vec![start, end])),
            QueryError::BadTolerance { value } | QueryError::BadMinSeparation { value } => fault.found(value),
            QueryError::NotWatertight { body }
            | QueryError::BadMotion { body }
            | QueryError::BadPose { body } => fault.at(body),
            QueryError::OutsideMotion { body, outside } => fault.at(body).with_value(times_of(outside)),
            QueryError::NotApart { triangle_a, triangle_b } => {
                fault.at_places(vec![triangle_a as usize, triangle_b as usize])
            }
            _ => fault,
        }
    }
}

impl From<MotionError> for Fault {
    fn from(error: MotionError) -> Self {
        let fault = Self::new(error.to_string());
        match error {
            MotionError::NotFinite { index, value, .. } => fault.at(index).found(value),
            MotionError::OrientationNorm { w, x, y, z } => fault.with_value(Value::Numbers(vec![w, x, y, z])),
            MotionError::Keyframes { index, time, .. } | MotionError::HalfTurn { index, time } => {
                fault.at(index).found(time)
            }
            MotionError::Gap { index, gap, .. } => fault.at(index).found(gap),
            // Places are texts such as "poses[3]" there: the first number in brackets.
            MotionError::Part { place, .. } => match first_index(&place) {
                Some(index) => fault.at(index),
                None => fault,
            },
            _ => fault,
        }
    }
}

/// The number in brackets, or behind a space, of a place such as "poses[3]" or "edge 3".
pub(crate) fn first_index(place: &str) -> Option<usize> {
    let (_, after) = place.split_once('[')?;
    after.split_once(']')?.0.parse().ok()
}

impl From<TreeFileError> for Fault {
    fn from(error: TreeFileError) -> Self {
        Self::new(error.to_string())
    }
}

impl From<ShapeError> for Fault {
    fn from(error: ShapeError) -> Self {
        Self::new(error.to_string())
    }
}

impl From<WorldError> for Fault {
    fn from(error: WorldError) -> Self {
        let fault = Self::new(error.to_string());
        match error {
            WorldError::Pair { a, b, .. } => fault.at_places(vec![a.index(), b.index()]),
            WorldError::OutsideMotion { body, outside } => {
                fault.at(body.index()).with_value(times_of(outside))
            }
            _ => fault,
        }
    }
}

/// The times that the motion covers.
fn times_of(outside: OutsideDomain) -> Value {
    Value::Numbers(vec![outside.start, outside.end])
}

/// A result whose error becomes an exception.
pub(crate) trait OrRaise<T> {
    /// The value, or the exception.
    fn or_raise(self) -> PyResult<T>;
}

impl<T, E: Into<Fault>> OrRaise<T> for Result<T, E> {
    fn or_raise(self) -> PyResult<T> {
        self.map_err(|error| error.into().into())
    }
}
