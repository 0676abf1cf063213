//! Paths of robots made of boxes, held against samples by other code.

mod arm;

use arm::{BoxArm, BoxLink};
use d2m_bvh::QueryOptions;
use d2m_robot::{Interpolation, Robot, RobotOptions, RobotScene, Trajectory, TrajectoryPoint};
use d2m_testing::{Draw, Random};
use glam::DVec3;
use std::sync::Arc;

const KINDS: [&str; 4] = ["revolute", "continuous", "prismatic", "fixed"];

/// A chain of boxes with a side branch, a mimic joint, axes of any length, boxes in frames of their own, and a post beside it.
fn random_arm(random: &mut Random) -> BoxArm {
    let still = BoxLink {
        parent: None,
        kind: "fixed",
        xyz: DVec3::ZERO,
        rpy: DVec3::ZERO,
        axis: DVec3::X,
        size: DVec3::splat(0.1),
        at: DVec3::ZERO,
        turn: DVec3::ZERO,
        mimic: None,
    };
    let mut links = vec![still.clone()];
    for k in 1..6 {
        let kind = if k < 3 { "revolute" } else { KINDS[random.index(4)] };
        let is_follower = k == 5 && kind != "fixed" && links[3].kind != "fixed";
        links.push(BoxLink {
            parent: Some(if k == 5 { 3 } else { k - 1 }),
            kind,
            xyz: DVec3::X * 0.35 + random.vector() * 0.1,
            rpy: if random.unit() < 0.5 { DVec3::ZERO } else { random.vector() * 1.5 },
            axis: random.vector() * 2.0,
            size: DVec3::new(0.3, 0.06, 0.05) + random.vector() * 0.02,
            at: DVec3::X * 0.15,
            turn: random.vector() * 0.3,
            mimic: is_follower.then_some((3, -0.5, 0.25)),
        });
    }
    let beside = random.direction() * random.between(0.4, 1.2);
    links.push(BoxLink {
        parent: Some(0),
        xyz: beside,
        rpy: random.vector(),
        size: DVec3::new(0.2, 0.2, 0.3),
        ..still
    });
    BoxArm { links }
}

fn is_free_joint(link: &BoxLink) -> bool {
    link.parent.is_some() && link.kind != "fixed" && link.mimic.is_none()
}

/// The values of all joints from those of the free ones.
fn all_values(arm: &BoxArm, free: &[f64]) -> Vec<f64> {
    let mut q = vec![0.0; arm.links.len()];
    let places = (0..arm.links.len()).filter(|&k| is_free_joint(&arm.links[k]));
    for (place, value) in places.zip(free) {
        q[place] = *value;
    }
    for k in 0..arm.links.len() {
        if let Some((joint, multiplier, offset)) = arm.links[k].mimic {
            q[k] = multiplier * q[joint] + offset;
        }
    }
    q
}

/// The least gap of all pairs that no joint joins.
fn least_gap(arm: &BoxArm, q: &[f64]) -> (f64, [usize; 2]) {
    let placed = arm.place(q);
    let mut least = (f64::INFINITY, [0, 0]);
    for a in 0..placed.len() {
        for b in 0..a {
            let joined = arm.links[a].parent == Some(b) || arm.links[b].parent == Some(a);
            let gap = placed[a].gap(&placed[b]);
            if !joined && gap < least.0 {
                least = (gap, [b, a]);
            }
        }
    }
    least
}

fn scene_of(arm: &BoxArm, separation: f64) -> RobotScene {
    let robot = Robot::parse("boxes.urdf", &arm.urdf(), &RobotOptions::new()).unwrap();
    let options = QueryOptions::default().with_min_separation(separation);
    RobotScene::new(Arc::new(robot), None, options).unwrap()
}

