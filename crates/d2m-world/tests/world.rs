//! Worlds of bodies with all kinds of motions, filters, removals and changes in any order, against brute force over all
//! pairs: the same verdicts, brackets that overlap, and the same bits at any number of threads.

use d2m_bvh::{
    Contact, MeshTree, QueryOptions, Solid, Start, TimeOfContact, TriMesh, Window, time_of_contact,
};
use d2m_motion::{Chain, Joint, JointKind, JointValue, Keyframes, Pose, Span, Spline, SplineDegree};
use d2m_motion::{ConstantTwist, RigidMotion, ScrewMotion};
use d2m_testing::{Draw, KnuthRandom, Opaque};
use d2m_world::{Body, BodyId, FirstContact, Group, PairContact, PlannedMotion, SharedMotion, World};
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use std::sync::Arc;

const SIZE: f64 = 9.0;

fn pose(random: &mut KnuthRandom) -> Pose {
    Pose {
        translation: random.vector() * SIZE,
        rotation: DQuat::from_scaled_axis(random.vector() * 3.0),
        at: random.vector() * 0.3,
    }
}

/// Poses at 0, at some times between, and at 1, each not far from the one before.
fn poses(random: &mut KnuthRandom) -> Vec<(f64, Pose)> {
    let mut last = Pose { at: DVec3::ZERO, ..pose(random) };
    let between = 1 + random.index(3);
    (0..=between + 1)
        .map(|k| {
            last.translation += random.vector() * 2.0;
            last.rotation = DQuat::from_scaled_axis(random.vector() * 0.8) * last.rotation;
            (k as f64 / (between + 1) as f64, last)
        })
        .collect()
}

/// A link of an arm: a turning joint, a sliding one in two pieces, and a turning one.
fn link(random: &mut KnuthRandom) -> Chain {
    let turn = |random: &mut KnuthRandom| {
        let value =
            JointValue::try_polynomial(vec![random.unit(), random.vector().x * 2.0, random.vector().x])
                .unwrap();
        JointKind::Revolute { axis: random.vector(), value }
    };
    let (start, rate) = (random.unit(), random.vector().x);
    let pieces = vec![vec![start, rate], vec![start + 0.5 * rate, -rate, random.vector().x]];
    let value = JointValue::try_pieces(vec![0.0, 0.5, 1.0], pieces).unwrap();
    let kinds = [turn(random), JointKind::Prismatic { axis: random.vector(), value }, turn(random)];
    let joints = kinds.into_iter().enumerate().map(|(k, kind)| {
        let place = if k == 0 { random.vector() * SIZE } else { random.vector() };
        Joint::try_new(place, DQuat::from_scaled_axis(random.vector()), kind).unwrap()
    });
    Chain::try_new(joints.collect()).unwrap()
}

fn motion(random: &mut KnuthRandom) -> SharedMotion {
    let spin = if random.unit() < 0.2 { 20.0 } else { 2.0 };
    let turned = DQuat::from_scaled_axis(random.vector() * 3.0);
    let twist =
        ConstantTwist::try_new(random.vector() * SIZE, turned, random.vector() * 3.0, random.vector() * spin);
    let twist = twist.unwrap().with_at(random.vector() * 0.5);
    match random.index(24) {
        0 => Arc::new(Opaque(twist.with_angular_velocity(random.vector()))),
        1..3 => Arc::new(ConstantTwist::REST.with_position(random.vector() * SIZE)),
        3..5 => {
            let end = twist.with_position(random.vector() * SIZE).pose_and_twist(1.0).0;
            Arc::new(ScrewMotion::try_from_poses(twist.pose_and_twist(0.0).0, end, 0.0, 1.0).unwrap())
        }
        5..8 => Arc::new(twist.with_linear_velocity(random.vector() * 30.0)),
        8 => Arc::new(Keyframes::try_new(&poses(random), Span::Linear).unwrap()),
        9 => Arc::new(Keyframes::try_new(&poses(random), Span::Screw).unwrap()),
        10 => Arc::new(Spline::try_through(&poses(random), SplineDegree::Cubic).unwrap()),
        11 => Arc::new(link(random)),
        _ => Arc::new(twist),
    }
}

