//! Places of few of many things in a list.

use core::num::NonZeroU32;

/// The places in a list of those of many things that are in it. Memory of the others is not touched: there may be millions.
pub(super) struct Places(Vec<Option<NonZeroU32>>);

impl Places {
    /// Of so many things, none of which is in the list.
    pub(super) fn none_of(count: usize) -> Self {
        Self(vec![None; count])
    }

    /// Where a thing is.
    pub(super) fn get(&self, thing: usize) -> Option<usize> {
        self.0[thing].map(|next| next.get() as usize - 1)
    }

    /// A thing is the last one of a list of this length now.
    pub(super) fn set_last(&mut self, thing: usize, length: usize) {
        self.0[thing] = NonZeroU32::new(length as u32);
    }
}
