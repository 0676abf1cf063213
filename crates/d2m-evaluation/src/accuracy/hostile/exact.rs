//! The oracle of the hostile families: do two bodies certainly share a point at a time? In 320-bit arithmetic, by the
//! definition, without any tolerance: what it cannot decide beyond doubt it does not call a contact.
//!
//! It shares no code with the engine: its own rotation (`d2m_testing::big`), its own crossing of
//! triangles (signs of volumes), its own winding number (signed crossings of a segment).
use super::scene::{Body, HostileScene};
use d2m::Solid;
use d2m_testing::big::{self, Big, Big3, abs, cross, dot, sub};
use glam::DVec3;

/// Enough for times of 1e18 and lengths of 2^±60 beside each other.
const BITS: usize = 320;
/// A sign counts if the value is above this part of the product of the lengths that it is made of: rounding of 320 bits
/// after a few dozen operations lies below 2⁻³⁰⁰, far times take 60 bits, and the rest is room.
const DOUBT: isize = -200;

/// The vertices of a body in the world at a time.
fn place(body: &Body, t: f64) -> Vec<Big3> {
    big::place::<BITS>(&body.motion, body.vertices.iter().copied(), &big::number::<BITS>(t))
}

/// A vertex: exactly, and rounded relative to a point near by.
struct Point {
    exact: Big3,
    rounded: DVec3,
}

/// Both bodies at one time.
pub(super) struct Placed<'s> {
    scene: &'s HostileScene,
    points: [Vec<Point>; 2],
    /// No rounded coordinate errs by more: half a unit in the last place of the largest.
    error: f64,
}

/// A triangle of each body.
type Candidate = ([u32; 3], [u32; 3]);

impl<'s> Placed<'s> {
    pub(super) fn new(scene: &'s HostileScene, t: f64) -> Self {
        let exact = [place(&scene.bodies[0], t), place(&scene.bodies[1], t)];
        let origin = exact[1][0].clone();
        let rounded = |p: &Big3| DVec3::from_array(sub(p, &origin).map(|x| x.to_f64().value()));
        let points = exact.map(|points| -> Vec<Point> {
            points.into_iter().map(|exact| Point { rounded: rounded(&exact), exact }).collect()
        });
        let largest = points.iter().flatten().map(|p| p.rounded.abs().max_element()).fold(0.0, f64::max);
        Self { scene, points, error: largest * 2f64.powi(-53) }
    }

    /// Do the bodies certainly share a point? Surfaces that cross properly, or a vertex inside the other solid.
    pub(super) fn meet(&self) -> bool {
        self.candidates(0.0).iter().any(|(s, t)| self.cross(s, t))
            || self.scene.solid == Solid::Filled && (self.holds(0) || self.holds(1))
    }

    /// The distance of the surfaces up to the rounding of doubles of the scene's size; infinite above `limit`.
    pub(super) fn distance(&self, limit: f64) -> f64 {
        let corners = |body: usize, t: &[u32; 3]| t.map(|i| self.points[body][i as usize].rounded);
        self.candidates(limit)
            .iter()
            .map(|(s, t)| crate::judge::distance(&corners(0, s), &corners(1, t)))
            .fold(f64::INFINITY, f64::min)
    }

    /// Pairs of triangles whose boxes come within `limit`.
    fn candidates(&self, limit: f64) -> Vec<Candidate> {
        let boxes = [0, 1].map(|body| -> Vec<(DVec3, DVec3)> {
            let span = |t: &[u32; 3]| {
                let [p, q, r] = t.map(|i| self.points[body][i as usize].rounded);
                (p.min(q).min(r), p.max(q).max(r))
            };
            self.scene.bodies[body].triangles.iter().map(span).collect()
        });
        let room = limit + 4.0 * self.error;
        let mut found = Vec::new();
        for (s, (lo, hi)) in self.scene.bodies[0].triangles.iter().zip(&boxes[0]) {
            for (t, (low, high)) in self.scene.bodies[1].triangles.iter().zip(&boxes[1]) {
                if (*low - *hi).max(*lo - *high).max_element() <= room {
                    found.push((*s, *t));
                }
            }
        }
        found
    }

