//! Rotations about a fixed axis: a quaternion or a matrix in doubles, a matrix in double-double.
use crate::double_double_trig::sin_cos_double;
use crate::sin_cos::{LARGEST_ANGLE, sin_cos};
use core::ops::Mul;
use d2m_interval::Interval;
use d2m_lanes::{DoubleDouble, power_of_two_below};
use glam::{DMat3, DQuat, DVec3};

/// Squared norms of quaternions between these lose nothing to under- or overflow in products of four.
const LEAST_SQUARED_NORM: f64 = 1e-200;
const MOST_SQUARED_NORM: f64 = 1e200;

/// exp([ω]s) as a unit quaternion, plain floating point with the project's own sine.
pub(crate) fn quat_of(omega: DVec3, s: f64) -> DQuat {
    let largest = omega.abs().max_element();
    if largest == 0.0 || s == 0.0 {
        return DQuat::IDENTITY;
    }
    // In a unit in which no square is lost to underflow.
    let unit = power_of_two_below(largest);
    let scaled = omega / unit;
    let speed = scaled.length();
    // Beyond the kernel's range the angle loses whole turns first: an estimate, but a finite one.
    let half = 0.5 * (speed * unit) * s;
    let half = if half.abs() > LARGEST_ANGLE { half % core::f64::consts::TAU } else { half };
    let (sin, cos) = sin_cos(half);
    let axis = scaled * (sin / speed);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)
}

/// Axis times angle in [0, π] of the rotation by a unit quaternion, to rounding; the same bits on every platform.
///
/// ```
/// use d2m_motion::{Pose, rotation_vector};
/// use glam::DVec3;
/// let turn = DVec3::new(0.5, -1.0, 2.0);
/// let pose = Pose::from_rotation_vector(DVec3::ZERO, turn);
/// assert!((rotation_vector(-pose.rotation) - turn).length() < 1e-15);
/// ```
pub fn rotation_vector(q: DQuat) -> DVec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let axis = DVec3::new(q.x, q.y, q.z);
    let sine = axis.length();
    if sine == 0.0 {
        return DVec3::ZERO;
    }
    // Accurate for small turns, where acos of the scalar part is not.
    let half = Interval::point(sine).atan2(Interval::point(q.w)).mid();
    axis * (2.0 * half / sine)
}

/// An angular velocity with its rounded length and direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spin {
    pub(crate) omega: DVec3,
    pub(crate) speed: f64,
    pub(crate) axis: DVec3,
}

impl Spin {
    pub(crate) fn new(omega: DVec3) -> Self {
        // Scaling keeps the squares of tiny and huge rates away from under- and overflow.
        let scale = omega.abs().max_element();
        if scale == 0.0 {
            return Self { omega, speed: 0.0, axis: DVec3::ZERO };
        }
        let scaled = omega / scale;
        let length = scaled.length();
        Self { omega, speed: scale * length, axis: scaled / length }
    }

    /// exp([ω]τ) by Rodrigues: `c·1 + s[k] + (1 − c)kkᵀ`.
    #[inline(always)]
    pub(crate) fn rotation(&self, tau: f64) -> DMat3 {
        if self.speed == 0.0 || tau == 0.0 {
            return DMat3::IDENTITY;
        }
        let (sin, cos) = sin_cos(self.speed * tau);
        self.rotation_of(sin, cos)
    }

    /// The same from the sine and cosine of the angle.
    #[inline(always)]
    pub(crate) fn rotation_of(&self, sin: f64, cos: f64) -> DMat3 {
        let k = self.axis;
        let s = k * sin;
        let v = k * (1.0 - cos);
        DMat3::from_cols(
            DVec3::new(cos + v.x * k.x, v.x * k.y + s.z, v.x * k.z - s.y),
            DVec3::new(v.y * k.x - s.z, cos + v.y * k.y, v.y * k.z + s.x),
            DVec3::new(v.z * k.x + s.y, v.z * k.y - s.x, cos + v.z * k.z),
        )
    }
}

/// The rotation of `q/|q|` within 36·2⁻⁵³ (Frobenius); `None` where squares might under- or overflow.
pub(crate) fn from_quat_rounded(q: DQuat) -> Option<DMat3> {
    let (xx, yy, zz) = (q.x * q.x, q.y * q.y, q.z * q.z);
    let norm = xx + yy + zz + q.w * q.w;
    if !(LEAST_SQUARED_NORM..=MOST_SQUARED_NORM).contains(&norm) {
        return None;
    }
    let s = 2.0 / norm;
    let (xy, xz, yz) = (q.x * q.y, q.x * q.z, q.y * q.z);
    let (wx, wy, wz) = (q.w * q.x, q.w * q.y, q.w * q.z);
    Some(DMat3::from_cols(
        DVec3::new(1.0 - s * (yy + zz), s * (xy + wz), s * (xz - wy)),
        DVec3::new(s * (xy - wz), 1.0 - s * (xx + zz), s * (yz + wx)),
        DVec3::new(s * (xz + wy), s * (yz - wx), 1.0 - s * (xx + yy)),
    ))
}

