//! Where the feature tests get their jets from: closed form for constant twists, interval enclosures otherwise.
mod enclosed;
mod rigid;

pub(crate) use enclosed::{EnclosedMotions, EnclosedPath, Extent};
pub(crate) use rigid::{FramedMotion, RigidPath};

use crate::rounding::{UNIT, UP, length_up};
use d2m_lanes::{power_of_two, two_sum};
use d2m_motion::{EdgeJets, PathJet, Remainder, TwoJets};
use d2m_root::{Cubic, Piece, Quadratic};
use glam::DVec3;

/// The motion of features of A in the frame of B, as jets about the middle of a piece of time.
pub(crate) trait FeaturePath {
    /// Jet of the point of A about `at`, valid on the piece. The remainder counts a dot product with a direction of
    /// length at most 1 and the comparison with points of B within the extent given at construction.
    fn point(&mut self, piece: Piece, at: f64) -> PathJet;

    /// [`FeaturePath::point`] along a direction of length at most 1 that is fixed in B's frame, with the remainder.
    #[inline(always)]
    fn point_along(&mut self, piece: Piece, at: f64, d: DVec3) -> CubicAlong {
        CubicAlong::new(&self.point(piece, at), d)
    }

    /// Jets of the point of A relative to the midpoint of B's edge and of the direction of A, and B's half edge: in axes
    /// that turn with B, whichever they are at that time.
    fn edges(&mut self, piece: Piece, at: f64, of_b: HalfEdge) -> EdgeJets;

    /// Bound of the point's speed.
    fn speed(&self) -> f64;

    /// Bound of the speed of the direction's tip.
    fn direction_speed(&self) -> f64;

    /// Bound of what a jet of the point leaves out of the Taylor series on a piece of this half-width (0 if that is
    /// not what limits the path).
    fn left_out(&self, half_width: f64) -> f64;

    /// Rounding that no narrow piece gets below.
    fn rounding(&self) -> f64;
}

/// The width of a piece on which features of this speed move by the tolerance.
#[inline(always)]
pub(crate) fn resolution(tolerance: f64, speed: f64) -> f64 {
    let resolution = tolerance / (2.0 * speed);
    if resolution.is_nan() { f64::INFINITY } else { resolution }
}

/// An edge of B as its midpoint and half of the vector between its ends.
#[derive(Clone, Copy)]
pub(crate) struct HalfEdge {
    pub(crate) middle: DVec3,
    pub(crate) half: DVec3,
}

/// A jet along a direction, as a cubic in the time from the jet's center, with the jet's remainder.
pub(crate) struct CubicAlong {
    pub(crate) cubic: Cubic,
    pub(crate) remainder: Remainder,
}

impl CubicAlong {
    #[inline(always)]
    fn new(jet: &PathJet, d: DVec3) -> Self {
        Self { cubic: cubic_along(jet, d), remainder: jet.remainder }
    }
}

/// A jet along a direction, as a cubic in the time from the jet's center.
#[inline(always)]
pub(crate) fn cubic_along(jet: &PathJet, d: DVec3) -> Cubic {
    Cubic { value: d.dot(jet.p), slope: d.dot(jet.v), curvature: d.dot(jet.a), jerk: d.dot(jet.j) }
}

/// A jet along a direction, as a quadratic in the time from the jet's center.
/// (The third derivative is left to the remainder.)
#[inline(always)]
pub(crate) fn along(jet: &PathJet, d: DVec3) -> Quadratic {
    Quadratic { value: d.dot(jet.p), slope: d.dot(jet.v), curvature: d.dot(jet.a) }
}

/// The jets of an edge of A in axes in which the midpoint and the half edge of B are at rest.
#[inline(always)]
fn against([point, direction]: [PathJet; 2], HalfEdge { middle, half }: HalfEdge) -> EdgeJets {
    let jets = TwoJets::new(&PathJet { p: point.p - middle, ..point }, &direction);
    EdgeJets { jets, half_b: half }
}

/// The piece relative to `at`, and back with the ends rounded outward and kept inside the piece.
#[inline(always)]
pub(crate) fn local(piece: Piece, at: f64) -> Piece {
    Piece { lo: piece.lo - at, hi: piece.hi - at }
}

/// The inverse of [`local`] for a part of the piece.
#[inline(always)]
pub(crate) fn global(part: Piece, at: f64, piece: Piece) -> Piece {
    let ((lo, lo_error), (hi, hi_error)) = (two_sum(at, part.lo), two_sum(at, part.hi));
    let lo = if lo_error < 0.0 { lo.next_down() } else { lo };
    let hi = if hi_error > 0.0 { hi.next_up() } else { hi };
    let lo = if lo > piece.lo { lo } else { piece.lo };
    let hi = if hi < piece.hi { hi } else { piece.hi };
    Piece { lo, hi: if hi > lo { hi } else { lo } }
}

/// More than the 2⁻⁵² that an end may move outward when it is rounded, as a part of the time: one unit in the last place of
/// a sum, and the rounding of this product.
const OUTWARD: f64 = 2.1 * UNIT;

/// The part with what [`global`] may add to it: up to 2⁻⁵²·|at + s| at either end, less than `OUTWARD`·(|at| + |s|).
#[inline(always)]
pub(crate) fn padded(part: Piece, at: f64, whole: Piece) -> Piece {
    let pad = OUTWARD * (at.abs() + whole.reach());
    let (lo, hi) = (part.lo - pad, part.hi + pad);
    Piece { lo: if lo > whole.lo { lo } else { whole.lo }, hi: if hi < whole.hi { hi } else { whole.hi } }
}

/// Adds a distance that counts as contact to a remainder.
#[inline(always)]
pub(crate) fn widened(remainder: Remainder, separation: f64) -> Remainder {
    Remainder { e0: remainder.e0 + separation, ..remainder }
}

/// The remainder of the jet's part to second order: the third derivative counts as an error.
#[inline(always)]
pub(crate) fn without_third(jet: &PathJet) -> Remainder {
    let m3 = (jet.remainder.m3 + length_up(jet.j)) * UP;
    Remainder { m3, ..jet.remainder }
}

/// 2⁻⁴⁸⁰ and 2⁴⁸⁰: the squares of what lies between are normal, and so are their sums.
const SQUARE_ROOTS: (f64, f64) = (power_of_two(-480), power_of_two(480));
/// Keeps a computed direction from being longer than 1: the length errs by 3.5·2⁻⁵³, the quotient and the product by 1 each.
const SHORTER: f64 = 1.0 - 8.0 * UNIT;

/// A vector of length at most 1 (and at least 1 − 16·2⁻⁵³) along `v`; zero if `v` is zero or not finite.
#[inline]
pub(crate) fn direction(v: DVec3) -> DVec3 {
    let scale = v.abs().max_element();
    if !(SQUARE_ROOTS.0..=SQUARE_ROOTS.1).contains(&scale) {
        if scale > 0.0 && scale.is_finite() {
            // Out of the range whose squares are normal: bring it there first, by a power of two.
            return direction(v * (if scale < 1.0 { SQUARE_ROOTS.1 } else { SQUARE_ROOTS.0 }));
        }
        return DVec3::ZERO;
    }
    v * (SHORTER / v.length())
}

/// The part and as much again on either side, inside the piece: where it is bracketed with signs that are certain.
#[inline(always)]
pub(crate) fn around(part: Piece, whole: Piece) -> Piece {
    let width = part.width();
    let (lo, hi) = (part.lo - width, part.hi + width);
    Piece { lo: if lo > whole.lo { lo } else { whole.lo }, hi: if hi < whole.hi { hi } else { whole.hi } }
}
