//! Bodies that were said to overlap though they touch, or to touch though they overlap: found by an adversary.

use d2m_bvh::{
    Budget, MeshTree, Moving, Posed, QueryOptions, Solid, StartState, TriMesh, Window, departure, distance,
    time_of_contact,
};
use d2m_interval::Interval;
use d2m_motion::{CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};
use std::collections::BTreeSet;

fn tetrahedron(corners: [[f64; 3]; 4]) -> MeshTree {
    let [a, b, c, d] = corners.map(DVec3::from);
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let is_outward = (b - a).cross(c - a).dot(d - a) > 0.0;
    let faces = faces.map(|[i, j, k]| if is_outward { [i, j, k] } else { [i, k, j] });
    MeshTree::new(TriMesh::try_new(vec![a, b, c, d], faces.to_vec()).unwrap())
}

fn state(a: &MeshTree, b: &MeshTree) -> StartState {
    distance(Posed::at_rest(a), Posed::at_rest(b), Solid::Filled).unwrap().state
}

/// Two ridges that cross at the origin at small angles: z = 0 is between them, and only across their edges.
#[test]
fn ridges_that_cross_at_small_angles_do_not_overlap() {
    let below = tetrahedron([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, -1.0], [0.0, 1.0, -1.0]]);
    for exponent in 10..53 {
        let slope = 2_f64.powi(-exponent);
        let ridge =
            |z: f64| tetrahedron([[-1.0, -slope, z], [1.0, slope, z], [0.0, -1.0, 1.0], [0.0, 1.0, 1.0]]);
        let found = [state(&below, &ridge(0.0)), state(&ridge(0.0), &below)];
        assert!(!found.contains(&StartState::Overlapping), "{exponent}: {found:?}");
        assert!(exponent > 22 || found == [StartState::Touching; 2], "{exponent}: {found:?}");
        assert_eq!(state(&below, &ridge(-1e-3)), StartState::Overlapping, "{exponent}");
    }
}

/// A slab between two heights, `n` by `n` squares on both sides, with the heights of the lower vertices given by their numbers.
fn slab(n: u32, low: impl Fn(u32, u32) -> f64, high: f64) -> MeshTree {
    let side = n + 1;
    let at = |layer: u32, i: u32, j: u32| layer * side * side + i * side + j;
    let mut vertices = Vec::new();
    for layer in [0, 1] {
        for i in 0..side {
            for j in 0..side {
                let z = if layer == 0 { low(i, j) } else { high };
                vertices.push(DVec3::new(f64::from(i) / f64::from(n), f64::from(j) / f64::from(n), z));
            }
        }
    }
    let mut faces = Vec::new();
    let mut square = |[a, b, c, d]: [u32; 4]| faces.extend([[a, b, c], [a, c, d]]);
    for i in 0..n {
        for j in 0..n {
            square([at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j)]);
            square([at(1, i, j), at(1, i + 1, j), at(1, i + 1, j + 1), at(1, i, j + 1)]);
        }
        square([at(0, i, 0), at(0, i + 1, 0), at(1, i + 1, 0), at(1, i, 0)]);
        square([at(0, i + 1, n), at(0, i, n), at(1, i, n), at(1, i + 1, n)]);
        square([at(0, 0, i + 1), at(0, 0, i), at(1, 0, i), at(1, 0, i + 1)]);
        square([at(0, n, i), at(0, n, i + 1), at(1, n, i + 1), at(1, n, i)]);
    }
    MeshTree::new(TriMesh::try_new(vertices, faces).unwrap())
}

/// More pairs of triangles touch than are judged one by one, and one vertex somewhere is an ulp inside of the other body.
#[test]
fn crowds_that_touch_hide_no_overlap_by_an_ulp() {
    for n in [4, 16, 24] {
        let below = slab(n, |_, _| 0.0, 1.0);
        assert_eq!(state(&below, &slab(n, |_, _| 1.0, 2.0)), StartState::Touching, "{n}");
        for inside in [[1, 1], [n / 2, n / 2], [n - 1, n - 1], [1, n - 1], [n / 2, 1]] {
            let dented = slab(n, |i, j| if [i, j] == inside { 1_f64.next_down() } else { 1.0 }, 2.0);
            assert_ne!(state(&below, &dented), StartState::Touching, "{n} {inside:?}");
            assert_ne!(state(&dented, &below), StartState::Touching, "{n} {inside:?}");
        }
    }
}

