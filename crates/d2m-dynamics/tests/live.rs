//! A running simulation is changed from outside: bodies come and go, are put elsewhere, become others. What was proven of them before proves
//! nothing any more. Each flight is judged by distances at many of its times that share nothing with what the simulation keeps.

mod ground;

use d2m_bvh::{MeshTree, Posed, Solid, distance};
use d2m_dynamics::{
    Body, BodyId, Groups, Joint, JointKind, Kind, Mass, Segment, Simulation, SimulationError,
    SimulationOptions, StepError,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use glam::{DQuat, DVec3};
use ground::{at, cube, floor, rest, tree};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Follows the segments of a simulation, and judges them by distances of their own.
#[derive(Default)]
struct Judge {
    flights: BTreeMap<BodyId, ConstantTwist>,
    trees: BTreeMap<BodyId, Arc<MeshTree>>,
    dynamic: BTreeMap<BodyId, bool>,
    ignored: Vec<[BodyId; 2]>,
    judged: usize,
}

impl Judge {
    fn knows(&mut self, id: BodyId, tree: &Arc<MeshTree>, dynamic: bool) {
        self.trees.insert(id, Arc::clone(tree));
        self.dynamic.insert(id, dynamic);
    }

    fn judge(&mut self, segments: &[Segment]) {
        for segment in segments {
            for gone in &segment.removed {
                self.flights.remove(gone);
            }
            self.flights.extend(segment.changed.iter().copied());
            let ids: Vec<BodyId> = self.flights.keys().copied().collect();
            for (k, &a) in ids.iter().enumerate() {
                for &b in &ids[k + 1..] {
                    if (self.dynamic[&a] || self.dynamic[&b]) && !self.ignored.contains(&[a, b]) {
                        self.pair(a, b, segment);
                    }
                }
            }
        }
    }

    fn pair(&mut self, a: BodyId, b: BodyId, segment: &Segment) {
        let reach = self.trees[&a].radius() + self.trees[&b].radius();
        for part in 0..=4 {
            let time = segment.start + f64::from(part) / 4.0 * (segment.end - segment.start);
            let poses = [a, b].map(|id| self.flights[&id].pose_and_twist(time).0);
            let centers =
                [(a, poses[0]), (b, poses[1])].map(|(id, p)| p.transform_point(self.trees[&id].center()));
            if centers[0].distance(centers[1]) > reach {
                continue;
            }
            let posed = [(a, poses[0]), (b, poses[1])].map(|(id, pose)| Posed::new(&self.trees[&id], pose));
            let found = distance(posed[0], posed[1], Solid::Filled).unwrap();
            assert!(found.lower > 0.0, "{a:?} and {b:?} at {time}: {found:?}");
            self.judged += 1;
        }
    }
}

/// Numbers in [0, 1).
fn draw(state: &mut u64) -> f64 {
    *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*state >> 11) as f64 / (1u64 << 53) as f64
}

