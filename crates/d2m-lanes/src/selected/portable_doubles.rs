//! Four doubles in the registers of the target that the program is compiled for.

use super::quad::{Doubles, Quad};
use super::two::{Both, Elementwise};
use crate::F64x4;

impl Elementwise for F64x4 {
    type Scalar = f64;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self::splat(x)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::min(self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::max(self, other)
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        right.lt(left).select(yes, no)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::abs(self)
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        magnitude.xor(sign.and(Self::splat(-0.0)))
    }
}

impl Doubles for F64x4 {
    type Two = Both<Self>;

    #[inline(always)]
    fn load(values: &Quad) -> Self {
        Self::new(values.0)
    }
    #[inline(always)]
    fn store(self) -> Quad {
        Quad(self.to_array())
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }
    #[inline(always)]
    fn narrow(self) -> [f32; 4] {
        let [a, b, c, d] = self.to_array();
        [a as f32, b as f32, c as f32, d as f32]
    }
    #[inline(always)]
    fn min_element(self) -> f64 {
        let [a, b, c, d] = self.to_array();
        let (low, high) = (if a < c { a } else { c }, if b < d { b } else { d });
        if low < high { low } else { high }
    }
    #[inline(always)]
    fn max_element(self) -> f64 {
        let [a, b, c, d] = self.to_array();
        let (low, high) = (if a > c { a } else { c }, if b > d { b } else { d });
        if low > high { low } else { high }
    }
    #[inline(always)]
    fn transposed(columns: [Self; 3]) -> [Self; 3] {
        let [a, b, c] = columns.map(Self::to_array);
        [0, 1, 2].map(|row| Self::new([a[row], b[row], c[row], 0.0]))
    }
}
