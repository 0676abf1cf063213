//! What ends flights.

use glam::DVec3;

/// Something that ends flights: at `time`, of bodies that have not begun another flight since.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Event {
    pub(super) time: f64,
    /// Until when the bodies have certainly met.
    pub(super) by: f64,
    pub(super) bodies: [usize; 2],
    pub(super) versions: [u64; 2],
    pub(super) cause: Cause,
    /// From the first body to the second, and how fast they close along it.
    pub(super) normal: DVec3,
    pub(super) closing: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Cause {
    /// The bodies meet.
    Contact,
    /// The end of what the query could certify.
    Budget,
    /// Too close for any query.
    Stuck,
    /// A flight that was planned to end; both bodies are the same.
    Horizon,
}

impl Eq for Event {}

impl Ord for Event {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        let rest = |e: &Self| (e.bodies, e.versions, e.cause);
        self.time.total_cmp(&other.time).then_with(|| rest(self).cmp(&rest(other)))
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
