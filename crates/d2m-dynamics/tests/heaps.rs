//! Heaps of which parts sleep while others move: what sleeps bears what touches it, and wakes where that changes.

mod ground;

use d2m_bvh::MeshTree;
use d2m_dynamics::{Body, BodyId, Kind, Mass, Segment, Simulation, SimulationOptions};
use d2m_motion::Pose;
use glam::{DQuat, DVec3};
use ground::{judge_from, tree};
use std::sync::Arc;

const MANY: usize = 260;
/// Of a slab and what lies on it.
const FRICTION: f64 = 0.2;

/// Of density one.
fn body(name: &'static str, shape: &Arc<MeshTree>, friction: f64, position: DVec3) -> Body {
    let body = Body::new(name, Arc::clone(shape)).with_mass(Mass::Density(1.0));
    body.with_friction(friction).with_position(position)
}

fn simulation_on(friction: f64) -> Simulation {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let floor = Body::new("floor", tree("box?x=300&y=0.5&z=30"))
        .with_kind(Kind::Static)
        .with_friction(friction)
        .with_position(DVec3::NEG_Y * 0.5);
    simulation.add(&floor).unwrap();
    simulation
}

/// A slab on the floor, and small boxes on it.
fn laden_slab() -> (Simulation, BodyId, Vec<BodyId>) {
    let mut simulation = simulation_on(0.5);
    let slab = body("slab", &tree("box?x=20&y=0.1&z=20"), FRICTION, DVec3::Y * 0.101);
    let slab = simulation.add(&slab).unwrap();
    let small = tree("box?x=0.25&y=0.25&z=0.25");
    let place = |k: usize| DVec3::new(2.0 * (k / 17) as f64 - 16.0, 0.452, 2.0 * (k % 17) as f64 - 16.0);
    let boxes = (0..MANY).map(|k| simulation.add(&body("box", &small, FRICTION, place(k))).unwrap());
    let boxes = boxes.collect();
    (simulation, slab, boxes)
}

/// A step in which the first box is pushed to and fro, harder than friction holds it.
fn push(simulation: &mut Simulation, boxes: &[BodyId], step: usize) -> Vec<Segment> {
    let way = if (step / 4).is_multiple_of(2) { 1.0 } else { -1.0 };
    simulation.set_force(boxes[0], DVec3::X * (way * 4.0 * 0.125 * 9.81), DVec3::ZERO).unwrap();
    simulation.step().unwrap().segments
}

fn asleep(simulation: &Simulation, of: &[BodyId]) -> usize {
    of.iter().filter(|&&body| simulation.is_asleep(body)).count()
}

/// One box that moves keeps itself awake and the slab that it slides on, and none of the others on that.
#[test]
fn what_rests_sleeps_beside_what_moves() {
    let (mut simulation, slab, boxes) = laden_slab();
    for step in 0..150 {
        push(&mut simulation, &boxes, step);
    }
    assert!(asleep(&simulation, &boxes) == MANY - 1, "{}", asleep(&simulation, &boxes));
    assert!(!simulation.is_asleep(boxes[0]) && !simulation.is_asleep(slab));
    // What sleeps is part of a snapshot with what it bears.
    let snapshot = simulation.snapshot();
    let run = |simulation: &mut Simulation| {
        for step in 0..40 {
            push(simulation, &boxes, step);
        }
        boxes.iter().map(|&body| simulation.position(body)).collect::<Vec<_>>()
    };
    let first = run(&mut simulation);
    simulation.restore(&snapshot).unwrap();
    assert_eq!(simulation.snapshot(), snapshot);
    assert_eq!(run(&mut simulation), first);
}

/// A push that lifts the slab lifts what sleeps on it in the same step, and with all of the momentum.
#[test]
fn what_is_hit_from_below_moves_at_once() {
    let (mut simulation, slab, boxes) = laden_slab();
    for step in 0..150 {
        push(&mut simulation, &boxes, step);
    }

    let (mass, small) = (40.0 * 40.0 * 0.2, 0.125);
    let all = mass + small * MANY as f64;
    simulation.apply_impulse_at(slab, DVec3::Y * (2.0 * all), simulation.position(slab)).unwrap();
    simulation.step().unwrap();
    assert_eq!(asleep(&simulation, &boxes), 0);
    let up = |body: BodyId| simulation.linear_velocity(body).y;
    let momentum = mass * up(slab) + boxes.iter().map(|&body| small * up(body)).sum::<f64>();
    // Less what gravity takes in a step.
    let (most, taken) = (2.0 * all, all * 9.81 * simulation.options().step);
    assert!(momentum < most && momentum > most - taken, "{momentum} of {most}, {taken}");
}

