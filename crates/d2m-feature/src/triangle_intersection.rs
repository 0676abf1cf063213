//! Do two closed triangles share a point? Decided exactly.

use crate::exact_sign::{orient2d, orient3d};
use glam::{DVec2, DVec3};
use std::cmp::Ordering::{self, Equal};

/// Whether two closed triangles have a point in common, decided exactly for all finite vertices: touching counts, and
/// degenerate triangles are the segments or points that their vertices span.
///
/// Two convex polygons meet if and only if an edge of one meets the other one (if the planes cross, the common part is a
/// segment whose ends lie on edges; if they coincide, either edges cross or one polygon holds an edge of the other), so
/// six edge/triangle tests decide, each by exact orientation signs.
///
/// ```
/// use d2m_feature::triangles_intersect;
/// use glam::{DVec3, dvec3};
///
/// let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let touching = [dvec3(0.25, 0.25, 0.0), dvec3(0.0, 0.0, 1.0), dvec3(1.0, 1.0, 1.0)];
/// assert!(triangles_intersect(&floor, &touching));
/// let above = touching.map(|vertex| vertex + dvec3(0.0, 0.0, 1e-300));
/// assert!(!triangles_intersect(&floor, &above));
/// ```
pub fn triangles_intersect(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    if boxes_are_apart(a, b) {
        return false;
    }
    let sides_of_b = b.map(|point| orient3d(a[0], a[1], a[2], point));
    if strictly_on_one_side(sides_of_b) {
        return false;
    }
    let sides_of_a = a.map(|point| orient3d(b[0], b[1], b[2], point));
    if strictly_on_one_side(sides_of_a) {
        return false;
    }
    let edge = |triangle: &[DVec3; 3], slot: usize| [triangle[slot], triangle[(slot + 1) % 3]];
    (0..3).any(|slot| {
        edge_meets_triangle(edge(b, slot), [sides_of_b[slot], sides_of_b[(slot + 1) % 3]], a)
            || edge_meets_triangle(edge(a, slot), [sides_of_a[slot], sides_of_a[(slot + 1) % 3]], b)
    })
}

fn boxes_are_apart(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    let low = |t: &[DVec3; 3]| t[0].min(t[1]).min(t[2]);
    let high = |t: &[DVec3; 3]| t[0].max(t[1]).max(t[2]);
    high(a).cmplt(low(b)).any() || high(b).cmplt(low(a)).any()
}

fn strictly_on_one_side(sides: [Ordering; 3]) -> bool {
    sides[0] != Equal && sides[0] == sides[1] && sides[0] == sides[2]
}

/// `sides` are the sides of the edge's ends with respect to the triangle's plane (all equal for a degenerate triangle).
fn edge_meets_triangle([p, q]: [DVec3; 2], sides: [Ordering; 2], triangle: &[DVec3; 3]) -> bool {
    let [a, b, c] = *triangle;
    if sides == [Equal, Equal] {
        return match try_projection(&[a, b, c]) {
            Some(axis) => {
                let flat = |point| drop_axis(point, axis);
                edge_meets_triangle_2d([flat(p), flat(q)], [flat(a), flat(b), flat(c)])
            }
            // A triangle without area is the union of its edges.
            None => [[a, b], [b, c], [c, a]].into_iter().any(|edge| segments_meet([p, q], edge)),
        };
    }
    if sides[0] == sides[1] {
        return false;
    }
    // The line p, q crosses the plane in one point; it lies in the triangle if the line passes all three edges on one
    // side or through them. A degenerate triangle does not get here: all its sides are equal.
    not_mixed([orient3d(p, q, a, b), orient3d(p, q, b, c), orient3d(p, q, c, a)])
}

/// Not both a positive and a negative sign among the three.
fn not_mixed(signs: [Ordering; 3]) -> bool {
    !(signs.contains(&Ordering::Less) && signs.contains(&Ordering::Greater))
}

fn drop_axis(point: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => DVec2::new(point.y, point.z),
        1 => DVec2::new(point.z, point.x),
        _ => DVec2::new(point.x, point.y),
    }
}

/// An axis along which the plane of the three points projects one-to-one; none if they are on a line.
fn try_projection(points: &[DVec3; 3]) -> Option<usize> {
    (0..3).find(|&axis| {
        let [a, b, c] = points.map(|point| drop_axis(point, axis));
        orient2d(a, b, c) != Equal
    })
}

/// In the plane, for a triangle with area.
fn edge_meets_triangle_2d([p, q]: [DVec2; 2], [a, b, c]: [DVec2; 3]) -> bool {
    let inside = |point| not_mixed([orient2d(a, b, point), orient2d(b, c, point), orient2d(c, a, point)]);
    inside(p) || [[a, b], [b, c], [c, a]].into_iter().any(|edge| segments_meet_2d([p, q], edge))
}

fn segments_meet([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> bool {
    if orient3d(p, q, r, s) != Equal {
        return false;
    }
    let triples = [[p, q, r], [p, q, s], [p, r, s], [q, r, s]];
    match triples.iter().find_map(try_projection) {
        Some(axis) => {
            let flat = |point| drop_axis(point, axis);
            segments_meet_2d([flat(p), flat(q)], [flat(r), flat(s)])
        }
        // All four on one line, along which the lexicographic order is the order of the line.
        None => ranges_meet([p, q].map(|point| point.to_array()), [r, s].map(|point| point.to_array())),
    }
}

fn segments_meet_2d([p, q]: [DVec2; 2], [r, s]: [DVec2; 2]) -> bool {
    let first = [orient2d(p, q, r), orient2d(p, q, s)];
    let second = [orient2d(r, s, p), orient2d(r, s, q)];
    if first == [Equal; 2] && second == [Equal; 2] {
        return ranges_meet([p, q].map(|point| point.to_array()), [r, s].map(|point| point.to_array()));
    }
    let crosses = |sides: [Ordering; 2]| sides[0] == Equal || sides[0] != sides[1];
    crosses(first) && crosses(second)
}

/// Whether two segments of one line overlap, their ends compared lexicographically.
fn ranges_meet<T: PartialOrd>([p, q]: [T; 2], [r, s]: [T; 2]) -> bool {
    let (p, q) = if p <= q { (p, q) } else { (q, p) };
    let (r, s) = if r <= s { (r, s) } else { (s, r) };
    p <= s && r <= q
}
