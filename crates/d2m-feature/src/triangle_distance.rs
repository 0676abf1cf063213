//! Static distance of two triangles with a certificate.
//!
//! **Why the enclosure is proven whatever the search does.** The search for the closest points is ordinary floating
//! point; its answer is only used through two statements that hold for *any* answer:
//!
//! - *Upper bound.* The witness points are convex combinations of the vertices, so they are points of the triangles, and
//!   their distance is at least the distance of the triangles.
//! - *Lower bound.* For any direction n, every point of A has n·x ≤ max n·aᵢ and every point of B has n·y ≥ min n·bⱼ (a
//!   linear function on a triangle takes its extrema at vertices), so the distance is at least (min n·bⱼ − max n·aᵢ)/|n|.
//!   For the best n the two bounds are equal (duality of convex sets).
//!
//! **Rounding.** Let u = 2⁻⁵³. Coordinates are taken relative to a vertex o and scaled by a power of two so that the
//! largest is in [1, 2); r is an upper bound of the length of any scaled vertex. A relative coordinate is fl(p − o),
//! with relative error u.
//!
//! - A projection n·x of three products errs by at most 3u Σ|nₖ||xₖ| from its own operations and u Σ|nₖ||xₖ| from xₖ:
//!   4u|n|r to first order, 5u|n|r with all orders. A gap of two projections errs by at most 10u|n|r + u|gap|; since
//!   |gap| ≤ 2|n|r: 12u|n|r. |n| is computed within 3u, and dividing adds u to the quotient, which is at most 2r: 8ur.
//!   In all 20ur; [`LOSS`] = 32u is used.
//! - Barycentrics are clamped to [0, 1] and used as they are. With e = Σλ − 1, the combination differs from the
//!   triangle's point Σλᵢaᵢ/Σλ by at most |e|r, from its own operations by 3u·r(1 + e), from the coordinates by u·r. The
//!   code measures e (with error at most 2u); so witnesses err by (|e| + 7u)r each, their distance by twice that, plus
//!   4u of itself. [`LOSS`] = 32u and the measured e are used.
//! - Directions are cross products of differences of vertices. They are made with twice the digits where the plain ones do
//!   not settle it: rounding turns the plain cross product of nearly parallel edges by u over the sine of their angle.
//! - Underflow loses at most 2⁻¹⁰⁷⁰ after scaling, covered by the floor 2⁻⁵⁰⁰.

use crate::accurate_cross::{Difference, accurate_cross};
use crate::triangle_intersection::triangles_intersect;
use crate::units::Units;
use d2m_lanes::{power_of_two, power_of_two_below};
use glam::DVec3;

/// Relative loss of both bounds: 32u.
const LOSS: f64 = 16.0 * f64::EPSILON;
/// Lengths of directions that are normalised as they are: their squares are far from under- and overflow.
const SAFE_LENGTHS: core::ops::Range<f64> = power_of_two(-300)..power_of_two(300);
/// Bounds that differ by this part of the reach differ by what rounding explains: both lose [`LOSS`], twice over with the
/// excess of the weights. (Any value is sound: it says when to stop.)
const TIGHT: f64 = 5.0 * LOSS;
/// Absolute floor after scaling: 2⁻⁵⁰⁰.
const FLOOR: f64 = power_of_two(-500);

/// The part of a triangle that holds a closest point.
///
/// ```
/// use d2m_feature::{TriangleFeature, triangle_distance};
/// use glam::{DVec3, dvec3};
/// let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let needle = [dvec3(0.25, 0.25, 0.5), dvec3(0.25, 0.25, 1.0), dvec3(0.25, 0.5, 1.0)];
/// let found = triangle_distance(&floor, &needle);
/// assert_eq!((found.feature_a, found.feature_b), (TriangleFeature::Face, TriangleFeature::Vertex(0)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TriangleFeature {
    /// Vertex 0, 1 or 2.
    Vertex(u8),
    /// The edge from vertex k to vertex k + 1 (mod 3), without its ends.
    Edge(u8),
    /// The interior.
    Face,
}

