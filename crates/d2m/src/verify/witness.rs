//! The data of a contact that are no certificate: points, weights, normal, features, speed. They are compared with its triangles.

use super::rounding::Scale;
use crate::{Clearance, Contact, Moving, QueryOptions, StartState, Window};
use d2m_feature::{FeaturePair, triangle_distance};
use d2m_motion::length;
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
    if !are_features_of(bodies, numbers, contact.feature) {
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
        if is_off(length(points[k] - (on_triangle + outward[k])), off) {
            return Some(names[0]);
        }
    }
    if contact.start == StartState::Overlapping {
        return None;
    }
    let between = (bodies[0].radius + bodies[1].radius) + contact.separation;
    // Of rounded bodies that overlap the depth is not stated.
    let distance = if contact.separation > 0.0 { between } else { 0.0 };
    if !is_normal(contact.normal, &placed, distance, [4.0 * off; 2]) {
        return Some("normal");
    }
    let velocity = |k: usize| states[k].1.velocity_of(points[k] - states[k].0.translation);
    let closing = (velocity(0) - velocity(1)).dot(contact.normal);
    let turning = |k: usize| length(states[k].1.angular) * length(points[k] - states[k].0.translation);
    let fastest = length(velocity(0)) + length(velocity(1)) + turning(0) + turning(1);
    if (closing - contact.closing_speed).abs() <= PART_OF_SPEED * fastest {
        None
    } else {
        Some("closing_speed")
    }
}

/// Are these features of these triangles?
fn are_features_of(bodies: &[Moving<'_>; 2], numbers: [u32; 2], feature: FeaturePair) -> bool {
    let of = |k: usize, vertices: &[u32]| {
        let ids = bodies[k].body.mesh().triangles()[numbers[k] as usize];
        vertices.iter().all(|vertex| ids.contains(vertex))
    };
    match feature {
        FeaturePair::VertexFace { vertex, face } => of(0, &[vertex]) && face == numbers[1],
        FeaturePair::FaceVertex { face, vertex } => face == numbers[0] && of(1, &[vertex]),
        FeaturePair::EdgeEdge { edge_a, edge_b } => of(0, &edge_a) && of(1, &edge_b),
    }
}

/// Does a unit normal separate two placed triangles that are so far apart by no less than that, up to `beside`? Those that are no further apart than
/// `error` have no direction of closest points.
fn is_normal(normal: DVec3, [a, b]: &[[DVec3; 3]; 2], distance: f64, [error, beside]: [f64; 2]) -> bool {
    if is_off((normal.length() - 1.0).abs(), UNITS) {
        return false;
    }
    let along = |p: &DVec3| normal.dot(*p - a[0]);
    let nearest = b.iter().map(along).fold(f64::INFINITY, f64::min);
    let furthest = a.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
    !(distance > error && nearest - furthest < distance - beside)
}

/// The triangles of a clearance at its time; none where there are none of these numbers.
fn placed_triangles(bodies: &[Moving<'_>; 2], answer: &Clearance) -> Option<[[DVec3; 3]; 2]> {
    let place = |k: usize, number: u32| {
        let mesh = bodies[k].body.mesh();
        let (pose, _) = bodies[k].motion.pose_and_twist(answer.time);
        let is_there = (number as usize) < mesh.triangle_count();
        is_there.then(|| mesh.corners(number as usize).map(|p| pose.transform_point(p)))
    };
    Some([place(0, answer.triangle_a)?, place(1, answer.triangle_b)?])
}

/// Are the triangles of a clearance within this distance of each other, with the bodies' radii, at its time?
pub(super) fn are_near(bodies: &[Moving<'_>; 2], answer: &Clearance, distance: f64) -> bool {
    placed_triangles(bodies, answer).is_some_and(|[a, b]| {
        !is_off(triangle_distance(&a, &b).lower, bodies[0].radius + bodies[1].radius + distance)
    })
}

/// The first field of a clearance that is not that of its triangles at its time: its points are on them, and as far apart as its upper
/// end, up to `error`, and up to `above` where they are less than that; the normal, where it is known, separates them.
pub(super) fn clearance_fault(
    bodies: &[Moving<'_>; 2],
    answer: &Clearance,
    error: f64,
    above: f64,
) -> Option<&'static str> {
    let (numbers, points) = ([answer.triangle_a, answer.triangle_b], [answer.point_a, answer.point_b]);
    let inward = [answer.normal * -bodies[0].radius, answer.normal * bodies[1].radius];
    let Some(placed) = placed_triangles(bodies, answer) else { return Some("triangles") };
    if !are_features_of(bodies, numbers, answer.feature) {
        return Some("feature");
    }
    for (k, name) in ["point_a", "point_b"].into_iter().enumerate() {
        let off = triangle_distance(&[points[k] + inward[k]; 3], &placed[k]).lower;
        if is_off(off, error) {
            return Some(name);
        }
    }
    let radii = bodies[0].radius + bodies[1].radius;
    // Of rounded bodies that meet the meshes are within the radii; of triangles that cross nothing more is said.
    let does_cross = answer.upper == 0.0 && triangle_distance(&placed[0], &placed[1]).lower == 0.0;
    let [between, most, least] = if answer.upper > 0.0 {
        [length(points[0] - points[1]), answer.upper, answer.upper - above]
    } else {
        [length((points[0] + inward[0]) - (points[1] + inward[1])), radii + above, 0.0]
    };
    if !does_cross && (is_off(between, most + 2.0 * error) || is_off(least, between + 2.0 * error)) {
        return Some("clearance");
    }
    let distance = if answer.upper > above { between + radii } else { 0.0 };
    let is_known = answer.normal != DVec3::ZERO;
    // Of points that are off by no more the direction is off by that part of their distance, and so is what it says of points beside them.
    let [a, b] = &placed;
    let reach = a.iter().flat_map(|p| b.iter().map(|q| length(*q - *p))).fold(distance, f64::max);
    let beside = if distance > 0.0 { 4.0 * error * (reach / distance) } else { 4.0 * error };
    if is_known && !is_normal(answer.normal, &placed, distance, [4.0 * error, beside]) {
        return Some("normal");
    }
    None
}
