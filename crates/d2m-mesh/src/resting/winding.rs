//! Is a point in a closed solid? The winding number of the surface about it, from the crossings of a ray, with exact
//! signs.
//!
//! The ray runs along an axis from the point, which is thought of as moved by (0, ε, ε²) across the axis with an
//! infinitesimal ε > 0: then it meets no edge and no vertex. Each of the three edges of a triangle, seen along the axis, is
//! crossed by a second ray across it or not; an odd number of crossings means that the first ray's line meets the
//! triangle. That answer for an edge depends on the edge and the point only, so the triangles at an edge never
//! disagree, and orientation signs are exact: the count is right for every closed surface and every point that is
//! not on it, flat triangles included. (Edelsbrunner and Mücke, Simulation of Simplicity, ACM Trans. Graph. 9(1), 1990,
//! doi:10.1145/77635.77639.)
//!
//! A triangle counts +1 where the ray goes the way of its normal and −1 where it goes against it: the sum is the winding
//! number, the same along every ray if each edge is run through as often one way as the other. The point is in
//! the solid if it is not zero: parts that overlap (2) and parts that are inside out (−1) are solid, a cavity (1 − 1) is
//! not. Surfaces that close but do not agree about the outside have a parity only, and that decides.

use crate::MeshTree;
use crate::meter::{Exhausted, Meter};
use crate::tree::node::{Below, WIDTH};
use d2m_feature::{orient2d, orient3d};
use glam::{DVec2, DVec3};
use std::cmp::Ordering;

/// Boxes that one ray may test before another direction is tried, at first; then this factor more. A ray through as
/// many layers in every direction costs twelve times the least, at most.
const FIRST_TESTS: u64 = 512;
const MORE_TESTS: u64 = 8;

/// A box reaches |p_k − c_k| ≤ Σ|axis_k| h + 5.2u r for nearly orthonormal axes (docs/theory/static-queries.md); this
/// is 16u, u = 2⁻²⁴, and so covers the rounding of the sum as well.
const AXES_ERROR: f64 = 16.0 / 16_777_216.0;
/// Local coordinates of the point and of the boxes round by less than 2⁻⁵⁰ together: all are below 4.
const PLACE_ERROR: f64 = 1.0 / 1_125_899_906_842_624.0;

/// Is the point (body axes, from the tree's center) in the closed solid, or on its surface? Exact for the surface whose
/// vertices are rounded to coordinates from the tree's center. The mesh must be watertight.
pub(super) fn contains(tree: &MeshTree, point: DVec3, meter: &mut Meter) -> Result<bool, Exhausted> {
    let far = point.abs().max_element();
    if far.is_nan() || far > tree.radius() || is_beside(tree, point) {
        return Ok(false);
    }
    let mut most = FIRST_TESTS;
    loop {
        for axis in 0..3 {
            for backward in [false, true] {
                let ray = Ray { tree, point, axis, backward };
                if let Some(inside) = ray.is_inside(most, meter)? {
                    return Ok(inside);
                }
            }
        }
        most = most.saturating_mul(MORE_TESTS);
    }
}

/// Beside the box of the whole body?
fn is_beside(tree: &MeshTree, point: DVec3) -> bool {
    let (to, reach) = box_along_axes(tree, 0, 0, point / tree.unit());
    (to.abs() - reach).max_element() > 0.0
}

/// From the point (local coordinates) to the center of a box, and a bound on the box's reach along each axis.
#[inline(always)]
fn box_along_axes(tree: &MeshTree, node: usize, lane: usize, point: DVec3) -> (DVec3, DVec3) {
    let node = &tree.nodes[node];
    let boxed = node.oriented_box(lane);
    let reach = |k: usize| {
        let along: f64 =
            (0..3).map(|i| f64::from(boxed.axes[i][k].abs()) * f64::from(boxed.half_extent[i])).sum();
        along + AXES_ERROR * f64::from(boxed.radius) + PLACE_ERROR
    };
    let to = |k: usize| f64::from(node.origin[k]) + f64::from(boxed.center[k]) - point[k];
    (DVec3::new(to(0), to(1), to(2)), DVec3::new(reach(0), reach(1), reach(2)))
}

