//! Through the times of a contact: from a time at which bodies are within the level to the first one at which they are proven further
//! apart.

#[cfg(feature = "audit")]
use super::concluded::{Claimed, conclude_of_triangles, conclude_overlap};
use super::meshes::of_meshes;
use super::staying_inside::DeepPoint;
use crate::moving::triangles_of;
use crate::{Budget, Meter, Moving, Posed, QueryError, QueryOptions, Solid, TimeOfContact, Window};
use d2m_feature::stay_within;
use d2m_mesh::at_rest::{Nearness, near_pair};
use d2m_mesh::at_rest::{is_contained, some_colliding_pairs};

/// Steps of the search for the closest pair at a time.
const NEAR_STEPS: u64 = 4096;
/// Pairs of triangles that may stay in contact the longest, and the steps of the search for them.
const PAIRS: usize = 24;
const PAIR_STEPS: u64 = 4096;
/// A pair that stays in contact for so many resolutions is followed without a search for a better one.
const LONG: f64 = 64.0;
/// Longer by so much are spans after one that was proven.
const GROWTH: f64 = 4.0;
/// After a span that was not proven longer so many are tried as long as the last one.
const SETTLED: u32 = 8;
/// And shorter by so much those in which a point that is inside of both bodies may come too far.
const SHORTER: f64 = 0.75;
/// A search stops at most 3.3 tolerances above the separation: bodies that are further apart than that do not stop it at once.
const CLEARLY: f64 = 3.0;
/// A search with this part of the tolerance stops within 3.3 times that above the separation: below a level that is passed.
pub(super) const FINER: f64 = 0.25;
/// Node tests that the work at one time counts for in a budget.
const TESTS_A_TIME: u64 = 64;

/// What comes after a time at which the bodies are within the level.
#[derive(Clone, Copy, Debug)]
pub(super) enum Next {
    /// Within the level to the end, with no more than the resolution between two times at which it is proven.
    End,
    /// Proven within at `last` and further apart at `at`.
    Apart { last: f64, at: f64 },
    /// Nothing is proven between `last` and `at`, where they are within the level again.
    Within { last: f64, at: f64 },
    /// Nothing is proven from here on.
    Unknown { last: f64 },
}

/// The way through a contact.
pub(super) struct Walk<'a> {
    pub(super) bodies: [Moving<'a>; 2],
    pub(super) window: Window,
    /// The options of the meshes' query.
    pub(super) options: QueryOptions,
    /// s + δ of the meshes.
    pub(super) level: f64,
    pub(super) resolution: f64,
    pub(super) meter: Meter,
    /// The pair that proved the last contact, and how long it was good for.
    pair: Option<[u32; 2]>,
    span: f64,
    /// Spans that are still taken as long as the last one, since a longer one was not proven.
    settled: u32,
    /// The last span was proven by a point inside of both.
    is_deep: bool,
}

