//! Is a point inside a closed surface? The parity of the crossings of a ray, with exact signs.
//!
//! The ray runs along +x from the point, which is thought of as moved by (0, ε, ε²) with an infinitesimal ε > 0: then it
//! meets no edge and no corner. Each of the three sides of a triangle, seen along x, is crossed by a second ray along +y
//! or not; an odd number of crossings means that the first ray's line meets the triangle. That answer for a side depends
//! on the side and the point only, so the triangles at an edge never disagree, and orientation signs are exact: the
//! parity is right for every closed surface and every point that is not on it, flat triangles included. (Edelsbrunner
//! and Mücke, Simulation of Simplicity, ACM Trans. Graph. 9(1), 1990, doi:10.1145/77635.77639.)

use super::static_pair::Scene;
use crate::MeshTree;
use crate::tree::node::{Below, WIDTH};
use d2m_feature::{orient2d, orient3d};
use glam::{DVec2, DVec3};
use std::cmp::Ordering;

/// Is `point` (body coordinates) in the filled mesh? Exact for the surface whose corners are rounded to the
/// coordinates from the tree's centre; a point on that surface is inside. The mesh must be watertight.
pub(crate) fn contains_point(tree: &MeshTree, point: DVec3) -> bool {
    contains_local_point(tree, point - tree.center())
}

/// The same for a point relative to the tree's centre.
pub(crate) fn contains_local_point(tree: &MeshTree, point: DVec3) -> bool {
    let far = point.abs().max_element();
    if far.is_nan() || far > tree.radius() {
        return false;
    }
    let start = point / tree.unit();
    let mut stack = vec![(0usize, 0usize)];
    let mut hits: Vec<[DVec3; 3]> = Vec::new();
    while let Some((index, lane)) = stack.pop() {
        let node = &tree.nodes[index];
        let boxed = node.oriented_box(lane);
        // |axis·(p − c)| ≤ h for nearly orthonormal axes gives |p_k − c_k| ≤ Σ|axis_k| h + 5.2u r; 1e-6 > 5.2u.
        let reach = |k: usize| {
            let along: f64 =
                (0..3).map(|i| f64::from(boxed.axes[i][k].abs()) * f64::from(boxed.half_extent[i])).sum();
            along + 1e-6 * f64::from(boxed.radius) + 1e-15
        };
        let to = |k: usize| f64::from(node.origin[k]) + f64::from(boxed.center[k]) - start[k];
        if to(1).abs() > reach(1) || to(2).abs() > reach(2) || to(0) < -reach(0) {
            continue;
        }
        match node.below(lane) {
            Below::Triangle(triangle) => {
                let corners = tree.mesh().corners(triangle as usize).map(|p| p - tree.center());
                match crossing(point, &corners) {
                    Crossing::None => {}
                    Crossing::Ahead => hits.push(first_smallest(corners)),
                    Crossing::Here => return true,
                }
            }
            Below::Node(child) => {
                let used = (tree.nodes[child as usize].used as usize).min(WIDTH);
                stack.extend((0..used).map(|lane| (child as usize, lane)));
            }
        }
    }
    // A repetition of a triangle with the same orientation is not part of the surface.
    let new = |i: usize| !hits[..i].contains(&hits[i]);
    (0..hits.len()).filter(|&i| new(i)).count() % 2 == 1
}

/// The same cyclic order with the least corner first: equal for repeated triangles.
fn first_smallest(corners: [DVec3; 3]) -> [DVec3; 3] {
    let key = |p: &DVec3| [p.x, p.y, p.z];
    let first =
        (0..3).min_by(|&i, &j| key(&corners[i]).partial_cmp(&key(&corners[j])).unwrap_or(Ordering::Equal));
    let first = first.unwrap_or(0);
    [corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]]
}

/// How the ray along +x stands to a triangle.
enum Crossing {
    None,
    Ahead,
    /// The point is on the triangle.
    Here,
}

fn crossing(point: DVec3, corners: &[DVec3; 3]) -> Crossing {
    let flat = |p: DVec3| DVec2::new(p.y, p.z);
    let here = flat(point);
    let crosses = |p: DVec3, q: DVec3| {
        let (p, q) = if p.z > point.z { (q, p) } else { (p, q) };
        // From below, or level, to above; at a tie of the sign the moved point is beyond the side.
        p.z <= point.z && q.z > point.z && orient2d(flat(p), flat(q), here) == Ordering::Greater
    };
    let [a, b, c] = *corners;
    if !(crosses(a, b) ^ crosses(b, c) ^ crosses(c, a)) {
        return Crossing::None;
    }
    // The normal's x component has the sign of the turn seen along x, and the ray ends on the triangle's far side.
    let facing = orient2d(flat(a), flat(b), flat(c));
    match orient3d(a, b, c, point) {
        Ordering::Equal => Crossing::Here,
        side if side == facing.reverse() => Crossing::Ahead,
        _ => Crossing::None,
    }
}

/// Which body holds the other, if one does (0: A holds a part of B, 1: B holds a part of A)? For surfaces whose
/// placed triangles are more than `scene.error` apart: moving every corner to its placed position is then a motion
/// without contact, so what is inside stays inside.
pub(crate) fn one_holds_the_other(scene: &Scene<'_>) -> Option<usize> {
    let (rows, back) = scene.pose.inverse();
    let sides = [(rows, back), (scene.pose.rotation, scene.pose.offset)];
    (0..2).find(|&outer| {
        let (holder, inner) = (scene.trees[outer], scene.trees[1 - outer]);
        let (r, offset) = &sides[outer];
        inner.component_vertices().iter().any(|&vertex| {
            let p = inner.mesh().vertices()[vertex as usize] - inner.center();
            contains_local_point(holder, r[0] * p.x + r[1] * p.y + r[2] * p.z + *offset)
        })
    })
}
