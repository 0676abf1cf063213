//! Spans of time that are divided where pairs of boxes need it.
//!
//! A sub-window of some tenths of a radian is short against what most pairs of boxes allow that are not near each other: at
//! high spins a search would begin at the root hundreds of times. So a longer span comes first. Its pairs of boxes are
//! tested over all of it; those that stay apart are done with. The others are expanded while boxes are large against
//! the way that their points go, and handed on to the two halves of the span. Spans that are short enough are searched
//! best first, from the pairs that are left. Most have none.
//!
//! See docs/theory/engine.md, "Time, divided".

use crate::pair::boxes::node_scale::NodeScale;
use crate::pair::boxes::whole_span::{PlacedPose, SpanFrame};
use crate::pair::motion::frame::{FAR_ANGLE, PlacedFrame, RelativeMotion};
use crate::pair::scene::{MovingScene, WINDOW_ANGLE};
use crate::walk::best_first::{OneWindow, expander};
use crate::walk::effort::{LAST_TESTS, MOST_PAIRS_OF_SPAN};
use crate::walk::queue::{Item, WaitingSpan, WaitingSpans};
use crate::walk::state::{Outcome, Search, Step, SubWindow};
use d2m_lanes::{Lanes, Task, run_on};
use d2m_mesh::node::{NodeBox, WIDTH, WideNode};

/// A span is halved so often before it is searched.
const HALVINGS: usize = 4;
/// Steps of the grid of times on which the spans and their middles lie.
const GRID: usize = 2 << HALVINGS;
/// A span is so many of the longest sub-windows. At all its times the bodies are within 1.2 rad of how they lie in its middle,
/// so that far frames hold, with room for roundings.
const SPAN: f64 = 8.0;
const _: () = assert!(0.5 * SPAN * WINDOW_ANGLE < 0.99 * FAR_ANGLE);

/// The radii of boxes, of A and of B, from which on a pair is divided in a span: nothing rests on how exact they are.
struct LeastRadii<'a> {
    nodes: [&'a [WideNode]; 2],
    least: [f32; 2],
}

impl<'a> LeastRadii<'a> {
    /// `way`: how far points go against each other in the span, in the unit of the scene.
    fn new(scene: &MovingScene<'a>, way: f64) -> Self {
        let bodies = [&scene.a, &scene.b];
        Self {
            nodes: bodies.map(|body| body.tree.nodes()),
            least: bodies.map(|body| (way / body.box_unit()) as f32),
        }
    }

    /// Whether a box of the pair is as large as that.
    #[inline(always)]
    fn are_reached(&self, item: &Item) -> bool {
        let reached = |k: usize| {
            let NodeBox { node, lane } = NodeBox::new(self.nodes[k], item.boxes[k]);
            node.radius[lane] >= self.least[k]
        };
        reached(0) || reached(1)
    }
}

/// The search of one span by dividing it.
struct DividedSpan<'a, 's> {
    search: &'a mut Search<'s>,
    span: SubWindow,
}

impl Task for DividedSpan<'_, '_> {
    type Output = Step;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Step {
        let Self { search, span } = self;
        let mut waiting = core::mem::take(&mut search.scratch.split);
        let step = search.search_divided::<L>(span, &mut waiting);
        search.scratch.split = waiting;
        step
    }
}

/// Times of a span on a grid, and the poses there that were needed so far.
struct Grid {
    span: SubWindow,
    motion: RelativeMotion,
    scales: [NodeScale; 2],
    poses: [Option<[PlacedPose; 2]>; GRID + 1],
}

impl Grid {
    fn new(scene: &MovingScene<'_>, span: SubWindow) -> Self {
        let motion = scene.relative_motion(span.start + 0.5 * (span.end - span.start));
        Self { span, motion, scales: scene.node_scales(1.0), poses: [None; GRID + 1] }
    }

    /// The time at a place of the grid.
    fn time(&self, index: usize) -> f64 {
        if index == GRID {
            return self.span.end;
        }
        self.span.start + (self.span.end - self.span.start) * (index as f64 / GRID as f64)
    }

    /// Makes sure that the poses at a place are there.
    #[inline(always)]
    fn fill<L: Lanes>(&mut self, index: usize) {
        if self.poses[index].is_none() {
            let offset = self.time(index) - self.motion.start;
            self.poses[index] = Some(PlacedPose::both::<L::Doubles>(&self.motion, offset, &self.scales));
        }
    }
}

