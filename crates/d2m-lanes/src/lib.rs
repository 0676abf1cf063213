#![doc = include_str!("../README.md")]
#![doc = include_str!("../picture.svg")]
//!
//! ## Sums and products without error
//! [`two_sum`], [`fast_two_sum`], [`two_product`], [`DoubleDouble`].
//!
//! ## Exponents and roundings
//! [`Binary`], [`scaled`], [`power_of_two()`], [`power_of_two_above`], [`power_of_two_below`]; [`UNIT`],
//! [`UP`].
//!
//! ## Registers of the target
//! [`F64x2`], [`F64x4`], [`Vector`], [`sqrt`].
//!
//! ## Registers of the processor (feature `selected`)
//! - [`run`] and [`run_on`] do a [`Task`] with an [`InstructionSet`].
//! - [`Lanes`], [`Elementwise`], [`Bytes`], [`Keys`], [`Rows`], [`Portable`]: eight numbers of single
//!   precision.
//! - [`Doubles`], [`Quad`], [`QuadVec`], [`Two`]: four and eight doubles.
//! - [`three`]: vectors of three such.
//! - [`Matrix`], [`SingleSide`], [`WideSide`]: boxes.
#![doc(html_root_url = "https://docs.rs/d2m-lanes")]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![no_std]
#[cfg(any(test, feature = "std"))]
extern crate std;

mod binary;
mod double_double;
mod exact;
#[allow(unsafe_code)] // the vector instructions of each target
#[allow(missing_docs)] // named after the operation
mod fixed;
mod power_of_two;
mod rounding;
#[cfg(feature = "selected")]
mod selected;

pub use binary::{Binary, scaled};
pub use double_double::DoubleDouble;
pub use exact::{fast_two_sum, two_product, two_sum};
pub use fixed::{F64x2, F64x4, Vector, sqrt};
pub use power_of_two::{power_of_two, power_of_two_above, power_of_two_below};
pub use rounding::{UNIT, UP};
#[cfg(feature = "selected")]
pub use selected::{
    Bytes, Doubles, Elementwise, InstructionSet, Keys, Lanes, Matrix, Portable, Quad, QuadVec, Rows,
    SingleSide, Task, Two, WideSide, run, run_on, three,
};
