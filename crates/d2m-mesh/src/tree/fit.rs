//! Moments of a piece of surface.

use d2m_lanes::three::{cross, dot, minus};
use d2m_lanes::{Doubles, Quad};

/// Weight, first moments, and second moments xx, yy, zz, xy, xz, yz of a piece of surface; those of two pieces together are
/// their sums.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Moments(pub(super) [f64; Moments::LENGTH]);

/// What the area of a triangle (the body has radius one) counts at least, so that degenerate ones have a place, too. It weights the choice of
/// directions and cuts only: that boxes hold their triangles does not depend on it.
pub(super) const LEAST_AREA: f64 = 1e-12;

impl Moments {
    pub(super) const LENGTH: usize = 10;

    /// Adds those of another piece.
    pub(super) fn add(&mut self, other: &Self) {
        for (sum, part) in self.0.iter_mut().zip(&other.0) {
            *sum += part;
        }
    }

    /// The center of the area, about.
    pub(super) fn center(&self) -> [f32; 3] {
        let [weight, x, y, z, ..] = self.0;
        [(x / weight) as f32, (y / weight) as f32, (z / weight) as f32]
    }

    /// Second moments about the center, in units of their trace.
    pub(super) fn covariance(&self) -> [f32; 6] {
        let [weight, x, y, z, second @ ..] = &self.0;
        let (x, y, z) = (x / weight, y / weight, z / weight);
        let products = [x * x, y * y, z * z, x * y, x * z, y * z];
        let mut about = [0.0; 6];
        for k in 0..6 {
            about[k] = second[k] / weight - products[k];
        }
        let trace = about[0] + about[1] + about[2];
        // A point has none.
        let scale = if trace > 0.0 { 1.0 / trace } else { 0.0 };
        about.map(|c| (c * scale) as f32)
    }
}

/// The moments of four triangles side by side, each weighted by its area plus a small number so that degenerate ones
/// still count.
#[inline(always)]
pub(super) fn triangle_moments<D: Doubles<Scalar = f64>>(corners: &[[D; 3]; 3]) -> [Quad; Moments::LENGTH] {
    let [a, b, c] = corners;
    let n = cross(&minus(b, a), &minus(c, a));
    let area = D::splat(0.5) * dot(&n, &n).sqrt() + D::splat(LEAST_AREA);
    let sum = [a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]];
    // ∫ x xᵀ over a triangle = area/12 (Σ p pᵀ + s sᵀ) with s the sum of the vertices.
    let (third, twelfth) = (area * D::splat(1.0 / 3.0), area * D::splat(1.0 / 12.0));
    let mut moments = [area.store(); Moments::LENGTH];
    for k in 0..3 {
        moments[1 + k] = (third * sum[k]).store();
    }
    const PRODUCTS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
    for k in 0..6 {
        let (i, j) = PRODUCTS[k];
        let product = a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + sum[i] * sum[j];
        moments[4 + k] = (twelfth * product).store();
    }
    moments
}
