//! Steps that end with an error: where nothing has moved nothing has changed, and else what acts for a part of the step acts for the time
//! that was flown.

mod ground;

use d2m_dynamics::{
    Body, BodyId, ContactImpulse, Damping, Joint, JointKind, Kind, Mass, Motor, MotorTarget, Simulation,
    SimulationOptions, Snapshot, Spring, StepError,
};
use d2m_motion::{ConstantTwist, Keyframes, Pose, Span};
use glam::DVec3;
use ground::{at, cube, tree};
use std::sync::Arc;

/// The largest force of a motor that never reaches its speed: of a body of mass one.
const FORCE: f64 = 3.0;

/// A body whose velocity fades, and one that a motor drives: far from each other, and from what will be at the origin.
fn faded_and_driven(step: f64) -> (Simulation, [BodyId; 2]) {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(step);
    let mut simulation = Simulation::new(options).unwrap();
    let light = |x: f64| Body::new("light", cube()).with_mass(Mass::Total(1.0)).with_position(DVec3::X * x);
    let faded = light(10.0).with_damping(Damping { linear: 1.0, angular: 0.0 });
    let faded = simulation.add(&faded.with_linear_velocity(DVec3::Y)).unwrap();
    let driven = simulation.add(&light(20.0)).unwrap();
    let mut motor = Motor::new(MotorTarget::Velocity(50.0));
    motor.most = FORCE;
    let rail = Joint::new(JointKind::Prismatic, driven, None, DVec3::X * 20.0).with_axis(DVec3::X);
    simulation.add_joint(&rail.with_motor(motor)).unwrap();
    (simulation, [faded, driven])
}

/// A press comes down on an egg.
fn add_press(simulation: &mut Simulation) -> [BodyId; 2] {
    let plate = || tree("box?x=1&y=0.5&z=1");
    let anvil = Body::new("anvil", plate()).with_kind(Kind::Static).with_position(DVec3::Y * -0.5);
    simulation.add(&anvil).unwrap();
    let egg = simulation.add(&Body::new("egg", cube()).with_position(DVec3::Y * 0.501)).unwrap();
    let down = ConstantTwist::REST.with_position(DVec3::Y * 1.6).with_linear_velocity(DVec3::Y * -0.75);
    let press = Body::new("press", plate()).with_kind(Kind::Kinematic(Arc::new(down)));
    [egg, simulation.add(&press).unwrap()]
}

/// Velocities faded, and motors drove, by each attempt at a step that was refused.
#[test]
fn steps_that_are_refused_change_nothing() {
    let stands = |end: f64| Keyframes::try_new(&[0.0, end].map(|t| (t, at(0.0, 9.0, 0.0))), Span::Linear);
    let blur = ConstantTwist::REST.with_position(DVec3::Y * 9.0).with_angular_velocity(DVec3::X * 1e9);
    type Fault<'f> = Box<dyn Fn(&mut Simulation) + 'f>;
    let add = |body: &Body, simulation: &mut Simulation| simulation.add(body).unwrap();
    let small = || Body::new("small", tree("box?x=0.1&y=0.1&z=0.1"));
    let faults: [Fault<'_>; 4] = [
        Box::new(|s| {
            let over = Kind::Kinematic(Arc::new(stands(0.03).unwrap()));
            add(&small().with_kind(over), s);
        }),
        Box::new(|s| {
            let hand = add(&small().with_kind(Kind::Driven).with_position(DVec3::Y * 9.0), s);
            s.set_target(hand, Pose { translation: DVec3::Y * 1e200, ..Pose::IDENTITY }).unwrap();
        }),
        Box::new(|s| {
            add(&small().with_kind(Kind::Kinematic(Arc::new(blur))), s);
        }),
        Box::new(|s| {
            add(&small().with_position(DVec3::X * 10.0), s);
        }),
    ];
    for (k, fault) in faults.into_iter().enumerate() {
        let (mut simulation, _) = faded_and_driven(0.02);
        simulation.step().unwrap();
        fault(&mut simulation);
        let before = simulation.snapshot();
        for _ in 0..3 {
            assert!(simulation.step().is_err(), "{k}");
            assert_eq!(simulation.snapshot(), before, "{k}");
        }
    }
}