/// Cubes that overlap in all of a face: no triangle of one crosses one of the other, since the other faces lie in common planes.
#[test]
fn flush_cubes_that_overlap_by_little_do() {
    let cube = |x: f64| {
        let corner = |i: u32| DVec3::new(x + f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
        MeshTree::new(TriMesh::try_new((0..8).map(corner).collect(), halves.collect()).unwrap())
    };
    for exponent in [1, 4, 8, 12, 20, 30] {
        let (a, b) = (cube(0.0), cube(1.0 - 2_f64.powi(-exponent)));
        assert_eq!([state(&a, &b), state(&b, &a)], [StartState::Overlapping; 2], "2^-{exponent}");
    }
    assert_eq!(state(&cube(0.0), &cube(1.0)), StartState::Touching);
}

/// Unit cubes of a random walk, joined: the squares between them are left out.
fn cubes(random: &mut KnuthRandom, from: [i32; 3], steps: u32, scale: f64) -> MeshTree {
    let mut cells = BTreeSet::from([from]);
    let mut now = from;
    for _ in 0..steps {
        let side = random.index(6);
        now[side / 2] += if side.is_multiple_of(2) { 1 } else { -1 };
        cells.insert(now);
    }
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for &cell in &cells {
        for side in 0..6_usize {
            let (axis, is_high) = (side / 2, side.is_multiple_of(2));
            let mut beside = cell;
            beside[axis] += if is_high { 1 } else { -1 };
            if cells.contains(&beside) {
                continue;
            }
            let first = vertices.len() as u32;
            for (u, v) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut corner = cell;
                corner[axis] += i32::from(is_high);
                corner[(axis + 1) % 3] += u;
                corner[(axis + 2) % 3] += v;
                vertices.push(DVec3::from(corner.map(f64::from)) * scale);
            }
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| first + k);
            faces.extend(if is_high { [[a, b, c], [a, c, d]] } else { [[c, b, a], [d, c, a]] });
        }
    }
    MeshTree::new(TriMesh::try_new(vertices, faces).unwrap())
}

/// Which of two bodies is called A changes nothing but the sign of the normal.
#[test]
fn an_exchange_of_the_bodies_turns_the_normal_round() {
    let mut random = KnuthRandom(11);
    let mut touches = 0;
    for _ in 0..300 {
        let scale = [1.0, 0.1, 1.0 / 3.0][random.index(3)];
        let place = [0, 1, 2].map(|_| random.index(6) as i32 - 2);
        let [a, b] = [[0; 3], place].map(|from| cubes(&mut random, from, 6, scale));
        let rotation = match random.index(3) {
            0 => DQuat::IDENTITY,
            1 => DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5),
            _ => DQuat::from_xyzw(random.unit(), random.unit(), random.unit(), 1.0).normalize(),
        };
        let pose = Pose { translation: DVec3::ZERO, rotation, at: DVec3::ZERO };
        let [a, b] = [&a, &b].map(|tree| Posed::new(tree, pose));
        for solid in [Solid::Filled, Solid::Surface] {
            let [found, other] = [distance(a, b, solid).unwrap(), distance(b, a, solid).unwrap()];
            assert_eq!(found.state, other.state, "{place:?} {rotation}");
            if found.state == StartState::Touching {
                touches += 1;
                assert_eq!(found.normal, -other.normal, "{place:?} {rotation}");
            }
        }
    }
    assert!(touches > 100, "{touches}");
}

/// A budget that ends while it is not known how bodies stand that begin within the minimum separation: the separation is still that of the
/// reported triangles, so bodies whose radii leave room between them do not overlap.
#[test]
fn a_start_that_a_budget_leaves_undecided_keeps_its_separation() {
    let [low, high, b] = [[-1.0, 0.0], [1.2, 2.0], [0.2, 1.0]].map(|[from, to]| slab(4, |_, _| from, to));
    // One body, with room for the other one.
    let count = low.mesh().vertex_count() as u32;
    let vertices = [low.mesh().vertices(), high.mesh().vertices()].concat();
    let above: Vec<[u32; 3]> = high.mesh().triangles().iter().map(|t| t.map(|v| v + count)).collect();
    let a = MeshTree::new(TriMesh::try_new(vertices, [low.mesh().triangles(), &above].concat()).unwrap());
    let motion = ConstantTwist::REST;
    let mut undecided = 0;
    for (radius, budget) in
        [0.0, 0.05].into_iter().flat_map(|radius| (1..400).map(move |tests| (radius, tests)))
    {
        let [a, b] = [&a, &b].map(|tree| Moving::new(tree, &motion).with_radius(radius));
        let options = QueryOptions::default()
            .with_min_separation(0.3)
            .with_budget(Budget::UNLIMITED.with_node_tests(budget));
        let found = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let Some(contact) = found.contact() else { continue };
        let apart = (contact.point_a - contact.point_b).length();
        assert!(apart > 0.09 && (contact.separation - apart).abs() < 1e-9, "{radius} {budget}: {contact:?}");
        assert_ne!(contact.start, StartState::Overlapping, "{radius} {budget}");
        undecided += usize::from(contact.start == StartState::Undecided);
    }
    assert!(undecided > 0);
}

