//! No energy is gained, measured at the middles of the reported flights by nothing but their numbers and the masses.

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, BodyId, Kind, Mass, Segment, Simulation, SimulationOptions};
use d2m_motion::{ConstantTwist, RigidMotion};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

fn tree(shape: &str) -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()))
}

/// What the segments say of the energy.
struct Energy {
    /// The greatest rise above a value before.
    rise: f64,
    /// The greatest kinetic energy.
    kinetic: f64,
    events: u32,
}

fn run(simulation: &mut Simulation, ids: &[BodyId], end: f64) -> Energy {
    let mut segments: Vec<Segment> = Vec::new();
    let mut events = 0;
    while simulation.time() < end {
        let report = simulation.step().unwrap();
        events += report.events;
        segments.extend(report.segments);
    }
    segments.extend(simulation.finish());
    let gravity = simulation.options().gravity;
    let mut flights = vec![ConstantTwist::REST; ids.len()];
    let mut energy = Energy { rise: 0.0, kinetic: 0.0, events };
    let mut least = f64::INFINITY;
    for segment in &segments {
        assert_eq!(segment.skipped, 0.0);
        for (id, flight) in &segment.changed {
            flights[id.index()] = *flight;
        }
        let middle = 0.5 * (segment.start + segment.end);
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for &id in ids {
            let Some(p) = simulation.mass_properties(id) else { continue };
            let (pose, twist) = flights[id.index()].pose_and_twist(middle);
            let spin = DMat3::from_quat(pose.rotation).transpose() * twist.angular;
            kinetic += 0.5 * (p.mass * twist.linear.length_squared() + spin.dot(p.inertia * spin));
            potential -= p.mass * gravity.dot(pose.translation);
        }
        energy.kinetic = energy.kinetic.max(kinetic);
        least = least.min(kinetic + potential);
        energy.rise = energy.rise.max(kinetic + potential - least);
    }
    energy
}

/// Links meet in the middles of steps while all of them fall: flights that events cut must not keep the velocities of
/// longer ones.
#[test]
fn a_falling_chain_gains_none() {
    let link = tree("torus?triangles=400&tube=0.15");
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let mut ids = Vec::new();
    for k in 0..4 {
        let turn = DQuat::from_rotation_x(f64::from(k % 2) * core::f64::consts::FRAC_PI_2);
        let body = Body::new(format!("link {k}"), Arc::clone(&link))
            .with_position(DVec3::X * 1.2 * f64::from(k))
            .with_orientation(turn);
        let body = if k == 0 { body.with_kind(Kind::Static) } else { body };
        ids.push(simulation.add(&body).unwrap());
    }
    let energy = run(&mut simulation, &ids, 3.0);
    assert!(energy.rise <= energy.kinetic / 128.0, "{} of {}", energy.rise, energy.kinetic);
}

/// Cards that fall over meet each other and the floor in the middles of steps.
#[test]
fn bodies_that_lean_on_each_other_gain_none() {
    let card = tree("box?x=0.5&y=0.02&z=0.3");
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let floor = Body::new("floor", tree("box?x=10&y=0.5&z=10")).with_kind(Kind::Static);
    let mut ids = vec![simulation.add(&floor.with_position(DVec3::Y * -0.5).with_friction(0.3)).unwrap()];
    for k in 0..6 {
        let side = if k % 2 == 0 { -1.0 } else { 1.0 };
        let body = Body::new(format!("card {k}"), Arc::clone(&card))
            .with_position(DVec3::new(0.3 * side + 2.0 * f64::from(k / 2), 0.6 + 0.1 * f64::from(k / 2), 0.0))
            .with_orientation(DQuat::from_rotation_z(-1.1 * side))
            .with_friction(0.3);
        ids.push(simulation.add(&body).unwrap());
    }
    let energy = run(&mut simulation, &ids, 2.0);
    assert!(energy.rise <= energy.kinetic / 128.0, "{} of {}", energy.rise, energy.kinetic);
}

