//! Directions that may separate two triangles, accurate also for slivers and for edges that are nearly parallel.

use super::closest::{across_all, face_normal};
use crate::gap::widest_gap::{greatest, least};
use glam::DVec3;

/// The normals of two triangles, the normals of their edges in their planes, the products of their edges: each
/// re-orthogonalised against the edges that it should be at right angles to, the longer one last.
///
/// A cross product errs by a rounding of the product of the lengths. Where it is short that is a large angle; but only what
/// it has along the edges themselves loses gap in proportion to it, and that is taken off.
pub(super) fn refined_directions(a: &[DVec3; 3], b: &[DVec3; 3]) -> impl Iterator<Item = DVec3> {
    let (normals, [edges_a, edges_b]) = ([a, b].map(face_normal), [a, b].map(edges));
    let in_planes = [(normals[0], edges_a), (normals[1], edges_b)]
        .into_iter()
        .flat_map(|(normal, edges)| edges.map(|edge| across_all(normal.cross(edge), &[edge, edge])));
    let products = edges_a.into_iter().flat_map(move |e| {
        edges_b.map(|d| {
            let (short, long) = if e.length_squared() < d.length_squared() { (e, d) } else { (d, e) };
            across_all(e.cross(d), &[short, long])
        })
    });
    normals.into_iter().chain(in_planes).chain(products)
}

fn edges(t: &[DVec3; 3]) -> [DVec3; 3] {
    [t[1] - t[0], t[2] - t[1], t[0] - t[2]]
}

/// The sum of all directions that part the triangles with the same sense, each of length one: it parts them too, and lasts longer
/// than one at the border of those that do, as most of them are. Zero where none does.
pub(super) fn middle_direction(a: &[DVec3; 3], b: &[DVec3; 3]) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for direction in refined_directions(a, b) {
        let n = direction.normalize_or_zero();
        let (pa, pb) = (a.map(|p| n.dot(p)), b.map(|p| n.dot(p)));
        let (forward, backward) = (least(&pb) - greatest(&pa), least(&pa) - greatest(&pb));
        if forward > 0.0 {
            sum += n;
        } else if backward > 0.0 {
            sum -= n;
        }
    }
    sum
}
