//! A moving point against a triangle that is fixed in B's frame.
mod planes;

pub(crate) use planes::TrianglePlanes;

use crate::closest;
use crate::path::{
    CubicAlong, FeaturePath, along, around, cubic_along, direction, global, local, padded, resolution,
    widened, without_third,
};
use crate::rounding::{CLOSE, PART_OF_WAY, UNIT, UP, length_up};
use d2m_motion::{PathJet, Remainder};
use d2m_root::{Band, Cubic, Measurement, NearbyQuadratic, Piece, PieceTest, Quadratic, Verdict};
use glam::DVec3;

/// The piece test of a point path and a triangle.
pub(crate) struct PointTriangleTest<'a, P> {
    pub(crate) path: P,
    pub(crate) planes: &'a TrianglePlanes,
    pub(crate) tolerance: f64,
    pub(crate) separation: f64,
    /// A piece throughout which the path is certainly inside the triangle's prism.
    inside: Piece,
}

/// Part of the triangle's radius that the path must move in half a piece for the sphere for that test to be worth its time.
const NEARBY: f64 = 1.0;

/// Part of the feature's size that a remainder may reach before a piece is worth an evaluation; tuned on the random
/// families (far, near, hit, graze), where 0.5 to 1 differ by less than 3 %.
const PATIENCE: f64 = 0.12;
/// Part of the latest time of a piece to which a crossing's bracket may shrink when no shorter one can be proven: some four
/// units in the last place.
const FEW_UNITS: f64 = 8.0 * UNIT;
/// What the support of a side normal errs by and the side normals are tilted by, as a part of the extent: each is within
/// 32·2⁻⁵³ of unit length and of the normal across the side, the dot product adds 3; in all below 90·2⁻⁵³.
const TILT: f64 = 90.0 * UNIT;

impl<'a, P> PointTriangleTest<'a, P> {
    pub(crate) const fn new(path: P, planes: &'a TrianglePlanes, tolerance: f64, separation: f64) -> Self {
        Self { path, planes, tolerance, separation, inside: Piece::NONE }
    }
}

