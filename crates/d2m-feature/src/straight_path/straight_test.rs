//! What the tests of both pairs of features on straight paths share.
use super::linear::{Clearance, Lengths, Line};
use super::triple_product::{Allowed, TripleProduct};
use crate::closest::ClosestPair;
use crate::path::{around, direction, global, local, padded, resolution};
use crate::point_triangle::cleared;
use crate::rounding::{CLOSE, length_up};
use core::marker::PhantomData;
use d2m_root::{Measurement, Piece, PieceTest, Verdict};
use glam::DVec3;

/// The piece test of two features whose vertices are sums and differences of three lines `x`, `y`, `z`. Where the features meet,
/// `f = x·(y × z)` is zero: a cubic, known exactly up to rounding.
pub(super) struct StraightTest<F> {
    pub(super) features: PhantomData<F>,
    /// `x`, `y`, `z` from t = 0.
    pub(super) lines: [Line; 3],
    pub(super) error: f64,
    pub(super) size: f64,
    pub(super) speed: f64,
    pub(super) tolerance: f64,
    pub(super) separation: f64,
    /// A piece throughout which the features meet within both where they lie in a plane.
    pub(super) inside: Piece,
}

/// How three lines make two features; times count from the middle of a piece.
pub(super) trait StraightFeatures {
    /// Further apart than `margin` for |s| ≤ h, seen along the line of the middles.
    fn are_apart(lines: &[Line; 3], margin: f64, h: f64) -> bool;

    /// The part where features in a plane may meet within both; `None` if that is none of it.
    fn clip_inside(lines: &[Line; 3], seen: &SeenAlong, part: Piece) -> Option<Inside>;

    /// The closest points at s = 0.
    fn closest(lines: &[Line; 3]) -> ClosestPair;

    /// By how much the features are further apart than the margin along a direction, and for how long.
    fn clear_along(lines: &[Line; 3], n: DVec3, margin: f64) -> Clearance;

    /// Directions that separate features that are close to each other.
    fn directions(lines: &[Line; 3], consider: impl FnMut(DVec3));
}

/// How features are seen along `n = y × z`, frozen in the middle.
pub(super) struct SeenAlong {
    pub(super) normal: DVec3,
    /// At least |n|.
    pub(super) length: f64,
    /// Of the lines in the padded piece.
    pub(super) lengths: [f64; 3],
    pub(super) allowed: Allowed,
    pub(super) padded: Piece,
}

/// What [`StraightFeatures::clip_inside`] leaves.
pub(super) struct Inside {
    pub(super) part: Piece,
    /// Features that lie in a plane at a time of the part meet within both; nothing was cut off then.
    pub(super) is_certain: bool,
}

impl<F: StraightFeatures> PieceTest for StraightTest<F> {
    fn too_wide(&self, _: f64) -> bool {
        false
    }

    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn resolution(&self) -> f64 {
        resolution(self.tolerance, self.speed)
    }

    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let at = piece.mid();
        let lines = self.lines_from(at);
        let whole = local(piece, at);
        let h = whole.reach();
        let known_inside = self.inside.holds(piece);
        if !known_inside && F::are_apart(&lines, self.error + self.separation, h) {
            return Verdict::Clear;
        }
        let [x, y, z] = &lines;
        let lengths = [x.lengths(), y.lengths(), z.lengths()];
        let allowed = Allowed { error: self.error, separation: self.separation };
        let volume = TripleProduct::new(&lines, &lengths, h, allowed);
        let Some(mut part) = volume.clip(whole) else {
            return Verdict::Clear;
        };
        let mut certain = known_inside;
        if !known_inside {
            let padded = padded(part, at, whole);
            let within = |length: &Lengths| length.within(padded.reach());
            let seen = SeenAlong {
                normal: volume.normal,
                length: length_up(volume.normal),
                lengths: [within(&lengths[0]), within(&lengths[1]), within(&lengths[2])],
                allowed,
                padded,
            };
            let Some(inside) = F::clip_inside(&lines, &seen, part) else {
                return Verdict::Clear;
            };
            part = inside.part;
            if inside.is_certain {
                certain = true;
                self.inside = global(part, at, piece);
            }
        }
        let certain = certain && (volume.changes_sign(whole) || volume.changes_sign(around(part, whole)));
        Verdict::Within { part: global(part, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let lines = self.lines_from(at);
        let pair = F::closest(&lines);
        let distance = length_up(pair.difference) + self.error - self.separation;
        let margin = self.error + self.separation;
        let mut best = Clearance::NONE;
        let mut consider = |n: DVec3| {
            let found = F::clear_along(&lines, n, margin);
            if found.gap > best.gap {
                best = found;
            }
        };
        consider(direction(pair.separating));
        if distance < CLOSE * self.size {
            F::directions(&lines, consider);
        }
        cleared(best.around, local(piece, at), at, piece, distance)
    }
}

impl<F> StraightTest<F> {
    #[inline(always)]
    fn lines_from(&self, at: f64) -> [Line; 3] {
        let [x, y, z] = &self.lines;
        [x.from(at), y.from(at), z.from(at)]
    }
}
