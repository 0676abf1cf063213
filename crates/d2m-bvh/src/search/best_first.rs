//! The search itself: windows of limited rotation, and best first inside each.

use super::crowd::Patience;
use super::motion::base_pose::two_sum;
use super::motion::frame::{Frame, RelativeMotion};
use super::motion::units::power_of_two_from;
use super::node_pair::expansion::{KEY_SCALE, Opening};
use super::node_pair::node_test::{NodeFrame, NodeScale};
use super::queue::{Bucket, Item};
use super::scene::{Scene, SceneBody, Scratch};
use super::skip::helix::screw_clear_until;
use super::skip::swept::swept_clear_until;
use super::triangle_pair::closest::closest;
use super::triangle_pair::separating_axis::{Behind, Care, Look, apart_since, look, place_a, widest_normal};
use crate::lanes::Lanes;
use crate::lanes::Quad;
use crate::lanes::Task;
use crate::tree::margin::NARROW_UP;
use crate::tree::node::{Below, LEAST_SIZE, WIDTH, WideNode};
use crate::{Budget, Mode, QueryOptions};
use glam::DVec3;
use std::time::Instant;

/// A pair that is followed out of turn is left after so many steps; ordinary contacts take fewer than ten.
const MOST_STEPS_ALONE: u32 = 64;
/// Batches between two counts of the pairs that wait, for a plane between them.
const CROWD_CHECK: u32 = 32;
/// Batches between two checks of the queue's length: it grows by less than 2¹⁵ items between them.
const MEMORY_CHECK: u32 = 128;

/// Least unit of time of a window, for those of no length: nothing moves by more than a rounding in it.
const LEAST_SPAN: f64 = 1.0 / 1_152_921_504_606_846_976.0; // 2⁻⁶⁰

/// Items that a batch may have before it is divided.
pub(super) const BATCH: usize = 32;
/// Looks at pairs of triangles of one search that do little; ordinary queries need fewer.
pub(super) const QUICK_LOOKS: u64 = 192;
/// Node tests, besides one for each [`TRIANGLES_A_TEST`] triangles, before sweeps are looked at for the first time:
/// ordinary queries end before that, or are well on their way.
const FIRST_SWEEP: u64 = 256;
/// As many triangles are measured for a sweep in the time of one node test.
const TRIANGLES_A_TEST: u64 = 8;
/// A search that has come this part of its way is on its way: it gets a node test for each triangle before sweeps.
const ON_ITS_WAY: f64 = 0.0625;

/// A pair of triangles is followed alone until its time has grown by one part in this many: what it finds early spares
/// the queue what comes later, and pairs that meet at the same features need one look back each.
const FOLLOWED: u32 = 16;
/// And by so many steps of the key: some 2e-6 of the window.
const FOLLOWED_KEYS: u32 = 1024;

/// The frame is renewed when the time has grown by more than one part in this many: an older one is as right, its
/// bounds only begin earlier.
const FRESH: u32 = 128;

/// Nodes are asked for so many items before they are opened: trees are larger than the caches near the processor.
const AHEAD: usize = 2;

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

/// How a window ended.
enum Step {
    /// The answer of the whole search.
    Answer(Outcome),
    /// Apart until here: the end of the window, or later.
    ClearUntil(f64),
}

/// One search.
pub(crate) struct Search<'s> {
    pub(super) scene: &'s Scene<'s>,
    pub(super) scratch: &'s mut Scratch,
    pub(super) limits: Limits,
    /// Of the last window, and its unit of time.
    scales: Option<(f64, [NodeScale; 2])>,
    /// Set for a single window that is searched before it is known what earlier ones give.
    #[cfg(feature = "rayon")]
    pub(super) ahead: Option<super::parallel::Ahead<'s>>,
    #[cfg(feature = "rayon")]
    parallel: bool,
}

/// How far a search goes, and when it tries something else.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) mode: Mode,
    pub(super) most_tests: u64,
    pub(super) deadline: Option<Instant>,
    /// The number of node tests from which on it is time to look at sweeps.
    pub(super) sweep_from: u64,
    /// Only whether the bodies meet at the start matters.
    pub(super) only_start: bool,
}

