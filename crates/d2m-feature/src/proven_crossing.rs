//! Do two triangles share a point although their vertices are known only up to an error?

use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::{power_of_two, power_of_two_below};
use glam::DVec3;

/// Proof that triangles share a point whose vertices are within `error` of the given ones in each coordinate. False
/// proves nothing: not for triangles that only touch, nor for flat or coplanar ones.
///
/// An edge crosses a triangle if its ends are on different sides of the triangle's plane and the line through the edge
/// passes the three sides of the triangle on the same side: five signs of 3 × 3 determinants, enclosed in intervals
/// over all positions of the vertices.
///
/// Plain arithmetic chooses the edges that are worth the proof: those whose ends seem to be on different sides.
///
/// ```
/// use d2m_feature::proven_crossing;
/// use glam::{DVec3, dvec3};
/// let floor = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
/// let upright = [dvec3(1.0, 1.0, -1.0), dvec3(1.0, 1.0, 1.0), dvec3(3.0, 3.0, 1.0)];
/// assert!(proven_crossing(&floor, &upright, 0.125));
/// let touching = upright.map(|p| p + DVec3::Z);
/// assert!(!proven_crossing(&floor, &touching, 0.125)); // may be apart
/// ```
pub fn proven_crossing(a: &[DVec3; 3], b: &[DVec3; 3], error: f64) -> bool {
    let largest = a.iter().chain(b).fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
    if !KNOWN.contains(&largest) && largest > 0.0 && largest < f64::INFINITY {
        let unit = power_of_two_below(largest);
        // Exact, but for what underflows.
        let [a, b] = [a, b].map(|triangle| triangle.map(|p| p / unit));
        return proven_crossing(&a, &b, error / unit + f64::MIN_POSITIVE);
    }
    let blur = Interval::new(-error, error);
    let wide = |p: DVec3| IntervalVec3::point(p) + IntervalVec3::new(blur, blur, blur);
    let pierces = |edges: &[DVec3; 3], face: &[DVec3; 3]| {
        let sides = seeming_sides(edges, face);
        (0..3).any(|k| {
            let next = (k + 1) % 3;
            sides[k] * sides[next] < 0.0 && crosses([edges[k], edges[next]].map(wide), &face.map(wide))
        })
    };
    pierces(a, b) || pierces(b, a)
}

/// Lengths of which products of three, and intervals of these, are known to rounding; others are taken in a unit of their own.
const KNOWN: core::ops::Range<f64> = power_of_two(-64)..power_of_two(256);

/// Signs of the volumes of a face with three points, up to rounding: which side of its plane each seems to be on.
fn seeming_sides(points: &[DVec3; 3], face: &[DVec3; 3]) -> [f64; 3] {
    let normal = (face[1] - face[0]).cross(face[2] - face[0]);
    points.map(|p| normal.dot(p - face[0]).signum())
}

/// Does the edge certainly pass through the triangle?
fn crosses([p, q]: [IntervalVec3; 2], [a, b, c]: &[IntervalVec3; 3]) -> bool {
    let volume = |u: IntervalVec3, v: IntervalVec3, w: IntervalVec3, x: IntervalVec3| {
        (v - u).cross(w - u).dot(x - u).certain_sign()
    };
    let (below, above) = (volume(*a, *b, *c, p), volume(*a, *b, *c, q));
    if below * above != -1 {
        return false;
    }
    let turn = volume(p, q, *a, *b);
    turn != 0 && turn == volume(p, q, *b, *c) && turn == volume(p, q, *c, *a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangles_intersect;
    use d2m_testing::{Draw, KnuthRandom};

    /// Pairs that are claimed to cross still share a point, by exact signs, when each vertex is moved by the error;
    /// and most pairs that go on crossing are claimed.
    #[test]
    fn claims_hold_for_every_position_of_the_corners() {
        let mut random = KnuthRandom(17);
        let (mut claimed, mut crossing) = (0, 0);
        for round in 0..4000 {
            let mut triangle = || [0; 3].map(|_| random.vector());
            let (a, b) = (triangle(), triangle());
            let error = [1e-1, 1e-2, 1e-3, 1e-9][round % 4];
            crossing += u32::from(triangles_intersect(&a, &b));
            if !proven_crossing(&a, &b, error) {
                continue;
            }
            claimed += 1;
            for _ in 0..100 {
                // Corners of the cubes of positions: the worst ones.
                let mut moved = |t: &[DVec3; 3]| t.map(|p| p + random.vector().signum() * error);
                let (a, b) = (moved(&a), moved(&b));
                assert!(triangles_intersect(&a, &b), "round {round}: {a:?} {b:?}");
            }
        }
        assert!(claimed > crossing / 2 && claimed > 200, "{claimed} of {crossing}");
    }
    /// Exact scalings change no proof.
    #[test]
    fn crossings_are_proven_in_any_unit() {
        let mut random = KnuthRandom(18);
        let mut claimed = 0;
        for round in 0..300 {
            let mut triangle = || [0; 3].map(|_| random.vector());
            let (a, b) = (triangle(), triangle());
            let error = [1e-2, 1e-9][round % 2];
            let usual = proven_crossing(&a, &b, error);
            claimed += u32::from(usual);
            for exponent in [-950, -300, -170, 300, 400, 900] {
                let unit = power_of_two(exponent);
                let [a, b] = [a, b].map(|triangle| triangle.map(|p| p * unit));
                assert_eq!(proven_crossing(&a, &b, error * unit), usual, "round {round}: {exponent}");
            }
        }
        assert!(claimed > 20, "{claimed}");
    }
}
