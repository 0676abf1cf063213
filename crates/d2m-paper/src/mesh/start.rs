//! How the bodies stand at the start of the window: apart, touching, overlapping, or one inside the other.

use super::distance::{ClosestPair, MeshDistance, enclose_distance, visit_close_pairs};
use super::sphere_tree::SphereTree;
use crate::feature::Placement;
use d2m_bvh::{Solid, StartState};
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// The distance of a point from a line takes some twenty roundings of 2⁻⁵³ of the lengths at hand, and cancellation at
/// most squares them: below 2⁻²⁶ of the lengths where the square of the distance is lost altogether.
const LINE_ROUNDING: f64 = 1.0 / 16_777_216.0;

/// The start state with the closest pair where the bodies meet.
#[derive(Clone, Debug)]
pub(crate) enum Start {
    /// Certainly further apart than the tolerance, and neither inside the other.
    Apart,
    /// In contact, or within the tolerance.
    Meeting(StartState, Box<ClosestPair>),
    /// The surfaces are apart, but no ray decided which side one lies on. Never seen; answered as undecided.
    Unknown,
}

/// Judges the placement of A in B's frame (`places[0]`) and of B in A's (`places[1]`), with tolerance δ.
pub(crate) fn classify_start(
    a: &SphereTree,
    b: &SphereTree,
    places: &[Placement; 2],
    tolerance: f64,
    solids: [Solid; 2],
) -> Start {
    let found = enclose_distance(a, b, &places[0], 4.0 * tolerance);
    if found.lower <= tolerance {
        let Some(closest) = found.closest else { return Start::Unknown };
        let crossing = first_crossing(a, b, &places[0], tolerance);
        let state = if crossing.is_some() { StartState::Overlapping } else { StartState::Touching };
        return Start::Meeting(state, Box::new(crossing.unwrap_or(closest)));
    }
    let filled = solids.map(|solid| solid == Solid::Filled);
    if filled == [false; 2] {
        return Start::Apart;
    }
    let inside = |bodies: (&SphereTree, &SphereTree), place: &Placement| {
        bodies.0.component_vertices().iter().try_fold(false, |known, &v| {
            // The surfaces are further apart than the tolerance, so rounding does not change the side.
            let point = place.enclose_point(bodies.0.vertex(v)).mid();
            Some(known || is_inside(bodies.1, point)?)
        })
    };
    let in_b = if filled[1] { inside((a, b), &places[0]) } else { Some(false) };
    let in_a = if filled[0] { inside((b, a), &places[1]) } else { Some(false) };
    match (in_b, in_a) {
        (Some(false), Some(false)) => Start::Apart,
        (Some(true), _) | (_, Some(true)) => {
            let MeshDistance { closest, .. } = enclose_distance(a, b, &places[0], f64::INFINITY);
            closest.map_or(Start::Unknown, |pair| Start::Meeting(StartState::Contained, Box::new(pair)))
        }
        _ => Start::Unknown,
    }
}

/// Pairs tested for a crossing: bodies that coincide have no end of touching pairs and no crossing one.
const MOST_TESTS: u32 = 4096;

/// A pair of triangles one of which an edge of the other clearly passes through, by more than the tolerance.
fn first_crossing(a: &SphereTree, b: &SphereTree, place: &Placement, tolerance: f64) -> Option<ClosestPair> {
    let mut crossing = None;
    let mut tests = 0;
    visit_close_pairs(a, b, place, tolerance, |pair| {
        tests += 1;
        if crossing.is_none() && pair.detail.upper == 0.0 && is_crossing(b, pair, tolerance) {
            crossing = Some(*pair);
        }
        if crossing.is_some() || tests == MOST_TESTS { f64::NEG_INFINITY } else { f64::INFINITY }
    });
    crossing
}

/// Does an edge of one triangle pass through the other one, reaching more than `margin` to both sides and crossing it
/// more than `margin` from its outline? An estimate.
pub(crate) fn is_crossing(b: &SphereTree, pair: &ClosestPair, margin: f64) -> bool {
    let corners_b = b.corners(pair.triangle_b);
    let passes = |edges: &[DVec3; 3], face: &[DVec3; 3]| {
        (0..3).any(|i| passes_through(edges[i], edges[(i + 1) % 3], face, margin + pair.rounding))
    };
    passes(&pair.corners_a, &corners_b) || passes(&corners_b, &pair.corners_a)
}

