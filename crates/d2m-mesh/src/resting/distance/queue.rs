//! Pairs of boxes, the closest first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A pair of boxes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Item {
    /// Lower bound of their distance.
    pub(super) key: f32,
    pub(super) pair: [u32; 2],
    /// Of the direction that the bound was computed with.
    pub(super) version: u32,
}

/// Pairs of boxes that wait, by their keys. Keys are not negative, so their bits are in the order of the numbers.
pub(super) struct Queue(BinaryHeap<Reverse<u128>>);

impl Default for Queue {
    fn default() -> Self {
        // Room for what most queries need.
        Self(BinaryHeap::with_capacity(512))
    }
}

impl Queue {
    #[inline(always)]
    pub(super) fn push(&mut self, item: Item) {
        let Item { key, pair, version } = item;
        let number = |word: u32, place: u32| u128::from(word) << (32 * place);
        self.0.push(Reverse(
            number(key.to_bits(), 3) | number(pair[0], 2) | number(pair[1], 1) | number(version, 0),
        ));
    }

    #[inline(always)]
    pub(super) fn pop(&mut self) -> Option<Item> {
        let Reverse(packed) = self.0.pop()?;
        let word = |place: u32| (packed >> (32 * place)) as u32;
        Some(Item { key: f32::from_bits(word(3)), pair: [word(2), word(1)], version: word(0) })
    }

    pub(super) fn least_key(&self) -> Option<f32> {
        self.0.peek().map(|Reverse(packed)| f32::from_bits((packed >> 96) as u32))
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }
}
