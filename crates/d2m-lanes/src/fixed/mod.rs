//! Two and four doubles in the vector registers of the target that the program is compiled for.
//!
//! Every back end has the same methods and the same bits as [`scalar`], which tests compare them with.
//! The feature `scalar` forces the scalar twin.

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

mod quad;
pub use quad::F64x4;

#[cfg(any(test, not(feature = "std")))]
#[allow(dead_code)] // where a vector unit has square roots
mod soft_sqrt;

/// What kernels need that work on two or four doubles alike.
pub trait Vector: Copy {
    fn splat(x: f64) -> Self;
    fn plus(self, o: Self) -> Self;
    fn minus(self, o: Self) -> Self;
    fn times(self, o: Self) -> Self;
}

macro_rules! vector {
    ($($name:ident)*) => {$(
        impl Vector for $name {
            #[inline(always)]
            fn splat(x: f64) -> Self {
                Self::splat(x)
            }
            #[inline(always)]
            fn plus(self, o: Self) -> Self {
                self.plus(o)
            }
            #[inline(always)]
            fn minus(self, o: Self) -> Self {
                self.minus(o)
            }
            #[inline(always)]
            fn times(self, o: Self) -> Self {
                self.times(o)
            }
        }
    )*};
}
vector!(F64x2 F64x4);

/// Correctly rounded square root of one number.
#[inline(always)]
pub fn sqrt(x: f64) -> f64 {
    F64x2::splat(x).sqrt().first()
}

#[cfg(test)]
mod tests;
