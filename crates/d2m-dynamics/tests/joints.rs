//! Joints keep their bodies together, and their energy; limits, motors, springs and friction do what they say.

mod ground;

use d2m_bvh::MeshTree;
use d2m_dynamics::{
    Body, BodyId, Joint, JointKind, Kind, Mass, Motor, MotorTarget, Simulation, SimulationError,
    SimulationOptions, Spring, StepError,
};
use glam::{BVec3, DQuat, DVec3};
use ground::{floor, tree};
use std::sync::Arc;

/// A bar of ten kilograms and a length of one, along x about this point.
fn bar(simulation: &mut Simulation, x: f64) -> BodyId {
    let shape = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.05&z=0.05").unwrap()));
    simulation.add(&Body::new(format!("bar at {x}"), shape).with_position(DVec3::X * x)).unwrap()
}

fn end(simulation: &Simulation, body: BodyId, x: f64) -> DVec3 {
    simulation.pose(body).transform_point(DVec3::X * x)
}

fn kinetic(simulation: &Simulation, id: BodyId) -> f64 {
    let mass = simulation.mass_properties(id).unwrap();
    let spin = simulation.orientation(id).conjugate() * simulation.angular_velocity(id);
    0.5 * (mass.mass * simulation.linear_velocity(id).length_squared() + spin.dot(mass.inertia * spin))
}

fn energy(simulation: &Simulation) -> f64 {
    let of = |id: BodyId| {
        // The velocity is that of the middle of the last flight.
        let half = 0.5 * simulation.options().step;
        let height = simulation.position(id).y - simulation.linear_velocity(id).y * half;
        kinetic(simulation, id) + simulation.mass_properties(id).unwrap().mass * 9.81 * height
    };
    simulation.ids().map(of).sum()
}

/// A bar on a pin hits another one near its end: joints take part in the impact, so that its energy is passed on.
#[test]
fn bars_on_pins_bounce_off_each_other() {
    let mut simulation = Simulation::new(still()).unwrap();
    let shape = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.05&z=0.05").unwrap()));
    let mut bar = |name: &str, y: f64, spin: f64| {
        let body = Body::new(name, Arc::clone(&shape)).with_position(DVec3::Y * y).with_restitution(1.0);
        let body = body.with_angular_velocity(DVec3::Z * spin).with_linear_velocity(DVec3::Y * (0.5 * spin));
        simulation.add(&body).unwrap()
    };
    let (first, second) = (bar("first", 0.0, 1.0), bar("second", 0.3, 0.0));
    for (body, end) in [(first, DVec3::X * -0.5), (second, DVec3::new(-0.5, 0.3, 0.0))] {
        simulation.add_joint(&Joint::new(JointKind::Revolute, body, None, end).with_axis(DVec3::Z)).unwrap();
    }
    let before = kinetic(&simulation, first);
    run(&mut simulation, 0.4);
    let after = [first, second].map(|body| kinetic(&simulation, body));
    assert!(after[1] > 0.1 * before, "{after:?}");
    // What straight flights of a center on a circle leave.
    assert!((after[0] + after[1] - before).abs() < 1e-3 * before, "{before} {after:?}");
}

fn run(simulation: &mut Simulation, until: f64) {
    while simulation.time() < until - 1e-9 {
        let report = simulation.step().unwrap();
        assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
    }
}

fn still() -> SimulationOptions {
    SimulationOptions::default().with_gravity(DVec3::ZERO)
}

#[test]
fn a_double_pendulum_keeps_its_joints_and_its_energy() {
    let threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| {
            // Short, as the middle of a flight that is split is not that of the step.
            let step = 1.0 / 512.0;
            let mut simulation = Simulation::new(SimulationOptions::default().with_step(step)).unwrap();
            let (a, b) = (bar(&mut simulation, 0.5), bar(&mut simulation, 1.5));
            simulation.add_joint(&Joint::new(JointKind::Revolute, a, None, DVec3::ZERO)).unwrap();
            simulation.add_joint(&Joint::new(JointKind::Revolute, a, Some(b), DVec3::X)).unwrap();
            assert_eq!(simulation.len(), 2);
            for _ in 0..1500 {
                let until = simulation.time() + step;
                run(&mut simulation, until);
                assert!(end(&simulation, a, -0.5).length() < 1e-6);
                assert!((end(&simulation, a, 0.5) - end(&simulation, b, -0.5)).length() < 1e-6);
                // Of 200 J that it swings with.
                assert!(energy(&simulation).abs() < 0.5, "{}", energy(&simulation));
            }
            simulation.snapshot()
        })
    };
    assert_eq!(threads(1), threads(2));
}