/// Does the segment reach more than `margin` to either side of the face, and cross it well inside? An estimate: it only
/// chooses between the words "touching" and "overlapping".
fn passes_through(p: DVec3, q: DVec3, face: &[DVec3; 3], margin: f64) -> bool {
    let [a, b, c] = *face;
    let normal = (b - a).cross(c - a);
    let length = normal.length();
    if length == 0.0 {
        return false;
    }
    let n = normal / length;
    let (s, t) = ((p - a).dot(n), (q - a).dot(n));
    if s.min(t) >= -margin || s.max(t) <= margin {
        return false;
    }
    let x = p + (q - p) * (s / (s - t));
    let turn = |u: DVec3, v: DVec3| (v - u).cross(x - u).dot(n) / (v - u).length();
    turn(a, b).min(turn(b, c)).min(turn(c, a)) > margin
}

/// Directions tried before giving up.
const RAYS: u32 = 64;

/// Is the winding number of the closed surface about `point` not zero (odd, where the surface does not agree about its
/// outside)? `None` where every ray met something whose side rounding left open.
///
/// Every sign is certain or the ray is dropped for another, so an answer is right if `point` is off the surface.
pub(crate) fn is_inside(tree: &SphereTree, point: DVec3) -> Option<bool> {
    let sphere = tree.bounding_sphere();
    let off = (IntervalVec3::point(point) - sphere.center).norm();
    if (off - sphere.radius).certainly_positive() {
        return Some(false);
    }
    let mut seed = 0x9E37_79B9_7F4A_7C15u64;
    let mut number = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    for _ in 0..RAYS {
        let direction = DVec3::new(number(), number(), number());
        if direction.length_squared() < 0.01 {
            continue;
        }
        // Far outside the bounding sphere.
        let far = point + direction * (4.0 * sphere.radius / direction.length());
        if let Some(crossings) = count_crossings(tree, point, far) {
            let odd_only = !tree.is_consistently_oriented();
            return Some(if odd_only { crossings % 2 != 0 } else { crossings != 0 });
        }
    }
    None
}

/// The number of triangles that the segment from `p` to `q` passes the way of their normals, less those that it passes
/// against it; `None` where one of them is not certain.
fn count_crossings(tree: &SphereTree, p: DVec3, q: DVec3) -> Option<i64> {
    let mut crossings = 0;
    let mut open = vec![0u32];
    let along = q - p;
    while let Some(index) = open.pop() {
        let node = tree.node(index);
        let w = node.sphere.center - p;
        // Distance of the center from the line, with a margin far above its rounding error.
        let squared = (w - along * (w.dot(along) / along.length_squared())).length_squared();
        let reach =
            node.sphere.radius * (1.0 + LINE_ROUNDING) + LINE_ROUNDING * (along.length() + w.length());
        if squared > reach * reach {
            continue;
        }
        if !node.is_leaf() {
            open.extend(node.children);
            continue;
        }
        for &t in tree.leaf(node).triangles.iter().filter(|&&t| tree.is_counted(t)) {
            crossings += crosses(p, q, &tree.corners(t))?;
        }
    }
    Some(crossings)
}

/// 1 if the open segment passes through the interior of the triangle the way of its normal, −1 against it, 0 if it does
/// not; `None` where a sign is uncertain.
fn crosses(p: DVec3, q: DVec3, triangle: &[DVec3; 3]) -> Option<i64> {
    let [a, b, c] = *triangle;
    let volume = |u: DVec3, v: DVec3, w: DVec3, x: DVec3| {
        let from = |y: DVec3| IntervalVec3::point(y) - u;
        from(v).cross(from(w)).dot(from(x))
    };
    let (below, above) = (volume(a, b, c, p), volume(a, b, c, q));
    if same_sign(below, above) {
        return Some(0);
    }
    let turns = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    if turns.iter().any(|t| t.certainly_positive()) && turns.iter().any(|t| t.certainly_negative()) {
        return Some(0);
    }
    let certain = |v: &Interval| v.certainly_positive() || v.certainly_negative();
    let sign = if above.certainly_positive() { 1 } else { -1 };
    (certain(&below) && certain(&above) && turns.iter().all(certain)).then_some(sign)
}

fn same_sign(a: Interval, b: Interval) -> bool {
    a.certain_sign() * b.certain_sign() > 0
}
