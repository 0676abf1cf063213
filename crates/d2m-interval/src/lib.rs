#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Start here
//! [`Interval`] is one interval, and every operation is its method; [`interval!`] encloses a decimal that is
//! written in the code.
//!
//! ## Vectors and matrices
//! With the feature `glam` (on by default): [`IntervalVec3`] is a box of vectors, [`IntervalMat3`] a matrix
//! of intervals.
//!
//! ## Four at a time
//! [`IntervalX4`] and [`IntervalVec3X4`] have the bits of four single calls.
//!
//! ## Comparing
//! [`Overlap`] says how two intervals lie on the line; the comparisons themselves are methods of
//! [`Interval`].
//!
//! ## Errors
//! [`IntervalError`]: two numbers that are no interval. [`ParseIntervalError`]: a text that is none.
#![doc(html_root_url = "https://docs.rs/d2m-interval")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![forbid(unsafe_code)]
#![no_std]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

mod arith;
mod compare;
mod elementary;
mod error;
mod interval;
#[cfg(feature = "glam")]
mod mat3;
mod round;
mod set_ops;
mod text;
#[cfg(feature = "glam")]
mod vec3;
#[cfg(feature = "glam")]
mod vec3_x4;
mod x4;

pub use compare::Overlap;
pub use error::{IntervalError, ParseIntervalError};
pub use interval::Interval;
#[cfg(feature = "glam")]
pub use mat3::IntervalMat3;
#[cfg(feature = "glam")]
pub use vec3::IntervalVec3;
#[cfg(feature = "glam")]
pub use vec3_x4::IntervalVec3X4;
pub use x4::IntervalX4;

/// The narrowest interval that holds the number or interval that is written: `interval!(0.1)`, `interval!("1/3")`,
/// `interval!("[0.1, 0.2]")`; with two arguments, [`Interval::new`].
///
/// # Panics
/// When the text is not an interval.
///
/// ```
/// use d2m_interval::{Interval, interval};
/// let tenth = interval!(0.1);
/// assert!((tenth * 10.0).contains(1.0) && tenth.lo() < tenth.hi());
/// assert_eq!(interval!("[1, 2]"), interval!(1.0, 2.0));
/// ```
#[macro_export]
macro_rules! interval {
    ($text:literal) => {
        match <$crate::Interval as ::core::str::FromStr>::from_str(::core::concat!($text)) {
            Ok(interval) => interval,
            Err(error) => panic!("{error}: {}", ::core::concat!($text)),
        }
    };
    ($lo:expr, $hi:expr) => {
        $crate::Interval::new($lo, $hi)
    };
}

#[cfg(all(test, feature = "glam"))]
mod tests;