    fn cross(&self, s: &[u32; 3], t: &[u32; 3]) -> bool {
        let s = s.map(|i| &self.points[0][i as usize]);
        let t = t.map(|i| &self.points[1][i as usize]);
        let pierces = |p: [&Point; 3], q: [&Point; 3]| {
            // Which side of the plane of q the corners of p are on: most triangles lie on one side.
            let sides = p.map(|corner| self.volume(q[0], q[1], q[2], corner));
            (0..3).any(|i| {
                let j = (i + 1) % 3;
                matches!((sides[i], sides[j]), (Some(from), Some(to)) if from != to)
                    && self.pierce(p[i], p[j], q).is_some_and(|side| side != 0)
            })
        };
        pierces(s, t) || pierces(t, s)
    }

    /// Does the solid of this body hold a vertex of the other? By its winding number about some vertices that lie in
    /// its box.
    fn holds(&self, body: usize) -> bool {
        let (lo, hi) =
            self.points[body].iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| {
                (lo.min(p.rounded), hi.max(p.rounded))
            });
        let size = (hi - lo).length();
        let inside_box = |p: &&Point| p.rounded.cmpge(lo).all() && p.rounded.cmple(hi).all();
        let inner = self.points[1 - body].iter().filter(inside_box);
        inner.take(8).any(|p| self.winding(body, p, size).is_some_and(|turns| turns != 0))
    }

    /// Signed crossings of a segment from the point to far outside; `None` when one is in doubt in two directions.
    fn winding(&self, body: usize, point: &Point, size: f64) -> Option<i32> {
        let directions = [DVec3::new(0.363_821, 0.581_297, 0.727_941), DVec3::new(-0.613, 0.331, 0.718)];
        directions.into_iter().find_map(|direction| {
            let by = direction * (4.0 * size);
            let far = Point {
                exact: big::add(&point.exact, &big::vector::<BITS>(by)),
                rounded: point.rounded + by,
            };
            self.scene.bodies[body].triangles.iter().try_fold(0, |sum, t| {
                let corners = t.map(|i| &self.points[body][i as usize]);
                self.pierce(point, &far, corners).map(|side| sum + side)
            })
        })
    }

    /// How the segment p q passes through the triangle: 1 along its normal, −1 against it, 0 not at all, `None` in doubt.
    fn pierce(&self, p: &Point, q: &Point, t: [&Point; 3]) -> Option<i32> {
        let (from, to) = (self.volume(t[0], t[1], t[2], p), self.volume(t[0], t[1], t[2], q));
        if from.is_some() && from == to {
            return Some(0);
        }
        let sides = [0, 1, 2].map(|i| self.volume(p, q, t[i], t[(i + 1) % 3]));
        if sides.contains(&Some(1)) && sides.contains(&Some(-1)) {
            return Some(0);
        }
        let (from, _) = (from?, to?);
        for side in sides {
            side?;
        }
        // Before the triangle the volume is negative where the normal points onwards.
        Some(-from)
    }

    /// The sign of the volume of four points; `None` when 320 bits leave it in doubt, or when it is zero.
    fn volume(&self, a: &Point, b: &Point, c: &Point, d: &Point) -> Option<i32> {
        let [x, y, z] = [b, c, d].map(|p| p.rounded - a.rounded);
        let value = x.cross(y).dot(z);
        let length = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
        let (l, m, n) = (length(x), length(y), length(z));
        // Each difference errs by 4 errors a coordinate (both ends, its own rounding and room), a far point by as much;
        // the product of three by 6 roundings.
        let e = 16.0 * self.error.max(f64::MIN_POSITIVE);
        let doubt = e * (l * m + m * n + n * l) * 2.0 + l * m * n * 2f64.powi(-48);
        if value.abs() > doubt && doubt > 1e-250 {
            return Some(if value > 0.0 { 1 } else { -1 });
        }
        let [x, y, z] = [b, c, d].map(|p| sub(&p.exact, &a.exact));
        let value = dot(&cross(&x, &y), &z);
        let length = |v: &Big3| v.iter().map(abs).fold(Big::ZERO, |sum, c| sum + c);
        let doubt = length(&x) * length(&y) * length(&z) * Big::from_parts(1.into(), DOUBT);
        if abs(&value) <= doubt { None } else { Some(if value > Big::ZERO { 1 } else { -1 }) }
    }
}
