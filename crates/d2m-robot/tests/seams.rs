//! The same question by every door has the same answer: paths, edges, batches, worlds; in other units, by other points, in another
//! order.

mod arm;

use arm::{BoxArm, BoxLink};
use d2m_bvh::{Budget, Canceller, MeshTree, QueryOptions, Start, TimeOfContact, TriMesh, time_of_contact};
use d2m_motion::ConstantTwist;
use d2m_robot::{
    Attached, Obstacle, PathAnswer, Robot, RobotOptions, RobotScene, Srdf, Trajectory, TrajectoryPoint,
};
use d2m_testing::{Draw, Random};
use d2m_world::{Body, BodyId, FirstContact, PlannedMotion, SharedMotion, World};
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// Three links that turn about slanted axes on a base, lengths times `unit`.
fn arm(random: &mut Random, unit: f64) -> BoxArm {
    let base = BoxLink {
        parent: None,
        kind: "fixed",
        xyz: DVec3::ZERO,
        rpy: DVec3::ZERO,
        axis: DVec3::X,
        size: DVec3::splat(0.2) * unit,
        at: DVec3::ZERO,
        turn: DVec3::ZERO,
        mimic: None,
    };
    let link = |parent: usize, axis: DVec3| BoxLink {
        parent: Some(parent),
        kind: "continuous",
        xyz: if parent == 0 { DVec3::Z * 0.2 * unit } else { DVec3::X * 0.4 * unit },
        axis,
        size: DVec3::new(0.3, 0.05, 0.05) * unit,
        at: DVec3::X * 0.2 * unit,
        ..base.clone()
    };
    let mut slanted = |axis: DVec3| axis + random.vector() * 0.2;
    let axes = [slanted(DVec3::Z), slanted(DVec3::Y), slanted(DVec3::Y)];
    let links = axes.into_iter().enumerate().map(|(parent, axis)| link(parent, axis));
    BoxArm { links: core::iter::once(base.clone()).chain(links).collect() }
}

const NAMES: [&str; 3] = ["j1", "j2", "j3"];

