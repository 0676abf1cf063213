//! Answers proven again.

use crate::answer::Answer;
use crate::fault::{Fault, OrRaise};
use crate::options::{QueryKeywords, window};
use crate::query::MovingPair;
use crate::supervise::{Watch, supervised};
use d2m::verify::{MeshFault, Verdict as Found, Verifier};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;

impl From<MeshFault> for Fault {
    fn from(error: MeshFault) -> Self {
        Self::new(error.to_string())
    }
}

/// What became of an answer that was to be proven again.
///
/// `status` "verified": it is true. "refuted": it is false, and `time` and `distance` are a counterexample. "unproven": neither was
/// shown, and `reason` says why. It has no truth value: ask for its status.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box")
/// >>> answer = d2m_ccd.time_of_contact(box, box, {"x": [9, 0, 0]})
/// >>> d2m_ccd.verify(box, box, answer, {"x": [9, 0, 0]})
/// Verdict('verified')
#[pyclass(frozen, get_all, module = "d2m_ccd")]
pub(crate) struct Verdict {
    /// "verified", "refuted" or "unproven".
    status: &'static str,
    /// When the claim is false; `None` unless refuted.
    time: Option<f64>,
    /// Bounds of the distance of two triangles then; `None` unless refuted.
    distance: Option<(f64, f64)>,
    /// The triangle of A and that of B at which it is false or was not proven, or `None`.
    triangles: Option<(u32, u32)>,
    /// Why it was not proven; `None` unless unproven.
    reason: Option<String>,
    /// Until when what was claimed to be clear is proven to be; `None` unless unproven.
    clear_until: Option<f64>,
}

#[pymethods]
impl Verdict {
    fn __bool__(&self) -> PyResult<bool> {
        let message = "Verdict has no truth value: compare its status with \"verified\"";
        Err(PyTypeError::new_err(message))
    }

    fn __repr__(&self) -> String {
        match (&self.reason, self.time, self.distance) {
            (Some(reason), ..) => format!("Verdict('unproven', reason='{reason}')"),
            (_, Some(time), Some((lo, hi))) => {
                format!("Verdict('refuted', time={time:?}, distance=[{lo:?}, {hi:?}])")
            }
            _ => format!("Verdict('{}')", self.status),
        }
    }
}

impl From<Found> for Verdict {
    fn from(found: Found) -> Self {
        let nothing = Self {
            status: "verified",
            time: None,
            distance: None,
            triangles: None,
            reason: None,
            clear_until: None,
        };
        match found {
            Found::Verified { .. } => nothing,
            Found::Refuted { time, triangles: [a, b], distance } => Self {
                status: "refuted",
                time: Some(time),
                distance: Some((distance.lo(), distance.hi())),
                triangles: Some((a, b)),
                ..nothing
            },
            Found::Unproven { clear_until, reason, pair } => Self {
                status: "unproven",
                triangles: pair.map(|[a, b]| (a, b)),
                reason: Some(reason.to_string()),
                clear_until: Some(clear_until),
                ..nothing
            },
        }
    }
}

/// Proves an answer of `time_of_contact` again, by interval arithmetic alone: code that shares no search, tree or margin with the engine.
///
/// Motions and keywords as the query had them; `steps`: an end to the work, by default some seconds.
///
/// Raises `InputError` as `time_of_contact`. Returns a `Verdict`.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> falling = d2m_ccd.ConstantTwist(x=[0, 0, 3], v=[0, 0, -4], w=[0, 1, 0])
/// >>> answer = d2m_ccd.time_of_contact(box, box, falling)
/// >>> d2m_ccd.verify(box, box, answer, falling).status
/// 'verified'
/// >>> separated = d2m_ccd.time_of_contact(box, box, {"x": [9, 0, 0]})
/// >>> d2m_ccd.verify(box, box, separated, falling).status
/// 'refuted'
#[pyfunction]
#[pyo3(signature = (a, b, answer, motion_a=None, motion_b=None, *, window=(0.0, 1.0), tolerance=None, min_separation=0.0, solid=None, mode="accurate", steps=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn verify(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    answer: &Bound<'_, Answer>,
    motion_a: Option<&Bound<'_, PyAny>>,
    motion_b: Option<&Bound<'_, PyAny>>,
    window: (f64, f64),
    tolerance: Option<f64>,
    min_separation: f64,
    solid: Option<&Bound<'_, PyAny>>,
    mode: &str,
    steps: Option<u64>,
) -> PyResult<Verdict> {
    let keywords = QueryKeywords { tolerance, min_separation, mode, node_tests: None, time_limit: None };
    let options = keywords.options()?;
    let window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid)?;
    let answer = answer.get().answer;
    let found = supervised(py, &Watch::default(), |supervision| -> Result<Found, Fault> {
        let moving = pair.moving();
        let verifier = Verifier::try_new(moving[0].body.mesh(), moving[1].body.mesh())?;
        // The verifier cannot be cancelled: it is asked for more and more steps, and the last ones are most of them.
        let most = steps.unwrap_or(d2m::verify::DEFAULT_STEPS);
        let mut now = most.min(FIRST_STEPS);
        loop {
            let found = verifier.time_of_contact(&moving, window, &options, &answer, now);
            let ended = matches!(found, Found::Unproven { reason: d2m::verify::Reason::Steps, .. });
            if !ended || now >= most || supervision.is_cancelled() {
                return Ok(found);
            }
            now = now.saturating_mul(4).min(most);
        }
    })?;
    Ok(found.or_raise()?.into())
}

/// Steps of the first attempt: some milliseconds. Each next one has four times as many, so that all but the last cost a third of it.
const FIRST_STEPS: u64 = 1 << 14;
