//! What is known of a pair, and when it has to be judged next.

use crate::box_tree::IndexPair;
use d2m_bvh::{Contact, PairCache};
use std::cmp::Ordering;

/// Numbers of the bodies' versions that something was proven for: every change of a body gives it a new one.
pub(super) type Versions = [u64; 2];

/// What was proven of a pair that was searched.
#[derive(Clone, Debug)]
pub(super) struct PairState {
    pub(super) versions: Versions,
    /// The separation that it was proven for.
    pub(super) separation: f64,
    /// Nothing is known of times before this.
    pub(super) from: f64,
    pub(super) known: Known,
    pub(super) cache: Box<PairCache>,
}

#[derive(Clone, Debug)]
pub(super) enum Known {
    /// Nothing.
    Nothing,
    /// No contact from `from` to here, both included.
    ClearUntil(f64),
    /// The first contact from `from` on.
    Contact(Box<Contact>),
}

/// A pair in the queue: 32 bytes, which is all that a pair costs that is never searched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// No contact of the pair before this time, unless one began before the window.
    pub(super) time: f64,
    pub(super) pair: IndexPair,
    pub(super) versions: Versions,
}

impl Entry {
    fn rank(&self, other: &Self) -> Ordering {
        // Earliest first out of a heap that hands out the greatest.
        other.time.total_cmp(&self.time).then_with(|| other.pair.cmp(&self.pair))
    }
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.rank(other) == Ordering::Equal
    }
}

impl Eq for Entry {}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank(other)
    }
}