fn trees() -> Vec<Arc<MeshTree>> {
    let sheet =
        TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::ONE], vec![[0, 1, 2], [1, 3, 2]]);
    let solids = ["box?x=0.5&y=0.4&z=0.3", "torus?triangles=200", "box?x=1.5&y=0.05&z=0.1"];
    let mut trees: Vec<_> =
        solids.iter().map(|name| MeshTree::new(d2m_shapes::mesh(name).unwrap())).collect();
    trees.push(MeshTree::new(sheet.unwrap()));
    trees.into_iter().map(Arc::new).collect()
}

fn body(random: &mut KnuthRandom, trees: &[Arc<MeshTree>]) -> Body {
    let tree = &trees[random.index(trees.len())];
    let solid = if tree.is_watertight() && random.unit() < 0.8 { Solid::Filled } else { Solid::Surface };
    let body = Body::with_shared(Arc::clone(tree), motion(random)).with_solid(solid);
    if random.unit() < 0.4 { body.with_group(Group(random.index(3) as u32)) } else { body }
}

/// What the world should know, by other means.
#[derive(Default)]
struct Model {
    bodies: BTreeMap<BodyId, Body>,
    ignored: Vec<[BodyId; 2]>,
    groups: Vec<[Group; 2]>,
    separations: BTreeMap<[BodyId; 2], f64>,
}

type Found = (BodyId, BodyId, Contact);

impl Model {
    fn asks(&self, a: BodyId, b: BodyId) -> bool {
        let by_name = self.ignored.contains(&[a, b]);
        let by_group = match (self.bodies[&a].group(), self.bodies[&b].group()) {
            (Some(g), Some(h)) => self.groups.iter().any(|pair| *pair == [g, h] || *pair == [h, g]),
            _ => false,
        };
        !by_name && !by_group
    }

    /// All pairs, each by itself over the whole window.
    fn contacts(&self, window: Window) -> Vec<Found> {
        let ids: Vec<_> = self.bodies.keys().copied().collect();
        let mut found = Vec::new();
        for (k, &a) in ids.iter().enumerate() {
            for &b in ids[k + 1..].iter().filter(|&&b| self.asks(a, b)) {
                let (first, second) = (&self.bodies[&a], &self.bodies[&b]);
                let filled = [first, second].iter().all(|body| body.solid() == Some(Solid::Filled));
                let options = QueryOptions::default()
                    .with_tolerance(1e-7)
                    .with_solid(if filled { Solid::Filled } else { Solid::Surface })
                    .with_min_separation(self.separations.get(&[a, b]).copied().unwrap_or(0.01));
                match time_of_contact(first.moving(), second.moving(), window, &options).unwrap() {
                    TimeOfContact::Contact(contact) => found.push((a, b, contact)),
                    TimeOfContact::Separated => {}
                    TimeOfContact::Undecided { .. } => panic!("no budget"),
                }
            }
        }
        found
    }
}

/// Brackets that share a time; one without a proven end, of a pass that grazes, is as long as the tolerance allows.
fn overlap(x: &Contact, y: &Contact) -> bool {
    (x.time_lo <= y.time_hi && y.time_lo <= x.time_hi) || (x.time_lo - y.time_lo).abs() < 1e-4
}

/// A pass at a distance of about a tolerance may be answered either way.
fn is_sure(contact: &Contact) -> bool {
    contact.evidence != d2m_bvh::Evidence::Early
}

fn earliest<'a>(all: impl Iterator<Item = &'a Found>) -> Option<&'a Found> {
    all.min_by(|x, y| x.2.time_lo.total_cmp(&y.2.time_lo))
}

/// A world, what is known about it by other means, and what it answered.
struct Run {
    random: KnuthRandom,
    trees: Vec<Arc<MeshTree>>,
    world: World,
    model: Model,
    start: f64,
    answers: (Vec<Vec<PairContact>>, Vec<FirstContact>),
}

