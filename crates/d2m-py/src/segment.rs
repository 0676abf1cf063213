//! What simulations report: segments and their impulses.

use crate::arrays::vector;
use crate::motion::ConstantTwist;
use d2m_dynamics::{BodyId, ContactImpulse, Segment as Flown, TouchChange, TouchEvent as Touched};
use numpy::PyArray1;
use pyo3::prelude::*;

/// A span of time in which every body moves with a constant twist about its center of mass.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> body = simulation.add("shape:box")
/// >>> segments = simulation.advance(0.05)
/// >>> segments[-1].end, segments[-1].skipped
/// (0.05, 0.0)
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Segment {
    pub(crate) flown: Flown,
}

#[pymethods]
impl Segment {
    /// First instant.
    #[getter]
    fn start(&self) -> f64 {
        self.flown.start
    }

    /// Last instant; the next segment begins here.
    #[getter]
    fn end(&self) -> f64 {
        self.flown.end
    }

    /// The length of the segment if bodies stand still in it because the events of the step were used up, else zero.
    #[getter]
    fn skipped(&self) -> f64 {
        self.flown.skipped
    }

    /// Bodies with another twist than in the segment before (all of them in the first one), and their motions from `start` on: a list
    /// of (index, ConstantTwist).
    #[getter]
    fn changed<'py>(&self, py: Python<'py>) -> PyResult<Vec<(usize, Bound<'py, ConstantTwist>)>> {
        let one = |&(id, twist): &(BodyId, d2m::ConstantTwist)| {
            Ok((id.index(), Bound::new(py, ConstantTwist::of(twist))?))
        };
        self.flown.changed.iter().map(one).collect()
    }

    /// Indices of the bodies that were removed before the segment begins.
    #[getter]
    fn removed(&self) -> Vec<usize> {
        self.flown.removed.iter().map(|id| id.index()).collect()
    }

    /// Impulses at the end of the segment.
    #[getter]
    fn contacts(&self) -> Vec<Impulse> {
        self.flown.contacts.iter().map(|&impulse| Impulse { impulse }).collect()
    }

    fn __repr__(&self) -> String {
        let Flown { start, end, changed, contacts, .. } = &self.flown;
        format!("Segment([{start:?}, {end:?}], {} changed, {} contacts)", changed.len(), contacts.len())
    }
}

/// An impulse at a contact.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation()
/// >>> floor = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", kind="static")
/// >>> cup = simulation.add("shape:box?x=0.5&y=0.5&z=0.5", pose=d2m_ccd.Pose(x=[0, 1.1, 0]))
/// >>> impulses = [impulse for segment in simulation.advance(0.3) for impulse in segment.contacts]
/// >>> impulses[0].a, impulses[0].b, impulses[0].normal.round(9).tolist()
/// (0, 1, [0.0, 1.0, 0.0])
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Impulse {
    impulse: ContactImpulse,
}

#[pymethods]
impl Impulse {
    /// Index of the first body.
    #[getter]
    fn a(&self) -> usize {
        self.impulse.a.index()
    }

    /// Index of the second body.
    #[getter]
    fn b(&self) -> usize {
        self.impulse.b.index()
    }

    /// When it acts.
    #[getter]
    fn time(&self) -> f64 {
        self.impulse.time
    }

    /// Middle of the two closest points, world frame, shape (3,).
    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.impulse.point.to_array())
    }

    /// Unit normal from a to b, shape (3,).
    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.impulse.normal.to_array())
    }

    /// Impulse on a (its opposite acts on b): mass times speed, world axes, shape (3,).
    #[getter]
    fn impulse<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.impulse.impulse.to_array())
    }

    fn __repr__(&self) -> String {
        let ContactImpulse { a, b, time, impulse, .. } = self.impulse;
        format!("Impulse({}, {}, time={time:?}, impulse={:?})", a.index(), b.index(), impulse.to_array())
    }
}

/// Two bodies begin to touch, or do so no more. What rests and sleeps goes on touching.
///
/// >>> import d2m_ccd
/// >>> simulation = d2m_ccd.Simulation(gravity=[0, 0, 0])
/// >>> gate = simulation.add("shape:box", kind="static", presence="sensor")
/// >>> ball = simulation.add("shape:box", pose=d2m_ccd.Pose(x=[-5, 0, 0]), v=[10, 0, 0])
/// >>> segments = simulation.advance(1.0)
/// >>> [event.change for event in simulation.touches]
/// ['began', 'ended']
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct TouchEvent {
    pub(crate) event: Touched,
}

#[pymethods]
impl TouchEvent {
    /// Index of the body with the smaller one.
    #[getter]
    fn a(&self) -> usize {
        self.event.a.index()
    }

    /// Index of the other body.
    #[getter]
    fn b(&self) -> usize {
        self.event.b.index()
    }

    /// When.
    #[getter]
    fn time(&self) -> f64 {
        self.event.time
    }

    /// "began": the first impulse between them, or a sensor may be met. "ended": they are clear of each other, or one of them was removed.
    #[getter]
    fn change(&self) -> &'static str {
        match self.event.change {
            TouchChange::Ended => "ended",
            _ => "began",
        }
    }

    fn __repr__(&self) -> String {
        let Touched { a, b, time, .. } = self.event;
        format!("TouchEvent({}, {}, time={time:?}, change='{}')", a.index(), b.index(), self.change())
    }
}