/// The distance of two closed triangles, enclosed, with witnesses.
///
/// ```
/// use d2m_feature::triangle_distance;
/// use glam::DVec3;
/// let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let lifted = floor.map(|p| p + DVec3::Z * 2.0);
/// let apart = triangle_distance(&floor, &lifted);
/// assert!(apart.lower <= 2.0 && 2.0 <= apart.upper && (apart.direction - DVec3::Z).length() < 1e-12);
/// assert_eq!(triangle_distance(&floor, &floor).upper, 0.0); // they share a point: decided exactly
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TriangleDistance {
    /// Proven lower bound of the distance; 0 if and only if nothing better could be proven.
    pub lower: f64,
    /// Proven upper bound of the distance; 0 if and only if the triangles share a point (decided exactly).
    pub upper: f64,
    /// A point of A, rounded, with `upper` from B's.
    pub point_a: DVec3,
    /// A point of B, rounded.
    pub point_b: DVec3,
    /// Weights of A's vertices at `point_a`; each in [0, 1], sum 1 to rounding.
    pub barycentric_a: [f64; 3],
    /// Weights of B's vertices at `point_b`.
    pub barycentric_b: [f64; 3],
    /// Direction from A to B that proves `lower`, unit to rounding; zero if `lower` is zero.
    pub direction: DVec3,
    /// Where `point_a` lies on A.
    pub feature_a: TriangleFeature,
    /// Where `point_b` lies on B.
    pub feature_b: TriangleFeature,
}

/// Encloses the distance of two closed triangles (finite vertices of any magnitude; degenerate ones are the segments or
/// points that their vertices span).
///
/// **Promise.** `lower` ≤ exact distance ≤ `upper`; `upper` is 0 exactly if the triangles meet. The width
/// `upper − lower` is not promised but measured: below 3e-14 of the extent (largest coordinate difference to the first
/// vertex) on random, coincident, nearly touching and sliver families, below 1e-13 where edges cross or planes meet at angles
/// down to 1e-15, against exact rational arithmetic. An exact scaling by a power of two scales the result.
///
/// ```
/// use d2m_feature::{TriangleFeature, triangle_distance};
/// use glam::{DVec3, dvec3};
///
/// let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let hanging = [dvec3(0.25, 0.25, 0.5), dvec3(0.0, 0.0, 1.0), dvec3(1.0, 1.0, 1.0)];
/// let distance = triangle_distance(&floor, &hanging);
/// assert!(distance.lower <= 0.5 && 0.5 <= distance.upper && distance.upper - distance.lower < 3e-14);
/// assert_eq!(distance.feature_a, TriangleFeature::Face);
/// assert_eq!(distance.feature_b, TriangleFeature::Vertex(0));
/// ```
pub fn triangle_distance(a: &[DVec3; 3], b: &[DVec3; 3]) -> TriangleDistance {
    // Powers of two: first so that no difference overflows, then so that the largest difference is near one.
    let largest = a.iter().chain(b).fold(DVec3::ZERO, |most, p| most.max(p.abs())).max_element();
    let units = Units::of_size(largest);
    let (in_units_a, in_units_b) = (units.points(*a), units.points(*b));
    let origin = in_units_a[0];
    let extent =
        in_units_a.iter().chain(&in_units_b).map(|&p| (p - origin).abs().max_element()).fold(0.0, f64::max);
    let scale = if extent == 0.0 { 1.0 } else { power_of_two_below(extent) };
    let shrink = 1.0 / scale;
    let [local_a, local_b] = [in_units_a, in_units_b].map(|triangle| triangle.map(|p| (p - origin) * shrink));
    let mut search = Search::new(&local_a, &local_b);
    let is_tight = search.run();
    // What is proven apart does not meet. For what meets no direction is of use.
    let meet = search.lower.gap <= 0.0 && triangles_intersect(a, b);
    if meet {
        search.closest = try_common_point(&local_a, &local_b).unwrap_or(search.closest);
    } else if !is_tight {
        search.try_directions();
    }
    let Search { closest, upper, lower, .. } = search;
    let place =
        |weights, vertices: &[DVec3; 3]| units.point_back(combine(weights, vertices) * scale + origin);
    let back = |distance: f64| units.length_back(distance * scale);
    TriangleDistance {
        // Scaling back is exact, except that it may round once in the subnormal range.
        lower: if lower.gap > 0.0 { back(lower.gap).next_down() } else { 0.0 },
        upper: if meet { 0.0 } else { back(upper).next_up() },
        point_a: place(closest.weights_a, &local_a),
        point_b: place(closest.weights_b, &local_b),
        barycentric_a: closest.weights_a,
        barycentric_b: closest.weights_b,
        direction: lower.direction,
        feature_a: feature_of(closest.weights_a),
        feature_b: feature_of(closest.weights_b),
    }
}