/// Everything at once, by chance: bodies are added, removed and put elsewhere, some into each other, which is refused; kinds, groups,
/// velocities and gravity change; snapshots are taken and gone back to. No flight of any segment meets another one.
#[test]
fn whatever_is_changed_nothing_meets() {
    let shapes = [cube(), tree("box?x=0.7&y=0.2&z=0.4"), tree("pebble?triangles=80&scale=0.5")];
    let (mut refused, mut removed, mut restored, mut judged) = (0, 0, 0, 0);
    for seed in 0..6 {
        let state = &mut (seed + 1);
        let options = SimulationOptions::default().with_gap(5e-3).with_step(1.0 / 64.0);
        let mut simulation = Simulation::new(options).unwrap();
        let mut judge = Judge::default();
        let ground = floor();
        let id = simulation.add(&ground).unwrap();
        judge.knows(id, &ground.tree, false);
        let mut ids = Vec::new();
        let mut kept = None;
        for round in 0..90 {
            let place = DVec3::new(2.0 * draw(state), 0.3 + 2.5 * draw(state), 2.0 * draw(state));
            let pose =
                Pose::from_rotation_vector(place, DVec3::new(draw(state), draw(state), draw(state)) * 2.0);
            let chosen = (draw(state) * ids.len() as f64) as usize;
            match (draw(state) * 12.0) as u32 {
                0..=3 if ids.len() < 14 => {
                    let shape = &shapes[(draw(state) * 3.0) as usize];
                    let body = Body::new(format!("body {round}"), Arc::clone(shape)).with_friction(0.4);
                    let body = body.with_position(pose.translation).with_orientation(pose.rotation);
                    match simulation.add_checked(&body) {
                        Ok(id) => {
                            judge.knows(id, shape, true);
                            ids.push(id);
                        }
                        Err(error) => {
                            assert!(matches!(error, SimulationError::Intersecting { .. }), "{error}");
                            refused += 1;
                        }
                    }
                }
                4 if ids.len() > 3 => {
                    let id = ids.swap_remove(chosen);
                    assert!(simulation.remove(id) && !simulation.contains(id));
                    removed += 1;
                }
                5 | 6 if !ids.is_empty() => {
                    let before = simulation.pose(ids[chosen]);
                    if simulation.set_pose(ids[chosen], pose).is_err() {
                        assert_eq!(simulation.pose(ids[chosen]), before);
                        refused += 1;
                    }
                }
                7 if !ids.is_empty() => {
                    let id = ids[chosen];
                    let kind = if judge.dynamic[&id] { Kind::Static } else { Kind::Dynamic };
                    if simulation.set_kind(id, kind).is_ok() {
                        *judge.dynamic.get_mut(&id).unwrap() ^= true;
                    }
                }
                8 if !ids.is_empty() && judge.dynamic[&ids[chosen]] => {
                    let way = (pose.translation - DVec3::Y) * 3.0;
                    simulation.set_velocity(ids[chosen], way, pose.translation).unwrap();
                }
                9 => simulation.set_gravity(DVec3::new(place.x - 1.0, -9.81 * draw(state), 0.0)).unwrap(),
                10 => kept = Some((simulation.snapshot(), ids.clone(), judge.dynamic.clone())),
                11 => {
                    if let Some((snapshot, known, dynamic)) = &kept
                        && known.iter().all(|id| simulation.contains(*id))
                    {
                        simulation.restore(snapshot).unwrap();
                        ids.clone_from(known);
                        judge.dynamic.extend(dynamic.iter().map(|(id, dynamic)| (*id, *dynamic)));
                        judge.flights.clear();
                        restored += 1;
                    }
                }
                _ => {}
            }
            let report = simulation.step().unwrap();
            judge.judge(&report.segments);
        }
        judge.judge(&simulation.finish());
        judged += judge.judged;
    }
    assert!(
        refused > 20 && removed > 10 && restored > 5 && judged > 2000,
        "{refused} {removed} {restored} {judged}"
    );
}

/// What was asleep on a body that goes, is put elsewhere, becomes dynamic, or is met no more, falls.
#[test]
fn what_rests_on_a_body_that_changes_is_awake() {
    let changes: [fn(&mut Simulation, BodyId); 6] = [
        |simulation, shelf| assert!(simulation.remove(shelf)),
        |simulation, shelf| simulation.set_pose(shelf, at(5.0, 0.0, 0.0)).unwrap(),
        |simulation, shelf| simulation.set_kind(shelf, Kind::Dynamic).unwrap(),
        |simulation, shelf| simulation.set_groups(shelf, Groups { member: 0, meets: 0 }).unwrap(),
        |simulation, shelf| simulation.ignore(shelf, simulation.ids().nth(1).unwrap()),
        |simulation, _| simulation.set_gravity(DVec3::X).unwrap(),
    ];
    for (k, change) in changes.into_iter().enumerate() {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        let shelf = simulation.add(&Body::new("shelf", cube()).with_kind(Kind::Static)).unwrap();
        let low = simulation.add(&Body::new("low", cube()).with_position(DVec3::Y * 1.001)).unwrap();
        let high = simulation.add(&Body::new("high", cube()).with_position(DVec3::Y * 2.002)).unwrap();
        rest(&mut simulation, high);
        change(&mut simulation, shelf);
        for _ in 0..10 {
            simulation.step().unwrap();
        }
        for body in [low, high] {
            assert!(
                simulation.linear_velocity(body).length() > 0.05,
                "change {k}: {}",
                simulation.name(body)
            );
        }
    }
}

