//! Many trials of one pair of bodies.

use crate::arrays::Doubles;
use crate::fault::{Fault, OrRaise, Value};
use crate::mesh::tree_argument;
use crate::options::{QueryKeywords, radii, solids};
use crate::record::{ANSWER_WORDS, write_answer};
use crate::resting::named;
use crate::supervise::{Supervision, Watch, pool, supervised};
use crate::trajectory::{Motions, MotionsView, TrialMotion};
use d2m::bvh::{MeshTree, Moving, QueryOptions, Solid, Window, time_of_contact};
use pyo3::prelude::*;
use rayon::prelude::*;
use std::sync::{Mutex, PoisonError};

/// One window for all trials, or a row for each.
enum Windows<'py> {
    Same(Window),
    Rows(Doubles<'py>),
}

impl<'py> Windows<'py> {
    fn new(any: &Bound<'py, PyAny>) -> PyResult<Self> {
        if let Ok(ends) = any.extract::<(f64, f64)>() {
            return Ok(Self::Same(crate::options::window(ends)?));
        }
        let rows = Doubles::of_any_shape(any, "window")?;
        match (rows.shape(), rows.slice()) {
            ([2], &[start, end]) => Ok(Self::Same(crate::options::window((start, end))?)),
            ([_, 2], _) => Ok(Self::Rows(rows)),
            (shape, _) => {
                let message = format!("window has the shape {shape:?}, (2,) or (n, 2) is expected");
                Err(Fault::new(message).into())
            }
        }
    }

    fn count(&self) -> Option<usize> {
        match self {
            Self::Same(_) => None,
            Self::Rows(rows) => rows.shape().first().copied(),
        }
    }

    fn view(&self) -> WindowsView<'_> {
        match self {
            Self::Same(window) => WindowsView::Same(*window),
            Self::Rows(rows) => WindowsView::Rows(rows.slice()),
        }
    }
}

#[derive(Clone, Copy)]
enum WindowsView<'a> {
    Same(Window),
    Rows(&'a [f64]),
}

/// All that the workers need, without the interpreter.
#[derive(Clone, Copy)]
struct Batch<'a> {
    trees: [&'a MeshTree; 2],
    motions: [MotionsView<'a>; 2],
    solids: [Solid; 2],
    radii: [f64; 2],
    windows: WindowsView<'a>,
    options: QueryOptions,
}

impl Batch<'_> {
    fn answer(&self, trial: usize, words: &mut [u64]) -> Result<(), Fault> {
        let window = match self.windows {
            WindowsView::Same(window) => window,
            WindowsView::Rows(rows) => Window::try_new(rows[2 * trial], rows[2 * trial + 1])?,
        };
        let within = |name: &'static str| move |fault: Fault| fault.within(name);
        let a = self.motions[0].of_trial(trial).map_err(within("motion of A"))?;
        let b = self.motions[1].of_trial(trial).map_err(within("motion of B"))?;
        for ((motion, tree), name) in [&a, &b].into_iter().zip(self.trees).zip(["motion of A", "motion of B"])
        {
            if let TrialMotion::Form(form) = motion {
                form.check_size(tree).map_err(within(name))?;
            }
        }
        let [tree_a, tree_b] = self.trees;
        let ([solid_a, solid_b], [radius_a, radius_b]) = (self.solids, self.radii);
        let a = Moving::new(tree_a, a.motion()).with_solid(solid_a).with_radius(radius_a);
        let b = Moving::new(tree_b, b.motion()).with_solid(solid_b).with_radius(radius_b);
        write_answer(&time_of_contact(a, b, window, &self.options)?, words);
        Ok(())
    }

    /// All trials, in parallel; the fault of the first trial that has one, at any number of threads.
    fn run(&self, words: &mut [u64], supervision: &Supervision) -> Result<(), Fault> {
        let first: Mutex<Option<(usize, Fault)>> = Mutex::new(None);
        let first_fault = || first.lock().unwrap_or_else(PoisonError::into_inner);
        let failed = std::sync::atomic::AtomicUsize::new(usize::MAX);
        let order = std::sync::atomic::Ordering::Relaxed;
        words.par_chunks_mut(ANSWER_WORDS).enumerate().for_each(|(trial, words)| {
            if supervision.is_cancelled() || trial > failed.load(order) {
                return;
            }
            if let Err(fault) = self.answer(trial, words) {
                failed.fetch_min(trial, order);
                let mut first = first_fault();
                if first.as_ref().is_none_or(|(other, _)| trial < *other) {
                    *first = Some((trial, fault));
                }
            }
            supervision.add_done(1);
        });
        match first.into_inner().unwrap_or_else(PoisonError::into_inner) {
            Some((trial, fault)) => Err(fault.of_trial(trial)),
            None => Ok(()),
        }
    }
}

