//! A crowd, very many node pairs that may meet at the same time: one plane that separates all of them.
//!
//! Where n triangles of one body and m of the other come together at a point – two fans, stars, copies of one face –
//! all n·m pairs have the same time of impact, and best first has to test each. So when many pairs wait, one of them is
//! advanced to its contact, out of turn; then all vertices below the pairs that wait are taken, and a direction is sought
//! along which all of A's are below all of B's from the time proven so far until that contact. Along a fixed direction n a
//! point moves at a constant rate, and accelerations take at most |n × ω||ω × e| s²/2 from that, e from the axis of its
//! spin: tips near the axis hardly bend. So the gap of the two sets is at least a concave function of time: positive at both
//! ends, it is positive between. One such plane proves all pairs apart. If there is none, the directions that were tried first
//! still part many pairs one by one. Where most stay, planes for a part of the time, one after the other, advance all pairs
//! together, since s²/2 is little for small s. Without a contact the same is tried until the end of the window.
//!
//! See docs/theory/engine.md, "Crowds".

mod group;
mod moving;
mod paths;
mod places;
mod reaches;
mod sampled;
#[cfg(test)]
mod tests;

use crate::pair::motion::frame::Frame;
use crate::walk::effort::{
    CROWD, CROWD_CHECK, CROWD_CHECK_TESTS, CROWD_OF_BATCHES, MOST_HALVINGS, MOST_PLANES, WORK_A_PAIR,
};
use crate::walk::pairs::Turn;
use crate::walk::queue::{Bucket, Item};
use crate::walk::state::{Search, State};
use d2m_lanes::Lanes;
use d2m_mesh::Meter;
#[cfg(feature = "audit")]
use d2m_mesh::audit::{Part, Place};
use d2m_mesh::node::WIDTH;
use glam::DVec3;
use group::{Group, Vertices};
use moving::{Moving, PlaneSearch, Separation};
use paths::Side;
use reaches::Reaches;

/// Most vertices of each body that are gathered, for each node test that the search has done: one is placed in about the time of
/// such a test, so gathering too many takes no more than the search itself did.
const VERTICES_A_TEST_DONE: u64 = 1;
/// Most vertices that are compared for one plane, all directions together: less than a millisecond of work.
const MOST_COMPARED: u64 = 1 << 18;
/// Directions that are tried for one plane, from each of the two that it begins with: at least, and at most.
const LEAST_DIRECTIONS: u64 = 8;
const MOST_DIRECTIONS: u64 = 32;
/// Vertices that are compared along one direction in the time of one node test.
const VERTICES_A_TEST: u64 = 16;

/// How far the search of a sub-window has come.
#[derive(Clone, Copy, Debug)]
pub(super) struct Progress {
    /// No live key is below this one.
    pub(super) least: u32,
    /// Batches that were handed out.
    pub(super) batches: u32,
}

/// What planes for a part of the time did.
#[derive(Clone, Copy, Debug)]
enum Planes {
    Part,
    PartNothing,
}

/// When a search examines its crowd next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patience {
    pairs: usize,
    batches: u32,
    /// Not before so much work of the search, whatever waits: it does as much between as this takes.
    rest_until: u64,
    /// The limit of the keys when the crowd was examined.
    examined_to: Option<u32>,
    /// When pairs are counted next: then, or after so many tests of triangle pairs.
    next_count: u32,
    next_tests: u64,
}

impl Patience {
    /// Of a sub-window that begins after so many tests of triangle pairs, so many times as long as usual.
    pub(super) const fn new(tests: u64, factor: u64) -> Self {
        Self {
            pairs: CROWD * factor as usize,
            batches: CROWD_OF_BATCHES * factor as u32,
            rest_until: 0,
            examined_to: None,
            next_count: CROWD_CHECK,
            next_tests: tests + CROWD_CHECK_TESTS,
        }
    }

