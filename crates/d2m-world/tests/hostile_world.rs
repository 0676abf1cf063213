//! Uses of a world that nobody means, and what must be answered.

use d2m_bvh::{
    ClearanceOptions, MeshTree, ProximityOptions, QueryOptions, Start, StartState, TriMesh, Window,
};
use d2m_motion::ConstantTwist;
use d2m_testing::Surface;
use d2m_world::{Body, BodyId, Candidate, FirstContact, PlannedMotion, Threads, World};
use glam::{DQuat, DVec3};
use std::sync::Arc;

fn cube() -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()))
}

fn at(place: DVec3) -> ConstantTwist {
    ConstantTwist::REST.with_position(place)
}

fn world_of(motions: impl IntoIterator<Item = ConstantTwist>) -> World {
    let cube = cube();
    let mut world = World::new(QueryOptions::default());
    for motion in motions {
        world.add(Body::new(Arc::clone(&cube), motion));
    }
    world
}

/// The numbers of the pairs that meet, by every query that lists them.
fn meeting(world: &mut World, window: Window) -> Vec<[usize; 2]> {
    let listed = world.contacts(window).unwrap();
    let mut pairs: Vec<_> = listed.iter().map(|pair| [pair.a.index(), pair.b.index()]).collect();
    pairs.sort_unstable();
    let candidates: Vec<_> =
        world.candidates(window).unwrap().iter().map(|(a, b)| [a.index(), b.index()]).collect();
    assert!(pairs.iter().all(|pair| candidates.contains(pair)));
    assert_eq!(world.first_contact(window).unwrap() == FirstContact::Separated, pairs.is_empty());
    assert_eq!(world.clone().contacts(window).unwrap(), listed);
    pairs
}

fn still() -> Window {
    Window::try_new(0.25, 0.25).unwrap()
}

#[test]
fn no_body_and_one_body_meet_nothing() {
    for count in 0..2 {
        let mut world = world_of((0..count).map(|_| at(DVec3::ZERO).with_linear_velocity(DVec3::X)));
        for window in [Window::UNIT, still(), Window::try_new(-1e9, 1e9).unwrap()] {
            assert!(meeting(&mut world, window).is_empty());
            assert_eq!(world.first_contact_of(&[], window).unwrap(), FirstContact::Separated);
        }
        assert!(world.proximities(0.0, &ProximityOptions::new(1e9)).unwrap().is_empty());
        assert_eq!((world.len(), world.ids().count()), (count, count));
        for id in world.ids().collect::<Vec<_>>() {
            let plan = [PlannedMotion { body: id, motion: Arc::new(ConstantTwist::REST) }];
            assert_eq!(world.first_contact_of(&plan, Window::UNIT).unwrap(), FirstContact::Separated);
        }
    }
}

#[test]
fn windows_without_length_hold_their_one_time() {
    // They touch at 0.5, overlap until 2.5, are apart again after that.
    let mut world = world_of([at(DVec3::ZERO), at(DVec3::X * 2.0).with_linear_velocity(DVec3::X * -2.0)]);
    for (time, meets) in [(0.0, false), (0.49, false), (0.51, true), (1.0, true), (2.0, false)] {
        let window = Window::try_new(time, time).unwrap();
        assert_eq!(!meeting(&mut world, window).is_empty(), meets, "{time}");
    }
    for (start, end) in
        [(1.0, 0.0), (f64::NAN, 1.0), (0.0, f64::NAN), (f64::NEG_INFINITY, 0.0), (0.0, f64::INFINITY)]
    {
        assert!(Window::try_new(start, end).is_err(), "{start} {end}");
    }
}

#[test]
fn windows_in_any_order_hold_what_they_hold_alone() {
    let motions =
        || (0..6).map(|k| at(DVec3::X * 2.0 * f64::from(k)).with_linear_velocity(DVec3::X * -f64::from(k)));
    let mut world = world_of(motions());
    for (start, end) in
        [(0.0, 1.0), (0.9, 1.0), (0.0, 0.1), (-5.0, -4.0), (0.5, 30.0), (2.0, 2.0), (0.0, 1.0), (0.3, 0.9)]
    {
        let window = Window::try_new(start, end).unwrap();
        let alone = meeting(&mut world_of(motions()), window);
        assert_eq!(meeting(&mut world, window), alone, "{start} {end}");
    }
}

