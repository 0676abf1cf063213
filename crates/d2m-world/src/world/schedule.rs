//! The pairs that may meet within a span of time, by the time at which they may do so first.
//!
//! Boxes that the bodies sweep over the span are kept until a body changes or the span ends; the queue too. A query of a later
//! window within the same span, after a few bodies have changed, costs what the pairs of those bodies cost.

use super::filter::PairFilter;
use super::pair_queue::PairQueue;
use super::pair_state::Entry;
use super::slots::Slots;
use crate::batches::BOXES;
use crate::box_tree::{BoxTree, IndexPair};
use crate::moving_sphere::sphere_about;
use crate::swept_bounds::{CoveredBody, SliceRange, Slicing, Sweep, SweptSlices};
use crate::{Aabb, Body};
use d2m_bvh::{QueryOptions, Window};
use d2m_feature::{FirstMeeting, MovingSphere};
use d2m_mesh::parallel::map_in_order;
use d2m_motion::OutsideDomain;

/// Bodies that change one by one look for their pairs; from this part of all on all pairs are found anew.
const CHANGED_PART: usize = 4;
/// A box over the span that is wider than this many radii of its body is worth cutting into slices: the box of a body that
/// rests is two radii wide at most.
const FAR: f64 = 3.0;

/// So many stale entries are not worth a walk through the queue.
const LEAST_STALE: usize = 1024;

/// Smaller boxes of one body.
#[derive(Clone, Debug)]
enum Slices {
    /// It moves so little that slices would not be smaller.
    NotWorthIt,
    /// Not needed so far.
    Unknown,
    Known(SweptSlices),
}

/// What is considered when a pair is judged.
#[derive(Clone, Copy)]
pub(super) struct Rules<'a> {
    pub(super) slots: &'a Slots,
    pub(super) filter: &'a PairFilter,
    pub(super) options: &'a QueryOptions,
}

impl Rules<'_> {
    /// Of pairs without a separation of their own.
    const fn usual_separation(self) -> f64 {
        self.options.min_separation
    }

    /// The separation of a pair.
    pub(super) fn separation(self, pair: IndexPair) -> f64 {
        self.filter.separation(pair, self.usual_separation())
    }

    /// Boxes and spheres are wider than their bodies by this. The margins of two bodies are together at least their tolerance, so that
    /// what boxes or spheres exclude is not in contact at the start of a window either, where a tolerance above the separation is.
    fn margin(self, body: &Body) -> f64 {
        let margin = match self.options.tolerance {
            Some(tolerance) => (0.5 * tolerance).next_up(),
            None => self.options.tolerance_of((body.tree().radius() + body.radius()).next_up()).next_up(),
        };
        // What is none is refused by the query of a pair.
        if margin > 0.0 { margin } else { 0.0 }
    }
}

/// Kept from query to query.
#[derive(Clone, Debug, Default)]
pub(super) struct Schedule {
    /// Boxes and queue hold for windows within this.
    span: Option<Window>,
    /// The start of the last window: boxes of changed bodies begin there.
    from: f64,
    hulls: Vec<Aabb>,
    slices: Vec<Slices>,
    /// From the start of the span, for bodies with a constant twist.
    spheres: Vec<Option<MovingSphere>>,
    tree: BoxTree,
    /// Of pairs that a caller's own broad phase has left, ascending: then boxes and spheres are not asked.
    given: Option<Vec<(IndexPair, MeetingSpan)>>,
    queue: PairQueue,
    /// Entries when stale ones were last dropped.
    fresh: usize,
}

/// The motion of the body at a place does not cover the times of a query.
#[derive(Clone, Copy, Debug)]
pub(super) struct Uncovered {
    pub(super) place: u32,
    pub(super) outside: OutsideDomain,
}

/// Were boxes and queue kept?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Prepared {
    /// But for changed bodies.
    Kept,
    /// They are all new.
    Anew,
}

/// Part of the span in which a pair may meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct MeetingSpan {
    pub(super) start: f64,
    pub(super) end: f64,
    /// The pair is proven apart from `end` on to the end of the span.
    pub(super) clear_after: f64,
}

impl Schedule {
    /// Forgets everything: the next query starts from scratch.
    pub(super) fn clear(&mut self) {
        self.span = None;
    }