    /// Sets when the next planes are tried after those that were begun at so much work: once the search has done as much as they took, and
    /// where they proved nothing, as much as all so far.
    fn rest_after(&mut self, search: &Search<'_>, before: u64, planes: Planes) {
        let work = search.work();
        self.rest_until = match planes {
            Planes::Part => work + (work - before),
            Planes::PartNothing => 2 * work,
        };
    }

    /// Are the pairs that wait to be counted now?
    #[inline(always)]
    pub(super) const fn is_due(&self, batches: u32, tests: u64) -> bool {
        batches >= self.next_count || tests >= self.next_tests
    }
}

/// The vertices below the pairs that wait, and what a plane between them has to leave.
struct Crowd {
    /// Of A and of B.
    vertices: [Vertices; 2],
    /// That of the search: pairs that a plane parts are as clear as those that are followed one by one, so that no answer
    /// depends on which of the two it was, and caches may rely on it.
    level: f64,
    /// Directions that are tried for a plane.
    directions: u64,
}

impl Crowd {
    const fn points(&self) -> [&Vec<DVec3>; 2] {
        let [a, b] = &self.vertices;
        [&a.points, &b.points]
    }

    /// What the comparison along so many directions costs, in node tests.
    fn cost(&self, directions: u64) -> u64 {
        let vertices = self.vertices.iter().map(|of| of.points.len()).sum::<usize>() as u64;
        (vertices * directions).div_ceil(VERTICES_A_TEST)
    }
}

/// The frame from which planes are sought for all that is left after a time: that of the contact, backwards, if one is known; and how long
/// that is.
fn rest_of_window<L: Lanes>(state: &State<'_>, known: f64) -> (Frame, f64) {
    let frame = match state.found {
        Some(_) => state.behind.reversed,
        None => state.motion.frame::<L::Doubles>(known),
    };
    (frame, (state.limit_offset - known).next_up())
}