impl<P: FeaturePath> PieceTest for PointTriangleTest<'_, P> {
    #[inline(always)]
    fn too_wide(&self, h: f64) -> bool {
        self.path.left_out(h) > PATIENCE * (self.planes.size + PART_OF_WAY * self.path.speed() * h)
    }

    fn tolerance(&self) -> f64 {
        self.tolerance
    }

    fn resolution(&self) -> f64 {
        resolution(self.tolerance, self.path.speed())
    }

    #[inline]
    fn evaluate(&mut self, piece: Piece) -> Verdict {
        let at = piece.mid();
        let planes = self.planes;
        let whole = local(piece, at);
        if self.inside.holds(piece) {
            // All that is left to know is when the plane is crossed.
            let CubicAlong { cubic: plane, remainder } = self.path.point_along(piece, at, planes.normal);
            let remainder = widened(remainder, self.separation);
            // The remainder covers the evaluation of the cubic: 109u of its 128u of the value, 131u of 256u of the slope, 95u of
            // 256u of half the curvature and 45u of 64u of a sixth of the jerk (features.md, section 3, "Single jets").
            let Some(part) = plane.clip_beyond(planes.slab, |h| remainder.bound(h), whole) else {
                return Verdict::Clear;
            };
            return self.crossing(&plane, &remainder, part, (whole, at, piece));
        }
        let jet = self.path.point(piece, at);
        let h = whole.reach();
        let remainder = widened(jet.remainder, self.separation);
        let mut searched = whole;
        if self.path.speed() * h > NEARBY * planes.radius {
            let Some(near) = self.near(&jet, whole, h) else {
                return Verdict::Clear;
            };
            searched = near;
        }
        let plane = cubic_along(&jet, planes.normal);
        // Covered as above.
        let Some(mut part) = plane.clip_beyond(planes.slab, |h| remainder.bound(h), searched) else {
            return Verdict::Clear;
        };
        // About the middle of what is left: first with what the speed admits.
        let in_slab = padded(part, at, whole);
        let m = part.mid();
        let in_prism = Piece { lo: in_slab.lo - m, hi: in_slab.hi - m };
        let r = in_prism.reach() * UP;
        let rounding = remainder.bound(in_slab.reach());
        let there = jet.at(m);
        let displacement = (self.path.speed() * r + rounding) * UP;
        let [s0, s1, s2] = planes.sides;
        let values = [s0.dot(there), s1.dot(there), s2.dot(there)];
        if (0..3).any(|i| {
            let Band { lo, hi } = planes.side_support[i];
            values[i] < lo - displacement || values[i] > hi + displacement
        }) {
            return Verdict::Clear;
        }
        let mut inside = self.is_inside(values, displacement);
        if !inside {
            // Then with the jet.
            let margin = rounding + (1.0 / 6.0) * length_up(jet.j) * (r * r * r) * UP;
            let here = jet.moved(m);
            let sides = [along(&here, s0), along(&here, s1), along(&here, s2)];
            let mut beside = Piece { lo: part.lo - m, hi: part.hi - m };
            let before = beside;
            // The margin covers the evaluation of a quadratic: 12u of |value|, |slope|h and |curvature|h², in the last row of
            // features.md, section 3 (119u of 128u and 169u of 256u with it); the 9u that are left cover moving the jet.
            for (side, Band { lo, hi }) in sides.iter().zip(planes.side_support) {
                let Some(left) = side.clip_beyond(Band { lo, hi }, margin, beside) else {
                    return Verdict::Clear;
                };
                beside = left;
            }
            if beside == before {
                inside = self.stays_inside(&sides, margin, in_prism);
            } else {
                part = Piece { lo: m + beside.lo, hi: m + beside.hi };
            }
        }
        if !inside {
            return Verdict::Within { part: global(part, at, piece), certain: false };
        }
        // Only the plane has cut: what is left is inside the prism for good.
        self.inside = global(part, at, piece);
        self.crossing(&plane, &remainder, part, (searched, at, piece))
    }

    fn measure(&mut self, piece: Piece, at: f64) -> Measurement {
        let jet = self.path.point(piece, at);
        let planes = self.planes;
        let pair = closest::point_triangle(jet.p, &planes.vertices, planes.normal);
        let distance = length_up(pair.difference) + jet.remainder.bound(0.0) - self.separation;
        let whole = local(piece, at);
        let margin = widened(without_third(&jet), self.separation).bound(whole.reach());
        let mut clear = Piece { lo: 0.0, hi: 0.0 };
        let mut best = 0.0;
        let mut consider = |d: DVec3| {
            let q = along(&jet, d);
            let support = planes.vertices.map(|v| d.dot(v));
            let top = support[0].max(support[1]).max(support[2]) + margin;
            let gap = q.value - top;
            if gap > best {
                best = gap;
                clear = Piece {
                    lo: -Quadratic::bound_first_zero(gap, -q.slope, q.curvature),
                    hi: Quadratic::bound_first_zero(gap, q.slope, q.curvature),
                };
            }
        };
        consider(direction(pair.separating));
        if distance < CLOSE * planes.size {
            let side = if planes.normal.dot(pair.difference) < 0.0 { -planes.normal } else { planes.normal };
            consider(side);
            planes.sides.into_iter().for_each(consider);
        }
        cleared(clear, whole, at, piece, distance)
    }
}

/// Turns how far to the left and right of `at` no contact is possible into a measurement on the piece.
pub(crate) fn cleared(clear: Piece, whole: Piece, at: f64, piece: Piece, distance: f64) -> Measurement {
    if clear.lo >= clear.hi {
        return Measurement { distance, clear_lo: at, clear_hi: at };
    }
    // Beyond the piece the remainder is not valid: cut there. Inside, the ends are rounded inward.
    let clear_lo = if clear.lo <= whole.lo { piece.lo } else { (at + clear.lo).next_up() };
    let clear_hi = if clear.hi >= whole.hi { piece.hi } else { (at + clear.hi).next_down() };
    Measurement { distance, clear_lo, clear_hi }
}