/// Positions on the way of a path, by the basis of Hermite.
fn position(points: &[TrajectoryPoint], interpolation: Interpolation, t: f64) -> Vec<f64> {
    let last = points.len() - 2;
    let piece = (0..=last).rev().find(|&k| points[k].time_from_start <= t).unwrap_or(0);
    let (p, q) = (&points[piece], &points[piece + 1]);
    let h = q.time_from_start - p.time_from_start;
    let u = (t - p.time_from_start) / h;
    let w = 1.0 - u;
    (0..p.positions.len())
        .map(|k| match interpolation {
            Interpolation::Linear => p.positions[k] * w + q.positions[k] * u,
            _ => {
                p.positions[k] * w * w * (1.0 + 2.0 * u)
                    + q.positions[k] * u * u * (3.0 - 2.0 * u)
                    + h * (p.velocities[k] * u * w * w - q.velocities[k] * u * u * w)
            }
        })
        .collect()
}

#[test]
fn random_paths_are_answered_right() {
    let mut random = Random(7);
    let (mut contacts, mut free) = (0, 0);
    for round in 0..60 {
        let arm = random_arm(&mut random);
        let interpolation = [Interpolation::Linear, Interpolation::Cubic][round % 2];
        let names: Vec<String> =
            (0..arm.links.len()).filter(|&k| is_free_joint(&arm.links[k])).map(|k| format!("j{k}")).collect();
        let mut time = random.signed();
        let points: Vec<TrajectoryPoint> = (0..2 + round % 3)
            .map(|_| {
                time += random.between(0.3, 1.0);
                let mut list = |size: f64| names.iter().map(|_| size * random.signed()).collect::<Vec<_>>();
                let point = TrajectoryPoint::new(time, list(1.2));
                if interpolation == Interpolation::Cubic { point.with_velocities(list(1.0)) } else { point }
            })
            .collect();
        let path = Trajectory::new(names, points.clone()).with_interpolation(interpolation);
        let separation = [0.0, 0.01][round / 2 % 2];
        let answer = scene_of(&arm, separation).check_path(&path).unwrap();
        let [start, end] = path.times().unwrap();
        let gap_at = |t: f64| least_gap(&arm, &all_values(&arm, &position(&points, interpolation, t)));
        // Everything before the certified time is free; gaps along axes are lower bounds, so above the separation is proof enough.
        let steps = 3000;
        let until = answer.free_until();
        for k in 0..=steps {
            let t = start + (until - start) * f64::from(k) / f64::from(steps);
            let (gap, pair) = gap_at(t);
            let begins_in_contact = until == start;
            assert!(
                gap > -1e-9 || begins_in_contact,
                "round {round}: {gap:e} of {pair:?} at {t} before {until}"
            );
        }
        if let Some(found) = answer.contact() {
            contacts += 1;
            // At that time they are in contact: no axis is further apart than the separation and the tolerance.
            let (_, pair) = gap_at(found.contact.time_hi);
            let mut names = [found.a.clone(), found.b.clone()];
            names.sort();
            let placed =
                arm.place(&all_values(&arm, &position(&points, interpolation, found.contact.time_hi)));
            let [a, b] = [&names[0], &names[1]].map(|name| name[1..].parse::<usize>().unwrap());
            assert!(placed[a].gap(&placed[b]) < separation + 1e-8, "round {round}: {pair:?} {names:?}");
        } else {
            free += 1;
            assert!(answer.is_free() && until == end);
        }
    }
    assert!(contacts > 15 && free > 5, "{contacts} contacts, {free} free");
}

