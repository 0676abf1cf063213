//! The queue of box pairs: a radix heap whose buckets are handed out whole while they are small.
//!
//! Keys are times as integers. The search takes the earliest keys; keys that come in are never below the last one
//! handed out (monotone). An item moves to a lower bucket at most 32 times, so the work is bounded by 32 moves an item
//! whatever the scene does.

use d2m_mesh::node::LEAF;

/// A pair of boxes and the time until which it is proven apart.
///
/// In the order of a row of words, so that a row becomes an item as it is: queries queue a thousand of them.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(crate) struct Item {
    /// Time key.
    pub(crate) key: u32,
    /// Boxes of A and of B.
    pub(crate) boxes: [u32; 2],
    /// What is to be done: the number of the wide node to expand, and [`Item::OF_B`] if it is one of B's; or
    /// [`Item::TRIANGLES`] when both boxes are triangles.
    pub(crate) next: u32,
}

impl Item {
    /// The node to expand is one of B's.
    pub(crate) const OF_B: u32 = 1 << 30;
    /// Nothing is left to expand: both boxes are triangles.
    pub(crate) const TRIANGLES: u32 = LEAF;

    /// From four words in the order of the fields.
    #[inline(always)]
    pub(crate) const fn from_row([key, a, b, next]: [u32; 4]) -> Self {
        Self { key, boxes: [a, b], next }
    }

    /// Whose node is to be expanded: 0 is A, 1 is B.
    #[inline(always)]
    pub(crate) const fn side(&self) -> usize {
        (self.next >> Self::OF_B.trailing_zeros()) as usize & 1
    }

    /// The node to be expanded, by number.
    #[inline(always)]
    pub(crate) const fn node(&self) -> u32 {
        self.next & !Self::OF_B
    }
}

/// Monotone queue. Bucket 0 holds keys equal to `last`, bucket i keys whose highest bit that differs is bit i − 1.
#[derive(Debug)]
pub(crate) struct Queue {
    buckets: [Bucket; 33],
    /// Bit i is set when bucket i is not empty.
    occupied: u64,
    last: u32,
}

/// A span of time that waits, by places of a grid, and where its pairs are in the list.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WaitingSpan {
    pub(crate) from: usize,
    pub(crate) to: usize,
    pub(crate) pairs: (usize, usize),
}

/// Spans of time that wait, the earliest last, and their pairs of boxes.
#[derive(Debug, Default)]
pub(crate) struct WaitingSpans {
    pub(crate) spans: Vec<WaitingSpan>,
    pub(crate) pairs: Vec<Item>,
    /// Pairs of the span in hand that may be expanded.
    pub(crate) to_expand: Vec<Item>,
}

/// Room for more items than this is given back after use: 1 MB.
const LARGE: usize = 1 << 16;

/// Items in any order.
#[derive(Debug)]
pub(crate) struct Bucket {
    /// The first `count` of them; the others are room.
    items: Vec<Item>,
    count: usize,
    /// The least of their keys.
    least: u32,
}

impl Bucket {
    pub(crate) const EMPTY: Self = Self { items: Vec::new(), count: 0, least: u32::MAX };

    /// What it holds.
    #[inline(always)]
    pub(crate) fn items(&self) -> &[Item] {
        &self.items[..self.count]
    }

    #[inline(always)]
    fn push(&mut self, item: Item) {
        match self.items.get_mut(self.count) {
            Some(place) => *place = item,
            None => self.grow(item),
        }
        self.count += 1;
        self.least = self.least.min(item.key);
    }

    /// By value, as everywhere here: an item whose address is taken is written to the stack and read again.
    #[cold]
    #[inline(never)]
    fn grow(&mut self, item: Item) {
        self.items.resize((2 * self.count).max(16), item);
    }

    /// Drops the items for which `keep` is false.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(&Item) -> bool) {
        let (mut kept, mut least) = (0, u32::MAX);
        for index in 0..self.count {
            let item = self.items[index];
            if keep(&item) {
                self.items[kept] = item;
                least = least.min(item.key);
                kept += 1;
            }
        }
        (self.count, self.least) = (kept, least);
    }

    /// Moves the last items, whose keys are all equal, to an empty bucket.
    fn move_last(&mut self, count: usize, to: &mut Self) {
        let rest = self.count - count;
        for item in &self.items[rest..self.count] {
            to.push(*item);
        }
        self.count = rest;
    }

    #[inline(always)]
    fn clear(&mut self) {
        self.count = 0;
        self.least = u32::MAX;
    }
}

impl Queue {
    pub(crate) fn new() -> Self {
        Self { buckets: [const { Bucket::EMPTY }; 33], occupied: 0, last: 0 }
    }

    /// Empties the queue and restarts the keys at zero.
    pub(crate) fn clear(&mut self) {
        for bucket in &mut self.buckets {
            bucket.clear();
        }
        self.occupied = 0;
        self.last = 0;
    }

