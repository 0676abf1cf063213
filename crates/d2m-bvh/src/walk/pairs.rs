//! What is done with the pairs that the queue hands out: boxes are expanded, triangles are advanced in time.

use super::effort::{self, AHEAD, BATCH, MOST_STEPS_ALONE};
use super::expansion::DirectedSpan;
use super::queue::Item;
use super::state::{Found, Search, State};
use crate::Mode;
use crate::pair::motion::frame::Frame;
use crate::pair::scene::SceneBody;
use crate::pair::triangles::closest::closest;
use crate::pair::triangles::separating_axis::{
    BackwardCertificate, Evaluation, apart_since, place_a, separating_axis_test,
};
use d2m_lanes::{Lanes, Task, run};
#[cfg(feature = "audit")]
use d2m_mesh::audit::Place;
use d2m_mesh::node::WIDTH;
use glam::DVec3;

/// When a pair is advanced.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Turn {
    /// Nothing that waits comes before it.
    Own,
    /// Before others that come first, for what it finds early.
    Ahead,
}

impl Search<'_> {
    /// Expands at most [`BATCH`] items. Pairs of triangles first: they may lower the limit. Then all node tests, which
    /// do not wait for each other, then all that they leave.
    #[inline(always)]
    pub(super) fn expand_batch<L: Lanes>(
        &mut self,
        state: &mut State<'_>,
        items: &[Item],
        parting: Option<&DirectedSpan<'_, L>>,
    ) {
        for item in &items[..AHEAD.min(items.len())] {
            state.prefetch::<L>(item);
        }
        for item in items {
            if item.next & Item::TRIANGLES != 0 && item.key < state.limit {
                self.advance::<L>(state, *item, Turn::Own);
            }
        }
        let fresh = &mut self.scratch.fresh;
        fresh.resize(WIDTH * (BATCH + 1), [0; 4]);
        let (mut tests, mut count) = (0, 0);
        for (i, item) in items.iter().enumerate() {
            if let Some(next) = items.get(i + AHEAD) {
                state.prefetch::<L>(next);
            }
            if item.next & Item::TRIANGLES == 0 && item.key < state.limit {
                let mut expanded = state.expander.expand::<L>(item, &state.node_frames, state.keys());
                if let Some(span) = parting
                    && expanded.wanted != 0
                {
                    let apart = state.expander.apart_along::<L>(item, span);
                    expanded.wanted &= !apart;
                    #[cfg(feature = "audit")]
                    state.conclude_parted(self.scene, item, &expanded, apart);
                }
                #[cfg(feature = "audit")]
                state.conclude_rows(self.scene, item, &expanded);
                let list = fresh[count..].first_chunk_mut().expect("room for eight more");
                count += L::pack(&expanded, list);
                tests += 1;
            }
        }
        self.scratch.counts.node_tests += tests;
        self.scratch.counts.queued += count as u64;
        let fresh = self.scratch.fresh[..count].iter();
        self.scratch.queue.extend(fresh.map(|row| Item::from_row(*row)));
    }

    /// Advances a pair of triangles until it is past the limit, waits for others (if in turn), or is in contact.
    #[inline(always)]
    pub(super) fn advance<L: Lanes>(&mut self, state: &mut State<'_>, item: Item, turn: Turn) {
        let triangle = |body: usize| {
            let index = item.boxes[body] as usize;
            state.expander.nodes[body][index / WIDTH].triangle(index % WIDTH)
        };
        let triangles = [triangle(0), triangle(1)];
        let (a, b) = (self.scene.a.corners(triangles[0]), self.scene.b.corners(triangles[1]));
        if self.limits.mode == Mode::Capoeira && self.stop_early(state, item, &a, &b, triangles) {
            return;
        }
        // Proven apart until here.
        let mut known = f64::from(item.key) * state.step;
        if state.found.is_some() {
            self.scratch.counts.triangle_looks += 1;
            let span = (state.limit_offset - known).next_up();
            if apart_since::<L::Doubles>(&state.behind, [&a, &b], &self.scene.pair, span) {
                #[cfg(feature = "audit")]
                state.conclude_pair(self.scene, Place::Backward, [known, state.limit_offset], triangles);
                return;
            }
        }
        let start = state.motion.start;
        // Not copied: most pairs end with the frame of all.
        let mut own;
        let mut frame = &state.frame;
        let mut steps = 0u32;
        loop {
            steps += 1;
            if turn == Turn::Ahead && steps > MOST_STEPS_ALONE {
                return;
            }
            if steps.is_multiple_of(256) && self.out_of_budget() {
                let key = ((known / state.step) as u32).max(item.key);
                self.scratch.queue.push(Item { key, ..item });
                return;
            }
            self.scratch.counts.triangle_looks += 1;
            self.scratch.last_tested = triangles;
            let enough = state.limit_offset - frame.offset;
            let looks = self.scratch.counts.triangle_looks;
            let order = effort::bound_order(looks, steps);
            match separating_axis_test::<L::Doubles>(frame, [&a, &b], &self.scene.pair, enough, order) {
                Evaluation::ClearFor(time) => {
                    known = known.max(frame.offset + time);
                    #[cfg(feature = "audit")]
                    state.conclude_pair(
                        self.scene,
                        Place::TrianglePair,
                        [frame.offset, (frame.offset + time).min(state.limit_offset)],
                        triangles,
                    );
                    if known >= state.limit_offset {
                        return;
                    }
                    let key = (known / state.step) as u32;
                    if turn == Turn::Own && key > effort::followed_until(item.key) {
                        if key < state.limit {
                            self.scratch.queue.push(Item { key, ..item });
                        }
                        return;
                    }
                }
                Evaluation::Near { crossing, direction } => {
                    // Near at the time of the frame, which may be before what the boxes proved: then it is evaluated again there.
                    if known <= frame.offset {
                        if known < state.limit_offset {
                            let reversed = frame.reversed::<L::Doubles>();
                            state.find(Found { start, offset: known, triangles, crossing });
                            state.behind = BackwardCertificate { reversed, direction };
                            if self.limits.mode == Mode::Exists {
                                state.end();
                            }
                        }
                        return;
                    }
                }
            }
            if known > frame.offset {
                own = state.motion.frame::<L::Doubles>(known);
                frame = &own;
            } else {
                // The time left is below the resolution of time itself: no time between would show more.
                let reversed = frame.reversed::<L::Doubles>();
                state.find(Found { start, offset: known, triangles, crossing: false });
                state.behind.reversed = reversed;
                return;
            }
        }
    }

    /// Capoeira: takes the pair as the answer when the triangles are as close as their boxes are large. What is
    /// certified is the time of the frame: no live key is earlier.
    fn stop_early(
        &self,
        state: &mut State<'_>,
        item: Item,
        a: &[DVec3; 3],
        b: &[DVec3; 3],
        triangles: [u32; 2],
    ) -> bool {
        let radius = |body: &SceneBody<'_>, index: u32| {
            let (node, lane) = (&body.tree.nodes()[index as usize / WIDTH], index as usize % WIDTH);
            f64::from(node.radius[lane]) * body.box_unit()
        };
        let size = radius(&self.scene.a, item.boxes[0]) + radius(&self.scene.b, item.boxes[1]);
        let distance_squared = run(DistanceSquared { frame: &state.frame, a, b });
        let close = distance_squared <= size * size && (state.frame.offset > 0.0 || distance_squared > 0.0);
        // At the very start the accurate test decides whether the bodies touch.
        if close && (state.frame_key > 0 || state.motion.start > 0.0) {
            let offset = state.frame.offset;
            state.found = Some(Found { start: state.motion.start, offset, triangles, crossing: false });
            state.end();
            return true;
        }
        false
    }
}

/// The squared distance of two triangles that do not cross, the first one of A at the time of the frame. A task of its own:
/// the search proper is the leaner without it.
struct DistanceSquared<'a> {
    frame: &'a Frame,
    a: &'a [DVec3; 3],
    b: &'a [DVec3; 3],
}

impl Task for DistanceSquared<'_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self) -> f64 {
        closest::<L::Doubles>(&place_a::<L::Doubles>(self.frame, self.a), self.b).distance_squared
    }
}

impl State<'_> {
    /// Prefetches the node that the item expands.
    #[inline(always)]
    fn prefetch<L: Lanes>(&self, item: &Item) {
        if item.next & Item::TRIANGLES == 0 {
            L::prefetch(&self.expander.nodes[item.side()][item.node() as usize]);
        }
    }
}