/// A press crushes an egg in the middle of a step, and goes on failing there; what fades and what is driven elsewhere is afterwards as in
/// the same times without the press.
#[test]
fn what_acts_for_a_part_of_a_step_acts_for_the_time_flown() {
    let (mut pressed, ids) = faded_and_driven(0.02);
    let gone = add_press(&mut pressed);
    let (mut alone, twins) = faded_and_driven(0.02);
    let error = loop {
        match pressed.step() {
            Ok(_) => alone.step().unwrap(),
            Err(error) => break error,
        };
    };
    assert!(matches!(error, StepError::Crushed { .. } | StepError::Cornered { .. }), "{error}");
    let time = pressed.time();
    assert!(time > alone.time() && time < alone.time() + 0.02);
    while pressed.step().is_ok() {}
    let before = (pressed.time(), pressed.snapshot());
    for _ in 0..5 {
        assert!(pressed.step().is_err());
        assert!((pressed.time(), pressed.snapshot()) == before);
    }
    for body in gone {
        assert!(pressed.remove(body));
    }
    if time > alone.time() {
        alone.step_to(time).unwrap();
    }
    for _ in 0..3 {
        alone.step().unwrap();
        pressed.step().unwrap();
        assert_eq!(alone.time(), pressed.time());
        let speeds = |simulation: &Simulation, [faded, driven]: [BodyId; 2]| {
            [simulation.linear_velocity(faded).y, simulation.linear_velocity(driven).x]
        };
        let (one, two) = (speeds(&pressed, ids), speeds(&alone, twins));
        assert!((one[0] - two[0]).abs() < 1e-12 && (one[1] - two[1]).abs() < 1e-9, "{one:?} {two:?}");
        let end = -pressed.time();
        assert!((one[0] - end.exp()).abs() < 1e-12, "{one:?}");
        assert!((one[1].abs() + FORCE * end).abs() < 1e-9, "{one:?} {end}");
    }
}

/// A cube lies on the floor while elsewhere something is so fast that no query knows its way: what would have borne the cube has not acted, and
/// the listener hears nothing of it. Without that it hears the cube's weight.
#[test]
fn nothing_is_heard_of_a_step_in_which_nothing_moves() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&ground::floor()).unwrap();
    simulation.add(&Body::new("cube", cube()).with_position(DVec3::Y * 0.501)).unwrap();
    simulation.step().unwrap();
    let [fast, _] = [9.0, 10.5]
        .map(|x| simulation.add(&Body::new("far", cube()).with_position(DVec3::new(x, 9.0, 0.0))).unwrap());
    simulation.set_velocity(fast, DVec3::X * 1e30, DVec3::ZERO).unwrap();
    let before = simulation.snapshot();
    let mut heard = 0;
    assert!(simulation.step_with(&mut |_: &ContactImpulse| heard += 1).is_err());
    assert!(heard == 0 && simulation.snapshot() == before);
    simulation.remove(fast);
    simulation.step_with(&mut |_: &ContactImpulse| heard += 1).unwrap();
    assert!(heard > 0);
}

/// A state that an error has left in the middle of a step goes on with the same bits, whether it was held, or written and read: of springs,
/// soft motors and friction, of motors of bounded force, and of velocities that fade.
#[test]
fn what_an_error_ended_goes_on_the_same_held_or_read() {
    let soft = |target: MotorTarget, stiffness: f64| {
        let mut motor = Motor::new(target);
        (motor.stiffness, motor.most) = (stiffness, FORCE);
        motor
    };
    type Drive<'d> = &'d dyn Fn(Joint) -> Joint;
    let drives: [Drive<'_>; 4] = [
        &|joint| joint.with_spring(Spring::new(50.0, 0.0, 0.5)),
        &|joint| joint.with_friction(FORCE),
        &|joint| joint.with_motor(soft(MotorTarget::Position(0.5), 50.0)),
        &|joint| joint.with_motor(soft(MotorTarget::Velocity(50.0), 0.0)),
    ];
    for (k, drive) in drives.into_iter().enumerate() {
        let (mut simulation, _) = faded_and_driven(0.02);
        let load = Body::new("load", cube()).with_mass(Mass::Total(1.0)).with_position(DVec3::X * 30.0);
        let load = simulation.add(&load.with_linear_velocity(DVec3::X)).unwrap();
        let rail = Joint::new(JointKind::Prismatic, load, None, DVec3::X * 30.0).with_axis(DVec3::X);
        simulation.add_joint(&drive(rail)).unwrap();
        let gone = add_press(&mut simulation);
        while simulation.step().is_ok() {}
        let text = serde_json::to_string(&simulation.snapshot()).unwrap();
        let read: Snapshot = serde_json::from_str(&text).unwrap();
        assert_eq!(read, simulation.snapshot(), "{k}");
        let mut other = simulation.clone();
        other.restore(&read).unwrap();
        for simulation in [&mut simulation, &mut other] {
            for body in gone {
                simulation.remove(body);
            }
            simulation.step().unwrap();
        }
        assert_eq!(simulation.snapshot(), other.snapshot(), "{k}");
    }
    // Times that no step has are refused by their name.
    let (mut simulation, _) = faded_and_driven(0.02);
    let text = serde_json::to_string(&simulation.snapshot()).unwrap();
    let forged = text.replace("\"owed\":0.0", "\"owed\":1e200");
    let said = simulation.restore(&serde_json::from_str(&forged).unwrap()).unwrap_err().to_string();
    assert!(said.ends_with("motor's impulse 1e200 cannot be used"), "{said}");
}