/// What sleeps, what moves beside it, and what is hit and wakes: none of them meet.
#[test]
fn nothing_meets_where_parts_sleep() {
    let (mut simulation, slab, boxes) = laden_slab();
    let mut trees = vec![tree("box?x=300&y=0.5&z=30"), tree("box?x=20&y=0.1&z=20")];
    let small = tree("box?x=0.25&y=0.25&z=0.25");
    trees.extend(boxes.iter().map(|_| Arc::clone(&small)));
    let (mut segments, mut begin) = (Vec::new(), f64::INFINITY);
    for step in 0..150 {
        if step == 130 {
            assert!(asleep(&simulation, &boxes) > MANY / 2);
            begin = simulation.time() - 0.05;
            let push = DVec3::new(0.1, 0.5, 0.0) * (40.0 * 40.0 * 0.2);
            simulation.apply_impulse(slab, push, DVec3::ZERO).unwrap();
        }
        segments.extend(push(&mut simulation, &boxes, step));
    }
    segments.extend(simulation.finish());
    judge_from(begin, &segments, &trees);
}

/// A slab that is slow does next to nothing to what sleeps on it, and carries it all the same.
#[test]
fn what_lies_on_what_moves_is_carried() {
    let (mut simulation, slab, boxes) = laden_slab();
    let floor = simulation.ids().next().unwrap();
    simulation.set_pair(floor, slab, 0.01, 0.0).unwrap();
    while asleep(&simulation, &boxes) < MANY {
        assert!(simulation.time() < 5.0);
        simulation.step().unwrap();
    }
    let (speed, mass) = (0.05, 40.0 * 40.0 * 0.2);
    simulation.apply_impulse(slab, DVec3::X * (speed * mass), DVec3::ZERO).unwrap();
    for _ in 0..10 {
        simulation.step().unwrap();
    }
    let carried = simulation.linear_velocity(slab).x;
    assert!(carried > 0.5 * speed, "{carried}");
    let off = boxes.iter().map(|&body| (simulation.linear_velocity(body).x - carried).abs());
    let off = off.fold(0.0, f64::max);
    assert!(off < 0.1 * speed, "{off}");
}

/// A row of boxes that sleep on a floor that is nearly ice is hit from one end: none of the momentum is lost but what friction takes.
#[test]
fn hits_on_what_sleeps_lose_no_momentum() {
    let friction = 1e-4;
    let mut simulation = simulation_on(friction);
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let place = |k: usize| DVec3::new(1.001 * k as f64, 0.501, 0.0);
    let row = (0..MANY).map(|k| simulation.add(&body("box", &cube, friction, place(k))).unwrap());
    let row: Vec<BodyId> = row.collect();
    while asleep(&simulation, &row) < MANY {
        assert!(simulation.time() < 5.0);
        simulation.step().unwrap();
    }
    let speed = 3.0;
    let hits = body("hits", &cube, friction, DVec3::new(-1.02, 0.501, 0.0));
    let hits = simulation.add(&hits.with_linear_velocity(DVec3::X * speed)).unwrap();
    for step in 1..=10 {
        simulation.step().unwrap();
        let along = |body: BodyId| simulation.linear_velocity(body).x;
        let momentum = along(hits) + row.iter().map(|&body| along(body)).sum::<f64>();
        let taken = friction * 9.81 * (MANY + 1) as f64 * simulation.options().step * step as f64;
        assert!(momentum < speed + 1e-9 && momentum > speed - 2.0 * taken, "{momentum} of {speed}, {taken}");
    }
    assert!(simulation.linear_velocity(hits).x < 0.5 * speed);
}