/// A chain of twenty links, its first one held, that swings; spherical and fixed ones.
#[test]
fn a_chain_of_twenty_links_holds_together() {
    for kind in [JointKind::Spherical, JointKind::Fixed] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let links: Vec<BodyId> = (0..20).map(|k| bar(&mut simulation, 0.5 + f64::from(k))).collect();
        simulation.add_joint(&Joint::new(kind, links[0], None, DVec3::ZERO)).unwrap();
        for (k, pair) in links.windows(2).enumerate() {
            let point = DVec3::X * (k + 1) as f64;
            simulation.add_joint(&Joint::new(kind, pair[0], Some(pair[1]), point)).unwrap();
        }
        run(&mut simulation, 1.0);
        for pair in links.windows(2) {
            let apart = end(&simulation, pair[0], 0.5) - end(&simulation, pair[1], -0.5);
            assert!(apart.length() < 1e-5, "{kind:?}: {apart}");
        }
        let fallen = -simulation.position(links[19]).y;
        assert!(if kind == JointKind::Fixed { fallen < 1e-3 } else { fallen > 2.0 }, "{kind:?}: {fallen}");
    }
}

#[test]
fn limits_stop_a_pendulum_and_a_slide() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let arm = bar(&mut simulation, 0.5);
    // b is the world: it turns against the arm, the other way round.
    let pin = Joint::new(JointKind::Revolute, arm, None, DVec3::ZERO).with_limits([-1.0, 0.5]);
    let pin = simulation.add_joint(&pin).unwrap();
    let slider = bar(&mut simulation, 3.0);
    let slide = Joint::new(JointKind::Prismatic, slider, None, DVec3::X * 3.0).with_axis(DVec3::Y);
    let slide = simulation.add_joint(&slide.with_limits([-1.0, 0.25])).unwrap();
    run(&mut simulation, 2.0);
    let (angle, way) = (simulation.joint_value(pin), simulation.joint_value(slide));
    assert!((angle - 0.5).abs() < 1e-6 && (way - 0.25).abs() < 1e-6, "{angle} {way}");
    let place = simulation.position(slider);
    assert!((place - DVec3::new(3.0, -0.25, 0.0)).length() < 1e-6, "{place}");
}

/// A motor reaches its rate, no faster than its torque allows; one with a position goes there; dry friction stops a turn in the time
/// that its torque takes.
#[test]
fn motors_and_friction_act_with_their_torques() {
    let inertia = |simulation: &Simulation, body| simulation.mass_properties(body).unwrap().inertia.z_axis.z;
    let spun = |joint: &dyn Fn(Joint) -> Joint, rate: f64, until: f64| {
        let mut simulation = Simulation::new(still()).unwrap();
        let body = bar(&mut simulation, 0.0);
        let inertia = inertia(&simulation, body);
        simulation.apply_impulse(body, DVec3::ZERO, DVec3::Z * (rate * inertia)).unwrap();
        let pin = joint(Joint::new(JointKind::Revolute, body, None, DVec3::ZERO));
        let pin = simulation.add_joint(&pin).unwrap();
        run(&mut simulation, until);
        (simulation.angular_velocity(body).z * inertia, inertia, simulation.joint_value(pin))
    };
    let mut motor = Motor::new(MotorTarget::Velocity(-2.0));
    motor.most = 0.5;
    let (momentum, inertia, _) = spun(&|joint| joint.with_motor(motor), 0.0, 1.0);
    assert!((momentum - 0.5).abs() < 0.01, "{momentum}");
    let (momentum, ..) = spun(&|joint| joint.with_motor(motor), 0.0, 2.0 * inertia / 0.5 + 1.0);
    assert!((momentum - 2.0 * inertia).abs() < 1e-6, "{momentum}");
    let motor = Motor::new(MotorTarget::Position(0.75));
    let (_, _, value) = spun(&|joint| joint.with_motor(motor), 0.0, 2.0);
    assert!((value - 0.75).abs() < 1e-6, "{value}");
    let (momentum, ..) = spun(&|joint| joint.with_friction(0.3), 2.0 / inertia, 1.0);
    assert!((momentum - 1.7).abs() < 0.01, "{momentum}");
    let (momentum, ..) = spun(&|joint| joint.with_friction(4.0), 2.0 / inertia, 1.0);
    assert!(momentum.abs() < 1e-6, "{momentum}");
}

