//! Lanes that are chosen when the program runs, and the choice of the processor's instructions. Every choice gives the same bits.

#[cfg(target_arch = "x86_64")]
mod avx;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod dispatch;
mod eight;
mod instruction_set;
mod portable;
mod portable_doubles;
mod quad;
#[cfg(target_arch = "x86_64")]
mod register;
pub mod three;
mod two;

pub use dispatch::{Task, run, run_on};
pub use eight::{Keys, Lanes, Rows, SingleSide, WideSide};
pub use instruction_set::InstructionSet;
pub use portable::Portable;
pub use quad::{Doubles, Matrix, Quad, QuadVec};
pub use two::{Bytes, Elementwise, Two};
