//! Gaps of boxes with cut edges, and of triangles, along directions other than the boxes' axes.
//!
//! For any n with |n| ≤ 1 the gap of the projections onto n is a lower bound of the distance. Far from contact it is the choice of
//! n that counts: the line of the closest points proves almost the whole distance, a box's axes often much less. Errors of
//! these gaps are below twice the margin of those along the axes; docs/theory/static-queries.md counts them.

use super::axes::Axes;
use super::placed_box::Placed;
use crate::margin::UNIT_F32;
use crate::tree::node::WideNode;
use crate::tree::slabs::reach;
use d2m_lanes::Lanes;
use d2m_lanes::three::{cross, dot, load, minus, splat, times};

/// Makes computed unit vectors no longer than one: their lengths err by at most five roundings.
const SHORTENED: f32 = 1.0 - 8.0 * UNIT_F32 as f32;
/// Squares of lengths below this are not distinguished from zero; what is divided by its root then is shorter than one.
const LEAST_SQUARE: f32 = f32::MIN_POSITIVE;

/// How far the lanes' boxes reach along directions that have these cosines with their axes, or along the opposite ones
/// where `along` is negative.
#[inline(always)]
fn wide_reach<L: Lanes>(wide: &WideNode, axes: &Axes<L>, cosines: &[L; 3], along: L) -> L {
    let slabs = load::<L>(&wide.slabs);
    reach::<L, 3>(&axes.half, &slabs, cosines, along).min(L::load(&wide.radius))
}

/// The same for the single box, against the directions.
#[inline(always)]
fn single_reach_back<L: Lanes>(placed: &Placed, axes: &Axes<L>, cosines: &[L; 3]) -> L {
    let slabs = splat::<L, 3>(&placed.boxed.slabs);
    reach::<L, 3>(&axes.other_half, &slabs, cosines, L::splat(1.0)).min(L::splat(placed.radius))
}

#[inline(always)]
fn twice_margin<L: Lanes>(placed: &Placed) -> L {
    L::splat(placed.boxed.margin + placed.boxed.margin)
}

/// 1/|v| for a vector of this squared length, shortened.
#[inline(always)]
fn inverse_length<L: Lanes>(square: L) -> L {
    L::splat(SHORTENED) / square.max(L::splat(LEAST_SQUARE)).sqrt()
}

/// Along the direction that the single box was prepared for.
#[inline(always)]
pub(super) fn gap_along<L: Lanes>(wide: &WideNode, placed: &Placed, axes: &Axes<L>) -> L {
    let n = splat::<L, 3>(&placed.along);
    let between = L::splat(placed.at_along) - dot(&load::<L>(&wide.center), &n);
    let cosines = [dot(&n, &axes.own[0]), dot(&n, &axes.own[1]), dot(&n, &axes.own[2])];
    let [forth, back] = placed.reach_along;
    // The single box lies where `between` points, and reaches back from there.
    let other = L::if_greater(between, L::splat(0.0), L::splat(back), L::splat(forth));
    between.abs() - wide_reach(wide, axes, &cosines, between) - other - twice_margin(placed)
}

/// Along the shortest way from each lane's box to the hull of the single one with parallel sides; `square`: its squared
/// length. Proves at least that length, usually more: the hull is wider than the box.
#[inline(always)]
pub(super) fn gap_along_own<L: Lanes>(wide: &WideNode, placed: &Placed, axes: &Axes<L>, square: L) -> L {
    let n = shortest(&axes.gaps, &axes.between, square);
    let s = &axes.cosines;
    let other = [
        dot(&n, &[s[0][0], s[1][0], s[2][0]]),
        dot(&n, &[s[0][1], s[1][1], s[2][1]]),
        dot(&n, &[s[0][2], s[1][2], s[2][2]]),
    ];
    gap_between(wide, placed, axes, dot(&n, &axes.between), [&n, &other])
}

/// The same in the frame of the single box.
#[inline(always)]
pub(super) fn gap_along_other<L: Lanes>(wide: &WideNode, placed: &Placed, axes: &Axes<L>, square: L) -> L {
    let n = shortest(&axes.other_gaps, &axes.other_between, square);
    let s = &axes.cosines;
    let own = [dot(&n, &s[0]), dot(&n, &s[1]), dot(&n, &s[2])];
    gap_between(wide, placed, axes, dot(&n, &axes.other_between), [&own, &n])
}

/// The direction of these gaps along the axes of a box, of which `square` is the sum of the squares.
#[inline(always)]
fn shortest<L: Lanes>(gaps: &[L; 3], between: &[L; 3], square: L) -> [L; 3] {
    let [x, y, z] = times(gaps, inverse_length(square));
    [L::flip_sign(x, between[0]), L::flip_sign(y, between[1]), L::flip_sign(z, between[2])]
}