/// A ray along an axis of the body.
struct Ray<'a> {
    tree: &'a MeshTree,
    point: DVec3,
    axis: usize,
    backward: bool,
}

/// How a ray stands to a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Crossing {
    None,
    /// Ahead; +1 where the ray goes the way of the triangle's normal, −1 where it goes against it.
    Ahead(i32),
    /// The point is on the triangle.
    Here,
}

impl Ray<'_> {
    /// `None`: more than `most` boxes.
    fn is_inside(&self, most: u64, meter: &mut Meter) -> Result<Option<bool>, Exhausted> {
        let start = self.point / self.tree.unit();
        let (mut winding, mut odd, mut tests) = (0i64, false, 0);
        let mut stack = vec![(0usize, 0usize)];
        while let Some((node, lane)) = stack.pop() {
            tests += 1;
            if tests > most {
                return Ok(None);
            }
            meter.step()?;
            let (to, reach) = box_along_axes(self.tree, node, lane, start);
            let ahead = if self.backward { -to[self.axis] } else { to[self.axis] };
            let [u, v] = [(self.axis + 1) % 3, (self.axis + 2) % 3];
            if to[u].abs() > reach[u] || to[v].abs() > reach[v] || ahead < -reach[self.axis] {
                continue;
            }
            match self.tree.nodes[node].below(lane) {
                Below::Triangle(triangle) => {
                    match self.crossing(triangle) {
                        Crossing::None => {}
                        // A repetition of a triangle with the same orientation is not part of the surface.
                        Crossing::Ahead(_) if self.tree.repeated.binary_search(&triangle).is_ok() => {}
                        Crossing::Ahead(sign) => (winding, odd) = (winding + i64::from(sign), !odd),
                        Crossing::Here => return Ok(Some(true)),
                    }
                }
                Below::Node(child) => {
                    let used = (self.tree.nodes[child as usize].used as usize).min(WIDTH);
                    stack.extend((0..used).map(|lane| (child as usize, lane)));
                }
            }
        }
        Ok(Some(if self.tree.oriented { winding != 0 } else { odd }))
    }

    fn crossing(&self, triangle: u32) -> Crossing {
        let corners = self.tree.mesh().corners(triangle as usize);
        let [a, b, c] = corners.map(|p| self.seen(p - self.tree.center()));
        let point = self.seen(self.point);
        let flat = |p: DVec3| DVec2::new(p.y, p.z);
        let here = flat(point);
        let crosses = |p: DVec3, q: DVec3| {
            let (p, q) = if p.z > point.z { (q, p) } else { (p, q) };
            // From below, or level, to above; at a tie of the sign the moved point is beyond the edge.
            p.z <= point.z && q.z > point.z && orient2d(flat(p), flat(q), here) == Ordering::Greater
        };
        if !(crosses(a, b) ^ crosses(b, c) ^ crosses(c, a)) {
            return Crossing::None;
        }
        // The normal's component along the axis has the sign of the turn seen along it, and the ray ends on the
        // triangle's far side.
        let facing = orient2d(flat(a), flat(b), flat(c));
        match orient3d(a, b, c, point) {
            Ordering::Equal => Crossing::Here,
            // Seen in a mirror all signs change, which is the same to us.
            side if side == facing.reverse() => {
                Crossing::Ahead(if facing == Ordering::Greater { 1 } else { -1 })
            }
            _ => Crossing::None,
        }
    }

    /// The axis of the ray first; backwards in a mirror. Exact.
    fn seen(&self, p: DVec3) -> DVec3 {
        let k = self.axis;
        DVec3::new(if self.backward { -p[k] } else { p[k] }, p[(k + 1) % 3], p[(k + 2) % 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshArrays, TriMesh};
    use d2m_testing::{Draw, KnuthRandom, Surface};

    /// Boxes from `low` to `high`; inside out where `inverted`.
    fn boxes(parts: &[(DVec3, DVec3, bool)]) -> TriMesh {
        let surfaces = parts.iter().map(|&(low, high, inverted)| {
            let cuboid = Surface::cuboid(low, high);
            if inverted { cuboid.inverted() } else { cuboid }
        });
        surfaces.reduce(|all, next| all.with(&next)).expect("a part").into_mesh(TriMesh::try_new)
    }

    fn is_inside(tree: &MeshTree, point: DVec3) -> bool {
        contains(tree, point - tree.center(), &mut Meter::unlimited()).unwrap()
    }

    /// Boxes with integer corners, points on the half-integer lattice and on lines through vertices and edges: every kind of
    /// ray through a vertex, along an edge and within a face.
    #[test]
    fn winding_numbers_of_boxes_are_counted_exactly() {
        let mut random = KnuthRandom(11);
        let mut number = |most: u32| ((random.signed() + 1.0) * 0.5 * f64::from(most)) as u32 % most;
        let (mut inside, mut outside) = (0, 0);
        for _ in 0..200 {
            let parts: Vec<(DVec3, DVec3, bool)> = (0..=number(5))
                .map(|_| {
                    let mut ends = || {
                        let low = number(6);
                        (f64::from(low), f64::from(low + 1 + number(4)))
                    };
                    let [x, y, z] = [0; 3].map(|_| ends());
                    (DVec3::new(x.0, y.0, z.0), DVec3::new(x.1, y.1, z.1), number(3) == 0)
                })
                .collect();
            let tree = MeshTree::new(boxes(&parts));
            for _ in 0..100 {
                let point = [0; 3].map(|_| f64::from(number(20)) * 0.5);
                let point = DVec3::from_array(point);
                let within = |low: DVec3, high: DVec3| point.cmpge(low).all() && point.cmple(high).all();
                let strictly = |low: DVec3, high: DVec3| point.cmpgt(low).all() && point.cmplt(high).all();
                if parts.iter().any(|&(low, high, _)| within(low, high) && !strictly(low, high)) {
                    continue; // on a surface
                }
                // Equal boxes repeat each other's triangles, which count once.
                let mut seen: Vec<&(DVec3, DVec3, bool)> = Vec::new();
                for part in &parts {
                    if !seen.contains(&part) {
                        seen.push(part);
                    }
                }
                let winding: i32 = seen
                    .iter()
                    .filter(|&&&(low, high, _)| strictly(low, high))
                    .map(|part| if part.2 { -1 } else { 1 })
                    .sum();
                assert_eq!(is_inside(&tree, point), winding != 0, "{point} {parts:?}");
                for (axis, backward) in (0..6).map(|k| (k % 3, k > 2)) {
                    let ray = Ray { tree: &tree, point: point - tree.center(), axis, backward };
                    let found = ray.is_inside(u64::MAX, &mut Meter::unlimited());
                    assert_eq!(found, Ok(Some(winding != 0)), "{point} {parts:?} {axis} {backward}");
                }
                *if winding != 0 { &mut inside } else { &mut outside } += 1;
            }
        }
        assert!(inside > 200 && outside > 200, "{inside} {outside}");
    }

    /// A surface whose faces disagree about the outside has a parity.
    #[test]
    fn without_an_orientation_parity_decides() {
        let joined = boxes(&[(DVec3::ZERO, DVec3::ONE * 3.0, false), (DVec3::ONE, DVec3::ONE * 2.0, false)]);
        let MeshArrays { mut vertices, mut triangles } = joined.into_arrays();
        triangles[5].swap(0, 1);
        vertices.push(DVec3::ZERO);
        let tree = MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap());
        assert!(is_inside(&tree, DVec3::splat(0.5)) && !is_inside(&tree, DVec3::splat(1.5)));
    }

    /// Thousands of thin walls side by side: one ray in six crosses few of them, and the work does not grow with their number.
    #[test]
    fn rays_avoid_many_layers() {
        let wall = |k: usize| {
            let x = k as f64 * 1e-3;
            (DVec3::new(x, -1.0, -1.0), DVec3::new(x + 1e-4, 1.0, 1.0), false)
        };
        let walls: Vec<_> = (0..2000).map(wall).collect();
        let tree = MeshTree::new(boxes(&walls));
        for (x, expected) in [(1.0 + 5e-5, true), (1.0 + 5e-4, false), (-0.5, false)] {
            let point = DVec3::new(x, 0.1, 0.2) - tree.center();
            let mut few = Meter::unlimited().at_most(4 * FIRST_TESTS);
            assert_eq!(contains(&tree, point, &mut few), Ok(expected), "{x}");
        }
    }
}
