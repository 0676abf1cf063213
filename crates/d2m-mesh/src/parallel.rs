//! Work on several threads with answers in the order of the work: the same bits at any number of threads.

/// Both answers: on two threads of the current rayon pool with the feature `rayon`.
pub(crate) fn both<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "rayon")]
    return rayon::join(first, second);
    #[cfg(not(feature = "rayon"))]
    (first(), second())
}

/// Triangles, or vertices, from which on two threads are worth waking: a tree of so many takes two milliseconds.
const MANY: usize = 4096;

/// As [`both`], side by side where the work is on many triangles.
pub(crate) fn both_of_many<A: Send, B: Send>(
    triangles: usize,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if triangles > MANY { both(first, second) } else { (first(), second()) }
}

/// `work` of each item, in order: on all threads of the current rayon pool with the feature `rayon`.
pub(crate) fn map_in_order<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    {
        use rayon::prelude::*;
        items.par_iter().map(work).collect()
    }
    #[cfg(not(feature = "rayon"))]
    items.iter().map(work).collect()
}

/// As [`map_in_order`], on several threads where the items are many.
pub(crate) fn map_of_many<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    if items.len() > MANY { map_in_order(items, work) } else { items.iter().map(work).collect() }
}