    /// Makes boxes and queue hold for `window`; `changed` are the places of bodies that changed since the last time.
    ///
    /// # Errors
    /// A motion that does not cover the window. Then nothing is known any more.
    pub(super) fn prepare(
        &mut self,
        rules: Rules<'_>,
        window: Window,
        changed: &[u32],
    ) -> Result<Prepared, Uncovered> {
        let prepared = match self.span {
            // What changed may cover the window and not the span: then that is the new span.
            Some(_) => self.try_prepare(rules, window, changed).or_else(|_| {
                self.clear();
                self.try_prepare(rules, window, changed)
            }),
            None => self.try_prepare(rules, window, changed),
        };
        prepared.inspect_err(|_| self.clear())
    }

    fn try_prepare(
        &mut self,
        rules: Rules<'_>,
        window: Window,
        changed: &[u32],
    ) -> Result<Prepared, Uncovered> {
        let kept = self.span.filter(|span| {
            span.start() <= window.start() && window.end() <= span.end() && self.from <= window.start()
        });
        self.from = window.start();
        match kept {
            Some(_) if changed.is_empty() => Ok(Prepared::Kept),
            Some(span) => {
                self.hulls.resize(rules.slots.places(), Aabb::EMPTY);
                self.slices.resize(rules.slots.places(), Slices::NotWorthIt);
                self.spheres.resize(rules.slots.places(), None);
                self.enclose(rules, span, changed)?;
                if changed.len() * CHANGED_PART > rules.slots.places() {
                    self.tree.fit(&self.hulls);
                    self.sweep(rules);
                } else {
                    self.tree.refit(&self.hulls, changed);
                    self.insert(rules, changed);
                }
                Ok(Prepared::Kept)
            }
            None => {
                self.span = Some(window);
                let all: Vec<u32> = (0..rules.slots.places() as u32).collect();
                self.hulls = vec![Aabb::EMPTY; all.len()];
                self.slices = vec![Slices::NotWorthIt; all.len()];
                self.spheres = vec![None; all.len()];
                self.enclose(rules, window, &all)?;
                self.tree.fit(&self.hulls);
                self.sweep(rules);
                Ok(Prepared::Anew)
            }
        }
    }

    /// Boxes of some bodies over the rest of the span.
    fn enclose(&mut self, rules: Rules<'_>, span: Window, places: &[u32]) -> Result<(), Uncovered> {
        let from = self.from;
        let enclosed = map_in_order(places, BOXES, |&place| {
            let Some(body) = rules.slots.at(place) else { return Ok(None) };
            CoveredBody::try_new(body, from, span.end()).map(|covered| {
                let margin = rules.margin(body);
                let hull = covered.with_margin(margin).swept();
                let is_wide = (hull.high - hull.low).max_element() > FAR * body.tree().radius();
                let slices = if is_wide { Slices::Unknown } else { Slices::NotWorthIt };
                Some((hull, slices, sphere_about(body, span.start(), margin)))
            })
        });
        for (&place, enclosed) in places.iter().zip(enclosed) {
            let at = place as usize;
            let enclosed = enclosed.map_err(|outside| Uncovered { place, outside })?;
            (self.hulls[at], self.slices[at], self.spheres[at]) =
                enclosed.unwrap_or((Aabb::EMPTY, Slices::NotWorthIt, None));
        }
        Ok(())
    }

    /// The queue from scratch.
    fn sweep(&mut self, rules: Rules<'_>) {
        let mut pairs = Vec::new();
        let usual = rules.usual_separation();
        self.tree.pairs(&self.hulls, usual, |pair| pairs.push(pair));
        let own = rules.filter.wider_than(usual);
        let more = own.filter(|&(pair, separation)| self.meets_beyond(pair, usual, separation));
        pairs.extend(more.map(|(pair, _)| pair));
        self.cut(rules, &pairs);
        let entries: Vec<Entry> = pairs.into_iter().filter_map(|pair| self.entry(rules, pair)).collect();
        self.fresh = entries.len();
        self.queue = PairQueue::new(entries);
    }

    /// May these two come within their own separation, but not within the usual one?
    fn meets_beyond(&self, pair: IndexPair, usual: f64, own: f64) -> bool {
        let [Some(a), Some(b)] = pair.map(|place| self.hulls.get(place as usize)) else { return false };
        !a.is_empty() && !b.is_empty() && !a.may_meet(b, usual) && a.may_meet(b, own)
    }

