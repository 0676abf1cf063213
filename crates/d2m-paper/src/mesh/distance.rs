//! Distance of two meshes at one time, enclosed, on the sphere trees.

use super::sphere_tree::{Node, SphereTree};
use crate::feature::Placement;
use d2m_feature::{TriangleDistance, triangle_distance};
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// The distance of two boxes takes fewer than ten roundings of 2⁻⁵³ each; 2⁻⁴⁰ is far more than they add up to.
const BOX_ROUNDING: f64 = 1.0 - 1.0 / 1_099_511_627_776.0;

/// The distance of two surfaces at one time, enclosed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MeshDistance {
    /// The surfaces are at least this far apart; the cut-off if nothing is closer than that.
    pub(crate) lower: f64,
    /// They are at most this far apart; ∞ if the cut-off stopped the search.
    pub(crate) upper: f64,
    /// The closest pair, if it is closer than the cut-off.
    pub(crate) closest: Option<ClosestPair>,
}

/// The closest pair of triangles; positions in B's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClosestPair {
    pub(crate) triangle_a: u32,
    pub(crate) triangle_b: u32,
    pub(crate) detail: TriangleDistance,
    /// A's vertices in B's frame, rounded.
    pub(crate) corners_a: [DVec3; 3],
    /// The vertices are within this of their true places.
    pub(crate) rounding: f64,
}

/// Encloses the distance of A, placed in B's frame, and B; nothing beyond `cutoff` is searched.
pub(crate) fn enclose_distance(
    a: &SphereTree,
    b: &SphereTree,
    place: &Placement,
    cutoff: f64,
) -> MeshDistance {
    let mut found = MeshDistance { lower: cutoff, upper: f64::INFINITY, closest: None };
    visit_close_pairs(a, b, place, cutoff, |pair| {
        let lower = (pair.detail.lower - pair.rounding).next_down().max(0.0);
        let upper = (pair.detail.upper + pair.rounding).next_up();
        found.lower = found.lower.min(lower);
        if upper < found.upper {
            found.upper = upper;
            found.closest = Some(*pair);
        }
        // Nothing is closer than a common point.
        if pair.detail.upper == 0.0 { f64::NEG_INFINITY } else { found.upper }
    });
    if !found.lower.is_finite() {
        found.lower = 0.0;
    }
    found
}

/// Calls `visit` with pairs of triangles, closest spheres first, among them every pair whose distance is less than the
/// smaller of `cutoff` and the least value that `visit` has returned.
pub(crate) fn visit_close_pairs(
    a: &SphereTree,
    b: &SphereTree,
    place: &Placement,
    cutoff: f64,
    mut visit: impl FnMut(&ClosestPair) -> f64,
) {
    let mut limit = cutoff;
    let center = |node: &Node| place.enclose_point(node.sphere.center);
    let gap = |(center, radius): &(IntervalVec3, f64), node: &Node| {
        let radii = Interval::point(*radius) + node.sphere.radius;
        ((*center - node.sphere.center).norm() - radii).lo()
    };
    let root = a.node(0);
    let mut placed = PlacedLeaf::default();
    let mut open = vec![(f64::NEG_INFINITY, 0u32, 0u32, (center(root), root.sphere.radius))];
    while let Some((least, index_a, index_b, sphere)) = open.pop() {
        if least > limit {
            continue;
        }
        let (node_a, node_b) = (a.node(index_a), b.node(index_b));
        if node_a.is_leaf() && node_b.is_leaf() {
            placed.fill(a, index_a, place);
            limit = limit.min(leaf_pairs(&placed, b, node_b, limit, &mut visit));
            continue;
        }
        let descend_a =
            !node_a.is_leaf() && (node_b.is_leaf() || node_a.sphere.radius >= node_b.sphere.radius);
        let mut next = if descend_a {
            node_a.children.map(|child| {
                let child_node = a.node(child);
                let sphere = (center(child_node), child_node.sphere.radius);
                (gap(&sphere, node_b), child, index_b, sphere)
            })
        } else {
            node_b.children.map(|child| (gap(&sphere, b.node(child)), index_a, child, sphere))
        };
        next.sort_by(|p, q| q.0.total_cmp(&p.0));
        open.extend(next.into_iter().filter(|n| n.0 <= limit || n.0.is_nan()));
    }
}

/// The triangles of one leaf of A in B's frame.
#[derive(Default)]
struct PlacedLeaf {
    node: u32,
    triangles: Vec<(u32, [DVec3; 3], f64)>,
}

impl PlacedLeaf {
    /// Keeps what is there if it is the same leaf: the search visits a leaf against many others in turn.
    fn fill(&mut self, tree: &SphereTree, node: u32, place: &Placement) {
        if self.node == node && !self.triangles.is_empty() {
            return;
        }
        self.node = node;
        self.triangles.clear();
        for &triangle in &tree.leaf(tree.node(node)).triangles {
            let (corners, rounding) = placed(tree, triangle, place);
            self.triangles.push((triangle, corners, rounding));
        }
    }
}

/// A triangle of A in B's frame, and how far its vertices may be from there.
fn placed(tree: &SphereTree, triangle: u32, place: &Placement) -> ([DVec3; 3], f64) {
    let enclosed = tree.corners(triangle).map(|p| place.enclose_point(p));
    let corners = enclosed.map(IntervalVec3::mid);
    (corners, (0..3).map(|i| (enclosed[i] - corners[i]).norm().hi()).fold(0.0, f64::max))
}

/// Are A, placed in B's frame, and B within this distance of each other for certain? These two triangles are compared first.
pub(crate) fn are_within(
    a: &SphereTree,
    b: &SphereTree,
    place: &Placement,
    distance: f64,
    [of_a, of_b]: [u32; 2],
) -> bool {
    let (corners, rounding) = placed(a, of_a, place);
    (triangle_distance(&corners, &b.corners(of_b)).upper + rounding).next_up() <= distance
        || enclose_distance(a, b, place, 2.0 * distance).upper <= distance
}

fn leaf_pairs(
    placed: &PlacedLeaf,
    b: &SphereTree,
    node_b: &Node,
    mut limit: f64,
    visit: &mut impl FnMut(&ClosestPair) -> f64,
) -> f64 {
    for &(triangle_a, corners_a, rounding) in &placed.triangles {
        let box_a = bounds(&corners_a);
        for &triangle_b in &b.leaf(node_b).triangles {
            let corners_b = b.corners(triangle_b);
            if boxes_apart(box_a, bounds(&corners_b)) * BOX_ROUNDING > limit + rounding {
                continue;
            }
            let detail = triangle_distance(&corners_a, &corners_b);
            limit = limit.min(visit(&ClosestPair { triangle_a, triangle_b, detail, corners_a, rounding }));
        }
    }
    limit
}

fn bounds(t: &[DVec3; 3]) -> (DVec3, DVec3) {
    (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]))
}

/// About the largest distance of two boxes along an axis, at least 0.
fn boxes_apart(a: (DVec3, DVec3), b: (DVec3, DVec3)) -> f64 {
    (b.0 - a.1).max(a.0 - b.1).max_element().max(0.0)
}