/// A table of which one leg is pulled away tips over, though it sleeps, as do its other legs.
#[test]
fn what_loses_its_support_tips_over() {
    let mut simulation = simulation_on(0.5);
    let leg = tree("box?x=0.15&y=0.5&z=0.15");
    let legs = [DVec3::new(-2.0, 0.501, -1.0), DVec3::new(-2.0, 0.501, 1.0), DVec3::new(2.0, 0.501, 0.0)]
        .map(|place| simulation.add(&body("leg", &leg, 0.5, place)).unwrap());
    let top = body("top", &tree("box?x=2.5&y=0.1&z=1.5"), 0.5, DVec3::Y * 1.102);
    let top = simulation.add(&top).unwrap();
    let place = |k: usize| DVec3::new(k as f64 - 130.0, 0.501, 10.0);
    let others = (0..MANY).map(|k| simulation.add(&body("other", &leg, 0.5, place(k))).unwrap());
    let others: Vec<BodyId> = others.collect();
    while !simulation.is_asleep(top) || asleep(&simulation, &others) < MANY {
        assert!(simulation.time() < 5.0);
        simulation.step().unwrap();
    }
    // Half of the top rests on it, and its own weight: friction holds half of that above it and below.
    let weight = |mass: f64| 9.81 * mass;
    let held = 0.5 * (2.0 * weight(3.0 / 2.0) + weight(0.09));
    for _ in 0..200 {
        simulation.set_force(legs[2], DVec3::X * (1.1 * held), DVec3::ZERO).unwrap();
        simulation.step().unwrap();
    }
    let upright = (simulation.orientation(top) * DVec3::Y).y;
    assert!(upright < 0.99 && simulation.position(top).y < 0.9, "{upright}");
    assert_eq!(asleep(&simulation, &others), MANY);
}

/// A row of boxes that sleep on a slippery floor is pushed from one end, by less than counts in a step and by twice of what friction holds. What each
/// takes of it until it wakes adds up to less than a fifth of a second.
#[test]
fn what_is_pushed_little_by_little_moves() {
    let friction = 0.05;
    let mut simulation = simulation_on(friction);
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let put = |simulation: &mut Simulation, friction: f64, x: f64, z: f64| {
        simulation.add(&body("box", &cube, friction, DVec3::new(x, 0.501, z))).unwrap()
    };
    let row: Vec<BodyId> = (0..5).map(|k| put(&mut simulation, friction, 1.001 * k as f64, 0.0)).collect();
    let others: Vec<BodyId> =
        (0..MANY).map(|k| put(&mut simulation, 0.5, 2.0 * k as f64 - 260.0, 10.0)).collect();
    for between in row.windows(2) {
        simulation.set_pair(between[0], between[1], 0.0, 0.0).unwrap();
    }
    while asleep(&simulation, &row) < row.len() || asleep(&simulation, &others) < MANY {
        assert!(simulation.time() < 5.0);
        simulation.step().unwrap();
    }
    let (weight, begin) = (9.81, simulation.time());
    while simulation.time() < begin + 2.0 {
        simulation.set_force(row[0], DVec3::X * (0.5 * weight), DVec3::ZERO).unwrap();
        simulation.step().unwrap();
    }
    let acceleration = (0.5 - 5.0 * friction) * weight / 5.0;
    let way = |time: f64| 0.5 * acceleration * time * time;
    let came = simulation.position(row[4]).x - 4.004;
    assert!(came > way(1.8) && came < way(2.0), "{came} of {}", way(2.0));
    assert_eq!(asleep(&simulation, &others), MANY);
}

/// A stack that sleeps on a shelf of this kind, beside others that sleep.
fn laden_shelf(kind: Kind) -> (Simulation, BodyId, Vec<BodyId>, Vec<BodyId>) {
    let mut simulation = simulation_on(0.5);
    let shelf = body("shelf", &tree("box?x=1&y=0.1&z=1"), 0.5, DVec3::Y * 10.0).with_kind(kind);
    let shelf = simulation.add(&shelf).unwrap();
    let cube = tree("box?x=0.5&y=0.5&z=0.5");
    let mut put = |position: DVec3| simulation.add(&body("box", &cube, 0.5, position)).unwrap();
    let stack: Vec<BodyId> = (0..5).map(|k| put(DVec3::Y * (10.601 + 1.001 * k as f64))).collect();
    let others: Vec<BodyId> =
        (0..MANY).map(|k| put(DVec3::new(2.0 * k as f64 - 260.0, 0.501, 10.0))).collect();
    while asleep(&simulation, &stack) < stack.len() || asleep(&simulation, &others) < MANY {
        assert!(simulation.time() < 5.0);
        simulation.step().unwrap();
    }
    (simulation, shelf, stack, others)
}