/// The box about the flight of a body that stood still, and its neighbors, are those of where it is now: it is found by what flies there.
#[test]
fn a_wall_that_was_put_elsewhere_is_met_there() {
    let changes: [fn(&mut Simulation, BodyId); 3] = [
        |simulation, wall| simulation.set_pose(wall, at(3.0, 0.0, 0.0)).unwrap(),
        // Another body takes the place, the version and the look of the old one.
        |simulation, wall| {
            simulation.remove(wall);
            let wall = Body::new("new wall", cube()).with_kind(Kind::Static);
            simulation.add_checked(&wall.with_position(DVec3::X * 3.0)).unwrap();
        },
        |simulation, wall| {
            let before = simulation.snapshot();
            simulation.set_pose(wall, at(3.0, 0.0, 0.0)).unwrap();
            let after = simulation.snapshot();
            simulation.restore(&before).unwrap();
            simulation.step().unwrap();
            simulation.restore(&after).unwrap();
        },
    ];
    for (k, change) in changes.into_iter().enumerate() {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        let ball = simulation.add(&Body::new("ball", cube()).with_linear_velocity(DVec3::X)).unwrap();
        // The last one: its place is given up with it, and what is remembered of the place must go, too.
        let wall =
            Body::new("wall", cube()).with_kind(Kind::Static).with_position(DVec3::new(0.0, 50.0, 0.0));
        let wall = simulation.add(&wall).unwrap();
        simulation.step().unwrap();
        change(&mut simulation, wall);
        simulation.set_velocity(ball, DVec3::X * 50.0, DVec3::ZERO).unwrap();
        for _ in 0..20 {
            simulation.step().unwrap();
        }
        let x = simulation.position(ball).x;
        assert!(x < 2.0 && x > 1.9, "change {k}: {x}");
    }
}

/// What is put against a body, up to rounding, is accepted, and the body parts from it, also where only that one moves and others are behind it.
#[test]
fn what_is_put_against_a_body_parts_from_it() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let ids = [0.0, -1.0005].map(|x| {
        let body = Body::new("cube", cube()).with_position(DVec3::X * x);
        simulation.add(&body).unwrap()
    });
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let before = simulation.position(ids[0]).x;
    let wall = Body::new("wall", cube()).with_kind(Kind::Static).with_position(DVec3::X * (before + 1.0));
    let wall = simulation.add_checked(&wall).unwrap();
    let mut judge = Judge::default();
    simulation.finish();
    for id in [ids[0], ids[1], wall] {
        judge.knows(id, &cube(), id != wall);
    }
    for _ in 0..20 {
        judge.judge(&simulation.step().unwrap().segments);
    }
    judge.judge(&simulation.finish());
    assert!(judge.judged > 0 && simulation.position(ids[0]).x < before - 5e-4);
}

/// How far a pair is apart is not how far another pair at the same places is: a thin bar gives its place to a thick one.
#[test]
fn distances_of_a_body_that_is_gone_prove_nothing() {
    let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let bar = |thick: f64| {
        let shape = tree(&format!("box?x={thick}&y=2&z=0.1"));
        Body::new("bar", shape).with_kind(Kind::Static)
    };
    let thin = simulation.add(&bar(0.1)).unwrap();
    let ball = Body::new("ball", cube()).with_position(DVec3::X * 0.9).with_linear_velocity(DVec3::X * -1e-3);
    let ball = simulation.add(&ball).unwrap();
    simulation.step().unwrap();
    simulation.remove(thin);
    let thick = simulation.add_checked(&bar(0.3)).unwrap();
    assert_eq!(thick.index(), thin.index());
    simulation.apply_impulse(ball, DVec3::X * -10_000.0, DVec3::ZERO).unwrap();
    for _ in 0..10 {
        simulation.step().unwrap();
        assert!(simulation.position(ball).x > 0.8, "{}", simulation.position(ball));
    }
}

