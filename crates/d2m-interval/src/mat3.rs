use core::ops::Mul;

use glam::{DMat3, DQuat, DVec3};

use crate::{Interval, IntervalVec3};
use d2m_lanes::{F64x2, UNIT, power_of_two};

/// A 3×3 matrix of intervals.
///
/// ```
/// use d2m_interval::{Interval, IntervalMat3};
/// use glam::DVec3;
/// // Every turn about z by 0 to 0.1 radians.
/// let turns = IntervalMat3::rotation(DVec3::Z, Interval::new(0.0, 0.1));
/// let tip = turns.mul_point(DVec3::X);
/// assert!(tip.x.contains(0.05f64.cos()) && tip.y.contains(0.05f64.sin()) && tip.z.contains(0.0));
/// ```
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

    /// A box about the matrices whose entries are within `radius` of those of `m`: those of a distance in the operator norm are.
    ///
    /// ```
    /// # use d2m_interval::IntervalMat3;
    /// # use glam::{DMat3, DVec3};
    /// let nearly = IntervalMat3::around(DMat3::IDENTITY, 0.1);
    /// assert!(nearly.mul_point(DVec3::X).contains(DVec3::new(0.95, 0.05, -0.05)) && nearly.mid() == DMat3::IDENTITY);
    /// ```
    #[inline]
    pub fn around(m: DMat3, radius: f64) -> Self {
        let t = m.transpose();
        Self::from_rows([t.x_axis, t.y_axis, t.z_axis].map(|row| IntervalVec3::around(row, radius)))
    }

    /// The middles of the entries.
    #[inline]
    pub fn mid(self) -> DMat3 {
        let [x, y, z] = self.cols().map(IntervalVec3::mid);
        DMat3::from_cols(x, y, z)
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
        let [a, b, c] = self.rows;
        Self::from_rows([n.mul_vec(a), n.mul_vec(b), n.mul_vec(c)])
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
    ///
    /// In plain floating point with a bound known in advance, u = 2⁻⁵³: with n = |q|² and s = 2/n (5u), an entry
    /// s(ab ± cd) has s(|ab| + |cd|) ≤ 1 and so an error of (5 + 2 + 1)u; 1 − s(aa + bb) has s(aa + bb) ≤ 2 and so
    /// 2·8u + u. Padded by 10u and 20u, which leaves more than the rounding of the ends.
    pub fn from_quat_normalized(q: DQuat) -> Self {
        // Between them no square overflows, and one that underflows is far below u of the sum.
        const SMALLEST_SQUARE: f64 = 1e-200;
        const LARGEST_SQUARE: f64 = 1e200;
        let (xx, yy, zz) = (q.x * q.x, q.y * q.y, q.z * q.z);
        let n = xx + yy + zz + q.w * q.w;
        if !(SMALLEST_SQUARE..=LARGEST_SQUARE).contains(&n) {
            return Self::from_quat_scaled(q);
        }
        let s = 2.0 / n;
        let (xy, xz, yz) = (q.x * q.y, q.x * q.z, q.y * q.z);
        let (wx, wy, wz) = (q.w * q.x, q.w * q.y, q.w * q.z);
        let padded = |v: f64, pad: f64| Interval::raw(v - pad * UNIT, v + pad * UNIT);
        let (beside, diagonal) = (|v: f64| padded(s * v, 10.0), |v: f64| padded(1.0 - s * v, 20.0));
        Self::from_rows([
            IntervalVec3::new(diagonal(yy + zz), beside(xy - wz), beside(xz + wy)),
            IntervalVec3::new(beside(xy + wz), diagonal(xx + zz), beside(yz - wx)),
            IntervalVec3::new(beside(xz - wy), beside(yz + wx), diagonal(xx + yy)),
        ])
        .clamp_to_rotation()
    }

    /// The same in interval arithmetic, for quaternions whose squares leave the range of doubles.
    fn from_quat_scaled(q: DQuat) -> Self {
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

    /// Entries of rotation matrices lie in [−1, 1]; with lower ends kept negated that is one minimum.
    #[inline(always)]
    fn clamp_to_rotation(self) -> Self {
        let clamped = |i: Interval| Interval(i.0.min(F64x2::splat(1.0)));
        let row = |r: IntervalVec3| IntervalVec3::new(clamped(r.x), clamped(r.y), clamped(r.z));
        let [a, b, c] = self.rows;
        Self::from_rows([row(a), row(b), row(c)])
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
    // A smaller end may have lost bits; this is above it, and below 2⁻⁵⁰⁰.
    const FAR_FROM_UNDERFLOW: f64 = 1e-290;
    let upper = |end: f64| {
        let y = end * power_of_two(k / 2) * power_of_two(k - k / 2);
        if end != 0.0 && y.abs() < FAR_FROM_UNDERFLOW {
            FAR_FROM_UNDERFLOW
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
