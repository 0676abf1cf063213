//! Rigorous, fast, portable interval arithmetic: outward-rounded in every operation, no_std.
#![cfg_attr(not(feature = "std"), no_std)]
mod arith;
mod compare;
mod elementary;
mod error;
mod interval;
mod mat3;
mod round;
#[cfg(feature = "serde")]
mod serde_form;
mod set_ops;
mod simd;
mod vec3;
mod x4;

pub use compare::Overlap;
pub use error::IntervalError;
pub use interval::Interval;
pub use mat3::IntervalMat3;
pub use vec3::IntervalVec3;
pub use x4::{IntervalVec3X4, IntervalX4};

#[cfg(test)]
mod tests;
