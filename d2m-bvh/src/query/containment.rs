//! Is a point inside a closed surface? Parity of the crossings of a ray that stays clear of edges.

use crate::MeshTree;
use crate::tree::node::{Below, WIDTH};
use glam::DVec3;

/// Directions that are tried one after the other; no two share a plane with a coordinate axis.
const DIRECTIONS: [DVec3; 6] = [
    DVec3::new(0.577_123, 0.601_717, 0.552_101),
    DVec3::new(-0.267_191, 0.801_713, 0.534_571),
    DVec3::new(0.842_113, -0.331_171, 0.425_507),
    DVec3::new(0.151_197, 0.349_813, -0.924_557),
    DVec3::new(-0.713_141, -0.517_271, 0.473_197),
    DVec3::new(-0.419_813, 0.227_191, -0.878_713),
];
/// A crossing counts when it is at least this far from every edge, relative to the lengths involved.
const CLEARANCE: f64 = 1e-11;

/// Is `point` (body coordinates) inside the filled mesh? For points away from the surface. Parity of ray crossings;
/// when every direction grazes an edge, the winding number.
pub(crate) fn contains_point(tree: &MeshTree, point: DVec3) -> bool {
    let local = point - tree.center();
    if local.length() > tree.radius() * (1.0 + 1e-12) {
        return false;
    }
    for direction in DIRECTIONS {
        if let Some(crossings) = count_crossings(tree, local, direction) {
            return crossings % 2 == 1;
        }
    }
    winding(tree, local).round() as i64 % 2 != 0
}

fn corners(tree: &MeshTree, triangle: u32) -> [DVec3; 3] {
    tree.mesh().corners(triangle as usize).map(|p| p - tree.center())
}

/// Crossings of the ray with the surface; None when one is too near an edge to be certain.
fn count_crossings(tree: &MeshTree, from: DVec3, direction: DVec3) -> Option<u32> {
    let start = from / tree.unit();
    let direction = direction.normalize();
    let mut stack = vec![(0usize, 0usize)];
    let mut count = 0;
    while let Some((index, lane)) = stack.pop() {
        let node = &tree.nodes[index];
        let boxed = node.oriented_box(lane);
        let center =
            DVec3::from_array([0, 1, 2].map(|k| f64::from(node.origin[k]) + f64::from(boxed.center[k])));
        let to = center - start;
        let radius = f64::from(boxed.radius) * (1.0 + 1e-6) + 1e-12;
        let along = to.dot(direction);
        if along < -radius || to.length_squared() - along * along > radius * radius {
            continue;
        }
        match node.below(lane) {
            Below::Triangle(triangle) => count += crosses(from, direction, &corners(tree, triangle))?,
            Below::Node(child) => {
                let used = tree.nodes[child as usize].used as usize;
                stack.extend((0..used.min(WIDTH)).map(|lane| (child as usize, lane)));
            }
        }
    }
    Some(count)
}

/// 1 when the ray crosses the inside of the triangle, 0 when it passes by, None when that is not certain.
fn crosses(from: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> Option<u32> {
    let [a, b, c] = corners.map(|p| p - from);
    let side = |p: DVec3, q: DVec3| p.cross(q).dot(direction);
    let (u, v, w) = (side(a, b), side(b, c), side(c, a));
    let size = a.length().max(b.length()).max(c.length());
    let slack = CLEARANCE * size * size;
    let (low, high) = (u.min(v).min(w), u.max(v).max(w));
    if low < -slack && high > slack {
        return Some(0);
    }
    if low <= slack && high >= -slack {
        // Near an edge's line on the inner side of the others, or edge-on.
        let ahead = a.dot(direction).max(b.dot(direction)).max(c.dot(direction));
        return if ahead < 0.0 { Some(0) } else { None };
    }
    let normal = (b - a).cross(c - a);
    // The plane is at distance t along the ray, a·normal = t direction·normal.
    Some(u32::from(a.dot(normal) * direction.dot(normal) > 0.0))
}

/// Winding number of the surface about the point: the sum of the signed solid angles over 4π.
fn winding(tree: &MeshTree, from: DVec3) -> f64 {
    let mut turns = 0.0;
    for triangle in 0..tree.mesh().triangle_count() as u32 {
        let [a, b, c] = corners(tree, triangle).map(|p| (p - from).normalize_or_zero());
        let volume = a.cross(b).dot(c);
        let shape = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        turns += angle_of(volume, shape);
    }
    turns / (2.0 * core::f64::consts::PI)
}

/// The angle of the vector (x, y) in (−π, π], to about 1e-4: the sum above is rounded to an integer.
fn angle_of(y: f64, x: f64) -> f64 {
    use core::f64::consts::{FRAC_PI_2, PI};
    let ratio = if x.abs() > y.abs() { y.abs() / x.abs() } else { x.abs() / y.abs().max(f64::MIN_POSITIVE) };
    let z = ratio * ratio;
    let angle = ratio * (0.999_866 - z * (0.330_299_5 - z * (0.180_141 - z * (0.085_133 - z * 0.020_835_1))));
    let acute = if x.abs() > y.abs() { angle } else { FRAC_PI_2 - angle };
    let upper = if x < 0.0 { PI - acute } else { acute };
    if y < 0.0 { -upper } else { upper }
}
