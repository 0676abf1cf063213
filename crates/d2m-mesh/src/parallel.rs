//! Work on several threads of the current rayon pool with the feature `rayon`, with the answers in the order of the work: the same bits at any
//! number of threads, because nothing depends on which item is done first.

/// Both answers: on two threads.
pub(crate) fn both<A: Send, B: Send>(
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "rayon")]
    return rayon::join(first, second);
    #[cfg(not(feature = "rayon"))]
    (first(), second())
}

/// Does one thread do all there is?
pub(crate) fn is_alone() -> bool {
    #[cfg(feature = "rayon")]
    return rayon::current_num_threads() == 1;
    #[cfg(not(feature = "rayon"))]
    true
}

/// Triangles, or vertices, from which on two threads are worth waking: a tree of so many takes two milliseconds.
pub(crate) const MANY: usize = 4096;

/// As [`both`], side by side where the work is on many triangles.
pub(crate) fn both_of_many<A: Send, B: Send>(
    triangles: usize,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B + Send,
) -> (A, B) {
    if triangles > MANY { both(first, second) } else { (first(), second()) }
}

/// `work` of each item, in order: on all threads if there are more items than `least`, as many as that at a time.
///
/// ```
/// assert_eq!(d2m_mesh::parallel::map_in_order(&[1, 2, 3], 1, |number| 10 * number), [10, 20, 30]);
/// ```
pub fn map_in_order<T: Sync, R: Send>(
    items: &[T],
    least: usize,
    work: impl Fn(&T) -> R + Sync + Send,
) -> Vec<R> {
    #[cfg(feature = "rayon")]
    if items.len() > least && rayon::current_num_threads() > 1 {
        use rayon::prelude::*;
        return items.par_iter().with_min_len(least).map(work).collect();
    }
    let _ = least;
    items.iter().map(work).collect()
}

/// As [`map_in_order`], of items that the work takes: on all threads if there are more than `few`, one at a time.
///
/// ```
/// let words = vec!["one".to_owned(), "two".to_owned()];
/// assert_eq!(d2m_mesh::parallel::map_owned(words, 1, |word| word + "!"), ["one!", "two!"]);
/// ```
pub fn map_owned<T: Send, R: Send>(items: Vec<T>, few: usize, work: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "rayon")]
    if items.len() > few && rayon::current_num_threads() > 1 {
        use rayon::prelude::*;
        return items.into_par_iter().map(work).collect();
    }
    let _ = few;
    items.into_iter().map(work).collect()
}