fn combine(weights: [f64; 3], vertices: &[DVec3; 3]) -> DVec3 {
    vertices[0] * weights[0] + vertices[1] * weights[1] + vertices[2] * weights[2]
}

fn feature_of(weights: [f64; 3]) -> TriangleFeature {
    match weights.map(|weight| weight != 0.0) {
        [true, false, false] => TriangleFeature::Vertex(0),
        [false, true, false] => TriangleFeature::Vertex(1),
        [false, false, true] => TriangleFeature::Vertex(2),
        [true, true, false] => TriangleFeature::Edge(0),
        [false, true, true] => TriangleFeature::Edge(1),
        [true, false, true] => TriangleFeature::Edge(2),
        _ => TriangleFeature::Face,
    }
}

/// The best direction so far and the gap that it proves.
struct Separation {
    gap: f64,
    direction: DVec3,
}

impl Separation {
    /// Tries n and −n.
    fn consider(&mut self, a: &[DVec3; 3], b: &[DVec3; 3], direction: DVec3, reach: f64) {
        let size = direction.abs().max_element();
        if !(size > 0.0 && size.is_finite()) {
            return;
        }
        // Coordinates are about 1, so only lengths far from 1 could lose bits to underflow or overflow.
        let safe = SAFE_LENGTHS.contains(&size);
        let direction = if safe { direction } else { direction / power_of_two_below(size) };
        let length = direction.length();
        let range = |triangle: &[DVec3; 3]| {
            let [p, q, r] = triangle.map(|vertex| vertex.dot(direction));
            (p.min(q).min(r), p.max(q).max(r))
        };
        let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
        for (gap, sign) in [(low_b - high_a, 1.0), (low_a - high_b, -1.0)] {
            let gap = gap / length - LOSS * reach - FLOOR;
            if gap > self.gap {
                *self = Self { gap, direction: direction * (sign / length) };
            }
        }
    }
}

/// Two points by their weights.
#[derive(Clone, Copy)]
struct Closest {
    weights_a: [f64; 3],
    weights_b: [f64; 3],
}

impl Closest {
    /// The upper bound of the module's notes.
    fn bound_distance(&self, a: &[DVec3; 3], b: &[DVec3; 3], reach: f64) -> f64 {
        let excess = |[p, q, r]: [f64; 3]| (p + q + r - 1.0).abs() + f64::EPSILON;
        let distance = combine(self.weights_a, a).distance(combine(self.weights_b, b));
        let loss = excess(self.weights_a) + excess(self.weights_b) + LOSS;
        distance * (1.0 + LOSS) + loss * reach + FLOOR
    }
}

/// The best pair of points and the best direction so far.
struct Search<'a> {
    a: &'a [DVec3; 3],
    b: &'a [DVec3; 3],
    reach: f64,
    squared: f64,
    closest: Closest,
    upper: f64,
    lower: Separation,
}

impl<'a> Search<'a> {
    fn new(a: &'a [DVec3; 3], b: &'a [DVec3; 3]) -> Self {
        let reach = a.iter().chain(b).map(|p| p.length_squared()).fold(0.0, f64::max).sqrt() * (1.0 + LOSS);
        let vertex = [1.0, 0.0, 0.0];
        Self {
            a,
            b,
            reach,
            squared: f64::INFINITY,
            closest: Closest { weights_a: vertex, weights_b: vertex },
            upper: f64::INFINITY,
            lower: Separation { gap: 0.0, direction: DVec3::ZERO },
        }
    }

