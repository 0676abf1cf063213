//! Work on many items, with the answers in the order of the items.

/// `work` of each item, in order: on all threads of the current rayon pool with the feature `rayon`. The same bits at any
/// number of threads, because nothing depends on which item is done first.
pub(crate) fn map_in_order<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    if items.len() > 1 {
        use rayon::prelude::*;
        return items.par_iter().map(work).collect();
    }
    items.iter().map(work).collect()
}