impl Run {
    fn new(seed: u64, count: usize) -> Self {
        let options = QueryOptions::default().with_tolerance(1e-7).with_min_separation(0.01);
        let mut run = Self {
            random: KnuthRandom(seed),
            trees: trees(),
            world: World::new(options),
            model: Model::default(),
            start: 0.0,
            answers: Default::default(),
        };
        for _ in 0..count {
            run.add();
        }
        run
    }

    fn add(&mut self) {
        let body = body(&mut self.random, &self.trees);
        let id = self.world.add(body.clone());
        assert!(self.model.bodies.insert(id, body).is_none());
    }

    fn change(&mut self) {
        let (random, world, model) = (&mut self.random, &mut self.world, &mut self.model);
        let ids: Vec<_> = model.bodies.keys().copied().collect();
        let (a, b) = (ids[random.index(ids.len())], ids[random.index(ids.len())]);
        let (a, b) = (a.min(b), a.max(b));
        match random.index(8) {
            0 => {
                world.remove(a);
                model.bodies.remove(&a);
                model.ignored.retain(|pair| !pair.contains(&a));
                model.separations.retain(|pair, _| !pair.contains(&a));
            }
            1 => self.add(),
            2 if a != b => {
                model.ignored.push([a, b]);
                world.ignore_pair(a, b, true);
            }
            3 if !model.ignored.is_empty() => {
                let [a, b] = model.ignored.swap_remove(0);
                model.ignored.retain(|pair| *pair != [a, b]);
                world.ignore_pair(b, a, false);
            }
            4 => {
                let pair = [Group(random.index(3) as u32), Group(random.index(3) as u32)];
                let turned = [pair[1], pair[0]];
                let count = model.groups.len();
                model.groups.retain(|other| *other != pair && *other != turned);
                let ignored = model.groups.len() == count;
                if ignored {
                    model.groups.push(pair);
                }
                world.ignore_groups(pair[0], pair[1], ignored);
            }
            5 if a != b => {
                let separation = [0.0, 0.005, 0.2][random.index(3)];
                model.separations.insert([a, b], separation);
                world.set_min_separation(a, b, Some(separation));
            }
            _ => {
                world.set_shared_motion(a, motion(random));
                model.bodies.insert(a, world.body(a).clone());
            }
        }
    }

    /// Some changes and a query.
    fn step(&mut self, compare: bool) {
        for _ in 0..self.random.index(6) {
            self.change();
        }
        let window = match self.random.index(4) {
            0 => Window::UNIT,
            1 => Window::try_new(0.1, 0.6).unwrap(),
            _ => {
                self.start = if self.start > 0.8 { 0.0 } else { self.start + 0.2 * self.random.unit() };
                Window::try_new(self.start, 1.0).unwrap()
            }
        };
        let list = (self.random.unit() < 0.5).then(|| self.world.contacts(window).unwrap());
        let first = self.world.first_contact(window).unwrap();
        if compare {
            let all = self.model.contacts(window);
            if let Some(list) = &list {
                compare_lists(list, &all);
            }
            compare_first(&first, &all, window);
            // A body that takes its own motion once more: the first contact of its own pairs.
            let place = self.random.index(self.model.bodies.len());
            let (&id, body) = self.model.bodies.iter().nth(place).unwrap();
            let plan = [PlannedMotion { body: id, motion: body.shared_motion() }];
            let planned = self.world.first_contact_of(&plan, window).unwrap();
            let own: Vec<_> = all.into_iter().filter(|(a, b, _)| [a, b].contains(&&id)).collect();
            compare_first(&planned, &own, window);
        }
        self.answers.0.extend(list);
        self.answers.1.push(first);
    }
}

fn compare_lists(list: &[PairContact], all: &[Found]) {
    for (a, b, contact) in all.iter().filter(|(_, _, contact)| is_sure(contact)) {
        let same = list.iter().find(|pair| (pair.a, pair.b) == (*a, *b));
        let found = same.and_then(|pair| pair.answer.contact());
        assert!(found.is_some_and(|found| overlap(found, contact)), "{contact:?} {found:?}");
    }
    for pair in list.iter().filter(|pair| pair.answer.contact().is_some_and(is_sure)) {
        assert!(all.iter().any(|(a, b, _)| (*a, *b) == (pair.a, pair.b)), "{pair:?}");
    }
    assert!(list.is_sorted_by(|x, y| x.clear_until() <= y.clear_until()));
}

