//! Pairs by the time at which they have to be judged next.

use super::pair_state::Entry;
use std::collections::BinaryHeap;

/// So many entries are put in order at first when the earliest is wanted, then [`GROWTH`] times as many.
///
/// A crowd has half a million pairs and a search that is over after a few of them: finding the earliest ones is a few
/// passes over all, putting all in order is many.
const FIRST_PORTION: usize = 64;
/// Each portion costs a pass over what is left; with this growth half a million entries take five.
const GROWTH: usize = 8;

/// A priority queue of entries, the earliest first, that orders only the part that is taken.
#[derive(Clone, Debug, Default)]
pub(super) struct PairQueue {
    ordered: BinaryHeap<Entry>,
    /// In any order, but for the last one, which is the earliest of them.
    unordered: Vec<Entry>,
    portion: usize,
}

impl PairQueue {
    pub(super) fn new(entries: Vec<Entry>) -> Self {
        let mut queue = Self { ordered: BinaryHeap::new(), unordered: entries, portion: FIRST_PORTION };
        queue.put_earliest_last();
        queue
    }

    fn put_earliest_last(&mut self) {
        // Entries compare as a heap wants them: the earliest is the greatest.
        if let Some((place, _)) = self.unordered.iter().enumerate().max_by(|x, y| x.1.cmp(y.1)) {
            let last = self.unordered.len() - 1;
            self.unordered.swap(place, last);
        }
    }

    pub(super) fn push(&mut self, entry: Entry) {
        self.ordered.push(entry);
    }

    pub(super) fn peek(&self) -> Option<&Entry> {
        self.ordered.peek().max(self.unordered.last())
    }

    pub(super) fn pop(&mut self) -> Option<Entry> {
        if self.unordered.last() > self.ordered.peek() {
            self.order_portion();
        }
        self.ordered.pop()
    }

    fn order_portion(&mut self) {
        let count = self.unordered.len();
        if self.portion < count {
            let rest = count - self.portion;
            self.unordered.select_nth_unstable(rest - 1);
            self.ordered.extend(self.unordered.drain(rest..));
            self.portion = self.portion.saturating_mul(GROWTH);
        } else {
            self.ordered.extend(self.unordered.drain(..));
        }
    }

    pub(super) fn retain(&mut self, mut keep: impl FnMut(&Entry) -> bool) {
        self.ordered.retain(&mut keep);
        self.unordered.retain(&mut keep);
        self.put_earliest_last();
    }

    pub(super) fn len(&self) -> usize {
        self.ordered.len() + self.unordered.len()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &Entry> {
        self.ordered.iter().chain(&self.unordered)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};

    fn entry(random: &mut KnuthRandom) -> Entry {
        let time = random.index(40) as f64;
        Entry { time, pair: [random.index(30) as u32, 30 + random.index(30) as u32], versions: [1, 2] }
    }

    #[test]
    fn hands_out_the_earliest_whatever_is_pushed_and_dropped() {
        let mut random = KnuthRandom(17);
        for count in [0, 1, 2, 63, 64, 65, 600, 3000] {
            let mut all: Vec<_> = (0..count).map(|_| entry(&mut random)).collect();
            let mut queue = PairQueue::new(all.clone());
            while !all.is_empty() {
                if random.unit() < 0.3 {
                    let more = entry(&mut random);
                    all.push(more);
                    queue.push(more);
                }
                if random.unit() < 0.01 {
                    let first = random.index(60) as u32;
                    all.retain(|entry| !entry.pair.contains(&first));
                    queue.retain(|entry| !entry.pair.contains(&first));
                }
                assert_eq!((queue.len(), queue.iter().count()), (all.len(), all.len()));
                let expected = all.iter().enumerate().max_by(|x, y| x.1.cmp(y.1));
                let expected = expected.map(|(place, entry)| (place, (entry.time, entry.pair)));
                let rank = |entry: &Entry| (entry.time, entry.pair);
                assert_eq!(queue.peek().map(rank), expected.map(|(_, rank)| rank));
                assert_eq!(queue.pop().map(|entry| rank(&entry)), expected.map(|(_, rank)| rank));
                if let Some((place, _)) = expected {
                    all.swap_remove(place);
                }
            }
            assert!(queue.pop().is_none() && queue.peek().is_none());
        }
    }
}