/// A name that outlived its body changes nothing for the body that took its place.
#[test]
fn stale_names_do_nothing() {
    let mut world = world_of([at(DVec3::ZERO), at(DVec3::X * 0.5)]);
    let [a, old]: [BodyId; 2] = world.ids().collect::<Vec<_>>().try_into().unwrap();
    assert_eq!(meeting(&mut world, Window::UNIT), [[0, 1]]);
    world.remove(old);
    let new = world.add(Body::new(cube(), at(DVec3::X * 0.5)));
    assert!(new != old && new.index() == old.index() && world.get(old).is_none());
    world.ignore_pair(a, old, true);
    world.ignore_pair(old, a, true);
    assert_eq!(meeting(&mut world, Window::UNIT), [[0, 1]]);
    world.set_min_separation(a, old, Some(f64::NAN));
    assert_eq!(meeting(&mut world, Window::UNIT), [[0, 1]]);
    // A change by a stale name is refused loudly, and leaves the world as it was.
    let refused =
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| world.set_motion(old, at(DVec3::Y * 9.0))));
    assert!(refused.is_err() && world.remove(old).is_none());
    let foreign = world_of((0..40).map(|_| ConstantTwist::REST)).ids().last().unwrap();
    let refused =
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| world.set_motion(foreign, at(DVec3::Y))));
    assert!(refused.is_err());
    assert_eq!(meeting(&mut world, Window::UNIT), [[0, 1]]);
}

#[test]
fn bodies_added_between_queries_keep_all_names() {
    let mut world = world_of([]);
    let mut names = Vec::new();
    for k in 0..30 {
        names.push(world.add(Body::new(cube(), at(DVec3::X * 0.9 * f64::from(k)))));
        // Each meets its neighbors, some of them never queried before.
        assert_eq!(meeting(&mut world, Window::UNIT).len(), k as usize);
        for (j, &name) in names.iter().enumerate() {
            assert_eq!(world.body(name).motion().pose_and_twist(0.0).0.translation.x, 0.9 * j as f64);
        }
    }
    for (k, name) in names.into_iter().enumerate().step_by(2) {
        world.remove(name).unwrap();
        assert!(world.get(name).is_none() && world.len() == 29 - k / 2);
    }
    assert!(meeting(&mut world, Window::UNIT).is_empty());
}

/// One pair with a huge separation of its own makes no other pair a candidate.
#[test]
fn a_huge_separation_is_that_of_its_pair() {
    let mut world = world_of((0..200).map(|k| at(DVec3::new(f64::from(k) * 3.0, f64::from(k % 7), 0.0))));
    let ids: Vec<_> = world.ids().collect();
    world.set_min_separation(ids[3], ids[150], Some(1e6));
    world.set_min_separation(ids[5], ids[9], Some(1e300));
    assert_eq!(world.candidates(Window::UNIT).unwrap(), [(ids[3], ids[150]), (ids[5], ids[9])]);
    assert_eq!(meeting(&mut world, Window::UNIT), [[3, 150], [5, 9]]);
    world.set_motion(ids[150], at(DVec3::Y * 90.0));
    assert_eq!(meeting(&mut world, Window::UNIT), [[3, 150], [5, 9]]);
    world.set_min_separation(ids[3], ids[150], Some(1.0));
    world.set_min_separation(ids[5], ids[9], None);
    assert!(meeting(&mut world, Window::UNIT).is_empty());
    world.set_min_separation(ids[9], ids[5], Some(f64::INFINITY));
    assert!(world.contacts(Window::UNIT).is_err());
    world.set_min_separation(ids[5], ids[9], None);
    assert!(meeting(&mut world, Window::UNIT).is_empty());
}

/// The same body many times: every pair meets at the start, and the first one is reported at once.
#[test]
fn identical_bodies_meet_at_once() {
    let mut world = world_of((0..40).map(|_| at(DVec3::ONE).with_angular_velocity(DVec3::Z)));
    let FirstContact::Contact { a, b, contact, .. } = world.first_contact(Window::UNIT).unwrap() else {
        panic!("they are at one place")
    };
    assert_eq!((a.index(), b.index(), contact.time_lo), (0, 1, 0.0));
    assert_ne!(contact.start, StartState::Apart);
    assert_eq!(meeting(&mut world, Window::UNIT).len(), 40 * 39 / 2);
}

/// Motions and places that overflow what boxes can hold are queried, not lost.
#[test]
fn enormous_places_and_speeds_lose_no_pair() {
    for scale in [1e-60, 1e-6, 1.0, 1e6, 1e40] {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p * scale);
        let tree = Arc::new(MeshTree::new(Surface::tetrahedron(corners).into_mesh(TriMesh::try_new)));
        let mut world = World::new(QueryOptions::default());
        for k in 0..8 {
            let motion = at(DVec3::X * 4.0 * scale * f64::from(k))
                .with_orientation(DQuat::from_rotation_y(0.1 * f64::from(k)))
                .with_linear_velocity(DVec3::X * -8.0 * scale * f64::from(k % 2));
            world.add(Body::new(Arc::clone(&tree), motion));
        }
        // Each odd one runs through its left neighbor.
        let pairs = meeting(&mut world, Window::UNIT);
        assert!((0..4).all(|k| pairs.contains(&[2 * k, 2 * k + 1])), "{scale:e}: {pairs:?}");
    }
}

