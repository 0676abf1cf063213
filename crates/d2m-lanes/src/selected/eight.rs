//! Eight `f32` lanes: the operations that the searches need of an instruction set.
//!
//! Only + − × ÷ √, extrema, comparison and sign removal, each correctly rounded by IEEE 754, and no fused
//! multiply-add: every implementation returns the same bits.

use super::quad::Doubles;
use super::two::{Bytes, Two};
use core::ops::Div;

/// Eight rows of four words, one a lane: a key, two numbers, a tag. One of the numbers counts up from lane to lane, the
/// other is the same in all of them.
#[derive(Clone, Copy, Debug)]
pub struct Rows {
    /// First word.
    pub keys: [i32; 8],
    /// The number that counts up, in lane 0.
    pub counting: u32,
    /// The number that stays.
    pub constant: u32,
    /// The number that counts up is the third word and the other one the second; else the other way round.
    pub counting_is_third: bool,
    /// Fourth word.
    pub tags: [u32; 8],
    /// Bit i is set when row i is wanted.
    pub wanted: u32,
}

/// Eight keys.
#[derive(Clone, Copy, Debug)]
pub struct Keys {
    /// Lane by lane.
    pub keys: [i32; 8],
    /// The bits of the lanes whose key is below the limit.
    pub below: u32,
}

/// Eight boxes that are compared with one by their sizes.
#[derive(Clone, Copy, Debug)]
pub struct WideSide<'a> {
    /// What is below each box; with the highest bit set nothing that can be expanded.
    pub children: &'a [u32; 8],
    /// Added to a child.
    pub flag: u32,
}

/// The one box that eight are compared with.
#[derive(Clone, Copy, Debug)]
pub struct SingleSide {
    /// Its size.
    pub size: f32,
    /// What stands for it.
    pub tag: u32,
}

/// Eight lanes of `f32`.
pub trait Lanes: Bytes + Div<Output = Self> {
    /// Four `f64` of the same instruction set.
    type Doubles: Doubles;
    /// Two times eight lanes.
    type Two: Two<Self> + Bytes;

    /// Lanes from memory.
    fn load(values: &[f32; 8]) -> Self;
    /// Lanes to memory.
    fn store(self) -> [f32; 8];
    /// The first four lanes and the last four, each rounded to `f32`.
    fn narrowed(halves: [Self::Doubles; 2]) -> Self;
    /// The first four lanes and the last four, exactly.
    fn widened(self) -> [Self::Doubles; 2];
    /// Correctly rounded square root.
    fn sqrt(self) -> Self;
    /// Bit i is set when lane i of `self` is less than lane i of `other`.
    fn less_bits(self, other: Self) -> u32;
    /// max(`least`, `base` + the integer part) in each lane, with `least` for what is not a number; and the bits of
    /// the lanes where that is below `limit`. Lanes stay below 2³¹ − `base`.
    fn keys(self, base: i32, least: i32, limit: i32) -> Keys;
    /// `wide.children | wide.flag` in the lanes where the size, `self`, is more than `single.size` and the child's highest bit
    /// is not set, else `single.tag`.
    fn larger(self, wide: WideSide<'_>, single: SingleSide) -> [u32; 8];
    /// Writes the wanted rows to the start of the list, in the order of their lanes, and returns how many there are. What
    /// is behind them has no meaning.
    fn pack(rows: &Rows, list: &mut [[u32; 4]; 8]) -> usize;
    /// Prefetches the memory of a value: a hint.
    fn prefetch<T>(value: &T);
    /// x·c₀ + y·c₁ + z·c₂ for the columns c of a matrix.
    fn combine(columns: &[[f32; 4]; 3], x: f32, y: f32, z: f32) -> [f32; 4];
}