    /// Entries of changed bodies (ascending); their old ones are recognised by their versions.
    fn insert(&mut self, rules: Rules<'_>, changed: &[u32]) {
        let mut pairs = Vec::new();
        let usual = rules.usual_separation();
        for &place in changed {
            self.tree.pairs_of(&self.hulls, place, usual, |pair| pairs.push(pair));
        }
        let own = rules.filter.wider_than(usual);
        let more = own.filter(|&(pair, separation)| {
            pair.iter().any(|place| changed.binary_search(place).is_ok())
                && self.meets_beyond(pair, usual, separation)
        });
        pairs.extend(more.map(|(pair, _)| pair));
        pairs.sort_unstable();
        pairs.dedup();
        self.cut(rules, &pairs);
        for pair in pairs {
            if let Some(entry) = self.entry(rules, pair) {
                self.queue.push(entry);
            }
        }
        if self.queue.len() > 2 * self.fresh + LEAST_STALE {
            self.queue.retain(|entry| rules.slots.versions(entry.pair) == Some(entry.versions));
            self.fresh = self.queue.len();
        }
    }

    /// Computes the slices of all bodies that have none yet, of pairs that spheres do not prove apart.
    fn cut(&mut self, rules: Rules<'_>, pairs: &[IndexPair]) {
        let Some(span) = self.span else { return };
        let mut is_wanted = vec![false; self.slices.len()];
        let mut wanted = Vec::new();
        for &pair in pairs {
            let lacks = |place: u32| {
                matches!(self.slices[place as usize], Slices::Unknown) && !is_wanted[place as usize]
            };
            let lacking = pair.map(lacks);
            if lacking == [false; 2] || !self.is_near(rules, pair) {
                continue;
            }
            for (place, lacks) in pair.into_iter().zip(lacking) {
                if lacks {
                    is_wanted[place as usize] = true;
                    wanted.push(place);
                }
            }
        }
        let (slicing, from) = (Slicing::new(span), self.from);
        let boxes = map_in_order(&wanted, BOXES, |&place| {
            // Its box was made from an earlier time on, so that the motion covers this.
            let body = rules.slots.at(place)?;
            let covered = CoveredBody::try_new(body, from, span.end()).ok()?;
            Some(SweptSlices::enclose(covered.with_margin(rules.margin(body)), &slicing))
        });
        for (&place, slices) in wanted.iter().zip(boxes) {
            if let Some(slices) = slices {
                self.slices[place as usize] = Slices::Known(slices);
            }
        }
    }

    /// The entry of a pair; none if it is ignored or proven apart for the rest of the span.
    pub(super) fn entry(&self, rules: Rules<'_>, pair: IndexPair) -> Option<Entry> {
        let versions = rules.slots.versions(pair)?;
        if rules.filter.ignores(pair, rules.slots.groups(pair)) {
            return None;
        }
        let meeting = self.meeting_span(rules, pair)?;
        (meeting.end >= self.from).then(|| Entry { time: meeting.start.max(self.from), pair, versions })
    }

    /// Is it not ignored, and not proven apart by spheres for the rest of the span?
    fn is_near(&self, rules: Rules<'_>, pair: IndexPair) -> bool {
        !rules.filter.ignores(pair, rules.slots.groups(pair)) && self.first_meeting(rules, pair).is_some()
    }

    /// The time before which spheres prove a pair apart; none: for the rest of the span.
    fn first_meeting(&self, rules: Rules<'_>, pair: IndexPair) -> Option<f64> {
        let span = self.span?;
        let [Some(a), Some(b)] = pair.map(|place| self.spheres[place as usize].as_ref()) else {
            return Some(self.from);
        };
        let separation = rules.separation(pair);
        // Times since the start of the span, the first one rounded down and the last one up.
        let begin = (self.from - span.start()).next_down().max(0.0);
        let end = (span.end() - span.start()).next_up();
        match a.first_meeting(b, separation, begin, end) {
            FirstMeeting::Never => None,
            FirstMeeting::After(time) => Some((span.start() + time).next_down().clamp(self.from, span.end())),
            FirstMeeting::Unknown => Some(self.from),
        }
    }