/// Static bodies have no neighbors of their kind: one that becomes dynamic has.
#[test]
fn a_static_body_that_becomes_dynamic_meets_the_others() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let held = Body::new("held", cube()).with_kind(Kind::Static).with_position(DVec3::Y);
    let held = simulation.add(&held).unwrap();
    let other =
        simulation.add(&Body::new("other", cube()).with_position(DVec3::new(3.0, 0.501, 0.0))).unwrap();
    rest(&mut simulation, other);
    simulation.set_kind(held, Kind::Dynamic).unwrap();
    while simulation.time() < 3.0 {
        simulation.step().unwrap();
    }
    assert!((simulation.position(held).y - 0.501).abs() < 1e-3, "{}", simulation.position(held));
}

/// The same steps from the state after a change as those of a simulation that was built in it, to the bit.
#[test]
fn a_changed_simulation_is_one_that_was_built_so() {
    let body = |x: f64| Body::new("cube", cube()).with_friction(0.5).with_position(DVec3::new(x, 2.0, 0.0));
    let turned = DQuat::from_rotation_z(0.3);
    let mut changed = Simulation::new(SimulationOptions::default()).unwrap();
    changed.add(&floor()).unwrap();
    let ids = [0.0, 3.0, 6.0].map(|x| changed.add(&body(x)).unwrap());
    let pin = changed.add_joint(&Joint::new(JointKind::Revolute, ids[2], None, DVec3::X * 6.0)).unwrap();
    let moved = Pose::new(DVec3::new(0.0, 1.5, 4.0), turned);
    changed.set_pose(ids[0], moved).unwrap();
    changed.set_velocity(ids[0], DVec3::X, DVec3::Y).unwrap();
    changed.set_material(ids[0], 0.25, 0.75).unwrap();
    changed.set_gravity(DVec3::Y * -5.0).unwrap();
    changed.remove_joint(pin);
    changed.remove(ids[1]);
    let last = changed.add_checked(&body(1.5)).unwrap();
    changed.set_kind(ids[2], Kind::Static).unwrap();
    assert_eq!((last.index(), changed.len()), (2, 4));

    let mut built = Simulation::new(SimulationOptions::default().with_gravity(DVec3::Y * -5.0)).unwrap();
    built.add(&floor()).unwrap();
    let first = body(0.0).with_position(moved.translation).with_orientation(turned);
    let first = first.with_linear_velocity(DVec3::X).with_angular_velocity(DVec3::Y);
    let first = first.with_restitution(0.25).with_friction(0.75);
    let bodies = [first, body(1.5), body(6.0).with_kind(Kind::Static)];
    let same: Vec<BodyId> = bodies.iter().map(|body| built.add(body).unwrap()).collect();
    for _ in 0..150 {
        changed.step().unwrap();
        built.step().unwrap();
        for (one, other) in [ids[0], last, ids[2]].into_iter().zip(&same) {
            assert_eq!(changed.pose(one), built.pose(*other));
            assert_eq!(changed.linear_velocity(one), built.linear_velocity(*other));
        }
    }
}

/// What has gone does not make a crowd of the others, and a joint that was taken out no jointed bodies of them.
#[test]
fn what_has_gone_counts_for_nothing() {
    let small = tree("box?x=0.3&y=0.3&z=0.3");
    let after = |count: usize, gone: usize, joints: usize| {
        let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
        simulation.add(&floor()).unwrap();
        let mut add = |turn: f64, position: DVec3| {
            let turned = DQuat::from_rotation_x(turn);
            let body = Body::new("box", Arc::clone(&small)).with_orientation(turned).with_position(position);
            simulation.add(&body.with_friction(0.5)).unwrap()
        };
        let place = |k: usize| DVec3::new((k % 4) as f64, 0.6 + 1.1 * (k / 16) as f64, (k % 16 / 4) as f64);
        let boxes: Vec<BodyId> = (0..count).map(|k| add(0.1 * k as f64, 1.2 * place(k))).collect();
        let others: Vec<BodyId> =
            (0..gone).map(|k| add(0.0, DVec3::new(50.0, 2.0 * k as f64, 0.0))).collect();
        // Behind them, so that their places stay.
        let last = add(0.0, DVec3::new(-50.0, 0.4, 0.0));
        for other in others {
            simulation.remove(other);
        }
        for _ in 0..joints {
            let joint = Joint::new(JointKind::Fixed, last, None, DVec3::ZERO);
            let joint = simulation.add_joint(&joint).unwrap();
            simulation.remove_joint(joint);
        }
        for _ in 0..120 {
            simulation.step().unwrap();
        }
        boxes.iter().map(|&body| simulation.pose(body)).collect::<Vec<_>>()
    };
    assert_eq!(after(48, 0, 0), after(48, 20, 0));
    assert_eq!(after(70, 0, 0), after(70, 0, 1));
}

