//! Queries of one pair of moving bodies.

use crate::answer;
use crate::fault::{Fault, OrRaise};
use crate::mesh::tree_argument;
use crate::motion::{Form, motion_argument};
use crate::options::{QueryKeywords, REPORT, radii, solids, window};
use crate::supervise::{Watch, pool, supervised};
use d2m::bvh::{
    MeshTree, Moving, PairCache, QueryOptions, Solid, StartState, TimeOfContact, Window, contact_exists,
    time_of_contact,
};
use pyo3::prelude::*;
use std::sync::Arc;
use std::time::Duration;

/// Queries that take longer than this are begun again on another thread, so that the calling one can look after signals.
const BRIEF: Duration = Duration::from_millis(5);

/// Two bodies with their motions.
pub(crate) struct MovingPair {
    trees: [Arc<MeshTree>; 2],
    motions: [Form; 2],
    solids: [Solid; 2],
    radii: [f64; 2],
}

impl MovingPair {
    /// Of the arguments of a query.
    pub(crate) fn new(
        bodies: [&Bound<'_, PyAny>; 2],
        motions: [Option<&Bound<'_, PyAny>>; 2],
        solid: Option<&Bound<'_, PyAny>>,
        radius: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let trees = [tree_argument(bodies[0])?, tree_argument(bodies[1])?];
        let motions = [motion_argument(motions[0], "motion_a")?, motion_argument(motions[1], "motion_b")?];
        for (motion, tree) in motions.iter().zip(&trees) {
            motion.check_size(tree).or_raise()?;
        }
        let solids = solids(solid, [&trees[0], &trees[1]])?;
        Ok(Self { trees, motions, solids, radii: radii(radius)? })
    }

    /// As queries take them.
    pub(crate) fn moving(&self) -> [Moving<'_>; 2] {
        [0, 1].map(|body| {
            Moving::new(&*self.trees[body], self.motions[body].motion())
                .with_solid(self.solids[body])
                .with_radius(self.radii[body])
        })
    }
}

/// Is all of an answer decided, how the bodies begin, too?
pub(crate) fn is_decided(answer: &TimeOfContact) -> bool {
    match answer {
        TimeOfContact::Undecided { .. } => false,
        TimeOfContact::Contact(contact) => contact.start != StartState::Undecided,
        _ => true,
    }
}

/// Runs a query at once (on the calling thread, with no more threads); what is not decided within a few milliseconds is queried again on another thread, where signals end it.
///
/// Every answer within the first limit is the one that would have been given without it.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    options: &QueryOptions,
    ask: impl Fn(&QueryOptions) -> Result<T, Fault> + Sync,
    is_decided: impl Fn(&T) -> bool,
) -> PyResult<T> {
    let limit = options.budget.wall_clock;
    let brief =
        options.with_budget(options.budget.with_wall_clock(limit.map_or(BRIEF, |limit| limit.min(BRIEF))));
    let first = py.detach(|| ask(&brief.with_parallel(false))).or_raise()?;
    if is_decided(&first) || limit.is_some_and(|limit| limit <= BRIEF) {
        return Ok(first);
    }
    let rest = match limit {
        Some(limit) => options.with_budget(options.budget.with_wall_clock(limit - BRIEF)),
        None => *options,
    };
    supervised(py, &Watch::default(), |supervision| {
        let rest = supervision.cancels(&rest);
        if rest.parallel { pool(None)?.install(|| ask(&rest)) } else { ask(&rest) }
    })?
    .or_raise()
}

/// First time in a window at which two moving bodies touch.
///
/// `a` and `b` are trees (or what `Tree` takes: then a tree is built for each call); motions are those of `Motion`, `None` for rest.
/// `window` (t0, t1); `tolerance` δ, a length, by default 1e-10 of the scene's length scale; `min_separation`: the first time at
/// which the distance is at most this; `radius`: one or a tuple of two, the bodies are all that is within it of their meshes; `solid`: True, False or a tuple of two, by default whether each mesh is watertight;
/// `start` "report", or "leave": what is in contact at the start is let go until it is proven apart, and the answer is the first contact
/// after that, with `left`; `mode` "accurate" or "capoeira"; `node_tests` and `time_limit` (seconds) end the search with an `Undecided`; `parallel`: one
/// query on all threads, of use for those that take long, with the same bits.
///
/// Returns `Separated`, `Contact` or `Undecided`: never a missed contact, never a late one.
///
/// Raises `InputError` for numbers that are not finite, a window outside of a motion's times, a filled solid that does not
/// close; `KeyboardInterrupt` on Ctrl-C. The interpreter's lock is released.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> falling = d2m_ccd.ConstantTwist(x=[0, 0, 3], v=[0, 0, -4])
/// >>> answer = d2m_ccd.time_of_contact(box, box, falling)
/// >>> answer.status, abs(answer.time_lo - 0.5) < 1e-9
/// ('contact', True)
#[pyfunction(name = "time_of_contact")]
#[pyo3(signature = (a, b, motion_a=None, motion_b=None, *, window=(0.0, 1.0), tolerance=None, min_separation=0.0, radius=None, solid=None, start="report", mode="accurate", node_tests=None, time_limit=None, parallel=false))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn time_of_contact_py<'py>(
    py: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    motion_a: Option<&Bound<'py, PyAny>>,
    motion_b: Option<&Bound<'py, PyAny>>,
    window: (f64, f64),
    tolerance: Option<f64>,
    min_separation: f64,
    radius: Option<&Bound<'py, PyAny>>,
    solid: Option<&Bound<'py, PyAny>>,
    start: &str,
    mode: &str,
    node_tests: Option<u64>,
    time_limit: Option<f64>,
    parallel: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let keywords = QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit };
    let options = keywords.options()?.with_parallel(parallel);
    let window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid, radius)?;
    let [a, b] = pair.moving();
    let ask = |options: &QueryOptions| Ok(time_of_contact(a, b, window, options)?);
    answer::object(py, run(py, &options, ask, is_decided)?)
}

/// Do two moving bodies come within `min_separation` of each other at any time of the window?
///
/// Arguments as of `time_of_contact`. Returns `False`: proven that they do not; `True`: at some time their distance is at most
/// `min_separation` + 3.3 tolerances; `None`: the budget ended the search, and nothing is known.
///
/// Raises `InputError` as `time_of_contact`.
///
/// >>> import d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> d2m_ccd.contact_exists(box, box, {"x": [0, 0, 3], "v": [0, 0, -4]})
/// True
#[pyfunction(name = "contact_exists")]
#[pyo3(signature = (a, b, motion_a=None, motion_b=None, *, window=(0.0, 1.0), tolerance=None, min_separation=0.0, radius=None, solid=None, node_tests=None, time_limit=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn contact_exists_py(
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
) -> PyResult<Option<bool>> {
    let (mode, start) = ("accurate", REPORT);
    let options =
        QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit }.options()?;
    let window: Window = self::window(window)?;
    let pair = MovingPair::new([a, b], [motion_a, motion_b], solid, radius)?;
    let [a, b] = pair.moving();
    let ask = |options: &QueryOptions| Ok(contact_exists(a, b, window, options, &mut PairCache::new())?);
    run(py, &options, ask, Option::is_some)
}
