//! The boxes of a wide node and a single box along the axes of both.

use super::placed_box::Placed;
use crate::tree::node::WideNode;
use d2m_lanes::Lanes;
use d2m_lanes::three::{dot, load, minus, splat};

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
    pub(super) own: [[L; 3]; 3],
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
    pub(super) fn new(wide: &WideNode, placed: &Placed) -> Self {
        let center = load::<L>(&wide.center);
        let single = &placed.boxed;
        let at = splat::<L, 4>(&single.center);
        let to = minus(&at, &center);
        let h = load::<L>(&wide.half_extent);
        let a = wide.wide_axes::<L>();
        let b = [splat::<L, 4>(&single.axes[0]), splat(&single.axes[1]), splat(&single.axes[2])];
        let k = splat::<L, 3>(&single.half);
        let m = L::splat(single.margin);
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
        Self { to, half: h, other_half: k, own: a, cosines: s, between, other_between, gaps, other_gaps }
    }
}
