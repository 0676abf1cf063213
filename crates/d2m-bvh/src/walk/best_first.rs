//! Best first inside one sub-window.

use super::effort::{self, BATCH, MEMORY_CHECK, ON_ITS_WAY, Passing};
use super::expansion::{KEY_SCALE, NodePairExpander};
use super::parting::Parting;
use super::queue::{Bucket, Item};
use super::state::{Outcome, Search, State, Step, SubWindow, triangle_count};
use crate::Budget;
use crate::gap::widest_gap::widest_normal;
use crate::pair::boxes::node_scale::NodeScale;
use crate::pair::boxes::node_test::{Expanded, NodeFrame};
use crate::pair::motion::frame::{Frame, RelativeMotion};
use crate::pair::motion::units::sum_down;
use crate::pair::scene::MovingScene;
use crate::pair::triangles::separating_axis::{BackwardCertificate, place_a};
use crate::pair::witness::Witness;
use crate::skip::SkipLimits;
use crate::skip::screw_search::screw_clear_until;
use crate::skip::swept_volume::swept_clear_until;
use crate::walk::crowd::{Patience, Progress};
use d2m_lanes::{F64x4, Lanes, Task, power_of_two_above};
#[cfg(feature = "audit")]
use d2m_mesh::audit::Place;
use d2m_mesh::margin::NARROW_UP;
use d2m_mesh::node::{Below, LEAST_SIZE, WIDTH, WideNode};
use glam::DVec3;

/// Least unit of time of a window, for those of no length: nothing moves by more than a rounding in it.
const LEAST_SPAN: f64 = 1.0 / 1_152_921_504_606_846_976.0; // 2⁻⁶⁰

/// The search of one sub-window, from these pairs of boxes on, whose keys are zero: all that may meet in it are below
/// them. None: from the roots.
///
/// It is compiled once for each instruction set, whoever calls it: with two copies in one function ordinary queries took one
/// per cent longer.
pub(crate) struct OneWindow<'a, 's> {
    pub(crate) search: &'a mut Search<'s>,
    pub(crate) window: SubWindow,
    pub(crate) pairs: Option<&'a [Item]>,
}

impl Task for OneWindow<'_, '_> {
    type Output = Step;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Step {
        self.search.search_window::<L>(self.window, self.pairs)
    }
}

impl<'s> Search<'s> {
    #[inline(always)]
    fn search_window<L: Lanes>(&mut self, window: SubWindow, pairs: Option<&[Item]>) -> Step {
        let mut state = self.begin_window(window);
        self.scratch.counts.windows += 1;
        self.scratch.queue.clear();
        match pairs {
            Some(pairs) => self.scratch.queue.extend(pairs.iter().copied()),
            None => self.scratch.queue.push(state.expander.root()),
        }
        let mut batch = core::mem::replace(&mut self.scratch.batch, Bucket::EMPTY);
        let (mut outcome, mut batches) = (None, 0u32);
        let parting = self
            .limits
            .parting
            .map(|triangles| Parting::new::<L>(self.scene, &state, &Witness::new(self.scene, triangles)));
        let parting =
            parting.as_ref().map(|parting| parting.over_span::<L>(self.scene, &state.expander.scales));
        let mut patience = Patience::new(self.scratch.counts.triangle_looks, self.limits.patience);
        while let Some(least) = self.scratch.queue.take(&mut batch, BATCH) {
            if least >= state.limit {
                break;
            }
            batches += 1;
            let progress = Progress { least, batches };
            outcome = self.interruption(&state, window, progress, &batch);
            if outcome.is_some() {
                break;
            }
            self.scratch.counts.frames += 1;
            if batches == 1 || least > effort::fresh_until(state.frame_key) {
                state.renew_frames::<L>(least, effort::boxes_may_pass(batches));
            }
            if patience.is_due(batches, self.scratch.counts.triangle_looks) {
                self.thin_out::<L>(&mut state, progress, &mut batch, &mut patience);
            }
            self.expand_batch::<L>(&mut state, batch.items(), parting.as_ref());
        }
        self.scratch.batch = batch;
        outcome.unwrap_or(match state.found {
            Some(found) if found.offset <= length_of(window) => {
                self.scratch.found_in = Some(state.motion);
                Step::Answer(Outcome::Found(found))
            }
            _ => Step::ClearUntil(window.end),
        })
    }

