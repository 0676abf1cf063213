//! What is done lane by lane in a vector register of x86-64, of any width and of either kind of number.

/// Implements the operators and [`Elementwise`](super::two::Elementwise) of a register type, which has a function `wrap`, by
/// the intrinsics of its width. Values of the type exist only inside functions that were entered through a check of the
/// processor for these intrinsics.
macro_rules! register {
    (
        [$($generics:tt)*] $type:ty, $scalar:ty:
        $add:ident $sub:ident $mul:ident $splat:ident $max:ident $min:ident $xor:ident $and:ident,
        |$x:ident| $abs:expr, |$left:ident, $right:ident, $yes:ident, $no:ident| $select:expr
    ) => {
        register!([$($generics)*] $type: Add add $add);
        register!([$($generics)*] $type: Sub sub $sub);
        register!([$($generics)*] $type: Mul mul $mul);

        impl $($generics)* Elementwise for $type {
            type Scalar = $scalar;

            #[inline(always)]
            fn splat(value: $scalar) -> Self {
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $splat(value) })
            }
            #[inline(always)]
            fn abs(self) -> Self {
                let $x = self.0;
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $abs })
            }
            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $max(self.0, other.0) })
            }
            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $min(self.0, other.0) })
            }
            #[inline(always)]
            fn flip_sign(magnitude: Self, sign: Self) -> Self {
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $xor(magnitude.0, $and(sign.0, $splat(-0.0))) })
            }
            #[inline(always)]
            fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
                let ($left, $right, $yes, $no) = (left.0, right.0, yes.0, no.0);
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $select })
            }
        }
    };
    ([$($generics:tt)*] $type:ty: $operator:ident $method:ident $intrinsic:ident) => {
        impl $($generics)* $operator for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the processor has the intrinsics (see the type).
                Self::wrap(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    };
}
pub(super) use register;
