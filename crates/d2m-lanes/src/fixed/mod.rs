//! Two and four doubles in the vector registers of the target that the program is compiled for.
//!
//! Every back end has the same methods and the same bits as [`scalar`], which tests compare them with.
//! The feature `scalar` forces the scalar twin.

use core::ops::{Add, Mul, Sub};

/// Implements the operators of two numbers, then the negative of one, by what they do in a back end.
macro_rules! operators {
    ($type:ident: $($operator:ident $method:ident |$a:ident, $b:ident| $result:expr),*; |$c:ident| $negative:expr) => {
        $(impl core::ops::$operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let ($a, $b) = (self, other);
                $result
            }
        })*
        impl core::ops::Neg for $type {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                let $c = self;
                $negative
            }
        }
    };
}

#[cfg(any(
    test,
    miri,
    feature = "scalar",
    not(any(
        target_arch = "x86_64",
        all(target_arch = "aarch64", target_feature = "neon"),
        all(target_arch = "wasm32", target_feature = "simd128")
    ))
))]
#[allow(unreachable_pub)] // where tests alone use it
mod scalar;

#[cfg(all(target_arch = "x86_64", not(miri), not(feature = "scalar")))]
mod sse2;
#[cfg(all(target_arch = "x86_64", not(miri), not(feature = "scalar")))]
pub use sse2::F64x2;

#[cfg(all(target_arch = "aarch64", target_feature = "neon", not(miri), not(feature = "scalar")))]
mod neon;
#[cfg(all(target_arch = "aarch64", target_feature = "neon", not(miri), not(feature = "scalar")))]
pub use neon::F64x2;

#[cfg(all(target_arch = "wasm32", target_feature = "simd128", not(miri), not(feature = "scalar")))]
mod wasm;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128", not(miri), not(feature = "scalar")))]
pub use wasm::F64x2;

#[cfg(any(
    miri,
    feature = "scalar",
    not(any(
        target_arch = "x86_64",
        all(target_arch = "aarch64", target_feature = "neon"),
        all(target_arch = "wasm32", target_feature = "simd128")
    ))
))]
pub use scalar::F64x2;

mod four;
pub use four::F64x4;

#[cfg(any(test, not(feature = "std")))]
#[allow(dead_code)] // where a vector unit has square roots
mod soft_sqrt;

/// What kernels need that work on two or four doubles alike.
pub trait Vector: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    fn splat(x: f64) -> Self;
}

impl Vector for F64x2 {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self::splat(x)
    }
}

impl Vector for F64x4 {
    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self::splat(x)
    }
}

/// Correctly rounded square root of one number.
#[inline(always)]
pub fn sqrt(x: f64) -> f64 {
    F64x2::splat(x).sqrt().first()
}

#[cfg(test)]
mod tests;