impl Search<'_> {
    /// Drops the pairs that are proven apart, of those that wait and of the batch, until the contact that is known, or
    /// until the end of the window, or raises all their keys. Searches for an earlier
    /// contact first.
    #[cold]
    #[inline(never)]
    pub(super) fn thin_out<L: Lanes>(
        &mut self,
        state: &mut State<'_>,
        Progress { least, batches }: Progress,
        batch: &mut Bucket,
        patience: &mut Patience,
    ) {
        patience.next_count = batches.saturating_add(CROWD_CHECK);
        patience.next_tests = self.scratch.counts.triangle_looks + CROWD_CHECK_TESTS;
        let waiting = self.scratch.queue.len();
        let crowded = waiting >= patience.pairs || batches >= patience.batches;
        // An earlier contact may be the one that a plane reaches to.
        let nearer = (waiting >= CROWD || batches >= CROWD_OF_BATCHES)
            && patience.examined_to.is_some_and(|limit| state.limit < limit);
        if !(crowded || nearer) || self.work() < patience.rest_until {
            return;
        }
        let before = *patience;
        patience.pairs = if waiting >= patience.pairs { 2 * waiting } else { patience.pairs };
        patience.batches = if batches >= patience.batches { 2 * batches } else { patience.batches };
        let known = f64::from(least) * state.step;
        // Also when a contact is known: it may be that of a pair that meets much later.
        self.dive::<L>(state, batch.items()[0]);
        // Nothing that waits can be earlier than what was found, or matters any more.
        if least >= state.limit {
            return;
        }
        let mut clock = Meter::until(self.limits.stop);
        let before_planes = self.work();
        if !self.planes_may_part::<L>(state, least, batch.items(), &mut clock) {
            patience.rest_after(self, before_planes, Planes::PartNothing);
            patience.examined_to = Some(state.limit);
            return;
        }
        let Some(crowd) = self.crowd(state, batch.items(), &mut clock) else { return };
        let (frame, span) = rest_of_window::<L>(state, known);
        let Some(moving) = Moving::new(self.scene, crowd.points(), &frame, span, &mut clock) else { return };
        let starts = [state.behind.direction, moving.between()].map(DVec3::normalize_or_zero);
        let mut tried = starts.to_vec();
        for first in starts {
            match self.separation(&moving, (first, crowd.level), &crowd, &mut clock) {
                Separation::Proven { .. } => {
                    #[cfg(feature = "audit")]
                    self.conclude_crowd(state.span([known, state.limit_offset]), batch, state.limit);
                    self.scratch.queue.clear();
                    batch.retain(|_| false);
                    return;
                }
                Separation::Unknown { last } => tried.push(last),
            }
        }
        for n in tried.into_iter().filter(|&n| n != DVec3::ZERO) {
            let [of_a, of_b] = &crowd.vertices;
            let mut a = Reaches::new(&self.scene.a, &of_a.places, moving.reaches(Side::A, n));
            let mut b = Reaches::new(&self.scene.b, &of_b.places, moving.reaches(Side::B, n));
            let items = self.scratch.queue.items().chain(batch.items());
            // Later ones do not matter, and their vertices were not gathered.
            for item in items.filter(|item| item.key < state.limit) {
                if clock.step().is_err() {
                    return;
                }
                let measured = a.measure(item.boxes[0], &mut clock).zip(b.measure(item.boxes[1], &mut clock));
                if measured.is_none() {
                    return;
                }
            }
            let need = crowd.level * n.length();
            // When the time is over, what is left stays.
            let mut over = false;
            #[cfg(feature = "audit")]
            let (scene, pair_span) = (self.scene, state.span([known, state.limit_offset]));
            let mut meet = |item: &Item| {
                over = over || clock.step().is_err();
                if over {
                    return true;
                }
                let reaches = a.of(item.boxes[0]).zip(b.of(item.boxes[1]));
                // Also when something is not a number.
                let meets =
                    !reaches.is_some_and(|(high, low)| (0..2).all(|end| -low[end] - high[end] > need));
                #[cfg(feature = "audit")]
                if !meets {
                    let parts = [Part::Boxes(&item.boxes[..1]), Part::Boxes(&item.boxes[1..])];
                    scene.conclude(Place::Crowd, pair_span, parts);
                }
                meets
            };
            self.scratch.queue.retain(&mut meet);
            batch.retain(meet);
            if over {
                return;
            }
        }
        // Where most pairs are done with that way, the rest is no crowd.
        if self.scratch.queue.len() + batch.items().len() < waiting / 2 {
            return;
        }
        let before_planes = self.work();
        let most_work = WORK_A_PAIR * waiting.max(CROWD) as u64;
        let key = self.advance_together::<L>(state, least, (&crowd, most_work), &mut clock);
        let planes = if key > least { Planes::Part } else { Planes::PartNothing };
        #[cfg(feature = "audit")]
        if key > least {
            self.conclude_crowd(state.span([known, f64::from(key) * state.step]), batch, state.limit);
        }
        patience.rest_after(self, before_planes, planes);
        patience.examined_to = Some(state.limit);
        if key > least {
            // The next step of the crowd comes as soon as this one did.
            patience.pairs = before.pairs;
            patience.batches = before.batches.max(batches.saturating_add(CROWD_CHECK));
            let queue = &mut self.scratch.queue;
            let mut later = Vec::with_capacity(queue.len() + batch.items().len());
            for item in queue.items().chain(batch.items()) {
                // When the time is over, all keep their keys, which are right.
                if clock.step().is_err() {
                    return;
                }
                later.push(Item { key: item.key.max(key), ..*item });
            }
            queue.clear();
            queue.extend(later);
            batch.retain(|_| false);
        }
    }

    /// The key until which planes part the crowd from `least` on, one after the other, each for a part of the time that is
    /// left, for at most so much work.
    fn advance_together<L: Lanes>(
        &mut self,
        state: &State<'_>,
        least: u32,
        (crowd, most_work): (&Crowd, u64),
        clock: &mut Meter,
    ) -> u32 {
        let enough = self.work() + most_work;
        let Some(most_halvings) = state.limit.saturating_sub(least).checked_ilog2() else { return least };
        // A plane that parts all for a time parts them for each shorter one: the shortest comes first, so that one attempt is all that is
        // lost where there is none.
        let (mut key, mut halvings) = (least, most_halvings.min(MOST_HALVINGS));
        let mut newest = state.behind.direction.normalize_or_zero();
        for _ in 0..MOST_PLANES {
            let ticks = state.limit.saturating_sub(key) >> halvings;
            if ticks == 0 || halvings > MOST_HALVINGS || self.work() >= enough || self.out_of_budget() {
                break;
            }
            let frame = state.motion.frame::<L::Doubles>(f64::from(key) * state.step);
            // Exact: a number of 30 bits times a power of two.
            let span = f64::from(ticks) * state.step;
            let Some(moving) = Moving::new(self.scene, crowd.points(), &frame, span, clock) else { break };
            let mut parted = false;
            for first in [newest, moving.between().normalize_or_zero()] {
                let separation = self.separation(&moving, (first, crowd.level), crowd, clock);
                if let Separation::Proven { along } = separation {
                    (parted, newest) = (true, along);
                    break;
                }
            }
            if parted {
                halvings = if key == least { 1 } else { u32::max(halvings, 2) - 1 };
                key += ticks;
            } else {
                halvings += 1;
            }
        }
        key
    }

    /// Searches for a plane that leaves a level, from a direction on, along as many directions as the budget still allows.
    fn separation(
        &mut self,
        moving: &Moving<'_>,
        (first, level): (DVec3, f64),
        crowd: &Crowd,
        clock: &mut Meter,
    ) -> Separation {
        let left = self.limits.most_tests.saturating_sub(self.work());
        let most = crowd.directions.min(left / crowd.cost(1).max(1));
        let attempt = moving.separation(&PlaneSearch { first, level, most }, clock);
        self.scratch.counts.swept_pairs += crowd.cost(attempt.directions);
        attempt.separation
    }

    /// Follows a pair of triangles below an item to its contact, if it has one.
    fn dive<L: Lanes>(&mut self, state: &mut State<'_>, mut item: Item) {
        while item.next & Item::TRIANGLES == 0 {
            self.scratch.counts.node_tests += 1;
            let expanded = state.expander.expand::<L>(&item, &state.node_frames, state.keys());
            let mut list = [[0; 4]; WIDTH];
            let count = L::pack(&expanded, &mut list);
            match list[..count].iter().map(|row| Item::from_row(*row)).min_by_key(|next| next.key) {
                Some(next) => item = next,
                None => return,
            }
        }
        self.advance::<L>(state, item, Turn::Ahead);
    }

    /// The vertices below all pairs that wait; none if they are too many for what the search has done so far, or the time is over.
    fn crowd(&self, state: &State<'_>, batch: &[Item], clock: &mut Meter) -> Option<Crowd> {
        let most = (VERTICES_A_TEST_DONE * self.work()) as usize;
        let items = self.scratch.queue.items().chain(batch);
        self.gathered(items.filter(|item| item.key < state.limit), most, clock)
    }

    /// The vertices below pairs of boxes; none if they are more than so many of one body, or the time is over.
    fn gathered<'i>(
        &self,
        items: impl Iterator<Item = &'i Item>,
        most: usize,
        clock: &mut Meter,
    ) -> Option<Crowd> {
        let mut bodies = [&self.scene.a, &self.scene.b].map(Group::new);
        for item in items {
            for (body, &index) in bodies.iter_mut().zip(&item.boxes) {
                body.add(index, most, clock)?;
            }
        }
        let vertices = bodies.map(|body| body.vertices);
        if vertices.iter().any(|of| of.points.is_empty()) {
            return None;
        }
        let count = vertices.iter().map(|of| of.points.len()).sum::<usize>() as u64;
        let directions = (MOST_COMPARED / (2 * count).max(1)).clamp(LEAST_DIRECTIONS, MOST_DIRECTIONS);
        // Places and rates err by less than half of the error, and what is bent by less than the rest.
        let level = self.scene.pair.level + 2.0 * self.scene.pair.error;
        Some(Crowd { vertices, level, directions })
    }
}
