//! How far surfaces are from points and lines of their own axes.

use d2m_bvh::{DistanceOptions, MeshTree, Posed, Solid, TriMesh, distance_within};
use d2m_motion::Pose;
use glam::DVec3;

/// No point of the body's surface is nearer to its center; zero where that does not show.
pub(crate) fn cavity(tree: &MeshTree, center: DVec3) -> f64 {
    let Ok(point) = TriMesh::point(center) else { return 0.0 };
    lower_bound(&MeshTree::new(point), tree).unwrap_or(0.0)
}

/// How near the body's surface is to each of the lines through its center along the axes of the mesh, so far each way; zero where that does not show.
pub(crate) fn bores(tree: &MeshTree, center: DVec3, reach: f64) -> [f64; 3] {
    DVec3::AXES.map(|axis| free(tree, [center - axis * reach, center + axis * reach]))
}

/// Of the distance of two surfaces in the same axes; none where no query is possible.
fn lower_bound(a: &MeshTree, b: &MeshTree) -> Option<f64> {
    let options = DistanceOptions::default().with_solid(Solid::Surface);
    let posed = [a, b].map(|tree| Posed::new(tree, Pose::IDENTITY));
    let found = distance_within(posed[0], posed[1], &options);
    found.ok().flatten().map(|found| found.lower)
}

/// The distance of a surface from a line, mesh frame; zero where that does not show.
pub(crate) fn free(tree: &MeshTree, [start, end]: [DVec3; 2]) -> f64 {
    let Ok(line) = TriMesh::segment(start, end) else { return 0.0 };
    lower_bound(&MeshTree::new(line), tree).unwrap_or(0.0)
}