    /// Adds an item whose key is not below the last key handed out.
    #[inline(always)]
    pub(crate) fn push(&mut self, item: Item) {
        debug_assert!(item.key >= self.last);
        let bucket = 32 - (item.key ^ self.last).leading_zeros();
        self.buckets[bucket as usize].push(item);
        self.occupied |= 1 << bucket;
    }

    /// Moves the earliest items into `batch` (emptied first), at most `target` of them, and returns the least key of all
    /// live items; None when there is none. Of more items with equal keys the last that came in are handed out: what
    /// they leave comes next if its keys are equal too, so the search goes depth first among equals, and its memory
    /// does not grow with their number.
    #[inline(always)]
    pub(crate) fn take(&mut self, batch: &mut Bucket, target: usize) -> Option<u32> {
        batch.clear();
        loop {
            let index = self.occupied.trailing_zeros() as usize;
            if index == 0 && self.buckets[0].count > target {
                self.buckets[0].move_last(target, batch);
                return Some(batch.least);
            }
            core::mem::swap(self.buckets.get_mut(index)?, batch);
            self.occupied &= self.occupied - 1;
            // The bits of `last` above the bucket's own stay what they were: the higher buckets remain valid.
            self.last = batch.least;
            if batch.count <= target {
                return Some(batch.least);
            }
            self.extend(batch.items().iter().copied());
            batch.clear();
            if batch.items.len() > LARGE {
                batch.items = Vec::new();
            }
        }
    }

    /// Adds items whose keys are not below the last key handed out.
    #[inline(always)]
    pub(crate) fn extend(&mut self, items: impl IntoIterator<Item = Item>) {
        // Kept in registers: in memory each item would wait for the one before.
        let (last, mut occupied) = (self.last, self.occupied);
        for item in items {
            debug_assert!(item.key >= last);
            let bucket = 32 - (item.key ^ last).leading_zeros();
            self.buckets[bucket as usize].push(item);
            occupied |= 1 << bucket;
        }
        self.occupied = occupied;
    }

    /// Drops the items for which `keep` is false.
    pub(crate) fn retain(&mut self, mut keep: impl FnMut(&Item) -> bool) {
        for (index, bucket) in self.buckets.iter_mut().enumerate() {
            bucket.retain(&mut keep);
            if bucket.count == 0 {
                self.occupied &= !(1 << index);
            }
        }
    }

    /// Items waiting, in any order.
    pub(crate) fn items(&self) -> impl Iterator<Item = &Item> {
        self.buckets.iter().flat_map(Bucket::items)
    }

    /// How many items are waiting.
    pub(crate) fn len(&self) -> usize {
        self.buckets.iter().map(|bucket| bucket.count).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::Random;

    /// Each item leaves eight with the same key, ten levels deep: the queue holds the siblings along one path.
    #[test]
    fn equal_keys_are_searched_depth_first() {
        let (mut queue, mut batch) = (Queue::new(), Bucket::EMPTY);
        queue.push(Item { key: 7, boxes: [10, 0], next: 0 });
        let (mut most, mut taken) = (0, 0);
        while taken < 10_000 && queue.take(&mut batch, 4).is_some() {
            for item in batch.items() {
                taken += 1;
                for _ in 0..if item.boxes[0] > 0 { 8 } else { 0 } {
                    queue.push(Item { key: 7, boxes: [item.boxes[0] - 1, 0], next: 0 });
                }
            }
            most = queue.len().max(most);
        }
        assert!(taken >= 10_000 && most <= 10 * 8 * 4, "{most} items waiting");
    }

    #[test]
    fn no_live_key_is_below_the_one_handed_out() {
        let mut random = Random(7);
        let mut next = move || (random.bits() >> 33) as u32;
        for target in [1, 4, 16, 64] {
            let mut queue = Queue::new();
            let mut live = std::collections::BTreeMap::new();
            let mut batch = Bucket::EMPTY;
            for _ in 0..50 {
                let key = next() >> 3;
                queue.push(Item { key, boxes: [0; 2], next: 0 });
                *live.entry(key).or_insert(0) += 1;
            }
            let mut taken = 0;
            while let Some(least) = queue.take(&mut batch, target) {
                assert_eq!(Some(&least), live.keys().next());
                assert!(batch.items().len() <= target);
                for item in batch.items() {
                    assert!(item.key >= least);
                    let count = live.get_mut(&item.key).unwrap();
                    *count -= 1;
                    if *count == 0 {
                        live.remove(&item.key);
                    }
                    taken += 1;
                    if taken < 3000 {
                        for shift in [4, 12, 20] {
                            let key = item.key + (next() >> shift);
                            queue.push(Item { key, boxes: [0; 2], next: 0 });
                            *live.entry(key).or_insert(0) += 1;
                        }
                    }
                }
                assert_eq!(queue.len(), live.values().sum::<usize>());
            }
            assert!(live.is_empty() && taken > 3000);
        }
    }
}
