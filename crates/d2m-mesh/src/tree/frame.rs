//! Orthonormal frames in `f64`, four side by side.

use crate::margin::{UNIT_F32, UNIT_F64};
use d2m_lanes::three::{dot, minus, times};
use d2m_lanes::{Doubles, Elementwise};

/// A direction whose square is below this is none: the square is about lost to underflow.
const LEAST_SQUARE: f64 = 1e-300;
/// Square of the sine of the angle below which a second direction is no other one.
const LEAST_SINE_SQUARE: f64 = 1e-18;

/// A vector in each lane.
pub(super) type Vectors<D> = [D; 3];

/// `if left > right { yes } else { no }` in each lane.
#[inline(always)]
fn select<D: Elementwise>(left: D, right: D, yes: &Vectors<D>, no: &Vectors<D>) -> Vectors<D> {
    [
        D::if_greater(left, right, yes[0], no[0]),
        D::if_greater(left, right, yes[1], no[1]),
        D::if_greater(left, right, yes[2], no[2]),
    ]
}

/// `v` without its part along the unit vectors `x`.
#[inline(always)]
fn across<D: Elementwise>(v: &Vectors<D>, x: &Vectors<D>) -> Vectors<D> {
    let along = dot(v, x);
    [v[0] - along * x[0], v[1] - along * x[1], v[2] - along * x[2]]
}

#[inline(always)]
fn unit<D: Doubles<Scalar = f64>>(v: &Vectors<D>) -> Vectors<D> {
    let inverse = D::splat(1.0) / dot(v, v).sqrt();
    times(v, inverse)
}

/// The first two axes of orthonormal frames from first directions and second ones; anything where they do not define them.
#[inline(always)]
pub(super) fn frames<D: Doubles<Scalar = f64>>(first: &Vectors<D>, second: &Vectors<D>) -> [Vectors<D>; 2] {
    let (zero, one) = (D::splat(0.0), D::splat(1.0));
    let any = [one, zero, zero];
    let first = select(dot(first, first), D::splat(LEAST_SQUARE), first, &any);
    let x = unit(&first);
    let y = across(second, &x);
    let least = D::splat(LEAST_SINE_SQUARE) * dot(second, second);
    let is_other = D::if_greater(dot(&y, &y), least.max(D::splat(LEAST_SQUARE)), one, zero);
    // The coordinate axis that is farthest from the first direction.
    let [a, b, c] = [x[0].abs(), x[1].abs(), x[2].abs()];
    let is_x = D::if_greater(a, b.min(c), zero, one);
    let is_y = D::if_greater(b, c, zero, one - is_x);
    let far = [is_x, is_y, one - is_x - is_y];
    let y = select(is_other, zero, &y, &across(&far, &x));
    [x, unit(&across(&unit(&y), &x))]
}

/// What ‖A·Aᵀ − I‖ of a box's axes may be, in the Frobenius norm: so in every entry and in the spectral norm.
///
/// First and second axes that are rounded to `f32` are each off by √3/2·u, and their cross product by as much as both and its own
/// roundings, 2.2u: in all that is at most 9.5u, 1.4u in the mean, and above 5.2u in one of 10⁸ frames.
pub(super) const MOST_DEVIATION: f64 = 5.2 * UNIT_F32;
/// What the norm is computed wrong by, at most: its sums err by less than 2⁻⁴⁹.
pub(super) const DEVIATION_ERROR: f64 = 32.0 * UNIT_F64;

/// ‖A·Aᵀ − I‖ of frames.
#[inline(always)]
pub(super) fn deviation<D: Doubles<Scalar = f64>>([x, y, z]: &[Vectors<D>; 3]) -> D {
    let one = D::splat(1.0);
    let (xx, yy, zz) = (dot(x, x) - one, dot(y, y) - one, dot(z, z) - one);
    let (xy, xz, yz) = (dot(x, y), dot(x, z), dot(y, z));
    let mixed = xy * xy + xz * xz + yz * yz;
    ((xx * xx + yy * yy + zz * zz) + (mixed + mixed)).sqrt()
}

/// Axes of triangles: longest edge, the direction across it; the third is the normal.
#[inline(always)]
pub(super) fn triangle_axes<D: Doubles<Scalar = f64>>(corners: &[Vectors<D>; 3]) -> [Vectors<D>; 2] {
    let [a, b, c] = corners;
    let edges = [minus(b, a), minus(c, b), minus(a, c)];
    let squares = [dot(&edges[0], &edges[0]), dot(&edges[1], &edges[1]), dot(&edges[2], &edges[2])];
    let first = select(squares[1], squares[0], &edges[1], &edges[0]);
    let second = select(squares[1], squares[0], &edges[2], &edges[1]);
    let longest = squares[0].max(squares[1]);
    let second = select(squares[2], longest, &edges[0], &second);
    let first = select(squares[2], longest, &edges[2], &first);
    frames(&first, &second)
}
