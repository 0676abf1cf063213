//! Bodies that are inside others when the query begins.

use d2m_bvh::{
    MeshTree, Moving, PairCache, Posed, QueryError, QueryOptions, Solid, SpanStatus, StartState,
    TimeOfContact, TriMesh, Window, contact_spans, departure, distance, time_of_contact,
    time_of_contact_with,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

/// A closed cube.
fn cube(half: f64) -> MeshTree {
    MeshTree::new(Surface::cube(half).into_mesh(TriMesh::try_new))
}

/// A small cube in the very corner of a large one, where the spheres about both nearly part; whatever the reference points and
/// spins are.
#[test]
fn a_body_in_a_corner_of_the_other_is_held() {
    let (large, small) = (cube(1.0), cube(0.01));
    for spin in [DVec3::ZERO, DVec3::Z, DVec3::new(3.0, -2.0, 1.0)] {
        for at in [DVec3::ZERO, DVec3::new(0.3, -2.0, 5.0)] {
            for q in [DQuat::IDENTITY, DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize()] {
                let place = q * (DVec3::splat(0.98) - at * 0.5);
                let outer = ConstantTwist::try_new(DVec3::ZERO, q, DVec3::X, spin).unwrap();
                let outer = outer.try_with_at(at * 0.5).unwrap();
                let inner = ConstantTwist::try_new(place, q, -DVec3::Y, -spin).unwrap();
                let [a, b] = [Moving::new(&large, &outer), Moving::new(&small, &inner)];
                for [a, b] in [[a, b], [b, a]] {
                    let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
                    let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
                    assert_eq!((contact.start, contact.time_lo), (StartState::Contained, 0.0));
                }
            }
        }
    }
}

/// An open sheet and a solid: what is inside the solid is in contact, whichever of the bodies it is, with any motion; nothing is
/// inside of the sheet; both as surfaces are apart.
#[test]
fn a_sheet_inside_a_solid_is_held() {
    let solid = cube(1.0);
    let corners = vec![DVec3::ZERO, DVec3::X * 0.1, DVec3::Y * 0.1];
    let sheet = MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap());
    let options = QueryOptions::default();
    let spinning = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
    let curved =
        d2m_motion::Composed::new(ConstantTwist::REST, spinning.with_linear_velocity(DVec3::X * 0.01));
    let motions: [&dyn d2m_motion::RigidMotion; 2] = [&spinning, &curved];
    for motion in motions {
        let outer = Moving::new(&solid, motion);
        let inner = Moving::new(&sheet, &ConstantTwist::REST).with_solid(Solid::Surface);
        for [a, b] in [[outer, inner], [inner, outer]] {
            let mut cache = PairCache::new();
            for _ in 0..2 {
                let answer = time_of_contact_with(a, b, Window::UNIT, &options, &mut cache).unwrap();
                assert_eq!(answer, time_of_contact(a, b, Window::UNIT, &options).unwrap());
                let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
                assert_eq!((contact.start, contact.time_lo), (StartState::Contained, 0.0));
                // The options are for bodies that have no meaning of their own.
                let surfaces = options.with_solid(Solid::Surface);
                assert!(
                    time_of_contact_with(a, b, Window::UNIT, &surfaces, &mut cache).unwrap().is_separated()
                );
            }
        }
        let shell = outer.with_solid(Solid::Surface);
        assert!(time_of_contact(shell, inner, Window::UNIT, &options).unwrap().is_separated());
        let claimed = inner.with_solid(Solid::Filled);
        let refused = time_of_contact(outer, claimed, Window::UNIT, &options);
        assert_eq!(refused, Err(QueryError::NotWatertight { body: 1 }));
    }
}

