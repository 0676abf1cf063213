use core::ops::{Add, Mul, Neg, Sub};

use glam::DVec3;

use crate::Interval;

/// A box of vectors: one interval per coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct IntervalVec3 {
    /// First coordinate.
    pub x: Interval,
    /// Second coordinate.
    pub y: Interval,
    /// Third coordinate.
    pub z: Interval,
}

impl IntervalVec3 {
    /// The zero vector.
    pub const ZERO: Self = Self::new(Interval::ZERO, Interval::ZERO, Interval::ZERO);

    /// From three coordinates.
    #[inline]
    pub const fn new(x: Interval, y: Interval, z: Interval) -> Self {
        Self { x, y, z }
    }

    /// The single vector `p`.
    #[inline]
    pub fn point(p: DVec3) -> Self {
        Self::new(Interval::point(p.x), Interval::point(p.y), Interval::point(p.z))
    }

    /// `self · o`.
    #[inline]
    pub fn dot(self, o: Self) -> Interval {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// `self · p`.
    #[inline]
    pub fn dot_point(self, p: DVec3) -> Interval {
        self.x * p.x + self.y * p.y + self.z * p.z
    }

    /// `self × o`.
    #[inline]
    pub fn cross(self, o: Self) -> Self {
        Self::new(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    /// `|self|²`.
    #[inline]
    pub fn norm_squared(self) -> Interval {
        let s = self.x.sqr() + self.y.sqr() + self.z.sqr();
        if s.lo() < 0.0 { Interval::raw(0.0, s.hi()) } else { s }
    }

    /// `|self|`.
    #[inline]
    pub fn norm(self) -> Interval {
        self.norm_squared().sqrt()
    }

    /// The smallest box that holds both.
    #[inline]
    pub fn hull(self, o: Self) -> Self {
        Self::new(self.x.hull(o.x), self.y.hull(o.y), self.z.hull(o.z))
    }

    /// The common vectors, coordinate by coordinate.
    #[inline]
    pub fn intersection(self, o: Self) -> Self {
        Self::new(self.x.intersection(o.x), self.y.intersection(o.y), self.z.intersection(o.z))
    }

    /// The middle of the box.
    #[inline]
    pub fn mid(self) -> DVec3 {
        DVec3::new(self.x.mid(), self.y.mid(), self.z.mid())
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
}

impl Neg for IntervalVec3 {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.x, -self.y, -self.z)
    }
}

macro_rules! vector_ops {
    ($($op:ident $f:ident),*) => {$(
        impl $op for IntervalVec3 {
            type Output = Self;
            #[inline]
            fn $f(self, o: Self) -> Self {
                Self::new($op::$f(self.x, o.x), $op::$f(self.y, o.y), $op::$f(self.z, o.z))
            }
        }
        impl $op<DVec3> for IntervalVec3 {
            type Output = Self;
            #[inline]
            fn $f(self, o: DVec3) -> Self { $op::$f(self, Self::point(o)) }
        }
        impl $op<IntervalVec3> for DVec3 {
            type Output = IntervalVec3;
            #[inline]
            fn $f(self, o: IntervalVec3) -> IntervalVec3 { $op::$f(IntervalVec3::point(self), o) }
        }
    )*};
}
vector_ops!(Add add, Sub sub);

impl Mul<Interval> for IntervalVec3 {
    type Output = Self;
    #[inline]
    fn mul(self, s: Interval) -> Self {
        Self::new(self.x * s, self.y * s, self.z * s)
    }
}

impl Mul<f64> for IntervalVec3 {
    type Output = Self;
    #[inline]
    fn mul(self, s: f64) -> Self {
        self * Interval::point(s)
    }
}

impl Mul<IntervalVec3> for Interval {
    type Output = IntervalVec3;
    #[inline]
    fn mul(self, v: IntervalVec3) -> IntervalVec3 {
        v * self
    }
}

impl Mul<IntervalVec3> for f64 {
    type Output = IntervalVec3;
    #[inline]
    fn mul(self, v: IntervalVec3) -> IntervalVec3 {
        v * self
    }
}

impl From<DVec3> for IntervalVec3 {
    fn from(p: DVec3) -> Self {
        Self::point(p)
    }
}