impl<'a> Walk<'a> {
    pub(super) fn new(
        bodies: [Moving<'a>; 2],
        window: Window,
        options: &QueryOptions,
        tolerance: f64,
        resolution: f64,
    ) -> Self {
        // The hard cap on one search holds for all of them together.
        let most = options.budget.node_tests.unwrap_or(Budget::HARD_NODE_TESTS);
        Self {
            bodies,
            window,
            options: *options,
            level: options.min_separation + tolerance,
            resolution,
            meter: Meter::new(&options.budget.with_node_tests(most)),
            pair: None,
            span: 0.25 * window.length(),
            settled: 0,
            is_deep: false,
        }
    }

    /// The options of the meshes' query with what is left of the budget; `None` when that is used up.
    pub(super) fn rest(&self) -> Option<QueryOptions> {
        (!self.meter.is_exhausted()).then(|| self.options.with_budget(self.meter.rest()))
    }

    /// The first contact from a time on. `None`: the budget is used up.
    ///
    /// # Errors
    /// Those of the query.
    pub(super) fn contact_from(&mut self, from: f64, to: f64) -> Result<Option<TimeOfContact>, QueryError> {
        let Some(options) = self.rest() else { return Ok(None) };
        self.contact_with(&options, from, to)
    }

    /// The same where the bodies are proven further apart than the level at `from`: a search that does not stop there.
    ///
    /// # Errors
    /// Those of the query.
    pub(super) fn contact_from_above(
        &mut self,
        from: f64,
        to: f64,
    ) -> Result<Option<TimeOfContact>, QueryError> {
        let Some(options) = self.rest() else { return Ok(None) };
        let tolerance = FINER * (self.level - options.min_separation);
        self.contact_with(&options.with_tolerance(tolerance), from, to)
    }

    fn contact_with(
        &mut self,
        options: &QueryOptions,
        from: f64,
        to: f64,
    ) -> Result<Option<TimeOfContact>, QueryError> {
        let [a, b] = self.bodies;
        let found = of_meshes([a, b], Window::try_new(from, to)?, options)?;
        self.meter.spend(found.work.work() + 1);
        Ok(Some(found.answer))
    }

    /// Proven further apart than the level at this time?
    pub(super) fn is_apart(&mut self, time: f64) -> Result<bool, QueryError> {
        Ok(self.contact_from(time, time)?.is_some_and(|answer| answer.is_separated()))
    }

    /// Proven so far apart at this time that a search from there on does not stop at once?
    ///
    /// # Errors
    /// Those of the query.
    pub(super) fn is_clearly_apart(&mut self, time: f64) -> Result<bool, QueryError> {
        let Some(options) = self.rest() else { return Ok(false) };
        let tolerance = self.level - self.options.min_separation;
        let further = options.min_separation + CLEARLY * tolerance;
        let [a, b] = self.bodies;
        let found = of_meshes([a, b], Window::try_new(time, time)?, &options.with_min_separation(further))?;
        self.meter.spend(found.work.work() + 1);
        Ok(found.answer.is_separated())
    }

    /// Proven within the level at this time?
    pub(super) fn is_within(&mut self, time: f64) -> bool {
        self.meter.spend(TESTS_A_TIME);
        if self.pair.is_some_and(|pair| self.stays(pair, time, time)) {
            return true;
        }
        let [a, b] = self.posed(time);
        let near = near_pair(a, b, self.pair, Nearness { steps: NEAR_STEPS, slack: 0.0 }).ok().flatten();
        if let Some(pair) = near.filter(|&pair| self.stays(pair, time, time)) {
            self.pair = Some(pair);
            return true;
        }
        self.contains(time)
    }

    fn posed(&self, time: f64) -> [Posed<'a>; 2] {
        self.bodies.map(|moving| Posed::new(moving.body, moving.motion.pose_and_twist(time).0))
    }

    /// Is a part of one body in the other one, if that is solid?
    fn contains(&self, time: f64) -> bool {
        let [a, b] = self.posed(time);
        is_contained(a, b, self.solids()).unwrap_or(false)
    }

    fn stays(&self, pair: [u32; 2], from: f64, to: f64) -> bool {
        let stays = stay_within(&triangles_of(&self.bodies, pair), from, to, self.level);
        #[cfg(feature = "audit")]
        if stays {
            use d2m_mesh::audit::{Place, Promise};
            let claimed = Claimed { from, to, distance: self.level };
            conclude_of_triangles(Place::Staying, Promise::Stays, &self.bodies, pair, claimed);
        }
        stays
    }

    /// From `last`, at which the bodies are within the level, to where that ends.
    ///
    /// # Errors
    /// Those of the query.
    pub(super) fn next(&mut self, last: f64) -> Result<Next, QueryError> {
        let end = self.window.end();
        let mut last = last;
        loop {
            if self.rest().is_none() {
                return Ok(Next::Unknown { last });
            }
            last = self.within_until(last);
            if last >= end {
                return Ok(Next::End);
            }
            let mut step = self.resolution;
            let mut at = last;
            loop {
                let time = (at + step).max(at.next_up()).min(end);
                if self.is_within(time) {
                    if at > last {
                        return Ok(Next::Within { last, at: time });
                    }
                    last = time;
                    break;
                }
                if self.is_apart(time)? {
                    return self.narrowed(last, time);
                }
                if time >= end || self.rest().is_none() {
                    return Ok(Next::Unknown { last });
                }
                at = time;
                step *= 2.0;
            }
            if last >= end {
                return Ok(Next::End);
            }
        }
    }

    /// The time at which bodies part, between one at which they are within the level and one at which they are apart.
    fn narrowed(&mut self, mut last: f64, mut at: f64) -> Result<Next, QueryError> {
        loop {
            let middle = last + 0.5 * (at - last);
            if middle <= last || middle >= at || self.rest().is_none() {
                break;
            }
            if self.is_within(middle) {
                last = middle;
            } else if self.is_apart(middle)? {
                at = middle;
            } else {
                break;
            }
        }
        Ok(Next::Apart { last, at })
    }

    /// A time, not before `from`, up to which the bodies are proven within the level all the time.
    fn within_until(&mut self, from: f64) -> f64 {
        let joint = |body: &Moving<'_>| body.motion.smooth_until(from).filter(|joint| *joint > from);
        let end = self.bodies.iter().filter_map(joint).fold(self.window.end(), f64::min);
        let mut best = from;
        let known = self.pair;
        if let Some(pair) = known {
            best = self.stays_until(pair, from, end);
            if best >= end || best - from >= LONG * self.resolution {
                return best;
            }
        }
        let [a, b] = self.posed(from);
        let pairs = some_colliding_pairs(a, b, PAIRS, PAIR_STEPS);
        if self.is_deep {
            best = best.max(self.inside_until(&pairs, from, end));
            if best >= end || best - from >= LONG * self.resolution {
                return best;
            }
        }
        for &pair in &pairs {
            self.meter.spend(TESTS_A_TIME);
            if known == Some(pair) {
                continue;
            }
            let until = self.stays_until(pair, from, end);
            if until > best {
                (best, self.pair) = (until, Some(pair));
            }
            if best >= end {
                return best;
            }
        }
        let is_tried = self.is_deep;
        self.is_deep = false;
        if best - from < LONG * self.resolution && !is_tried {
            let inside = self.inside_until(&pairs, from, end);
            self.is_deep = inside > best && inside - from >= LONG * self.resolution;
            best = best.max(inside);
        }
        best
    }

    fn solids(&self) -> [Solid; 2] {
        self.bodies.map(|body| body.solid_in(&self.options))
    }

    /// The same by a point of one body that is inside of the other.
    fn inside_until(&mut self, pairs: &[[u32; 2]], from: f64, end: f64) -> f64 {
        let solids = self.solids();
        let Some(point) = DeepPoint::find(&self.bodies, solids, pairs, from, &mut self.meter) else {
            return from;
        };
        let mut until = point.guess(&self.bodies).min(end);
        while until - from >= self.resolution {
            self.meter.spend(TESTS_A_TIME);
            if point.stays_until(&self.bodies, until) {
                #[cfg(feature = "audit")]
                conclude_overlap(&self.bodies, solids, Claimed { from, to: until, distance: self.level });
                return until;
            }
            // Next to each other numbers for time become no shorter.
            let shorter = from + SHORTER * (until - from);
            if shorter >= until || self.meter.is_exhausted() {
                return from;
            }
            until = shorter;
        }
        from
    }

    /// The same for one pair; `from` itself where not even a part of the resolution is proven.
    fn stays_until(&mut self, pair: [u32; 2], from: f64, end: f64) -> f64 {
        let mut span = self.span.max(self.resolution).min(end - from);
        let mut best = from;
        let least = 0.25 * self.resolution;
        while from + span > from && span >= least {
            self.meter.spend(TESTS_A_TIME);
            let to = (from + span).min(end);
            if self.stays(pair, from, to) {
                best = to;
                if to >= end || self.settled > 0 {
                    self.settled = self.settled.saturating_sub(1);
                    break;
                }
                span *= GROWTH;
            } else if best > from {
                self.settled = SETTLED;
                break;
            } else {
                self.settled = 0;
                span /= GROWTH;
            }
        }
        if best > from {
            self.span = best - from;
        }
        best
    }
}
