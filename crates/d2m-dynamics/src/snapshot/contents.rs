//! What a snapshot holds besides numbers.

/// What proofs depend on, or follow from. It is held in memory, and not written: a snapshot that is read has
/// none of it.
#[derive(Clone)]
pub(crate) struct Held<T>(pub(crate) Option<T>);

impl<T> Default for Held<T> {
    fn default() -> Self {
        Self(None)
    }
}

/// Snapshots are compared by their numbers.
impl<T> PartialEq for Held<T> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<T> core::fmt::Debug for Held<T> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_tuple("Held").field(&self.0.is_some()).finish()
    }
}

/// The source of the numbers of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The same bodies: proofs about them still hold.
    Held,
    /// A file, or other bodies: nothing is proven.
    Read,
}