/// What changes while a window is searched.
pub(super) struct State<'a> {
    pub(super) motion: RelativeMotion,
    pub(super) opening: Opening<'a>,
    /// One step of the key, as a difference of offsets.
    pub(super) step: f64,
    /// Keys from here on do not matter.
    pub(super) limit: u32,
    /// The same as an offset.
    pub(super) limit_offset: f64,
    pub(super) frame: Frame,
    pub(super) node_frames: [NodeFrame; 2],
    pub(super) frame_key: u32,
    pub(super) found: Option<Found>,
    /// The time of what is found; before something is found, of no meaning.
    pub(super) behind: Behind,
}

impl Task for Search<'_> {
    type Output = Outcome;

    /// Searches window after window.
    #[inline(always)]
    fn run<L: Lanes>(mut self) -> Outcome {
        let end = self.scene.end;
        #[cfg(feature = "rayon")]
        let mut window = self.ahead.map_or_else(|| self.window_from(0.0), |ahead| Some(ahead.window));
        #[cfg(not(feature = "rayon"))]
        let mut window = self.window_from(0.0);
        while let Some((start, next)) = window {
            let clear_until = match self.search_window::<L>(start, next) {
                Step::Answer(outcome) => return outcome,
                Step::ClearUntil(until) => until,
            };
            #[cfg(feature = "rayon")]
            if self.ahead.is_some() {
                return Outcome::Separated;
            }
            if clear_until >= end {
                return Outcome::Separated;
            }
            #[cfg(feature = "rayon")]
            let clear_until = if self.parallel {
                match self.search_ahead(clear_until) {
                    Ok(until) => until,
                    Err(outcome) => return outcome,
                }
            } else {
                clear_until
            };
            window = self.window_from(clear_until);
        }
        Outcome::Separated
    }
}

