//! Scenes with what must happen, and the promise: nothing ever meets.

mod ground;

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, BodyId, Kind, Segment, Simulation, SimulationOptions};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use ground::judge;
use std::sync::Arc;

fn tree(shape: &str) -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh(shape).unwrap()))
}

fn cube() -> Arc<MeshTree> {
    tree("box?x=0.5&y=0.5&z=0.5")
}

fn floor() -> Body {
    Body::new("floor", tree("box?x=10&y=0.5&z=10")).with_kind(Kind::Static).with_position(DVec3::Y * -0.5)
}

/// Runs until `end` and returns all segments.
fn run(simulation: &mut Simulation, end: f64) -> Vec<Segment> {
    let mut segments = Vec::new();
    while simulation.time() < end - 1e-9 {
        segments.extend(simulation.step().unwrap().segments);
    }
    segments.extend(simulation.finish());
    segments
}

#[test]
fn a_tumbling_pile_never_intersects_and_comes_to_rest() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let (block, ring) = (cube(), tree("torus?triangles=400"));
    let mut trees = vec![tree("box?x=10&y=0.5&z=10")];
    simulation.add(&floor().with_friction(0.5)).unwrap();
    for k in 0..6 {
        let shape = if k % 2 == 0 { &block } else { &ring };
        let height = 1.5 + 1.7 * f64::from(k);
        let turn = DQuat::from_xyzw(0.3 * f64::from(k), 0.2, -0.1, 1.0);
        let body = Body::new(format!("body {k}"), Arc::clone(shape)).with_position(DVec3::Y * height);
        let body = body.with_orientation(turn).with_friction(0.5).with_angular_velocity(DVec3::X * 2.0);
        simulation.add(&body).unwrap();
        trees.push(Arc::clone(shape));
    }
    let segments = run(&mut simulation, 2.5);
    assert!(segments.iter().all(|s| s.skipped == 0.0));
    judge(&segments, &trees);
}

/// Velocities are exchanged, energy and momentum kept.
#[test]
fn head_on() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO);
    let mut simulation = Simulation::new(options).unwrap();
    let shape = cube();
    let body = |x: f64, v: f64| {
        Body::new(format!("{x}"), Arc::clone(&shape))
            .with_position(DVec3::X * x)
            .with_linear_velocity(DVec3::X * v)
            .with_restitution(1.0)
    };
    let a = simulation.add(&body(-2.0, 2.0)).unwrap();
    let b = simulation.add(&body(2.0, -1.0)).unwrap();
    let segments = run(&mut simulation, 2.0);
    assert!((simulation.linear_velocity(a) - DVec3::NEG_X).length() < 1e-9);
    assert!((simulation.linear_velocity(b) - DVec3::X * 2.0).length() < 1e-9);
    judge(&segments, &[Arc::clone(&shape), shape]);
}

/// A stack of ten boxes stands, and sleeps.
#[test]
fn a_stack_stands() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor().with_friction(0.5)).unwrap();
    let shape = cube();
    let ids: Vec<BodyId> = (0..10)
        .map(|k| {
            let body = Body::new(format!("box {k}"), Arc::clone(&shape)).with_friction(0.5);
            simulation.add(&body.with_position(DVec3::Y * (0.501 + 1.001 * f64::from(k)))).unwrap()
        })
        .collect();
    let before: Vec<DVec3> = ids.iter().map(|&id| simulation.position(id)).collect();
    run(&mut simulation, 3.0);
    for (id, start) in ids.iter().zip(before) {
        assert!((simulation.position(*id) - start).length() < 1e-3);
        assert!(simulation.is_asleep(*id));
    }
}

