//! Memory of a search.

use super::counts::SearchCounts;
use super::queue::{Bucket, Queue, WaitingSpans};
use crate::pair::motion::frame::RelativeMotion;

/// Memory that one search uses and the next one uses again, without new allocations.
#[derive(Debug)]
pub(crate) struct Scratch {
    pub(crate) queue: Queue,
    pub(crate) batch: Bucket,
    /// The pairs that a batch leaves.
    pub(crate) fresh: Vec<[u32; 4]>,
    pub(crate) counts: SearchCounts,
    /// The triangles that were tested last.
    pub(crate) last_tested: [u32; 2],
    /// The spans of time that wait, and their pairs.
    pub(crate) split: WaitingSpans,
    /// The motion over the sub-window of the last contact that a search with this memory found.
    pub(crate) found_in: Option<RelativeMotion>,
    /// For sub-windows that other threads search before their turn.
    #[cfg(feature = "rayon")]
    pub(crate) helpers: Vec<Scratch>,
}

impl Scratch {
    pub(crate) fn new() -> Self {
        Self {
            queue: Queue::new(),
            batch: Bucket::EMPTY,
            fresh: Vec::new(),
            counts: SearchCounts::default(),
            last_tested: [0, 0],
            split: WaitingSpans::default(),
            found_in: None,
            #[cfg(feature = "rayon")]
            helpers: Vec::new(),
        }
    }
}
