//! The search itself: windows of limited rotation, and best first inside each.

use super::closest::closest;
use super::frame::{Frame, RelativeMotion};
use super::lanes::Lanes;
use super::node_test::{NodeFrame, NodeScale, Placed, entry_times};
use super::queue::Item;
use super::scene::{Scene, Scratch};
use super::triangle_pair::{Look, look, place_a};
use crate::tree::node::{Below, WIDTH};
use crate::{Budget, MeshTree, Mode, QueryOptions};
use glam::DVec3;
use std::time::Instant;

/// Keys of a window run from 0 to this for its whole unit of time.
const KEY_SCALE: f64 = 536_870_912.0; // 2²⁹
/// Items that a batch may have before it is divided.
const BATCH: usize = 32;

/// A contact as the search knows it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// Start of the window of the search in which it lies, and the offset from there.
    pub(crate) start: f64,
    pub(crate) offset: f64,
    pub(crate) triangles: [u32; 2],
    /// Whether no direction kept the triangles apart: they cross, or come within the level of it.
    pub(crate) crossing: bool,
}

/// Result of a search.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Outcome {
    Separated,
    Found(Found),
    /// The budget ran out; free until this time.
    OutOfBudget(f64),
}

/// One search.
pub(crate) struct Search<'s> {
    scene: &'s Scene<'s>,

    scratch: &'s mut Scratch,
    mode: Mode,
    node_tests: u64,
    most_tests: u64,
    deadline: Option<Instant>,
}

/// What changes while a window is searched.
struct State {
    motion: RelativeMotion,
    scales: [NodeScale; 2],
    /// Seconds (scene time) of one step of the key.
    step: f64,
    /// Keys from here on do not matter.
    limit: u32,
    /// The same as an offset.
    limit_offset: f64,
    frame: Frame,
    node_frames: [NodeFrame; 2],
    /// Size of A's units over that of B's.
    size_ratio: f32,
    frame_key: u32,
    found: Option<Found>,
}

impl<'s> Search<'s> {
    pub(crate) fn new(scene: &'s Scene<'s>, options: &QueryOptions, scratch: &'s mut Scratch) -> Self {
        let budget = &options.budget;
        scratch.counts = super::scene::SearchCounts::default();
        Self {
            scene,

            scratch,
            mode: options.mode,
            node_tests: 0,
            most_tests: budget.node_tests.unwrap_or(u64::MAX).min(Budget::HARD_NODE_TESTS),
            deadline: budget.wall_clock.and_then(|time| Instant::now().checked_add(time)),
        }
    }

    /// Searches window after window.
    #[inline(always)]
    pub(crate) fn run<L: Lanes>(mut self) -> Outcome {
        let (mut start, end) = (self.scene.window.start(), self.scene.window.end());
        loop {
            start = self.scene.balls_clear_until(start);
            if start >= end && end > self.scene.window.start() {
                return Outcome::Separated;
            }
            let next = (start + self.scene.longest).min(end);
            let next = if next > start { next } else { end };
            match self.search_window::<L>(start, next) {
                Outcome::Separated if next < end => start = next,
                outcome => return outcome,
            }
        }
    }

    #[inline(always)]
    fn search_window<L: Lanes>(&mut self, start: f64, end: f64) -> Outcome {
        let scene = self.scene;
        let motion = RelativeMotion::new((scene.a.0, &scene.a.1), (scene.b.0, &scene.b.1), start);
        // At least end − start, whatever its rounding.
        let length = (end - start) * (1.0 + 1e-15);
        let time_unit = power_of_two_from(length);
        let step = time_unit / KEY_SCALE;
        let scales = scene.node_scales(time_unit);
        let frame = motion.frame(0.0);
        let limit = (length / step).ceil() as u32 + 1;
        let left = time_left(limit, 0);
        let mut state = State {
            motion,
            node_frames: [
                NodeFrame::new(&frame, &scales[0], false, left),
                NodeFrame::new(&frame, &scales[1], true, left),
            ],
            size_ratio: scales[1].ratio.powi(3) as f32,
            scales,
            step,
            limit,
            // A tick more, so that the end itself is inside; what is found after the end does not count.
            limit_offset: length + step,
            frame,
            frame_key: 0,
            found: None,
        };
        self.scratch.counts.windows += 1;
        self.scratch.queue.clear();
        self.scratch.queue.push(Item { key: 0, a: 0, b: 0 });
        let mut batch = core::mem::take(&mut self.scratch.batch);
        let mut outcome = None;
        while let Some(least) = self.scratch.queue.take(&mut batch, BATCH) {
            if least >= state.limit {
                break;
            }
            if self.out_of_budget() {
                outcome = Some(Outcome::OutOfBudget(time_from(start, f64::from(least) * step)));
                break;
            }
            self.scratch.counts.frames += 1;
            if least != state.frame_key {
                state.frame = state.motion.frame(f64::from(least) * step);
                let left = time_left(state.limit, least);
                state.node_frames = [
                    NodeFrame::new(&state.frame, &state.scales[0], false, left),
                    NodeFrame::new(&state.frame, &state.scales[1], true, left),
                ];
                state.frame_key = least;
            }
            for item in &batch {
                if item.key < state.limit {
                    self.open::<L>(&mut state, *item);
                }
            }
        }
        self.scratch.batch = batch;
        outcome.unwrap_or(match state.found {
            Some(found) if found.offset <= length => Outcome::Found(found),
            _ => Outcome::Separated,
        })
    }

