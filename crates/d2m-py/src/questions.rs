//! How near two moving bodies come, and when they are clear of each other.

use crate::answer;
use crate::options::{QueryKeywords, REPORT, window};
use crate::query::{MovingPair, is_decided, run};
use crate::witness::Witness;
use d2m::bvh::{Clearance as Found, ClearanceOptions, ClearanceStatus, SpanStatus};
use d2m::{
    ContactSpan, Departure as FoundDeparture, QueryOptions, StartState, clearance, contact_spans, departure,
};
use d2m_io::start_word;
use pyo3::prelude::*;

/// The least distance of two bodies over a window: proven bounds, with a time and points (those of `Witness`) that attain the upper one.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> near = d2m_ccd.clearance(box, box, {"x": [0, 0, 3], "v": [0, 0, -1]})
/// >>> near.status, near.lower <= 1.0 <= near.upper, round(near.time, 6)
/// ('clear', True, 1.0)
#[pyclass(frozen, extends = Witness, module = "d2m_ccd")]
pub(crate) struct Clearance {
    found: Found,
}

#[pymethods]
impl Clearance {
    /// "clear": apart all the time. "contact": they meet. "undecided": the budget ended; the bounds hold all the same.
    #[getter]
    const fn status(&self) -> &'static str {
        clearance_word(self.found.status)
    }

    /// Proven: the distance is at least this at every time of the window.
    #[getter]
    const fn lower(&self) -> f64 {
        self.found.lower
    }

    /// Proven: at `time` the distance is at most this.
    #[getter]
    const fn upper(&self) -> f64 {
        self.found.upper
    }

    /// A time at which the distance is at most `upper`.
    #[getter]
    const fn time(&self) -> f64 {
        self.found.time
    }

    fn __repr__(&self) -> String {
        let Found { lower, upper, time, .. } = self.found;
        format!("Clearance('{}', bounds=[{lower:?}, {upper:?}], time={time:?})", self.status())
    }
}

/// A word for what is known.
pub(crate) const fn clearance_word(status: ClearanceStatus) -> &'static str {
    match status {
        ClearanceStatus::Clear => "clear",
        ClearanceStatus::Contact => "contact",
        ClearanceStatus::Undecided => "undecided",
    }
}

/// How near do two moving bodies come in a window, and when?
///
/// Bodies, motions and keywords as of `time_of_contact`; `accuracy`: the bounds are at most this part of the upper one apart (or four
/// tolerances).
///
/// Raises `InputError` as `time_of_contact`, and for an accuracy that is not positive. Returns a `Clearance`.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> d2m_ccd.clearance(box, box, {"x": [0, 0, 3], "v": [0, 0, -4]}).status
/// 'contact'
#[pyfunction(name = "clearance")]
#[pyo3(signature = (a, b, motion_a=None, motion_b=None, *, window=(0.0, 1.0), accuracy=1e-6, tolerance=None, radius=None, solid=None, node_tests=None, time_limit=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn clearance_py(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    motion_a: Option<&Bound<'_, PyAny>>,
    motion_b: Option<&Bound<'_, PyAny>>,
    window: (f64, f64),
    accuracy: f64,
    tolerance: Option<f64>,
    radius: Option<&Bound<'_, PyAny>>,
    solid: Option<&Bound<'_, PyAny>>,
    node_tests: Option<u64>,
    time_limit: Option<f64>,
) -> PyResult<Py<Clearance>> {
    let (mode, start, min_separation) = ("accurate", REPORT, 0.0);
    let keywords = QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit };
    let options = keywords.options()?;
    let window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid, radius)?;
    let [a, b] = pair.moving();
    let ask = |options: &QueryOptions| {
        let mut wanted = ClearanceOptions::default().with_accuracy(accuracy).with_budget(options.budget);
        if let Some(tolerance) = options.tolerance {
            wanted = wanted.with_tolerance(tolerance);
        }
        Ok(clearance(a, b, window, &wanted)?)
    };
    let found = run(py, &options, ask, |found: &Found| found.status != ClearanceStatus::Undecided)?;
    Py::new(py, PyClassInitializer::from(Witness::from(&found)).add_subclass(Clearance { found }))
}