    /// When a pair may meet; none is a proof that it does not for the rest of the span.
    pub(super) fn meeting_span(&self, rules: Rules<'_>, pair: IndexPair) -> Option<MeetingSpan> {
        let span = self.span?;
        if let Some(given) = &self.given {
            return given.binary_search_by_key(&pair, |(pair, _)| *pair).ok().map(|place| given[place].1);
        }
        let meeting = self.first_meeting(rules, pair)?;
        let sweep = |place: u32| Sweep {
            hull: &self.hulls[place as usize],
            slices: match &self.slices[place as usize] {
                Slices::Known(slices) => Some(slices),
                Slices::Unknown | Slices::NotWorthIt => None,
            },
        };
        let separation = rules.separation(pair);
        let SliceRange { first, last } = SliceRange::of_pair(sweep(pair[0]), sweep(pair[1]), separation)?;
        let slicing = Slicing::new(span);
        let (start, end) = (slicing.time(first).max(meeting), slicing.time(last + 1));
        (start <= end).then_some(MeetingSpan { start, end, clear_after: span.end() })
    }

    /// Adds the pair again, after its separation has changed for instance.
    pub(super) fn push_pair(&mut self, rules: Rules<'_>, pair: IndexPair) {
        let is_enclosed = |place: u32| (place as usize) < self.hulls.len();
        if self.span.is_some()
            && (self.given.is_some() || pair.iter().all(|&place| is_enclosed(place)))
            && let Some(entry) = self.entry(rules, pair)
        {
            self.queue.push(entry);
        }
    }

    /// The first entry that is not later than `limit`, unless its bodies have changed.
    pub(super) fn pop(&mut self, slots: &Slots, limit: f64) -> Option<Entry> {
        loop {
            if self.queue.peek()?.time > limit {
                return None;
            }
            let entry = self.queue.pop()?;
            if slots.versions(entry.pair) == Some(entry.versions) {
                return Some(entry);
            }
        }
    }

    /// Is there an entry that is not known to be free up to `time`?
    pub(super) fn may_begin_before(&self, time: f64) -> bool {
        self.queue.peek().is_some_and(|entry| entry.time.max(self.from) < time)
    }

    /// Puts an entry into the queue.
    pub(super) fn push(&mut self, entry: Entry) {
        self.queue.push(entry);
    }

    /// The end of the span that boxes and queue hold for.
    #[cfg(feature = "audit")]
    pub(super) fn end(&self) -> Option<f64> {
        self.span.map(Window::end)
    }

    /// The start of the last window.
    pub(super) const fn from(&self) -> f64 {
        self.from
    }

    /// How many entries wait.
    pub(super) fn waiting(&self) -> usize {
        self.queue.len()
    }

    /// All pairs that the boxes leave, ascending.
    pub(super) fn pairs(&self) -> Vec<IndexPair> {
        let mut pairs: Vec<_> = self.queue.iter().map(|entry| entry.pair).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// A schedule with these pairs only, ascending, each with when it may meet.
    pub(super) fn of_given(rules: Rules<'_>, window: Window, given: Vec<(IndexPair, MeetingSpan)>) -> Self {
        let mut schedule = Self { span: Some(window), from: window.start(), ..Self::default() };
        let pairs: Vec<IndexPair> = given.iter().map(|(pair, _)| *pair).collect();
        schedule.given = Some(given);
        for pair in pairs {
            schedule.push_pair(rules, pair);
        }
        schedule
    }

    /// A schedule with the pairs of some bodies only. `earlier` is that of the same bodies, but for these and the `stale`
    /// ones, and lends its boxes where they hold.
    ///
    /// # Errors
    /// A motion that does not cover the window.
    pub(super) fn of_some(
        rules: Rules<'_>,
        window: Window,
        some: &[u32],
        earlier: &Self,
        stale: &[u32],
    ) -> Result<Self, Uncovered> {
        let places = rules.slots.places();
        let mut schedule = Self {
            span: Some(window),
            from: window.start(),
            hulls: vec![Aabb::EMPTY; places],
            slices: vec![Slices::NotWorthIt; places],
            spheres: vec![None; places],
            ..Self::default()
        };
        let lends = earlier.span.is_some_and(|span| {
            span.start() <= window.start() && window.end() <= span.end() && earlier.from <= window.start()
        });
        let mut wanted: Vec<u32> = (0..places as u32).collect();
        if lends {
            let lent = earlier.hulls.len();
            schedule.hulls[..lent].copy_from_slice(&earlier.hulls);
            if earlier.span.is_some_and(|span| span.start() == window.start()) {
                schedule.spheres[..lent].copy_from_slice(&earlier.spheres);
            }
            wanted = (lent as u32..places as u32).chain(some.iter().chain(stale).copied()).collect();
            wanted.sort_unstable();
            wanted.dedup();
        }
        schedule.enclose(rules, window, &wanted)?;
        schedule.insert(rules, some);
        Ok(schedule)
    }
}