/// Refused changes change nothing, to the bit.
#[test]
fn what_is_refused_changes_nothing() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let ground = simulation.add(&floor()).unwrap();
    let low = simulation.add(&Body::new("low", cube()).with_position(DVec3::Y * 0.501)).unwrap();
    let ghost = Body::new("ghost", cube()).with_groups(Groups { member: 2, meets: 0 });
    let ghost = simulation.add(&ghost.with_kind(Kind::Static).with_position(DVec3::Y * 0.7)).unwrap();
    let hand = simulation
        .add(&Body::new("hand", cube()).with_kind(Kind::Driven).with_position(DVec3::X * 9.0))
        .unwrap();
    simulation.step().unwrap();
    let before = simulation.snapshot();
    let body = Body::new("new", cube());
    type Attempt = fn(&mut Simulation, &Body, [BodyId; 4]) -> Result<(), SimulationError>;
    let refused: [Attempt; 12] = [
        |simulation, body, _| simulation.add_checked(&body.clone().with_position(DVec3::Y)).map(|_| ()),
        |simulation, body, _| simulation.add(&body.clone().with_friction(-1.0)).map(|_| ()),
        |simulation, _, [_, low, ..]| simulation.set_pose(low, at(0.0, 0.2, 0.0)),
        |simulation, _, [_, low, ..]| simulation.set_pose(low, at(f64::NAN, 0.2, 0.0)),
        |simulation, _, [_, low, ..]| simulation.set_velocity(low, DVec3::X * 1e200, DVec3::ZERO),
        |simulation, _, [ground, ..]| simulation.set_velocity(ground, DVec3::X, DVec3::ZERO),
        |simulation, _, [_, low, ..]| simulation.set_material(low, 2.0, 0.0),
        |simulation, _, [_, _, ghost, _]| simulation.set_groups(ghost, Groups::ALL),
        |simulation, _, _| simulation.set_gravity(DVec3::NAN),
        |simulation, _, [.., hand]| {
            let motion = ConstantTwist::REST.with_position(DVec3::Y * 0.6);
            simulation.set_motion(hand, Arc::new(motion))
        },
        |simulation, _, [.., hand]| {
            simulation.set_target(hand, Pose::new(DVec3::X * 9.0, DQuat::from_rotation_z(3.1)))
        },
        |simulation, _, [_, low, ..]| simulation.set_target(low, at(0.0, 0.0, 0.0)),
    ];
    for (k, attempt) in refused.into_iter().enumerate() {
        assert!(attempt(&mut simulation, &body, [ground, low, ghost, hand]).is_err(), "{k}");
        assert_eq!(simulation.snapshot(), before, "{k}");
    }
}

