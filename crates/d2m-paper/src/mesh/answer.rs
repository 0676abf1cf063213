//! From the first root to the answer: the certified time and the contact's data.

use super::Moving;
use super::distance::{ClosestPair, are_within, enclose_distance};
use super::leaf_pair::Candidate;
use super::sphere_tree::SphereTree;
use super::step_back::{Disjoint, estimate_relative_velocity, step_back};
use crate::feature::RelativeMotion;
use d2m_bvh::{Contact, Evidence};
use d2m_feature::{FeaturePair, TriangleFeature};
use d2m_interval::Interval;
use d2m_motion::Pose;
use glam::DVec3;

/// The contact of `best`, whose bracket nothing precedes from `start` on, reported at a time at which the bodies are certainly disjoint.
pub(crate) fn certified_contact(
    bodies: &[Moving<'_>; 2],
    relative: &RelativeMotion<'_>,
    start: f64,
    best: &Candidate,
    tolerance: f64,
) -> Option<Contact> {
    let root = best.bracket.lo();
    let guess = {
        let (pose, _) = bodies[1].motion.pose_and_twist(root);
        let middle = bodies[1].body.corners(best.triangle_b).iter().sum::<DVec3>() / 3.0;
        estimate_relative_velocity(bodies, root, pose.transform_point(middle)).length()
    };
    let disjoint = step_back(bodies, relative, Interval::new(start, root), guess, tolerance)?;
    Some(describe(bodies, relative, &disjoint, best, tolerance))
}

/// Capoeira mode: the bodies as they stand where the spheres of two leaves begin to overlap.
pub(crate) fn early_contact(
    bodies: &[Moving<'_>; 2],
    relative: &RelativeMotion<'_>,
    best: &Candidate,
    tolerance: f64,
) -> Option<Contact> {
    let time = best.bracket.lo();
    let distance = enclose_distance(bodies[0].body, bodies[1].body, &relative.placement(time), f64::INFINITY);
    let pair = distance.closest?;
    Some(describe(bodies, relative, &Disjoint { time, distance, pair }, best, tolerance))
}

fn describe(
    bodies: &[Moving<'_>; 2],
    relative: &RelativeMotion<'_>,
    disjoint: &Disjoint,
    best: &Candidate,
    tolerance: f64,
) -> Contact {
    let mut contact = contact_of_pair(bodies, disjoint.time, tolerance, &disjoint.pair);
    // A bracket holds what may be a root: that the bodies have met by its end is measured.
    let end = best.bracket.hi().max(disjoint.time);
    let ([a, b], at_end) = (bodies.each_ref().map(|body| body.body), relative.placement(end));
    if are_within(a, b, &at_end, tolerance, [disjoint.pair.triangle_a, disjoint.pair.triangle_b]) {
        (contact.time_hi, contact.evidence) = (end, Evidence::Near);
    }
    contact.separation = disjoint.distance.lower;
    contact
}

fn contact_of_pair(bodies: &[Moving<'_>; 2], time: f64, tolerance: f64, pair: &ClosestPair) -> Contact {
    let (pose, _): (Pose, _) = bodies[1].motion.pose_and_twist(time);
    let detail = &pair.detail;
    let direction = if detail.direction == DVec3::ZERO {
        estimate_normal(bodies[1].body, pair)
    } else {
        detail.direction
    };
    let normal = pose.transform_vector(direction).normalize_or(DVec3::X);
    let (point_a, point_b) = (pose.transform_point(detail.point_a), pose.transform_point(detail.point_b));
    let mut contact = Contact::unproven(time, feature_of(bodies, pair), [pair.triangle_a, pair.triangle_b]);
    contact.tolerance = tolerance;
    contact.normal = normal;
    (contact.point_a, contact.point_b) = (point_a, point_b);
    (contact.barycentric_a, contact.barycentric_b) = (detail.barycentric_a, detail.barycentric_b);
    contact.closing_speed = -normal.dot(estimate_relative_velocity(bodies, time, point_b));
    contact
}

/// A direction from A to B for triangles that meet: against B's outer normal, or any if B's triangle has collapsed.
fn estimate_normal(tree: &SphereTree, pair: &ClosestPair) -> DVec3 {
    let [a, b, c] = tree.corners(pair.triangle_b);
    -(b - a).cross(c - a).normalize_or((a - pair.corners_a[0]).normalize_or(DVec3::X))
}

/// The features on which the closest points lie; where a face meets an edge or a face, a corner stands for the other triangle.
fn feature_of(bodies: &[Moving<'_>; 2], pair: &ClosestPair) -> FeaturePair {
    let corners = |i: usize, t: u32| bodies[i].body.mesh().triangles()[t as usize];
    let (a, b) = (corners(0, pair.triangle_a), corners(1, pair.triangle_b));
    let side = |t: [u32; 3], k: u8| {
        let (v, w) = (t[k as usize % 3], t[(k as usize + 1) % 3]);
        [v.min(w), v.max(w)]
    };
    let vertex_face = |k: u8| FeaturePair::VertexFace { vertex: a[k as usize % 3], face: pair.triangle_b };
    let face_vertex = |k: u8| FeaturePair::FaceVertex { face: pair.triangle_a, vertex: b[k as usize % 3] };
    match (pair.detail.feature_a, pair.detail.feature_b) {
        (TriangleFeature::Edge(k), TriangleFeature::Edge(l)) => {
            FeaturePair::EdgeEdge { edge_a: side(a, k), edge_b: side(b, l) }
        }
        (TriangleFeature::Vertex(k), _) => vertex_face(k),
        (_, TriangleFeature::Vertex(k)) => face_vertex(k),
        (TriangleFeature::Face, _) => face_vertex(0),
        (_, TriangleFeature::Face) => vertex_face(0),
    }
}
