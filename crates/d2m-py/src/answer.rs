//! Answers about moving bodies.

use crate::arrays::vector;
use crate::fault::Fault;
use crate::pose::list;
use d2m::bvh::{Contact as Found, TimeOfContact};
use d2m_io::{feature_field, start_word};
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// What a query of moving bodies answers: `Separated`, `Contact` or `Undecided`.
///
/// `status` is "separated", "contact" or "undecided". An answer has no truth value: ask for its status.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box")
/// >>> d2m_ccd.time_of_contact(box, box, [1, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0]).status
/// 'separated'
#[pyclass(frozen, subclass, module = "d2m_ccd")]
pub(crate) struct Answer {
    pub(crate) answer: TimeOfContact,
}

#[pymethods]
impl Answer {
    /// "separated", "contact" or "undecided".
    #[getter]
    fn status(&self) -> &'static str {
        match self.answer {
            TimeOfContact::Separated => "separated",
            TimeOfContact::Contact(_) => "contact",
            TimeOfContact::Undecided { .. } => "undecided",
        }
    }

    /// Certified: no contact from the start of the window until here; infinite when separated.
    #[getter]
    const fn clear_until(&self) -> f64 {
        match &self.answer {
            TimeOfContact::Separated => f64::INFINITY,
            TimeOfContact::Contact(contact) => contact.time_lo,
            TimeOfContact::Undecided { clear_until } => *clear_until,
        }
    }

    /// The answer as a JSON text with the names of the command line's `toc --json`.
    ///
    /// >>> import d2m_ccd
    /// >>> box = d2m_ccd.Tree("shape:box")
    /// >>> d2m_ccd.time_of_contact(box, box, [1, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0]).to_json()
    /// '{"status":"separated"}'
    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&self.answer).map_err(|error| Fault::new(error.to_string()).into())
    }

    #[staticmethod]
    fn _from_json<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
        let answer = serde_json::from_str(text).map_err(|error| Fault::new(format!("answer: {error}")))?;
        object(py, answer)
    }

    fn __bool__(slf: &Bound<'_, Self>) -> PyResult<bool> {
        Err(PyTypeError::new_err(format!(
            "{} has no truth value: compare its status with \"separated\", \"contact\" or \"undecided\"",
            slf.get_type().name()?
        )))
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.answer == other.answer
    }

    fn __hash__(&self) -> u64 {
        crate::pose::hash_of(&[self.clear_until()])
    }

    fn __repr__(&self) -> String {
        match &self.answer {
            TimeOfContact::Separated => "Separated()".to_owned(),
            TimeOfContact::Contact(contact) => contact_text(contact),
            TimeOfContact::Undecided { clear_until } => format!("Undecided(clear_until={clear_until:?})"),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        let read = py.get_type::<Self>().getattr(intern!(py, "_from_json"))?;
        (read, (slf.get().to_json()?,)).into_pyobject(py)
    }
}

fn contact_text(contact: &Found) -> String {
    format!(
        "Contact(time=[{:?}, {:?}], evidence='{}', separation={:?}, start='{}', normal={}, point_a={}, point_b={}, feature='{}')",
        contact.time_lo,
        contact.time_hi,
        contact.evidence,
        contact.separation,
        start_word(contact.start),
        list(&contact.normal.to_array()),
        list(&contact.point_a.to_array()),
        list(&contact.point_b.to_array()),
        feature_field(contact.feature),
    )
}

/// Certified: the bodies do not meet anywhere in the window.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box")
/// >>> d2m_ccd.time_of_contact(box, box, [1, 0, 0, 0, 9, 0, 0, 0, 0, 0, 0, 0, 0])
/// Separated()
#[pyclass(frozen, extends = Answer, module = "d2m_ccd")]
pub(crate) struct Separated;

/// The budget ran out, or a motion encloses itself too widely: certified only until `clear_until`.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box")
/// >>> d2m_ccd.time_of_contact(box, box, {"x": [9, 0, 0], "v": [-9, 0, 0]}, node_tests=0).status
/// 'undecided'
#[pyclass(frozen, extends = Answer, module = "d2m_ccd")]
pub(crate) struct Undecided;

