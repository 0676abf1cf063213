//! Vectors of intervals. Products of sums are rounded once, by an increment that is known in advance.
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use glam::DVec3;

use crate::{
    Interval,
    arith::{magnitudes, products, products_with},
    round::{THREE_PRODUCTS, TINY, TWO_PRODUCTS, finite, finite_with, increment},
};
use d2m_lanes::F64x2;

/// A box of vectors: one interval per coordinate.
///
/// ```
/// use d2m_interval::{Interval, IntervalVec3};
/// use glam::DVec3;
/// let p = IntervalVec3::point(DVec3::new(1.0, 2.0, 3.0));
/// let q = IntervalVec3::point(DVec3::new(0.1, 0.2, 0.3));
/// assert!(p.cross(q).contains(DVec3::ZERO) || p.cross(q).norm().hi() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct IntervalVec3 {
    /// First coordinate.
    pub x: Interval,
    /// Second coordinate.
    pub y: Interval,
    /// Third coordinate.
    pub z: Interval,
}

/// A sum and the increment that rounds it up; not yet checked.
pub(crate) type Pending = (F64x2, F64x2);

/// Σ pᵢ, each the correctly rounded value of a product.
#[inline(always)]
fn sum3(p: F64x2, q: F64x2, r: F64x2) -> Pending {
    let size = p.abs() + q.abs() + r.abs();
    (p + q + r, size * F64x2::splat(THREE_PRODUCTS) + F64x2::splat(TINY))
}

/// p − q, intervals, each end the correctly rounded value of a product.
#[inline(always)]
fn difference(p: F64x2, q: F64x2) -> Pending {
    let q = q.swap();
    let size = p.abs() + q.abs();
    (p + q, size * F64x2::splat(TWO_PRODUCTS) + F64x2::splat(TINY))
}

#[inline(always)]
fn dot(a: IntervalVec3, b: IntervalVec3) -> Pending {
    sum3(products(a.x.0, b.x.0), products(a.y.0, b.y.0), products(a.z.0, b.z.0))
}

#[inline(always)]
fn dot_point(a: IntervalVec3, b: DVec3) -> Pending {
    sum3(products_with(a.x.0, b.x), products_with(a.y.0, b.y), products_with(a.z.0, b.z))
}

/// Three results at once, with one check; `largest` is the maximum of the operands of products.
#[inline(always)]
fn rounded3(largest: F64x2, [x, y, z]: [Pending; 3], slow: impl FnOnce() -> IntervalVec3) -> IntervalVec3 {
    if finite_with(largest, x.1 + y.1 + z.1) {
        IntervalVec3::new(Interval(x.0 + x.1), Interval(y.0 + y.1), Interval(z.0 + z.1))
    } else {
        slow()
    }
}

/// The increment of a single operation.
#[inline(always)]
fn single(x: F64x2) -> Pending {
    (x, increment(x))
}

/// Term by term, with every special case of infinite and empty intervals.
#[cold]
#[inline(never)]
fn dot_slow(a: IntervalVec3, b: IntervalVec3) -> Interval {
    a.x * b.x + a.y * b.y + a.z * b.z
}

