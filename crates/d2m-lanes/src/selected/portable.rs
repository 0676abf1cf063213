//! The lanes that every target has: in vector registers where its plainest processor has some.

use super::eight::{Keys, Lanes, Rows, SingleSide, WideSide};
use super::quad::Doubles;
use super::two::{Both, Bytes, Elementwise};
use crate::F64x4;
use core::ops::{Add, Div, Mul, Sub};
use wide::bytemuck::cast;
use wide::{f32x8, i32x8, u32x8};

/// Portable lanes.
#[derive(Clone, Copy)]
pub struct Portable(f32x8);

macro_rules! portable_operator {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl $operator for Portable {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0 $symbol other.0)
            }
        }
    )*};
}
portable_operator!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Elementwise for Portable {
    type Scalar = f32;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self(f32x8::splat(value))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::if_greater(self, other, self, other)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::if_greater(other, self, self, other)
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        Self(magnitude.0 ^ (sign.0 & f32x8::splat(-0.0)))
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        Self(left.0.simd_gt(right.0).bitselect(yes.0, no.0))
    }
}

impl Bytes for Portable {
    #[inline(always)]
    fn byte_of(self, x: Self, y: Self, flip: Self) -> Self {
        // All bits of a lane are those of its sign.
        let sign = |v: Self| -> u32x8 { cast(cast::<_, i32x8>(v.0 ^ flip.0) >> 31_i32) };
        let four: u32x8 = cast(self.0);
        let two = sign(x).bitselect(four >> 8_u32, four);
        let one = sign(y).bitselect(two >> 16_u32, two);
        Self(f32x8::from_i32x8(cast(one & u32x8::splat(255))))
    }
}

impl Lanes for Portable {
    type Doubles = F64x4;
    type Two = Both<Self>;

    #[inline(always)]
    fn load(values: &[f32; 8]) -> Self {
        Self(f32x8::new(*values))
    }
    #[inline(always)]
    fn store(self) -> [f32; 8] {
        self.0.to_array()
    }
    #[inline(always)]
    fn narrowed([low, high]: [F64x4; 2]) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (Doubles::narrow(low), Doubles::narrow(high));
        Self(f32x8::new([a, b, c, d, e, f, g, h]))
    }
    #[inline(always)]
    fn widened(self) -> [F64x4; 2] {
        let [a, b, c, d, e, f, g, h] = self.0.to_array();
        let wide = |v: [f32; 4]| F64x4::new([v[0].into(), v[1].into(), v[2].into(), v[3].into()]);
        [wide([a, b, c, d]), wide([e, f, g, h])]
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline(always)]
    fn less_bits(self, other: Self) -> u32 {
        self.0.simd_lt(other.0).to_bitmask()
    }
    #[inline(always)]
    fn keys(self, base: i32, least: i32, limit: i32) -> Keys {
        let (mut keys, mut below) = ([0; 8], 0);
        for (lane, (key, x)) in keys.iter_mut().zip(self.store()).enumerate() {
            let whole = if x.is_nan() { i32::MIN } else { x as i32 };
            *key = base.wrapping_add(whole).max(least);
            below |= u32::from(*key < limit) << lane;
        }
        Keys { keys, below }
    }
    #[inline(always)]
    fn larger(self, WideSide { children, flag }: WideSide<'_>, single: SingleSide) -> [u32; 8] {
        let (sizes, mut out) = (self.store(), [single.tag; 8]);
        for lane in 0..8 {
            let larger = sizes[lane] > single.size && children[lane] >> 31 == 0;
            out[lane] = if larger { children[lane] | flag } else { single.tag };
        }
        out
    }
    #[inline(always)]
    fn pack(rows: &Rows, list: &mut [[u32; 4]; 8]) -> usize {
        // Without a branch: which lanes they are cannot be predicted.
        let mut count = 0;
        for lane in 0..8 {
            let (counting, constant) = (rows.counting + lane as u32, rows.constant);
            let [a, b] = if rows.counting_is_third { [constant, counting] } else { [counting, constant] };
            list[count] = [rows.keys[lane] as u32, a, b, rows.tags[lane]];
            count += (rows.wanted >> lane) as usize & usize::from(lane < 7);
        }
        count + (rows.wanted >> 7) as usize
    }
    #[inline(always)]
    fn prefetch<T>(_: &T) {}
    #[inline(always)]
    fn combine(c: &[[f32; 4]; 3], x: f32, y: f32, z: f32) -> [f32; 4] {
        let at = |k: usize| c[0][k] * x + c[1][k] * y + c[2][k] * z;
        [at(0), at(1), at(2), at(3)]
    }
}
