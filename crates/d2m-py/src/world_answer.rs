//! Bodies of a world, and what is known of pairs of them.

use pyo3::prelude::*;

/// Names a body of one `World`: equal only to itself, never reused.
///
/// >>> import d2m_ccd
/// >>> world = d2m_ccd.World()
/// >>> world.add("shape:box", name="table")
/// BodyId(0, 'table')
#[pyclass(frozen, eq, hash, module = "d2m_ccd", from_py_object)]
#[derive(Clone)]
pub(crate) struct BodyId {
    pub(crate) world: u64,
    pub(crate) id: d2m::BodyId,
    pub(crate) name: Option<String>,
}

impl PartialEq for BodyId {
    fn eq(&self, other: &Self) -> bool {
        (self.world, self.id) == (other.world, other.id)
    }
}

impl std::hash::Hash for BodyId {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        (self.world, self.id).hash(state);
    }
}

#[pymethods]
impl BodyId {
    /// The place of the body. Without removals bodies are numbered in the order in which they were added, from 0.
    #[getter]
    const fn index(&self) -> usize {
        self.id.index()
    }

    /// The name that the user gave it.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    fn __repr__(&self) -> String {
        match &self.name {
            Some(name) => format!("BodyId({}, '{name}')", self.id.index()),
            None => format!("BodyId({})", self.id.index()),
        }
    }
}

/// Two bodies of a world and what is known of them: a `Contact`, or an `Undecided`.
///
/// >>> import d2m_ccd
/// >>> world = d2m_ccd.World()
/// >>> ids = [world.add("shape:box", {"x": [x, 0, 0], "v": [-x, 0, 0]}) for x in (0.0, 9.0)]
/// >>> [(pair.a.index, pair.b.index, pair.answer.status) for pair in world.contacts()]
/// [(0, 1, 'contact')]
#[pyclass(frozen, get_all, module = "d2m_ccd")]
pub(crate) struct PairContact {
    /// The body with the smaller index.
    pub(crate) a: BodyId,
    /// The other body.
    pub(crate) b: BodyId,
    /// What is known of them.
    pub(crate) answer: Py<PyAny>,
}

#[pymethods]
impl PairContact {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!(
            "PairContact({}, {}, {})",
            self.a.__repr__(),
            self.b.__repr__(),
            self.answer.bind(py).repr()?
        ))
    }
}

/// The first contact of a world.
///
/// `status` "separated": certified, no two bodies meet in the window. "contact": certified, none meet before `contact.time_lo`, and
/// `a` and `b` do by `contact.time_hi`; `overlapping` are the other contacts whose brackets begin before this one's ends.
/// "undecided": certified until `clear_until`. It has no truth value: ask for its status.
///
/// >>> import d2m_ccd
/// >>> d2m_ccd.World().first_contact()
/// FirstContact('separated')
#[pyclass(frozen, get_all, module = "d2m_ccd")]
pub(crate) struct FirstContact {
    /// "separated", "contact" or "undecided".
    pub(crate) status: &'static str,
    /// The body with the smaller index, if there is a contact or an undecided pair.
    pub(crate) a: Option<BodyId>,
    /// The other body.
    pub(crate) b: Option<BodyId>,
    /// Their contact, or `None`.
    pub(crate) contact: Option<Py<PyAny>>,
    /// Contacts that may be as early, a list of `PairContact`.
    pub(crate) overlapping: Vec<Py<PairContact>>,
    /// Certified: no contact of any pair until here; infinite when separated.
    pub(crate) clear_until: f64,
}

#[pymethods]
impl FirstContact {
    fn __bool__(&self) -> PyResult<bool> {
        let message = "FirstContact has no truth value: compare its status with \"separated\"";
        Err(pyo3::exceptions::PyTypeError::new_err(message))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let pair = match (&self.a, &self.b) {
            (Some(a), Some(b)) => format!(", {}, {}", a.__repr__(), b.__repr__()),
            _ => String::new(),
        };
        let rest = match &self.contact {
            Some(contact) => format!(", {}", contact.bind(py).repr()?),
            None if self.status == "undecided" => format!(", clear_until={:?}", self.clear_until),
            None => String::new(),
        };
        Ok(format!("FirstContact('{}'{pair}{rest})", self.status))
    }
}
