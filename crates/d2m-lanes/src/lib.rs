#![doc = include_str!("../README.md")]
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
    SingleSide, Task, Two, WideSide, run, run_on,
};
