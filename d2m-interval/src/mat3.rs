use core::ops::Mul;

use glam::{DMat3, DQuat, DVec3};

use crate::{Interval, IntervalVec3};

/// A 3×3 matrix of intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntervalMat3 {
    rows: [IntervalVec3; 3],
}

impl IntervalMat3 {
    /// The identity.
    pub const IDENTITY: Self = {
        let (o, e) = (Interval::ZERO, Interval::ONE);
        Self::from_rows([IntervalVec3::new(e, o, o), IntervalVec3::new(o, e, o), IntervalVec3::new(o, o, e)])
    };

    /// From three rows.
    #[inline]
    pub const fn from_rows(rows: [IntervalVec3; 3]) -> Self {
        Self { rows }
    }

    /// From three columns.
    #[inline]
    pub fn from_cols(cols: [IntervalVec3; 3]) -> Self {
        Self::from_rows(cols).transpose()
    }

    /// The three rows.
    #[inline]
    pub const fn rows(self) -> [IntervalVec3; 3] {
        self.rows
    }

    /// The three columns.
    #[inline]
    pub fn cols(self) -> [IntervalVec3; 3] {
        self.transpose().rows
    }

    /// The single matrix `m`.
    #[inline]
    pub fn point(m: DMat3) -> Self {
        let t = m.transpose();
        Self::from_rows([t.x_axis.into(), t.y_axis.into(), t.z_axis.into()])
    }

    /// `M v`.
    #[inline]
    pub fn mul_vec(self, v: IntervalVec3) -> IntervalVec3 {
        IntervalVec3::new(self.rows[0].dot(v), self.rows[1].dot(v), self.rows[2].dot(v))
    }

    /// `M p`.
    #[inline]
    pub fn mul_point(self, p: DVec3) -> IntervalVec3 {
        IntervalVec3::new(self.rows[0].dot_point(p), self.rows[1].dot_point(p), self.rows[2].dot_point(p))
    }

    /// `M N`.
    #[inline]
    pub fn mul_mat(self, n: Self) -> Self {
        let n = n.transpose();
        Self::from_rows(self.rows.map(|row| n.mul_vec(row)))
    }

    /// Rows become columns.
    #[inline]
    pub fn transpose(self) -> Self {
        let [a, b, c] = self.rows;
        Self::from_rows([
            IntervalVec3::new(a.x, b.x, c.x),
            IntervalVec3::new(a.y, b.y, c.y),
            IntervalVec3::new(a.z, b.z, c.z),
        ])
    }

    /// The smallest matrix that holds both.
    #[inline]
    pub fn hull(self, o: Self) -> Self {
        Self::from_rows(core::array::from_fn(|i| self.rows[i].hull(o.rows[i])))
    }

    /// The rotation of the unit quaternion `q/|q|`; all matrices when `q` is zero or not finite.
    pub fn from_quat_normalized(q: DQuat) -> Self {
        // Scaling by a power of two changes nothing in q/|q|; it is exact unless parts underflow,
        // so only quaternions that need it are scaled.
        let largest = q.x.abs().max(q.y.abs()).max(q.z.abs()).max(q.w.abs());
        let scale = if largest > 1e100 {
            f64::from_bits((1023 - 600) << 52)
        } else if largest < 1e-100 {
            f64::from_bits((1023 + 600) << 52)
        } else {
            1.0
        };
        let part = |a: f64| {
            let p = Interval::point(a) * scale;
            if scale == 1.0 { Interval::point(a) } else { p }
        };
        let (x, y, z, w) = (part(q.x), part(q.y), part(q.z), part(q.w));
        let (xx, yy, zz, ww) = (x.sqr(), y.sqr(), z.sqr(), w.sqr());
        let n = xx + yy + zz + ww;
        if n.lo() <= 0.0 {
            let e = Interval::ENTIRE;
            let row = IntervalVec3::new(e, e, e);
            return Self::from_rows([row, row, row]);
        }
        let s = Interval::point(2.0) / n;
        let one = Interval::ONE;
        let (xy, xz, yz) = (x * y, x * z, y * z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        Self::from_rows([
            IntervalVec3::new(one - s * (yy + zz), s * (xy - wz), s * (xz + wy)),
            IntervalVec3::new(s * (xy + wz), one - s * (xx + zz), s * (yz - wx)),
            IntervalVec3::new(s * (xz - wy), s * (yz + wx), one - s * (xx + yy)),
        ])
        .clamp_to_rotation()
    }

    /// `exp([ω] t)`: the rotations by `|ω| t` about `ω` (Rodrigues), for all `t` of the interval.
    pub fn rotation(omega: DVec3, t: Interval) -> Self {
        if omega == DVec3::ZERO {
            return Self::IDENTITY;
        }
        let largest = omega.abs().max_element();
        // Work with 2^k ω so that squares neither overflow nor vanish.
        let (scale, back) = if largest > 1e100 {
            (f64::from_bits((1023 - 600) << 52), f64::from_bits((1023 + 600) << 52))
        } else if largest < 1e-100 {
            (f64::from_bits((1023 + 600) << 52), f64::from_bits((1023 - 600) << 52))
        } else {
            (1.0, 1.0)
        };
        let w = if scale == 1.0 { IntervalVec3::point(omega) } else { IntervalVec3::point(omega) * scale };
        let length = w.norm();
        let angle = length * t * if back == 1.0 { Interval::ONE } else { Interval::point(back) };
        let inverse = length.recip();
        let n = w * inverse;
        let (sin, cos) = angle.sin_cos();
        let versine = (angle * 0.5).sin().sqr() * 2.0;
        let (nx, ny, nz) = (n.x * versine, n.y * versine, n.z * versine);
        let (xy, xz, yz) = (nx * n.y, nx * n.z, ny * n.z);
        let (sx, sy, sz) = (n.x * sin, n.y * sin, n.z * sin);
        Self::from_rows([
            IntervalVec3::new(cos + nx * n.x, xy - sz, xz + sy),
            IntervalVec3::new(xy + sz, cos + ny * n.y, yz - sx),
            IntervalVec3::new(xz - sy, yz + sx, cos + nz * n.z),
        ])
        .clamp_to_rotation()
    }

    /// Entries of rotation matrices lie in [−1, 1].
    fn clamp_to_rotation(self) -> Self {
        let unit = Interval::raw(-1.0, 1.0);
        Self::from_rows(self.rows.map(|r| {
            IntervalVec3::new(r.x.intersection(unit), r.y.intersection(unit), r.z.intersection(unit))
        }))
    }
}

impl Mul<IntervalVec3> for IntervalMat3 {
    type Output = IntervalVec3;
    fn mul(self, v: IntervalVec3) -> IntervalVec3 {
        self.mul_vec(v)
    }
}

impl Mul<DVec3> for IntervalMat3 {
    type Output = IntervalVec3;
    fn mul(self, p: DVec3) -> IntervalVec3 {
        self.mul_point(p)
    }
}

impl Mul for IntervalMat3 {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        self.mul_mat(o)
    }
}

impl From<DMat3> for IntervalMat3 {
    fn from(m: DMat3) -> Self {
        Self::point(m)
    }
}