/// Along a direction from the lanes' boxes to the single one: the distance of the centers and the cosines with the axes of both.
#[inline(always)]
fn gap_between<L: Lanes>(
    wide: &WideNode,
    placed: &Placed,
    axes: &Axes<L>,
    centers: L,
    [own, other]: [&[L; 3]; 2],
) -> L {
    centers
        - wide_reach(wide, axes, own, L::splat(1.0))
        - single_reach_back(placed, axes, other)
        - twice_margin(placed)
}

/// Along the line from the triangle in the single box to the center of each lane's box.
#[inline(always)]
pub(super) fn gap_from_triangle<L: Lanes>(
    wide: &WideNode,
    placed: &Placed,
    axes: &Axes<L>,
    corners: &[[f32; 3]; 3],
) -> L {
    let center = load::<L>(&wide.center);
    let [p, q, r] = [splat::<L, 3>(&corners[0]), splat::<L, 3>(&corners[1]), splat::<L, 3>(&corners[2])];
    let towards = from_triangle(&p, &q, &r, &center);
    gap_towards(wide, placed, axes, [&p, &q, &r], &towards)
}

/// Along the direction across an edge of the triangle and the longest axis of each lane's box.
#[inline(always)]
pub(super) fn gap_across_edge<L: Lanes>(
    wide: &WideNode,
    placed: &Placed,
    axes: &Axes<L>,
    corners: &[[f32; 3]; 3],
    edge: &[f32; 3],
) -> L {
    let center = load::<L>(&wide.center);
    let [p, q, r] = [splat::<L, 3>(&corners[0]), splat::<L, 3>(&corners[1]), splat::<L, 3>(&corners[2])];
    let across = cross(&splat::<L, 3>(edge), &axes.own[0]);
    let side = dot(&across, &minus(&center, &p));
    let towards =
        [L::flip_sign(across[0], side), L::flip_sign(across[1], side), L::flip_sign(across[2], side)];
    gap_towards(wide, placed, axes, [&p, &q, &r], &towards)
}

/// Along a direction of any length from the triangle to the boxes.
#[inline(always)]
fn gap_towards<L: Lanes>(
    wide: &WideNode,
    placed: &Placed,
    axes: &Axes<L>,
    [p, q, r]: [&[L; 3]; 3],
    towards: &[L; 3],
) -> L {
    let center = load::<L>(&wide.center);
    let n = times(towards, inverse_length(dot(towards, towards)));
    let most = dot(&n, p).max(dot(&n, q)).max(dot(&n, r));
    let cosines = [dot(&n, &axes.own[0]), dot(&n, &axes.own[1]), dot(&n, &axes.own[2])];
    dot(&n, &center) - most - wide_reach(wide, axes, &cosines, L::splat(-1.0)) - twice_margin(placed)
}

/// About the direction, of any length, from the closest point of a triangle to a point.
#[inline(always)]
fn from_triangle<L: Lanes>(p: &[L; 3], q: &[L; 3], r: &[L; 3], point: &[L; 3]) -> [L; 3] {
    let zero = L::splat(0.0);
    let (pq, qr, rp) = (minus(q, p), minus(r, q), minus(p, r));
    let (from_p, from_q, from_r) = (minus(point, p), minus(point, q), minus(point, r));
    let first = from_segment(&from_p, &pq);
    let second = from_segment(&from_q, &qr);
    let third = from_segment(&from_r, &rp);
    let shorter = shorter(&shorter(&first, &second), &third);
    let normal = cross(&pq, &qr);
    let inside = dot(&from_p, &cross(&normal, &pq))
        .min(dot(&from_q, &cross(&normal, &qr)))
        .min(dot(&from_r, &cross(&normal, &rp)));
    let height = dot(&from_p, &normal);
    [
        L::if_greater(inside, zero, L::flip_sign(normal[0], height), shorter[0]),
        L::if_greater(inside, zero, L::flip_sign(normal[1], height), shorter[1]),
        L::if_greater(inside, zero, L::flip_sign(normal[2], height), shorter[2]),
    ]
}

/// From the closest point of a segment, which begins `offset` before the point.
#[inline(always)]
fn from_segment<L: Lanes>(offset: &[L; 3], segment: &[L; 3]) -> [L; 3] {
    let part = dot(offset, segment) / dot(segment, segment).max(L::splat(LEAST_SQUARE));
    let part = part.max(L::splat(0.0)).min(L::splat(1.0));
    minus(offset, &times(segment, part))
}

#[inline(always)]
fn shorter<L: Lanes>(a: &[L; 3], b: &[L; 3]) -> [L; 3] {
    let (x, y) = (dot(a, a), dot(b, b));
    [L::if_greater(x, y, b[0], a[0]), L::if_greater(x, y, b[1], a[1]), L::if_greater(x, y, b[2], a[2])]
}