/// A motor that turns a crank, which pushes a slider a thousand times as heavy to and fro over a rod: where a step is flown in parts it sees to its
/// speed in each of them, and its torque is that of the step. It also does from rest to a radian a step; only where the rod allows no turn it does none.
#[test]
fn motors_turn_cranks_at_their_speed() {
    for (step, speed, end) in [(0.002, 20.0, 1.0), (0.01, 100.0, 0.1)] {
        let (mut simulation, driven) = crank(step, speed, Some(1e6));
        run(&mut simulation, end);
        let turned = simulation.joint_value(driven);
        assert!((turned + speed * simulation.time()).abs() < 1e-3, "{turned}");
    }
    let (mut simulation, driven) = crank(0.01, 20.0, None);
    for _ in 0..3 {
        assert!(simulation.step().unwrap().segments.len() < 4);
    }
    let turned = simulation.joint_value(driven);
    // Lengths change by less than a hundredth of the gap in such a turn.
    assert!(turned.abs() < 5e-3, "{turned}");
}

/// A crank with a motor that is as strong as it needs, from its dead point if the rod's other end is pinned to the world, in place of a slider of this
/// density.
fn crank(step: f64, speed: f64, slider: Option<f64>) -> (Simulation, usize) {
    let mut simulation = Simulation::new(still().with_step(step)).unwrap();
    let mut part = |name: &str, length: f64, at: DVec3, angle: f64, density: f64| {
        let shape = format!("box?x={}&y=0.025&z=0.025", 0.5 * length);
        let shape = Arc::new(MeshTree::new(d2m_shapes::mesh(&shape).unwrap()));
        let body = Body::new(name, shape).with_mass(Mass::Density(density)).with_position(at);
        simulation.add(&body.with_orientation(DQuat::from_rotation_z(angle))).unwrap()
    };
    let angle = if slider.is_some() { 0.5_f64 } else { 0.0 };
    let pin = DVec3::new(angle.cos(), angle.sin(), 0.0) * 0.3;
    let cross = DVec3::X * (pin.x + (1.0 - pin.y * pin.y).sqrt());
    let tilt = (-pin.y).atan2(cross.x - pin.x);
    let crank = part("crank", 0.27, pin * 0.5, angle, 1000.0);
    let rod = part("rod", 0.9, (pin + cross) * 0.5, tilt, 1000.0);
    let slider = slider.map(|density| part("slider", 0.2, cross, 0.0, density));
    let hinge = |a: BodyId, b: Option<BodyId>, at: DVec3| {
        Joint::new(JointKind::Revolute, a, b, at).with_axis(DVec3::Z)
    };
    let mut motor = Motor::new(MotorTarget::Velocity(-speed));
    motor.most = 1e12;
    let driven = simulation.add_joint(&hinge(crank, None, DVec3::ZERO).with_motor(motor)).unwrap();
    simulation.add_joint(&hinge(crank, Some(rod), pin)).unwrap();
    simulation.add_joint(&hinge(rod, slider, cross)).unwrap();
    if let Some(slider) = slider {
        let way = Joint::new(JointKind::Prismatic, slider, None, cross).with_axis(DVec3::X);
        simulation.add_joint(&way).unwrap();
    }
    (simulation, driven)
}

