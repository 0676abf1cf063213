use crate::pair::relative_trajectory::RelativeTrajectory;
use crate::{Answered, Solid};

/// What a query of a pair of bodies leaves for the next one: the triangles that were closest, or met, and for bodies
/// that did not meet how far apart they stayed.
///
/// Bodies that move little between two queries are closest, or meet, near the same place again: `distance_within` and
/// [`contact_exists`](crate::contact_exists) begin there. And bodies that stayed 0.1 apart (lengths in the unit of
/// the meshes) stay apart when they move almost the same way again, where "almost" is a bound on the difference of all their
/// points' positions below 0.1: so [`time_of_contact_with`](crate::time_of_contact_with) need not search. Promise: a cache
/// never changes an answer, not in one bit; a cache from other bodies is useless but harmless. Source: Section VI of the d2m
/// paper; docs/theory/engine.md, "What one query proves for the next".
///
/// ```
/// let mut cache = d2m_bvh::PairCache::new();
/// assert_eq!(cache.triangles(), None);
/// cache.remember([3, 7]);
/// assert_eq!(cache.triangles(), Some([3, 7]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairCache {
    triangles: Option<[u32; 2]>,
    /// Time after the start of the window at which they met.
    pub(crate) meeting: f64,
    apart: Option<Apart>,
    /// The next search proves room for about so many more queries.
    ahead: f64,
    /// Queries until the next attempt to prove more separation than a query needs, and how many it will be after a failure.
    rest: u32,
    next_rest: u32,
    /// Node tests of the queries that used it.
    work: u64,
}

impl Default for PairCache {
    fn default() -> Self {
        Self::new()
    }
}

/// Bodies that did not meet.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Apart {
    trajectory: RelativeTrajectory,
    /// Proven: further apart than this all the time.
    room: f64,
    solids: [Solid; 2],
    /// Queries since then.
    age: f64,
}

/// Queries that a proof should serve at first, and at most.
const AHEAD: f64 = 16.0;
const MOST_AHEAD: f64 = 64.0;
/// A room of so many tolerances at least.
const LEAST_TOLERANCES: f64 = 16.0;
/// A room of this part of the bodies' reach at most.
const MOST_OF_EXTENT: f64 = 0.125;
/// Most queries between two attempts.
const LONGEST_REST: u32 = 1024;

impl PairCache {
    /// Knows nothing yet.
    pub const fn new() -> Self {
        Self { triangles: None, meeting: 0.0, apart: None, ahead: AHEAD, rest: 0, next_rest: 16, work: 0 }
    }

    /// The remembered triangles, of A and of B.
    pub const fn triangles(&self) -> Option<[u32; 2]> {
        self.triangles
    }

    /// Remembers the triangles of A and of B.
    pub const fn remember(&mut self, triangles: [u32; 2]) {
        self.triangles = Some(triangles);
    }

    /// What was done in all first-contact queries with this cache, in node tests, as a [`Budget`](crate::Budget) counts them.
    pub const fn work(&self) -> u64 {
        self.work
    }

    /// Adds the work of a query to the sum.
    pub(crate) fn counted<T>(&mut self, Answered { answer, work }: Answered<T>) -> T {
        self.work += work.work();
        answer
    }

    /// Adds work to the sum.
    pub(crate) const fn spend(&mut self, work: u64) {
        self.work += work;
    }

    /// Forgets everything.
    pub const fn clear(&mut self) {
        *self = Self::new();
    }

    /// The remembered triangles if bodies with these numbers of triangles have them.
    pub(crate) fn within(&self, counts: [usize; 2]) -> Option<[u32; 2]> {
        self.triangles.filter(|t| (t[0] as usize) < counts[0] && (t[1] as usize) < counts[1])
    }

    /// A distance that the bodies are proven to keep all along the trajectory; none, or negative, when nothing is known.
    pub(crate) fn room_along(&mut self, trajectory: &RelativeTrajectory, solids: [Solid; 2]) -> Option<f64> {
        let apart = self.apart.as_mut().filter(|apart| apart.solids == solids)?;
        apart.age += 1.0;
        Some(apart.room - trajectory.deviation(&apart.trajectory)?)
    }

    /// How much separation to prove beyond what the query needs: enough for the next ones if they go on to differ as those since
    /// the last proof did. None when that did not work lately, or when there is nothing to go by.
    pub(crate) fn room_to_prove(&mut self, trajectory: &RelativeTrajectory, tolerance: f64) -> Option<f64> {
        if self.rest > 0 {
            self.rest -= 1;
            return None;
        }
        let apart = self.apart?;
        let step = trajectory.deviation(&apart.trajectory)? / apart.age.max(1.0);
        let room = (self.ahead * step).max(LEAST_TOLERANCES * tolerance);
        let most = MOST_OF_EXTENT * trajectory.extent();
        (2.0 * step <= most).then_some(room.min(most))
    }

    /// Proven: along this trajectory the bodies are further apart than `room` all the time.
    pub(crate) fn found_apart(&mut self, trajectory: &RelativeTrajectory, solids: [Solid; 2], room: f64) {
        self.apart = Some(Apart { trajectory: *trajectory, room, solids, age: 0.0 });
    }

    /// Proven: along this trajectory the bodies are further apart than a room for more queries all the time.
    pub(crate) fn found_room(&mut self, trajectory: &RelativeTrajectory, solids: [Solid; 2], room: f64) {
        self.ahead = (2.0 * self.ahead).min(MOST_AHEAD);
        self.next_rest = 16;
        self.found_apart(trajectory, solids, room);
    }

    /// An attempt to prove such a room has failed.
    pub(crate) fn found_no_room(&mut self) {
        self.ahead *= 0.25;
        if self.ahead < 2.0 {
            self.ahead = AHEAD;
            self.rest = self.next_rest;
            self.next_rest = (2 * self.next_rest).min(LONGEST_REST);
        }
    }

    /// The bodies met on these triangles.
    pub(crate) fn found_contact(&mut self, triangles: [u32; 2], after: f64) {
        self.apart = None;
        self.triangles = Some(triangles);
        self.meeting = after;
    }
}
