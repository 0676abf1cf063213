//! Four `f64` side by side: how they lie in memory, and what registers of any instruction set do with them.

use super::two::{Elementwise, Two};
use crate::F64x4;
use core::ops::{Add, Div, Mul, Sub};
use glam::DVec3;

/// Four doubles in memory; registers that hold them are [`Doubles`].
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(32))]
pub struct Quad(pub [f64; 4]);

/// Four doubles in registers: each operation correctly rounded, no fused multiply-add, so every implementation returns
/// the same bits. [`F64x4`] is the portable one.
pub trait Doubles: Elementwise<Scalar = f64> + Div<Output = Self> {
    /// Two times four doubles.
    type Two: Two<Self>;

    /// From memory.
    fn load(values: &Quad) -> Self;
    /// To memory.
    fn store(self) -> Quad;
    /// Correctly rounded square root.
    fn sqrt(self) -> Self;
    /// Each rounded to `f32`.
    fn narrow(self) -> [f32; 4];
    /// The smallest of the four.
    fn min_element(self) -> f64;
    /// The largest of the four.
    fn max_element(self) -> f64;
    /// The transposed matrix of three columns with zeros below.
    fn transposed(columns: [Self; 3]) -> [Self; 3];
}

impl Quad {
    /// A vector, and zero.
    #[inline(always)]
    pub const fn from_vec(v: DVec3) -> Self {
        Self([v.x, v.y, v.z, 0.0])
    }

    /// The first three.
    #[inline(always)]
    pub const fn to_vec(self) -> DVec3 {
        DVec3::new(self.0[0], self.0[1], self.0[2])
    }
}

/// Vectors side by side: four, or eight where `D` is two times four doubles.
#[derive(Clone, Copy, Debug)]
pub struct QuadVec<D>(pub [D; 3]);

impl<D: Doubles> QuadVec<D> {
    /// Four vectors.
    #[inline(always)]
    pub fn new(v: [DVec3; 4]) -> Self {
        Self([
            D::load(&Quad([v[0].x, v[1].x, v[2].x, v[3].x])),
            D::load(&Quad([v[0].y, v[1].y, v[2].y, v[3].y])),
            D::load(&Quad([v[0].z, v[1].z, v[2].z, v[3].z])),
        ])
    }

    /// These four, then four others.
    #[inline(always)]
    pub fn beside(&self, other: &Self) -> QuadVec<D::Two> {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        QuadVec([D::Two::of(x, u), D::Two::of(y, v), D::Two::of(z, w)])
    }
}

impl<D: Elementwise<Scalar = f64>> QuadVec<D> {
    /// The same vector in each place.
    #[inline(always)]
    pub fn splat(v: DVec3) -> Self {
        Self([D::splat(v.x), D::splat(v.y), D::splat(v.z)])
    }

    /// Scalar product of each with the same vector.
    #[inline(always)]
    pub fn dot(&self, p: DVec3) -> D {
        self.dots(&Self::splat(p))
    }

    /// `e` × each.
    #[inline(always)]
    pub fn crossed_by(&self, e: DVec3) -> Self {
        Self::splat(e).crossed(self)
    }

    /// Lane by lane: the scalar product.
    #[inline(always)]
    pub fn dots(&self, other: &Self) -> D {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        x * u + y * v + z * w
    }

    /// Lane by lane: self × other.
    #[inline(always)]
    pub fn crossed(&self, other: &Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        Self([y * w - z * v, z * u - x * w, x * v - y * u])
    }

    /// Lane by lane: the squared length.
    #[inline(always)]
    pub fn length_squared(&self) -> D {
        self.dots(self)
    }
}

/// Lane by lane.
impl<D: Elementwise<Scalar = f64>> Add for QuadVec<D> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        Self([x + u, y + v, z + w])
    }
}

/// Lane by lane.
impl<D: Elementwise<Scalar = f64>> Sub for QuadVec<D> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        Self([x - u, y - v, z - w])
    }
}

/// Each times its own factor.
impl<D: Elementwise<Scalar = f64>> Mul<D> for QuadVec<D> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, factors: D) -> Self {
        let [x, y, z] = self.0;
        Self([x * factors, y * factors, z * factors])
    }
}

/// Columns of a 3×3 matrix, each with a zero below.
#[derive(Clone, Copy, Debug, Default)]
pub struct Matrix(pub [Quad; 3]);

impl Matrix {
    /// The matrix of v ↦ ω × v.
    #[inline(always)]
    pub const fn cross(omega: &Quad) -> Self {
        let [x, y, z, _] = omega.0;
        Self([Quad([0.0, z, -y, 0.0]), Quad([-z, 0.0, x, 0.0]), Quad([y, -x, 0.0, 0.0])])
    }

    /// Rows as columns.
    #[inline(always)]
    pub fn transposed<D: Doubles>(&self) -> Self {
        let [a, b, c] = &self.0;
        let [x, y, z] = D::transposed([D::load(a), D::load(b), D::load(c)]);
        Self([x.store(), y.store(), z.store()])
    }

    /// The product with a vector.
    #[inline(always)]
    pub fn times<D: Doubles>(&self, v: DVec3) -> D {
        D::load(&self.0[0]) * D::splat(v.x)
            + D::load(&self.0[1]) * D::splat(v.y)
            + D::load(&self.0[2]) * D::splat(v.z)
    }

    /// The product with a vector, by the registers of the target that the program is compiled for.
    #[inline(always)]
    pub fn transform(&self, v: DVec3) -> DVec3 {
        self.times::<F64x4>(v).store().to_vec()
    }

    /// The product with a vector in memory, whose fourth number does not matter.
    #[inline(always)]
    pub fn times_quad<D: Doubles>(&self, v: &Quad) -> D {
        self.times(v.to_vec())
    }

    /// The product with each column of the other.
    #[inline(always)]
    pub fn times_matrix<D: Doubles>(&self, other: &Self) -> Self {
        Self([
            self.times_quad::<D>(&other.0[0]).store(),
            self.times_quad::<D>(&other.0[1]).store(),
            self.times_quad::<D>(&other.0[2]).store(),
        ])
    }
}