/// What joints cannot hold in 4096 flights a step is no motion: the step says which body is too fast, and what was flown before that keeps
/// the joint. A motor of a thousand radians a second is followed.
#[test]
fn motors_of_absurd_speed_are_errors() {
    for (speed, is_followed) in [(1e3, true), (1e6, false), (1e9, false), (1e30, false)] {
        let mut simulation = Simulation::new(still()).unwrap();
        let rotor = bar(&mut simulation, 0.5);
        let mut motor = Motor::new(MotorTarget::Velocity(speed));
        motor.most = 1e6 * speed;
        let hinge = Joint::new(JointKind::Revolute, rotor, None, DVec3::ZERO).with_axis(DVec3::Y);
        simulation.add_joint(&hinge.with_motor(motor)).unwrap();
        let outcome = (0..4).try_for_each(|_| simulation.step().map(|_| ()));
        match outcome {
            Ok(()) => assert!(is_followed, "{speed:e} is followed"),
            Err(StepError::TooFast { body, .. }) => {
                assert!(!is_followed && body == "bar at 0.5", "{speed:e}: {body}");
            }
            Err(error) => panic!("{speed:e}: {error}"),
        }
        let off = end(&simulation, rotor, -0.5).length();
        assert!(off <= simulation.options().gap, "{speed:e}: {off} off the hinge");
    }
}

/// A weight on a spring comes to rest where the spring carries it.
#[test]
fn a_damped_spring_carries_a_weight() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let body = bar(&mut simulation, 0.0);
    let slide = Joint::new(JointKind::Prismatic, body, None, DVec3::ZERO).with_axis(DVec3::Y);
    let mass = simulation.mass_properties(body).unwrap().mass;
    let slide = slide.with_spring(Spring::new(1000.0, 200.0, 0.0));
    let slide = simulation.add_joint(&slide).unwrap();
    run(&mut simulation, 5.0);
    let (found, wanted) = (simulation.joint_value(slide), mass * 9.81 / 1000.0);
    assert!((found - wanted).abs() < 1e-4, "{found} {wanted}");
}

#[test]
fn joints_that_cannot_be_are_refused() {
    let mut simulation = Simulation::new(still()).unwrap();
    let body = bar(&mut simulation, 0.0);
    let good = Joint::new(JointKind::Revolute, body, None, DVec3::ZERO);
    let bad = [
        good.clone().with_axis(DVec3::ZERO),
        good.clone().with_limits([1.0, -1.0]),
        good.clone().with_friction(f64::NAN),
        good.clone().with_spring(Spring::new(-1.0, 0.0, 0.0)),
        Joint::new(JointKind::Fixed, body, Some(body), DVec3::ZERO),
        Joint::new(JointKind::Fixed, body, None, DVec3::NAN),
    ];
    for joint in bad {
        assert!(matches!(simulation.add_joint(&joint), Err(SimulationError::BadJoint { .. })), "{joint:?}");
    }
    assert!(simulation.add_joint(&good).is_ok());
}

/// A chain of a hundred links falls from level: its end whips round, too fast for the ends of flights of a whole step to be put right. The
/// energy of what it falls is about 600; what diverged had two million.
#[test]
fn the_end_of_a_long_chain_whips_round_without_gaining_energy() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let link = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.04&y=0.02&z=0.02").unwrap()));
    let mut last = None;
    for k in 0..100 {
        let place = DVec3::X * (0.1 * f64::from(k) + 0.05);
        let body =
            simulation.add(&Body::new(format!("{k}"), Arc::clone(&link)).with_position(place)).unwrap();
        let point = place - DVec3::X * 0.05;
        let joint = match last {
            Some(before) => Joint::new(JointKind::Spherical, before, Some(body), point),
            None => Joint::new(JointKind::Spherical, body, None, point),
        };
        simulation.add_joint(&joint).unwrap();
        last = Some(body);
    }
    let (first, mut most) = (energy(&simulation), f64::NEG_INFINITY);
    for k in 1..=40 {
        run(&mut simulation, 0.01 * f64::from(k));
        most = most.max(energy(&simulation) - first);
        let mut ends =
            simulation.ids().map(|id| [-0.05, 0.05].map(|x| end(&simulation, id, x))).collect::<Vec<_>>();
        ends.insert(0, [DVec3::ZERO; 2]);
        let apart = ends.windows(2).map(|pair| pair[0][1].distance(pair[1][0])).fold(0.0, f64::max);
        assert!(apart < 1e-3, "{apart} at {}", simulation.time());
    }
    assert!(most < 6.0, "{most}");
}