#[cold]
#[inline(never)]
fn cross_slow(a: IntervalVec3, b: IntervalVec3) -> IntervalVec3 {
    IntervalVec3::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

impl IntervalVec3 {
    /// The zero vector.
    pub const ZERO: Self = Self::new(Interval::ZERO, Interval::ZERO, Interval::ZERO);
    /// All vectors.
    pub const ENTIRE: Self = Self::new(Interval::ENTIRE, Interval::ENTIRE, Interval::ENTIRE);

    /// From three coordinates.
    #[inline(always)]
    pub const fn new(x: Interval, y: Interval, z: Interval) -> Self {
        Self { x, y, z }
    }

    /// The single vector `p`; entire in a coordinate that is not finite.
    #[inline(always)]
    pub fn point(p: DVec3) -> Self {
        Self::new(Interval::point(p.x), Interval::point(p.y), Interval::point(p.z))
    }

    /// A box about the vectors within `radius` of `center`: [`Interval::around`] of each coordinate.
    ///
    /// ```
    /// # use d2m_interval::IntervalVec3;
    /// # use glam::DVec3;
    /// assert!(IntervalVec3::around(DVec3::X, 0.1).contains(DVec3::new(1.05, -0.05, 0.05)));
    /// ```
    #[inline]
    pub fn around(center: DVec3, radius: f64) -> Self {
        let side = |x: f64| Interval::around(x, radius);
        Self::new(side(center.x), side(center.y), side(center.z))
    }

    /// The smallest box that holds `p` and `q`.
    #[inline]
    pub fn between(p: DVec3, q: DVec3) -> Self {
        Self::point(p).hull(Self::point(q))
    }

    /// The maximum over the coordinates, end by end.
    #[inline(always)]
    fn largest(self) -> F64x2 {
        self.x.0.max(self.y.0).max(self.z.0)
    }

    /// `self · o`. The increment is `4·2⁻⁵³ Σ|aᵢbᵢ|` (and a little), for all roundings together.
    #[inline(always)]
    pub fn dot(self, o: Self) -> Interval {
        let (x, e) = dot(self, o);
        if finite_with(self.largest().max(o.largest()), e) { Interval(x + e) } else { dot_slow(self, o) }
    }

    /// `self · p`.
    #[inline(always)]
    pub fn dot_point(self, p: DVec3) -> Interval {
        let (x, e) = dot_point(self, p);
        if finite_with(self.largest(), e) { Interval(x + e) } else { dot_slow(self, Self::point(p)) }
    }

    /// `self × o`.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        let ([ax, ay, az], [bx, by, bz]) = ([self.x.0, self.y.0, self.z.0], [o.x.0, o.y.0, o.z.0]);
        rounded3(
            self.largest().max(o.largest()),
            [
                difference(products(ay, bz), products(az, by)),
                difference(products(az, bx), products(ax, bz)),
                difference(products(ax, by), products(ay, bx)),
            ],
            || cross_slow(self, o),
        )
    }

    /// `self × p`.
    #[inline(always)]
    pub fn cross_point(self, p: DVec3) -> Self {
        let [x, y, z] = [self.x.0, self.y.0, self.z.0];
        rounded3(
            self.largest(),
            [
                difference(products_with(y, p.z), products_with(z, p.y)),
                difference(products_with(z, p.x), products_with(x, p.z)),
                difference(products_with(x, p.y), products_with(y, p.x)),
            ],
            || cross_slow(self, Self::point(p)),
        )
    }

    /// `self · (a × b)`.
    ///
    /// ```
    /// # use d2m_interval::IntervalVec3;
    /// # use glam::DVec3;
    /// let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(IntervalVec3::point);
    /// assert!(x.triple_product(y, z).contains(1.0));
    /// ```
    #[inline(always)]
    pub fn triple_product(self, a: Self, b: Self) -> Interval {
        self.dot(a.cross(b))
    }

    /// `|self|²`; never below zero.
    #[inline(always)]
    pub fn norm_squared(self) -> Interval {
        let square = |x: Interval| {
            let m = magnitudes(x.0);
            m * m
        };
        let s = square(self.x) + square(self.y) + square(self.z);
        let e = s * F64x2::splat(THREE_PRODUCTS) + F64x2::splat(TINY);
        if finite(e) {
            Interval((s.neg_first() + e).min(F64x2::new(0.0, f64::INFINITY)))
        } else {
            self.norm_squared_slow()
        }
    }

    #[cold]
    #[inline(never)]
    fn norm_squared_slow(self) -> Interval {
        let s = self.x.sqr() + self.y.sqr() + self.z.sqr();
        if s.lo() < 0.0 { Interval::raw(0.0, s.hi()) } else { s }
    }

    /// `|self|`.
    #[inline(always)]
    pub fn norm(self) -> Interval {
        self.norm_squared().sqrt()
    }

    /// `self` turned by `angle` about the unit vector `axis` (right-handed), by Rodrigues' formula
    /// `v cos θ + (k × v) sin θ + k (k·v)(1 − cos θ)`: with one increment for the sum of the three terms.
    ///
    /// ```
    /// # use d2m_interval::{Interval, IntervalVec3};
    /// # use glam::DVec3;
    /// let [x, z] = [DVec3::X, DVec3::Z].map(IntervalVec3::point);
    /// assert!(x.rotated(z, Interval::FRAC_PI_2).contains(DVec3::Y));
    /// ```
    #[inline(always)]
    pub fn rotated(self, axis: Self, angle: Interval) -> Self {
        let (sin, cos) = angle.sin_cos();
        let across = axis.cross(self);
        let along = axis.dot(self) * (1.0 - cos);
        let row = |v: Interval, c: Interval, k: Interval| {
            sum3(products(cos.0, v.0), products(sin.0, c.0), products(along.0, k.0))
        };
        rounded3(
            self.largest().max(across.largest()).max(axis.largest()).max(along.0),
            [row(self.x, across.x, axis.x), row(self.y, across.y, axis.y), row(self.z, across.z, axis.z)],
            || {
                let row = |v, c, k| dot_slow(Self::new(cos, sin, along), Self::new(v, c, k));
                Self::new(
                    row(self.x, across.x, axis.x),
                    row(self.y, across.y, axis.y),
                    row(self.z, across.z, axis.z),
                )
            },
        )
    }

    /// The smallest box that holds both.
    #[inline]
    pub fn hull(self, o: Self) -> Self {
        Self::new(self.x.hull(o.x), self.y.hull(o.y), self.z.hull(o.z))
    }

    /// The common vectors; empty in all coordinates when there is none.
    #[inline]
    pub fn intersection(self, o: Self) -> Self {
        let common = Self::new(self.x.intersection(o.x), self.y.intersection(o.y), self.z.intersection(o.z));
        if common.is_empty() { Self::new(Interval::EMPTY, Interval::EMPTY, Interval::EMPTY) } else { common }
    }

    /// The middle of the box.
    #[inline]
    pub fn mid(self) -> DVec3 {
        DVec3::new(self.x.mid(), self.y.mid(), self.z.mid())
    }

    /// The three lower ends.
    #[inline]
    pub fn lo(self) -> DVec3 {
        DVec3::new(self.x.lo(), self.y.lo(), self.z.lo())
    }

    /// The three upper ends.
    #[inline]
    pub fn hi(self) -> DVec3 {
        DVec3::new(self.x.hi(), self.y.hi(), self.z.hi())
    }

    /// Half the widths, rounded up.
    #[inline]
    pub fn rad(self) -> DVec3 {
        DVec3::new(self.x.rad(), self.y.rad(), self.z.rad())
    }

    /// Whether the box has no element.
    #[inline]
    pub fn is_empty(self) -> bool {
        self.x.is_empty() || self.y.is_empty() || self.z.is_empty()
    }

    /// Whether `p` lies in the box.
    #[inline]
    pub fn contains(self, p: DVec3) -> bool {
        self.x.contains(p.x) && self.y.contains(p.y) && self.z.contains(p.z)
    }

    /// Whether every vector of `self` is in `o`.
    #[inline]
    pub fn is_subset(self, o: Self) -> bool {
        self.is_empty() || (self.x.is_subset(o.x) && self.y.is_subset(o.y) && self.z.is_subset(o.z))
    }

    #[inline(always)]
    pub(crate) fn rows_times(rows: &[Self; 3], v: Self) -> Self {
        rounded3(
            v.largest().max(rows[0].largest()).max(rows[1].largest()).max(rows[2].largest()),
            [dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)],
            || Self::new(dot_slow(rows[0], v), dot_slow(rows[1], v), dot_slow(rows[2], v)),
        )
    }

    #[inline(always)]
    pub(crate) fn rows_times_point(rows: &[Self; 3], p: DVec3) -> Self {
        rounded3(
            rows[0].largest().max(rows[1].largest()).max(rows[2].largest()),
            [dot_point(rows[0], p), dot_point(rows[1], p), dot_point(rows[2], p)],
            || {
                let v = Self::point(p);
                Self::new(dot_slow(rows[0], v), dot_slow(rows[1], v), dot_slow(rows[2], v))
            },
        )
    }
}

