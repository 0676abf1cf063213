//! Points inside of both of two solids.

use super::super::collide::surfaces_are_apart;
use super::super::containment::held_by;
use super::super::node_pair::RestingScene;
use super::axis::TouchingPair;
use crate::meter::{Exhausted, Meter};
use crate::{MeshTree, Posed, TriMesh};
use glam::DVec3;

/// Pairs about which points are tried.
const MOST_PAIRS: usize = 4;
/// How far from a face a point is tried, in parts of the size of its triangle: a quarter, and 2⁻⁵ and 2⁻¹⁰ for thin overlaps.
const DEPTHS: [f64; 3] = [0.25, 0.03125, 0.000_976_562_5];

/// Is a point found that is proven to be inside of both solids, further from their surfaces than rounding reaches?
pub(super) fn share_a_point_inside(
    (bodies, blur): ([Posed<'_>; 2], f64),
    scene: &RestingScene<'_>,
    pairs: &[TouchingPair],
    meter: &mut Meter,
) -> Result<bool, Exhausted> {
    let about_faces = points(pairs).map(|placed| placed * scene.unit + scene.trees[1].center());
    for point in about_faces.chain(middle_of_boxes(&bodies)) {
        // The point of B's own frame, whatever it is: exact from here on.
        let Ok(mesh) = TriMesh::point(point) else { continue };
        let tree = MeshTree::new(mesh);
        let point = Posed::new(&tree, bodies[1].pose);
        if holds(bodies[0], point, blur, meter)? && holds(bodies[1], point, blur, meter)? {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Under and above faces of some pairs, in working coordinates.
fn points(pairs: &[TouchingPair]) -> impl Iterator<Item = DVec3> {
    let step = (pairs.len() / MOST_PAIRS).max(1);
    pairs.iter().step_by(step).take(MOST_PAIRS).flat_map(|pair| &pair.corners).flat_map(|&[p, q, r]| {
        let middle = (p + q + r) / 3.0;
        let size = p.distance(q).max(q.distance(r)).max(r.distance(p));
        let normal = (q - p).cross(r - p).normalize_or_zero();
        DEPTHS
            .into_iter()
            .flat_map(move |depth| [-depth, depth].map(|depth| middle + normal * (depth * size)))
    })
}

/// The middle of what the bounding boxes of both share, in B's frame: where boxes overlap by little in all of a face, no point about the
/// middles of their triangles is inside of both.
///
/// ```
/// use d2m_mesh::at_rest::middle_of_boxes;
/// use d2m_mesh::{MeshTree, Posed, TriMesh};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let tree = MeshTree::new(TriMesh::segment(DVec3::ZERO, DVec3::X * 3.0)?);
/// let moved = Posed::new(&tree, Pose { translation: DVec3::X, ..Pose::IDENTITY });
/// assert_eq!(middle_of_boxes(&[Posed::at_rest(&tree), moved]), Some(DVec3::X)); // 2 in the world
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
pub fn middle_of_boxes(bodies: &[Posed<'_>; 2]) -> Option<DVec3> {
    let [a, b] = bodies.map(|body| body.pose);
    let back = |p: DVec3| b.rotation.conjugate() * (a.transform_point(p) - b.translation) + b.at;
    let vertices = |k: usize| bodies[k].body.mesh().vertices().iter();
    let bounds = |points: &mut dyn Iterator<Item = DVec3>| {
        points.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    };
    let (low_a, high_a) = bounds(&mut vertices(0).map(|&p| back(p)));
    let (low_b, high_b) = bounds(&mut vertices(1).copied());
    let (low, high) = (low_a.max(low_b), high_a.min(high_b));
    (low.cmple(high).all() && (high - low).is_finite()).then(|| low * 0.5 + high * 0.5)
}

/// Is the point, a mesh of its own, proven to be in the solid, and not on its surface, wherever both are within `blur`, a length, of where
/// the poses place them?
///
/// ```
/// use d2m_mesh::at_rest::holds;
/// use d2m_mesh::{MeshTree, Meter, Posed, TriMesh};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let solid = MeshTree::new(TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?);
/// let point = MeshTree::new(TriMesh::point(DVec3::splat(0.125))?);
/// let held = |blur| holds(Posed::at_rest(&solid), Posed::at_rest(&point), blur, &mut Meter::unlimited());
/// assert_eq!((held(0.0), held(0.25)), (Ok(true), Ok(false))); // 0.125 from three faces
/// assert_eq!([held(f64::INFINITY), held(f64::NAN)], [Ok(false); 2]); // anywhere
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Exhausted`] when the meter runs out.
pub fn holds(body: Posed<'_>, point: Posed<'_>, blur: f64, meter: &mut Meter) -> Result<bool, Exhausted> {
    let Ok(scene) = RestingScene::try_blurred(body, point, blur) else { return Ok(false) };
    Ok(surfaces_are_apart(&scene, meter)? && held_by(&scene, 0, meter)?.is_some())
}