/// What goes to sleep stands still in the segments, too, and is where they have it when it wakes: a ring that has come to rest, and a block that
/// friction hardly brakes, which creeps until then.
#[test]
fn segments_join_where_bodies_sleep_and_wake() {
    let (block, ring) = (cube(), tree("torus?triangles=400"));
    let turn = DQuat::from_xyzw(0.4, 0.1, 0.05, 1.0);
    let drops = Body::new("rests", Arc::clone(&ring)).with_position(DVec3::Y * 1.2);
    let creeps = Body::new("rests", Arc::clone(&block)).with_position(DVec3::Y * 0.501);
    let scenes = [
        (drops.with_orientation(turn), &ring, 0.5),
        (creeps.with_linear_velocity(DVec3::X * 1e-4), &block, 1e-12),
    ];
    for (rests, shape, friction) in scenes {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&floor().with_friction(friction)).unwrap();
        let rests = simulation.add(&rests.with_friction(friction)).unwrap();
        let falls = Body::new("falls", Arc::clone(&block)).with_position(DVec3::new(0.3, 150.0, 0.1));
        simulation.add(&falls.with_friction(0.5)).unwrap();
        let mut slept = false;
        let mut segments = Vec::new();
        while simulation.time() < 6.0 {
            segments.extend(simulation.step().unwrap().segments);
            slept |= simulation.is_asleep(rests);
        }
        segments.extend(simulation.finish());
        assert!(slept && !simulation.is_asleep(rests));
        judge(&segments, &[tree("box?x=10&y=0.5&z=10"), Arc::clone(shape), Arc::clone(&block)]);
    }
}

/// 100 m a step against a plate of a millimeter.
#[test]
fn a_bullet_stops_at_a_plate() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_gap(1e-4);
    let mut simulation = Simulation::new(options).unwrap();
    let (plate, bullet) = (tree("box?x=0.0005&y=1&z=1"), tree("box?x=0.005&y=0.005&z=0.005"));
    simulation.add(&Body::new("plate", Arc::clone(&plate)).with_kind(Kind::Static)).unwrap();
    let shot = Body::new("bullet", Arc::clone(&bullet)).with_position(DVec3::new(-12.34, 0.1, 0.05));
    let id = simulation.add(&shot.with_linear_velocity(DVec3::X * 10_000.0)).unwrap();
    let segments = run(&mut simulation, 0.1);
    let x = simulation.position(id).x;
    assert!(-0.0056 - 1e-4 < x && x < -0.0055, "{x}");
    judge(&segments, &[plate, bullet]);
}

/// The momentum of a body that tumbles about its middle axis is that of each flight's middle.
#[test]
fn tumbling_keeps_angular_momentum_and_energy() {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(0.01);
    let mut simulation = Simulation::new(options).unwrap();
    let brick = Body::new("brick", tree("box?x=0.5&y=1&z=1.5"));
    let id = simulation.add(&brick.with_angular_velocity(DVec3::new(0.1, 8.0, 0.0))).unwrap();
    let p = simulation.mass_properties(id).unwrap();
    let before = simulation.angular_momentum(id);
    let mut energies = Vec::new();
    for segment in run(&mut simulation, 4.0).iter().skip(1) {
        let flight = segment.changed[0].1;
        let middle = flight.rebase(0.5 * (segment.start + segment.end));
        let r = glam::DMat3::from_quat(middle.orientation());
        let (w, inertia) = (flight.angular_velocity(), r * p.inertia * r.transpose());
        assert!((inertia * w - before).length() < 1e-11 * before.length());
        energies.push(0.5 * w.dot(inertia * w));
    }
    let (low, high) = energies.iter().fold((f64::INFINITY, 0.0f64), |(l, h), &e| (l.min(e), h.max(e)));
    assert!(high / low - 1.0 < 1e-3, "{low} {high}");
}

#[test]
fn the_same_bits_at_any_number_of_threads_and_after_a_snapshot() {
    let build = || {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&floor().with_friction(0.4)).unwrap();
        let shape = cube();
        for k in 0..12 {
            let place =
                DVec3::new(0.3 * f64::from(k % 3), 0.8 + 1.2 * f64::from(k / 3), 0.2 * f64::from(k % 2));
            let place = place + DVec3::X * 1.2 * f64::from(k % 3);
            let body = Body::new(format!("{k}"), Arc::clone(&shape)).with_position(place).with_friction(0.4);
            simulation.add(&body.with_restitution(0.3)).unwrap();
        }
        simulation
    };
    let threads = |count: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build().unwrap();
        pool.install(|| run(&mut build(), 1.0))
    };
    let one = threads(1);
    assert_eq!(one, threads(2));
    let mut simulation = build();
    run(&mut simulation, 0.5);
    let snapshot = simulation.snapshot();
    let first = run(&mut simulation, 1.0);
    let mut other = build();
    other.restore(&snapshot).unwrap();
    let second = run(&mut other, 1.0);
    assert_eq!(first.last().unwrap().changed, second.last().unwrap().changed);
    assert_eq!(simulation.snapshot(), other.snapshot());
}