/// A box on a rope of ten rods of 100 grams, which ends at these points.
fn rope(load: f64, points: &[DVec3]) -> Simulation {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let shape = |query: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(query).unwrap()));
    let (rod, cube) = (shape("box?x=0.05&y=0.01&z=0.01"), shape("box?x=0.15&y=0.15&z=0.15"));
    let mut last = None;
    for (k, &point) in points.iter().enumerate() {
        let way = points.get(k + 1).map_or(DVec3::X * 0.3, |next| next - point);
        let (tree, mass) = if k + 1 < points.len() { (&rod, 0.1) } else { (&cube, load) };
        let body = Body::new(format!("{k}"), Arc::clone(tree)).with_mass(Mass::Total(mass));
        let turn = DQuat::from_rotation_arc(DVec3::X, way.normalize());
        let body = simulation.add(&body.with_position(point + way * 0.5).with_orientation(turn)).unwrap();
        let joint = match last {
            Some(before) => Joint::new(JointKind::Spherical, before, Some(body), point),
            None => Joint::new(JointKind::Spherical, body, None, point),
        };
        simulation.add_joint(&joint).unwrap();
        last = Some(body);
    }
    let ids: Vec<BodyId> = simulation.ids().collect();
    for (k, &a) in ids.iter().enumerate() {
        ids[k + 1..].iter().for_each(|&b| simulation.ignore(a, b));
    }
    simulation
}

/// Ten rods of 100 grams carry a box of a tonne, and of a thousand, and a hundred rods one of a hundred, which swings from level: pulled so hard they
/// turn a hundred times faster than steps are long. Without brakes a tonne takes twelve times the flights, and a thousand of them gain any
/// energy; of the hundred rods the last corrections of a flight lead further off than those before.
#[test]
fn a_light_rope_carries_a_heavy_load() {
    for (count, load, until) in [(10, 1e3, 0.5), (10, 1e6, 0.5), (100, 1e5, 0.9)] {
        let points: Vec<DVec3> = (0..=count).map(|k| DVec3::X * (0.1 * f64::from(k))).collect();
        let mut simulation = rope(load, &points);
        let ids: Vec<BodyId> = simulation.ids().collect();
        let (mut flights, first) = (0, energy(&simulation));
        while simulation.time() < until - 1e-9 {
            let report = simulation.step().unwrap();
            flights += report.segments.len();
            assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
            assert!(flights <= 200, "{flights} until {}", simulation.time());
        }
        let fallen = -simulation.position(ids[count as usize]).y;
        assert!(fallen > 0.9, "{fallen}");
        let gained = (energy(&simulation) - first) / (load * 9.81 * fallen);
        assert!(gained.abs() < 1e-2, "{gained}");
        for (k, pair) in ids.windows(2).enumerate() {
            let half = if k + 2 < ids.len() { 0.05 } else { 0.15 };
            let apart = end(&simulation, pair[0], 0.05) - end(&simulation, pair[1], -half);
            assert!(apart.length() < 1e-5, "{k}: {apart}");
        }
    }
}

/// The most and the least energy until a time, against the first; no step fails, and few are flown in many parts.
fn energies(simulation: &mut Simulation, until: f64, most_flights: usize) -> [f64; 2] {
    let (first, mut flights) = (energy(simulation), 0);
    let mut range = [f64::INFINITY, f64::NEG_INFINITY];
    while simulation.time() < until {
        flights += simulation.step().unwrap().segments.len();
        assert!(flights <= most_flights, "{flights} until {}", simulation.time());
        let now = energy(simulation) - first;
        range = [range[0].min(now), range[1].max(now)];
    }
    range
}

