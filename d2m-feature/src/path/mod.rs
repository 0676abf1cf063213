//! Where the feature tests get their jets from: closed form for constant twists, interval enclosures otherwise.
mod enclosed;
mod rigid;

pub(crate) use enclosed::{EnclosedMotions, EnclosedPath, Extent};
pub(crate) use rigid::{FramedMotion, RigidPath};

use d2m_motion::{PathJet, Remainder};
use d2m_root::{Piece, Quadratic};
use glam::DVec3;

/// The motion of features of A in the frame of B, as jets about the middle of a piece of time.
pub(crate) trait FeaturePath {
    /// Jet of the point of A about `at`, valid on the piece. The remainder counts a dot product with a direction of
    /// length at most 1 and the comparison with points of B within the extent given at construction.
    fn point(&mut self, piece: Piece, at: f64) -> PathJet;

    /// Jets of the point and of the direction of A.
    fn point_and_direction(&mut self, piece: Piece, at: f64) -> (PathJet, PathJet);

    /// Bound of the point's speed.
    fn speed(&self) -> f64;

    /// Bound of the speed of the direction's tip.
    fn direction_speed(&self) -> f64;

    /// Bound of the point's third derivative (0 if the path makes no use of one).
    fn jerk(&self) -> f64;

    /// Rounding that no narrow piece gets below.
    fn rounding(&self) -> f64;
}

/// A jet along a direction, as a quadratic in the time from the jet's centre.
#[inline(always)]
pub(crate) fn along(jet: &PathJet, d: DVec3) -> Quadratic {
    Quadratic { value: d.dot(jet.p), slope: d.dot(jet.v), curvature: d.dot(jet.a) }
}

/// The largest |s| of a part.
#[inline(always)]
pub(crate) fn reach(part: Piece) -> f64 {
    part.lo.abs().max(part.hi.abs())
}

/// The piece relative to `at`, and back with the ends rounded outward and kept inside the piece.
#[inline(always)]
pub(crate) fn local(piece: Piece, at: f64) -> Piece {
    Piece { lo: piece.lo - at, hi: piece.hi - at }
}

/// The inverse of [`local`] for a part of the piece.
#[inline(always)]
pub(crate) fn global(part: Piece, at: f64, piece: Piece) -> Piece {
    let below = |s: f64| {
        let sum = at + s;
        // The error of the sum, exactly, because |s| ≤ |at| or the sum is exact enough: two-sum.
        let t = sum - at;
        let error = (at - (sum - t)) + (s - t);
        if error < 0.0 { sum.next_down() } else { sum }
    };
    let above = |s: f64| -> f64 {
        let sum = at + s;
        let t = sum - at;
        let error = (at - (sum - t)) + (s - t);
        if error > 0.0 { sum.next_up() } else { sum }
    };
    let lo = below(part.lo).max(piece.lo);
    Piece { lo, hi: above(part.hi).min(piece.hi).max(lo) }
}

/// Adds a distance that counts as contact to a remainder.
#[inline(always)]
pub(crate) fn widened(remainder: Remainder, separation: f64) -> Remainder {
    Remainder { e0: remainder.e0 + separation, ..remainder }
}

/// A vector of length at most 1 (and at least 1 − 16·2⁻⁵³) along `v`; zero if `v` is zero or not finite.
#[inline]
pub(crate) fn direction(v: DVec3) -> DVec3 {
    let scale = v.abs().max_element();
    if !(1e-140..=1e140).contains(&scale) {
        if scale > 0.0 && scale.is_finite() {
            // Out of the range whose squares are normal: bring it there first.
            return direction(v * (if scale < 1.0 { 1e150 } else { 1e-150 }));
        }
        return DVec3::ZERO;
    }
    v * ((1.0 - 4.0 * f64::EPSILON) / v.length())
}
