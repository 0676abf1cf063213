//! Rotations about a fixed axis: a quaternion in doubles, a matrix in double-double.
use crate::double_double::{DoubleDouble, two_product};
use crate::sin_cos::{LARGEST_ANGLE, sin_cos};
use glam::{DMat3, DQuat, DVec3};

/// exp([ω]s) as a unit quaternion, plain floating point with the project's own sine.
pub(crate) fn quat_of(omega: DVec3, s: f64) -> DQuat {
    let speed = omega.length();
    if speed == 0.0 || s == 0.0 {
        return DQuat::IDENTITY;
    }
    // Beyond the kernel's range the angle loses whole turns first: an estimate, but a finite one.
    let half = 0.5 * speed * s;
    let half = if half.abs() > LARGEST_ANGLE { half % core::f64::consts::TAU } else { half };
    let (sin, cos) = sin_cos(half);
    let axis = omega * (sin / speed);
    DQuat::from_xyzw(axis.x, axis.y, axis.z, cos)
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

    pub(crate) fn mul(&self, other: &Self) -> Self {
        let mut out = [[DoubleDouble::ZERO; 3]; 3];
        for (i, row) in out.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate() {
                for k in 0..3 {
                    *entry = entry.add(self.0[i][k].mul(other.0[k][j]));
                }
            }
        }
        Self(out)
    }

    pub(crate) fn apply(&self, v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        self.0.map(|row| row[0].mul(v[0]).add(row[1].mul(v[1])).add(row[2].mul(v[2])))
    }

    /// Transpose times vector.
    pub(crate) fn apply_transposed(&self, v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
        let m = &self.0;
        [0, 1, 2].map(|j| m[0][j].mul(v[0]).add(m[1][j].mul(v[1])).add(m[2][j].mul(v[2])))
    }
}

/// The rotation of `q/|q|` in double-double.
fn from_quat(q: DQuat) -> RotationDd {
    // Scaling by a power of two is exact and keeps the squares away from under- and overflow.
    let largest = q.x.abs().max(q.y.abs()).max(q.z.abs()).max(q.w.abs());
    let scale = f64::from_bits((2046 - (largest.to_bits() >> 52)) << 52);
    let q = [q.x * scale, q.y * scale, q.z * scale, q.w * scale];
    let product = |i: usize, j: usize| {
        let (hi, lo) = two_product(q[i], q[j]);
        DoubleDouble { hi, lo }
    };
    let (xx, yy, zz, ww) = (product(0, 0), product(1, 1), product(2, 2), product(3, 3));
    let norm = xx.add(yy).add(zz).add(ww);
    let half = |d: DoubleDouble| d.mul_f64(2.0).div(norm);
    let (xy, xz, yz) = (product(0, 1), product(0, 2), product(1, 2));
    let (wx, wy, wz) = (product(3, 0), product(3, 1), product(3, 2));
    let diagonal = |a: DoubleDouble, b: DoubleDouble| DoubleDouble::ONE.sub(half(a.add(b)));
    RotationDd([
        [diagonal(yy, zz), half(xy.sub(wz)), half(xz.add(wy))],
        [half(xy.add(wz)), diagonal(xx, zz), half(yz.sub(wx))],
        [half(xz.sub(wy)), half(yz.add(wx)), diagonal(xx, yy)],
    ])
}

/// exp([ω]s) in double-double (Rodrigues).
pub(crate) fn exponential_dd(omega: DVec3, s: DoubleDouble) -> RotationDd {
    let zero = DoubleDouble::ZERO;
    let square = |x: f64| {
        let (hi, lo) = two_product(x, x);
        DoubleDouble { hi, lo }
    };
    let speed = square(omega.x).add(square(omega.y)).add(square(omega.z)).sqrt();
    if speed.hi == 0.0 {
        let one = DoubleDouble::ONE;
        return RotationDd([[one, zero, zero], [zero, one, zero], [zero, zero, one]]);
    }
    let (sin, cos) = speed.mul(s).sin_cos();
    let axis = [omega.x, omega.y, omega.z].map(|w| DoubleDouble::from_f64(w).div(speed));
    let versine = DoubleDouble::ONE.sub(cos);
    let entry = |i: usize, j: usize| versine.mul(axis[i]).mul(axis[j]);
    let [x, y, z] = axis.map(|k| k.mul(sin));
    RotationDd([
        [entry(0, 0).add(cos), entry(0, 1).sub(z), entry(0, 2).add(y)],
        [entry(1, 0).add(z), entry(1, 1).add(cos), entry(1, 2).sub(x)],
        [entry(2, 0).sub(y), entry(2, 1).add(x), entry(2, 2).add(cos)],
    ])
}

/// exp([ω]s)·R(q/|q|) in double-double.
pub(crate) fn rotate_dd(omega: DVec3, s: DoubleDouble, q: DQuat) -> RotationDd {
    let start = from_quat(q);
    if omega == DVec3::ZERO { start } else { exponential_dd(omega, s).mul(&start) }
}