/// How many trials there are, where all that say so agree.
fn trial_count(counts: [(&str, Option<usize>); 3]) -> Result<usize, Fault> {
    let mut given = counts.into_iter().filter_map(|(name, count)| Some((name, count?)));
    let Some((first, count)) = given.next() else { return Ok(1) };
    match given.find(|(_, other)| *other != count) {
        None => Ok(count),
        Some((name, other)) => {
            let message = format!("{first} has {count} trials and {name} has {other}");
            Err(Fault::new(message).with_value(Value::Numbers(vec![count as f64, other as f64])))
        }
    }
}

/// First contacts of many trials of one pair of bodies, on all threads.
///
/// `motions_a`, `motions_b`: an array of shape (n, 13) as (q(w, x, y, z), x, v, w), the columns of a trials file; a list of motions;
/// `PoseTrajectories` or `JointTrajectories`; or one motion (or `None`, at rest) for all trials. `window`: (t0, t1), or an array of shape
/// (n, 2). `threads`: by default one a processor. `progress`: called with (done, total) some times a second, or a bar with
/// `update(n)` such as one of tqdm. Other arguments as of `time_of_contact`; limits are those of a trial.
///
/// Returns a structured array of n results, with the fields of `d2m_ccd.RESULT`, in order and with the same bits at any number of
/// threads: `status` (`Status`), `time_lo`, `time_hi`, `separation`, `tolerance`, `normal`, `point_a`, … . C-contiguous arrays of
/// doubles are read where they are: do not change them meanwhile.
///
/// Raises `InputError` whose `index` is the first trial that cannot be answered; `KeyboardInterrupt` on Ctrl-C. The
/// interpreter's lock is released.
///
/// >>> import numpy, d2m_ccd
/// >>> box = d2m_ccd.Tree("shape:box?x=0.5&y=0.5&z=0.5")
/// >>> motions = numpy.zeros((3, 13))
/// >>> motions[:, 0] = 1
/// >>> motions[:, 4] = [3, 5, 9]
/// >>> motions[:, 7] = -4
/// >>> results = d2m_ccd.batch(box, box, motions)
/// >>> [d2m_ccd.Status(status).name for status in results["status"]], results["time_lo"].round(9).tolist()
/// (['CONTACT', 'CONTACT', 'SEPARATED'], [0.5, 1.0, inf])
#[pyfunction]
#[pyo3(signature = (a, b, motions_a=None, motions_b=None, *, window=None, tolerance=None, min_separation=0.0, radius=None, solid=None, start="report", mode="accurate", node_tests=None, time_limit=None, threads=None, progress=None))]
#[expect(clippy::too_many_arguments, reason = "keywords")]
pub(crate) fn batch<'py>(
    py: Python<'py>,
    a: &Bound<'py, PyAny>,
    b: &Bound<'py, PyAny>,
    motions_a: Option<&Bound<'py, PyAny>>,
    motions_b: Option<&Bound<'py, PyAny>>,
    window: Option<&Bound<'py, PyAny>>,
    tolerance: Option<f64>,
    min_separation: f64,
    radius: Option<&Bound<'py, PyAny>>,
    solid: Option<&Bound<'py, PyAny>>,
    start: &str,
    mode: &str,
    node_tests: Option<u64>,
    time_limit: Option<f64>,
    threads: Option<usize>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let options =
        QueryKeywords { tolerance, min_separation, mode, start, node_tests, time_limit }.options()?;
    let trees = [tree_argument(a)?, tree_argument(b)?];
    let solids = solids(solid, [&trees[0], &trees[1]])?;
    let motions = [Motions::new(motions_a, "motions_a")?, Motions::new(motions_b, "motions_b")?];
    let windows = window.map_or(Ok(Windows::Same(Window::UNIT)), Windows::new)?;
    let counts =
        [("motions_a", motions[0].count()), ("motions_b", motions[1].count()), ("window", windows.count())];
    let total = trial_count(counts).or_raise()?;
    let pool = pool(threads).or_raise()?;
    let mut words = vec![0u64; total * ANSWER_WORDS];
    let work = Batch {
        trees: [&trees[0], &trees[1]],
        motions: [motions[0].view(), motions[1].view()],
        solids,
        radii: radii(radius)?,
        windows: windows.view(),
        options,
    };
    let watch = Watch { progress, total };
    let run = |supervision: &Supervision| {
        let work = Batch { options: supervision.cancels(&work.options), ..work };
        pool.install(|| work.run(&mut words, supervision))
    };
    supervised(py, &watch, run)?.or_raise()?;
    named(py, words, "RESULT")
}
