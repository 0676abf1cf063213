//! Answers proven again.

use crate::answer::Answer;
use crate::fault::{Fault, OrRaise};
use crate::options::{QueryKeywords, window};
use crate::query::MovingPair;
use crate::supervise::{Supervision, Watch, supervised};
use d2m::verify::{MeshFault, Verdict as Found, Verifier};
use d2m::{Departure, TimeOfContact};
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
    /// Of a path of a `Robot`: the link or body of which it is false or not proven, or `None`.
    a: Option<String>,
    /// The other one.
    b: Option<String>,
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

impl Verdict {
    /// About two links or bodies of a robot.
    pub(crate) fn of([a, b]: [&str; 2], found: Found) -> Self {
        Self { a: Some(a.to_owned()), b: Some(b.to_owned()), ..found.into() }
    }

    /// Not proven, for a reason that is not the verifier's.
    pub(crate) fn unproven([a, b]: [&str; 2], reason: String, clear_until: f64) -> Self {
        let steps = Found::Verified { steps: 0 };
        let (status, reason, clear_until) = ("unproven", Some(reason), Some(clear_until));
        Self { status, reason, clear_until, ..Self::of([a, b], steps) }
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
            a: None,
            b: None,
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

/// Proves an answer of `time_of_contact`, or one of `departure`, again, by interval arithmetic alone: code that shares no search, tree or margin with the engine.
///
/// Motions and keywords as the query had them, also `start` (of a `departure` it says nothing); `steps`: an end to the work, by default some seconds.
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
#[pyo3(signature = (a, b, answer, motion_a=None, motion_b=None, *, window=(0.0, 1.0), tolerance=None, min_separation=0.0, radius=None, solid=None, start="report", mode="accurate", steps=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn verify(
    py: Python<'_>,
    a: &Bound<'_, PyAny>,
    b: &Bound<'_, PyAny>,
    answer: &Bound<'_, PyAny>,
    motion_a: Option<&Bound<'_, PyAny>>,
    motion_b: Option<&Bound<'_, PyAny>>,
    window: (f64, f64),
    tolerance: Option<f64>,
    min_separation: f64,
    radius: Option<&Bound<'_, PyAny>>,
    solid: Option<&Bound<'_, PyAny>>,
    start: &str,
    mode: &str,
    steps: Option<u64>,
) -> PyResult<Verdict> {
    let (node_tests, time_limit) = (None, None);
    let keywords = QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit };
    let options = keywords.options()?;
    let window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid, radius)?;
    let answer = Claimed::new(answer)?;
    let found = supervised(py, &Watch::default(), |supervision| -> Result<Found, Fault> {
        let moving = pair.moving();
        let verifier = Verifier::try_new(moving[0].body.mesh(), moving[1].body.mesh())?;
        let prove = |now: u64| {
            Ok(match &answer {
                Claimed::Answer(answer) => verifier.time_of_contact(&moving, window, &options, answer, now),
                Claimed::Departure(found) => verifier.departure(&moving, window, &options, found, now),
            })
        };
        in_growing_steps(steps, supervision, prove, ran_out)
    })?;
    Ok(found.or_raise()?.into())
}

/// What is to be proven.
enum Claimed {
    Answer(TimeOfContact),
    Departure(Departure),
}

impl Claimed {
    fn new(any: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(departure) = any.cast::<crate::questions::Departure>() {
            return Ok(Self::Departure(departure.get().found));
        }
        Ok(Self::Answer(any.cast::<Answer>()?.get().answer))
    }
}

/// Would more steps help?
pub(crate) const fn ran_out(found: &Found) -> bool {
    matches!(found, Found::Unproven { reason: d2m::verify::Reason::Steps, .. })
}

/// A proof in at most so many steps. The verifier cannot be cancelled: it is asked for more and more steps, and the last ones are most of
/// them.
pub(crate) fn in_growing_steps<T>(
    steps: Option<u64>,
    supervision: &Supervision,
    prove: impl Fn(u64) -> Result<T, Fault>,
    ran_out: impl Fn(&T) -> bool,
) -> Result<T, Fault> {
    let most = steps.unwrap_or(d2m::verify::DEFAULT_STEPS);
    let mut now = most.min(FIRST_STEPS);
    loop {
        let found = prove(now)?;
        if !ran_out(&found) || now >= most || supervision.is_cancelled() {
            return Ok(found);
        }
        now = now.saturating_mul(4).min(most);
    }
}

/// Steps of the first attempt: some milliseconds. Each next one has four times as many, so that all but the last cost a third of it.
const FIRST_STEPS: u64 = 1 << 14;
