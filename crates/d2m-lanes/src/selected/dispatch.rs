//! Runs a piece of work with the vector instructions in use. Every choice gives the same bits.

use super::InstructionSet;
use super::eight::Lanes;
use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::{
    avx::{Avx, Of256},
    avx512::Of512,
};

/// A piece of work that is compiled once for each kind of lanes.
///
/// What is not `#[inline(always)]` all the way down, closures among it, is compiled for the plainest processor.
pub trait Task {
    /// What it returns.
    type Output;
    /// Does it.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does the task with the instruction set in use.
pub fn run<T: Task>(task: T) -> T::Output {
    run_on(InstructionSet::in_use(), task)
}

/// The same with a given instruction set, or the best of the processor if it does not have that one.
#[allow(unsafe_code)]
pub fn run_on<T: Task>(set: InstructionSet, task: T) -> T::Output {
    match set.min(InstructionSet::best()) {
        // SAFETY: `InstructionSet::best` found the features on this processor.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => unsafe { avx2(task) },
        // SAFETY: the same.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => unsafe { avx512(task) },
        _ => task.run::<Portable>(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn avx2<T: Task>(task: T) -> T::Output {
    task.run::<Avx<Of256>>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512bw,avx512dq,avx512vbmi2")]
fn avx512<T: Task>(task: T) -> T::Output {
    task.run::<Avx<Of512>>()
}