impl Search<'_> {
    /// Whether spans longer than a sub-window come first.
    fn divides_time(&self) -> bool {
        !self.limits.only_start && !self.has_few_windows()
    }

    /// The longest span that is begun at the root.
    pub(crate) fn longest_span(&self) -> f64 {
        if self.divides_time() { SPAN * self.scene.longest } else { self.scene.longest }
    }

    /// Searches a span that [`Search::window_from`] gave.
    pub(crate) fn search_span(&mut self, span: SubWindow) -> Step {
        let instructions = self.instructions;
        if self.divides_time() {
            run_on(instructions, DividedSpan { search: self, span })
        } else {
            run_on(instructions, OneWindow { search: self, window: span, pairs: None })
        }
    }

    #[inline(always)]
    fn search_divided<L: Lanes>(&mut self, span: SubWindow, waiting: &mut WaitingSpans) -> Step {
        let mut grid = Grid::new(self.scene, span);
        let root = expander(self.scene, grid.scales).root();
        let mut clear_until = span.start;
        waiting.spans.clear();
        waiting.pairs.clear();
        waiting.pairs.push(root);
        waiting.spans.push(WaitingSpan { from: 0, to: GRID, pairs: (0, 1) });
        while let Some(now) = waiting.spans.pop() {
            waiting.pairs.truncate(now.pairs.1);
            let (start, end) = (grid.time(now.from), grid.time(now.to));
            if end <= clear_until {
                continue;
            }
            if self.out_of_budget() || self.gives_up() {
                return Step::Answer(Outcome::OutOfBudget(start));
            }
            if self.is_sweep_due() {
                let PlacedFrame { frame, .. } =
                    grid.motion.far_frame::<L::Doubles>(start - grid.motion.start);
                let boxes = waiting.pairs[now.pairs.0].boxes;
                let until = self.sweep(&grid.motion, &frame, start, boxes);
                if let Some(until) = until.filter(|until| *until >= end) {
                    clear_until = until;
                    continue;
                }
            }
            self.keep_near_pairs::<L>(&now, &mut grid, waiting);
            let pairs = (now.pairs.1, waiting.pairs.len());
            if pairs.0 == pairs.1 {
                clear_until = end;
            } else if now.to - now.from == 2 {
                let left = Some(&waiting.pairs[pairs.0..]);
                let window = SubWindow { start, end };
                match run_on(self.instructions, OneWindow { search: self, window, pairs: left }) {
                    Step::ClearUntil(until) => clear_until = until,
                    answer @ Step::Answer(_) => return answer,
                }
            } else {
                let middle = usize::midpoint(now.from, now.to);
                waiting.spans.push(WaitingSpan { from: middle, pairs, ..now });
                waiting.spans.push(WaitingSpan { to: middle, pairs, ..now });
            }
        }
        Step::ClearUntil(clear_until)
    }

    /// Appends the pairs of boxes of a span that are not proven apart over it.
    #[inline(always)]
    fn keep_near_pairs<L: Lanes>(&mut self, span: &WaitingSpan, grid: &mut Grid, waiting: &mut WaitingSpans) {
        let scene = self.scene;
        let length = (grid.time(span.to) - grid.time(span.from)).next_up();
        let WaitingSpans { pairs, to_expand, .. } = waiting;
        let expander = expander(scene, grid.scales);
        let large = LeastRadii::new(scene, length * (scene.spin_speed + scene.closing_speed()));
        to_expand.clear();
        for index in span.pairs.0..span.pairs.1 {
            let item = pairs[index];
            if large.are_reached(&item) { to_expand.push(item) } else { pairs.push(item) }
        }
        if to_expand.is_empty() {
            return;
        }
        let middle = usize::midpoint(span.from, span.to);
        for index in [span.from, middle, span.to] {
            grid.fill::<L>(index);
        }
        let [Some(start), Some(middle), Some(end)] = [span.from, middle, span.to].map(|k| &grid.poses[k])
        else {
            pairs.append(to_expand);
            return;
        };
        let bend = scene.pair.acceleration * (0.125 * length * length) + scene.far_frame_error();
        let frames = [
            SpanFrame::<L>::new([&start[0], &middle[0], &end[0]], &grid.scales[0], bend),
            SpanFrame::<L>::new([&start[1], &middle[1], &end[1]], &grid.scales[1], bend),
        ];
        let (most, given) = (pairs.len() + MOST_PAIRS_OF_SPAN, to_expand.len());
        let halved = span.to - span.from > 2;
        let most_tests = if halved { usize::MAX } else { given / 2 + LAST_TESTS };
        // First in, first out: what is next is known while a test is under way, and no length of a list is guessed.
        let (mut tests, mut next) = (0, 0);
        while let Some(&item) = to_expand.get(next) {
            next += 1;
            if let Some(ahead) = to_expand.get(next).filter(|item| item.next & Item::TRIANGLES == 0) {
                L::prefetch(&expander.nodes[ahead.side()][ahead.node() as usize]);
            }
            let few = tests < most_tests && pairs.len() + to_expand.len() - next < most;
            // Those that were given are known to be large.
            let is_large = next <= given || large.are_reached(&item);
            if item.next & Item::TRIANGLES != 0 || !few || !is_large {
                pairs.push(item);
                continue;
            }
            let mut rows = [[0; 4]; WIDTH];
            let expanded = expander.expand_over_span::<L>(&item, &frames);
            #[cfg(feature = "audit")]
            scene.conclude_span([grid.time(span.from), grid.time(span.to)], &expander, &item, &expanded);
            let count = L::pack(&expanded, &mut rows);
            let end = to_expand.len() + count;
            to_expand.extend_from_slice(&rows.map(Item::from_row));
            to_expand.truncate(end);
            tests += 1;
        }
        let (tests, queued) = (tests as u64, (to_expand.len() - given) as u64);
        let counts = &mut self.scratch.counts;
        (counts.node_tests, counts.queued) = (counts.node_tests + tests, counts.queued + queued);
        counts.frames += 1;
    }
}
