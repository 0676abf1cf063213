//! One box of one body against the eight boxes of a wide node of the other: how far apart are they at least?

use super::axes::Axes;
use super::directions::{gap_across_edge, gap_along, gap_along_other, gap_along_own, gap_from_triangle};
use super::placed_box::Placed;
use crate::margin::UNIT_F32;
use crate::tree::box_pair::BoxPair;
#[cfg(test)]
use crate::tree::box_pair::PlacedBox;
use crate::tree::node::WideNode;
use d2m_lanes::Lanes;
use d2m_lanes::three::dot;

/// Covers the axes' deviation from orthonormal and the roundings of squares, sums and root: at most 9u.
const NORM_FACTOR: f32 = 1.0 - 16.0 * UNIT_F32 as f32;
/// Boxes are wider than what is sought by this factor: then the axes of the boxes are directions enough. (Any value is sound:
/// measured where boxes of bodies in near contact cost no more than without further directions.)
const WORTH_DIRECTIONS: f32 = 0.125;

/// The bound, or zero where it is no number that was computed.
///
/// Bodies of very unlike sizes make sums and squares of `f32` overflow. A gap is what is between the centers less what the
/// boxes reach, and every term of the two is added or multiplied only: one that overflows makes the gap infinite or not a number,
/// never a wrong number. Directions that overflow are shortened to zero or are not numbers.
#[inline(always)]
fn known<L: Lanes>(bound: L) -> L {
    L::if_greater(L::splat(f32::INFINITY), bound, bound, L::splat(0.0))
}

/// Lower bounds on the distances from the single box to each lane's box, in the working unit; zero where nothing is known.
/// A lane that holds no box may get any value. Bounds above `enough` (working unit) need not be close.
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
    let spheres = dot(&axes.to, &axes.to).sqrt()
        - L::load(&wide.radius)
        - L::splat(placed.radius)
        - L::splat(placed.boxed.margin);
    let bound = boxes.max(spheres).max(gap_along(wide, placed, &axes));
    let factor = L::splat(NORM_FACTOR) * L::splat(to_work);
    let used = (1u32 << wide.used.min(8)) - 1;
    if L::splat(enough).less_bits(bound * factor) & used == used {
        return known(bound * factor).store();
    }
    let closer = match &placed.corners {
        Some(corners) => {
            let closer = gap_from_triangle(wide, placed, &axes, corners);
            match &placed.edge {
                Some(edge) => closer.max(gap_across_edge(wide, placed, &axes, corners, edge)),
                None => closer,
            }
        }
        None if enough < WORTH_DIRECTIONS * placed.radius * to_work => return known(bound * factor).store(),
        None => gap_along_own(wide, placed, &axes, own).max(gap_along_other(wide, placed, &axes, other)),
    };
    known(closer.max(bound) * factor).store()
}

/// Bit i is set when lane i is not proven apart from the single box. An infinite gap proves nothing: see [`known`].
#[inline(always)]
pub(super) fn overlaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> u32 {
    let gap = BoxPair::<L>::new(wide, &placed.boxed).gap(placed.boxed.margin);
    let used = (1u32 << wide.used.min(8)) - 1;
    !(L::splat(0.0).less_bits(gap) & gap.less_bits(L::splat(f32::INFINITY))) & used
}

/// The six gaps as computed before anything is taken off; zero where negative.
#[cfg(test)]
pub(super) fn margin_free_gaps<L: Lanes>(wide: &WideNode, placed: &Placed) -> Vec<[f32; 8]> {
    let boxed = PlacedBox { margin: 0.0, ..placed.boxed };
    let Axes { gaps, other_gaps, .. } = Axes::<L>::new(wide, &Placed { boxed, ..*placed });
    gaps.into_iter().chain(other_gaps).map(L::store).collect()
}