/// A driven body is where its target was at the end of each step, pushes what is in its way, and crushes by name.
#[test]
fn driven_bodies_follow_their_targets() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let hand = Body::new("hand", cube()).with_kind(Kind::Driven).with_position(DVec3::new(-2.0, 0.6, 0.0));
    let hand = simulation.add(&hand).unwrap();
    let pushed = simulation.add(&Body::new("pushed", cube()).with_position(DVec3::Y * 0.501)).unwrap();
    for k in 1..=100 {
        let target = Pose::new(DVec3::new(-2.0 + 0.02 * f64::from(k), 0.6, 0.0), DQuat::IDENTITY);
        simulation.set_target(hand, target).unwrap();
        simulation.step().unwrap();
        assert!((simulation.position(hand) - target.translation).length() < 1e-14);
    }
    assert!(simulation.position(pushed).x > 0.99, "{}", simulation.position(pushed));
    simulation.step().unwrap();
    assert_eq!(simulation.linear_velocity(hand), DVec3::ZERO);
    // Down on what lies on the floor.
    simulation.set_pose(pushed, at(10.0, 0.501, 0.0)).unwrap();
    simulation.set_target(hand, at(10.0, 3.0, 0.0)).unwrap();
    simulation.step().unwrap();
    simulation.set_target(hand, at(10.0, 0.2, 0.0)).unwrap();
    let crushed = simulation.step();
    assert!(
        matches!(crushed, Err(StepError::Crushed { ref crushed, .. }) if crushed == "pushed"),
        "{crushed:?}"
    );
}

/// A joint holds where it was when the center of one of its bodies becomes another point.
#[test]
fn joints_stay_where_a_kind_changes() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let properties = d2m_dynamics::MassProperties::try_new(
        1000.0,
        DVec3::new(0.2, 0.1, 0.0),
        glam::DMat3::IDENTITY * 200.0,
    );
    let anchor =
        Body::new("anchor", cube()).with_kind(Kind::Static).with_mass(Mass::Given(properties.unwrap()));
    let anchor = simulation.add(&anchor.with_position(DVec3::Y * 3.0)).unwrap();
    let hung = simulation.add(&Body::new("hung", cube()).with_position(DVec3::Y * 1.5)).unwrap();
    let point = DVec3::Y * 2.3;
    simulation.add_joint(&Joint::new(JointKind::Spherical, anchor, Some(hung), point)).unwrap();
    let hook = Joint::new(JointKind::Spherical, anchor, None, DVec3::new(0.2, 3.6, 0.0));
    simulation.step().unwrap();
    simulation.set_kind(anchor, Kind::Dynamic).unwrap();
    simulation.add_joint(&hook).unwrap();
    let ends = |simulation: &Simulation| {
        let own = |id: BodyId, v: DVec3| simulation.pose(id).transform_point(v);
        (own(anchor, DVec3::Y * -0.7), own(hung, DVec3::Y * 0.8))
    };
    while simulation.time() < 1.0 {
        simulation.step().unwrap();
        let (one, other) = ends(&simulation);
        assert!(one.distance(other) < 1e-4, "{one} {other}");
    }
}

/// A joint goes with its body; what hung on it falls, its number means no other joint, and a hand that is parked is met like a wall.
#[test]
fn joints_go_with_their_bodies() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let hand = Body::new("hand", cube()).with_kind(Kind::Driven).with_position(DVec3::Y * -3.0);
    let hand = simulation.add(&hand).unwrap();
    let hung = simulation.add(&Body::new("hung", cube())).unwrap();
    let hook = simulation.add(&Body::new("hook", cube()).with_position(DVec3::Y * 2.0)).unwrap();
    let first = simulation.add_joint(&Joint::new(JointKind::Spherical, hook, Some(hung), DVec3::Y)).unwrap();
    let nail = simulation.add_joint(&Joint::new(JointKind::Fixed, hook, None, DVec3::Y * 2.0)).unwrap();
    simulation.set_target(hand, at(0.1, -3.0, 0.0)).unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    assert!(simulation.position(hung).y.abs() < 1e-6);
    simulation.remove(hook);
    assert!(simulation.joint(first).is_none() && simulation.joint(nail).is_none());
    while simulation.time() < 3.0 {
        simulation.step().unwrap();
    }
    // It lies on the hand, which has stood still since.
    assert!((simulation.position(hung).y + 2.0).abs() < 2e-3, "{}", simulation.position(hung));
    let again = Joint::new(JointKind::Fixed, hung, None, simulation.position(hung));
    assert_eq!(simulation.add_joint(&again), Ok(nail + 1));
    simulation.step().unwrap();
}
