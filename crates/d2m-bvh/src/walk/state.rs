//! What a search knows: its limits, what it has found, where it is in a sub-window.

use super::counts::SearchCounts;
use super::effort;
use super::expansion::{KeyRange, NodePairExpander};
use super::scratch::Scratch;
use crate::pair::boxes::node_scale::NodeScale;
use crate::pair::boxes::node_test::NodeFrame;
use crate::pair::motion::frame::{Frame, RelativeMotion};
use crate::pair::motion::units::sum_down;
use crate::pair::scene::MovingScene;
use crate::pair::triangles::separating_axis::BackwardCertificate;
use crate::{Budget, Mode, QueryOptions};
use d2m_lanes::InstructionSet;
use d2m_mesh::Stop;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A contact as the search knows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// Start of the window of the search in which it lies (an offset of the query), and the offset from there.
    pub(crate) start: f64,
    pub(crate) offset: f64,
    pub(crate) triangles: [u32; 2],
    /// Whether no direction kept the triangles apart: they cross, or come within the level of it.
    pub(crate) crossing: bool,
}

impl Found {
    /// The offset in the query, not late.
    pub(crate) fn in_query(&self) -> f64 {
        sum_down(self.start, self.offset)
    }

    /// Is it at the very start of the query?
    pub(crate) fn is_at_start(&self) -> bool {
        self.start == 0.0 && self.offset == 0.0
    }
}

/// Result of a search.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Outcome {
    Separated,
    Found(Found),
    /// The budget ran out; free until this offset.
    OutOfBudget(f64),
}

/// What a part of the search gave.
pub(crate) enum Step {
    /// The answer of the whole search.
    Answer(Outcome),
    /// The bodies are apart until this offset.
    ClearUntil(f64),
}

/// A part of the query's window in which the bodies turn by little, as offsets: it is searched at once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SubWindow {
    pub(crate) start: f64,
    pub(crate) end: f64,
}

/// One search.
pub(crate) struct Search<'s> {
    pub(crate) scene: &'s MovingScene<'s>,
    pub(crate) scratch: &'s mut Scratch,
    pub(crate) limits: Limits,
    /// The vector instructions that it uses.
    pub(crate) instructions: InstructionSet,
    /// Of the last sub-window, and its unit of time.
    pub(crate) scales: Option<(f64, [NodeScale; 2])>,
    /// Set for a single sub-window that is searched before it is known what earlier ones give.
    pub(crate) ahead: Option<Ahead<'s>>,
    /// Whether several threads may search.
    #[cfg(feature = "rayon")]
    pub(crate) parallel: bool,
}

/// A sub-window that is searched before it is known what earlier ones give, and where those state that they have an answer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ahead<'r> {
    pub(crate) number: usize,
    /// The least number of a sub-window with an answer.
    pub(crate) answered: &'r AtomicUsize,
}

impl Ahead<'_> {
    /// Is there an answer in an earlier sub-window?
    pub(crate) fn is_useless(&self) -> bool {
        self.answered.load(Ordering::Relaxed) < self.number
    }
}

/// How far a search goes, and when it tries something else.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Limits {
    pub(crate) mode: Mode,
    pub(crate) most_tests: u64,
    pub(crate) stop: Stop,
    /// The number of node tests from which on swept volumes are compared.
    pub(crate) sweep_from: u64,
    /// So many times as much work as usual is done before swept volumes or crowds are examined.
    pub(crate) patience: u64,
    /// Triangles whose line is tried of every pair before other directions are.
    pub(crate) parting: Option<[u32; 2]>,
    /// Only whether the bodies meet at the start matters.
    pub(crate) only_start: bool,
}

/// What changes while a sub-window is searched.
pub(crate) struct State<'a> {
    pub(crate) motion: RelativeMotion,
    pub(crate) expander: NodePairExpander<'a>,
    /// One step of the key, as a difference of offsets.
    pub(crate) step: f64,
    /// Keys from here on do not matter.
    pub(crate) limit: u32,
    /// The same as an offset.
    pub(crate) limit_offset: f64,
    pub(crate) frame: Frame,
    pub(crate) node_frames: [NodeFrame; 2],
    pub(crate) frame_key: u32,
    pub(crate) found: Option<Found>,
    /// The time of what is found; before something is found, of no meaning.
    pub(crate) behind: BackwardCertificate,
}

