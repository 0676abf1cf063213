//! Four `f64` side by side: the storage, and the operations for one instruction set.

use super::two::{Both, Elementwise, Two};
use core::ops::{Add, Div, Mul, Sub};
use glam::DVec3;
use wide::f64x4;

/// Four doubles in memory.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct Quad(pub [f64; 4]);

/// Four doubles in registers: each operation correctly rounded, no fused multiply-add, so every implementation returns
/// the same bits. [`Quad`] is the portable one.
pub trait Doubles: Elementwise<Scalar = f64> + Div<Output = Self> {
    /// Two times four doubles.
    type Two: Two<Self>;

    /// From memory.
    fn load(values: &Quad) -> Self;
    /// To memory.
    fn store(self) -> Quad;
    /// Each rounded to `f32`.
    fn narrow(self) -> [f32; 4];
    /// The smallest of the four.
    fn min_element(self) -> f64;
    /// The largest of the four.
    fn max_element(self) -> f64;
    /// The transposed matrix of three columns with zeros below.
    fn transposed(columns: [Self; 3]) -> [Self; 3];
}

macro_rules! elementwise {
    ($($operator:ident $method:ident $symbol:tt),*) => {$(
        impl $operator for Quad {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::of(self.register() $symbol other.register())
            }
        }
    )*};
}
elementwise!(Add add +, Sub sub -, Mul mul *, Div div /);

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

    #[inline(always)]
    const fn register(self) -> f64x4 {
        f64x4::new(self.0)
    }

    #[inline(always)]
    fn of(register: f64x4) -> Self {
        Self(register.to_array())
    }
}

impl Elementwise for Quad {
    type Scalar = f64;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Self([x; 4])
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::if_greater(other, self, self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::if_greater(self, other, self, other)
    }
    #[inline(always)]
    fn if_greater(left: Self, right: Self, yes: Self, no: Self) -> Self {
        Self::of(left.register().simd_gt(right.register()).bitselect(yes.register(), no.register()))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self::of(self.register().abs())
    }
    #[inline(always)]
    fn flip_sign(magnitude: Self, sign: Self) -> Self {
        Self::of(magnitude.register() ^ (sign.register() & f64x4::splat(-0.0)))
    }
}

impl Doubles for Quad {
    type Two = Both<Self>;

    #[inline(always)]
    fn load(values: &Quad) -> Self {
        *values
    }
    #[inline(always)]
    fn store(self) -> Quad {
        self
    }
    #[inline(always)]
    fn narrow(self) -> [f32; 4] {
        let a = &self.0;
        [a[0] as f32, a[1] as f32, a[2] as f32, a[3] as f32]
    }
    #[inline(always)]
    fn min_element(self) -> f64 {
        let [a, b, c, d] = self.0;
        let (low, high) = (if a < c { a } else { c }, if b < d { b } else { d });
        if low < high { low } else { high }
    }
    #[inline(always)]
    fn max_element(self) -> f64 {
        let [a, b, c, d] = self.0;
        let (low, high) = (if a > c { a } else { c }, if b > d { b } else { d });
        if low > high { low } else { high }
    }
    #[inline(always)]
    fn transposed([a, b, c]: [Self; 3]) -> [Self; 3] {
        [
            Self([a.0[0], b.0[0], c.0[0], 0.0]),
            Self([a.0[1], b.0[1], c.0[1], 0.0]),
            Self([a.0[2], b.0[2], c.0[2], 0.0]),
        ]
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

    /// Lane by lane: the sum.
    #[inline(always)]
    pub fn plus(&self, other: &Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        Self([x + u, y + v, z + w])
    }

    /// Lane by lane: the difference.
    #[inline(always)]
    pub fn minus(&self, other: &Self) -> Self {
        let ([x, y, z], [u, v, w]) = (self.0, other.0);
        Self([x - u, y - v, z - w])
    }

    /// Each times its own factor.
    #[inline(always)]
    pub fn times(&self, factors: D) -> Self {
        let [x, y, z] = self.0;
        Self([x * factors, y * factors, z * factors])
    }

    /// Lane by lane: the squared length.
    #[inline(always)]
    pub fn length_squared(&self) -> D {
        self.dots(self)
    }
}

/// Columns of a 3×3 matrix, each with a zero below.
#[derive(Clone, Copy, Debug)]
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