    /// Nine side/side and six vertex/face pairs; ends as soon as the bounds agree, which they do at the closest pair. Says
    /// whether they do.
    fn run(&mut self) -> bool {
        let (a, b) = (self.a, self.b);
        for pair in 0..9 {
            let (i, j) = (pair / 3, pair % 3);
            let (next_i, next_j) = ((i + 1) % 3, (j + 1) % 3);
            let (along_a, along_b) = (a[next_i] - a[i], b[next_j] - b[j]);
            let (s, t) = closest_on_segments(a[i], along_a, b[j], along_b);
            let offset = (b[j] + along_b * t) - (a[i] + along_a * s);
            if offset.length_squared() < self.squared {
                let (mut weights_a, mut weights_b) = ([0.0; 3], [0.0; 3]);
                (weights_a[i], weights_a[next_i]) = (1.0 - s, s);
                (weights_b[j], weights_b[next_j]) = (1.0 - t, t);
                self.take(Closest { weights_a, weights_b }, offset);
                if self.is_tight() {
                    return true;
                }
            }
        }
        for vertex in 0..3 {
            let mut weights = [0.0; 3];
            weights[vertex] = 1.0;
            let on_a = try_foot(a, b[vertex]).map(|foot| Closest { weights_a: foot, weights_b: weights });
            let on_b = try_foot(b, a[vertex]).map(|foot| Closest { weights_a: weights, weights_b: foot });
            for candidate in [on_a, on_b].into_iter().flatten() {
                let offset = combine(candidate.weights_b, b) - combine(candidate.weights_a, a);
                if offset.length_squared() < self.squared {
                    self.take(candidate, offset);
                }
            }
        }
        self.is_tight()
    }

    /// The direction that belongs to the closest points, with twice the digits, then every one that could be the best.
    fn try_directions(&mut self) {
        let (a, b) = (self.a, self.b);
        self.lower.consider(a, b, likely_direction(a, b, &self.closest), self.reach);
        if self.is_tight() {
            return;
        }
        for direction in all_directions(a, b) {
            self.lower.consider(a, b, direction, self.reach);
        }
    }

    /// Takes a closer pair, and the direction between its points.
    fn take(&mut self, closest: Closest, offset: DVec3) {
        self.closest = closest;
        self.squared = offset.length_squared();
        self.upper = closest.bound_distance(self.a, self.b, self.reach);
        self.lower.consider(self.a, self.b, offset, self.reach);
    }

    /// The bounds differ by what rounding explains.
    fn is_tight(&self) -> bool {
        self.upper - self.lower.gap <= TIGHT * self.reach
    }
}

/// Weights of the foot of the perpendicular from `point` if it lies inside the triangle.
fn try_foot([a, b, c]: &[DVec3; 3], point: DVec3) -> Option<[f64; 3]> {
    let normal = (b - a).cross(c - a);
    let weights = [
        normal.dot((c - b).cross(point - b)),
        normal.dot((a - c).cross(point - c)),
        normal.dot((b - a).cross(point - a)),
    ];
    let sum = weights[0] + weights[1] + weights[2];
    (weights.iter().all(|&weight| weight >= 0.0) && sum > 0.0).then(|| weights.map(|weight| weight / sum))
}

/// Parameters in [0, 1] of the closest points of the segments from p and from q.
///
/// The lines' parameter comes from cross products, n = d₁ × d₂ and s = ((q − p) × d₂)·n/n², which keeps its accuracy for
/// nearly parallel lines, unlike the usual difference of products d₁²d₂² − (d₁·d₂)². Then each parameter is minimised in
/// turn, which is exact after the first clamp.
fn closest_on_segments(p: DVec3, along_p: DVec3, q: DVec3, along_q: DVec3) -> (f64, f64) {
    let normal = along_p.cross(along_q);
    let offset = q - p;
    let ratio = |numerator: f64, denominator: f64| {
        let quotient = numerator / denominator;
        if quotient >= 0.0 { quotient.min(1.0) } else { 0.0 } // also for 0/0
    };
    let start = ratio(offset.cross(along_q).dot(normal), normal.length_squared());
    let t = ratio((along_p * start - offset).dot(along_q), along_q.length_squared());
    (ratio((offset + along_q * t).dot(along_p), along_p.length_squared()), t)
}

