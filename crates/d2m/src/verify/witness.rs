//! The data of a contact that are no certificate: points, weights, normal, features, speed. They are compared with its triangles.

use super::rounding::Scale;
use crate::{Clearance, Contact, Moving, QueryOptions, StartState, Window};
use d2m_feature::{FeaturePair, triangle_distance};
use glam::DVec3;

/// Roundings of weights, of a unit vector and of a speed, in units of 2⁻⁵².
const UNITS: f64 = 64.0 * f64::EPSILON;
/// A closing speed is that along a normal, whose own rounding is not bounded where the triangles all but touch: no promise, so any value
/// that is right to six digits of the greatest speed is taken.
const PART_OF_SPEED: f64 = 1e-6;

/// Is it more than it may be? Of what is no number nothing is known.
fn is_off(x: f64, most: f64) -> bool {
    x.is_nan() || x > most
}

/// The first field of a contact that is not that of its triangles at its time, up to rounding; what it says of bodies that are inside each
/// other or cross is not compared.
///
/// Points are those of the triangles within the tolerance and the rounding of the scene. The normal separates the triangles by what the
/// separation says, up to four times that: it is the direction of their closest points, and no other direction separates them as far.
pub fn witness_fault(
    bodies: &[Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    contact: &Contact,
) -> Option<&'static str> {
    let meshes = bodies.map(|moving| moving.body.mesh());
    let numbers = [contact.triangle_a, contact.triangle_b];
    for (k, name) in ["triangle_a", "triangle_b"].into_iter().enumerate() {
        if numbers[k] as usize >= meshes[k].triangle_count() {
            return Some(name);
        }
    }
    // What is inside a body has no closest points.
    if contact.start == StartState::Contained {
        return None;
    }
    let ids = [0, 1].map(|k| meshes[k].triangles()[numbers[k] as usize]);
    let of = |k: usize, vertices: &[u32]| vertices.iter().all(|v| ids[k].contains(v));
    let is_theirs = match contact.feature {
        FeaturePair::VertexFace { vertex, face } => of(0, &[vertex]) && face == numbers[1],
        FeaturePair::FaceVertex { face, vertex } => face == numbers[0] && of(1, &[vertex]),
        FeaturePair::EdgeEdge { edge_a, edge_b } => of(0, &edge_a) && of(1, &edge_b),
    };
    if !is_theirs {
        return Some("feature");
    }
    let off = contact.tolerance + Scale::new(bodies, window, options, contact.time_lo).world_error;
    let states = bodies.map(|moving| moving.motion.pose_and_twist(contact.time_lo));
    let placed =
        [0, 1].map(|k| meshes[k].corners(numbers[k] as usize).map(|p| states[k].0.transform_point(p)));
    let points = [contact.point_a, contact.point_b];
    let weights = [contact.barycentric_a, contact.barycentric_b];
    let outward = [contact.normal * bodies[0].radius, contact.normal * -bodies[1].radius];
    for (k, names) in [["point_a", "barycentric_a"], ["point_b", "barycentric_b"]].into_iter().enumerate() {
        let is_weight = |w: &f64| (-UNITS..=1.0 + UNITS).contains(w);
        if !weights[k].iter().all(is_weight) || (weights[k].iter().sum::<f64>() - 1.0).abs() > UNITS {
            return Some(names[1]);
        }
        let on_triangle: DVec3 = (0..3).map(|i| placed[k][i] * weights[k][i]).sum();
        if is_off(points[k].distance(on_triangle + outward[k]), off) {
            return Some(names[0]);
        }
    }
    if contact.start == StartState::Overlapping {
        return None;
    }
    let between = (bodies[0].radius + bodies[1].radius) + contact.separation;
    if is_off((contact.normal.length() - 1.0).abs(), UNITS) {
        return Some("normal");
    }
    // Triangles that all but touch have no direction of closest points; of rounded bodies that overlap the depth is not stated.
    let along = |k: usize| placed[k].map(|p| contact.normal.dot(p - placed[0][0]));
    let [a, b] = [along(0), along(1)];
    let gap = b.into_iter().fold(f64::INFINITY, f64::min) - a.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let is_known = contact.separation > 0.0 && between > 4.0 * off;
    if is_known && gap < between - 4.0 * off {
        return Some("normal");
    }
    let velocity = |k: usize| states[k].1.velocity_of(points[k] - states[k].0.translation);
    let closing = (velocity(0) - velocity(1)).dot(contact.normal);
    let turning = |k: usize| states[k].1.angular.length() * (points[k] - states[k].0.translation).length();
    let fastest = velocity(0).length() + velocity(1).length() + turning(0) + turning(1);
    if (closing - contact.closing_speed).abs() <= PART_OF_SPEED * fastest {
        None
    } else {
        Some("closing_speed")
    }
}

/// The same of a clearance: its points are on its triangles at its time, and as far apart as its upper end, up to `error`, and up to `above`
/// where they are less than that.
pub(super) fn clearance_fault(
    bodies: &[Moving<'_>; 2],
    answer: &Clearance,
    error: f64,
    above: f64,
) -> Option<&'static str> {
    let (numbers, points) = ([answer.triangle_a, answer.triangle_b], [answer.point_a, answer.point_b]);
    let inward = [answer.normal * -bodies[0].radius, answer.normal * bodies[1].radius];
    for (k, names) in [["triangle_a", "point_a"], ["triangle_b", "point_b"]].into_iter().enumerate() {
        let mesh = bodies[k].body.mesh();
        if numbers[k] as usize >= mesh.triangle_count() {
            return Some(names[0]);
        }
        let (pose, _) = bodies[k].motion.pose_and_twist(answer.time);
        let placed = mesh.corners(numbers[k] as usize).map(|p| pose.transform_point(p));
        let off = triangle_distance(&[points[k] + inward[k]; 3], &placed).lower;
        if is_off(off, error) {
            return Some(names[1]);
        }
    }
    let between = points[0].distance(points[1]);
    let is_attained = between <= answer.upper + 2.0 * error && answer.upper <= between + 2.0 * error + above;
    if is_attained { None } else { Some("clearance") }
}
