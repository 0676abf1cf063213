//! Runs a search with the widest vector instructions of the processor. Every choice gives the same bits.

use crate::search::{Isa, Lanes, Portable};

/// A piece of work that is compiled once for each kind of lanes.
pub(crate) trait Task {
    /// What it returns.
    type Output;
    /// Does it.
    fn run<L: Lanes>(self) -> Self::Output;
}

/// Does the task with the best instruction set of this processor.
pub(crate) fn run<T: Task>(task: T) -> T::Output {
    run_on(Isa::best(), task)
}

/// The same with a given instruction set, which the processor must have.
#[allow(unsafe_code)]
pub(crate) fn run_on<T: Task>(isa: Isa, task: T) -> T::Output {
    match isa {
        Isa::Portable => task.run::<Portable>(),
        // SAFETY: `Isa::best` found the features on this processor (tests ask only for sets that it names).
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 => unsafe { avx2(task) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 => unsafe { avx512(task) },
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn avx2<T: Task>(task: T) -> T::Output {
    task.run::<crate::search::Avx>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512vl,bmi1,bmi2,lzcnt,popcnt")]
fn avx512<T: Task>(task: T) -> T::Output {
    task.run::<crate::search::Avx>()
}
