//! Rest: for how long bodies have been quiet, and which sleep.
pub(crate) mod quiet;
pub(crate) mod sleep;
