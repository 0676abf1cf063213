//! Joints to bodies that turn fast: in a flight a body goes straight, and its joint's axes do not.

mod ground;

use d2m_dynamics::{
    Body, BodyId, Joint, JointKind, Kind, Motor, MotorTarget, Simulation, SimulationOptions, Spring,
};
use d2m_motion::ConstantTwist;
use glam::DVec3;
use ground::{run, tree};
use std::sync::Arc;

fn weightless() -> Simulation {
    Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap()
}

/// A body that turns about y by itself.
fn turning(simulation: &mut Simulation, rate: f64) -> BodyId {
    let motion = Arc::new(ConstantTwist::REST.with_angular_velocity(DVec3::Y * rate));
    let hub = Body::new("hub", tree("box?x=0.05&y=0.5&z=0.05")).with_kind(Kind::Kinematic(motion));
    simulation.add(&hub).unwrap()
}

/// A body at 0.5 along x that turns with the hub from the start.
fn carried(simulation: &mut Simulation, shape: &str, rate: f64) -> BodyId {
    let body = Body::new("carried", tree(shape)).with_position(DVec3::X * 0.5);
    let body = body.with_linear_velocity(DVec3::NEG_Z * (0.5 * rate)).with_angular_velocity(DVec3::Y * rate);
    simulation.add(&body).unwrap()
}

/// How far a body is from where it is held at the start, as seen from the hub.
fn off(simulation: &Simulation, hub: BodyId, body: BodyId, held: DVec3) -> f64 {
    let seen =
        simulation.orientation(hub).conjugate() * (simulation.position(body) - simulation.position(hub));
    (seen - held).length()
}

/// A rod that a turning body carries is divided into several flights a step, while that body is in one: in each of them
/// the joint is where the turning body is then.
#[test]
fn turning_bodies_carry_what_is_joined_to_them() {
    for rate in [10.0, 60.0] {
        let mut simulation = weightless();
        let hub = turning(&mut simulation, rate);
        let rod = carried(&mut simulation, "box?x=0.2&y=0.02&z=0.02", rate);
        simulation.add_joint(&Joint::new(JointKind::Fixed, hub, Some(rod), DVec3::X * 0.1)).unwrap();
        let mut flights = 0;
        while simulation.time() < 1.0 {
            flights += simulation.step().unwrap().segments.len();
            let off = off(&simulation, hub, rod, DVec3::X * 0.5);
            assert!(off < 1e-6, "{rate}: {off}");
        }
        assert!(flights > 150, "{rate}: {flights}");
    }
}

/// A slide on a turning body drives what is on it outward, to its limit or to where its motor has it, and not beyond.
#[test]
fn slides_that_turn_keep_to_limits_and_motors() {
    for rate in [10.0, 100.0] {
        let slide = |joint: &dyn Fn(Joint) -> Joint| {
            let mut simulation = weightless();
            let hub = turning(&mut simulation, rate);
            let cube = carried(&mut simulation, "box?x=0.1&y=0.1&z=0.1", rate);
            let free = Joint::new(JointKind::Prismatic, hub, Some(cube), DVec3::X * 0.3).with_axis(DVec3::X);
            let held = simulation.add_joint(&joint(free)).unwrap();
            run(&mut simulation, 1.0);
            let value = simulation.joint_value(held);
            let across = off(&simulation, hub, cube, DVec3::X * (0.5 + value));
            assert!(across < 1e-4, "{rate}: {across}");
            value
        };
        let limited = slide(&|joint| joint.with_limits([-0.1, 0.2]));
        let motor = Motor::new(MotorTarget::Position(0.1));
        let driven = slide(&|joint| joint.with_motor(motor));
        assert!((limited - 0.2).abs() < 1e-4 && (driven - 0.1).abs() < 1e-4, "{rate}: {limited} {driven}");
    }
}

/// A body that turns about a point far from its center follows its motion by many flights a step: what it carries flies as
/// long as these, and not on along the last one.
#[test]
fn bodies_on_circles_carry_what_is_joined_to_them() {
    let mut simulation = weightless();
    let circle = ConstantTwist::REST.with_at(DVec3::X * 2.0).with_angular_velocity(DVec3::Y * 10.0);
    let hub = Body::new("hub", tree("box?x=0.05&y=0.05&z=0.05"));
    let hub = simulation.add(&hub.with_kind(Kind::Kinematic(Arc::new(circle)))).unwrap();
    let start = simulation.position(hub) + DVec3::X * 0.5;
    let carried = Body::new("carried", tree("box?x=0.1&y=0.1&z=0.1")).with_position(start);
    let velocity = (DVec3::Y * 10.0).cross(start - simulation.position(hub) - DVec3::X * 2.0);
    let carried = carried.with_linear_velocity(velocity).with_angular_velocity(DVec3::Y * 10.0);
    let carried = simulation.add(&carried).unwrap();
    simulation.add_joint(&Joint::new(JointKind::Fixed, hub, Some(carried), start)).unwrap();
    while simulation.time() < 0.2 {
        simulation.step().unwrap();
        let off = off(&simulation, hub, carried, DVec3::X * 0.5);
        assert!(off < 1e-6, "{off}");
    }
}

/// In a step that is flown in parts springs pull and friction holds in each of them: of a slide at half a radian a step.
#[test]
fn forces_of_joints_act_in_every_flight_of_a_step() {
    let (rate, mass) = (50.0_f64, 8.0);
    let slide = |joint: &dyn Fn(Joint) -> Joint| {
        let mut simulation = weightless();
        let hub = turning(&mut simulation, rate);
        let cube = carried(&mut simulation, "box?x=0.1&y=0.1&z=0.1", rate);
        assert!((simulation.mass_properties(cube).unwrap().mass - mass).abs() < 1e-9);
        let free = Joint::new(JointKind::Prismatic, hub, Some(cube), DVec3::X * 0.5).with_axis(DVec3::X);
        let held = simulation.add_joint(&joint(free)).unwrap();
        let mut flights = 0;
        while simulation.time() < 1.0 {
            flights += simulation.step().unwrap().segments.len();
        }
        assert!(flights > 150, "{flights}");
        simulation.joint_value(held)
    };
    // k x = m ω² (0.5 + x) at x = 1/4, damped critically.
    let stiffness = 3.0 * mass * rate * rate;
    let spring = Spring::new(stiffness, 2.0 * (mass * stiffness).sqrt(), 0.0);
    let stretched = slide(&|joint| joint.with_spring(spring));
    assert!((stretched - 0.25).abs() < 0.01, "{stretched}");
    // Friction of three times the force that draws it outward.
    let held = slide(&|joint| joint.with_friction(1.5 * mass * rate * rate));
    assert!(held.abs() < 1e-4, "{held}");
    // And of half of it.
    let slides = slide(&|joint| joint.with_friction(0.25 * mass * rate * rate).with_limits([-1.0, 1.0]));
    assert!((slides - 1.0).abs() < 1e-3, "{slides}");
}
