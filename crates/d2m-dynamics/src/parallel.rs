//! One function over many items, on the threads of the current rayon pool; the answers in the order of the items.

/// Items below which threads cost more than they save.
#[cfg(feature = "rayon")]
const FEW: usize = 8;

/// Applies `f` to each item.
#[cfg(feature = "rayon")]
pub(crate) fn map<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    use rayon::prelude::*;
    if items.len() < FEW || rayon::current_num_threads() == 1 {
        return items.into_iter().map(f).collect();
    }
    items.into_par_iter().map(f).collect()
}

/// Applies `f` to each item.
#[cfg(not(feature = "rayon"))]
pub(crate) fn map<T, R>(items: Vec<T>, f: impl Fn(T) -> R) -> Vec<R> {
    items.into_iter().map(f).collect()
}
