//! Two vectors side by side, in the two halves of vector registers: the same bits as one after the other.
use core::ops::{Add, Mul, Sub};
use d2m_lanes::F64x2;
use glam::DVec3;

/// Two vectors, component by component.
#[derive(Clone, Copy)]
pub struct TwoVec3 {
    /// Both first components.
    pub x: F64x2,
    /// Both second components.
    pub y: F64x2,
    /// Both third components.
    pub z: F64x2,
}

impl TwoVec3 {
    /// Side by side.
    #[inline(always)]
    pub fn new(first: DVec3, second: DVec3) -> Self {
        Self {
            x: F64x2::pack(first.x, second.x),
            y: F64x2::pack(first.y, second.y),
            z: F64x2::pack(first.z, second.z),
        }
    }

    /// The same twice.
    #[inline(always)]
    pub fn splat(v: DVec3) -> Self {
        Self { x: F64x2::splat(v.x), y: F64x2::splat(v.y), z: F64x2::splat(v.z) }
    }

    /// The first.
    #[inline(always)]
    pub fn first(self) -> DVec3 {
        DVec3::new(self.x.first(), self.y.first(), self.z.first())
    }

    /// The second.
    #[inline(always)]
    pub fn second(self) -> DVec3 {
        DVec3::new(self.x.second(), self.y.second(), self.z.second())
    }

    /// The first of each.
    #[inline(always)]
    pub fn firsts(self, o: Self) -> Self {
        Self::new(self.first(), o.first())
    }

    /// The second of each.
    #[inline(always)]
    pub fn seconds(self, o: Self) -> Self {
        Self::new(self.second(), o.second())
    }

    /// Exchanged.
    #[inline(always)]
    pub fn swap(self) -> Self {
        Self { x: self.x.swap(), y: self.y.swap(), z: self.z.swap() }
    }

    /// Dot products, vector by vector.
    #[inline(always)]
    pub fn dot(self, o: Self) -> F64x2 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Cross products, vector by vector.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self {
            x: self.y * o.z - self.z * o.y,
            y: self.z * o.x - self.x * o.z,
            z: self.x * o.y - self.y * o.x,
        }
    }

    /// Each times its own factor.
    #[inline(always)]
    pub fn scaled(self, s: F64x2) -> Self {
        Self { x: self.x * s, y: self.y * s, z: self.z * s }
    }
}

impl Add for TwoVec3 {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl Sub for TwoVec3 {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl Mul<f64> for TwoVec3 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, s: f64) -> Self {
        self.scaled(F64x2::splat(s))
    }
}
