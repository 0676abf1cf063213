//! Rigorous, fast, portable interval arithmetic: outward-rounded in every operation, no_std.
#![cfg_attr(not(feature = "std"), no_std)]
mod arith;
mod error;
mod interval;
mod mat3;
mod round;
mod set_ops;
mod trig;
mod vec3;

pub use error::IntervalError;
pub use interval::Interval;
pub use mat3::IntervalMat3;
pub use vec3::IntervalVec3;

#[cfg(test)]
mod tests;
