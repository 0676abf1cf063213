//! Families of robots other than a single arm, and edges of planners, held against dense samples by other code.

mod arm;

use arm::{BoxArm, BoxLink, PlacedBox};
use d2m_bvh::{MeshTree, QueryOptions, TriMesh};
use d2m_motion::ConstantTwist;
use d2m_robot::{Obstacle, PathAnswer, Robot, RobotOptions, RobotScene};
use d2m_testing::{Draw, Random};
use glam::{DMat3, DQuat, DVec3};
use std::sync::Arc;

const SAMPLES: u32 = 600;

fn link(parent: usize, kind: &'static str, xyz: DVec3, axis: DVec3, size: DVec3) -> BoxLink {
    let zero = DVec3::ZERO;
    BoxLink { parent: Some(parent), kind, xyz, rpy: zero, axis, size, at: zero, turn: zero, mimic: None }
}

fn base() -> BoxLink {
    BoxLink { parent: None, ..link(0, "fixed", DVec3::ZERO, DVec3::X, DVec3::splat(0.1)) }
}

/// Two joints that turn about z, one that shifts along it, and one that turns the tool.
fn scara() -> Vec<BoxLink> {
    let beam = DVec3::new(0.4, 0.08, 0.06);
    vec![
        base(),
        BoxLink { at: DVec3::X * 0.2, ..link(0, "revolute", DVec3::Z * 0.3, DVec3::Z, beam) },
        BoxLink {
            at: DVec3::X * 0.2,
            ..link(1, "revolute", DVec3::new(0.4, 0.0, 0.1), DVec3::Z * 3.0, beam)
        },
        link(2, "prismatic", DVec3::X * 0.4, -DVec3::Z, DVec3::new(0.03, 0.03, 0.3)),
        link(3, "continuous", DVec3::Z * -0.2, DVec3::Z, DVec3::new(0.2, 0.03, 0.03)),
    ]
}

/// Three joints that shift at right angles, with a hand that turns below.
fn gantry() -> Vec<BoxLink> {
    vec![
        base(),
        link(0, "prismatic", DVec3::Z * 1.0, DVec3::X * 2.0, DVec3::new(0.1, 1.4, 0.1)),
        link(1, "prismatic", DVec3::Z * 0.15, DVec3::Y, DVec3::splat(0.15)),
        BoxLink {
            rpy: DVec3::new(3.0, 0.0, 0.3),
            ..link(2, "prismatic", DVec3::ZERO, DVec3::Z, DVec3::new(0.05, 0.05, 0.8))
        },
        link(3, "revolute", DVec3::Z * 0.45, DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.3, 0.04, 0.04)),
    ]
}

/// A base that drives in the plane and turns, with an arm on it.
fn mobile() -> Vec<BoxLink> {
    let beam = DVec3::new(0.35, 0.06, 0.06);
    vec![
        base(),
        link(0, "prismatic", DVec3::Z * 0.2, DVec3::X, DVec3::splat(0.05)),
        link(1, "prismatic", DVec3::ZERO, DVec3::Y, DVec3::splat(0.05)),
        link(2, "continuous", DVec3::Z * 0.1, DVec3::Z, DVec3::new(0.5, 0.3, 0.1)),
        BoxLink { at: DVec3::X * 0.17, ..link(3, "revolute", DVec3::Z * 0.12, DVec3::Y, beam) },
        BoxLink {
            at: DVec3::X * 0.17,
            ..link(4, "revolute", DVec3::X * 0.36, DVec3::new(0.0, 1.0, 0.2), beam)
        },
    ]
}

