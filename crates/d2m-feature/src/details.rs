//! Witness points, normal, weights and closing speed at one time, in plain floating point.
use crate::closest::{self, ClosestPair};
use crate::contact::ContactDetails;
use crate::features::Features;
use crate::path::direction;
use crate::sphere::Sphere;
use d2m_motion::{Pose, RigidMotion, Twist};
use glam::DVec3;

/// Difference of two closest points relative to the features' size below which its direction is rounding.
const TOUCHING: f64 = 1e-7;

/// A body at one time.
struct BodyAt {
    pose: Pose,
    twist: Twist,
}

impl BodyAt {
    fn new(motion: &dyn RigidMotion, time: f64) -> Self {
        let (pose, twist) = motion.pose_and_twist(time);
        Self { pose, twist }
    }

    /// Velocity of the body point that is at `world`.
    fn velocity(&self, world: DVec3) -> DVec3 {
        self.twist.velocity_of(world - self.pose.translation)
    }
}

/// What counts where the closest points are so near that their difference has no direction.
struct Shape {
    /// Normal of the face, or common normal of the edges; zero if there is none.
    normal: DVec3,
    /// Size of the features.
    size: f64,
}

/// Where and how features of A and B touch.
pub(crate) fn of(features: &Features, [a, b]: [&dyn RigidMotion; 2], time: f64) -> ContactDetails {
    match features {
        Features::PointTriangle(point, triangle) => point_triangle(a, b, *point, triangle, time),
        Features::TrianglePoint(triangle, point) => point_triangle(b, a, *point, triangle, time).reversed(),
        Features::Edges(edge_a, edge_b) => edge_edge(a, b, *edge_a, *edge_b, time),
        Features::Spheres(sphere_a, sphere_b) => sphere_sphere(a, b, *sphere_a, *sphere_b, time),
    }
}

fn point_triangle(
    a: &dyn RigidMotion,
    b: &dyn RigidMotion,
    point: DVec3,
    triangle: &[DVec3; 3],
    time: f64,
) -> ContactDetails {
    let [on_a, on_b] = [a, b].map(|motion| BodyAt::new(motion, time));
    let p = on_a.pose.transform_point(point);
    let vertices = triangle.map(|v| on_b.pose.transform_point(v));
    let normal = direction((vertices[1] - vertices[0]).cross(vertices[2] - vertices[0]));
    let pair = closest::point_triangle(p, &vertices, normal);
    let size = (vertices[1] - vertices[0]).length().max((vertices[2] - vertices[0]).length());
    let point_b = vertices[0] * pair.b[0] + vertices[1] * pair.b[1] + vertices[2] * pair.b[2];
    finish([on_a, on_b], [p, point_b], &pair, &Shape { normal, size }, time)
}

fn edge_edge(
    a: &dyn RigidMotion,
    b: &dyn RigidMotion,
    edge_a: [DVec3; 2],
    edge_b: [DVec3; 2],
    time: f64,
) -> ContactDetails {
    let [on_a, on_b] = [a, b].map(|motion| BodyAt::new(motion, time));
    let [a0, a1] = edge_a.map(|v| on_a.pose.transform_point(v));
    let [b0, b1] = edge_b.map(|v| on_b.pose.transform_point(v));
    let (e, d) = ((a1 - a0) * 0.5, (b1 - b0) * 0.5);
    let pair = closest::segment_segment((a0 + a1) * 0.5 - (b0 + b1) * 0.5, e, d);
    let (point_a, point_b) = (a0 * pair.a[0] + a1 * pair.a[1], b0 * pair.b[0] + b1 * pair.b[1]);
    let shape = Shape { normal: direction(e.cross(d)), size: e.length().max(d.length()) };
    finish([on_a, on_b], [point_a, point_b], &pair, &shape, time)
}

fn sphere_sphere(
    a: &dyn RigidMotion,
    b: &dyn RigidMotion,
    sphere_a: Sphere,
    sphere_b: Sphere,
    time: f64,
) -> ContactDetails {
    let [on_a, on_b] = [a, b].map(|motion| BodyAt::new(motion, time));
    let (center_a, center_b) =
        (on_a.pose.transform_point(sphere_a.center), on_b.pose.transform_point(sphere_b.center));
    let normal = (center_b - center_a).normalize_or_zero();
    let (point_a, point_b) = (center_a + normal * sphere_a.radius, center_b - normal * sphere_b.radius);
    let weights = [1.0, 0.0, 0.0];
    let closing_speed = normal.dot(on_a.velocity(point_a) - on_b.velocity(point_b));
    ContactDetails {
        time,
        point_a,
        point_b,
        normal,
        barycentric_a: weights,
        barycentric_b: weights,
        closing_speed,
    }
}

fn finish(
    [a, b]: [BodyAt; 2],
    [point_a, point_b]: [DVec3; 2],
    pair: &ClosestPair,
    shape: &Shape,
    time: f64,
) -> ContactDetails {
    let relative = a.velocity(point_a) - b.velocity(point_b);
    let difference = -pair.difference;
    let normal = if difference.length() > TOUCHING * shape.size {
        difference.normalize_or_zero()
    } else {
        let candidate = if shape.normal == DVec3::ZERO { -pair.separating } else { shape.normal };
        let normal = candidate.normalize_or_zero();
        // They approach along the normal from A to B.
        if normal.dot(relative) < 0.0 { -normal } else { normal }
    };
    ContactDetails {
        time,
        point_a,
        point_b,
        normal,
        barycentric_a: pair.a,
        barycentric_b: pair.b,
        closing_speed: normal.dot(relative),
    }
}
