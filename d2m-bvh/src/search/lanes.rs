//! Eight `f32` lanes: what the searches ask of an instruction set, and the portable array.
//!
//! Only + − × ÷ √, extrema, comparison and sign removal, each correctly rounded by IEEE 754, and no fused
//! multiply-add: every implementation returns the same bits.

use super::expansion::Opened;
use super::quad::{Doubles, Quad};
use super::queue::Item;
use super::two::{Both, Elementwise, Two};
use crate::tree::node::WIDTH;
use core::ops::{Add, Div, Mul, Sub};

/// Eight lanes of `f32`.
pub(crate) trait Lanes: Elementwise<Scalar = f32> + Div<Output = Self> {
    /// Four `f64` of the same instruction set.
    type Doubles: Doubles;
    /// Two times eight lanes.
    type Two: Two<Self>;

    /// Lanes from memory.
    fn load(values: &[f32; 8]) -> Self;
    /// Lanes to memory.
    fn store(self) -> [f32; 8];
    /// Correctly rounded square root.
    fn sqrt(self) -> Self;
    /// Bit i is set when lane i of `self` is less than lane i of `other`.
    fn less_bits(self, other: Self) -> u32;
    /// max(`least`, `base` + the integer part) in each lane, with `least` for what is not a number; and the bits of
    /// the lanes where that is below `limit`. Lanes stay below 2³¹ − `base`.
    fn keys(self, base: i32, least: i32, limit: i32) -> ([i32; 8], u32);
    /// `children | flag` in the lanes where `sizes · ratio > size`, else `other`.
    fn larger(sizes: (&[f32; 8], f32, f32), children: (&[u32; 8], u32), other: u32) -> [u32; 8];
    /// Writes the pairs worth queueing to the start of the list, in the order of their lanes; how many. What is
    /// behind them is of no meaning.
    fn pack(pairs: &Opened, list: &mut [Item; WIDTH]) -> usize;
    /// Asks for the memory of a value: a hint.
    fn prefetch<T>(value: &T);
    /// x·c₀ + y·c₁ + z·c₂ for the columns c of a matrix.
    fn combine(columns: &[[f32; 4]; 3], x: f32, y: f32, z: f32) -> [f32; 4];
}

/// Portable lanes.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(crate) struct Portable([f32; 8]);

impl Portable {
    #[inline(always)]
    fn zip(self, other: Self, op: impl Fn(f32, f32) -> f32) -> Self {
        let mut out = [0.0; 8];
        for (i, value) in out.iter_mut().enumerate() {
            *value = op(self.0[i], other.0[i]);
        }
        Self(out)
    }
}

macro_rules! portable_operator {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl $operator for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $symbol b)
            }
        }
    )*};
}
portable_operator!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Elementwise for Portable {
    type Scalar = f32;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self([value; 8])
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(f32::abs))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.zip(other, |a, b| if a > b { a } else { b })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        self.zip(other, |a, b| if a < b { a } else { b })
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        magnitude.zip(sign, |m, s| f32::from_bits(m.to_bits() ^ (s.to_bits() & 0x8000_0000)))
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        let mut out = no;
        for i in 0..8 {
            out.0[i] = if left.0[i] > right.0[i] { yes.0[i] } else { no.0[i] };
        }
        out
    }
}

impl Lanes for Portable {
    type Doubles = Quad;
    type Two = Both<Self>;

    #[inline(always)]
    fn load(values: &[f32; 8]) -> Self {
        Self(*values)
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        self.0
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(f32::sqrt))
    }
    #[inline(always)]
    fn less_bits(self, other: Self) -> u32 {
        let mut bits = 0;
        for i in 0..8 {
            bits |= u32::from(self.0[i] < other.0[i]) << i;
        }
        bits
    }
    #[inline(always)]
    fn keys(self, base: i32, least: i32, limit: i32) -> ([i32; 8], u32) {
        let (mut out, mut bits) = ([0; 8], 0);
        for (lane, (key, x)) in out.iter_mut().zip(self.0).enumerate() {
            let whole = if x.is_nan() { i32::MIN } else { x as i32 };
            *key = base.wrapping_add(whole).max(least);
            bits |= u32::from(*key < limit) << lane;
        }
        (out, bits)
    }
    #[inline(always)]
    fn larger(
        (sizes, ratio, size): (&[f32; 8], f32, f32),
        (children, flag): (&[u32; 8], u32),
        other: u32,
    ) -> [u32; 8] {
        let mut out = [other; 8];
        for lane in 0..8 {
            out[lane] = if sizes[lane] * ratio > size { children[lane] | flag } else { other };
        }
        out
    }
    #[inline(always)]
    fn pack(pairs: &Opened, list: &mut [Item; WIDTH]) -> usize {
        // Without a branch: which lanes they are cannot be predicted.
        let mut count = 0;
        for lane in 0..WIDTH {
            let (wide, single) = (pairs.first + lane as u32, pairs.single);
            let boxes = if pairs.wide_is_b { [single, wide] } else { [wide, single] };
            list[count] = Item { key: pairs.keys[lane] as u32, boxes, open: pairs.open[lane] };
            count += (pairs.bits >> lane) as usize & usize::from(lane < WIDTH - 1);
        }
        count + (pairs.bits >> (WIDTH - 1)) as usize
    }
    #[inline(always)]
    fn prefetch<T>(_: &T) {}
    #[inline(always)]
    fn combine(c: &[[f32; 4]; 3], x: f32, y: f32, z: f32) -> [f32; 4] {
        let at = |k: usize| c[0][k] * x + c[1][k] * y + c[2][k] * z;
        [at(0), at(1), at(2), at(3)]
    }
}