#[test]
fn a_plate_that_fifty_samples_miss_is_found() {
    // A long arm sweeps past a plate of a tenth of a millimeter that stands in its way.
    let urdf = |plate: f64| {
        format!(
            "<robot name=\"sweep\"><link name=\"base\"/><link name=\"arm\"><collision><origin xyz=\"0.5 0 0\"/>\
             <geometry><box size=\"1 0.002 0.002\"/></geometry></collision></link>\
             <link name=\"plate\"><collision><geometry><box size=\"0.2 {plate:?} 0.2\"/></geometry></collision></link>\
             <joint name=\"turn\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/><axis xyz=\"0 0 3\"/></joint>\
             <joint name=\"weld\" type=\"fixed\"><parent link=\"base\"/><child link=\"plate\"/>\
             <origin xyz=\"0.9 0.2 0\" rpy=\"0 0 0.2186689459\"/></joint></robot>"
        )
    };
    let robot = Robot::parse("sweep.urdf", &urdf(1e-4), &RobotOptions::new()).unwrap();
    let scene = RobotScene::new(Arc::new(robot), None, QueryOptions::default()).unwrap();
    let [from, to] = [-1.0, 1.48];
    // The line of the arm meets the plate where its direction is that of the plate's middle, 12.5 degrees.
    let middle = (0.2_f64 / 0.9).atan();
    let nearest = (0..=50)
        .map(|k| (from + (to - from) * f64::from(k) / 50.0 - middle).abs())
        .fold(f64::INFINITY, f64::min);
    // Half of both thicknesses, at the inner end of the plate.
    assert!(nearest > 0.002 / 0.8, "a sample is at the plate: {nearest}");
    let edges = scene.edges(&["turn"]).unwrap();
    let answer = edges.check(&[from], &[to]).unwrap();
    let contact = answer.contact().expect("the plate is in the way");
    let mut names = [contact.a.as_str(), contact.b.as_str()];
    names.sort_unstable();
    assert_eq!(names, ["arm", "plate"]);
    let angle = from + (to - from) * answer.free_until();
    assert!(angle < middle && angle > middle - 0.002, "{angle} {middle}");
    // A batch gives what single edges give.
    let all = [[from, to], [0.4, 1.4], [from, 0.0], [to, from]];
    let (starts, ends): (Vec<_>, Vec<_>) = all.iter().map(|[a, b]| ([*a], [*b])).unzip();
    let batch =
        edges.check_all(starts.iter().map(<[f64; 1]>::as_slice).zip(ends.iter().map(<[f64; 1]>::as_slice)));
    let single: Vec<_> = starts.iter().zip(&ends).map(|(a, b)| edges.check(a, b).unwrap()).collect();
    assert_eq!(batch.unwrap(), single);
    assert_eq!(
        single.iter().map(d2m_robot::PathAnswer::is_free).collect::<Vec<_>>(),
        [false, true, true, false]
    );
}

#[test]
fn joints_that_are_not_named_rest_and_mimic() {
    let mut random = Random(3);
    for _ in 0..20 {
        let arm = random_arm(&mut random);
        let robot = Robot::parse("boxes.urdf", &arm.urdf(), &RobotOptions::new()).unwrap();
        let point = |time: f64| TrajectoryPoint::new(time, vec![0.7, -0.4]);
        let path = Trajectory::new(vec!["j2".into(), "j1".into()], vec![point(0.0), point(1.0)]);
        let motions = robot.link_motions(&path).unwrap();
        let mut q = vec![0.0; arm.links.len()];
        (q[2], q[1]) = (0.7, -0.4);
        if let Some((_, _, offset)) = arm.links[5].mimic {
            q[5] = offset;
        }
        for (k, (motion, placed)) in motions.iter().zip(arm.place(&q)).enumerate() {
            use d2m_motion::RigidMotion;
            let state = motion.enclose_state(0.5);
            let center = state.rotation * arm.links[k].at + state.position;
            assert!((center - placed.center).length() < 1e-12, "link {k}");
            assert!(state.position_radius < 1e-12 && state.rotation_radius < 1e-12);
        }
    }
}