/// One to ten thousand tonnes fall by 0.4 on a slack rope of ten rods of 100 grams, which snaps taut: rods that take up what the load has whip round at
/// any speed. It is an inelastic impact instead, and the load hangs where it was caught.
#[test]
fn a_rope_that_snaps_taut_gains_no_energy() {
    let zigzag = |k: i32| DVec3::new(0.08 * f64::from(k % 2), -0.06 * f64::from(k), 0.0);
    let points: Vec<DVec3> = (0..=10).map(zigzag).collect();
    for load in [1e3, 1e4, 1e6, 1e7] {
        let mut simulation = rope(load, &points);
        let caught = load * 9.81 * 0.4;
        let [_, most] = energies(&mut simulation, 1.0, 1200);
        assert!(most < 0.1 * caught, "{load}: {}", most / caught);
        let ids: Vec<BodyId> = simulation.ids().collect();
        let height = simulation.position(ids[10]).y;
        assert!((-1.15..-0.8).contains(&height), "{load}: {height}");
    }
}

/// What falls obliquely on such a rope is caught, and swings on with what speed it has across the rope.
#[test]
fn a_rope_that_snaps_taut_lets_its_load_swing() {
    let zigzag = |k: i32| DVec3::new(0.08 * f64::from(k % 2), -0.06 * f64::from(k), 0.0);
    let points: Vec<DVec3> = (0..=10).map(zigzag).collect();
    let mut simulation = rope(1e5, &points);
    let load = simulation.ids().last().unwrap();
    simulation.set_velocity(load, DVec3::Z * 4.0, DVec3::ZERO).unwrap();
    let mut slowest = f64::INFINITY;
    while simulation.time() < 0.25 {
        simulation.step().unwrap();
        slowest = slowest.min(simulation.linear_velocity(load).length());
    }
    assert!((1.0..2.0).contains(&slowest), "{slowest}");
}

/// A box that hangs by its side on a rope of ten rods of a 10⁸th of its mass swings, with its energy: the brakes of the rods have to be as strong as the
/// force that the corrections of a flight find last.
#[test]
fn a_load_swings_on_the_lightest_of_ropes() {
    let points: Vec<DVec3> = (0..=10).map(|k| DVec3::NEG_Y * (0.1 * f64::from(k))).collect();
    let mut simulation = rope(1e7, &points);
    let [least, most] = energies(&mut simulation, 1.0, 200);
    let swung = 1e7 * 9.81 * 0.15;
    assert!(least > -0.2 * swung && most < 0.1 * swung, "{least} {most} of {swung}");
}

/// What is locked is so to rounding, also while the body tumbles about what is left free.
#[test]
fn a_body_stays_in_its_plane() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
    let thrown = Body::new("thrown", cube).with_linear_velocity(DVec3::new(1.0, 2.0, 3.0));
    let thrown = simulation.add(&thrown.with_angular_velocity(DVec3::ONE)).unwrap();
    let flat = BVec3::new(false, false, true);
    simulation.add_joint(&Joint::locks(thrown, flat, !flat)).unwrap();
    run(&mut simulation, 0.5);
    let (place, turn) = (simulation.position(thrown), simulation.orientation(thrown));
    assert!((place.x - 0.5).abs() < 1e-9 && place.z.abs() < 1e-9, "{place}");
    assert!(turn.x.abs() < 1e-9 && turn.y.abs() < 1e-9 && turn.z.abs() > 0.1, "{turn}");
}

