//! Events: what ends flights.

use glam::DVec3;

/// An event ends the flights of its bodies at `time`, unless they have begun others since.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Event {
    pub(super) time: f64,
    /// The time by which the bodies have certainly met.
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
    /// The query could certify nothing beyond this time.
    Budget,
    /// The bodies are too close for any query.
    Stuck,
    /// The end of a flight as planned; both bodies are the same.
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
