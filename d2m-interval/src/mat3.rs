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
        IntervalVec3::rows_times(&self.rows, v)
    }

    /// `M p`.
    #[inline]
    pub fn mul_point(self, p: DVec3) -> IntervalVec3 {
        IntervalVec3::rows_times_point(&self.rows, p)
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
        // Scaling by a power of two changes nothing in q/|q|, and keeps squares far from underflow.
        let k = -exponent(q.x.abs().max(q.y.abs()).max(q.z.abs()).max(q.w.abs()));
        let part = |a: f64| scaled(Interval::point(a), k);
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
        // With 2^k ω squares neither overflow nor vanish.
        let k = -exponent(omega.abs().max_element());
        let part = |a: f64| scaled(Interval::point(a), k);
        let w = IntervalVec3::new(part(omega.x), part(omega.y), part(omega.z));
        let length = w.norm();
        let angle = length * scaled(t, -k);
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

/// The k with `2^k ≤ x < 2^(k+1)` where that is far from 0 (else 0: nothing to scale).
fn exponent(x: f64) -> i32 {
    let k = (x.to_bits() >> 52 & 2047) as i32 - 1023;
    if k.abs() < 100 { 0 } else { k }
}

/// `x·2^k`, exactly unless that underflows.
fn scaled(x: Interval, k: i32) -> Interval {
    if k == 0 || x.is_empty() {
        return x;
    }
    let power = |p: i32| f64::from_bits(((1023 + p) as u64) << 52);
    let upper = |end: f64| {
        let y = end * power(k / 2) * power(k - k / 2);
        if end != 0.0 && y.abs() < 1e-290 {
            1e-290
        } else if y == f64::NEG_INFINITY {
            -f64::MAX
        } else {
            y
        }
    };
    Interval::raw(-upper(-x.lo()), upper(x.hi()))
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
