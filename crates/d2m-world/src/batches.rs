//! How many items a thread takes at a time.

/// Boxes: one takes a fraction of a microsecond, waking a thread several.
pub(crate) const BOXES: usize = 64;
/// Pair queries: one takes microseconds at least.
pub(crate) const PAIRS: usize = 2;
