//! Intervals as text.
mod big;
mod display;
mod parse;
#[cfg(feature = "serde")]
mod serial;