impl<'s> Search<'s> {
    pub(crate) fn new(scene: &'s Scene<'s>, options: &QueryOptions, scratch: &'s mut Scratch) -> Self {
        let budget = &options.budget;
        scratch.counts = super::scene::SearchCounts::default();
        scratch.last_looked_at = [0, 0];
        let limits = Limits {
            mode: options.mode,
            most_tests: budget.node_tests.unwrap_or(u64::MAX).min(Budget::HARD_NODE_TESTS),
            deadline: budget.wall_clock.and_then(|time| Instant::now().checked_add(time)),
            sweep_from: FIRST_SWEEP + triangle_count(scene) / TRIANGLES_A_TEST,
            only_start: false,
        };
        Self {
            scene,
            scratch,
            limits,
            scales: None,
            #[cfg(feature = "rayon")]
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

    /// The search of one window ahead of its turn.
    #[cfg(feature = "rayon")]
    pub(super) fn of_window(
        scene: &'s Scene<'s>,
        limits: Limits,
        scratch: &'s mut Scratch,
        ahead: super::parallel::Ahead<'s>,
    ) -> Self {
        Self { scene, scratch, limits, scales: None, ahead: Some(ahead), parallel: false }
    }

    /// The next window to be searched; `None` when nothing is left.
    pub(super) fn window_from(&self, start: f64) -> Option<(f64, f64)> {
        let end = self.scene.end;
        let start = self.scene.balls_clear_until(start);
        // A query of no length has one window.
        if start >= end && end > 0.0 {
            return None;
        }
        Some((start, (start + self.scene.longest).min(end)))
    }

    #[inline(always)]
    fn search_window<L: Lanes>(&mut self, start: f64, end: f64) -> Step {
        let scene = self.scene;
        let motion = RelativeMotion::new(scene, start);
        // At least end − start, whatever its rounding.
        let length = (end - start).next_up();
        let time_unit = power_of_two_from(length.max(LEAST_SPAN));
        let step = time_unit / KEY_SCALE;
        let scales = match self.scales {
            Some((unit, scales)) if unit == time_unit => scales,
            _ => scene.node_scales(time_unit),
        };
        self.scales = Some((time_unit, scales));
        let mut state = State {
            motion,
            node_frames: [NodeFrame::NONE; 2],
            opening: Opening {
                nodes: [&scene.a.tree.nodes, &scene.b.tree.nodes],
                scales,
                size_ratios: [
                    cube(scales[1].ratio).clamp(LEAST_SIZE.into(), 1.0 / f64::from(LEAST_SIZE)) as f32,
                    1.0,
                ],
            },
            step,
            limit: (length / step).ceil() as u32 + 1,
            // A tick more, so that the end itself is inside; what is found after the end does not count.
            limit_offset: length + step,
            frame: Frame::NONE,
            frame_key: 0,
            found: None,
            behind: Behind { reversed: Frame::NONE, direction: DVec3::ZERO },
        };
        self.scratch.counts.windows += 1;
        self.scratch.queue.clear();
        let open = state.opening.of_pair(0, 0);
        self.scratch.queue.push(&Item { key: 0, boxes: [0; 2], open });
        let mut batch = core::mem::replace(&mut self.scratch.batch, Bucket::EMPTY);
        let (mut outcome, mut begun, mut batches) = (None, false, 0u32);
        let mut patience = Patience::new();
        while let Some(least) = self.scratch.queue.take(&mut batch, BATCH) {
            if least >= state.limit {
                break;
            }
            if self.limits.only_start && least > 0 {
                outcome = Some(Step::Answer(Outcome::Separated));
                break;
            }
            batches += 1;
            let full = batches % MEMORY_CHECK == 0 && self.scratch.queue.len() > Budget::HARD_QUEUED_PAIRS;
            if full || self.out_of_budget() {
                outcome = Some(Step::Answer(Outcome::OutOfBudget(sum_down(start, f64::from(least) * step))));
                break;
            }
            #[cfg(feature = "rayon")]
            if self.ahead.is_some_and(|ahead| self.work() >= self.limits.sweep_from || ahead.is_useless()) {
                outcome = Some(Step::Answer(Outcome::OutOfBudget(start)));
                break;
            }
            if self.work() >= self.limits.sweep_from {
                let now = sum_down(start, f64::from(least) * step);
                if let Some(until) = self.sweep(&state, now, batch.items()[0].boxes)
                    && until >= end
                {
                    outcome = Some(Step::ClearUntil(until));
                    break;
                }
            }
            self.scratch.counts.frames += 1;
            if !begun || least > state.frame_key + state.frame_key / FRESH {
                state.frame = state.motion.frame::<L::Doubles>(f64::from(least) * step);
                let left = time_left(state.limit, least);
                state.node_frames = [
                    NodeFrame::new::<L::Doubles>(&state.frame, &state.opening.scales[0], false, left),
                    NodeFrame::new::<L::Doubles>(&state.frame, &state.opening.scales[1], true, left),
                ];
                state.frame_key = least;
                begun = true;
            }
            if batches % CROWD_CHECK == 0 {
                self.thin_out::<L>(&mut state, (least, batches), &mut batch, &mut patience);
            }
            self.open::<L>(&mut state, batch.items());
        }
        self.scratch.batch = batch;
        outcome.unwrap_or(match state.found {
            Some(found) if found.offset <= length => {
                self.scratch.found_in = Some(state.motion);
                Step::Answer(Outcome::Found(found))
            }
            _ => Step::ClearUntil(end),
        })
    }

    /// An offset up to which the sweeps of the bodies are apart from `now` on; none if they are not for long. `boxes`:
    /// a pair that may be near.
    #[cold]
    #[inline(never)]
    fn sweep(&mut self, state: &State<'_>, now: f64, boxes: [u32; 2]) -> Option<f64> {
        let patient = FIRST_SWEEP + triangle_count(self.scene);
        if self.work() < patient && now > ON_ITS_WAY * self.scene.end {
            self.limits.sweep_from = patient;
            return None;
        }
        if self.scratch.counts.triangle_looks == 0 {
            self.scratch.last_looked_at =
                [0, 1].map(|body| first_triangle(state.opening.nodes[body], boxes[body]));
        }
        let [a, b] = self.scratch.last_looked_at;
        let b = self.scene.b.corners(b);
        let near = widest_normal(&place_a::<Quad>(&state.frame, &self.scene.a.corners(a)), &b);
        let turn = state.motion.rotation_b(state.frame.offset);
        let interest = turn.times::<Quad>(near).to_vec().normalize_or(DVec3::X);
        let gain = self.scene.longest.min(self.scene.end - now);
        let limits = (gain, self.work() + FIRST_SWEEP);
        let (mut until, mut pairs) =
            swept_clear_until(self.scene, now, limits, interest, self.scratch.last_looked_at);
        if until.is_none() {
            let (later, more) = screw_clear_until(self.scene, now, limits, self.scratch.last_looked_at);
            (until, pairs) = (later, pairs + more);
        }
        self.scratch.counts.sweeps += 1;
        self.scratch.counts.swept_pairs += pairs;
        let work = self.work();
        let from = &mut self.limits.sweep_from;
        *from = if until.is_some() { work + *from / 4 } else { 4 * work };
        until
    }

    /// What the search has done, in node tests.
    pub(super) fn work(&self) -> u64 {
        self.scratch.counts.work()
    }

    fn out_of_budget(&self) -> bool {
        self.work() >= self.limits.most_tests
            || self.limits.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// Opens at most [`BATCH`] items. Pairs of triangles first: they may lower the limit. Then all node tests, which
    /// do not wait for each other, then all that they leave.
    #[inline(always)]
    fn open<L: Lanes>(&mut self, state: &mut State<'_>, items: &[Item]) {
        for item in &items[..AHEAD.min(items.len())] {
            state.prefetch::<L>(item);
        }
        for item in items {
            if item.open & Item::TRIANGLES != 0 && item.key < state.limit {
                self.advance::<L>(state, *item, false);
            }
        }
        let fresh = &mut self.scratch.fresh;
        fresh.resize(WIDTH * (BATCH + 1), [0; 4]);
        let (mut tests, mut count) = (0, 0);
        for (i, item) in items.iter().enumerate() {
            if let Some(next) = items.get(i + AHEAD) {
                state.prefetch::<L>(next);
            }
            if item.open & Item::TRIANGLES == 0 && item.key < state.limit {
                let times = (state.frame_key, state.limit);
                let opened = state.opening.expand::<L>(item, &state.node_frames, times);
                let list = fresh[count..].first_chunk_mut().expect("room for eight more");
                count += L::pack(&opened, list);
                tests += 1;
            }
        }
        self.scratch.counts.node_tests += tests;
        self.scratch.counts.queued += count as u64;
        let fresh = self.scratch.fresh[..count].iter();
        self.scratch.queue.extend(fresh.map(|row| Item::from_row(*row)));
    }

    /// Advances a pair of triangles until it is past the limit, waits for others (not if `alone`), or is in contact.
    #[inline(always)]
    pub(super) fn advance<L: Lanes>(&mut self, state: &mut State<'_>, item: Item, alone: bool) {
        let triangle = |body: usize| {
            let index = item.boxes[body] as usize;
            state.opening.nodes[body][index / WIDTH].triangle(index % WIDTH)
        };
        let triangles = [triangle(0), triangle(1)];
        let (a, b) = (self.scene.a.corners(triangles[0]), self.scene.b.corners(triangles[1]));
        if self.limits.mode == Mode::Capoeira && self.stop_early::<L>(state, item, &a, &b, triangles) {
            return;
        }
        // Proven apart until here.
        let mut known = f64::from(item.key) * state.step;
        if state.found.is_some() {
            self.scratch.counts.triangle_looks += 1;
            let span = (state.limit_offset - known).next_up();
            if apart_since::<L::Doubles>(&state.behind, (&a, &b), &self.scene.pair, span) {
                return;
            }
        }
        let mut frame = state.frame;
        let mut steps = 0u32;
        loop {
            steps += 1;
            if alone && steps > MOST_STEPS_ALONE {
                return;
            }
            if steps.is_multiple_of(256) && self.out_of_budget() {
                let key = ((known / state.step) as u32).max(item.key);
                self.scratch.queue.push(&Item { key, ..item });
                return;
            }
            self.scratch.counts.triangle_looks += 1;
            self.scratch.last_looked_at = triangles;
            let enough = state.limit_offset - frame.offset;
            let care =
                if self.scratch.counts.triangle_looks > QUICK_LOOKS { Care::Thorough } else { Care::Quick };
            match look::<L::Doubles>(&frame, (&a, &b), &self.scene.pair, enough, care) {
                Look::ClearFor(time) => {
                    known = known.max(frame.offset + time);
                    if known >= state.limit_offset {
                        return;
                    }
                    let key = (known / state.step) as u32;
                    if !alone && key > item.key + item.key / FOLLOWED + FOLLOWED_KEYS {
                        if key < state.limit {
                            self.scratch.queue.push(&Item { key, ..item });
                        }
                        return;
                    }
                }
                Look::Near { crossing, direction } => {
                    // Near at the time of the frame, which may be before what the boxes proved: then look again there.
                    if known <= frame.offset {
                        if known < state.limit_offset {
                            state.find(known, triangles, crossing);
                            state.behind = Behind { reversed: frame.reversed::<L::Doubles>(), direction };
                            if self.limits.mode == Mode::Exists {
                                state.end();
                            }
                        }
                        return;
                    }
                }
            }
            if known > frame.offset {
                frame = state.motion.frame::<L::Doubles>(known);
            } else {
                // The time left is below the resolution of time itself: as near as times can tell.
                state.find(known, triangles, false);
                state.behind = Behind { reversed: frame.reversed::<L::Doubles>(), ..state.behind };
                return;
            }
        }
    }
}

impl State<'_> {
    /// Asks for the node that the item opens.
    #[inline(always)]
    fn prefetch<L: Lanes>(&self, item: &Item) {
        if item.open & Item::TRIANGLES == 0 {
            L::prefetch(&self.opening.nodes[item.side()][item.node() as usize]);
        }
    }
    /// A contact at this offset: nothing later matters, and nothing whose key is not below it can be earlier. The step
    /// is a power of two, so the quotient is exact.
    fn find(&mut self, offset: f64, triangles: [u32; 2], crossing: bool) {
        self.limit_offset = offset;
        self.limit = ((offset / self.step).ceil() as u32).min(self.limit);
        self.found = Some(Found { start: self.motion.start, offset, triangles, crossing });
    }

    /// Nothing matters any more.
    fn end(&mut self) {
        self.limit = 0;
        self.limit_offset = 0.0;
    }
}

impl Search<'_> {
    /// Capoeira: takes the pair as the answer when the triangles are as close as their boxes are large. What is
    /// certified is the time of the frame: no live key is earlier.
    fn stop_early<L: Lanes>(
        &self,
        state: &mut State<'_>,
        item: Item,
        a: &[DVec3; 3],
        b: &[DVec3; 3],
        triangles: [u32; 2],
    ) -> bool {
        let radius = |body: &SceneBody<'_>, index: u32| {
            let (node, lane) = (&body.tree.nodes[index as usize / WIDTH], index as usize % WIDTH);
            f64::from(node.radius[lane]) * body.box_unit()
        };
        let size = radius(&self.scene.a, item.boxes[0]) + radius(&self.scene.b, item.boxes[1]);
        let near = closest::<L::Doubles>(&place_a::<L::Doubles>(&state.frame, a), b);
        let close = near.square <= size * size && (state.frame.offset > 0.0 || near.square > 0.0);
        // At the very start the accurate look decides whether the bodies touch.
        if close && (state.frame_key > 0 || state.motion.start > 0.0) {
            let offset = state.frame.offset;
            state.found = Some(Found { start: state.motion.start, offset, triangles, crossing: false });
            state.end();
            return true;
        }
        false
    }
}

/// A triangle in a box.
fn first_triangle(nodes: &[WideNode], index: u32) -> u32 {
    match nodes[index as usize / WIDTH].below(index as usize % WIDTH) {
        Below::Triangle(triangle) => triangle,
        Below::Node(node) => first_triangle(nodes, node * WIDTH as u32),
    }
}

fn triangle_count(scene: &Scene<'_>) -> u64 {
    (scene.a.tree.mesh.triangle_count() + scene.b.tree.mesh.triangle_count()) as u64
}

/// Units of the window from key `now` to key `limit`, rounded up.
fn time_left(limit: u32, now: u32) -> f32 {
    (limit - now) as f32 * (1.0 / KEY_SCALE as f32) * NARROW_UP as f32
}

fn cube(x: f64) -> f64 {
    x * x * x
}

/// The sum of two offsets, rounded down.
fn sum_down(start: f64, offset: f64) -> f64 {
    let sum = two_sum(start, offset);
    if sum.1 < 0.0 { sum.0.next_down() } else { sum.0 }
}