    /// The state of a sub-window of which nothing is searched yet.
    #[inline(always)]
    pub(crate) fn begin_window(&mut self, window: SubWindow) -> State<'s> {
        let scene = self.scene;
        let length = length_of(window);
        let time_unit = power_of_two_above(length.max(LEAST_SPAN));
        let step = time_unit / KEY_SCALE;
        let scales = match self.scales {
            Some((unit, scales)) if unit == time_unit => scales,
            _ => scene.node_scales(time_unit),
        };
        self.scales = Some((time_unit, scales));
        State {
            motion: scene.relative_motion(window.start),
            node_frames: Default::default(),
            expander: expander(scene, scales),
            step,
            limit: (length / step).ceil() as u32 + 1,
            // A tick more, so that the end itself is inside; what is found after the end does not count.
            limit_offset: length + step,
            frame: Frame::default(),
            frame_key: 0,
            found: None,
            behind: BackwardCertificate::default(),
        }
    }

    /// What ends the search of a sub-window before its queue is empty, if anything does: nothing live is before `least`.
    #[inline(always)]
    fn interruption(
        &mut self,
        state: &State<'_>,
        SubWindow { start, end }: SubWindow,
        Progress { least, batches }: Progress,
        batch: &Bucket,
    ) -> Option<Step> {
        if self.limits.only_start && least > 0 {
            return Some(Step::Answer(Outcome::Separated));
        }
        let now = || sum_down(start, f64::from(least) * state.step);
        let is_full = batches % MEMORY_CHECK == 0 && self.scratch.queue.len() > Budget::HARD_QUEUED_PAIRS;
        if is_full || self.out_of_budget() {
            return Some(Step::Answer(Outcome::OutOfBudget(now())));
        }
        if self.gives_up() {
            return Some(Step::Answer(Outcome::OutOfBudget(start)));
        }
        if !self.is_sweep_due() {
            return None;
        }
        let until = self.sweep(&state.motion, &state.frame, now(), batch.items()[0].boxes)?;
        (until >= end || self.has_few_windows()).then_some(Step::ClearUntil(until))
    }

    /// An offset up to which the swept volumes of the bodies are apart from `now` on; none if they are not for long. `boxes`:
    /// a pair that may be near.
    #[cold]
    #[inline(never)]
    pub(crate) fn sweep(
        &mut self,
        motion: &RelativeMotion,
        frame: &Frame,
        now: f64,
        boxes: [u32; 2],
    ) -> Option<f64> {
        let patient = effort::first_sweep_on_its_way(triangle_count(self.scene), self.limits.patience);
        if self.work() < patient && now > ON_ITS_WAY * self.scene.end {
            self.limits.sweep_from = patient;
            return None;
        }
        if self.scratch.counts.triangle_looks == 0 {
            self.scratch.last_tested = [
                first_triangle(self.scene.a.tree.nodes(), boxes[0]),
                first_triangle(self.scene.b.tree.nodes(), boxes[1]),
            ];
        }
        let [a, b] = self.scratch.last_tested;
        let b = self.scene.b.corners(b);
        let near = widest_normal(&place_a::<F64x4>(frame, &self.scene.a.corners(a)), &b);
        let turn = motion.rotation_b(frame.offset);
        let direction = turn.transform(near).normalize_or(DVec3::X);
        let limits = SkipLimits {
            least_gain: self.scene.longest.min(self.scene.end - now),
            most_work: effort::most_swept(self.work()),
            most_a_triangle: 0,
            most_before: effort::swept_before(triangle_count(self.scene)),
            budget: self.limits.most_tests.saturating_sub(self.work()),
            stop: self.limits.stop,
            witnesses: self.scratch.last_tested,
        };
        let mut skip = swept_clear_until(self.scene, now, &limits, direction);
        #[cfg(feature = "audit")]
        self.scene.conclude_whole(Place::Sweep, now, skip.clear_until);
        if skip.clear_until.is_none() {
            let swept = skip.work;
            let part = if self.has_few_windows() { effort::LEAST_PART_OF_A_WINDOW } else { 1.0 };
            let limits = SkipLimits {
                least_gain: part * limits.least_gain,
                most_work: effort::most_screw_pairs(self.work()),
                most_a_triangle: effort::SCREW_PAIRS_A_TRIANGLE,
                budget: limits.budget.saturating_sub(swept),
                ..limits
            };
            skip = screw_clear_until(self.scene, now, &limits);
            #[cfg(feature = "audit")]
            self.scene.conclude_whole(Place::Screw, now, skip.clear_until);
            skip.work += swept;
        }
        self.scratch.counts.sweeps += 1;
        self.scratch.counts.swept_pairs += skip.work;
        let work = self.work();
        let due = self.limits.sweep_from;
        self.limits.sweep_from = match skip.clear_until {
            Some(_) => effort::sweep_after_success(work, due),
            None => effort::sweep_after_failure(work),
        };
        skip.clear_until
    }
}

/// A triangle in a box.
fn first_triangle(nodes: &[WideNode], index: u32) -> u32 {
    match nodes[index as usize / WIDTH].below(index as usize % WIDTH) {
        Below::Triangle(triangle) => triangle,
        Below::Node(node) => first_triangle(nodes, node * WIDTH as u32),
    }
}

/// At least the length of the sub-window, whatever its rounding.
fn length_of(SubWindow { start, end }: SubWindow) -> f64 {
    (end - start).next_up()
}

impl State<'_> {
    /// The frame at a key, and those of the node tests from there on.
    #[inline(always)]
    fn renew_frames<L: Lanes>(&mut self, key: u32, passing: Passing) {
        self.frame = self.motion.frame::<L::Doubles>(f64::from(key) * self.step);
        let left = time_left(self.limit, key);
        self.node_frames = [
            NodeFrame::new::<L::Doubles>(&self.frame, &self.expander.scales[0], Expanded::A, left),
            NodeFrame::new::<L::Doubles>(&self.frame, &self.expander.scales[1], Expanded::B, left),
        ];
        self.frame_key = key;
        if passing == Passing::Tested {
            for frame in &mut self.node_frames {
                frame.passing = Some(left);
            }
        }
    }
}

/// Units of the sub-window from key `now` to key `limit`, rounded up.
fn time_left(limit: u32, now: u32) -> f32 {
    (limit - now) as f32 * (1.0 / KEY_SCALE as f32) * NARROW_UP as f32
}

/// The expander of pairs of boxes of two trees.
pub(crate) fn expander<'a>(scene: &MovingScene<'a>, scales: [NodeScale; 2]) -> NodePairExpander<'a> {
    let ratio = cube(scales[1].ratio).clamp(LEAST_SIZE.into(), 1.0 / f64::from(LEAST_SIZE)) as f32;
    NodePairExpander {
        nodes: [scene.a.tree.nodes(), scene.b.tree.nodes()],
        scales,
        size_ratios: [ratio, 1.0],
    }
}

fn cube(x: f64) -> f64 {
    x * x * x
}