/// Boxes that fall on each other: each step solves the contacts that its flights lead to, so hardly any flight is cut. Without
/// this the boxes meet in 40 events, and each of them cuts the flights of all in the reported segments.
#[test]
fn a_pile_without_restitution_meets_no_events_and_gains_none() {
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let mut simulation = Simulation::new(SimulationOptions::default().with_step(1.0 / 64.0)).unwrap();
    let floor = Body::new("floor", tree("box?x=10&y=0.5&z=10")).with_kind(Kind::Static);
    let mut ids = vec![simulation.add(&floor.with_position(DVec3::Y * -0.5).with_friction(0.5)).unwrap()];
    for k in 0..12 {
        let turn = DQuat::from_xyzw(0.3 * f64::from(k % 5), 0.2 * f64::from(k % 7), 0.1, 1.0).normalize();
        let place = DVec3::new(0.3 * f64::from(k % 3), 1.0 + 1.8 * f64::from(k / 2), 1.9 * f64::from(k % 2));
        let body = Body::new(format!("box {k}"), Arc::clone(&cube)).with_friction(0.5);
        ids.push(simulation.add(&body.with_position(place).with_orientation(turn)).unwrap());
    }
    let energy = run(&mut simulation, &ids, 1.5);
    assert!(energy.events <= 4, "{} events", energy.events);
    assert!(energy.rise <= energy.kinetic / 1024.0, "{} of {}", energy.rise, energy.kinetic);
}

/// Bodies of all shapes, masses, restitutions and frictions, thrown at each other, with gravity and a floor or without both.
#[test]
fn whatever_meets_gains_none() {
    let shapes = [
        "box?x=0.3&y=0.5&z=0.2",
        "torus?triangles=200&scale=0.4",
        "icosphere?triangles=80&scale=0.4",
        "box?x=0.1&y=0.9&z=0.1",
    ];
    let trees = shapes.map(tree);
    let mut state = 7u64;
    let mut random = move || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    for trial in 0..8 {
        let falls = trial % 4 != 3;
        let gravity = if falls { DVec3::Y * -9.81 } else { DVec3::ZERO };
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(gravity)).unwrap();
        let mut ids = Vec::new();
        if falls {
            let floor = Body::new("floor", tree("box?x=10&y=0.5&z=10")).with_kind(Kind::Static);
            let floor = floor.with_position(DVec3::Y * -0.5).with_friction(0.3 * f64::from(trial));
            ids.push(simulation.add(&floor).unwrap());
        }
        for k in 0..8 {
            let mut turn = || 2.0 * random() - 1.0;
            let place =
                DVec3::new(2.2 * f64::from(k % 2), 1.5 + 2.2 * f64::from(k / 4), 2.2 * f64::from(k / 2 % 2));
            let spin = DVec3::new(turn(), turn(), turn()) * 4.0;
            let velocity = DVec3::new(1.1, 2.2, 1.1) - place + DVec3::new(turn(), turn(), turn());
            let orientation = DQuat::from_xyzw(turn(), turn(), turn(), 1.1).normalize();
            let body = Body::new(format!("{trial}, {k}"), Arc::clone(&trees[k as usize % 4]))
                .with_position(place)
                .with_orientation(orientation)
                .with_linear_velocity(velocity)
                .with_angular_velocity(spin)
                .with_mass(Mass::Density(1000.0 * 8f64.powf(turn())))
                .with_restitution([0.0, 0.5, 1.0][trial as usize % 3])
                .with_friction(random());
            ids.push(simulation.add(&body).unwrap());
        }
        let energy = run(&mut simulation, &ids, 1.5);
        assert!(energy.rise <= energy.kinetic / 128.0, "{trial}: {} of {}", energy.rise, energy.kinetic);
    }
}

/// Needles that strike a floor. Of their angular momentum, which is mostly across them, an error of where they point makes a spin about
/// their axis that is as much larger as they are thin.
#[test]
fn needles_gain_none() {
    for (trial, thick) in (0usize..40).map(|trial| (trial, [1e-2, 1e-3, 1e-4, 3e-5][trial % 4])) {
        let mut state = 11 + trial as u64;
        let mut random = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let gap = 0.2 * f64::min(thick, 1e-3);
        let mut simulation = Simulation::new(SimulationOptions::default().with_gap(gap)).unwrap();
        let friction = [0.0, 0.4, 1.0][trial % 3];
        let floor = Body::new("floor", tree("box?x=20&y=1&z=20")).with_kind(Kind::Static);
        let floor = floor.with_position(-DVec3::Y).with_friction(friction);
        let turn = DQuat::from_xyzw(random(), random(), random(), random()).normalize();
        let lowest = DMat3::from_quat(turn).transpose().y_axis.abs().dot(DVec3::new(1.0, thick, thick));
        let needle = Body::new("needle", tree(&format!("box?x=1&y={thick}&z={thick}")))
            .with_position(DVec3::Y * (lowest + 0.05))
            .with_orientation(turn)
            .with_linear_velocity(DVec3::Y * -12.0)
            .with_friction(friction);
        let ids = [floor, needle].map(|body| simulation.add(&body).unwrap());
        let energy = run(&mut simulation, &ids, 0.05);
        assert!(energy.rise <= energy.kinetic / 128.0, "{trial}: {} of {}", energy.rise, energy.kinetic);
    }
}