impl<'s> Search<'s> {
    pub(crate) fn new(scene: &'s MovingScene<'s>, options: &QueryOptions, scratch: &'s mut Scratch) -> Self {
        let budget = &options.budget;
        scratch.counts = SearchCounts::default();
        scratch.last_tested = [0, 0];
        // What an earlier query left belongs to other motions.
        scratch.found_in = None;
        let patience = effort::patience(options.grazing);
        let limits = Limits {
            mode: options.mode,
            most_tests: budget.node_tests.unwrap_or(u64::MAX).min(Budget::HARD_NODE_TESTS),
            stop: Stop::new(budget),
            sweep_from: effort::first_sweep(triangle_count(scene), patience),
            patience,
            parting: options.grazing,
            only_start: false,
        };
        Self {
            scene,
            scratch,
            limits,
            instructions: InstructionSet::in_use(),
            scales: None,
            ahead: None,
            #[cfg(feature = "rayon")]
            parallel: options.parallel,
        }
    }

    /// A search that ends with `Separated` when the bodies are proven apart at the start.
    pub(crate) fn of_start(mut self) -> Self {
        self.limits.only_start = true;
        self
    }

    /// The next sub-window to be searched; `None` when nothing is left.
    pub(crate) fn window_from(&self, start: f64) -> Option<SubWindow> {
        let end = self.scene.end;
        let from = start;
        let start = self.scene.spheres_clear_until(from);
        #[cfg(feature = "audit")]
        self.scene.conclude_whole(d2m_mesh::audit::Place::Spheres, from, (start > from).then_some(start));
        // A query of no length has one window.
        if start >= end && end > 0.0 {
            return None;
        }
        Some(SubWindow { start, end: (start + self.longest_span()).min(end) })
    }

    /// Does the query have so few sub-windows that each is searched from the roots? Then the search may go on from any time in one.
    pub(crate) fn has_few_windows(&self) -> bool {
        effort::FEW_SUB_WINDOWS * self.scene.longest >= self.scene.end
    }

    /// What the search has done, in node tests.
    pub(crate) fn work(&self) -> u64 {
        self.scratch.counts.work()
    }

    /// Are swept volumes to be compared now?
    pub(crate) fn is_sweep_due(&self) -> bool {
        self.work() >= self.limits.sweep_from
    }

    /// Whether a sub-window that is searched before its turn is left to the search by one thread: there is an earlier answer, or
    /// swept volumes are due, which begin at what that search has tested last.
    pub(crate) fn gives_up(&self) -> bool {
        self.ahead.is_some_and(|ahead| self.is_sweep_due() || ahead.is_useless())
    }

    #[inline(always)]
    pub(crate) fn out_of_budget(&self) -> bool {
        self.work() >= self.limits.most_tests || self.limits.stop.is_due()
    }
}

impl State<'_> {
    /// The keys that new pairs may have.
    #[inline(always)]
    pub(crate) const fn keys(&self) -> KeyRange {
        KeyRange { now: self.frame_key, limit: self.limit }
    }

    /// A contact: nothing later matters, and nothing whose key is not below it can be earlier. The step
    /// is a power of two, so the quotient is exact.
    pub(crate) fn find(&mut self, found: Found) {
        self.limit_offset = found.offset;
        self.limit = ((found.offset / self.step).ceil() as u32).min(self.limit);
        self.found = Some(found);
    }

    /// Nothing matters any more.
    pub(crate) fn end(&mut self) {
        self.limit = 0;
        self.limit_offset = 0.0;
    }
}

pub(crate) fn triangle_count(scene: &MovingScene<'_>) -> u64 {
    (scene.a.tree.mesh().triangle_count() + scene.b.tree.mesh().triangle_count()) as u64
}