/// Two arms side by side, one with a gripper whose second finger follows the first by way of a third joint.
fn dual() -> Vec<BoxLink> {
    let beam = DVec3::new(0.3, 0.05, 0.05);
    let upper = |side: f64| BoxLink {
        at: DVec3::X * 0.15,
        ..link(0, "revolute", DVec3::new(0.0, side, 0.2), DVec3::Z, beam)
    };
    let lower = |parent: usize| BoxLink {
        at: DVec3::X * 0.15,
        ..link(parent, "revolute", DVec3::X * 0.31, DVec3::new(0.0, 0.3, 1.0), beam)
    };
    let finger = |side: f64, mimic: Option<(usize, f64, f64)>| BoxLink {
        at: DVec3::X * 0.04,
        mimic,
        ..link(
            3,
            "prismatic",
            DVec3::new(0.31, side * 0.02, 0.0),
            DVec3::Y * side,
            DVec3::new(0.08, 0.01, 0.02),
        )
    };
    vec![
        base(),
        upper(0.25),
        upper(-0.25),
        lower(1),
        lower(2),
        finger(1.0, None),
        finger(-1.0, Some((5, 0.5, 0.01))),
        finger(-1.0, Some((6, 2.0, -0.02))),
    ]
}

fn free_joints(arm: &BoxArm) -> Vec<usize> {
    let is_free = |&k: &usize| {
        let link = &arm.links[k];
        link.parent.is_some() && link.kind != "fixed" && link.mimic.is_none()
    };
    (0..arm.links.len()).filter(is_free).collect()
}

fn place(arm: &BoxArm, free: &[usize], configuration: &[f64]) -> Vec<PlacedBox> {
    let mut q = vec![0.0; arm.links.len()];
    for (&joint, &value) in free.iter().zip(configuration) {
        q[joint] = value;
    }
    for k in 0..q.len() {
        if let Some((leader, multiplier, offset)) = arm.links[k].mimic {
            q[k] = multiplier * q[leader] + offset;
        }
    }
    arm.place(&q)
}

