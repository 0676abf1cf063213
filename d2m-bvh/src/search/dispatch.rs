//! Choice of the vector instructions at run time. Every choice gives the same bits.

use super::lanes::Portable;
use super::scene::{Scene, Scratch};
use super::window::{Outcome, Search};
use crate::QueryOptions;

/// Instruction sets that the search is compiled for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Isa {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Isa {
    /// All that this processor has.
    #[cfg(test)]
    pub(crate) fn all() -> Vec<Self> {
        match Self::best() {
            Self::Portable => vec![Self::Portable],
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => vec![Self::Portable, Self::Avx2],
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => vec![Self::Portable, Self::Avx2, Self::Avx512],
        }
    }

    /// The best one of this processor.
    pub(crate) fn best() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            if std::arch::is_x86_feature_detected!("avx512vl")
                && std::arch::is_x86_feature_detected!("avx512f")
            {
                return Self::Avx512;
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                return Self::Avx2;
            }
        }
        Self::Portable
    }
}

/// Searches the window of the scene for the first contact.
pub(crate) fn first_contact(scene: &Scene<'_>, options: &QueryOptions, scratch: &mut Scratch) -> Outcome {
    first_contact_on(Isa::best(), scene, options, scratch)
}

/// The same with a given instruction set, which the processor must have.
#[allow(unsafe_code)]
pub(crate) fn first_contact_on(
    isa: Isa,
    scene: &Scene<'_>,
    options: &QueryOptions,
    scratch: &mut Scratch,
) -> Outcome {
    match isa {
        Isa::Portable => Search::new(scene, options, scratch).run::<Portable>(),
        // SAFETY: `Isa::best` found the feature on this processor (tests ask only for sets that it names).
        #[cfg(target_arch = "x86_64")]
        Isa::Avx2 => unsafe { avx2(scene, options, scratch) },
        // SAFETY: as above.
        #[cfg(target_arch = "x86_64")]
        Isa::Avx512 => unsafe { avx512(scene, options, scratch) },
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
fn avx2(scene: &Scene<'_>, options: &QueryOptions, scratch: &mut Scratch) -> Outcome {
    Search::new(scene, options, scratch).run::<super::lanes::Avx>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,avx512f,avx512vl,bmi1,bmi2,lzcnt,popcnt")]
fn avx512(scene: &Scene<'_>, options: &QueryOptions, scratch: &mut Scratch) -> Outcome {
    Search::new(scene, options, scratch).run::<super::lanes::Avx>()
}
