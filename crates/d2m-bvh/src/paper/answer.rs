//! From the first root to the answer: the certified time and the contact's data.

use super::Moving;
use super::distance::{ClosestPair, enclose_distance};
use super::leaf_pair::Candidate;
use super::sphere_tree::SphereTree;
use super::step_back::{Disjoint, estimate_relative_velocity, step_back};
use crate::{Contact, Evidence, StartState};
use d2m_feature::paper::RelativeMotion;
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
    Some(describe(bodies, &disjoint, best, tolerance))
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
    Some(describe(bodies, &Disjoint { time, distance, pair }, best, tolerance))
}

fn describe(bodies: &[Moving<'_>; 2], disjoint: &Disjoint, best: &Candidate, tolerance: f64) -> Contact {
    let mut contact = contact_of_pair(bodies, disjoint.time, tolerance, &disjoint.pair);
    contact.time_hi = best.bracket.hi().max(disjoint.time);
    contact.separation = disjoint.distance.lower;
    contact.feature = feature_of(bodies, &disjoint.pair).unwrap_or(best.feature);
    contact
}

/// The contact of bodies that meet at the start.
pub(crate) fn contact_at_start(
    bodies: &[Moving<'_>; 2],
    time: f64,
    tolerance: f64,
    start: StartState,
    pair: &ClosestPair,
) -> Contact {
    let mut contact = contact_of_pair(bodies, time, tolerance, pair);
    contact.start = start;
    contact.separation = 0.0;
    if start == StartState::Contained {
        // Decided by certain signs while the surfaces are further apart than the tolerance.
        contact.evidence = Evidence::Crossing;
    }
    if start == StartState::Touching {
        contact.separation = (pair.detail.lower - pair.rounding).max(0.0);
    }
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
    Contact {
        time_lo: time,
        time_hi: time,
        evidence: if detail.upper + pair.rounding <= tolerance { Evidence::Near } else { Evidence::Early },
        separation: 0.0,
        tolerance,
        normal,
        point_a,
        point_b,
        feature: feature_of(bodies, pair).unwrap_or_else(|| any_feature(bodies, pair)),
        triangle_a: pair.triangle_a,
        triangle_b: pair.triangle_b,
        barycentric_a: detail.barycentric_a,
        barycentric_b: detail.barycentric_b,
        closing_speed: -normal.dot(estimate_relative_velocity(bodies, time, point_b)),
        start: StartState::Apart,
        left: None,
    }
}

/// A direction from A to B for triangles that meet: against B's outer normal, or any if B's triangle has collapsed.
fn estimate_normal(tree: &SphereTree, pair: &ClosestPair) -> DVec3 {
    let [a, b, c] = tree.corners(pair.triangle_b);
    -(b - a).cross(c - a).normalize_or((a - pair.corners_a[0]).normalize_or(DVec3::X))
}

/// The features on which the closest points lie, where they are a vertex and a face or two edges.
fn feature_of(bodies: &[Moving<'_>; 2], pair: &ClosestPair) -> Option<FeaturePair> {
    let corners = |i: usize, t: u32| bodies[i].body.mesh().triangles()[t as usize];
    let (a, b) = (corners(0, pair.triangle_a), corners(1, pair.triangle_b));
    let side = |t: [u32; 3], k: u8| {
        let (v, w) = (t[k as usize % 3], t[(k as usize + 1) % 3]);
        [v.min(w), v.max(w)]
    };
    match (pair.detail.feature_a, pair.detail.feature_b) {
        (TriangleFeature::Vertex(k), TriangleFeature::Face) => {
            Some(FeaturePair::VertexFace { vertex: a[k as usize % 3], face: pair.triangle_b })
        }
        (TriangleFeature::Face, TriangleFeature::Vertex(k)) => {
            Some(FeaturePair::FaceVertex { face: pair.triangle_a, vertex: b[k as usize % 3] })
        }
        (TriangleFeature::Edge(k), TriangleFeature::Edge(l)) => {
            Some(FeaturePair::EdgeEdge { edge_a: side(a, k), edge_b: side(b, l) })
        }
        _ => None,
    }
}

/// Any pair of features of the two triangles.
fn any_feature(bodies: &[Moving<'_>; 2], pair: &ClosestPair) -> FeaturePair {
    let vertex = bodies[0].body.mesh().triangles()[pair.triangle_a as usize][0];
    FeaturePair::VertexFace { vertex, face: pair.triangle_b }
}
