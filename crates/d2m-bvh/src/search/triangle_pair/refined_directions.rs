//! Directions that may separate two triangles, accurate also for slivers and for edges that are nearly parallel.

use super::closest::{across_all, face_normal};
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