impl<P: FeaturePath> PointTriangleTest<'_, P> {
    /// True if a certain crossing in the part would be the answer.
    #[inline(always)]
    fn fine(&self, part: Piece, piece: Piece) -> bool {
        let width = part.width();
        width * (2.0 * self.path.speed()) <= self.tolerance || width <= FEW_UNITS * piece.reach()
    }

    /// The part of a piece in which the point may be in the sphere about the triangle: as a whole along the line of
    /// centers, from either end along the velocity.
    #[inline(always)]
    fn near(&self, jet: &PathJet, whole: Piece, h: f64) -> Option<Piece> {
        let planes = self.planes;
        let remainder = widened(jet.remainder, self.separation);
        let from_center = PathJet { p: jet.p - planes.center, ..*jet };
        let limit = (planes.radius + remainder.bound(h)) * UP;
        let distance = length_up(from_center.p);
        if distance > planes.radius {
            let near = cubic_along(&from_center, from_center.p).quadratic_about_center(h);
            let NearbyQuadratic { quadratic: away, left_out } = near;
            if away.exceeds((limit * distance + left_out) * UP, whole) {
                return None;
            }
        }
        let NearbyQuadratic { quadratic: forth, left_out } =
            cubic_along(&from_center, jet.v).quadratic_about_center(h);
        let reach = (limit * length_up(jet.v) + left_out) * UP;
        // The remainder in `limit` covers the evaluation, 12u of the jet's terms times |v|, as for the sides.
        forth.clip_beyond(Band { lo: 0.0, hi: 0.0 }, reach, whole)
    }

    /// What is left of a piece in which the path is certainly inside the prism. `searched` is what the plane has cut.
    #[inline(always)]
    fn crossing(
        &self,
        plane: &Cubic,
        remainder: &Remainder,
        part: Piece,
        (searched, at, piece): (Piece, f64, Piece),
    ) -> Verdict {
        let certain = self.fine(part, piece)
            && (self.crosses(plane, searched, remainder)
                || self.crosses(plane, around(part, searched), remainder));
        Verdict::Within { part: global(part, at, piece), certain }
    }

    /// The path is certainly on opposite sides of the slab at the ends of a piece.
    #[inline(always)]
    fn crosses(&self, plane: &Cubic, between: Piece, remainder: &Remainder) -> bool {
        let margin = remainder.bound(between.reach());
        let (first, last) = (plane.at(between.lo), plane.at(between.hi));
        let (low, high) = (self.planes.slab.lo - margin, self.planes.slab.hi + margin);
        (first > high && last < low) || (first < low && last > high)
    }

    /// A path along the side normals, up to the margin, certainly stays inside the triangle's prism.
    #[inline(always)]
    fn stays_inside(&self, sides: &[Quadratic; 3], margin: f64, part: Piece) -> bool {
        let Some(prism) = &self.planes.prism else {
            return false;
        };
        let pad = margin + TILT * self.planes.extent;
        (0..3).all(|i| {
            let below = Quadratic { value: prism[i] - sides[i].value, ..-sides[i] };
            below.exceeds(pad, part)
        })
    }

    /// A path whose greatest values along the side normals are these, up to the margin, is certainly inside the
    /// triangle's prism.
    #[inline(always)]
    fn is_inside(&self, greatest: [f64; 3], margin: f64) -> bool {
        let Some(prism) = &self.planes.prism else {
            return false;
        };
        let pad = margin + TILT * self.planes.extent;
        (0..3).all(|i| greatest[i] < prism[i] - pad)
    }
}
