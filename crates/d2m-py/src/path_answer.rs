//! Answers about paths and edges of robots.

use crate::answer;
use crate::fault::Fault;
use crate::questions::clearance_word;
use crate::record::Meeting;
use d2m::TimeOfContact;
use d2m_robot::{LimitKind, LimitWarning, PathAnswer as Found};
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::HashMap;

/// What is known of a path or an edge of a `Robot`.
///
/// `status` "free": certified, no pair of links or bodies meets. "contact": certified free before `contact.time_lo`, and `a` and `b`
/// meet by `contact.time_hi`. "undecided": certified free until `free_until`. It has no truth value: ask for its status.
///
/// >>> import d2m_ccd
/// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
/// >>> robot.check_edge([0.0], [1.0])
/// PathAnswer('free', free_until=1.0)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct PathAnswer {
    /// "free", "contact" or "undecided".
    #[pyo3(get)]
    status: &'static str,
    /// The end of what is proven free: a time of the path, or a part of an edge. Planners call it the last valid one.
    #[pyo3(get)]
    free_until: f64,
    /// The link or body that meets first, or is undecided first; `None` where the path is free.
    #[pyo3(get)]
    a: Option<String>,
    /// The other one.
    #[pyo3(get)]
    b: Option<String>,
    /// Their contact, in the world's frame, or `None`.
    #[pyo3(get)]
    contact: Option<Py<PyAny>>,
    pub(crate) found: Found,
}

#[pymethods]
impl PathAnswer {
    /// What `__reduce__` has written.
    #[staticmethod]
    fn _from_json(py: Python<'_>, text: &str) -> PyResult<Self> {
        let found = serde_json::from_str(text).map_err(|error| Fault::new(format!("answer: {error}")))?;
        Self::of(py, found)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.found == other.found
    }

    fn __hash__(&self) -> u64 {
        crate::pose::hash_of(&[self.free_until])
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let text = serde_json::to_string(&slf.get().found).map_err(|error| Fault::new(error.to_string()))?;
        (slf.get_type().getattr(intern!(py, "_from_json"))?, (text,)).into_pyobject(py)
    }

    fn __bool__(&self) -> PyResult<bool> {
        let message = "PathAnswer has no truth value: compare its status with \"free\"";
        Err(PyTypeError::new_err(message))
    }

    fn __repr__(&self) -> String {
        match (&self.a, &self.b) {
            (Some(a), Some(b)) => {
                format!("PathAnswer('{}', free_until={:?}, a='{a}', b='{b}')", self.status, self.free_until)
            }
            _ => format!("PathAnswer('{}', free_until={:?})", self.status, self.free_until),
        }
    }
}

impl PathAnswer {
    pub(crate) fn of(py: Python<'_>, found: Found) -> PyResult<Self> {
        let free_until = found.free_until();
        let (status, a, b) = match &found {
            Found::Free { .. } => ("free", None, None),
            Found::Contact(found) => ("contact", Some(found.a.clone()), Some(found.b.clone())),
            Found::Undecided { a, b, .. } => ("undecided", Some(a.clone()), Some(b.clone())),
        };
        let contact = found.contact().map(|found| answer::object(py, TimeOfContact::Contact(found.contact)));
        let contact = contact.transpose()?.map(Bound::unbind);
        Ok(Self { status, free_until, a, b, contact, found })
    }
}

/// How near a path comes to a contact: the least distance of all pairs that are checked, less the minimum separation of the pair.
///
/// >>> import d2m_ccd
/// >>> robot = d2m_ccd.Robot(d2m_ccd.EXAMPLE_URDF)
/// >>> robot.add_obstacle("wall", "shape:box?x=0.05&y=0.05&z=0.5", [1, 0, 0, 0, 0, 0.7, 0])
/// >>> near = robot.clearance([0.0, 1.0], [[0.0], [1.0]])
/// >>> near.status, near.a, near.b, near.lower <= near.upper, near.time
/// ('clear', 'arm', 'wall', True, 1.0)
#[pyclass(frozen, get_all, module = "d2m_ccd")]
pub(crate) struct PathClearance {
    /// "clear", "contact" or "undecided": of all pairs.
    status: &'static str,
    /// Proven: no pair comes nearer at any time.
    lower: f64,
    /// Proven: the pair `a`, `b` is at most this far apart at `time`.
    upper: f64,
    /// When.
    time: f64,
    /// The link or body that is nearest.
    a: String,
    /// The other one.
    b: String,
}

#[pymethods]
impl PathClearance {
    fn __repr__(&self) -> String {
        let Self { status, lower, upper, time, a, b } = self;
        format!("PathClearance('{status}', bounds=[{lower:?}, {upper:?}], time={time:?}, a='{a}', b='{b}')")
    }
}

impl From<d2m_robot::PathClearance> for PathClearance {
    fn from(found: d2m_robot::PathClearance) -> Self {
        let d2m_robot::PathClearance { lower, upper, time, a, b, status, .. } = found;
        Self { status: clearance_word(status), lower, upper, time, a, b }
    }
}

/// What a record of an edge holds.
pub(crate) fn meeting(found: &Found, places: &HashMap<&str, u32>) -> Meeting {
    let place = |name: &str| places.get(name).copied();
    let (answer, a, b) = match found {
        Found::Free { .. } => (TimeOfContact::Separated, None, None),
        Found::Contact(found) => (TimeOfContact::Contact(found.contact), place(&found.a), place(&found.b)),
        Found::Undecided { free_until, a, b, .. } => {
            (TimeOfContact::Undecided { clear_until: *free_until }, place(a), place(b))
        }
    };
    Meeting { answer, free_until: found.free_until(), bodies: [a, b] }
}

/// A joint beyond its limit, as a dictionary.
pub(crate) fn limit_warning<'py>(py: Python<'py>, found: &LimitWarning) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("joint", &found.joint)?;
    dict.set_item("kind", if found.kind == LimitKind::Position { "position" } else { "velocity" })?;
    dict.set_item("time", found.time)?;
    dict.set_item("point", found.point)?;
    dict.set_item("value", found.value)?;
    dict.set_item("limit", found.limit)?;
    dict.set_item("is_certain", found.is_certain)?;
    Ok(dict)
}
