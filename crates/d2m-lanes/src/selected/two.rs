//! What is done lane by lane, and twice as many lanes: one register where the processor has one that is wide enough,
//! else two.

use core::ops::{Add, Mul, Sub};

/// What is done in each lane by itself.
pub trait Elementwise: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// What one lane holds.
    type Scalar: Copy;

    /// The same value in each lane.
    fn splat(value: Self::Scalar) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// `if self > other { self } else { other }` in each lane (so `other` when one is NaN).
    fn max(self, other: Self) -> Self;
    /// `if self < other { self } else { other }` in each lane (so `other` when one is NaN).
    fn min(self, other: Self) -> Self;
    /// `magnitude` with its sign flipped where `sign` is negative (or −0).
    fn flip_sign(magnitude: Self, sign: Self) -> Self;
    /// `if left > right { yes } else { no }` in each lane.
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self;
}

/// Lanes of `f32` that may also hold four bytes each, as the bits of a number that is no NaN.
pub trait Bytes: Elementwise<Scalar = f32> {
    /// As a number, byte (x < 0) + 2·(y < 0) of the four bytes in each lane, counted from the lowest one. Signs are those
    /// of zeros, too, and count as flipped where that of `flip` is negative.
    fn byte_of(self, x: Self, y: Self, flip: Self) -> Self;
}

impl<L: Bytes> Bytes for Both<L> {
    #[inline(always)]
    fn byte_of(self, x: Self, y: Self, flip: Self) -> Self {
        Self(self.0.byte_of(x.0, y.0, flip.0), self.1.byte_of(x.1, y.1, flip.1))
    }
}

/// Two times the lanes of `L`.
pub trait Two<L: Elementwise>: Elementwise<Scalar = L::Scalar> {
    /// From both halves.
    fn of(first: L, second: L) -> Self;
    /// The same lanes twice.
    fn both(half: L) -> Self;
    /// The first half.
    fn first(self) -> L;
    /// The second half.
    fn second(self) -> L;
}

/// Two registers side by side.
#[derive(Clone, Copy)]
pub struct Both<L>(L, L);

macro_rules! both_operator {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl<L: Elementwise> $operator for Both<L> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $symbol other.0, self.1 $symbol other.1)
            }
        }
    )*};
}
both_operator!(Add add +, Sub sub -, Mul mul *);

impl<L: Elementwise> Elementwise for Both<L> {
    type Scalar = L::Scalar;

    #[inline(always)]
    fn splat(value: L::Scalar) -> Self {
        Self(L::splat(value), L::splat(value))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs(), self.1.abs())
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0), self.1.max(other.1))
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0), self.1.min(other.1))
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        Self(L::flip_sign(magnitude.0, sign.0), L::flip_sign(magnitude.1, sign.1))
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        Self(L::if_greater(left.0, right.0, yes.0, no.0), L::if_greater(left.1, right.1, yes.1, no.1))
    }
}

impl<L: Elementwise> Two<L> for Both<L> {
    #[inline(always)]
    fn of(first: L, second: L) -> Self {
        Self(first, second)
    }
    #[inline(always)]
    fn both(half: L) -> Self {
        Self(half, half)
    }
    #[inline(always)]
    fn first(self) -> L {
        self.0
    }
    #[inline(always)]
    fn second(self) -> L {
        self.1
    }
}
