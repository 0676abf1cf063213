//! A sphere that holds a body and moves with constant velocity.

use crate::Body;
use d2m_feature::MovingSphere;
use d2m_interval::{Interval, IntervalVec3};

/// Holds the body and a margin around it where its motion is known, for times since `start`; none if its twist is not constant.
///
/// The reference point of a constant twist moves in a straight line, and every point of the body is within
/// |center of the mesh − reference point| + radius of the mesh + radius of the body about its mesh of it.
pub(crate) fn sphere_about(body: &Body, start: f64, margin: f64) -> Option<MovingSphere> {
    let twist = body.motion().constant_twist()?;
    let since = Interval::point(start) - Interval::point(twist.reference_time());
    let path = IntervalVec3::point(twist.linear_velocity()) * since + twist.position();
    let off = IntervalVec3::point(body.tree().center()) - twist.at();
    let center = path.mid();
    let rounded = (path - center).norm();
    let own = Interval::point(body.tree().radius()) + Interval::point(body.radius());
    let reach = own + Interval::point(margin);
    let radius = (off.norm() + rounded + reach).hi();
    let sphere = MovingSphere { center, velocity: twist.linear_velocity(), radius };
    (radius.is_finite() && body.radius() >= 0.0).then_some(sphere)
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_bvh::MeshTree;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DVec3;
    use std::sync::Arc;

    #[test]
    fn nothing_is_known_of_where_a_body_is_whose_place_overflows() {
        let huge =
            ConstantTwist::REST.with_position(DVec3::X * 1e200).with_linear_velocity(DVec3::X * -1e200);
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box").unwrap()));
        let of = |motion: ConstantTwist| sphere_about(&Body::new(Arc::clone(&tree), motion), 2.0, 0.0);
        assert!(of(huge.with_reference_time(-1e200)).is_none() && of(ConstantTwist::REST).is_some());
    }

    #[test]
    fn a_sphere_holds_its_body_at_all_times() {
        let mut random = KnuthRandom(17);
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("gear?triangles=500").unwrap()));
        for round in 0..200 {
            let offset = random.vector() * [0.0, 1e5][round % 2];
            let twist = ConstantTwist::REST
                .with_position(random.vector() + offset)
                .with_orientation(glam::DQuat::from_scaled_axis(random.vector() * 3.0))
                .with_linear_velocity(random.vector() * 9.0)
                .with_angular_velocity(random.vector() * 40.0)
                .with_at(random.vector() * 2.0)
                .with_reference_time([0.0, -1e3][round % 2]);
            let body = Body::new(Arc::clone(&tree), twist);
            let start = random.vector().x * 3.0;
            let sphere = sphere_about(&body, start, 0.0).unwrap();
            for k in 0..20 {
                let since = f64::from(k) * 0.1;
                let pose = twist.pose_and_twist(start + since).0;
                let center = sphere.center + sphere.velocity * since;
                for &vertex in tree.mesh().vertices().iter().step_by(7) {
                    let point = pose.rotation * (vertex - pose.at) + pose.translation;
                    assert!(point.distance(center) <= sphere.radius * (1.0 + 1e-9), "round {round}");
                }
            }
        }
    }
}