/// Whatever triangles a search within a minimum separation reports: rounded bodies that begin in each other overlap, others touch. The same is said
/// of the start of a departure.
#[test]
fn rounded_bodies_overlap_where_their_radii_meet() {
    let mut random = KnuthRandom(17);
    let stone = MeshTree::new(Surface::wavy_torus(16, 8, 0.3).into_mesh(TriMesh::try_new));
    let point = MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap());
    let radius = |tree: &MeshTree| tree.radius();
    let (mut touching, mut overlapping) = (0, 0);
    for k in 0..1600 {
        let s = [0.0, 0.1, 0.3][k % 3];
        let radii = [[0.0, 0.2], [0.1, 0.2]][k / 3 % 2];
        let way = random.vector().normalize();
        let apart = radius(&stone) + 0.6 * random.unit();
        let motion = ConstantTwist::REST.with_position(way * apart).with_angular_velocity(DVec3::X);
        let other = if k % 2 == 0 { &point } else { &stone };
        let motion = if k % 2 == 0 { motion } else { motion.with_position(way * (apart + radius(&stone))) };
        let a = Moving::new(&stone, &ConstantTwist::REST).with_radius(radii[0]);
        let b = Moving::new(other, &motion).with_radius(radii[1]);
        let options = QueryOptions::default().with_min_separation(s);
        let at_start = Posed::new(other, motion.pose_and_twist(0.0).0);
        let found = distance(Posed::at_rest(&stone), at_start, Solid::Surface).unwrap().with_radii(radii);
        let Some(contact) = time_of_contact(a, b, Window::UNIT, &options).unwrap().contact().copied() else {
            continue;
        };
        if contact.start == StartState::Apart {
            continue;
        }
        let expected = match found.state {
            StartState::Apart => StartState::Touching,
            state => state,
        };
        assert_eq!(contact.start, expected, "{k}: {contact:?} {found:?}");
        assert_eq!(departure(a, b, Window::UNIT, &options).unwrap().start, expected, "{k}");
        touching += u32::from(expected == StartState::Touching);
        overlapping += u32::from(expected == StartState::Overlapping);
    }
    assert!(touching > 20 && overlapping > 20, "{touching} {overlapping}");
}

/// At rest, as it says, and within `off` of there and `turned` of its rotation as far as it knows itself at one time.
struct Blind {
    motion: ConstantTwist,
    off: f64,
    turned: f64,
}

impl RigidMotion for Blind {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.motion.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.motion.enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist_rate(t)
    }
    fn enclose_state_about(&self, t: f64, origin: DVec3) -> CertifiedState {
        let state = self.motion.enclose_state_about(t, origin);
        CertifiedState { position_radius: self.off, rotation_radius: self.turned, ..state }
    }
    fn constant_twist(&self) -> Option<ConstantTwist> {
        Some(self.motion)
    }
}

/// A pose that is not as it was given, and of which a motion knows nothing at that time: neither that bodies touch nor that they overlap.
#[test]
fn how_what_knows_nothing_of_itself_begins_is_undecided() {
    let cube =
        MeshTree::new(Surface::cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)).into_mesh(TriMesh::try_new));
    let held =
        MeshTree::new(Surface::cuboid(DVec3::splat(-0.125), DVec3::splat(0.125)).into_mesh(TriMesh::try_new));
    let at_rest = ConstantTwist::REST;
    for (other, place, known) in [
        (&cube, DVec3::X, StartState::Touching),
        (&cube, DVec3::splat(0.5), StartState::Overlapping),
        (&held, DVec3::X * 0.5, StartState::Overlapping),
    ] {
        let motion = at_rest.with_position(place).with_reference_time(0.5);
        let start = |off: f64, turned: f64| {
            let blind = Blind { motion, off, turned };
            let [a, b] = [Moving::new(&cube, &at_rest), Moving::new(other, &blind)];
            let [found, exchanged] = [(a, b), (b, a)].map(|(a, b)| {
                let found = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
                found.contact().expect("they share points").start
            });
            assert_eq!(found, exchanged, "{place}, {off}, {turned}");
            found
        };
        assert_eq!(start(0.0, 0.0), known, "{place}");
        for unknown in [f64::INFINITY, f64::NAN] {
            assert_eq!([start(unknown, 0.0), start(0.0, unknown)], [StartState::Undecided; 2], "{place}");
        }
    }
}