fn compare_first(first: &FirstContact, all: &[Found], window: Window) {
    match (first, earliest(all.iter())) {
        (FirstContact::Separated, None) => {}
        (FirstContact::Separated, Some((_, _, contact))) => {
            assert!(!is_sure(contact), "{contact:?}");
            let next = earliest(all.iter().filter(|(_, _, contact)| is_sure(contact)));
            assert!(next.is_none(), "{next:?}");
        }
        (FirstContact::Contact { a, b, contact, overlapping, .. }, Some((_, _, expected))) => {
            assert!(overlap(contact, expected), "{contact:?} {expected:?}");
            let same = all.iter().find(|(c, d, _)| (c, d) == (a, b));
            assert!(same.is_some_and(|(_, _, other)| overlap(other, contact)) || !is_sure(contact));
            // Whatever is certain to meet before this one's bracket ends is listed, unless the bodies met at the start.
            if contact.time_lo > window.start() {
                for (c, d, other) in all.iter().filter(|(_, _, other)| is_sure(other)) {
                    let listed = overlapping.iter().any(|pair| (pair.a, pair.b) == (*c, *d));
                    assert!(listed || (c, d) == (a, b) || other.time_hi >= contact.time_hi, "{other:?}");
                }
            }
        }
        (other, expected) => panic!("{other:?} but {expected:?}"),
    }
}

#[test]
fn changes_in_any_order_give_what_brute_force_gives() {
    for seed in 0..12 {
        let mut run = Run::new(seed, 25);
        for _ in 0..10 {
            run.step(true);
        }
    }
}

#[test]
fn two_hundred_bodies_give_what_brute_force_gives() {
    let mut run = Run::new(77, 200);
    for _ in 0..3 {
        run.step(true);
    }
}

#[cfg(feature = "rayon")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let answers = [1, 2, 5].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut run = Run::new(5, 60);
            for _ in 0..8 {
                run.step(false);
            }
            run.answers
        })
    });
    assert!(answers[0].0.iter().any(|list| !list.is_empty()));
    assert_eq!(answers[0], answers[1]);
    assert_eq!(answers[0], answers[2]);
}

/// What is in contact at the start of a window is let go, whatever windows were asked about before, and only where that is said.
#[test]
fn a_world_lets_go_what_is_to_leave() {
    let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()));
    let mut world = World::new(QueryOptions::default().with_start(Start::Leave));
    let table = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    // Overlaps the table by 1, has left it at 0.25 and meets the lamp at 2.
    let lifted = ConstantTwist::REST.with_position(DVec3::Y).with_linear_velocity(DVec3::Y * 4.0);
    let part = world.add(Body::new(Arc::clone(&cube), lifted));
    let lamp = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::Y * 11.0)));
    assert_eq!(world.first_contact(Window::UNIT).unwrap(), FirstContact::Separated);
    let whole = Window::try_new(0.0, 3.0).unwrap();
    for window in [whole, Window::try_new(0.1, 3.0).unwrap(), Window::try_new(1.0, 3.0).unwrap(), whole] {
        let all = world.contacts(window).unwrap();
        assert_eq!(all.len(), 1, "{window:?}: {all:?}");
        let contact = all[0].answer.contact().expect("no budget");
        assert_eq!((all[0].a, all[0].b), (part, lamp));
        assert!(contact.time_lo <= 2.0 && contact.time_lo > 2.0 - 1e-9, "{contact:?}");
        // These two begin apart.
        let left = contact.left.expect("they are apart");
        assert_eq!([left.lo, left.hi], [window.start(); 2]);
        let FirstContact::Contact { a, b, contact, .. } = world.first_contact(window).unwrap() else {
            panic!("{window:?}")
        };
        assert!((a, b) == (part, lamp) && contact.left.is_some());
    }
    // Bodies that never part in the window are in contact from its start, whatever a longer window says.
    for end in [0.2, 1.0, 0.2] {
        let all = world.contacts(Window::try_new(0.0, end).unwrap()).unwrap();
        assert_eq!(all.len(), usize::from(end < 0.25), "{end}");
        let never_left = |pair: &PairContact| pair.answer.contact().is_some_and(|c| c.left.is_none());
        assert!(all.iter().all(never_left));
    }
    world.set_start(part, table, Some(Start::Report));
    let all = world.contacts(whole).unwrap();
    assert_eq!((all.len(), all[0].a, all[0].clear_until()), (2, table, 0.0));
    world.set_start(part, table, None);
    assert_eq!(world.contacts(whole).unwrap().len(), 1);
    // It comes back: the contact after the departure, and when they had parted.
    let thrown = ConstantTwist::REST
        .with_position(DVec3::new(1.5, 0.0, 0.0))
        .with_linear_velocity(DVec3::ZERO)
        .with_angular_velocity(DVec3::Z * core::f64::consts::TAU)
        .with_at(DVec3::new(3.0, 0.0, 0.0));
    world.remove(lamp);
    world.set_motion(part, thrown);
    let again = world.contacts(Window::UNIT).unwrap();
    let contact = again[0].answer.contact().expect("no budget");
    let left = contact.left.expect("they part");
    assert!(
        0.0 < left.lo && left.lo <= left.hi && left.hi < contact.time_lo && contact.time_lo < 1.0,
        "{contact:?}"
    );
}

