//! Minimal enclosing sphere of points.
//!
//! The smallest sphere around n points is determined by at most four of them. Starting from one point, the point farthest
//! from the current sphere joins its support, and the smallest sphere of those at most five points replaces it; its radius
//! grows at each step, so no support comes twice (an LP-type basis exchange: E. Welzl, *Smallest enclosing disks (balls
//! and ellipsoids)*, 1991, doi:10.1007/BFb0038202, with the farthest-point pivoting of B. Gärtner, *Fast and robust
//! smallest enclosing balls*, 1999, doi:10.1007/3-540-48481-7_29). Enclosure does not depend on any of that: the radius
//! is measured from the final center to every point and rounded up.

use crate::TriMesh;
use d2m_lanes::power_of_two;
use glam::DVec3;

/// 2⁻⁵³: a squared radius that shrinks by less does not shrink. It ends the exchanges and proves nothing; the sphere
/// is measured afterwards.
const HALF_ULP: f64 = 0.5 * f64::EPSILON;

/// No input is known that takes more than 30 exchanges; after this many the best sphere so far is returned.
const MAX_EXCHANGES: usize = 200;

/// A sphere that contains given points: enclosure is proven, minimality holds to rounding.
///
/// ```
/// use d2m_mesh::EnclosingSphere;
/// use glam::DVec3;
///
/// let sphere = EnclosingSphere::of_points(&[DVec3::X, -DVec3::X, DVec3::new(0.0, 0.3, 0.1)]).unwrap();
/// assert!((sphere.radius - 1.0).abs() < 1e-14 && sphere.radius >= 1.0);
/// assert!(sphere.center.length() < 1e-14);
/// assert_eq!(EnclosingSphere::of_points(&[]), None);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnclosingSphere {
    /// Center, in the frame of the points.
    pub center: DVec3,
    /// Radius: at least the exact distance from `center` to every point.
    pub radius: f64,
}

impl EnclosingSphere {
    /// The smallest sphere around `points` (finite, magnitudes at most [`MAX_COORDINATE`](crate::MAX_COORDINATE)); none if
    /// there are no points.
    ///
    /// **Promise.** In exact arithmetic |p − center| ≤ radius for every point. The radius exceeds the minimal one by a
    /// few units of rounding of the coordinates' spread (measured: below 1e-14 of it).
    pub fn of_points(points: &[DVec3]) -> Option<Self> {
        let first = *points.first()?;
        let mut support = Support::one(first);
        let mut center = first;
        let mut best = (f64::INFINITY, first);
        for _ in 0..MAX_EXCHANGES {
            let (farthest, squared) = farthest_point(points, center);
            // Exchanges stop improving only when the sphere is minimal to rounding.
            if squared >= best.0 * (1.0 - HALF_ULP) && best.0.is_finite() && support.contains(farthest) {
                best = if squared < best.0 { (squared, center) } else { best };
                break;
            }
            if squared < best.0 {
                best = (squared, center);
            }
            if support.contains(farthest) || squared <= support.squared_radius {
                break;
            }
            let previous = support.squared_radius;
            support = support.with(farthest).reduced();
            center = support.center;
            if support.squared_radius <= previous {
                let (_, squared) = farthest_point(points, center);
                best = if squared < best.0 { (squared, center) } else { best };
                break;
            }
        }
        Some(Self { center: best.1, radius: bound_distance(best.0) })
    }

    /// The smallest sphere around the used vertices of a mesh; it contains every triangle, since spheres are convex.
    pub fn of_mesh(mesh: &TriMesh) -> Self {
        let points: Vec<DVec3> =
            mesh.triangles().iter().flatten().map(|&vertex| mesh.vertices()[vertex as usize]).collect();
        Self::of_points(&points).unwrap_or(Self { center: DVec3::ZERO, radius: 0.0 })
    }
}

/// An upper bound of the distance whose square was computed as d² = fl(Δx² + Δy² + Δz²).
///
/// Each difference has relative error u = 2⁻⁵³, its square 3u, the two additions 2u more: the exact square is at most
/// d²(1 + 6u), its root at most √d²·(1 + 3u), and the rounded root and product lose 2u. Below 2⁻⁵¹¹ squares may
/// underflow by 2⁻¹⁰⁷⁴ each, less than (2⁻⁵³⁰)² in sum.
fn bound_distance(squared: f64) -> f64 {
    squared.sqrt() * (1.0 + 8.0 * f64::EPSILON) + power_of_two(-530)
}

/// The farthest point and the square of its distance.
fn farthest_point(points: &[DVec3], center: DVec3) -> (DVec3, f64) {
    let mut farthest = (center, -1.0);
    for &point in points {
        let squared = point.distance_squared(center);
        if squared > farthest.1 {
            farthest = (point, squared);
        }
    }
    farthest
}

/// At most five points and the smallest sphere of those that determine it.
#[derive(Clone, Copy)]
struct Support {
    points: [DVec3; 5],
    count: usize,
    center: DVec3,
    squared_radius: f64,
}

impl Support {
    fn one(point: DVec3) -> Self {
        Self { points: [point; 5], count: 1, center: point, squared_radius: 0.0 }
    }

    fn points(&self) -> &[DVec3] {
        &self.points[..self.count]
    }

