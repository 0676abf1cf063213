//! Joints and kinds that change between two steps: what is gone is gone, what is refused changes nothing, and what is let go goes on as it moved.

mod ground;

use d2m_dynamics::{
    Body, BodyId, Joint, JointKind, Kind, Mass, MassProperties, Motor, MotorTarget, Simulation,
    SimulationError, SimulationOptions,
};
use d2m_motion::{ConstantTwist, Pose};
use glam::{DMat3, DQuat, DVec3};
use ground::cube;
use std::sync::Arc;

fn weightless() -> Simulation {
    Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap()
}

/// The body of the last place goes, and its place with it: the step after was a panic, since the joint still looked for it there.
#[test]
fn joints_of_the_last_body_go_with_it() {
    for with_others in [false, true] {
        let mut simulation = weightless();
        let [a, b] = [0.0, 2.0]
            .map(|x| simulation.add(&Body::new("cube", cube()).with_position(DVec3::X * x)).unwrap());
        let joint = simulation.add_joint(&Joint::new(JointKind::Spherical, a, Some(b), DVec3::X)).unwrap();
        if with_others {
            let third = Body::new("third", cube()).with_position(DVec3::X * 6.0);
            let third = simulation.add(&third).unwrap();
            let far = Joint::new(JointKind::Spherical, b, Some(third), DVec3::X * 4.0);
            simulation.add_joint(&far).unwrap();
            simulation.step().unwrap();
            simulation.remove(third);
        }
        simulation.remove(b);
        simulation.step().unwrap();
        assert!(simulation.joint(joint).is_none() && simulation.ids().eq([a]));
        let after = simulation.snapshot();
        simulation.restore(&after).unwrap();
        simulation.step().unwrap();
    }
}

/// A joint with the world that is refused leaves no world behind.
#[test]
fn joints_that_are_refused_change_nothing() {
    let mut simulation = weightless();
    let wall = simulation.add(&Body::new("wall", cube()).with_kind(Kind::Static)).unwrap();
    let free = simulation.add(&Body::new("free", cube()).with_position(DVec3::X * 3.0)).unwrap();
    let before = (simulation.next_index(), simulation.snapshot());
    let hinge = |body: BodyId, point: DVec3| Joint::new(JointKind::Revolute, body, None, point);
    for refused in [
        hinge(free, DVec3::NAN),
        hinge(wall, DVec3::ZERO),
        hinge(free, DVec3::ZERO).with_axis(DVec3::ZERO),
        Joint::new(JointKind::Fixed, free, Some(free), DVec3::ZERO),
    ] {
        assert!(matches!(simulation.add_joint(&refused), Err(SimulationError::BadJoint { .. })));
        assert!((simulation.next_index(), simulation.snapshot()) == before);
    }
    assert_eq!(simulation.add_joint(&hinge(free, DVec3::ZERO)), Ok(0));
    assert_eq!(simulation.next_index(), before.0 + 1);
}

/// What turns on a motion about its middle and is let go has its center of mass elsewhere: its points go on as they moved.
#[test]
fn points_of_what_is_let_go_go_on_as_they_moved() {
    let (mass, center) = (2.0, DVec3::X * 0.4);
    let inertia = DMat3::from_diagonal(DVec3::splat(0.3));
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 2.0).with_linear_velocity(DVec3::Y);
    let [end, of] = [DVec3::X * 0.5, DVec3::new(-0.5, 0.5, 0.2)];
    let mut simulation = weightless();
    let body = Body::new("thrown", cube()).with_mass(Mass::Given(MassProperties { mass, center, inertia }));
    let thrown = simulation.add(&body.with_kind(Kind::Kinematic(Arc::new(turning)))).unwrap();
    for _ in 0..10 {
        simulation.step().unwrap();
    }
    let velocity = |simulation: &Simulation, point: DVec3| {
        let arm = simulation.pose(thrown).transform_point(point) - simulation.position(thrown);
        simulation.linear_velocity(thrown) + simulation.angular_velocity(thrown).cross(arm)
    };
    let before = [end, of].map(|point| velocity(&simulation, point));
    simulation.set_kind(thrown, Kind::Dynamic).unwrap();
    assert_eq!(simulation.center(thrown), center);
    for (point, before) in [end, of].into_iter().zip(before) {
        assert!((velocity(&simulation, point) - before).length() < 1e-12, "{before}");
    }
    let before = simulation.position(thrown);
    let linear = simulation.linear_velocity(thrown);
    simulation.step().unwrap();
    let way = simulation.options().step * linear;
    assert!((simulation.position(thrown) - before - way).length() < 1e-12);
}

