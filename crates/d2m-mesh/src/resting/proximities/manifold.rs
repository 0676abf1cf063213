//! At most four of the points that push in the same direction.

use super::Proximity;
use d2m_lanes::power_of_two;
use glam::DVec3;

/// A contact manifold: of all proximities whose normals differ by at most `normal_tolerance` (the length of the
/// difference of two unit vectors, about the angle in radians) at most four, and among them the closest one.
///
/// Promise: deterministic; a subset, ordered by cluster and distance. One of a cluster's points is its closest, or as close
/// as makes no difference (2⁻³⁰ of the cluster's width); the second is the furthest from it across the normal, the third
/// and the fourth span the largest areas with them.
///
/// ```
/// use d2m_mesh::{MeshTree, Posed, TriMesh, proximities, reduce_proximities};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
/// let sheet = MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]])?);
/// let above = Pose { translation: DVec3::Z * 0.5, ..Pose::IDENTITY };
/// let all = proximities(Posed::at_rest(&sheet), Posed::new(&sheet, above), 1.0)?;
/// let manifold = reduce_proximities(&all, 0.1);
/// assert_eq!(manifold.len(), 3);
/// assert!(manifold.iter().all(|p| all.contains(p)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn reduce_proximities(proximities: &[Proximity], normal_tolerance: f64) -> Vec<Proximity> {
    let mut left: Vec<Proximity> = proximities.to_vec();
    // Stable: what is equally far stays in the order given.
    left.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mut manifold = Vec::new();
    while let Some(&closest) = left.first() {
        let same = |p: &Proximity| (p.normal - closest.normal).length() <= normal_tolerance;
        let mut cluster = vec![closest];
        cluster.extend(left[1..].iter().filter(|p| same(p)));
        left = left[1..].iter().filter(|p| !same(p)).copied().collect();
        manifold.extend(largest_area(&cluster));
    }
    manifold
}

/// Distances that differ by less than this part of the width of a patch are those of parallel faces: a choice, which
/// nothing certified rests on.
const NO_DIFFERENCE: f64 = power_of_two(-30);

/// Four of a cluster that starts with its closest member.
fn largest_area(cluster: &[Proximity]) -> Vec<Proximity> {
    if cluster.len() <= 4 {
        return cluster.to_vec();
    }
    let normal = cluster[0].normal;
    let from_closest = |p: &Proximity| p.point_a.distance(cluster[0].point_a);
    let width = from_closest(&cluster[furthest(cluster, from_closest)]);
    let close = cluster[0].distance + NO_DIFFERENCE * width;
    // The furthest from any point is a corner of the patch.
    let start = furthest(cluster, |p| if p.distance <= close { from_closest(p) } else { -1.0 });
    let first = cluster[start].point_a;
    let across = |p: &Proximity| {
        let to = p.point_a - first;
        to - normal * to.dot(normal)
    };
    let second = furthest(cluster, |p| across(p).length_squared());
    let side = across(&cluster[second]);
    let third = furthest(cluster, |p| normal.dot(side.cross(across(p))).abs());
    let height = |p: &Proximity| normal.dot(side.cross(across(p)));
    let above = height(&cluster[third]);
    let tip = across(&cluster[third]);
    // What a fourth point adds to the triangle: beyond its sides, each seen from outside.
    let turn = above.signum();
    let beyond = |from: DVec3, to: DVec3, p: DVec3| -turn * normal.dot((to - from).cross(p - from));
    let fourth = furthest(cluster, |p| {
        let at = across(p);
        beyond(DVec3::ZERO, side, at).max(beyond(side, tip, at)).max(beyond(tip, DVec3::ZERO, at))
    });
    let mut chosen = vec![start, second, third, fourth];
    chosen.sort_unstable();
    chosen.dedup();
    chosen.into_iter().map(|index| cluster[index]).collect()
}

/// The member of the largest measure; the first of equals.
fn furthest(cluster: &[Proximity], measure: impl Fn(&Proximity) -> f64) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (index, proximity) in cluster.iter().enumerate() {
        let size = measure(proximity);
        if size > best.1 {
            best = (index, size);
        }
    }
    best.0
}