/// The part of `offset` across `side`.
fn across(side: Difference, offset: Difference) -> DVec3 {
    accurate_cross(Difference::from(accurate_cross(side, offset)), side)
}

/// The direction that belongs to the kind of the closest points.
fn likely_direction(a: &[DVec3; 3], b: &[DVec3; 3], closest: &Closest) -> DVec3 {
    use TriangleFeature::{Edge, Face, Vertex};
    let side =
        |triangle: &[DVec3; 3], k: u8| Difference::new(triangle[(k as usize + 1) % 3], triangle[k as usize]);
    let normal = |&[p, q, r]: &[DVec3; 3]| accurate_cross(Difference::new(q, p), Difference::new(r, p));
    let between = |k: u8, l: u8| Difference::new(b[l as usize], a[k as usize]);
    match (feature_of(closest.weights_a), feature_of(closest.weights_b)) {
        (Face, _) => normal(a),
        (_, Face) => normal(b),
        (Edge(k), Edge(l)) => accurate_cross(side(a, k), side(b, l)),
        (Edge(k), Vertex(l)) => across(side(a, k), between(k, l)),
        (Vertex(k), Edge(l)) => across(side(b, l), between(k, l)),
        (Vertex(k), Vertex(l)) => b[l as usize] - a[k as usize],
    }
}

/// All directions in which the closest points of two triangles can lie: faces' normals, sides' cross products, vertices'
/// differences, vertices' perpendiculars to sides, and perpendiculars to sides within the faces.
fn all_directions(a: &[DVec3; 3], b: &[DVec3; 3]) -> impl Iterator<Item = DVec3> {
    let sides =
        |&[p, q, r]: &[DVec3; 3]| [Difference::new(q, p), Difference::new(r, q), Difference::new(p, r)];
    let (a, b) = (*a, *b);
    let (sides_a, sides_b) = (sides(&a), sides(&b));
    let normals = [accurate_cross(sides_a[0], sides_a[1]), accurate_cross(sides_b[0], sides_b[1])];
    (0..9).flat_map(move |pair| {
        let (i, j) = (pair / 3, pair % 3);
        let offset = Difference::new(b[j], a[i]);
        let within = |side: Difference, normal: DVec3| accurate_cross(side, Difference::from(normal));
        [
            normals[pair % 2],
            accurate_cross(sides_a[i], sides_b[j]),
            b[j] - a[i],
            across(sides_a[i], offset),
            across(sides_b[j], offset),
            across(sides_a[i], Difference::new(b[j], a[(i + 1) % 3])),
            across(sides_b[j], Difference::new(b[(j + 1) % 3], a[i])),
            within(sides_a[i], normals[j % 2]),
            within(sides_b[j], normals[i % 2]),
        ]
    })
}

/// A common point of triangles that are known to meet: where a side passes through a face, if one does so clearly.
fn try_common_point(a: &[DVec3; 3], b: &[DVec3; 3]) -> Option<Closest> {
    let pierce = |edge: [DVec3; 2], triangle: &[DVec3; 3]| {
        let normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
        let heights = edge.map(|point| normal.dot(point - triangle[0]));
        let along = heights[0] / (heights[0] - heights[1]);
        if !(heights[0] * heights[1] <= 0.0 && (0.0..=1.0).contains(&along)) {
            return None;
        }
        Some((along, try_foot(triangle, edge[0] + (edge[1] - edge[0]) * along)?))
    };
    (0..3).find_map(|slot| {
        let next = (slot + 1) % 3;
        let weights = |along: f64| {
            let mut weights = [0.0; 3];
            (weights[slot], weights[next]) = (1.0 - along, along);
            weights
        };
        let on_a = pierce([b[slot], b[next]], a)
            .map(|(along, foot)| Closest { weights_a: foot, weights_b: weights(along) });
        on_a.or_else(|| {
            pierce([a[slot], a[next]], b)
                .map(|(along, foot)| Closest { weights_a: weights(along), weights_b: foot })
        })
    })
}

#[cfg(test)]
mod tests;
