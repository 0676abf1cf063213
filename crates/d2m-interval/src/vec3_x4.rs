//! Four vectors of intervals at once.
use core::ops::{Add, Sub};

use crate::{
    Interval, IntervalVec3, IntervalX4,
    round::{THREE_PRODUCTS, TWO_PRODUCTS},
    x4::{finite, pad},
};
use d2m_lanes::F64x4;

/// Four boxes of vectors.
///
/// ```
/// use d2m_interval::{IntervalVec3, IntervalVec3X4};
/// use glam::DVec3;
/// let four = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE].map(IntervalVec3::point);
/// let squares = IntervalVec3X4::from_lanes(four).norm_squared();
/// assert!(squares.lane(0).contains(1.0) && squares.lane(3).contains(3.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct IntervalVec3X4 {
    /// First coordinates.
    pub x: IntervalX4,
    /// Second coordinates.
    pub y: IntervalX4,
    /// Third coordinates.
    pub z: IntervalX4,
}

impl IntervalVec3X4 {
    /// From coordinates.
    #[inline(always)]
    pub const fn new(x: IntervalX4, y: IntervalX4, z: IntervalX4) -> Self {
        Self { x, y, z }
    }

    /// From four boxes.
    pub fn from_lanes(v: [IntervalVec3; 4]) -> Self {
        Self::new(
            IntervalX4::new(v.map(|v| v.x)),
            IntervalX4::new(v.map(|v| v.y)),
            IntervalX4::new(v.map(|v| v.z)),
        )
    }

    /// The same box four times.
    pub fn splat(v: IntervalVec3) -> Self {
        Self::new(IntervalX4::splat(v.x), IntervalX4::splat(v.y), IntervalX4::splat(v.z))
    }

    /// One of the four.
    ///
    /// # Panics
    /// When `i > 3`.
    pub fn lane(self, i: usize) -> IntervalVec3 {
        IntervalVec3::new(self.x.lane(i), self.y.lane(i), self.z.lane(i))
    }

    /// The four boxes.
    pub fn lanes(self) -> [IntervalVec3; 4] {
        core::array::from_fn(|i| self.lane(i))
    }

    #[inline(always)]
    fn largest(self) -> F64x4 {
        self.x.largest().max(self.y.largest()).max(self.z.largest())
    }

    /// `self · o`, with one increment for all roundings.
    ///
    /// ```
    /// # use d2m_interval::{IntervalVec3, IntervalVec3X4};
    /// # use glam::DVec3;
    /// let v = IntervalVec3X4::splat(IntervalVec3::point(DVec3::new(1.0, 2.0, 3.0)));
    /// assert!(v.dot(v).lane(0).contains(14.0));
    /// ```
    #[inline(always)]
    pub fn dot(self, o: Self) -> IntervalX4 {
        let (p, q, r) = (self.x.products(o.x), self.y.products(o.y), self.z.products(o.z));
        let size = p.size().sum(q.size()).sum(r.size());
        let largest = self.largest().max(o.largest());
        p.sum(q).sum(r).rounded(size, THREE_PRODUCTS, largest, || {
            let (a, b) = (self.lanes(), o.lanes());
            IntervalX4::new(core::array::from_fn(|i| a[i].dot(b[i])))
        })
    }

    /// `self × o`.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        /// `a·d − b·c`. (A function: a closure is a call.)
        #[inline(always)]
        fn minor([a, d]: [IntervalX4; 2], [b, c]: [IntervalX4; 2], largest: F64x4) -> IntervalX4 {
            let (p, q) = (a.products(d), -b.products(c));
            p.sum(q).rounded(p.size().sum(q.size()), TWO_PRODUCTS, largest, || a * d - b * c)
        }
        let largest = self.largest().max(o.largest());
        Self::new(
            minor([self.y, o.z], [self.z, o.y], largest),
            minor([self.z, o.x], [self.x, o.z], largest),
            minor([self.x, o.y], [self.y, o.x], largest),
        )
    }

    /// `self` turned by `angle` about the unit vectors `axis`, as [`IntervalVec3::rotated`].
    #[inline(always)]
    pub fn rotated(self, axis: Self, angle: IntervalX4) -> Self {
        let (sin, cos) = angle.sin_cos();
        let across = axis.cross(self);
        let along = axis.dot(self) * (IntervalX4::splat(Interval::ONE) - cos);
        let factors = Self::new(cos, sin, along);
        let row = |v, c, k| factors.dot(Self::new(v, c, k));
        Self::new(row(self.x, across.x, axis.x), row(self.y, across.y, axis.y), row(self.z, across.z, axis.z))
    }

    /// `|self|²`; never below zero.
    #[inline(always)]
    pub fn norm_squared(self) -> IntervalX4 {
        let zero = F64x4::splat(0.0);
        let squares = |a: IntervalX4| {
            let least = (-a.neg_lo).max(-a.hi).max(zero);
            let greatest = a.neg_lo.max(a.hi);
            (least * least, greatest * greatest)
        };
        let ((a, b), (c, d), (e, f)) = (squares(self.x), squares(self.y), squares(self.z));
        let (l, g) = (a + c + e, b + d + f);
        let (e, f) = (pad(l, THREE_PRODUCTS), pad(g, THREE_PRODUCTS));
        if finite(e, f) {
            IntervalX4 { neg_lo: (-l + e).min(zero), hi: g + f }
        } else {
            IntervalX4::new(self.lanes().map(IntervalVec3::norm_squared))
        }
    }

    /// The vectors times four intervals.
    #[inline(always)]
    pub fn scaled(self, s: IntervalX4) -> Self {
        Self::new(s * self.x, s * self.y, s * self.z)
    }
}

impl Add for IntervalVec3X4 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self::new(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl Sub for IntervalVec3X4 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self::new(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}