    fn out_of_budget(&self) -> bool {
        self.node_tests >= self.most_tests || self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
    }

    /// What is to be opened of a pair: the number of the wide node and 0 for A, 1 for B; or the two triangles.
    #[inline(always)]
    fn larger(&self, state: &State, item: Item) -> Result<(u32, usize), [u32; 2]> {
        let split = |index: u32| (index as usize / WIDTH, index as usize % WIDTH);
        let ((ia, la), (ib, lb)) = (split(item.a), split(item.b));
        let (na, nb) = (&self.scene.a.0.nodes[ia], &self.scene.b.0.nodes[ib]);
        match (na.below(la), nb.below(lb)) {
            (Below::Triangle(a), Below::Triangle(b)) => Err([a, b]),
            (Below::Node(a), Below::Triangle(_)) => Ok((a, 0)),
            (Below::Triangle(_), Below::Node(b)) => Ok((b, 1)),
            (Below::Node(a), Below::Node(b)) => {
                if na.size[la] * state.size_ratio >= nb.size[lb] {
                    Ok((a, 0))
                } else {
                    Ok((b, 1))
                }
            }
        }
    }

    #[inline(always)]
    fn open<L: Lanes>(&mut self, state: &mut State, item: Item) {
        let (tree_a, tree_b) = (self.scene.a.0, self.scene.b.0);
        let (wide_index, side) = match self.larger(state, item) {
            Ok(choice) => choice,
            Err(triangles) => return self.advance(state, item, triangles),
        };
        let (na, la) = (&tree_a.nodes[item.a as usize / WIDTH], item.a as usize % WIDTH);
        let (nb, lb) = (&tree_b.nodes[item.b as usize / WIDTH], item.b as usize % WIDTH);
        self.node_tests += 1;
        self.scratch.counts.node_tests += 1;
        let (wide, single, lane) = if side == 0 {
            (&tree_a.nodes[wide_index as usize], nb, lb)
        } else {
            (&tree_b.nodes[wide_index as usize], na, la)
        };
        let scale = &state.scales[side];
        let placed = Placed::new(&state.node_frames[side], scale, (single, lane), wide);
        let times = entry_times::<L>(wide, &placed, scale);
        // What is not a number becomes the key of the item itself.
        let steps = L::splat(1.25 * KEY_SCALE as f32).min(times * L::splat(KEY_SCALE as f32));
        let (keys, below) = steps.keys(state.frame_key as i32, item.key as i32, state.limit as i32);
        let mut bits = below & ((1 << wide.used) - 1);
        let child = wide_index * WIDTH as u32;
        while bits != 0 {
            let lane = bits.trailing_zeros();
            bits &= bits - 1;
            let key = keys[lane as usize & 7] as u32;
            let (a, b) = if side == 0 { (child + lane, item.b) } else { (item.a, child + lane) };
            self.scratch.counts.queued += 1;
            self.scratch.queue.push(Item { key, a, b });
        }
    }

