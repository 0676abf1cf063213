//! Which vector instructions queries use. Every choice gives the same bits.

use core::sync::atomic::{AtomicU8, Ordering};
use std::vec::Vec;

/// Vector instructions that queries are compiled for, the plainest first.
///
/// A query uses the best set of the processor. The choice changes its time and nothing else: every answer has the same
/// bits. So the limit below is one of the process and not an option of each query. It serves to measure what the
/// instructions are worth, and to run under an emulator (valgrind, an old virtual machine) that promises instructions
/// which it does not have.
///
/// ```
/// use d2m_lanes::InstructionSet;
/// InstructionSet::Portable.limit();
/// assert_eq!(InstructionSet::in_use(), InstructionSet::Portable);
/// InstructionSet::Avx512.limit(); // again the best that there is
/// assert_eq!(Some(&InstructionSet::in_use()), InstructionSet::available().last());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum InstructionSet {
    /// What the target of the build has: SSE2 on x86-64.
    Portable,
    /// AVX2 with BMI, LZCNT and POPCNT, on x86-64.
    Avx2,
    /// AVX-512 F, VL, BW, DQ and VBMI2 besides, on x86-64: 32 registers of 256 bits and masks. VBMI2 stands for the
    /// processors on which that is faster (Ice Lake, Zen 4 and later); on those before it is slower than AVX2.
    Avx512,
}

const ALL: [InstructionSet; 3] = [InstructionSet::Portable, InstructionSet::Avx2, InstructionSet::Avx512];

/// Index into [`ALL`] of the best one of this processor, once it is known.
static FOUND: AtomicU8 = AtomicU8::new(UNKNOWN);
const UNKNOWN: u8 = u8::MAX;

/// Index into [`ALL`].
static LIMIT: AtomicU8 = AtomicU8::new(2);

impl InstructionSet {
    /// The sets that this processor has; the first is always [`InstructionSet::Portable`].
    pub fn available() -> Vec<Self> {
        let best = Self::best();
        ALL.into_iter().filter(|set| *set <= best).collect()
    }

    /// The set that queries use now: the best of this processor up to the limit.
    #[inline]
    pub fn in_use() -> Self {
        Self::best().min(ALL[usize::from(LIMIT.load(Ordering::Relaxed))])
    }

    /// From now on no query of this process uses a higher set than this one; no answer changes.
    pub fn limit(self) {
        LIMIT.store(self as u8, Ordering::Relaxed);
    }

    /// The best one of this processor.
    #[inline]
    pub(super) fn best() -> Self {
        match FOUND.load(Ordering::Relaxed) {
            UNKNOWN => {
                let best = Self::find();
                FOUND.store(best as u8, Ordering::Relaxed);
                best
            }
            found => ALL[usize::from(found)],
        }
    }

    #[cold]
    fn find() -> Self {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::is_x86_feature_detected as has;
            if has!("avx2") && has!("bmi1") && has!("bmi2") && has!("lzcnt") && has!("popcnt") {
                if has!("avx512f")
                    && has!("avx512vl")
                    && has!("avx512bw")
                    && has!("avx512dq")
                    && has!("avx512vbmi2")
                {
                    return Self::Avx512;
                }
                return Self::Avx2;
            }
        }
        Self::Portable
    }
}
