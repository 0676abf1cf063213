//! Places of few of many things in a list.

use core::num::NonZeroU32;

/// The places in a list of those of many things that are in it: a hash table with open addressing, so that all costs as much as what is in
/// the list, in memory and in time, whatever there is besides. At most half of it is in use.
pub(super) struct Places {
    /// Things and their places, one more than where they are; a power of two of them.
    slots: Vec<(u32, Option<NonZeroU32>)>,
    used: usize,
}

/// Slots of an empty table.
const FEWEST: usize = 64;

impl Places {
    pub(super) fn none() -> Self {
        Self { slots: vec![(0, None); FEWEST], used: 0 }
    }

    /// Where a thing is.
    #[inline]
    pub(super) fn get(&self, thing: u32) -> Option<usize> {
        let (_, next) = self.slots[self.slot_of(thing)];
        next.map(|next| next.get() as usize - 1)
    }

    /// A thing is the last one of a list of this length now, unless it is in the list: then this says no.
    pub(super) fn insert_last(&mut self, thing: u32, length: usize) -> bool {
        let slot = self.slot_of(thing);
        if self.slots[slot].1.is_some() {
            return false;
        }
        self.slots[slot] = (thing, NonZeroU32::new(length as u32));
        self.used += 1;
        if 2 * self.used > self.slots.len() {
            self.grow();
        }
        true
    }

    /// The slot of a thing, or the free one that it would have.
    #[inline]
    fn slot_of(&self, thing: u32) -> usize {
        let last = self.slots.len() - 1;
        // Fibonacci's multiplier: the high bits depend on all of the thing's.
        let hash = u64::from(thing).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32;
        let mut slot = hash as usize & last;
        while let (other, Some(_)) = self.slots[slot]
            && other != thing
        {
            slot = (slot + 1) & last;
        }
        slot
    }

    fn grow(&mut self) {
        let free = vec![(0, None); 2 * self.slots.len()];
        for (thing, place) in core::mem::replace(&mut self.slots, free) {
            if place.is_some() {
                let slot = self.slot_of(thing);
                self.slots[slot] = (thing, place);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};

    /// Against a table of all things; also of more things than 2³² steps apart would fill.
    #[test]
    fn places_are_those_of_a_list_of_all() {
        let mut random = KnuthRandom(3);
        for (count, stride) in [(40, 1), (3000, 1), (3000, 8), (3000, 1 << 19)] {
            let (mut places, mut all, mut length) = (Places::none(), vec![None; count as usize], 0);
            for _ in 0..2 * count {
                let thing = random.index(count as usize) as u32;
                let known = all[thing as usize];
                assert_eq!(places.get(thing * stride), known);
                if places.insert_last(thing * stride, length + 1) {
                    assert!(known.is_none());
                    all[thing as usize] = Some(length);
                    length += 1;
                } else {
                    assert!(known.is_some());
                }
            }
            assert!((0..count).all(|k| places.get(k * stride) == all[k as usize]));
            assert!(places.slots.len() <= 4 * length + FEWEST, "{} for {length}", places.slots.len());
        }
    }
}