#[test]
fn spheres_and_capsules_are_exact() {
    let slide = |shape: &str, size: &str| {
        format!(
            "<robot name=\"s\"><link name=\"rail\"/>\
             <link name=\"cart\"><collision><origin rpy=\"0 1.5707963267948966 0\"/><geometry>{shape}</geometry></collision></link>\
             <link name=\"stop\"><collision><origin xyz=\"2 0.03 0\"/><geometry>{size}</geometry></collision></link>\
             <joint name=\"run\" type=\"prismatic\"><parent link=\"rail\"/><child link=\"cart\"/></joint>\
             <joint name=\"weld\" type=\"fixed\"><parent link=\"rail\"/><child link=\"stop\"/></joint></robot>"
        )
    };
    let sphere = "<sphere radius=\"0.25\"/>";
    let touching = (0.75_f64 * 0.75 - 0.03 * 0.03).sqrt();
    for (shape, stop, separation, expected) in [
        (sphere, "<box size=\"1 1 1\"/>", 0.0, 1.25),
        (sphere, "<box size=\"1 1 1\"/>", 0.125, 1.125),
        (sphere, "<sphere radius=\"0.5\"/>", 0.0, 2.0 - touching),
        ("<capsule radius=\"0.25\" length=\"0.5\"/>", "<box size=\"1 1 1\"/>", 0.0, 1.0),
        ("<capsule radius=\"0.25\" length=\"0.5\"/>", "<sphere radius=\"0.5\"/>", 0.0, 1.75 - touching),
        (
            "<capsule radius=\"0.25\" length=\"0.5\"/>",
            "<cylinder radius=\"0.5\" length=\"1\"/>",
            0.0,
            1.75 - touching,
        ),
    ] {
        let robot = Robot::parse("slide.urdf", &slide(shape, stop), &RobotOptions::new()).unwrap();
        let is_exact = robot.remarks().is_empty();
        let options = QueryOptions::default().with_min_separation(separation);
        let scene = RobotScene::new(Arc::new(robot), None, options).unwrap();
        let answer = scene.edges(&["run"]).unwrap().check(&[0.0], &[2.0]).unwrap();
        let found = answer.contact().unwrap_or_else(|| panic!("{shape} {stop}: {answer:?}"));
        let way = 2.0 * answer.free_until();
        assert!(way <= expected, "{shape} {stop}: {way}");
        let early = if is_exact { 1e-9 } else { 1e-3 };
        assert!(way > expected - early, "{shape} {stop}: {way} {expected}");
        // The points are on the surfaces: as far apart as the separation that is left.
        let apart = (found.contact.point_a - found.contact.point_b).length();
        assert!((apart - found.contact.separation).abs() < 1e-9 && apart >= separation, "{apart}");
        assert!(apart < separation + 1e-9);
    }
    // What begins in a sphere is in contact at the start.
    let robot = Robot::parse(
        "slide.urdf",
        &slide("<box size=\"0.1 0.1 0.1\"/>", "<sphere radius=\"3\"/>"),
        &RobotOptions::new(),
    );
    let scene = RobotScene::new(Arc::new(robot.unwrap()), None, QueryOptions::default()).unwrap();
    let answer = scene.edges(&["run"]).unwrap().check(&[0.0], &[2.0]).unwrap();
    assert!(answer.contact().is_some() && answer.free_until() == 0.0);
    // Of spheres about points that are apart the insides overlap.
    let overlapping = slide(sphere, "<sphere radius=\"1.9\"/>");
    let robot = Robot::parse("slide.urdf", &overlapping, &RobotOptions::new()).unwrap();
    let scene = RobotScene::new(Arc::new(robot), None, QueryOptions::default()).unwrap();
    let answer = scene.edges(&["run"]).unwrap().check(&[0.0], &[2.0]).unwrap();
    let start = answer.contact().map(|found| found.contact.start);
    assert_eq!(start, Some(d2m_bvh::StartState::Overlapping));
}