/// The first contact of bodies A and B.
///
/// Certified: no contact from the start of the window to `time_lo`; what is proven of the meeting by `time_hi` is said by
/// `evidence`: "crossing" (they share a point), "near" (their distance is at most `min_separation` + `tolerance`) or "early"
/// (nothing). Times, lengths and world axes are those of the query.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> contact = d2m_ccd.time_of_contact(box, box, {"x": [0, 0, 3], "v": [0, 0, -4]})
/// >>> contact.status, round(contact.time_lo, 9), contact.normal.round(9).tolist(), contact.start
/// ('contact', 0.5, [0.0, 0.0, -1.0], 'apart')
#[pyclass(frozen, extends = Answer, module = "d2m_ccd")]
pub(crate) struct Contact {
    found: Found,
}

#[pymethods]
impl Contact {
    /// Certified free until here.
    #[getter]
    fn time_lo(&self) -> f64 {
        self.found.time_lo
    }

    /// By here the bodies had met in the sense of `evidence`.
    #[getter]
    fn time_hi(&self) -> f64 {
        self.found.time_hi
    }

    /// "crossing", "near" or "early".
    #[getter]
    fn evidence(&self) -> String {
        self.found.evidence.to_string()
    }

    /// Separation left at `time_lo`.
    #[getter]
    fn separation(&self) -> f64 {
        self.found.separation
    }

    /// The tolerance that was used: that of the query, unless rounding forbids it.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.found.tolerance
    }

    /// Unit normal from A to B at `time_lo`, world axes, shape (3,).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.found.normal.to_array())
    }

    /// Witness point on A at `time_lo`, world frame, shape (3,).
    #[getter]
    fn point_a<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.found.point_a.to_array())
    }

    /// Witness point on B at `time_lo`, world frame, shape (3,).
    #[getter]
    fn point_b<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.found.point_b.to_array())
    }

    /// The features that meet: "vertex_face:V:F", "face_vertex:F:V" or "edge_edge:P-Q:R-S", those of A first.
    #[getter]
    fn feature(&self) -> String {
        feature_field(self.found.feature)
    }

    /// Triangle of A.
    #[getter]
    fn triangle_a(&self) -> u32 {
        self.found.triangle_a
    }

    /// Triangle of B.
    #[getter]
    fn triangle_b(&self) -> u32 {
        self.found.triangle_b
    }

    /// Barycentric coordinates of `point_a` in `triangle_a`, shape (3,).
    #[getter]
    fn barycentric_a<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.found.barycentric_a)
    }

    /// Barycentric coordinates of `point_b` in `triangle_b`, shape (3,).
    #[getter]
    fn barycentric_b<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.found.barycentric_b)
    }

    /// Relative speed of the witness points along the normal at `time_lo`; positive when they close.
    #[getter]
    fn closing_speed(&self) -> f64 {
        self.found.closing_speed
    }

    /// Of a query with `start="leave"`: (lo, hi), when the bodies had parted before; else `None`.
    #[getter]
    fn left(&self) -> Option<(f64, f64)> {
        self.found.left.map(|left| (left.lo, left.hi))
    }

    /// How the bodies stood at the start of the window: "apart", "touching", "overlapping", "contained" or
    /// "undecided" (neither touching nor overlapping is proven).
    #[getter]
    fn start(&self) -> &'static str {
        start_word(self.found.start)
    }
}

/// The answer as an instance of its class.
pub(crate) fn object(py: Python<'_>, answer: TimeOfContact) -> PyResult<Bound<'_, PyAny>> {
    let base = PyClassInitializer::from(Answer { answer });
    Ok(match answer {
        TimeOfContact::Separated => Bound::new(py, base.add_subclass(Separated))?.into_any(),
        TimeOfContact::Contact(found) => Bound::new(py, base.add_subclass(Contact { found }))?.into_any(),
        TimeOfContact::Undecided { .. } => Bound::new(py, base.add_subclass(Undecided))?.into_any(),
    })
}
