//! Axes for a part of a surface: second moments and their eigenvectors.

/// First and second moments of a piece of surface.
#[derive(Clone, Copy, Default)]
pub(super) struct Moments {
    weight: f64,
    first: [f64; 3],
    /// xx, yy, zz, xy, xz, yz.
    second: [f64; 6],
}

impl Moments {
    /// Adds a triangle, weighted by its area plus a small number so that degenerate ones still count.
    #[inline]
    pub(super) fn add(&mut self, corners: &[[f64; 3]; 3]) {
        let [a, b, c] = corners;
        let e = sub(*b, *a);
        let f = sub(*c, *a);
        let n = cross(e, f);
        let area = 0.5 * dot(n, n).sqrt() + LEAST_AREA;
        let sum = [a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]];
        self.weight += area;
        // ∫ x xᵀ over a triangle = area/12 (Σ p pᵀ + s sᵀ) with s the sum of the vertices.
        let w = area / 12.0;
        for k in 0..3 {
            self.first[k] += area / 3.0 * sum[k];
            self.second[k] += w * (a[k] * a[k] + b[k] * b[k] + c[k] * c[k] + sum[k] * sum[k]);
        }
        for (slot, (i, j)) in [(3, (0, 1)), (4, (0, 2)), (5, (1, 2))] {
            self.second[slot] += w * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum[i] * sum[j]);
        }
    }

    /// Numbers that make up the moments, rounded up to a multiple of four.
    pub(super) const LENGTH: usize = 12;

    /// The numbers in `f32`; those of two pieces together are their sums.
    pub(super) fn narrow(&self) -> [f32; Self::LENGTH] {
        let (f, s) = (self.first, self.second);
        [self.weight, f[0], f[1], f[2], s[0], s[1], s[2], s[3], s[4], s[5], 0.0, 0.0].map(|x| x as f32)
    }

    /// From such numbers.
    pub(super) fn widen(numbers: &[f32; Self::LENGTH]) -> Self {
        let [weight, f0, f1, f2, s0, s1, s2, s3, s4, s5, ..] = numbers.map(f64::from);
        Self { weight, first: [f0, f1, f2], second: [s0, s1, s2, s3, s4, s5] }
    }

    /// Second moments about the center.
    fn covariance(&self) -> [[f64; 3]; 3] {
        let mean = self.first.map(|s| s / self.weight);
        let s = self.second.map(|s| s / self.weight);
        [
            [s[0] - mean[0] * mean[0], s[3] - mean[0] * mean[1], s[4] - mean[0] * mean[2]],
            [s[3] - mean[0] * mean[1], s[1] - mean[1] * mean[1], s[5] - mean[1] * mean[2]],
            [s[4] - mean[0] * mean[2], s[5] - mean[1] * mean[2], s[2] - mean[2] * mean[2]],
        ]
    }

    /// Orthonormal axes, the longest extent first.
    pub(super) fn axes(&self) -> [[f64; 3]; 3] {
        principal_axes(self.covariance())
    }

    /// √(λ₁λ₂ + λ₁λ₃ + λ₂λ₃) for the eigenvalues of the covariance: about the area of the box, up to a factor.
    pub(super) fn spread(&self) -> f64 {
        let m = self.covariance();
        let minor = |i: usize, j: usize| m[i][i] * m[j][j] - m[i][j] * m[i][j];
        (minor(0, 1) + minor(0, 2) + minor(1, 2)).max(0.0).sqrt()
    }
}

// Axes may be any: boxes are measured along what comes out. These numbers only keep out what is not a number.

/// What the area of a triangle (the body has radius one) counts at least: degenerate ones have a place, too.
const LEAST_AREA: f64 = 1e-12;
/// A direction shorter than this is none: its square is about lost to underflow.
const SHORTEST: f64 = 1e-150;
/// Sine of the angle below which a second direction is no other one.
const LEAST_SINE: f64 = 1e-9;
/// Part of the square of the diagonal at which a matrix counts as diagonal: axes within 1e-6.
const OFF_DIAGONAL: f64 = 1e-12;

/// Axes of one triangle: longest edge, the direction across it, the normal.
pub(super) fn triangle_axes(corners: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let edges = [sub(corners[1], corners[0]), sub(corners[2], corners[1]), sub(corners[0], corners[2])];
    let longest =
        (0..3).max_by(|&i, &j| dot(edges[i], edges[i]).total_cmp(&dot(edges[j], edges[j]))).unwrap_or(0);
    complete(edges[longest], edges[(longest + 1) % 3])
}

/// An orthonormal frame from a first direction and a second one; anything where they do not define it.
fn complete(first: [f64; 3], second: [f64; 3]) -> [[f64; 3]; 3] {
    let length = dot(first, first).sqrt();
    if length.is_nan() || length < SHORTEST {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    }
    let x = first.map(|c| c / length);
    let across = |v: [f64; 3]| {
        let along = dot(v, x);
        [v[0] - along * x[0], v[1] - along * x[1], v[2] - along * x[2]]
    };
    let mut y = across(second);
    let scale = dot(second, second).sqrt();
    if dot(y, y).sqrt().is_nan() || dot(y, y).sqrt() <= LEAST_SINE * scale {
        let k = (0..3).min_by(|&i, &j| x[i].abs().total_cmp(&x[j].abs())).unwrap_or(0);
        let mut unit = [0.0; 3];
        unit[k] = 1.0;
        y = across(unit);
    }
    let length = dot(y, y).sqrt();
    let y = across(y.map(|c| c / length));
    let length = dot(y, y).sqrt();
    let y = y.map(|c| c / length);
    [x, y, cross(x, y)]
}

/// Eigenvectors of a symmetric matrix by Jacobi rotations, the largest eigenvalue first.
fn principal_axes(mut m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let mut v = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]; // rows are the axes
    for _ in 0..12 {
        let off = m[0][1] * m[0][1] + m[0][2] * m[0][2] + m[1][2] * m[1][2];
        let diagonal = m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2];
        if off.is_nan() || off <= OFF_DIAGONAL * diagonal {
            break;
        }
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let c = 1.0 / (t * t + 1.0).sqrt();
            let s = t * c;
            for row in &mut m {
                (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
            }
            let (mp, mq) = (m[p], m[q]);
            for k in 0..3 {
                m[p][k] = c * mp[k] - s * mq[k];
                m[q][k] = s * mp[k] + c * mq[k];
            }
            let (vp, vq) = (v[p], v[q]);
            for k in 0..3 {
                v[p][k] = c * vp[k] - s * vq[k];
                v[q][k] = s * vp[k] + c * vq[k];
            }
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|&i: &usize, &j: &usize| m[j][j].total_cmp(&m[i][i]));
    complete(v[order[0]], v[order[1]])
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