/// A rotation matrix in double-double, row by row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RotationDd(pub(crate) [[DoubleDouble; 3]; 3]);

impl RotationDd {
    /// Each entry rounded once.
    pub(crate) fn to_mat3(self) -> DMat3 {
        let m = &self.0;
        let column = |j: usize| DVec3::new(m[0][j].hi, m[1][j].hi, m[2][j].hi);
        DMat3::from_cols(column(0), column(1), column(2))
    }

    pub(crate) fn to_quat(self) -> DQuat {
        DQuat::from_mat3(&self.to_mat3()).normalize()
    }

    pub(crate) fn apply(&self, v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        self.0.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
    }

    /// Transpose times vector.
    pub(crate) fn apply_transposed(&self, v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        let m = &self.0;
        [0, 1, 2].map(|j| m[0][j] * v[0] + m[1][j] * v[1] + m[2][j] * v[2])
    }
}

impl Mul for RotationDd {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let mut out = [[DoubleDouble::ZERO; 3]; 3];
        for (i, row) in out.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                for k in 0..3 {
                    *entry = *entry + self.0[i][k] * other.0[k][j];
                }
            }
        }
        Self(out)
    }
}

/// The rotation of `q/|q|` in double-double.
fn from_quat(q: DQuat) -> RotationDd {
    // Scaling by a power of two is exact and keeps the squares away from under- and overflow.
    let largest = q.x.abs().max(q.y.abs()).max(q.z.abs()).max(q.w.abs());
    let scale = f64::from_bits((2046 - (largest.to_bits() >> 52)) << 52);
    let q = [q.x * scale, q.y * scale, q.z * scale, q.w * scale];
    let product = |i: usize, j: usize| DoubleDouble::from_product(q[i], q[j]);
    let (xx, yy, zz, ww) = (product(0, 0), product(1, 1), product(2, 2), product(3, 3));
    let norm = xx + yy + zz + ww;
    // One quotient for all entries: each errs by less than 2⁻¹⁰⁰.
    let factor = DoubleDouble::from_f64(2.0).div_accurately(norm);
    let half = |d: DoubleDouble| d * factor;
    let (xy, xz, yz) = (product(0, 1), product(0, 2), product(1, 2));
    let (wx, wy, wz) = (product(3, 0), product(3, 1), product(3, 2));
    let diagonal = |a: DoubleDouble, b: DoubleDouble| DoubleDouble::ONE - half(a + b);
    RotationDd([
        [diagonal(yy, zz), half(xy - wz), half(xz + wy)],
        [half(xy + wz), diagonal(xx, zz), half(yz - wx)],
        [half(xz - wy), half(yz + wx), diagonal(xx, yy)],
    ])
}

/// exp([ω]s) in double-double (Rodrigues).
pub(crate) fn exponential_dd(omega: DVec3, s: DoubleDouble) -> RotationDd {
    let zero = DoubleDouble::ZERO;
    // Rates near one: their squares neither under- nor overflow, and a power of two rounds nothing. (The largest power of
    // two has no normal reciprocal: half of it will do.)
    let rate = power_of_two_below(omega.abs().max_element()).min(0.5 * power_of_two_below(f64::MAX));
    let (omega, s) = (omega * (1.0 / rate), DoubleDouble { hi: s.hi * rate, lo: s.lo * rate });
    let square = |x: f64| DoubleDouble::from_product(x, x);
    let speed = (square(omega.x) + square(omega.y) + square(omega.z)).sqrt();
    if speed.hi == 0.0 {
        let one = DoubleDouble::ONE;
        return RotationDd([[one, zero, zero], [zero, one, zero], [zero, zero, one]]);
    }
    let (sin, cos) = sin_cos_double(speed * s);
    let inverse = DoubleDouble::ONE.div_accurately(speed);
    let axis = [omega.x, omega.y, omega.z].map(|w| inverse * w);
    let versine = DoubleDouble::ONE - cos;
    let entry = |i: usize, j: usize| versine * axis[i] * axis[j];
    let [x, y, z] = axis.map(|k| k * sin);
    RotationDd([
        [entry(0, 0) + cos, entry(0, 1) - z, entry(0, 2) + y],
        [entry(1, 0) + z, entry(1, 1) + cos, entry(1, 2) - x],
        [entry(2, 0) - y, entry(2, 1) + x, entry(2, 2) + cos],
    ])
}

/// exp([ω]s)·R(q/|q|) in double-double.
pub(crate) fn rotate_dd(omega: DVec3, s: DoubleDouble, q: DQuat) -> RotationDd {
    let start = from_quat(q);
    if omega == DVec3::ZERO || s.hi == 0.0 { start } else { exponential_dd(omega, s) * start }
}