/// Where a link is within the tolerance of an obstacle when a path begins, as a query of the pair says: in contact at once.
#[test]
fn what_is_within_the_tolerance_at_the_start_is_in_contact() {
    let urdf = "<robot name=\"r\"><link name=\"base\"/><link name=\"cart\"><collision><geometry><box size=\"1 1 1\"/></geometry></collision></link>\
         <joint name=\"run\" type=\"prismatic\"><parent link=\"base\"/><child link=\"cart\"/><axis xyz=\"1 0 0\"/></joint></robot>";
    let robot = Arc::new(Robot::parse("r.urdf", urdf, &RobotOptions::new()).unwrap());
    let cube = Arc::new(d2m_bvh::MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
    for (gap, tolerance) in [(0.9e-2, Some(1e-2)), (0.5e-10, None), (1.1e-2, Some(1e-2))] {
        for separation in [0.0, 0.25] {
            let mut options = QueryOptions::default().with_min_separation(separation);
            options.tolerance = tolerance;
            let mut scene = RobotScene::new(Arc::clone(&robot), None, options).unwrap();
            let place = DVec3::X * -(1.0 + separation + gap);
            let obstacle =
                d2m_robot::Obstacle::at_rest("wall", Arc::clone(&cube), place, glam::DQuat::IDENTITY);
            scene.add_obstacle(obstacle.unwrap()).unwrap();
            let answer = scene.edges(&["run"]).unwrap().check(&[0.0], &[2.0]).unwrap();
            let is_free = tolerance.is_some_and(|tolerance| gap > tolerance);
            assert_eq!(answer.is_free(), is_free, "{gap} {separation}");
            assert!(is_free || answer.free_until() == 0.0);
        }
    }
}

/// Two links that are welded to each other (by way of a third), or a link that never moves and an obstacle, in contact or not: every path
/// says so.
#[test]
fn what_never_moves_against_each_other_counts_too() {
    let urdf = |gap: f64| {
        let part = |at: f64| {
            format!(
                "<collision><origin xyz=\"{at:?} 0 0\"/><geometry><box size=\"1 1 1\"/></geometry></collision>"
            )
        };
        let weld = |name: &str, parent: &str, child: &str| {
            format!(
                "<joint name=\"{name}\" type=\"fixed\"><parent link=\"{parent}\"/><child link=\"{child}\"/></joint>"
            )
        };
        format!(
            "<robot name=\"w\"><link name=\"base\"/><link name=\"a\">{}</link><link name=\"between\"/><link name=\"b\">{}</link>\
             <joint name=\"run\" type=\"prismatic\"><parent link=\"base\"/><child link=\"a\"/><axis xyz=\"0 0 1\"/></joint>{}{}</robot>",
            part(0.0),
            part(1.0 + gap),
            weld("v", "a", "between"),
            weld("w", "between", "b")
        )
    };
    let robot = |gap: f64| Arc::new(Robot::parse("w.urdf", &urdf(gap), &RobotOptions::new()).unwrap());
    let check = |scene: &RobotScene| scene.edges(&["run"]).unwrap().check(&[0.0], &[2.0]).unwrap();
    for (gap, separation, expected) in [(0.1, 0.0, true), (-0.1, 0.0, false), (0.1, 0.2, false)] {
        let options = QueryOptions::default().with_min_separation(separation);
        let answer = check(&RobotScene::new(robot(gap), None, options).unwrap());
        assert_eq!(answer.is_free(), expected, "{gap} {separation}");
        assert!(expected || answer.free_until() == 0.0);
    }
    let cube = Arc::new(d2m_bvh::MeshTree::new(
        d2m_bvh::TriMesh::try_new(
            vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
            vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        )
        .unwrap(),
    ));
    let fixed = urdf(0.1).replace("prismatic", "fixed");
    let with_arm = fixed.replace("</robot>", "<link name=\"tip\"/><joint name=\"far\" type=\"prismatic\"><parent link=\"base\"/><child link=\"tip\"/></joint></robot>");
    let robot = Arc::new(Robot::parse("w.urdf", &with_arm, &RobotOptions::new()).unwrap());
    for (at, is_free) in [(9.0, true), (0.25, false)] {
        let mut scene = RobotScene::new(Arc::clone(&robot), None, QueryOptions::default()).unwrap();
        let obstacle =
            d2m_robot::Obstacle::at_rest("cube", Arc::clone(&cube), DVec3::Y * at, glam::DQuat::IDENTITY);
        scene.add_obstacle(obstacle.unwrap()).unwrap();
        let answer = scene.edges(&["far"]).unwrap().check(&[0.0], &[2.0]).unwrap();
        assert_eq!(answer.is_free(), is_free, "{at}");
        // An obstacle that comes to a link that never moves.
        let coming = d2m_motion::ConstantTwist::REST
            .with_position(DVec3::Y * (at + 5.0))
            .with_linear_velocity(DVec3::Y * -20.0);
        let mut scene = RobotScene::new(Arc::clone(&robot), None, QueryOptions::default()).unwrap();
        scene.add_obstacle(d2m_robot::Obstacle::moving("comet", Arc::clone(&cube), coming)).unwrap();
        let answer = scene.edges(&["far"]).unwrap().check(&[0.0], &[2.0]).unwrap();
        assert!((answer.free_until() - (at + 4.5) / 20.0).abs() < 1e-9, "{answer:?}");
    }
}

#[test]
fn clearances_hold_the_least_distance() {
    // A cart passes a stop at a distance of 0.3 (box) or 0.25 (ball), at half of the way; another post is further away.
    for (shape, expected) in [("<box size=\"0.2 0.4 0.2\"/>", 0.3), ("<sphere radius=\"0.25\"/>", 0.25)] {
        let urdf = format!(
            "<robot name=\"s\"><link name=\"rail\"/>\
             <link name=\"cart\"><collision><geometry><box size=\"0.1 0.4 0.1\"/></geometry></collision></link>\
             <link name=\"stop\"><collision><origin xyz=\"1 0.7 0\"/><geometry>{shape}</geometry></collision></link>\
             <link name=\"post\"><collision><origin xyz=\"1 0 0.9\"/><geometry><box size=\"1 1 1\"/></geometry></collision></link>\
             <joint name=\"run\" type=\"prismatic\"><parent link=\"rail\"/><child link=\"cart\"/></joint>\
             <joint name=\"weld\" type=\"fixed\"><parent link=\"rail\"/><child link=\"stop\"/></joint>\
             <joint name=\"weld2\" type=\"fixed\"><parent link=\"rail\"/><child link=\"post\"/></joint></robot>"
        );
        let robot = Arc::new(Robot::parse("slide.urdf", &urdf, &RobotOptions::new()).unwrap());
        for separation in [0.0, 0.01] {
            let options = QueryOptions::default().with_min_separation(separation);
            let mut scene = RobotScene::new(Arc::clone(&robot), None, options).unwrap();
            assert!(scene.ignore("stop", "post"));
            let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
            let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, 2.0)]);
            let found = scene.clearance(&path).unwrap().unwrap();
            let truth = expected - separation;
            // The corners of the boxes are not exact.
            assert!(found.lower <= truth + 1e-15 && truth <= found.upper + 1e-15, "{found:?} {truth}");
            assert!(found.upper - found.lower <= 1e-6 * truth, "{found:?}");
            let mut names = [found.a.as_str(), found.b.as_str()];
            names.sort_unstable();
            assert_eq!((names, found.status), (["cart", "stop"], d2m_bvh::ClearanceStatus::Clear));
            assert!((0.35..=0.65).contains(&found.time), "{found:?}");
        }
        // No pair is checked.
        let mut scene = RobotScene::new(Arc::clone(&robot), None, QueryOptions::default()).unwrap();
        let point = |time: f64, x: f64| TrajectoryPoint::new(time, vec![x]);
        let path = Trajectory::new(vec!["run".into()], vec![point(0.0, 0.0), point(1.0, 1.0)]);
        for (a, b) in [("cart", "stop"), ("cart", "post"), ("stop", "post")] {
            assert!(scene.ignore(a, b));
        }
        assert_eq!(scene.clearance(&path).unwrap(), None);
    }
}