impl Neg for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

impl Add for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        rounded3(
            F64x2::splat(0.0),
            [single(self.x.0 + o.x.0), single(self.y.0 + o.y.0), single(self.z.0 + o.z.0)],
            || Self::new(self.x + o.x, self.y + o.y, self.z + o.z),
        )
    }
}

impl Sub for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Add<DVec3> for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: DVec3) -> Self {
        let p = |x: f64| Interval::point_unchecked(x).0;
        rounded3(
            F64x2::splat(0.0),
            [single(self.x.0 + p(o.x)), single(self.y.0 + p(o.y)), single(self.z.0 + p(o.z))],
            || Self::new(self.x + o.x, self.y + o.y, self.z + o.z),
        )
    }
}

impl Sub<DVec3> for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: DVec3) -> Self {
        self + -o
    }
}

impl Add<IntervalVec3> for DVec3 {
    type Output = IntervalVec3;
    #[inline(always)]
    fn add(self, o: IntervalVec3) -> IntervalVec3 {
        o + self
    }
}

impl Sub<IntervalVec3> for DVec3 {
    type Output = IntervalVec3;
    #[inline(always)]
    fn sub(self, o: IntervalVec3) -> IntervalVec3 {
        -o + self
    }
}

impl AddAssign for IntervalVec3 {
    fn add_assign(&mut self, o: Self) {
        *self = *self + o;
    }
}

