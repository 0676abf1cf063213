//! The state of a simulation, to come back to.

use crate::fault::{Fault, OrRaise};
use crate::simulation::{Inner, Simulation};
use d2m_dynamics::{BodyId, Snapshot as State};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Everything that changes in a `Simulation`: poses, velocities, resting contacts, who sleeps and who touches, joints, kinds, materials, groups.
///
/// `restore` followed by the same steps gives the same bits. Meshes, masses and names are not in it: it belongs to a simulation that has its
/// bodies, in the same order, and perhaps others.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> body = simulation.add("shape:box")
/// >>> before = simulation.snapshot()
/// >>> segments = simulation.advance(0.5)
/// >>> simulation.restore(before)
/// >>> simulation.time, simulation.pose(body).x.tolist()
/// (0.0, [0.0, 0.0, 0.0])
#[pyclass(frozen, eq, module = "d2m_ccd")]
#[derive(PartialEq)]
pub(crate) struct Snapshot {
    state: State,
}

#[pymethods]
impl Snapshot {
    /// The state as bytes, JSON text, which keeps every bit of its numbers. Motions of kinematic bodies are not written: those of the
    /// simulation go on.
    ///
    /// >>> import d2m_ccd
    /// >>> snapshot = d2m_ccd.Simulation().snapshot()
    /// >>> d2m_ccd.Snapshot.from_bytes(snapshot.to_bytes()) == snapshot
    /// True
    fn to_bytes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = serde_json::to_vec(&self.state).map_err(|error| Fault::new(error.to_string()));
        Ok(PyBytes::new(py, &bytes.or_raise()?))
    }

    /// The state that `to_bytes` wrote. It is checked for intersections where it is restored.
    ///
    /// Raises `InputError` for what is no snapshot.
    ///
    /// >>> import d2m_ccd
    /// >>> d2m_ccd.Snapshot.from_bytes(b"{}")
    /// Traceback (most recent call last):
    ///     ...
    /// d2m_ccd._errors.InputError: data is no snapshot: missing field `options` at line 1 column 2
    #[staticmethod]
    fn from_bytes(data: &[u8]) -> PyResult<Self> {
        let read = serde_json::from_slice(data);
        let state = read.map_err(|error| Fault::new(format!("data is no snapshot: {error}"))).or_raise()?;
        Ok(Self { state })
    }
}

#[pymethods]
impl Simulation {
    /// The state between two steps.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> simulation.snapshot() == simulation.snapshot()
    /// True
    fn snapshot(&self, py: Python<'_>) -> Snapshot {
        Snapshot { state: self.lock(py).engine.snapshot() }
    }

    /// Goes back to a state of this simulation, or of one with the same bodies. Bodies and joints that were added since are gone, joints that
    /// were taken out are there again.
    ///
    /// Raises `InputError` for a snapshot with a body that was removed since, and for bodies that intersect: nothing changes then.
    ///
    /// >>> import d2m_ccd
    /// >>> simulation = d2m_ccd.Simulation()
    /// >>> empty = simulation.snapshot()
    /// >>> cup = simulation.add("shape:box")
    /// >>> simulation.restore(empty)
    /// >>> len(simulation)
    /// 0
    fn restore(&self, py: Python<'_>, snapshot: &Snapshot) -> PyResult<()> {
        let mut inner = self.lock(py);
        let Inner { engine, names, touches } = &mut *inner;
        engine.restore(&snapshot.state).or_raise()?;
        touches.clear();
        let kept: Vec<usize> = engine.ids().map(BodyId::index).collect();
        names.retain(|_, index| kept.contains(index));
        Ok(())
    }
}
