//! A moving sphere against a sphere that is fixed in B's frame (solid spheres).
use crate::path::{FeaturePath, along, direction, global, local, resolution, widened, without_third};
use crate::point_triangle::cleared;
use crate::rounding::{DOWN, PART_OF_WAY, UNIT, length_up};
use d2m_root::{Measurement, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;

/// The piece test of two spheres: the path is A's center.
pub(crate) struct SphereSphereTest<P> {
    pub(crate) path: P,
    /// Center of B.
    pub(crate) center: DVec3,
    /// Sum of the radii: [lower, upper] bound.
    pub(crate) radii: (f64, f64),
    pub(crate) tolerance: f64,
    pub(crate) separation: f64,
    /// Distance of the centers at which the remainder is small enough.
    pub(crate) size: f64,
}

/// Part of the spheres' size that a remainder may reach before a piece is worth an evaluation (tuned; any value is sound).
const PATIENCE: f64 = 0.7;
/// Part of a guess of the time of overlap that is added to it: so that the spheres overlap there by more than rounding. It
/// is only a guess, and tested.
const LATER: f64 = 1e-6;
/// Depth of overlap to aim for beyond the remainder, in units of 2⁻⁵³ of the size: a guess as well.
const DEPTH: f64 = 8.0 * UNIT;

impl<P: FeaturePath> PieceTest for SphereSphereTest<P> {
    fn too_wide(&self, h: f64) -> bool {
        self.path.left_out(h) > PATIENCE * (self.size + PART_OF_WAY * self.path.speed() * h)
    }

    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn resolution(&self) -> f64 {
        resolution(self.tolerance, self.path.speed())
    }

    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let at = piece.mid();
        let jet = self.path.point(piece, at);
        let whole = local(piece, at);
        let remainder = widened(without_third(&jet), self.separation);
        // A direction that separates for longest: from the center of B to A at the end that is farther away, and in
        // the middle; each is a half-space test of the sphere about B.
        let mut part = whole;
        for _ in 0..2 {
            for s in [part.lo, 0.5 * (part.lo + part.hi), part.hi] {
                let n = direction(jet.at(s) - self.center);
                let q = along(&jet, n);
                let limit = n.dot(self.center) + (self.radii.1 + remainder.bound(part.reach()));
                if s >= part.hi {
                    let gap = q.at(part.hi) - limit;
                    if gap > 0.0 {
                        let back = Quadratic::bound_first_zero(gap, -q.slope_at(part.hi), q.curvature);
                        if back > part.hi - part.lo {
                            return Verdict::Clear;
                        }
                        part.hi -= back;
                    }
                } else {
                    let gap = q.at(part.lo) - limit;
                    if gap > 0.0 {
                        let forth = Quadratic::bound_first_zero(gap, q.slope_at(part.lo), q.curvature);
                        if forth > part.hi - part.lo {
                            return Verdict::Clear;
                        }
                        part.lo += forth;
                    }
                }
            }
        }
        // Just after the entry along the last direction the spheres overlap, if the approach is clean: nothing to the
        // right of such a time matters, and with a start apart a contact is certain.
        let margin = remainder.bound(whole.reach());
        let overlap =
            |s: f64| length_up(jet.at(s) - self.center) + margin < self.radii.0 + 2.0 * self.separation;
        let n = direction(jet.at(part.lo) - self.center);
        let q = along(&jet, n);
        let depth = q.at(part.lo) - n.dot(self.center) - self.radii.0 - self.separation;
        let inner = (depth + 2.0 * margin + DEPTH * self.size).max(0.0);
        let until = Quadratic::bound_first_zero(inner, q.slope_at(part.lo), q.curvature);
        let soon = part.lo + until * (1.0 + LATER);
        if soon < part.hi && overlap(soon) {
            part.hi = soon;
        }
        let apart_first = (jet.at(whole.lo) - self.center).length() * DOWN - margin > self.radii.1;
        let certain = apart_first && overlap(part.hi);
        Verdict::Within { part: global(part, at, piece), certain }
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let jet = self.path.point(piece, at);
        let difference = jet.p - self.center;
        let distance = length_up(difference) + jet.remainder.bound(0.0) - self.radii.0 - self.separation;
        let whole = local(piece, at);
        let margin = widened(without_third(&jet), self.separation).bound(whole.reach());
        let n = direction(difference);
        let q = along(&jet, n);
        let gap = q.value - n.dot(self.center) - self.radii.1 - margin;
        let mut clear = Piece { lo: 0.0, hi: 0.0 };
        if gap > 0.0 {
            clear = Piece {
                lo: -Quadratic::bound_first_zero(gap, -q.slope, q.curvature),
                hi: Quadratic::bound_first_zero(gap, q.slope, q.curvature),
            };
        }
        cleared(clear, whole, at, piece, distance)
    }
}