/// A body inside of another one, nearer to its wall than the separation, or than the tolerance, is held, and does not leave by going away from the wall. As
/// surfaces they touch.
#[test]
fn a_body_near_the_wall_of_the_other_is_held() {
    let (large, small) = (cube(0.5), cube(0.125));
    for (room, separation) in [(0.0625, 0.125), (0.5f64.powi(37), 0.0), (0.5f64.powi(46), 0.0)] {
        let inner = ConstantTwist::REST
            .with_position(DVec3::X * (0.375 - room))
            .with_linear_velocity(DVec3::X * -0.25);
        let [a, b] = [Moving::new(&small, &inner), Moving::new(&large, &ConstantTwist::REST)];
        let options = QueryOptions::default().with_min_separation(separation);
        for [a, b] in [[a, b], [b, a]] {
            let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
            let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
            assert_eq!((contact.start, contact.separation), (StartState::Contained, 0.0), "{contact:?}");
            let departed = departure(a, b, Window::UNIT, &options).unwrap();
            assert_eq!((departed.start, departed.left), (StartState::Contained, None), "{departed:?}");
            let surfaces = options.with_solid(Solid::Surface);
            let answer = time_of_contact(a, b, Window::UNIT, &surfaces).unwrap();
            let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
            assert_eq!(contact.start, StartState::Touching, "{contact:?}");
            assert!((contact.separation - room).abs() < 1e-12);
        }
    }
}

/// What is held nearer to a wall than bodies that touch are moved to part, and further than rounding reaches, is held: a solid, a sheet, of which no part is
/// inside, and a grain that is smaller than that way, which parts through the wall. The distance says the same.
#[test]
fn what_is_held_nearer_than_bodies_part_is_held() {
    let (large, small, grain) = (cube(2.0), cube(0.125), cube(0.5f64.powi(41)));
    let corners = vec![DVec3::new(0.125, 0.0, 0.0), DVec3::new(0.0, 0.1, 0.0), DVec3::new(0.0, 0.0, 0.1)];
    let sheet = MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap());
    let room = 0.5f64.powi(39);
    let turn = DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize();
    let bodies = [
        (&small, 0.125, Solid::Filled),
        (&sheet, 0.125, Solid::Surface),
        (&grain, 0.5f64.powi(41), Solid::Filled),
    ];
    for ((tree, reach, solid), turn) in bodies
        .into_iter()
        .zip([DQuat::IDENTITY, turn].into_iter().cycle())
        .chain(bodies.into_iter().zip([turn, DQuat::IDENTITY].into_iter().cycle()))
    {
        let place = turn * (DVec3::X * (2.0 - reach - room));
        let inner = ConstantTwist::REST.with_position(place).with_orientation(turn);
        let outer = ConstantTwist::REST.with_orientation(turn);
        let [a, b] = [Moving::new(tree, &inner).with_solid(solid), Moving::new(&large, &outer)];
        for [a, b] in [[a, b], [b, a]] {
            let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
            let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
            assert_eq!(
                (contact.start, contact.separation),
                (StartState::Contained, 0.0),
                "{reach} {contact:?}"
            );
            let departed = departure(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
            assert_eq!(departed.start, StartState::Contained, "{departed:?}");
        }
        let posed = [(tree, place), (&large, DVec3::ZERO)].map(|(tree, translation)| {
            Posed::new(tree, Pose { translation, rotation: turn, ..Pose::IDENTITY })
        });
        let found = distance(posed[0], posed[1], [solid, Solid::Filled]).unwrap();
        assert_eq!(found.state, StartState::Contained, "{found:?}");
    }
}

/// In units so small that underflow takes a part of all lengths, triangles that the search proves to cross still do: the bodies overlap, and nothing is
/// between them.
#[test]
fn what_is_proven_to_cross_overlaps_in_any_unit() {
    for power in [0, -300, -600, -900] {
        let unit = 2f64.powi(power);
        let (large, small) = (cube(unit), cube(0.25 * unit));
        let place = DVec3::new(1.0, 0.3, -0.2) * unit;
        let crossing = ConstantTwist::REST
            .with_position(place)
            .with_orientation(DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize());
        let [a, b] = [Moving::new(&large, &ConstantTwist::REST), Moving::new(&small, &crossing)];
        let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
        let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
        assert_eq!(
            (contact.start, contact.separation),
            (StartState::Overlapping, 0.0),
            "{power}: {contact:?}"
        );
    }
}