/// A motor that moves a box on the floor by a tenth of a gap in a second does so for ever, and so does a spring that is damped as much: friction does
/// not brake them. Where the motor is at its limit the box falls asleep. All this among many bodies, too.
#[test]
fn what_motors_move_slowly_stays_awake() {
    let shape = |shape: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()));
    let (cube, slab) = (shape("box?x=0.5&y=0.5&z=0.5"), shape("box?x=200&y=0.5&z=20"));
    let motor = |speed: f64| Some(Motor::new(MotorTarget::Velocity(speed)));
    let spring = Some(Spring::new(2e4, 1e8, 1.0));
    for (others, motor, spring, moved) in [
        (0, motor(1e-4), None, 3e-4),
        (0, None, spring, 1e-4),
        (0, motor(1.0), None, 0.0),
        (70, motor(1e-4), None, 3e-4),
    ] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let floor = Body::new("floor", Arc::clone(&slab)).with_kind(Kind::Static).with_friction(0.5);
        simulation.add(&floor.with_position(DVec3::Y * -0.5)).unwrap();
        let box_at = |x: f64| Body::new("box", Arc::clone(&cube)).with_position(DVec3::new(x, 0.501, 0.0));
        let pushed = simulation.add(&box_at(0.0)).unwrap();
        for k in 1..=others {
            simulation.add(&box_at(2.0 * f64::from(k))).unwrap();
        }
        let mut slide = Joint::new(JointKind::Prismatic, pushed, None, DVec3::ZERO);
        (slide.motor, slide.spring) = (motor, spring);
        let slide = slide.with_axis(DVec3::X).with_limits([-0.25, 0.25]);
        let slide = simulation.add_joint(&slide).unwrap();
        run(&mut simulation, 4.0);
        let before = simulation.joint_value(slide);
        run(&mut simulation, 7.0);
        let way = (simulation.joint_value(slide) - before).abs();
        assert_eq!(simulation.is_asleep(pushed), moved == 0.0);
        assert!(if moved == 0.0 { way < 1e-9 } else { way > 0.4 * moved }, "{others}: {way}");
    }
}

/// A bar that a motor turns above a box on the floor, on which its joint is: neither sleeps while the other one moves.
#[test]
fn what_joints_connect_sleeps_at_once() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let shape = |shape: &str| Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()));
    let floor = Body::new("floor", shape("box?x=20&y=0.5&z=20")).with_kind(Kind::Static).with_friction(0.5);
    simulation.add(&floor.with_position(DVec3::Y * -0.5)).unwrap();
    let base = Body::new("base", shape("box?x=0.5&y=0.5&z=0.5")).with_position(DVec3::Y * 0.501);
    let base = simulation.add(&base).unwrap();
    let arm = Body::new("arm", shape("box?x=0.3&y=0.05&z=0.05")).with_position(DVec3::new(0.3, 1.2, 0.0));
    let arm = simulation.add(&arm).unwrap();
    let motor = Motor::new(MotorTarget::Velocity(1.0));
    let hinge = Joint::new(JointKind::Revolute, base, Some(arm), DVec3::Y * 1.2).with_axis(DVec3::Y);
    simulation.add_joint(&hinge.with_motor(motor)).unwrap();
    while simulation.time() < 3.0 {
        simulation.step().unwrap();
        assert!(!simulation.is_asleep(base) && !simulation.is_asleep(arm), "{}", simulation.time());
    }
}

/// Five bars that fly freely, and motors without a bound on their force between them: at the limits of the joints they stop, in one flight a step or so,
/// and velocities obey both.
#[test]
fn motors_stop_at_limits_however_strong_they_are() {
    for target in [MotorTarget::Velocity(2.0), MotorTarget::Position(3.0)] {
        for limits in [[-0.5, 0.4], [0.0, 0.0]] {
            let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
            let bars: Vec<BodyId> = (0..5).map(|k| bar(&mut simulation, 1.1 * f64::from(k))).collect();
            let joint = |k: usize| {
                let axis = if k.is_multiple_of(2) { DVec3::Y } else { DVec3::Z };
                let point = DVec3::X * (1.1 * k as f64 - 0.55);
                let hinge =
                    Joint::new(JointKind::Revolute, bars[k - 1], Some(bars[k]), point).with_axis(axis);
                hinge.with_limits(limits).with_motor(Motor::new(target))
            };
            let joints: Vec<usize> = (1..5).map(|k| simulation.add_joint(&joint(k)).unwrap()).collect();
            let mut flights = 0;
            for _ in 0..50 {
                let report = simulation.step().unwrap();
                flights += report.segments.len();
                assert!(report.residual < 0.01, "{target:?}, {limits:?}: {}", report.residual);
                for value in joints.iter().map(|&joint| simulation.joint_value(joint)) {
                    assert!((limits[0] - 1e-4..limits[1] + 1e-4).contains(&value), "{target:?}: {value}");
                }
            }
            let off = |&joint: &usize| (simulation.joint_value(joint) - limits[1]).abs();
            assert!(joints.iter().map(off).all(|off| off < 1e-5));
            assert!(flights < 70, "{target:?}, {limits:?}: {flights}");
        }
    }
}

