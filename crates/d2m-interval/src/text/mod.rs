//! Intervals as text.
mod big;
mod display;
mod number;
mod parse;
#[cfg(feature = "serde")]
mod serial;

/// An end of an interval.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Lower,
    Upper,
}
