//! Joints that turn more than half round in a step, and those in the shortest steps.

mod ground;

use d2m_dynamics::{Body, BodyId, Joint, JointKind, Motor, MotorTarget, Simulation, SimulationOptions};
use glam::DVec3;
use ground::{run, tree};

/// Its flights are as long as the step, however fast it turns.
fn cube(simulation: &mut Simulation) -> BodyId {
    simulation.add(&Body::new("cube", tree("box?x=0.1&y=0.1&z=0.1"))).unwrap()
}

/// The kinetic energy of a body.
fn kinetic(simulation: &Simulation, id: BodyId) -> f64 {
    let mass = simulation.mass_properties(id).unwrap();
    let spin = simulation.orientation(id).conjugate() * simulation.angular_velocity(id);
    0.5 * (mass.mass * simulation.linear_velocity(id).length_squared() + spin.dot(mass.inertia * spin))
}

/// What turns more than half round in a step is where its flights have turned it: it stops at its limit, and where its motor has it go.
#[test]
fn turns_are_counted_however_fast_they_are() {
    for (spin, step) in [(320.0, 0.01), (1000.0, 0.01), (40.0, 0.1), (4.0, 1.0)] {
        let mut simulation =
            Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(step)).unwrap();
        let body = cube(&mut simulation);
        let inertia = simulation.mass_properties(body).unwrap().inertia.z_axis.z;
        simulation.apply_impulse(body, DVec3::ZERO, DVec3::Z * (spin * inertia)).unwrap();
        let pin = Joint::new(JointKind::Revolute, body, None, DVec3::ZERO).with_limits([-20.0, 20.0]);
        let pin = simulation.add_joint(&pin).unwrap();
        let mut segments = Vec::new();
        while simulation.time() < 40.0 * step {
            segments.extend(simulation.step().unwrap().segments);
            let value = simulation.joint_value(pin);
            assert!(value > -20.0 - 1e-6, "{spin}: {value}");
        }
        segments.extend(simulation.finish());
        let (mut rate, mut turned) = (0.0, 0.0);
        for segment in &segments {
            for (_, flight) in segment.changed.iter().filter(|(id, _)| *id == body) {
                rate = flight.angular_velocity().z;
            }
            turned += rate * (segment.end - segment.start);
        }
        let value = simulation.joint_value(pin);
        assert!((turned - 20.0).abs() < 1e-6 && (value + turned).abs() < 1e-6, "{spin}: {value} {turned}");
    }
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let body = cube(&mut simulation);
    let pin = Joint::new(JointKind::Revolute, body, None, DVec3::ZERO);
    let pin = pin.with_motor(Motor::new(MotorTarget::Position(100.0)));
    let pin = simulation.add_joint(&pin).unwrap();
    run(&mut simulation, 1.0);
    let value = simulation.joint_value(pin);
    assert!((value - 100.0).abs() < 1e-6 && simulation.angular_velocity(body).length() < 1e-4, "{value}");
}

/// A motor to a place gives its slide a fifth of the way in a step, however short the first steps are: it was six times as fast in those in
/// which no pose changes.
#[test]
fn motors_are_as_fast_in_the_shortest_steps() {
    for far in [0.0, 3.0] {
        for short in [1e-300, 1e-50, 1e-18, 1e-17, 1e-16, 1e-15, 5e-15] {
            let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
            let place = DVec3::new(far, 4.0, 0.0);
            let slide = simulation.add(&Body::new("slide", ground::cube()).with_position(place)).unwrap();
            let rail = Joint::new(JointKind::Prismatic, slide, None, place).with_axis(DVec3::Y);
            let motor = Motor::new(MotorTarget::Position(0.1));
            simulation.add_joint(&rail.with_motor(motor)).unwrap();
            for k in 1..4 {
                simulation.step_to(f64::from(k) * short).unwrap();
                let speed = simulation.linear_velocity(slide).y;
                assert!((speed + 0.2 * 0.1 / simulation.options().step).abs() < 1e-6, "{short:e} {speed}");
            }
        }
    }
}

/// Two cubes that tumble about each other keep their energy when a step ends at the next double, or a bit later: equations of joints were led to
/// where the rounding of poses has them, by up to 700 times the energy, a thousand lengths away also in steps of 1e-12.
#[test]
fn joints_gain_no_energy_in_the_shortest_steps() {
    let kinds = [JointKind::Fixed, JointKind::Revolute, JointKind::Prismatic, JointKind::Spherical];
    for (far, kind) in [0.0, 30.0, 1e3, 1e5].into_iter().flat_map(|far| kinds.map(|kind| (far, kind))) {
        for (k, short) in [0.0, 1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10].into_iter().enumerate() {
            let options = SimulationOptions::default().with_gravity(DVec3::ZERO);
            let mut simulation = Simulation::new(options).unwrap();
            let place = DVec3::X * (far + 0.013 * k as f64);
            let cube = Body::new("cube", ground::cube());
            let one = cube.clone().with_linear_velocity(DVec3::new(0.3, 1.0, -0.4)).with_position(place);
            let one = one.with_angular_velocity(DVec3::new(1.0, 2.0, 3.0));
            let other = cube.with_linear_velocity(DVec3::new(-0.3, 1.0, 0.4));
            let other = other.with_position(place + DVec3::new(-0.7, 0.2, 0.1));
            let bodies = [one, other].map(|body| simulation.add(&body).unwrap());
            let point = place + DVec3::new(-0.4, 0.1, 0.0);
            let joint = Joint::new(kind, bodies[0], Some(bodies[1]), point);
            simulation.add_joint(&joint.with_axis(DVec3::new(1.0, 0.2, 0.3))).unwrap();
            for _ in 0..7 {
                simulation.step().unwrap();
            }
            let energy =
                |simulation: &Simulation| bodies.map(|id| kinetic(simulation, id)).iter().sum::<f64>();
            let before = energy(&simulation);
            simulation.step_to((simulation.time() + short).max(simulation.time().next_up())).unwrap();
            for _ in 0..2 {
                let gained = energy(&simulation) / before - 1.0;
                assert!(gained.abs() < 3e-4, "{far} {kind:?} {short:e}: {gained:e}");
                simulation.step().unwrap();
            }
        }
    }
}
