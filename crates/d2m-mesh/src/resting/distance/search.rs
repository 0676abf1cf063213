//! Best first over pairs of boxes, for the closest pair of triangles.

use super::best::{Best, EXPECTED_WIDTH};
use super::hulls::{Hulls, Measure, Parting};
use super::queue::{Item, Queue};
use crate::margin::{UNIT_F64, round_up};
use crate::meter::{Exhausted, Meter};
use crate::resting::node_pair::{Direction, Directions, RestingScene, Step, Wanted, child, gap_exceeds};
use d2m_feature::triangle_distance;
use d2m_lanes::{Lanes, Task};

/// Node tests and comparisons after which the pairs that wait are a crowd: several times as many as in ordinary queries of
/// a million triangles. They are examined again after twice as many.
const CROWD: u64 = 1 << 13;
/// In place of the version of a pair's direction: a plane of its own was tried.
const PARTED: u32 = u32::MAX;

/// What a search finds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Found {
    Pair(Best),
    /// Every pair is proven to be further apart than the limit less the expected width.
    Beyond,
    /// The enclosure of a pair straddles the limit: without a limit there is an answer.
    Unclear,
    /// The meter ran out, or the pair is near enough: the closest pair so far, with a lower bound over all.
    Exhausted(Best),
}

/// Best first over pairs of boxes.
///
/// The answer is the pair of triangles with the least (computed upper bound, numbers). A pair is left out only when it
/// is proven that its computed bound is more than the best one so far; so neither the order of the search nor the pair
/// that is compared first has any influence on the answer. Two exceptions: where triangles cross, their bound is zero, the search
/// ends with the first such pair, and another, in a fixed order, chooses the one that is reported; and when a search becomes very
/// long, pairs that a plane proves no closer up to rounding are dropped, so which of many equally close pairs is reported may
/// depend on the search ([`super::hulls`]).
pub(super) struct Search<'a> {
    pub(super) scene: &'a RestingScene<'a>,
    /// A pair of triangles to compare first.
    pub(super) first: Option<[u32; 2]>,
    /// Pairs beyond this are of no interest, working units.
    pub(super) limit: f64,
    /// The search also ends when no pair can be closer than the best one by more than this part of its distance: zero where the
    /// closest pair is wanted.
    pub(super) slack: f64,
    pub(super) meter: &'a mut Meter,
}

impl Task for Search<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Found {
        let Self { scene, first, limit, slack, meter } = self;
        let mut state = State::new(scene, limit, first);
        loop {
            if state.next.is_none() && state.steps >= state.patience {
                state.thin_out(meter);
            }
            let Some(item) = state.next.take().or_else(|| state.queue.pop()) else { break };
            if item.key > state.closest.upper_key || state.closest.upper == 0.0 {
                break;
            }
            let is_over = meter.step().is_err();
            if is_over || slack > 0.0 && state.is_near_enough(&item, slack) {
                // Where a meter has an end, a pair of triangles is compared before the search, so that there is a best one.
                let Some(best) = state.closest.best else { return Found::Unclear };
                return Found::Exhausted(state.closest.finished(best, f64::from(state.least_key(&item))));
            }
            state.steps += 1;
            if state.waits(&item) {
                continue;
            }
            match scene.step(item.pair) {
                Step::Expand { wide, node } => {
                    if !state.is_parted(&item, meter) {
                        state.expand::<L>(&item, wide, node);
                    }
                }
                Step::Compare(triangles) => {
                    // On as long as it pays: each closer pair has a better direction for all that follow.
                    state.descending = state.closest.compare(triangles);
                }
            }
        }
        match state.closest.best {
            Some(best) => Found::Pair(state.closest.finished(best, f64::INFINITY)),
            None if state.closest.loose <= limit => Found::Unclear,
            None => Found::Beyond,
        }
    }
}

/// A search on its way.
struct State<'a> {
    closest: Closest<'a>,
    queue: Queue,
    /// The pair that comes before all that wait: the least child of the one before, while the search descends.
    next: Option<Item>,
    /// Does it descend greedily? To a pair of triangles, as long as that is closer than the one before; then best first.
    descending: bool,
    steps: u64,
    /// After so many steps the pairs that wait are examined.
    patience: u64,
    /// Hulls of nodes, once the pairs are a crowd that planes may part.
    hulls: Option<Hulls>,
}

impl<'a> State<'a> {
    fn new(scene: &'a RestingScene<'a>, limit: f64, first: Option<[u32; 2]>) -> Self {
        let mut closest = Closest::new(scene, limit);
        if let Some(triangles) = first {
            closest.compare(triangles);
        }
        Self {
            descending: closest.best.is_none(),
            closest,
            queue: Queue::default(),
            next: Some(Item { key: 0.0, pair: [0; 2], version: 0 }),
            steps: 0,
            patience: CROWD,
            hulls: None,
        }
    }

    /// No pair is closer than this: neither the one that comes next nor those that wait.
    fn least_key(&self, next: &Item) -> f32 {
        self.queue.least_key().map_or(next.key, |other| other.min(next.key))
    }

    /// Is no pair closer than the best one by more than this part?
    fn is_near_enough(&self, next: &Item, slack: f64) -> bool {
        self.closest.best.is_some() && f64::from(self.least_key(next)) >= self.closest.upper * (1.0 - slack)
    }