/// It falls as one where the shelf is gone.
#[test]
fn what_falls_takes_along_what_sleeps_on_it() {
    let (mut simulation, shelf, stack, others) = laden_shelf(Kind::Static);
    simulation.remove(shelf);
    for _ in 0..50 {
        simulation.step().unwrap();
        for between in stack.windows(2) {
            let apart = simulation.position(between[1]).y - simulation.position(between[0]).y;
            assert!((apart - 1.001).abs() < simulation.options().gap, "{apart}");
        }
    }
    assert_eq!(asleep(&simulation, &others), MANY);
}

/// And is raised as one where the shelf is a lift: nothing sleeps in its way.
#[test]
fn a_lift_raises_what_sleeps_on_it() {
    let (mut simulation, lift, stack, _) = laden_shelf(Kind::Driven);
    let begin = stack.iter().map(|&body| simulation.position(body).y).collect::<Vec<_>>();
    let rise = 0.002;
    for k in 1..=100 {
        let target = Pose::new(DVec3::Y * (10.0 + rise * f64::from(k)), DQuat::IDENTITY);
        simulation.set_target(lift, target).unwrap();
        simulation.step().unwrap();
    }
    for (&body, begin) in stack.iter().zip(begin) {
        let came = simulation.position(body).y - begin;
        assert!((came - 100.0 * rise).abs() < simulation.options().gap, "{came}");
    }
}

/// They come to rest where they are put.
fn rest_as_they_are(step: f64, end: f64, half: DVec3, places: &[DVec3]) {
    let mut simulation = Simulation::new(SimulationOptions::default().with_step(step)).unwrap();
    let floor = Body::new("floor", tree("box?x=30&y=0.5&z=30")).with_kind(Kind::Static).with_friction(0.5);
    simulation.add(&floor.with_position(DVec3::NEG_Y * 0.5)).unwrap();
    let cuboid = tree(&format!("box?x={}&y={}&z={}", half.x, half.y, half.z));
    let boxes: Vec<BodyId> =
        places.iter().map(|&place| simulation.add(&body("box", &cuboid, 0.5, place)).unwrap()).collect();
    while simulation.time() < end {
        assert_eq!(simulation.step().unwrap().segments.iter().map(|s| s.skipped).sum::<f64>(), 0.0);
    }
    assert_eq!(asleep(&simulation, &boxes), boxes.len(), "{step}");
    let off = |(id, place): (&BodyId, &DVec3)| (simulation.position(*id) - *place).length();
    let moved = boxes.iter().zip(places).map(off).fold(0.0, f64::max);
    assert!(moved < 1e-5, "{step}: {moved}");
}

/// Boxes that lie on two others each, 78 of them: what solutions leave at each level adds up to the top, and was lifted again for ever.
#[test]
fn pyramids_of_many_boxes_fall_asleep() {
    let levels = (0..12).flat_map(|level| (0..12 - level).map(move |k| (level, k)));
    let place = |(level, k): (i32, i32)| {
        DVec3::new(1.05 * (f64::from(k) + 0.5 * f64::from(level)), 0.501 + 1.001 * f64::from(level), 0.0)
    };
    let places: Vec<DVec3> = levels.map(place).collect();
    for step in [0.01, 1.0 / 240.0] {
        rest_as_they_are(step, 1.0, DVec3::splat(0.5), &places);
    }
}

/// Two columns a gap apart, of 34 and of 42 boxes each: whether they lean on each other is decided only where rounds that gain nothing are gone on with.
#[test]
fn columns_beside_each_other_fall_asleep() {
    for count in [34, 42] {
        let all = [0.0, 1.001].into_iter().flat_map(|x| (0..count).map(move |level| (x, level)));
        let place = |(x, level): (f64, i32)| DVec3::new(x, 0.251 + 0.501 * f64::from(level), 0.0);
        rest_as_they_are(0.01, 0.7, DVec3::new(0.5, 0.25, 0.5), &all.map(place).collect::<Vec<DVec3>>());
    }
}