/// What is said of a body and itself is kept by none, before and after a query.
#[test]
fn a_body_and_itself_are_no_pair() {
    let mut world = world_of([0.0, 5.0].map(|x| at(DVec3::X * x)));
    let ids: Vec<BodyId> = world.ids().collect();
    for round in 0..4 {
        let id = ids[round % 2];
        world.ignore_pair(id, id, true);
        world.ignore_pair(id, id, round < 2);
        world.ignore_pair(id, id, false);
        world.set_min_separation(id, id, Some(1.0));
        world.set_start(id, id, Some(Start::Leave));
        assert_eq!(world.pair_options(id, id), *world.options());
        assert!(meeting(&mut world, Window::UNIT).is_empty(), "{round}");
        assert!(world.contact_spans(Window::UNIT, None).unwrap().is_empty());
        let nearest = world.nearest_pair(Window::UNIT, &ClearanceOptions::default()).unwrap().unwrap();
        assert!(nearest.a != nearest.b && nearest.clearance.lower > 3.9);
        world.set_min_separation(id, id, None);
        let itself = Candidate { a: id, b: id, from: 0.0, until: 1.0 };
        let among = world.first_contact_among(&[], &[itself], Window::UNIT, Threads::Own);
        assert_eq!(among.unwrap(), FirstContact::Separated);
    }
}

/// A pair of a body that was removed is no proof that it is free, neither is that of the body in its place.
#[test]
fn candidates_that_were_removed_are_refused() {
    let mut world = world_of([0.0, 0.5].map(|x| at(DVec3::X * x)));
    let ids: Vec<BodyId> = world.ids().collect();
    let pair = Candidate { a: ids[0], b: ids[1], from: f64::NAN, until: f64::NAN };
    let ask = |world: &World, pair: Candidate| {
        let among = || world.first_contact_among(&[], &[pair], Window::UNIT, Threads::Own).unwrap();
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(among))
    };
    assert!(matches!(ask(&world, pair), Ok(FirstContact::Contact { .. })));
    let body = world.remove(ids[1]).unwrap();
    assert!(ask(&world, pair).is_err());
    let other = world.add(body);
    assert!(other.index() == ids[1].index() && ask(&world, pair).is_err());
    assert!(matches!(ask(&world, Candidate { b: other, ..pair }), Ok(FirstContact::Contact { .. })));
}

/// Bodies that the tolerance puts in contact at the start are so in a world, too, whatever their boxes and spheres prove of the separation:
/// with a tolerance that is given or follows from the sizes, one for all pairs or a separation of their own, rounded or not.
#[test]
fn what_is_within_the_tolerance_at_the_start_is_in_contact() {
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Y * 0.1).with_linear_velocity(DVec3::X);
    let cases =
        [(Some(1e-2), 0.9e-2, 0.0), (Some(1e-2), 0.9e-2, 0.5), (None, 0.8e-10, 0.0), (None, 0.8e-10, 0.5)];
    for (tolerance, gap, own) in cases {
        for (radius, going) in
            [(0.0, at(DVec3::X)), (0.25, at(DVec3::X)), (0.0, turning.with_position(DVec3::X))]
        {
            for separation in [0.0, 0.125] {
                let mut options = QueryOptions::default().with_min_separation(separation);
                options.tolerance = tolerance;
                let mut world = World::new(options);
                let wanted = if own > 0.0 { own } else { separation };
                let rest =
                    Body::new(cube(), at(DVec3::X * -(2.0 * radius + wanted + gap))).with_radius(radius);
                let [a, b] = [rest, Body::new(cube(), going).with_radius(radius)].map(|body| world.add(body));
                if own > 0.0 {
                    world.set_min_separation(a, b, Some(own));
                }
                let options = world.pair_options(a, b);
                let [one, other] = [a, b].map(|id| world.body(id).clone());
                let alone = d2m_bvh::time_of_contact(one.moving(), other.moving(), Window::UNIT, &options);
                let case = format!("{tolerance:?} {gap} {own} {radius} {separation}");
                assert!(alone.unwrap().contact().is_some_and(|found| found.time_lo == 0.0), "{case}");
                assert_eq!(meeting(&mut world, Window::UNIT), [[0, 1]], "{case}");
            }
        }
    }
}

/// The same of needles tip to tip, which their spheres alone would prove apart.
#[test]
fn tips_within_the_tolerance_at_the_start_are_in_contact() {
    let needle = Arc::new(MeshTree::new(d2m_shapes::mesh("needle?aspect=10").unwrap()));
    let tip = needle.mesh().vertices().iter().fold(0.0f64, |tip, vertex| tip.max(vertex.z));
    let mut world = World::new(QueryOptions::default().with_tolerance(1e-2));
    for place in [DVec3::ZERO, DVec3::Z * (2.0 * tip + 0.9e-2)] {
        world.add(Body::new(Arc::clone(&needle), at(place)));
    }
    assert_eq!(meeting(&mut world, Window::UNIT), [[0, 1]]);
}
