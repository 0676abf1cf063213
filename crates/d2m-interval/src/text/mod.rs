//! Intervals as text.
mod big;
mod display;
mod number;
mod parse;
#[cfg(feature = "serde")]
mod serial;
