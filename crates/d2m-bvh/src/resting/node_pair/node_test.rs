//! One box of one body against the eight boxes of a wide node of the other: how far apart are they at least?

use super::directions::{gap_along, gap_along_other, gap_along_own, gap_from_triangle};
use super::placed_box::Placed;
use crate::lanes::Lanes;
use crate::tree::margin::UNIT_F32;
use crate::tree::node::WideNode;

/// Factor of the error bound of a gap along a box axis; docs/theory/static-queries.md counts at most 29.
pub(super) const GAP_ERROR: f64 = 32.0 * UNIT_F32;
/// Covers the axes' deviation from orthonormal and the roundings of squares, sums and root: at most 9u.
const NORM_FACTOR: f32 = 1.0 - 16.0 * UNIT_F32 as f32;
/// Boxes are wider than what is sought by this factor: then the axes of the boxes are directions enough. (Any value is sound:
/// measured where boxes of bodies in near contact cost no more than without further directions.)
const WORTH_DIRECTIONS: f32 = 0.125;

/// Scalar product of lanes. (No closures and no `array::map` here: they are compiled without the vector instructions
/// unless they happen to be inlined.)
#[inline(always)]
pub(super) fn dot<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> L {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn splat<L: Lanes>(values: &[f32; 3]) -> [L; 3] {
    [L::splat(values[0]), L::splat(values[1]), L::splat(values[2])]
}

#[inline(always)]
pub(super) fn load<L: Lanes>(values: &[[f32; 8]; 3]) -> [L; 3] {
    [L::load(&values[0]), L::load(&values[1]), L::load(&values[2])]
}

/// How far a box is beyond another along one axis of either: distance of the centers, as projected, less what both reach
/// and the margin; not below zero.
#[inline(always)]
fn gap<L: Lanes>(between: L, own: L, other: &[L; 3], cosines: [L; 3], margin: L) -> L {
    let sizes = [cosines[0].abs(), cosines[1].abs(), cosines[2].abs()];
    (between.abs() - (own + dot(other, &sizes)) - margin).max(L::splat(0.0))
}

/// The boxes of a wide node and a single box, along the axes of both.
pub(super) struct Axes<L> {
    /// From the lane's center to the single one's.
    pub(super) to: [L; 3],
    /// Half extents of each lane's box and of the single box, and the axes of the former.
    pub(super) half: [L; 3],
    pub(super) other_half: [L; 3],
    pub(super) axes: [[L; 3]; 3],
    /// Cosines between axis i of the lane's box and axis j of the single one.
    pub(super) cosines: [[L; 3]; 3],
    /// The vector between the centers along the axes of either.
    pub(super) between: [L; 3],
    pub(super) other_between: [L; 3],
    /// Gaps along the three axes of each lane's box, and along the three of the single box; not below zero.
    pub(super) gaps: [L; 3],
    pub(super) other_gaps: [L; 3],
}

impl<L: Lanes> Axes<L> {
    #[inline(always)]
    fn new(wide: &WideNode, placed: &Placed) -> Self {
        let center = load::<L>(&wide.center);
        let at = splat::<L>(&placed.center);
        let to = [at[0] - center[0], at[1] - center[1], at[2] - center[2]];
        let h = load::<L>(&wide.half_extent);
        let a = [load::<L>(&wide.axes[0]), load::<L>(&wide.axes[1]), load::<L>(&wide.axes[2])];
        let b = [splat::<L>(&placed.axes[0]), splat::<L>(&placed.axes[1]), splat::<L>(&placed.axes[2])];
        let k = splat::<L>(&placed.half);
        let m = L::splat(placed.margin);
        let s = [
            [dot(&a[0], &b[0]), dot(&a[0], &b[1]), dot(&a[0], &b[2])],
            [dot(&a[1], &b[0]), dot(&a[1], &b[1]), dot(&a[1], &b[2])],
            [dot(&a[2], &b[0]), dot(&a[2], &b[1]), dot(&a[2], &b[2])],
        ];
        let between = [dot(&to, &a[0]), dot(&to, &a[1]), dot(&to, &a[2])];
        let other_between = [dot(&to, &b[0]), dot(&to, &b[1]), dot(&to, &b[2])];
        let gaps = [
            gap(between[0], h[0], &k, s[0], m),
            gap(between[1], h[1], &k, s[1], m),
            gap(between[2], h[2], &k, s[2], m),
        ];
        let other_gaps = [
            gap(other_between[0], k[0], &h, [s[0][0], s[1][0], s[2][0]], m),
            gap(other_between[1], k[1], &h, [s[0][1], s[1][1], s[2][1]], m),
            gap(other_between[2], k[2], &h, [s[0][2], s[1][2], s[2][2]], m),
        ];
        Self { to, half: h, other_half: k, axes: a, cosines: s, between, other_between, gaps, other_gaps }
    }
}

/// Lower bounds on the distances from the single box to each lane's box, in the working unit. A lane that holds no
/// box may get any value. Bounds above `enough` (working unit) need not be close.
#[inline(always)]
pub(super) fn lower_bounds<L: Lanes>(
    wide: &WideNode,
    placed: &Placed,
    to_work: f32,
    enough: f32,
) -> [f32; 8] {
    let axes = Axes::<L>::new(wide, placed);
    // |d|²(1 + 16u) ≥ Σ gap² for either frame: the distance of the box to the other's hull with parallel sides.
    let (own, other) = (dot(&axes.gaps, &axes.gaps), dot(&axes.other_gaps, &axes.other_gaps));
    let boxes = own.max(other).sqrt();
    let balls = dot(&axes.to, &axes.to).sqrt()
        - L::load(&wide.radius)
        - L::splat(placed.radius)
        - L::splat(placed.margin);
    let bound = boxes.max(balls).max(gap_along(wide, placed, &axes));
    let factor = L::splat(NORM_FACTOR) * L::splat(to_work);
    let used = (1u32 << wide.used.min(8)) - 1;
    if L::splat(enough).less_bits(bound * factor) & used == used {
        return (bound * factor).store();
    }
    let closer = match &placed.corners {
        Some(corners) => gap_from_triangle(wide, placed, &axes, corners),
        None if enough < WORTH_DIRECTIONS * placed.radius * to_work => return (bound * factor).store(),
        None => gap_along_own(wide, placed, &axes, own).max(gap_along_other(wide, placed, &axes, other)),
    };
    (closer.max(bound) * factor).store()
}

/// Bit i is set when lane i is not proven apart from the single box.
#[inline(always)]
pub(super) fn overlaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> u32 {
    let Axes { gaps: own, other_gaps: other, .. } = Axes::<L>::new(wide, placed);
    let most = own[0].max(own[1]).max(own[2].max(other[0])).max(other[1].max(other[2]));
    let used = (1u32 << wide.used.min(8)) - 1;
    !L::splat(0.0).less_bits(most) & used
}

/// The six gaps as computed before anything is taken off; zero where negative.
#[cfg(test)]
pub(super) fn margin_free_gaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> Vec<[f32; 8]> {
    let Axes { gaps, other_gaps, .. } = Axes::<L>::new(wide, &Placed { margin: 0.0, ..*placed });
    gaps.into_iter().chain(other_gaps).map(L::store).collect()
}
