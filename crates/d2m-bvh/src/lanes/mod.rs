//! Vector registers of several numbers, and the choice of the processor's instructions. Every choice gives the same bits.

#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod dispatch;
mod eight;
mod instruction_set;
mod portable;
mod quad;
mod two;

pub(crate) use dispatch::{Task, run, run_on};
pub(crate) use eight::{Lanes, Rows};
pub use instruction_set::InstructionSet;
#[cfg(test)]
pub(crate) use portable::Portable;
pub(crate) use quad::{Doubles, Matrix, Quad, QuadVec};
pub(crate) use two::{Bytes, Elementwise, Two};