#[test]
fn intersecting_starts_and_crushing_are_named() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let shape = cube();
    simulation.add(&Body::new("one", Arc::clone(&shape))).unwrap();
    simulation.add(&Body::new("two", Arc::clone(&shape)).with_position(DVec3::X * 0.9)).unwrap();
    let message = simulation.step().unwrap_err().to_string();
    assert!(message.starts_with("bodies one and two intersect at the start: by about 1.0"), "{message}");

    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let wall = |name: &str, x: f64| Body::new(name, Arc::clone(&shape)).with_position(DVec3::X * x);
    simulation.add(&wall("wall", 1.5).with_kind(Kind::Static)).unwrap();
    simulation.add(&wall("nut", 0.0)).unwrap();
    let press = ConstantTwist::REST.with_position(DVec3::X * -1.5).with_linear_velocity(DVec3::X * 2.0);
    simulation.add(&wall("press", 0.0).with_kind(Kind::Kinematic(Arc::new(press)))).unwrap();
    let error = (0..1000).find_map(|_| simulation.step().err()).expect("the press closes");
    assert!(error.to_string().contains("press") && error.to_string().contains("nut"), "{error}");
    assert!(simulation.time() < 1.0 && !simulation.finish().is_empty());
}

/// Without friction the least push sideways, or about the vertical, would let cubes slide off that fall flat on each other.
#[test]
fn cubes_without_friction_fall_flat_and_stack() {
    let gravity = DVec3::Y * -9.8;
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(gravity)).unwrap();
    let mut cubes = Vec::new();
    for k in 0..5 {
        let body =
            Body::new(format!("cube {k}"), cube()).with_position(DVec3::Y * (1.5 + 2.0 * f64::from(k)));
        cubes.push(simulation.add(&body).unwrap());
    }
    simulation.add(&floor()).unwrap();
    run(&mut simulation, 4.0);
    for (k, &id) in cubes.iter().enumerate() {
        let place = simulation.position(id);
        assert!(place.x.abs().max(place.z.abs()) < 1e-3, "{k}: {place}");
        assert!((place.y - 0.5 - k as f64).abs() < 0.03, "{k}: {place}");
    }
}

/// A hundredth of the gap between them, they keep what they have, and stand.
#[test]
fn boxes_that_start_closer_than_the_gap_stand() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor().with_friction(0.5)).unwrap();
    let (block, apart) = (cube(), 1e-5);
    for k in 0..5 {
        let place = DVec3::Y * (0.5 + apart + (1.0 + apart) * f64::from(k));
        let body = Body::new(format!("{k}"), Arc::clone(&block)).with_position(place).with_friction(0.5);
        simulation.add(&body).unwrap();
    }
    let starts: Vec<DVec3> = simulation.ids().map(|id| simulation.position(id)).collect();
    let segments = run(&mut simulation, 1.0);
    for (id, start) in simulation.ids().zip(starts) {
        assert!((simulation.position(id) - start).length() < 1e-3);
    }
    let mut trees = vec![block; 6];
    trees[0] = tree("box?x=10&y=0.5&z=10");
    judge(&segments, &trees);
}

/// Bodies that follow their motions may pass through each other; what they carry does not.
#[test]
fn bodies_that_follow_their_motions_cross() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let (bar, load) = (tree("box?x=1&y=0.2&z=0.2"), tree("box?x=0.2&y=0.2&z=0.2"));
    for (name, y, side) in [("one", 0.0, -1.0), ("other", 0.05, 1.0)] {
        let motion = ConstantTwist::REST
            .with_position(DVec3::new(2.0 * side, y, 0.0))
            .with_linear_velocity(DVec3::NEG_X * side);
        let body = Body::new(name, Arc::clone(&bar)).with_kind(Kind::Kinematic(Arc::new(motion)));
        simulation.add(&body.with_friction(0.3)).unwrap();
    }
    let place = DVec3::new(-2.0, 0.41, 0.0);
    let carried =
        simulation.add(&Body::new("carried", Arc::clone(&load)).with_position(place).with_friction(0.6));
    let carried = carried.unwrap();
    let segments = run(&mut simulation, 0.9);
    assert!((simulation.linear_velocity(carried) - DVec3::X).length() < 1e-3);
    judge(&segments, &[Arc::clone(&bar), bar, load]);
    let _ = run(&mut simulation, 2.5);
    assert!(simulation.position(carried).is_finite());
}