fn cuboid(half: DVec3) -> Arc<MeshTree> {
    let corner = |k: usize| {
        let side = |axis: usize| if k >> axis & 1 == 1 { half[axis] } else { -half[axis] };
        DVec3::new(side(0), side(1), side(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Arc::new(MeshTree::new(TriMesh::try_new((0..8).map(corner).collect(), triangles.collect()).unwrap()))
}

fn robot(arm: &BoxArm) -> Arc<Robot> {
    Arc::new(Robot::parse("boxes.urdf", &arm.urdf(), &RobotOptions::new()).unwrap())
}

/// With a post beside it and something in its hand.
fn scene(arm: &BoxArm, unit: f64, options: QueryOptions) -> RobotScene {
    let mut scene = RobotScene::new(robot(arm), None, options).unwrap();
    let post = Obstacle::at_rest(
        "post",
        cuboid(DVec3::new(0.05, 0.05, 0.5) * unit),
        DVec3::new(0.5, 0.5, 0.2) * unit,
        DQuat::IDENTITY,
    );
    scene.add_obstacle(post.unwrap()).unwrap();
    let cup = Attached::new(
        "cup",
        "l3",
        cuboid(DVec3::splat(0.03) * unit),
        DVec3::X * 0.4 * unit,
        DQuat::from_xyzw(0.1, 0.0, 0.2, 1.0),
    );
    scene.attach(cup.unwrap()).unwrap();
    scene
}

fn path(times: &[f64], points: &[Vec<f64>]) -> Trajectory {
    let points = times.iter().zip(points).map(|(&time, at)| TrajectoryPoint::new(time, at.clone()));
    Trajectory::new(NAMES.map(str::to_owned).to_vec(), points.collect())
}

fn draw(random: &mut Random, size: f64) -> Vec<f64> {
    (0..3).map(|_| size * random.signed()).collect()
}

/// Pair and time.
fn outcome(answer: &PathAnswer) -> (Option<[String; 2]>, f64) {
    let pair = answer.contact().map(|found| {
        let mut pair = [found.a.clone(), found.b.clone()];
        pair.sort();
        pair
    });
    (pair, answer.free_until())
}

fn about_the_same(one: &PathAnswer, other: &PathAnswer, scale: f64, within: f64) {
    let ((pair, until), (other_pair, other_until)) = (outcome(one), outcome(other));
    assert_eq!(pair, other_pair, "{one:?}\n{other:?}");
    assert!((until * scale - other_until).abs() <= within, "{until:?} times {scale:?}, {other_until:?}");
}

/// The number of a link by its name.
fn link(name: &str) -> Option<usize> {
    name.strip_prefix('l')?.parse().ok()
}

#[test]
fn every_door_has_the_same_answer() {
    let mut random = Random(2901);
    let (mut contacts, mut free) = (0, 0);
    for round in 0..12 {
        let arm = arm(&mut random, 1.0);
        let options = QueryOptions::default().with_min_separation([0.0, 0.01][round % 2]);
        let all = scene(&arm, 1.0, options);
        let edges = all.edges(&NAMES).unwrap();
        let drawn: Vec<[Vec<f64>; 2]> = (0..10)
            .map(|k| {
                let from = draw(&mut random, 1.0);
                let way = draw(&mut random, [0.1, 1.0, 5.0][k % 3]);
                let to = from.iter().zip(&way).map(|(a, b)| a + b).collect();
                [from, to]
            })
            .collect();
        let batch = edges.check_all(drawn.iter().map(|[a, b]| (&a[..], &b[..]))).unwrap();
        // A budget that never ends anything changes nothing, nor do names in another order.
        let mut limited = all.clone();
        let canceller = Canceller::new();
        let budget = Budget::UNLIMITED.with_cancel(canceller.flag());
        limited.set_budget(budget.with_wall_clock(std::time::Duration::from_secs(3600)));
        let swapped = all.edges(&["j3", "j1", "j2"]).unwrap();
        for ([from, to], of_batch) in drawn.iter().zip(&batch) {
            let edge = edges.check(from, to).unwrap();
            assert_eq!(edge, *of_batch);
            let ends = [from.clone(), to.clone()];
            assert_eq!(edge, all.check_path(&path(&[0.0, 1.0], &ends)).unwrap());
            assert_eq!(edge, limited.edges(&NAMES).unwrap().check(from, to).unwrap());
            assert_eq!(edge, limited.check_path(&path(&[0.0, 1.0], &ends)).unwrap());
            let turned = |q: &[f64]| [q[2], q[0], q[1]];
            assert_eq!(edge, swapped.check(&turned(from), &turned(to)).unwrap());
            // In another time, and through a point of the way that is there twice as a configuration.
            let shifted = all.check_path(&path(&[-3.0, 5.0], &ends)).unwrap();
            let (pair, until) = outcome(&edge);
            let (other_pair, other_until) = outcome(&shifted);
            assert_eq!(pair, other_pair);
            assert!((until * 8.0 - 3.0 - other_until).abs() < 1e-7, "{until} {other_until}");
            let middle: Vec<f64> = from.iter().zip(to).map(|(a, b)| 0.5 * a + 0.5 * b).collect();
            let rests = [from.clone(), middle.clone(), middle, to.clone()];
            let halted = all.check_path(&path(&[0.0, 0.5, 1.5, 2.0], &rests)).unwrap();
            let (other_pair, other_until) = outcome(&halted);
            assert_eq!(pair, other_pair, "{edge:?} {halted:?}");
            let expected = if until > 0.5 { until + 1.0 } else { until };
            assert!((expected - other_until).abs() < 1e-7, "{until} {other_until}");
            // No earlier contact of any pair alone.
            let bodies = all.bodies_along(&path(&[0.0, 1.0], &ends)).unwrap();
            let mut first = 1.0_f64;
            for &pair in bodies.pairs() {
                let [a, b] = pair.map(|body| bodies.moving(body));
                let answer = time_of_contact(a, b, bodies.window(), &bodies.pair_options(pair)).unwrap();
                match answer {
                    TimeOfContact::Contact(found) => first = first.min(found.time_lo),
                    TimeOfContact::Separated => {}
                    TimeOfContact::Undecided { .. } => panic!("{answer:?}"),
                }
            }
            assert!((first - until).abs() < 1e-8, "{first:?} {until:?}");
            // By kinematics of its own: links that meet are at each other then.
            if let PathAnswer::Contact(found) = &edge
                && let Some([a, b]) = [&found.a, &found.b]
                    .map(|name| link(name))
                    .into_iter()
                    .collect::<Option<Vec<_>>>()
                    .as_deref()
            {
                let t = found.contact.time_hi;
                let q: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + (b - a) * t).collect();
                let placed = arm.place(&[&[0.0], &q[..]].concat());
                let gap = placed[*a].gap(&placed[*b]);
                assert!(gap < options.min_separation + 1e-8, "{gap:e}");
            }
            if edge.is_free() { free += 1 } else { contacts += 1 }
        }
    }
    assert!(contacts > 20 && free > 20, "{contacts} {free}");
}

#[test]
fn a_robot_in_other_units_meets_at_the_same_times() {
    for unit in [1e-12, 1e-6, 1e6, 1e12] {
        let mut random = Random(2902);
        let [meters, other] = [1.0, unit].map(|unit| arm(&mut Random(2903), unit));
        for separation in [0.0, 0.01] {
            let options = |unit: f64| QueryOptions::default().with_min_separation(separation * unit);
            let [one, two] =
                [(&meters, 1.0), (&other, unit)].map(|(arm, unit)| scene(arm, unit, options(unit)));
            for k in 0..6 {
                let (from, to) = (draw(&mut random, 1.0), draw(&mut random, [1.0, 4.0][k % 2]));
                let [one, two] =
                    [&one, &two].map(|scene| scene.edges(&NAMES).unwrap().check(&from, &to).unwrap());
                about_the_same(&one, &two, 1.0, 1e-7);
            }
        }
    }
}

/// A configuration is a path: free for all of its time, or in contact from its start.
#[test]
fn edges_without_a_way_are_free_or_in_contact_at_once() {
    let mut random = Random(2904);
    let arm = arm(&mut random, 1.0);
    let all = scene(&arm, 1.0, QueryOptions::default());
    let edges = all.edges(&NAMES).unwrap();
    let (mut contacts, mut free) = (0, 0);
    for _ in 0..200 {
        let at = draw(&mut random, 3.0);
        let [one, other] = [
            edges.check(&at, &at),
            all.check_path(&path(&[2.0, 3.0, 9.0], &[at.clone(), at.clone(), at.clone()])),
        ]
        .map(Result::unwrap);
        match one {
            PathAnswer::Free { until, .. } => {
                assert!(until == 1.0 && other.free_until() == 9.0 && other.is_free());
            }
            PathAnswer::Contact(_) => assert!(one.free_until() == 0.0 && other.free_until() == 2.0),
            PathAnswer::Undecided { .. } => panic!("{one:?}"),
        }
        if one.is_free() { free += 1 } else { contacts += 1 }
    }
    assert!(contacts > 5 && free > 50, "{contacts} {free}");
}

/// A continuous joint over many turns meets what is in its way on the first one, and a π of twelve digits is the number that is written.
#[test]
fn many_turns_and_written_numbers() {
    let urdf = "<robot name=\"clock\"><link name=\"base\"/>\
        <link name=\"hand\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"0.9 0.02 0.02\"/></geometry></collision></link>\
        <link name=\"pin\"><collision><origin xyz=\"-0.8 0 0\"/><geometry><box size=\"0.01 0.01 0.01\"/></geometry></collision></link>\
        <joint name=\"turn\" type=\"continuous\"><parent link=\"base\"/><child link=\"hand\"/><axis xyz=\"0 0 1\"/></joint>\
        <joint name=\"weld\" type=\"fixed\"><parent link=\"base\"/><child link=\"pin\"/></joint></robot>";
    let robot = Arc::new(Robot::parse("clock.urdf", urdf, &RobotOptions::new()).unwrap());
    let scene = RobotScene::new(Arc::clone(&robot), None, QueryOptions::default()).unwrap();
    let edges = scene.edges(&["turn"]).unwrap();
    // The hand's flank at 0.01 meets the pin's corner at (−0.795, 0.005).
    let corner = 0.795_f64.hypot(0.005);
    let first = std::f64::consts::PI - (0.005_f64 / 0.795).atan() - (0.01 / corner).asin();
    for turns in [1.0, 3.0, 100.0, 1e4, -1.0, -100.0_f64] {
        let way = std::f64::consts::TAU * turns;
        let answer = edges.check(&[0.0], &[way]).unwrap();
        let angle = answer.free_until() * way.abs();
        assert!(angle <= first + 1e-12 * way.abs() && angle > first - 1e-6, "{turns}: {angle} {first}");
    }
    // Many turns begin from far away: the same place to the rounding of the number itself.
    for begin in [2e3, 2e6] {
        let from = (begin / std::f64::consts::TAU).round() * std::f64::consts::TAU;
        let answer = edges.check(&[from], &[from + 6.0]).unwrap();
        let angle = answer.free_until() * 6.0;
        assert!((angle - first).abs() < 1e-15 * begin + 1e-6, "{begin}: {angle} {first}");
    }
    // Half a turn as files write it, onto a pin that a gap of 1e-13 beyond leaves: the answers differ as the numbers do.
    let written: f64 = "3.14159265359".parse().unwrap();
    for (end, sign) in [(written, 1.0), (std::f64::consts::PI, 1.0), (-written, -1.0)] {
        let clear = first - 1e-9;
        assert!(edges.check(&[0.0], &[sign * clear]).unwrap().is_free());
        let answer = edges.check(&[end - sign * 3.2], &[end]).unwrap();
        let met = (end.abs() - 3.2) + 3.2 * answer.free_until();
        assert!(met <= first && met > first - 1e-6, "{end}: {met} {first}");
    }
}

/// What a part leaves, one pair or all, with separations of pairs or of all, by names or by the SRDF: the same.
#[test]
fn options_of_all_and_of_pairs_are_the_same() {
    let mut random = Random(2905);
    let arm = arm(&mut random, 1.0);
    let links = ["l0", "l1", "l2", "l3"];
    let bodies = [&links[..], &["post", "cup"]].concat();
    for start in [Start::Report, Start::Leave] {
        let options = QueryOptions::default().with_min_separation(0.02).with_start(start);
        let of_all = scene(&arm, 1.0, options);
        let mut of_pairs = scene(&arm, 1.0, QueryOptions::default());
        for (k, a) in bodies.iter().enumerate() {
            for b in &bodies[..k] {
                assert!(
                    of_pairs.set_start([a, b], start) && of_pairs.set_min_separation([b, a], 0.02).unwrap()
                );
            }
        }
        let (mut contacts, mut free) = (0, 0);
        for k in 0..60 {
            let (from, to) = (draw(&mut random, 2.0), draw(&mut random, [2.0, 6.0][k % 2]));
            let [one, other] =
                [&of_all, &of_pairs].map(|scene| scene.edges(&NAMES).unwrap().check(&from, &to).unwrap());
            about_the_same(&one, &other, 1.0, 1e-8);
            if one.is_free() { free += 1 } else { contacts += 1 }
        }
        assert!(contacts > 10 && free > 5, "{contacts} {free}");
    }
    let srdf = "<robot name=\"x\"><disable_collisions link1=\"l3\" link2=\"l0\"/><disable_collisions link1=\"l1\" link2=\"l3\"/></robot>";
    let srdf = Srdf::parse("x.srdf", srdf).unwrap();
    let disabled = RobotScene::new(robot(&arm), Some(&srdf), QueryOptions::default()).unwrap();
    let mut ignored = RobotScene::new(robot(&arm), None, QueryOptions::default()).unwrap();
    assert!(ignored.ignore("l0", "l3") && ignored.ignore("l3", "l1"));
    for _ in 0..40 {
        let (from, to) = (draw(&mut random, 2.0), draw(&mut random, 4.0));
        let [one, other] =
            [&disabled, &ignored].map(|scene| scene.edges(&NAMES).unwrap().check(&from, &to).unwrap());
        assert_eq!(one, other);
    }
}

/// What is attached in the order of obstacles, before or after them, is the same scene; and a scene that was cloned is another one.
#[test]
fn the_order_in_which_bodies_come_changes_no_answer() {
    let mut random = Random(2906);
    let arm = arm(&mut random, 1.0);
    let one = scene(&arm, 1.0, QueryOptions::default());
    let mut other = RobotScene::new(robot(&arm), None, QueryOptions::default()).unwrap();
    let turn = DQuat::from_xyzw(0.1, 0.0, 0.2, 1.0);
    other
        .attach(Attached::new("cup", "l3", cuboid(DVec3::splat(0.03)), DVec3::X * 0.4, turn).unwrap())
        .unwrap();
    let post = cuboid(DVec3::new(0.05, 0.05, 0.5));
    let at = DVec3::new(0.5, 0.5, 0.2);
    let before = other.clone();
    other.add_obstacle(Obstacle::at_rest("post", post, at, DQuat::IDENTITY).unwrap()).unwrap();
    assert_eq!(before.names().count() + 1, other.names().count());
    let mut differ = 0;
    for _ in 0..60 {
        let (from, to) = (draw(&mut random, 1.0), draw(&mut random, 3.0));
        let [one, two, fewer] =
            [&one, &other, &before].map(|scene| scene.edges(&NAMES).unwrap().check(&from, &to).unwrap());
        about_the_same(&one, &two, 1.0, 1e-9);
        differ += usize::from(outcome(&one) != outcome(&fewer));
        assert!(fewer.free_until() >= one.free_until() - 1e-9);
    }
    assert!(differ > 5, "{differ}");
}

/// The bodies along a path as those of a world, where they move or are planned to: with the pairs that are checked.
#[test]
fn worlds_of_the_same_bodies_have_the_same_answer() {
    let mut random = Random(2907);
    let (mut contacts, mut free) = (0, 0);
    for round in 0..10 {
        let arm = arm(&mut random, 1.0);
        let options = QueryOptions::default().with_min_separation([0.0, 0.02][round % 2]);
        let all = scene(&arm, 1.0, options);
        for k in 0..8 {
            let path = path(&[1.0, 3.0], &[draw(&mut random, 1.0), draw(&mut random, [1.0, 3.0][k % 2])]);
            let along = all.bodies_along(&path).unwrap();
            let (mut moving, mut planned, mut plan) = (World::new(options), World::new(options), Vec::new());
            for body in 0..along.len() {
                let of = along.moving(body);
                let tree = Arc::new(of.body.clone());
                let (pose, _) = of.motion.pose_and_twist(1.0);
                let rest = ConstantTwist::REST.with_position(pose.transform_point(DVec3::ZERO));
                let rest = rest.with_orientation(pose.rotation);
                match of.motion.chain().map(|chain| -> SharedMotion { Arc::new(chain.clone()) }) {
                    None => {
                        moving.add(Body::new(Arc::clone(&tree), rest));
                        planned.add(Body::new(tree, rest));
                    }
                    Some(motion) => {
                        moving.add(Body::with_shared(Arc::clone(&tree), Arc::clone(&motion)));
                        plan.push(PlannedMotion { body: planned.add(Body::new(tree, rest)), motion });
                    }
                }
            }
            for world in [&mut moving, &mut planned] {
                let ids: Vec<BodyId> = world.ids().collect();
                for (a, b) in (0..ids.len()).flat_map(|a| (0..a).map(move |b| (a, b))) {
                    let is_checked = along.pairs().iter().any(|&pair| pair == [a, b] || pair == [b, a]);
                    world.ignore_pair(ids[a], ids[b], !is_checked);
                }
            }
            let answer = all.check_path(&path).unwrap();
            let (pair, until) = outcome(&answer);
            for found in
                [moving.first_contact(along.window()), planned.first_contact_of(&plan, along.window())]
            {
                let (other_pair, other_until) = match found.unwrap() {
                    FirstContact::Separated => (None, 3.0),
                    FirstContact::Contact { a, b, contact, .. } => {
                        let mut pair = [a, b].map(|id| along.name(id.index()).to_owned());
                        pair.sort();
                        (Some(pair), contact.time_lo)
                    }
                    undecided @ FirstContact::Undecided { .. } => panic!("{undecided:?}"),
                };
                assert_eq!(pair, other_pair);
                assert!((until - other_until).abs() < 1e-8, "{until} {other_until}");
            }
            if answer.is_free() { free += 1 } else { contacts += 1 }
        }
    }
    assert!(contacts > 10 && free > 10, "{contacts} {free}");
}
