//! Polygons of mesh files as triangles.
//!
//! Every way of cutting keeps the polygon's sides, so a closed mesh stays closed. A convex polygon becomes a fan about its
//! first corner; another one is cut ear by ear (an ear is a corner whose triangle holds no other corner), seen along its
//! normal, with exact orientation signs. What has no ear, because it crosses itself or is far from flat, ends as a fan.

use d2m::feature::orient2d;
use glam::{DVec2, DVec3};
use std::cmp::Ordering::{Greater, Less};

/// Cutting ears takes up to cubic time; larger polygons become fans.
const MOST_CORNERS: usize = 1000;

/// The n − 2 triangles of a polygon of n corners; none for one or two corners.
pub(super) fn triangulate(polygon: &[u32], vertices: &[DVec3]) -> Vec<[u32; 3]> {
    if polygon.len() <= 3 || polygon.len() > MOST_CORNERS {
        return fan(polygon);
    }
    let corners: Option<Vec<DVec3>> =
        polygon.iter().map(|&index| vertices.get(index as usize).copied()).collect();
    match corners {
        Some(corners) => cut_ears(polygon, &flatten(&corners)),
        None => fan(polygon), // an index is out of range, which the mesh will say
    }
}

fn fan(polygon: &[u32]) -> Vec<[u32; 3]> {
    polygon.windows(2).skip(1).map(|pair| [polygon[0], pair[0], pair[1]]).collect()
}

/// Seen along the axis nearest to the normal (Newell's sum over the sides), counter-clockwise.
fn flatten(corners: &[DVec3]) -> Vec<DVec2> {
    let next = corners.iter().cycle().skip(1);
    let origin = corners[0];
    let normal: DVec3 = corners.iter().zip(next).map(|(&p, &q)| (p - origin).cross(q - origin)).sum();
    let size = normal.abs();
    let project: fn(DVec3) -> DVec2 = if size.x >= size.y && size.x >= size.z {
        if normal.x >= 0.0 { |p| DVec2::new(p.y, p.z) } else { |p| DVec2::new(p.z, p.y) }
    } else if size.y >= size.z {
        if normal.y >= 0.0 { |p| DVec2::new(p.z, p.x) } else { |p| DVec2::new(p.x, p.z) }
    } else if normal.z >= 0.0 {
        |p| DVec2::new(p.x, p.y)
    } else {
        |p| DVec2::new(p.y, p.x)
    };
    corners.iter().map(|&corner| project(corner)).collect()
}

fn cut_ears(polygon: &[u32], flat: &[DVec2]) -> Vec<[u32; 3]> {
    let mut rest: Vec<usize> = (0..polygon.len()).collect();
    let mut triangles = Vec::with_capacity(polygon.len() - 2);
    let turn = |rest: &[usize], i: usize| {
        let n = rest.len();
        orient2d(flat[rest[(i + n - 1) % n]], flat[rest[i]], flat[rest[(i + 1) % n]])
    };
    while rest.len() > 3 {
        let n = rest.len();
        if (0..n).all(|i| turn(&rest, i) != Less) {
            break; // convex: a fan will do
        }
        let is_ear = |&i: &usize| {
            let [p, q, r] = [rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]];
            let [a, b, c] = [flat[p], flat[q], flat[r]];
            let holds = |point: DVec2| {
                point != a
                    && point != b
                    && point != c
                    && [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| orient2d(from, to, point) != Less)
            };
            turn(&rest, i) == Greater && !rest.iter().any(|&other| holds(flat[other]))
        };
        let Some(ear) = (0..n).find(is_ear) else { break };
        triangles
            .push([rest[(ear + n - 1) % n], rest[ear], rest[(ear + 1) % n]].map(|corner| polygon[corner]));
        rest.remove(ear);
    }
    let rest: Vec<u32> = rest.into_iter().map(|corner| polygon[corner]).collect();
    triangles.extend(fan(&rest));
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area(flat: &[DVec2]) -> f64 {
        let next = flat.iter().cycle().skip(1);
        0.5 * flat.iter().zip(next).map(|(p, q)| p.perp_dot(*q)).sum::<f64>()
    }

    /// The sum of the triangles' absolute areas, which exceeds the polygon's if triangles overlap or lie outside.
    fn covered(flat: &[DVec2]) -> f64 {
        let vertices: Vec<DVec3> = flat.iter().map(|p| DVec3::new(p.x, 2.0 - p.x, p.y)).collect();
        let polygon: Vec<u32> = (0..flat.len() as u32).collect();
        let triangles = triangulate(&polygon, &vertices);
        assert_eq!(triangles.len(), flat.len() - 2);
        triangles.iter().map(|t| area(&t.map(|index| flat[index as usize])).abs()).sum()
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        let arrow = [(0.0, 0.0), (2.0, 1.0), (0.0, 2.0), (0.5, 1.0)];
        let letter = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)];
        let comb = [
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 3.0),
            (4.0, 3.0),
            (4.0, 1.0),
            (3.0, 1.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ];
        for polygon in [&arrow[..], &letter, &comb] {
            for first in 0..polygon.len() {
                let mut flat: Vec<DVec2> = polygon.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
                flat.rotate_left(first);
                assert!((covered(&flat) - area(&flat)).abs() < 1e-12, "{flat:?}");
                flat.reverse();
                assert!((covered(&flat) + area(&flat)).abs() < 1e-12, "{flat:?}");
            }
        }
    }

    proptest! {
        /// Star-shaped outlines with random radii.
        #[test]
        fn stars_are_covered_once(radii in prop::collection::vec(0.1..1.0_f64, 4..40)) {
            let step = std::f64::consts::TAU / radii.len() as f64;
            let flat: Vec<DVec2> =
                radii.iter().enumerate().map(|(k, &r)| DVec2::from_angle(step * k as f64) * r).collect();
            prop_assert!((covered(&flat) - area(&flat)).abs() < 1e-9);
        }

        /// Anything at all gives n − 2 triangles that keep the sides.
        #[test]
        fn tangles_keep_their_sides(corners in prop::collection::vec((-2..3, -2..3, -2..3), 3..12)) {
            let vertices: Vec<DVec3> =
                corners.iter().map(|p: &(i32, i32, i32)| DVec3::new(p.0.into(), p.1.into(), p.2.into())).collect();
            let polygon: Vec<u32> = (0..vertices.len() as u32).collect();
            let triangles = triangulate(&polygon, &vertices);
            prop_assert_eq!(triangles.len(), polygon.len() - 2);
            let mut balance = std::collections::HashMap::new();
            for [a, b, c] in triangles {
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    *balance.entry((from, to)).or_insert(0) += 1;
                    *balance.entry((to, from)).or_insert(0) -= 1;
                }
            }
            for k in 0..polygon.len() {
                let side = (polygon[k], polygon[(k + 1) % polygon.len()]);
                prop_assert_eq!(balance.remove(&side), Some(1));
            }
            prop_assert_eq!(balance.values().filter(|&&count| count > 0).count(), 0);
        }
    }
}