/// What two of many bodies do ends no flights of the others: they fall on as they did.
#[test]
fn what_two_of_a_crowd_do_leaves_the_others_in_flight() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    for k in 0..70 {
        let place = DVec3::new(f64::from(k % 10), 0.0, f64::from(k / 10)) * 5.0;
        simulation.add(&Body::new(format!("{k}"), Arc::clone(&cube)).with_position(place)).unwrap();
    }
    let thrown = Body::new("thrown", cube).with_position(DVec3::X * 2.1).with_restitution(1.0);
    simulation.add(&thrown.with_linear_velocity(DVec3::X * 20.0)).unwrap();
    let (mut met, mut starts, mut segments) = (0, Vec::new(), Vec::new());
    while simulation.time() < 0.2 {
        starts.push(simulation.time());
        let report = simulation.step().unwrap();
        met += report.events;
        segments.extend(report.segments);
    }
    segments.extend(simulation.finish());
    let within = segments.iter().filter(|segment| !starts.contains(&segment.start));
    let changed: Vec<usize> = within.map(|segment| segment.changed.len()).collect();
    assert!(met > 0 && changed.contains(&2) && changed.iter().all(|&count| count <= 2), "{met} {changed:?}");
}

/// What bounces to and fro in the same body, many times a step, has all of the gap for each of its bounces, as if it met something else each time.
#[test]
fn what_rattles_in_a_body_keeps_its_energy_and_its_room() {
    let mut simulation =
        Simulation::new(SimulationOptions::default().with_gap(1e-4).with_gravity(DVec3::ZERO)).unwrap();
    let hollow = Body::new("hollow", tree("hollow-box?wall=0.1&scale=1.7320508")).with_restitution(1.0);
    simulation.add(&hollow.with_kind(Kind::Static)).unwrap();
    let cube = Body::new("cube", tree("box?x=0.895&y=0.895&z=0.895")).with_restitution(1.0);
    let cube = simulation.add(&cube.with_linear_velocity(DVec3::new(40.0, 0.0, 0.0))).unwrap();
    let mut bounces = 0;
    while simulation.time() < 0.05 {
        let report = simulation.step().unwrap();
        assert!(report.segments.iter().all(|segment| segment.skipped == 0.0));
        bounces += report.events;
    }
    assert!(bounces > 190, "{bounces}");
    assert!((simulation.linear_velocity(cube).length() / 40.0 - 1.0).abs() < 1e-9);
}

/// A heavy cube falls onto a light one that lies on the floor: it comes up again as from the floor, at every ratio of masses.
#[test]
fn what_falls_on_something_light_bounces_as_on_what_that_lies_on() {
    for ratio in [1e3, 1e6, 1e8] {
        for restitution in [0.8, 1.0] {
            let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
            let shape = tree("box?x=0.5&y=0.5&z=0.5");
            let floor = Body::new("floor", tree("box?x=20&y=0.5&z=20")).with_kind(Kind::Static);
            simulation.add(&floor.with_position(DVec3::Y * -0.5)).unwrap();
            let cube = |y: f64, mass: f64| {
                let body = Body::new("cube", Arc::clone(&shape)).with_mass(Mass::Total(mass));
                body.with_position(DVec3::Y * y).with_restitution(restitution)
            };
            let light = simulation.add(&cube(0.501, 1.0)).unwrap();
            let heavy = simulation.add(&cube(2.502, ratio)).unwrap();
            let mut highest = 0.0f64;
            let falls = (2.0f64 / 9.81).sqrt();
            while simulation.time() < falls * (1.0 + restitution) + 0.02 {
                let _ = simulation.step().unwrap();
                if simulation.time() > falls + 0.1 {
                    highest = highest.max(simulation.position(heavy).y);
                }
            }
            let expected = 1.502 + restitution * restitution;
            assert!((highest - expected).abs() < 5e-3, "{ratio:e} {restitution}: {highest}, not {expected}");
            assert!(simulation.position(light).y < 1.0 + highest);
        }
    }
}