/// The motor of a joint is taken off while its body is static, and does not go on when that is let go. Axes have any length but zero.
#[test]
fn motors_are_set_whatever_their_bodies_are() {
    for length in [5e-324, 1e-200, 1.0, 1e155, 1e308] {
        let mut simulation = weightless();
        let wheel = simulation.add(&Body::new("wheel", cube())).unwrap();
        let hinge = Joint::new(JointKind::Revolute, wheel, None, DVec3::ZERO).with_axis(DVec3::Y * length);
        let motor = Motor::new(MotorTarget::Velocity(1.0));
        let hinge = simulation.add_joint(&hinge.with_motor(motor)).unwrap();
        simulation.step().unwrap();
        assert!((simulation.angular_velocity(wheel) + DVec3::Y).length() < 1e-6);
        simulation.set_kind(wheel, Kind::Static).unwrap();
        let mut bad = motor;
        bad.most = f64::NAN;
        assert!(simulation.set_motor(hinge, Some(bad)).is_err());
        simulation.set_motor(hinge, None).unwrap();
        simulation.step().unwrap();
        simulation.set_kind(wheel, Kind::Dynamic).unwrap();
        simulation.step().unwrap();
        assert_eq!(simulation.angular_velocity(wheel), DVec3::ZERO);
        let snapshot = simulation.snapshot();
        simulation.restore(&snapshot).unwrap();
    }
}

/// What was fixed to the world or to another body is moved away by its motion, as is a body that is put elsewhere: no impulse of the joint could
/// move any of them. Steps ended as too fast, without a name, once they were a few decimetres apart.
#[test]
fn joints_of_bodies_that_nothing_moves_hold_nothing() {
    for kind in [JointKind::Fixed, JointKind::Revolute, JointKind::Prismatic, JointKind::Spherical] {
        for with_world in [false, true] {
            let mut simulation = weightless();
            let [a, b, beside] = [0.0, 2.0, -9.0]
                .map(|x| simulation.add(&Body::new("cube", cube()).with_position(DVec3::X * x)).unwrap());
            let other = (!with_world).then_some(b);
            let joint = simulation.add_joint(&Joint::new(kind, a, other, DVec3::X)).unwrap();
            simulation.apply_impulse(beside, DVec3::Y, DVec3::ZERO).unwrap();
            simulation.step().unwrap();
            let up = ConstantTwist::REST.with_linear_velocity(DVec3::Y * 30.0);
            let up = up.with_reference_time(simulation.time());
            simulation.set_motion(a, Arc::new(up)).unwrap();
            simulation.set_kind(b, Kind::Static).unwrap();
            simulation.set_pose(b, Pose::new(DVec3::X * 20.0, DQuat::IDENTITY)).unwrap();
            for _ in 0..100 {
                simulation.step().unwrap();
            }
            assert!((simulation.position(a).y - 30.0).abs() < 1e-9 && simulation.joint(joint).is_some());
        }
    }
}

/// Two bodies meet again, whatever others intersect that the next step has not checked yet.
#[test]
fn a_pair_that_meets_again_is_asked_about_alone() {
    let mut simulation = weightless();
    let [a, b, c] = [0.0, 0.5, 10.0]
        .map(|x| simulation.add(&Body::new(format!("{x}"), cube()).with_position(DVec3::X * x)).unwrap());
    simulation.ignore(a, c);
    simulation.heed(a, c).unwrap();
    simulation.ignore(a, b);
    assert!(matches!(simulation.heed(a, b), Err(SimulationError::Intersecting { .. })));
}

/// A target where the body is already: it stands still there in all steps from then on, and others can be near it.
#[test]
fn what_is_sent_to_where_it_is_stands_still() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let lift = simulation.add(&Body::new("lift", cube()).with_kind(Kind::Driven)).unwrap();
    let load = simulation.add(&Body::new("load", cube()).with_position(DVec3::Y * 1.001)).unwrap();
    for height in [0.001, 0.002, 0.002] {
        simulation.set_target(lift, Pose::new(DVec3::Y * height, DQuat::IDENTITY)).unwrap();
        simulation.step().unwrap();
    }
    let snapshot = simulation.snapshot();
    for _ in 0..30 {
        simulation.step().unwrap();
    }
    assert_eq!(simulation.position(lift), DVec3::Y * 0.002);
    assert!((simulation.position(load).y - 1.003).abs() < 2e-3);
    let after = simulation.snapshot();
    simulation.restore(&snapshot).unwrap();
    for _ in 0..30 {
        simulation.step().unwrap();
    }
    assert_eq!(simulation.snapshot(), after);
}