fn cuboid(half: DVec3) -> Arc<MeshTree> {
    let corner = |k: usize| {
        let side = |axis: usize| if k >> axis & 1 == 1 { half[axis] } else { -half[axis] };
        DVec3::new(side(0), side(1), side(2))
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Arc::new(MeshTree::new(TriMesh::try_new((0..8).map(corner).collect(), triangles.collect()).unwrap()))
}

/// A box that flies through the scene, turning about its middle, or rests.
struct FlyingBox {
    half: DVec3,
    from: DVec3,
    velocity: DVec3,
    spin: DVec3,
}

impl FlyingBox {
    fn random(random: &mut Random, is_at_rest: bool) -> Self {
        let half = DVec3::new(0.2, 0.1, 0.01) * random.between(0.3, 1.0);
        let speed = if is_at_rest { 0.0 } else { 1.0 };
        let from = random.direction() * random.between(0.3, 1.0) + DVec3::Z * 0.3;
        Self { half, from, velocity: random.vector() * speed, spin: random.vector() * speed }
    }

    fn at(&self, time: f64) -> PlacedBox {
        let angle = self.spin * time;
        let axes = DMat3::from_quat(DQuat::from_scaled_axis(angle));
        PlacedBox { center: self.from + self.velocity * time, axes, half: self.half }
    }

    fn obstacle(&self, name: &str) -> Obstacle {
        let tree = cuboid(self.half);
        if self.velocity == DVec3::ZERO {
            return Obstacle::at_rest(name, tree, self.from, DQuat::IDENTITY).unwrap();
        }
        let motion = ConstantTwist::REST.with_position(self.from);
        let motion = motion.with_linear_velocity(self.velocity).with_angular_velocity(self.spin);
        Obstacle::moving(name, tree, motion)
    }
}

/// Edges of every family among boxes that rest and fly: nothing before the certified time touches at any sample, and the pair that
/// is named does at its time.
#[test]
fn edges_of_every_family_hold_against_samples() {
    let mut random = Random(2029);
    let (mut contacts, mut free, mut inside) = (0, 0, 0);
    for (family, links) in [scara(), gantry(), mobile(), dual()].into_iter().enumerate() {
        let arm = BoxArm { links };
        let joints = free_joints(&arm);
        let names: Vec<String> = joints.iter().map(|k| format!("j{k}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let robot = Arc::new(Robot::parse("family.urdf", &arm.urdf(), &RobotOptions::new()).unwrap());
        for round in 0..12_u32 {
            let separation = [0.0, 0.01][round as usize % 2];
            let options = QueryOptions::default().with_min_separation(separation);
            let mut scene = RobotScene::new(Arc::clone(&robot), None, options).unwrap();
            let obstacles: Vec<FlyingBox> =
                (0..3).map(|k| FlyingBox::random(&mut random, (k + round) % 3 != 0)).collect();
            for (k, of) in obstacles.iter().enumerate() {
                scene.add_obstacle(of.obstacle(&format!("o{k}"))).unwrap();
            }
            let step = [0.05, 0.4, 2.0][round as usize % 3];
            let mut draw =
                |size: f64| -> Vec<f64> { joints.iter().map(|_| random.signed() * size).collect() };
            let edges: Vec<[Vec<f64>; 2]> = (0..6)
                .map(|_| {
                    let from = draw(0.6);
                    let to = from.iter().zip(draw(step)).map(|(a, b)| a + b).collect();
                    [from, to]
                })
                .collect();
            let checker = scene.edges(&names).unwrap();
            let answers = checker.check_all(edges.iter().map(|[from, to]| (&from[..], &to[..]))).unwrap();
            for ([from, to], answer) in edges.iter().zip(&answers) {
                assert_eq!(*answer, checker.check(from, to).unwrap());
                let bodies = |t: f64| {
                    let q: Vec<f64> = from.iter().zip(to).map(|(a, b)| a + (b - a) * t).collect();
                    let mut all = place(&arm, &joints, &q);
                    all.extend(obstacles.iter().map(|of| of.at(t)));
                    all
                };
                let count = arm.links.len();
                let is_checked = |a: usize, b: usize| {
                    let is_joined = |a: usize, b: usize| b < count && arm.links[b].parent == Some(a);
                    a < count && !is_joined(a, b) && !(b < count && is_joined(b, a))
                };
                let least = |t: f64| {
                    let placed = bodies(t);
                    let pairs = (0..placed.len()).flat_map(|a| (a + 1..placed.len()).map(move |b| (a, b)));
                    let gaps = pairs
                        .filter(|&(a, b)| is_checked(a, b))
                        .map(|(a, b)| (placed[a].gap(&placed[b]), [a, b]));
                    gaps.min_by(|x, y| x.0.total_cmp(&y.0)).unwrap()
                };
                let until = answer.free_until();
                for k in 0..=SAMPLES {
                    let t = until * f64::from(k) / f64::from(SAMPLES);
                    let (gap, pair) = least(t);
                    assert!(
                        gap > -1e-9 || until == 0.0,
                        "family {family}, round {round}: {gap:e} of {pair:?} at {t} before {until}"
                    );
                }
                match answer {
                    PathAnswer::Free { until, .. } => {
                        free += 1;
                        assert_eq!(*until, 1.0);
                    }
                    PathAnswer::Contact(found) => {
                        contacts += 1;
                        inside += i32::from(until > 0.0);
                        let placed = bodies(found.contact.time_hi);
                        let [a, b] = [&found.a, &found.b].map(|name| {
                            let number = name[1..].parse::<usize>().unwrap();
                            if name.starts_with('o') { count + number } else { number }
                        });
                        let gap = placed[a].gap(&placed[b]);
                        assert!(
                            gap < separation + 1e-8,
                            "family {family}, round {round}: {gap:e} of {a} {b}"
                        );
                    }
                    undecided @ PathAnswer::Undecided { .. } => panic!("{undecided:?}"),
                }
            }
        }
    }
    assert!(
        contacts > 60 && free > 40 && inside > 30,
        "{contacts} contacts, {inside} on the way, {free} free"
    );
}