/// Cubes anywhere, or within a little of each other's walls, inside or outside, in several units: how they begin is what a query of the distance says of them, but
/// that what is nearer to a wall than the separation touches it from outside, and that what is held within roundings of a wall may count as overlapping.
#[test]
fn starts_are_what_the_distance_says() {
    let mut random = KnuthRandom(77);
    let (large, mut held) = (0.5, 0);
    for round in 0..3000 {
        let unit = [1.0, 1e-30, 1e30, 1e-9][round % 4];
        let half = 0.01 + 0.25 * random.unit();
        let mut place = random.vector() * 1.2;
        let axis = random.vector();
        let mut turn = DQuat::from_xyzw(axis.x, axis.y, axis.z, random.signed()).normalize();
        if round % 3 == 0 {
            let room = [0.0, 1e-14, 1e-12, 1e-11, 1e-9, 1e-6, 1e-2][round / 7 % 7];
            let wall = if round % 8 < 4 { large - half - room } else { large + half + room };
            (place, turn) = (DVec3::new(wall, 0.3 * place.y, 0.3 * place.z), DQuat::IDENTITY);
        }
        let (outer, inner) = (cube(large * unit), cube(half * unit));
        let motion =
            ConstantTwist::try_new(place * unit, turn, random.vector() * unit, random.vector()).unwrap();
        let separation = [0.0, 0.01, 0.1, 1.0][round / 3 % 4] * unit * random.unit();
        let options = QueryOptions::default().with_min_separation(separation);
        let bodies = [Moving::new(&inner, &motion), Moving::new(&outer, &ConstantTwist::REST)];
        let [a, b] = if round % 2 == 0 { bodies } else { [bodies[1], bodies[0]] };
        let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let mut cache = PairCache::new();
        for _ in 0..2 {
            let cached = time_of_contact_with(a, b, Window::UNIT, &options, &mut cache).unwrap();
            assert_eq!(cached, answer, "round {round}");
        }
        let start = match answer {
            TimeOfContact::Contact(contact) if contact.time_lo == 0.0 => contact.start,
            TimeOfContact::Undecided { .. } => StartState::Undecided,
            _ => StartState::Apart,
        };
        assert_eq!(departure(a, b, Window::UNIT, &options).unwrap().start, start, "round {round}");
        let posed = Posed::new(&inner, motion.pose_and_twist(0.0).0);
        let state = distance(posed, Posed::at_rest(&outer), Solid::Filled).unwrap().state;
        held += u32::from((state, start) == (StartState::Contained, StartState::Contained));
        let agree = match state {
            StartState::Apart => matches!(start, StartState::Apart | StartState::Touching),
            StartState::Contained => matches!(start, StartState::Contained | StartState::Overlapping),
            _ => start == state,
        };
        assert!(agree || start == StartState::Undecided, "round {round}: {state:?}, {start:?}");
    }
    assert!(held > 200, "{held}");
}

/// What is held at the start, at any distance from the wall and with any tolerance, is in contact from then on: also where the search for the
/// contact comes to a bracket in the middle of the window.
#[test]
fn spans_of_what_is_held_begin_with_the_window() {
    let mut random = KnuthRandom(5);
    let large = cube(0.5);
    for case in 0..1500 {
        let half = 0.02 + 0.2 * random.unit();
        let small = cube(half);
        let mut vector = || DVec3::from_array([(); 3].map(|()| random.signed()));
        let (place, velocity, spin) = (vector() * (0.5 - half) * 0.99, vector(), vector());
        let going = ConstantTwist::REST.with_position(place);
        let going = if case % 3 > 0 { going.with_linear_velocity(velocity) } else { going };
        let going = if case % 2 > 0 { going.with_angular_velocity(spin) } else { going };
        let options = QueryOptions::default().with_tolerance(10f64.powf(-3.0 + 2.5 * random.unit()));
        let [a, b] = [Moving::new(&large, &ConstantTwist::REST), Moving::new(&small, &going)];
        let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
        assert_eq!((spans[0].from, spans[0].status), (0.0, SpanStatus::Contact), "{case}: {spans:?}");
    }
}