    /// Examines a crowd of pairs that wait: drops them where they cannot change what is proven, or begins again with planes
    /// that may part nodes high up.
    fn thin_out(&mut self, meter: &mut Meter) {
        self.patience = 2 * self.steps;
        match (&self.closest.best, self.queue.least_key()) {
            // No lower bound above zero is proven, whatever the other pairs are. How the bodies meet is found out elsewhere.
            (Some(best), _) if best.distance.upper <= EXPECTED_WIDTH => self.queue.clear(),
            (Some(_), Some(least))
                if self.hulls.is_none() && Hulls::pay_off(self.closest.scene, self.steps) =>
            {
                self.hulls = Hulls::new(self.closest.scene, meter).ok();
                if self.hulls.is_some() {
                    self.queue.clear();
                    self.queue.push(Item { key: least, pair: [0; 2], version: self.closest.version });
                }
            }
            _ => {}
        }
    }

    /// True if the bound along the newest direction, which is cheap and often much better than the one that was known, leaves the
    /// pair out or sends it back to the queue.
    #[inline(always)]
    fn waits(&mut self, &Item { key, pair, version }: &Item) -> bool {
        if version == self.closest.version || version == PARTED {
            return false;
        }
        let bound = self.closest.scene.bound_along(pair, &self.closest.along);
        if bound > self.closest.upper_key {
            return true;
        }
        let is_better = bound > key;
        if is_better {
            self.queue.push(Item { key: bound, pair, version: self.closest.version });
        }
        is_better
    }

    /// True if a plane parts a pair of nodes further than was known: it is left out, or waits with the new bound.
    #[inline(always)]
    fn is_parted(&mut self, &Item { key, pair, version }: &Item, meter: &mut Meter) -> bool {
        let (Some(hulls), Some(best)) = (&mut self.hulls, &self.closest.best) else { return false };
        if version == PARTED {
            return false;
        }
        let best = Measure { upper: self.closest.upper, direction: best.distance.direction };
        match hulls.part(pair, best, self.steps, meter) {
            Ok(Parting::Beyond) => true,
            Ok(Parting::AtLeast(bound)) if bound > key => {
                self.queue.push(Item { key: bound, pair, version: PARTED });
                true
            }
            // The next step ends the search where the meter ran out.
            Ok(Parting::AtLeast(_)) | Err(Exhausted) => false,
        }
    }

    /// Replaces one node of a pair by its children.
    #[inline(always)]
    fn expand<L: Lanes>(&mut self, &Item { key, pair, .. }: &Item, wide: usize, node: u32) {
        let wanted = Wanted {
            along: &self.closest.along,
            enough: self.closest.upper_key,
            directions: if self.hulls.is_some() { Directions::OfEdges } else { Directions::Usual },
        };
        let bounds = self.closest.scene.bounds::<L>((wide, node), pair[1 - wide], &wanted);
        let mut least: Option<Item> = None;
        for (lane, &bound) in bounds.used().iter().enumerate() {
            // Also when the bound is not a number.
            let bound = if bound > key { bound } else { key };
            if bound > self.closest.upper_key {
                continue;
            }
            let pair = child(pair, wide, node, lane);
            let found = Item { key: bound, pair, version: self.closest.version };
            match &mut least {
                Some(so_far) if self.descending => {
                    let (keep, push) =
                        if found.key < so_far.key { (found, *so_far) } else { (*so_far, found) };
                    *so_far = keep;
                    self.queue.push(push);
                }
                _ if self.descending => least = Some(found),
                _ => self.queue.push(found),
            }
        }
        self.next = least;
    }
}

/// The best pair so far.
struct Closest<'a> {
    scene: &'a RestingScene<'a>,
    best: Option<Best>,
    /// Upper bound of the best pair, or the limit.
    upper: f64,
    /// Rounded up: pairs of boxes at more than this are left out.
    upper_key: f32,
    /// Least lower bound of a pair whose enclosure was wider than expected.
    loose: f64,
    /// The best pair's own direction; before there is one, from center to center.
    along: Direction,
    /// How often that direction has changed.
    version: u32,
}

impl<'a> Closest<'a> {
    fn new(scene: &'a RestingScene<'a>, limit: f64) -> Self {
        Self {
            scene,
            best: None,
            upper: limit,
            upper_key: round_up(limit),
            loose: f64::INFINITY,
            along: scene.direction(-scene.pose.offset),
            version: 0,
        }
    }

    /// True if the pair is closer than all so far.
    #[inline(always)]
    fn compare(&mut self, triangles: [u32; 2]) -> bool {
        let (a, b) = (self.scene.place(0, triangles[0]), self.scene.place(1, triangles[1]));
        if let Some(best) = &self.best {
            // Along the best pair's own direction: most of its neighbours are left out by this.
            if gap_exceeds(best.distance.direction, &a, &b, self.upper + self.scene.projection) {
                return false;
            }
        }
        let distance = triangle_distance(&a, &b);
        if distance.upper - distance.lower > EXPECTED_WIDTH {
            self.loose = self.loose.min(distance.lower);
        }
        let better = match &self.best {
            _ if distance.upper > self.upper => false,
            None => true,
            Some(best) => (distance.upper, triangles) < (best.distance.upper, best.triangles),
        };
        if better {
            self.best = Some(Best { distance, triangles, lower: 0.0 });
            self.upper = distance.upper;
            self.upper_key = round_up(distance.upper);
            if distance.lower > 0.0 {
                self.along = self.scene.direction(distance.direction);
                self.version = self.version.wrapping_add(1);
            }
        }
        better
    }

    /// The best pair with a lower bound over all, when every other pair is at least `waiting` apart.
    fn finished(&self, best: Best, waiting: f64) -> Best {
        let lower = (best.distance.upper - EXPECTED_WIDTH).min(self.loose).min(waiting).max(0.0);
        Best { lower: lower * (1.0 - 2.0 * UNIT_F64), ..best }
    }
}
