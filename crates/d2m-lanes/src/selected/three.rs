//! Vectors of three coordinates, each a number or a register of them.
//!
//! (No closures and no `array::map` here: they are compiled without the vector instructions unless they happen to be inlined.)
//!
//! ```
//! use d2m_lanes::three::{cross, dot, minus, times};
//! let (x, y) = ([2.0, 0.0, 0.0], [1.0, 3.0, 0.0]);
//! assert_eq!((dot(&x, &y), cross(&x, &y)), (2.0, [0.0, 0.0, 6.0]));
//! assert_eq!((minus(&y, &x), times(&y, 2.0)), ([-1.0, 3.0, 0.0], [2.0, 6.0, 0.0]));
//! ```

use super::{Elementwise, Lanes, Two};
use core::ops::{Add, Mul, Sub};

/// The scalar product.
#[inline(always)]
pub fn dot<T: Copy + Add<Output = T> + Mul<Output = T>>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
#[inline(always)]
pub fn cross<T: Copy + Mul<Output = T> + Sub<Output = T>>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The difference.
#[inline(always)]
pub fn minus<T: Copy + Sub<Output = T>>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// The product with a number.
#[inline(always)]
pub fn times<T: Copy + Mul<Output = T>>(a: &[T; 3], factor: T) -> [T; 3] {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

/// The first three values, each in all lanes.
///
/// ```
/// use d2m_lanes::{Elementwise, Portable, three};
/// let [x, _, z] = three::splat::<Portable, 4>(&[1.0, 2.0, 3.0, 0.0]);
/// assert_eq!((x.store()[7], z.store()[0]), (1.0, 3.0));
/// # use d2m_lanes::Lanes;
/// ```
#[inline(always)]
pub fn splat<T: Elementwise<Scalar = f32>, const N: usize>(values: &[f32; N]) -> [T; 3] {
    [T::splat(values[0]), T::splat(values[1]), T::splat(values[2])]
}

/// A vector in each of eight lanes.
#[inline(always)]
pub fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

/// One vector in the first eight lanes, another in the second.
#[inline(always)]
pub fn beside<L: Lanes>(first: &[L; 3], second: &[L; 3]) -> [L::Two; 3] {
    [L::Two::of(first[0], second[0]), L::Two::of(first[1], second[1]), L::Two::of(first[2], second[2])]
}

/// The same vector twice.
#[inline(always)]
pub fn both<L: Lanes>(half: &[L; 3]) -> [L::Two; 3] {
    [L::Two::both(half[0]), L::Two::both(half[1]), L::Two::both(half[2])]
}