    fn contains(&self, point: DVec3) -> bool {
        self.points().contains(&point)
    }

    fn with(mut self, point: DVec3) -> Self {
        self.points[self.count] = point;
        self.count += 1;
        self
    }

    /// The subset of at most four points whose circumsphere, enlarged to hold all points, is smallest. Judging each
    /// center by the farthest of all points needs no tolerance.
    fn reduced(self) -> Self {
        let mut best = Self { squared_radius: f64::INFINITY, ..self };
        for subset in 1_u32..1 << self.count {
            let mut chosen = [DVec3::ZERO; 4];
            let size = subset.count_ones() as usize;
            if size > 4 {
                continue;
            }
            let members = self.points().iter().enumerate().filter(|(index, _)| subset >> index & 1 == 1);
            for (slot, (_, &point)) in chosen.iter_mut().zip(members) {
                *slot = point;
            }
            let Some(center) = try_circumcenter(&chosen[..size]) else { continue };
            let squared_radius = farthest_point(self.points(), center).1;
            if squared_radius < best.squared_radius {
                let mut points = [chosen[0]; 5];
                points[..4].copy_from_slice(&chosen);
                best = Self { points, count: size, center, squared_radius };
            }
        }
        best
    }
}

/// The point in the affine hull of one to four points that has equal distance to all; none if they are affinely
/// dependent (to rounding) or not finite.
fn try_circumcenter(points: &[DVec3]) -> Option<DVec3> {
    let origin = points[0];
    let offset = match *points {
        [_] => DVec3::ZERO,
        [_, b] => (b - origin) * 0.5,
        [_, b, c] => {
            let (b, c) = (b - origin, c - origin);
            let normal = b.cross(c);
            (normal.cross(b) * c.length_squared() + c.cross(normal) * b.length_squared())
                / (2.0 * normal.length_squared())
        }
        [_, b, c, d] => {
            let (b, c, d) = (b - origin, c - origin, d - origin);
            let numerator = c.cross(d) * b.length_squared()
                + d.cross(b) * c.length_squared()
                + b.cross(c) * d.length_squared();
            numerator / (2.0 * b.dot(c.cross(d)))
        }
        _ => return None,
    };
    offset.is_finite().then_some(origin + offset)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The smallest radius over all subsets of at most four points, by trying every one.
    fn brute_force_radius(points: &[DVec3]) -> f64 {
        let mut best = f64::INFINITY;
        let n = points.len();
        for i in 0..n {
            for j in i..n {
                for k in j..n {
                    for l in k..n {
                        let mut subset = vec![i, j, k, l];
                        subset.dedup();
                        let subset: Vec<DVec3> = subset.iter().map(|&index| points[index]).collect();
                        if let Some(center) = try_circumcenter(&subset) {
                            best = best.min(farthest_point(points, center).1.sqrt());
                        }
                    }
                }
            }
        }
        best
    }

    fn check(points: &[DVec3]) {
        let sphere = EnclosingSphere::of_points(points).unwrap();
        let minimal = brute_force_radius(points);
        let spread = points.iter().map(|point| point.distance(points[0])).fold(0.0, f64::max);
        assert!(sphere.radius <= minimal + 1e-13 * spread + 1e-150, "{} {minimal} {points:?}", sphere.radius);
        for point in points {
            assert!(sphere.center.distance(*point) <= sphere.radius);
        }
    }

    #[test]
    fn degenerate_sets() {
        let p = DVec3::new(0.1, 0.2, 0.3);
        check(&[p; 7]);
        check(&[p, p * 2.0, p * 3.0, p * 3.0]);
        let square: Vec<DVec3> =
            (0..8).map(|k| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, 0.0)).collect();
        check(&square);
        let cube: Vec<DVec3> = (0..8)
            .map(|k| DVec3::new((k & 1) as f64, (k >> 1 & 1) as f64, (k >> 2) as f64) * 1e6 + p)
            .collect();
        check(&cube);
        check(&[p * 1e-200, p * 3e-200, p * 2e-200]);
    }

    proptest! {
        #[test]
        fn minimal_and_enclosing(coordinates in prop::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0), 1..9), scale in -20..20, flat in 0..3, offset in -1e3..1e3) {
            let stretch = [DVec3::ONE, DVec3::new(1.0, 1.0, 1e-9), DVec3::new(1.0, 1e-9, 1e-9)][flat as usize];
            let points: Vec<DVec3> = coordinates.iter()
                .map(|&(x, y, z)| (DVec3::new(x, y, z) * stretch + DVec3::splat(offset)) * 10_f64.powi(scale))
                .collect();
            let sphere = EnclosingSphere::of_points(&points).unwrap();
            let minimal = brute_force_radius(&points);
            let size = points.iter().map(|point| point.length()).fold(0.0, f64::max);
            prop_assert!(sphere.radius <= minimal * (1.0 + 1e-9) + 1e-13 * size, "{} {}", sphere.radius, minimal);
        }

        #[test]
        fn grids_with_many_ties(coordinates in prop::collection::vec((-2..3, -2..3, -2..3), 1..9)) {
            let points: Vec<DVec3> =
                coordinates.iter().map(|&(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z))).collect();
            check(&points);
        }
    }
}
