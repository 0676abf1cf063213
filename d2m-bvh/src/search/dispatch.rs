//! Runs the search with the vector instructions in use. Every choice gives the same bits.

use super::InstructionSet;
use super::lanes::Portable;
use super::scene::{Scene, Scratch};
use super::window::{Outcome, Search};
#[cfg(target_arch = "x86_64")]
use super::{
    avx::{Avx, Of256},
    avx512::Of512,
};
use crate::QueryOptions;

/// Searches the window of the scene for the first contact.
pub(crate) fn first_contact(scene: &Scene<'_>, options: &QueryOptions, scratch: &mut Scratch) -> Outcome {
    first_contact_on(InstructionSet::in_use(), scene, options, scratch)
}

/// The same with a given instruction set, which the processor must have.
pub(crate) fn first_contact_on(
    set: InstructionSet,
    scene: &Scene<'_>,
    options: &QueryOptions,
    scratch: &mut Scratch,
) -> Outcome {
    search_on(set, Search::new(scene, options, scratch))
}

/// Runs a search with a given instruction set, which the processor must have.
#[allow(unsafe_code)]
pub(super) fn search_on(set: InstructionSet, search: Search<'_>) -> Outcome {
    match set {
        // SAFETY: `InstructionSet::in_use` found the features on this processor (tests ask only for available sets).
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx2 => unsafe { avx2(search) },
        // SAFETY: the same.
        #[cfg(target_arch = "x86_64")]
        InstructionSet::Avx512 => unsafe { avx512(search) },
        _ => search.run::<Portable>(),
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn avx2(search: Search<'_>) -> Outcome {
    search.run::<Avx<Of256>>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512bw,avx512dq,avx512vbmi2")]
fn avx512(search: Search<'_>) -> Outcome {
    search.run::<Avx<Of512>>()
}