impl SubAssign for IntervalVec3 {
    fn sub_assign(&mut self, o: Self) {
        *self = *self - o;
    }
}

impl Mul<Interval> for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: Interval) -> Self {
        rounded3(
            self.largest().max(s.0),
            [
                single(products(s.0, self.x.0)),
                single(products(s.0, self.y.0)),
                single(products(s.0, self.z.0)),
            ],
            || Self::new(self.x * s, self.y * s, self.z * s),
        )
    }
}

impl Mul<f64> for IntervalVec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        rounded3(
            self.largest(),
            [
                single(products_with(self.x.0, s)),
                single(products_with(self.y.0, s)),
                single(products_with(self.z.0, s)),
            ],
            || Self::new(self.x * s, self.y * s, self.z * s),
        )
    }
}

impl Mul<IntervalVec3> for Interval {
    type Output = IntervalVec3;
    #[inline(always)]
    fn mul(self, v: IntervalVec3) -> IntervalVec3 {
        v * self
    }
}

impl Mul<IntervalVec3> for f64 {
    type Output = IntervalVec3;
    #[inline(always)]
    fn mul(self, v: IntervalVec3) -> IntervalVec3 {
        v * self
    }
}

impl Mul<DVec3> for Interval {
    type Output = IntervalVec3;
    /// The vectors `s p` for `s ∈ self`.
    #[inline(always)]
    fn mul(self, p: DVec3) -> IntervalVec3 {
        rounded3(
            self.0,
            [
                single(products_with(self.0, p.x)),
                single(products_with(self.0, p.y)),
                single(products_with(self.0, p.z)),
            ],
            || IntervalVec3::new(self * p.x, self * p.y, self * p.z),
        )
    }
}

impl From<DVec3> for IntervalVec3 {
    fn from(p: DVec3) -> Self {
        Self::point(p)
    }
}
