//! The point of a convex hull that is nearest to the origin, found from support points one by one.
//!
//! The algorithm of Gilbert, Johnson and Keerthi (IEEE J. Robotics and Automation 4(2), 1988, doi:10.1109/56.2083). Applied to
//! the differences of two sets of points it finds the direction along which the sets are furthest apart. Nothing is proven
//! here: whoever uses a direction measures the gap along it.

use glam::DVec3;

/// Points of a convex set, at most four, and the point of their hull that is nearest to the origin.
///
/// ```
/// use d2m_mesh::Simplex;
/// use glam::DVec3;
/// // The triangle with corners at 1 on each axis: of its points (1, 1, 1)/3 is the nearest to the origin.
/// let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
/// let all = Simplex::new(x).with(y).and_then(|edge| edge.with(z)).expect("each comes nearer");
/// assert!((all.nearest() - DVec3::ONE / 3.0).length() < 1e-15);
/// assert!(all.with(DVec3::ONE).is_none()); // a point behind it does not
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Simplex {
    points: [DVec3; 4],
    count: usize,
    nearest: DVec3,
}

impl Simplex {
    /// One point.
    pub const fn new(point: DVec3) -> Self {
        Self { points: [point; 4], count: 1, nearest: point }
    }

    /// The point of the hull that is nearest to the origin: zero if the hull holds the origin.
    pub const fn nearest(&self) -> DVec3 {
        self.nearest
    }

    /// With another point of the set, and without those points that the nearest one does not need. `None`: the hull does
    /// not come nearer to the origin.
    pub fn with(&self, point: DVec3) -> Option<Self> {
        if self.count == self.points.len() {
            return None;
        }
        let mut points = self.points;
        points[self.count] = point;
        let all = self.count + 1;
        let mut best: Option<Self> = None;
        // Each face of the new simplex, by the set of its points.
        for face in 1..1usize << all {
            let mut one = Self { points: [DVec3::ZERO; 4], count: 0, nearest: DVec3::ZERO };
            for k in (0..all).filter(|k| face >> k & 1 == 1) {
                one.points[one.count] = points[k];
                one.count += 1;
            }
            let Some(nearest) = foot(&one.points[..one.count]) else { continue };
            one.nearest = nearest;
            if best.is_none_or(|best| nearest.length_squared() < best.nearest.length_squared()) {
                best = Some(one);
            }
        }
        best.filter(|best| best.nearest.length_squared() < self.nearest.length_squared())
    }
}

/// The foot of the origin on the affine hull of some points; `None` if it is not between them, or they are
/// affinely dependent.
fn foot(points: &[DVec3]) -> Option<DVec3> {
    match *points {
        [p] => Some(p),
        [p, q] => {
            let edge = q - p;
            let weight = -p.dot(edge) / edge.length_squared();
            (weight > 0.0 && weight < 1.0).then(|| p + edge * weight)
        }
        [p, q, r] => {
            let normal = (q - p).cross(r - p);
            let sides = [q.cross(r), r.cross(p), p.cross(q)].map(|side| side.dot(normal));
            let within = sides.iter().all(|&side| side > 0.0);
            within.then(|| normal * (normal.dot(p) / normal.length_squared()))
        }
        [p, q, r, s] => {
            let volume = |a: DVec3, b: DVec3, c: DVec3| a.cross(b).dot(c);
            let sides = [-volume(q, r, s), volume(p, r, s), -volume(p, q, s), volume(p, q, r)];
            let within = sides.iter().all(|&side| side > 0.0) || sides.iter().all(|&side| side < 0.0);
            within.then_some(DVec3::ZERO)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};

    /// Hulls of clouds at any distance from the origin: along the direction found all points are as far as the nearest point.
    #[test]
    fn nearest_points_are_found_in_few_steps() {
        let mut random = KnuthRandom(31);
        for round in 0..500 {
            let away = random.vector() * [1.5, 3.0, 50.0][round % 3];
            let cloud: Vec<DVec3> = (0..200).map(|_| random.vector() + away).collect();
            let least =
                |n: DVec3| cloud.iter().copied().min_by(|p, q| n.dot(*p).total_cmp(&n.dot(*q))).unwrap();
            let mut simplex = Simplex::new(cloud[0]);
            let mut steps = 0;
            while let Some(next) = simplex.with(least(simplex.nearest())) {
                simplex = next;
                steps += 1;
            }
            let n = simplex.nearest();
            assert!(steps < 30, "{steps}");
            let gap = n.dot(least(n));
            // Or the hull holds the origin.
            assert!(gap > n.length_squared() * (1.0 - 1e-9) || n.length() < 1e-9, "{gap} {n}");
        }
    }
}
