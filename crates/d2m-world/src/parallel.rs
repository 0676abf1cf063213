//! Work on many items, with the answers in the order of the items.

/// Boxes at a time: one takes a fraction of a microsecond, waking a thread several.
pub(crate) const BOXES: usize = 64;
/// Pair queries at a time: one takes microseconds at least.
pub(crate) const PAIRS: usize = 2;

/// `work` of each item, in order: on all threads of the current rayon pool with the feature `rayon`, at least `least` items
/// at a time. The same bits at any number of threads, because nothing depends on which item is done first.
pub(crate) fn map_in_order<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    work: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    #[cfg(feature = "rayon")]
    if items.len() > least && rayon::current_num_threads() > 1 {
        use rayon::prelude::*;
        return items.par_iter().with_min_len(least).map(work).collect();
    }
    #[cfg(not(feature = "rayon"))]
    let _ = least;
    items.iter().map(work).collect()
}