/// Spheres, capsules and rounded boxes at the surfaces that their radii make, against the broad phase as well as in pairs.
#[test]
fn radii_count_in_every_question() {
    let point = Arc::new(MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap()));
    let rod = Arc::new(MeshTree::new(TriMesh::segment(-DVec3::Y, DVec3::Y).unwrap()));
    let mut world = World::new(QueryOptions::default().with_tolerance(1e-10));
    let coming = ConstantTwist::REST.with_position(DVec3::X * 4.0).with_linear_velocity(DVec3::X * -4.0);
    let ball = world.add(Body::new(Arc::clone(&point), coming).with_radius(0.25));
    let post = world.add(Body::new(rod, ConstantTwist::REST).with_radius(0.75));
    // 3 away from the way of the ball: 0.1 more than their radii.
    let moon = ConstantTwist::REST.with_position(DVec3::new(2.0, 0.0, 3.0));
    let moon = world.add(Body::new(point, moon).with_radius(2.65));
    let all = world.contacts(Window::UNIT).unwrap();
    let pairs: Vec<_> = all.iter().map(|pair| (pair.a, pair.b)).collect();
    assert_eq!(pairs, [(ball, post)], "{all:?}");
    let contact = all[0].answer.contact().expect("no budget");
    assert!(contact.time_lo <= 0.75 && contact.time_lo > 0.75 - 1e-9, "{contact:?}");
    assert!((contact.point_b - DVec3::X * 0.75).length() < 1e-9, "{contact:?}");
    world.set_body(moon, world.body(moon).clone().with_radius(2.8));
    assert!(world.contacts(Window::UNIT).unwrap().iter().any(|pair| (pair.a, pair.b) == (ball, moon)));
    world.remove(moon);
    let near = world.proximities(0.5, &d2m_bvh::ProximityOptions::new(1.1)).unwrap();
    let [only] = &near[0].proximities[..] else { panic!("{near:?}") };
    assert!((only.distance - 1.0).abs() < 1e-12 && (only.point_a.x - 1.75).abs() < 1e-12, "{only:?}");
    assert!(world.proximities(0.5, &d2m_bvh::ProximityOptions::new(0.9)).unwrap().is_empty());
    assert!(world.proximities(0.9, &d2m_bvh::ProximityOptions::new(0.9)).is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        world.set_body(
            ball,
            world
                .body(ball)
                .clone()
                .with_motion(ConstantTwist::REST.with_position(DVec3::X * 1e3))
                .with_radius(bad),
        );
        assert!(world.first_contact(Window::UNIT).is_err(), "{bad}");
    }
}