/// A bar that a motor holds level in the air falls asleep, and falls once the motor is gone, or weaker than its weight.
#[test]
fn what_a_motor_holds_still_sleeps_until_it_lets_go() {
    let weak = || {
        let mut motor = Motor::new(MotorTarget::Velocity(0.0));
        motor.most = 1.0;
        motor
    };
    for motor in [None, Some(weak())] {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let held = bar(&mut simulation, 0.5);
        let hinge = Joint::new(JointKind::Revolute, held, None, DVec3::ZERO).with_axis(DVec3::Z);
        let hinge = hinge.with_motor(Motor::new(MotorTarget::Velocity(0.0)));
        let hinge = simulation.add_joint(&hinge).unwrap();
        run(&mut simulation, 2.0);
        assert!(simulation.is_asleep(held) && simulation.position(held).y.abs() < 1e-6);
        simulation.set_motor(hinge, motor).unwrap();
        run(&mut simulation, 2.2);
        assert!(!simulation.is_asleep(held) && simulation.position(held).y < -0.01);
    }
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let held = bar(&mut simulation, 0.5);
    let hinge = Joint::new(JointKind::Revolute, held, None, DVec3::ZERO).with_axis(DVec3::Z);
    let hinge = simulation.add_joint(&hinge.with_motor(Motor::new(MotorTarget::Velocity(0.0)))).unwrap();
    run(&mut simulation, 2.0);
    assert!(simulation.is_asleep(held));
    simulation.remove_joint(hinge);
    run(&mut simulation, 2.2);
    assert!(simulation.position(held).y < -0.1);
}

/// A head that a motor lowers onto a box, and two that motors press on a box from both sides, without a bound on their force: what is in the way
/// stops them, in a flight a step, without time that is given up, and stays where it is.
#[test]
fn motors_stop_at_what_is_in_their_way_however_strong_they_are() {
    for target in [MotorTarget::Velocity(0.5), MotorTarget::Position(0.7)] {
        for (ways, mass) in
            [(vec![DVec3::Y], 1.0), (vec![DVec3::Y], 1e3), (vec![DVec3::X, DVec3::NEG_X], 1.0)]
        {
            let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
            simulation.add(&floor()).unwrap();
            let body = Body::new("box", tree("box?x=0.2&y=0.2&z=0.2")).with_friction(0.5);
            let pressed = simulation.add(&body.clone().with_position(DVec3::Y * 0.201)).unwrap();
            let mut heads = Vec::new();
            for &way in &ways {
                let place = DVec3::Y * 0.25 + way * 0.8;
                let head = body.clone().with_position(place).with_mass(Mass::Total(64.0 * mass));
                let id = simulation.add(&head).unwrap();
                let slide = Joint::new(JointKind::Prismatic, id, None, place).with_axis(way);
                simulation.add_joint(&slide.with_motor(Motor::new(target))).unwrap();
                heads.push((id, way));
            }
            let mut flights = 0;
            while simulation.time() < 1.5 {
                let report = simulation.step().unwrap();
                assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
                flights += report.segments.len();
            }
            assert!(flights < 200, "{target:?} {ways:?} {mass}: {flights}");
            let stayed = simulation.position(pressed);
            assert!((stayed - DVec3::Y * 0.201).length() < 3e-3, "{target:?} {ways:?} {mass}: {stayed}");
            for (head, way) in heads {
                let apart = (simulation.position(head) - stayed).dot(way);
                assert!((apart - 0.401).abs() < 2e-3, "{target:?} {ways:?} {mass}: {apart}");
            }
        }
    }
}
