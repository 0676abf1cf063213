//! Questions about the bodies of a simulation where they are now.

use crate::arrays::vector;
use crate::fault::{Fault, OrRaise, Value};
use crate::options::budget;
use crate::resting::Distance;
use crate::simulation::{Simulation, find, finite};
use d2m::bvh::QueryOptions;
use d2m_dynamics::{BodyId, Frozen as Held, RayAnswer as Met, RayError};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::collections::HashMap;

impl From<RayError> for Fault {
    fn from(error: RayError) -> Self {
        let fault = Self::new(error.to_string());
        match error {
            RayError::BadRay { origin, way } => {
                fault.with_value(Value::Numbers([origin.to_array(), way.to_array()].concat()))
            }
            RayError::World(error) => error.into(),
            _ => fault,
        }
    }
}

/// The bodies of a `Simulation` where they were when `frozen` was called; the simulation goes on without it.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> floor = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", kind="static")
/// >>> cup = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", pose=d2m_ccd.Pose(x=[0, 2, 0]))
/// >>> now = simulation.frozen()
/// >>> now.ray([0, 5, 0], [0, -10, 0]).body == cup, round(now.distance(floor, cup).value, 9)
/// (True, 1.0)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Frozen {
    held: Held,
    names: HashMap<String, usize>,
}

impl Frozen {
    fn find(&self, any: &Bound<'_, PyAny>) -> PyResult<BodyId> {
        find(any, &self.names, self.held.world().ids().map(|body| self.held.id(body)))
    }
}

#[pymethods]
impl Frozen {
    /// What a point meets first on the straight way from `origin` to `origin + way`, world frame.
    ///
    /// Raises `InputError` for numbers that are not finite.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> wall = simulation.add("shape:box?x=0.5&y=0.5&z=0.5")
    /// >>> simulation.frozen().ray([-2, 0, 0], [0, 1, 0]).status
    /// 'free'
    fn ray(&self, py: Python<'_>, origin: &Bound<'_, PyAny>, way: &Bound<'_, PyAny>) -> PyResult<RayAnswer> {
        let (origin, way) = (finite(origin, "origin")?, finite(way, "way")?);
        let met = py.detach(|| self.held.ray(origin, way)).or_raise()?;
        Ok(RayAnswer { met })
    }

    /// The distance of two bodies, whether they are ignored or not, as `d2m_ccd.distance` has it.
    ///
    /// Raises `KeyError` for a body that was not there.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> a, b = simulation.add("shape:box"), simulation.add("shape:box", pose=d2m_ccd.Pose(x=[3, 0, 0]))
    /// >>> simulation.frozen().distance(a, b).state
    /// 'apart'
    fn distance(&self, py: Python<'_>, a: &Bound<'_, PyAny>, b: &Bound<'_, PyAny>) -> PyResult<Py<Distance>> {
        let (a, b) = (self.find(a)?, self.find(b)?);
        let found = py.detach(|| self.held.distance(a, b)).or_raise()?;
        Distance::new(py, found)
    }

    fn __len__(&self) -> usize {
        self.held.world().ids().count()
    }

    fn __repr__(&self) -> String {
        format!("Frozen({} bodies)", self.__len__())
    }
}

/// What a ray meets: certified.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> wall = simulation.add("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> hit = simulation.frozen().ray([-2, 0, 0], [4, 0, 0])
/// >>> hit.status, hit.body, 1.499 < hit.lo <= 1.5, hit.normal.tolist()
/// ('hit', 0, True, [-1.0, 0.0, 0.0])
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct RayAnswer {
    met: Met,
}

#[pymethods]
impl RayAnswer {
    /// "free": nothing on its way. "hit": nothing before `lo` of its way, and `body` by `hi`. "undecided": the budget ran out; nothing before
    /// `free_until` of its way.
    #[getter]
    fn status(&self) -> &'static str {
        match self.met {
            Met::Free => "free",
            Met::Hit { .. } => "hit",
            _ => "undecided",
        }
    }

    /// Index of the first body that it meets; `None` unless it is a hit.
    #[getter]
    fn body(&self) -> Option<usize> {
        match self.met {
            Met::Hit { body, .. } => Some(body.index()),
            _ => None,
        }
    }

    /// How far along the way it is free, a length; `None` unless it is a hit.
    #[getter]
    fn lo(&self) -> Option<f64> {
        match self.met {
            Met::Hit { lo, .. } => Some(lo),
            _ => None,
        }
    }

    /// How far along the way it has met the body, up to the tolerance of queries, a length; `None` unless it is a hit.
    #[getter]
    fn hi(&self) -> Option<f64> {
        match self.met {
            Met::Hit { hi, .. } => Some(hi),
            _ => None,
        }
    }

    /// The point of the body's surface, world frame, shape (3,); `None` unless it is a hit.
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        match self.met {
            Met::Hit { point, .. } => Some(vector(py, &point.to_array())),
            _ => None,
        }
    }

    /// Outward unit normal of the body there, world axes, shape (3,); `None` unless it is a hit.
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        match self.met {
            Met::Hit { normal, .. } => Some(vector(py, &normal.to_array())),
            _ => None,
        }
    }

    /// How far along the way it is free, a length, where the budget ran out; else `None`.
    #[getter]
    fn free_until(&self) -> Option<f64> {
        match self.met {
            Met::Undecided { free_until } => Some(free_until),
            _ => None,
        }
    }

    fn __repr__(&self) -> String {
        match self.met {
            Met::Hit { body, lo, hi, .. } => format!("RayAnswer('hit', {}, [{lo:?}, {hi:?}])", body.index()),
            Met::Undecided { free_until } => format!("RayAnswer('undecided', free_until={free_until:?})"),
            _ => "RayAnswer('free')".to_owned(),
        }
    }
}

#[pymethods]
impl Simulation {
    /// The bodies where they are now, for rays and distances; `node_tests` and `time_limit` (seconds) of each query.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> len(simulation.frozen())
    /// 0
    #[pyo3(signature = (*, node_tests=None, time_limit=None))]
    fn frozen(&self, py: Python<'_>, node_tests: Option<u64>, time_limit: Option<f64>) -> PyResult<Frozen> {
        let options = QueryOptions::default().with_budget(budget(node_tests, time_limit).or_raise()?);
        let inner = self.lock(py);
        Ok(Frozen { held: inner.engine.frozen(options), names: inner.names.clone() })
    }
}
