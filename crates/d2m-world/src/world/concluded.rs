//! What a world relies on of its pairs (feature `audit`).

use super::World;
use super::schedule::Schedule;
use crate::box_tree::IndexPair;
use d2m_bvh::audit::{Audited, Conclusion, Part, Place, Promise, is_heard, report};

impl World {
    /// The surfaces of a pair are further apart than its separation over a span.
    pub(super) fn conclude(&self, place: Place, pair: IndexPair, [from, to]: [f64; 2]) {
        let [Some(a), Some(b)] = pair.map(|index| self.slots.at(index)) else { return };
        let distance = self.filter.separation(pair, self.options.min_separation);
        let [a, b] = [a.moving(), b.moving()];
        let bodies =
            [Audited::new(a.body, a.motion, Part::Whole), Audited::new(b.body, b.motion, Part::Whole)];
        report(&Conclusion { place, bodies, from, to, distance, promise: Promise::Apart });
    }

    /// Pairs that are not in the queue are apart to the end of the span.
    pub(super) fn conclude_left_out(&self) {
        let Some(end) = self.schedule.end().filter(|_| is_heard()) else { return };
        let waiting = Schedule::pairs(&self.schedule);
        let places = self.slots.places() as u32;
        for pair in (0..places).flat_map(|a| (a + 1..places).map(move |b| [a, b])) {
            let is_left_out =
                waiting.binary_search(&pair).is_err() && !self.filter.ignores(pair, self.slots.groups(pair));
            if is_left_out {
                self.conclude(Place::BroadPhase, pair, [self.schedule.from(), end]);
            }
        }
    }
}