/// In which spans of a window are two moving bodies proven clear of each other, and in which in contact?
///
/// Bodies, motions and keywords as of `time_of_contact`; `resolution`: a time, by default 1e-6 of the window: clear spans that are shorter may
/// be within a span of contact.
///
/// Returns a list of tuples (from, to, status), joined, in order, over all of the window; status is "clear", "contact" or "undecided".
///
/// Raises `InputError` as `time_of_contact`, and for a resolution that is not positive.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> [status for _, _, status in d2m_ccd.spans(box, box, {"x": [0, 0, 3], "v": [0, 0, -6]})]
/// ['clear', 'contact', 'clear']
#[pyfunction]
#[pyo3(signature = (a, b, motion_a=None, motion_b=None, *, window=(0.0, 1.0), resolution=None, tolerance=None, min_separation=0.0, radius=None, solid=None, node_tests=None, time_limit=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn spans(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    motion_a: Option<&Bound<'_, PyAny>>,
    motion_b: Option<&Bound<'_, PyAny>>,
    window: (f64, f64),
    resolution: Option<f64>,
    tolerance: Option<f64>,
    min_separation: f64,
    radius: Option<&Bound<'_, PyAny>>,
    solid: Option<&Bound<'_, PyAny>>,
    node_tests: Option<u64>,
    time_limit: Option<f64>,
) -> PyResult<Vec<(f64, f64, &'static str)>> {
    let (mode, start) = ("accurate", REPORT);
    let keywords = QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit };
    let options = keywords.options()?;
    let window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid, radius)?;
    let [a, b] = pair.moving();
    let ask = |options: &QueryOptions| Ok(contact_spans(a, b, window, options, resolution)?);
    let is_decided = |spans: &Vec<ContactSpan>| spans.iter().all(|span| span.status != SpanStatus::Undecided);
    let found = run(py, &options, ask, is_decided)?;
    let word = |status| match status {
        SpanStatus::Clear => "clear",
        SpanStatus::Contact => "contact",
        SpanStatus::Undecided => "undecided",
    };
    Ok(found.into_iter().map(|span| (span.from, span.to, word(span.status))).collect())
}

/// How two bodies part that are in contact at the start, and when they meet after that.
///
/// `start` "apart", "touching", "overlapping", "contained" or "undecided"; `left` (lo, hi): within `min_separation` + δ at lo, proven further
/// apart at hi, the start twice where they begin apart, `None` where they are never proven apart; `answer`: the first contact after that,
/// or that at the start of bodies that never part.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> d2m_ccd.departure(box, box, {"x": [0, 0, 0.5], "v": [0, 0, 1]})
/// Departure('overlapping', left=(0.5, 0.5), answer=Separated())
#[pyclass(frozen, module = "d2m_ccd")]
pub(crate) struct Departure {
    pub(crate) found: FoundDeparture,
}

#[pymethods]
impl Departure {
    /// How the bodies stand at the start of the window.
    #[getter]
    const fn start(&self) -> &'static str {
        start_word(self.found.start)
    }

    /// When they part, or `None`.
    #[getter]
    fn left(&self) -> Option<(f64, f64)> {
        self.found.left.map(|left| (left.lo, left.hi))
    }

    /// The first contact after that.
    #[getter]
    fn answer<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        answer::object(py, self.found.answer)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let left = match self.left() {
            Some((lo, hi)) => format!("({}, {})", short(lo), short(hi)),
            None => "None".to_owned(),
        };
        let answer = self.answer(py)?.repr()?;
        Ok(format!("Departure('{}', left={left}, answer={answer})", self.start()))
    }
}

/// A time to six digits, for people.
fn short(time: f64) -> String {
    let rounded: f64 = format!("{time:.5e}").parse().unwrap_or(time);
    format!("{rounded:?}")
}

/// When do two bodies part that are in contact at the start, and when do they meet after that?
///
/// Bodies, motions and keywords as of `time_of_contact`.
///
/// Raises `InputError` as `time_of_contact`. Returns a `Departure`.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> d2m_ccd.departure(box, box, {"x": [0, 0, 1], "v": [0, 0, 1]}).start
/// 'touching'
#[pyfunction(name = "departure")]
#[pyo3(signature = (a, b, motion_a=None, motion_b=None, *, window=(0.0, 1.0), tolerance=None, min_separation=0.0, radius=None, solid=None, node_tests=None, time_limit=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn departure_py(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    motion_a: Option<&Bound<'_, PyAny>>,
    motion_b: Option<&Bound<'_, PyAny>>,
    window: (f64, f64),
    tolerance: Option<f64>,
    min_separation: f64,
    radius: Option<&Bound<'_, PyAny>>,
    solid: Option<&Bound<'_, PyAny>>,
    node_tests: Option<u64>,
    time_limit: Option<f64>,
) -> PyResult<Departure> {
    let (mode, start) = ("accurate", REPORT);
    let keywords = QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit };
    let options = keywords.options()?;
    let window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid, radius)?;
    let [a, b] = pair.moving();
    let ask = |options: &QueryOptions| Ok(departure(a, b, window, options)?);
    let is_known = |found: &FoundDeparture| found.start != StartState::Undecided && is_decided(&found.answer);
    Ok(Departure { found: run(py, &options, ask, is_known)? })
}