    /// Advances a pair of triangles until it is past the limit, waits for others, or is in contact.
    #[inline(always)]
    fn advance(&mut self, state: &mut State, item: Item, triangles: [u32; 2]) {
        let a = corners(self.scene.a.0, triangles[0]);
        let b = corners(self.scene.b.0, triangles[1]);
        if self.mode == Mode::Capoeira && self.stop_early(state, item, &a, &b, triangles) {
            return;
        }
        let mut frame = state.frame;
        let mut steps = 0u32;
        // Proven apart until here.
        let mut known = f64::from(item.key) * state.step;
        loop {
            steps += 1;
            if steps.is_multiple_of(256) && self.out_of_budget() {
                let key = ((known / state.step) as u32).max(item.key);
                self.scratch.queue.push(Item { key, ..item });
                return;
            }
            self.node_tests += 1;
            self.scratch.counts.triangle_looks += 1;
            let enough = state.limit_offset - frame.offset;
            match look(&frame, &a, &b, &self.scene.pair, enough) {
                Look::ClearFor(time) => {
                    known = known.max(frame.offset + time);
                    if known >= state.limit_offset {
                        return;
                    }
                    let key = (known / state.step) as u32;
                    if key > item.key + 1024 {
                        if key < state.limit {
                            self.scratch.queue.push(Item { key, ..item });
                        }
                        return;
                    }
                }
                Look::Near { crossing } => {
                    // Near at the time of the frame, which may be before what the boxes proved: look again there.
                    if known > frame.offset {
                        frame = state.motion.frame(known);
                        continue;
                    }
                    if self.mode == Mode::Exists && known < state.limit_offset {
                        state.found =
                            Some(Found { start: state.motion.start, offset: known, triangles, crossing });
                        state.end();
                        return;
                    }
                    if known < state.limit_offset {
                        state.limit_offset = known;
                        state.limit = ((known / state.step) as u32 + 1).min(state.limit);
                        state.found =
                            Some(Found { start: state.motion.start, offset: known, triangles, crossing });
                    }
                    return;
                }
            }
            if known > frame.offset {
                frame = state.motion.frame(known);
            } else {
                // The time left is below the resolution of time itself: as near as times can tell.
                state.limit_offset = known;
                state.limit = ((known / state.step) as u32 + 1).min(state.limit);
                state.found =
                    Some(Found { start: state.motion.start, offset: known, triangles, crossing: false });
                return;
            }
        }
    }
}

impl State {
    /// Nothing matters any more.
    fn end(&mut self) {
        self.limit = 0;
        self.limit_offset = 0.0;
    }
}

impl Search<'_> {
    /// Capoeira: takes the pair as the answer when the triangles are as close as their boxes are large. What is
    /// certified is the time of the frame: no live key is earlier.
    fn stop_early(
        &self,
        state: &mut State,
        item: Item,
        a: &[DVec3; 3],
        b: &[DVec3; 3],
        triangles: [u32; 2],
    ) -> bool {
        let radius = |tree: &MeshTree, index: u32| {
            f64::from(tree.nodes[index as usize / WIDTH].radius[index as usize % WIDTH]) * tree.unit
        };
        let size = radius(self.scene.a.0, item.a) + radius(self.scene.b.0, item.b);
        let near = closest(&place_a(&state.frame, a), b);
        let close = near.square <= size * size && (state.frame.offset > 0.0 || near.square > 0.0);
        // At the very start the accurate look decides whether the bodies touch.
        if close && (state.frame_key > 0 || state.motion.start > self.scene.window.start()) {
            let offset = state.frame.offset;
            state.found = Some(Found { start: state.motion.start, offset, triangles, crossing: false });
            state.end();
            return true;
        }
        false
    }
}

/// Corners relative to the tree's centre, body axes, scene units.
#[inline(always)]
pub(crate) fn corners(tree: &MeshTree, triangle: u32) -> [DVec3; 3] {
    let [i, j, k] = tree.mesh.triangles()[triangle as usize];
    let vertices = tree.mesh.vertices();
    [
        vertices[i as usize] - tree.center,
        vertices[j as usize] - tree.center,
        vertices[k as usize] - tree.center,
    ]
}

/// Units of the window from key `now` to key `limit`, rounded up.
fn time_left(limit: u32, now: u32) -> f32 {
    (limit - now) as f32 * (1.0 / KEY_SCALE as f32) * (1.0 + 1e-6)
}

/// The least power of two that is not below a positive `length`.
fn power_of_two_from(length: f64) -> f64 {
    let length = length.max(1e-290);
    let power = f64::from_bits(length.to_bits() & (0x7ff << 52));
    if power < length { 2.0 * power } else { power }
}

/// start + offset, rounded down.
pub(crate) fn time_from(start: f64, offset: f64) -> f64 {
    let sum = start + offset;
    let back = sum - start;
    let error = (start - (sum - back)) + (offset - back);
    if error < 0.0 { sum.next_down() } else { sum }
}
