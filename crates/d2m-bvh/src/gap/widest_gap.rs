//! Along which of many directions are two triangles widest apart?

use d2m_lanes::{Doubles, Elementwise, QuadVec, Two};
use glam::DVec3;

/// Of the 2 normals, the 9 products of edges, 3 edge normals and the line of centers: the direction with the widest gap.
#[inline(always)]
pub(crate) fn widest_gap<D: Doubles>(a: &[DVec3; 3], b: &[DVec3; 3]) -> WidestGap {
    let ea = [a[1] - a[0], a[2] - a[1], a[0] - a[2]];
    let eb = [b[1] - b[0], b[2] - b[1], b[0] - b[2]];
    let (normal_a, normal_b) = (ea[0].cross(ea[1]), eb[0].cross(eb[1]));
    let center = (b[0] + b[1] + b[2]) - (a[0] + a[1] + a[2]);
    let first = QuadVec::<D>::new([normal_a, normal_b, center, b[0] - a[0]]);
    let across = QuadVec::<D>::new([eb[0], eb[1], eb[2], normal_a]);
    let ends = QuadVec::<D>::splat(ea[1]).beside(&QuadVec::splat(ea[2]));
    let best = Widest::of(&first.beside(&across.crossed_by(ea[0])), a, b).or(&Widest::of(
        &ends.crossed(&across.beside(&across)),
        a,
        b,
    ));
    best.halves::<D>().of_all()
}

/// Of the two normals the one along which the gap is wider (not normalised).
#[inline(always)]
pub(crate) fn widest_normal(a: &[DVec3; 3], b: &[DVec3; 3]) -> DVec3 {
    let along = |n: DVec3| -> [f64; 2] {
        let (pa, pb) = (a.map(|p| n.dot(p)), b.map(|p| n.dot(p)));
        let gap = (least(&pb) - greatest(&pa)).max(least(&pa) - greatest(&pb));
        [gap * gap.abs(), n.length_squared()]
    };
    let (na, nb) = ((a[1] - a[0]).cross(a[2] - a[0]), (b[1] - b[0]).cross(b[2] - b[0]));
    let ([ga, la], [gb, lb]) = (along(na), along(nb));
    if ga * lb > gb * la { na } else { nb }
}

/// Directions side by side, the square of the gap along each (not normalised, zero when there is none) and of its length.
struct Widest<D> {
    axis: QuadVec<D>,
    gap_squared: D,
    length_squared: D,
}

/// The widest gap that was found.
#[derive(Clone, Copy)]
pub(crate) struct WidestGap {
    /// The direction, not normalised.
    pub(crate) direction: DVec3,
    /// The square of the gap along it, zero when there is none.
    gap_squared: f64,
    /// The square of the direction's length.
    length_squared: f64,
}

impl WidestGap {
    #[inline(always)]
    pub(crate) fn exceeds(&self, limit: f64) -> bool {
        self.gap_squared > limit * limit * self.length_squared
    }
}

impl<D: Elementwise<Scalar = f64>> Widest<D> {
    #[inline(always)]
    fn of(axis: &QuadVec<D>, a: &[DVec3; 3], b: &[DVec3; 3]) -> Self {
        // From vertex 0 of A: its own projection is zero.
        let zero = D::splat(0.0);
        let (a1, a2) = (axis.dot(a[1] - a[0]), axis.dot(a[2] - a[0]));
        let (b0, b1, b2) = (axis.dot(b[0] - a[0]), axis.dot(b[1] - a[0]), axis.dot(b[2] - a[0]));
        let (low_a, high_a) = (a1.min(a2).min(zero), a1.max(a2).max(zero));
        let (low_b, high_b) = (b0.min(b1).min(b2), b0.max(b1).max(b2));
        let gap = (low_b - high_a).max(low_a - high_b).max(zero);
        let length_squared = axis.length_squared();
        // No direction at all has a gap of zero.
        let length_squared = D::if_greater(length_squared, zero, length_squared, D::splat(1.0));
        Self { axis: *axis, gap_squared: gap * gap, length_squared }
    }

    /// In each lane the direction with the wider gap: gap²/|n|², compared without dividing.
    #[inline(always)]
    fn or(self, other: &Self) -> Self {
        let (left, right) =
            (other.gap_squared * self.length_squared, self.gap_squared * other.length_squared);
        let ([x, y, z], [u, v, w]) = (other.axis.0, self.axis.0);
        Self {
            axis: QuadVec([
                D::if_greater(left, right, x, u),
                D::if_greater(left, right, y, v),
                D::if_greater(left, right, z, w),
            ]),
            gap_squared: D::if_greater(left, right, other.gap_squared, self.gap_squared),
            length_squared: D::if_greater(left, right, other.length_squared, self.length_squared),
        }
    }

    /// In each lane the wider one of both halves.
    #[inline(always)]
    fn halves<H: Doubles<Two = D>>(self) -> Widest<H>
    where
        D: Two<H>,
    {
        let [x, y, z] = self.axis.0;
        let first = Widest {
            axis: QuadVec([x.first(), y.first(), z.first()]),
            gap_squared: self.gap_squared.first(),
            length_squared: self.length_squared.first(),
        };
        first.or(&Widest {
            axis: QuadVec([x.second(), y.second(), z.second()]),
            gap_squared: self.gap_squared.second(),
            length_squared: self.length_squared.second(),
        })
    }
}

impl<D: Doubles> Widest<D> {
    /// The widest of all lanes. Without a branch: which one it is cannot be predicted.
    #[inline(always)]
    fn of_all(self) -> WidestGap {
        let (gap, length) = (self.gap_squared.store().0, self.length_squared.store().0);
        let i = wider(&gap, &length, 0, 1);
        let j = wider(&gap, &length, 2, 3);
        let lane = wider(&gap, &length, i, j);
        let [x, y, z] = self.axis.0;
        let direction = DVec3::new(x.store().0[lane], y.store().0[lane], z.store().0[lane]);
        WidestGap { direction, gap_squared: gap[lane], length_squared: length[lane] }
    }
}

#[inline(always)]
pub(crate) fn least(v: &[f64; 3]) -> f64 {
    let m = if v[0] < v[1] { v[0] } else { v[1] };
    if m < v[2] { m } else { v[2] }
}

#[inline(always)]
pub(crate) fn greatest(v: &[f64; 3]) -> f64 {
    let m = if v[0] > v[1] { v[0] } else { v[1] };
    if m > v[2] { m } else { v[2] }
}

/// Of two lanes the one with the wider gap: `gap` and `length` hold squares.
#[inline(always)]
fn wider(gap: &[f64; 4], length: &[f64; 4], i: usize, j: usize) -> usize {
    [i, j][usize::from(gap[j & 3] * length[i & 3] > gap[i & 3] * length[j & 3])]
}
