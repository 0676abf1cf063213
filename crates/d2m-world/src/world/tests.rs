use super::*;
use d2m_bvh::{Budget, MeshTree, TimeOfContact};
use d2m_motion::{ConstantTwist, Pose};
use glam::{DQuat, DVec3};

fn cube() -> Arc<MeshTree> {
    Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()))
}

fn flying(from: DVec3, velocity: DVec3) -> ConstantTwist {
    ConstantTwist::REST.with_position(from).with_linear_velocity(velocity)
}

/// Steps of a world of its own, each a new one without caches, and steps of one world: the same answers.
#[test]
fn caches_change_nothing() {
    let ring = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=600").unwrap()));
    let bodies = |step: u32| {
        let passing = flying(DVec3::new(-2.0, 0.0, 1.2 - 0.02 * f64::from(step)), DVec3::X * 4.0)
            .with_angular_velocity(DVec3::Z);
        let away = ConstantTwist::REST.with_position(DVec3::Y * f64::from(step % 7));
        [ConstantTwist::REST, passing, away].map(|motion| Body::new(Arc::clone(&ring), motion))
    };
    let filled = |step: u32| {
        let mut world = World::new(QueryOptions::default());
        for body in bodies(step) {
            world.add(body);
        }
        world
    };
    let (mut one, mut met, mut apart) = (filled(0), 0, 0);
    let ids: Vec<_> = one.ids().collect();
    for step in 0..40 {
        for (id, body) in ids.iter().zip(bodies(step)) {
            one.set_body(*id, body);
        }
        let contacts = one.contacts(Window::UNIT).unwrap();
        assert_eq!(contacts, filled(step).contacts(Window::UNIT).unwrap(), "step {step}");
        let first = one.first_contact(Window::UNIT).unwrap();
        assert_eq!(first, filled(step).first_contact(Window::UNIT).unwrap(), "step {step}");
        met += u32::from(!contacts.is_empty());
        apart += u32::from(contacts.is_empty());
    }
    assert!(met > 10 && apart > 3, "{met} {apart}");
}

/// With "any contact will do" the later of two would be as good as the first, and its time any time.
#[test]
fn first_contacts_are_first_in_any_mode() {
    let cube = cube();
    for mode in [Mode::Accurate, Mode::Exists] {
        let mut world = World::new(QueryOptions::default().with_mode(mode));
        world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
        for (axis, distance) in [(DVec3::X, 7.0), (DVec3::Y, 5.0), (DVec3::Z, 6.0)] {
            world.add(Body::new(Arc::clone(&cube), flying(axis * distance, axis * -8.0)));
        }
        let FirstContact::Contact { a, b, contact, overlapping } = world.first_contact(Window::UNIT).unwrap()
        else {
            panic!("three of them arrive")
        };
        assert_eq!((a.index(), b.index(), overlapping), (0, 2, vec![]), "{mode:?}");
        assert!(contact.time_lo <= 0.375 && contact.time_lo > 0.375 - 1e-9, "{mode:?}: {contact:?}");
    }
}

/// What meets at the same time is reported together, and what is proven of other pairs stays when two bodies change.
#[test]
fn an_event_asks_the_pairs_of_its_bodies_only() {
    let cube = cube();
    let mut world = World::new(QueryOptions::default());
    // Three targets far from each other, each with a cube that comes in; the first two arrive together.
    let mut arrivals = Vec::new();
    for (k, distance) in [(0, 5.0), (1, 5.0), (2, 6.0)] {
        let place = DVec3::Y * 20.0 * f64::from(k);
        world.add(Body::new(Arc::clone(&cube), flying(place, DVec3::ZERO)));
        arrivals.push(
            world.add(Body::new(Arc::clone(&cube), flying(place + DVec3::X * distance, DVec3::X * -8.0))),
        );
    }
    let first = world.first_contact(Window::UNIT).unwrap();
    let FirstContact::Contact { b, contact, overlapping, .. } = first else { panic!("{first:?}") };
    assert_eq!((b, overlapping.len()), (arrivals[0], 1));
    assert_eq!(overlapping[0].b, arrivals[1]);
    let known: Vec<_> = world.states.iter().map(|(pair, state)| (*pair, state.versions)).collect();
    let time = contact.time_lo;
    for &id in &arrivals[..2] {
        let here = world.body(id).motion().pose_and_twist(time).0.translation;
        world.set_motion(id, flying(here, DVec3::X * 8.0).with_reference_time(time));
    }
    let rest = Window::try_new(time, 1.0).unwrap();
    let next = world.first_contact(rest).unwrap();
    let FirstContact::Contact { b, contact, overlapping, .. } = next else { panic!("{next:?}") };
    assert_eq!((b, overlapping.len()), (arrivals[2], 0));
    assert!(contact.time_lo <= 0.5 && contact.time_lo > 0.5 - 1e-9);
    // The third pair's proof, if it was searched before, is the old one.
    for (pair, versions) in known.into_iter().filter(|(pair, _)| pair[1] == 5) {
        assert_eq!(world.states[&pair].versions, versions);
    }
}

#[test]
fn removed_names_stay_dead_and_their_places_are_used_again() {
    let cube = cube();
    let mut world = World::new(QueryOptions::default());
    let a = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    let b = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    let met = |world: &mut World| world.contacts(Window::UNIT).unwrap().len();
    assert_eq!(met(&mut world), 1);
    world.ignore_pair(a, b, true);
    assert_eq!(met(&mut world), 0);
    assert!(world.remove(b).is_some() && world.remove(b).is_none() && world.get(b).is_none());
    assert_eq!(met(&mut world), 0);
    let c = world.add(Body::new(cube, ConstantTwist::REST).with_group(Group(3)));
    assert!(c.index() == b.index() && c != b && world.len() == 2);
    // What was said about the removed body is not said about this one.
    assert_eq!(met(&mut world), 1);
    world.ignore_groups(Group(3), Group(3), true);
    assert_eq!(met(&mut world), 1);
    let grouped = world.body(a).clone().with_group(Group(3));
    world.set_body(a, grouped);
    assert_eq!(met(&mut world), 0);
    world.ignore_groups(Group(3), Group(3), false);
    assert_eq!(met(&mut world), 1);
}

#[test]
fn separations_of_pairs_are_kept_and_may_change() {
    let cube = cube();
    let mut world = World::new(QueryOptions::default());
    let a = world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST));
    let b = world.add(Body::new(cube, flying(DVec3::X * 4.0, DVec3::X * -4.0)));
    let mut time = |separation: Option<f64>| {
        world.set_min_separation(a, b, separation);
        let first = world.first_contact(Window::UNIT).unwrap();
        let FirstContact::Contact { contact, .. } = first else { panic!("{first:?}") };
        contact.time_lo
    };
    for (separation, expected) in
        [(None, 0.5), (Some(1.0), 0.25), (Some(0.5), 0.375), (None, 0.5), (Some(2.5), 0.0)]
    {
        assert!((time(separation) - expected).abs() < 1e-9, "{separation:?}");
    }
    world.set_min_separation(a, b, Some(f64::NAN));
    assert!(world.first_contact(Window::UNIT).is_err());
}

/// Pairs wait in the order of the times at which their boxes meet. One that is known to be free for longer does not speak for
/// those behind it when the budget ends: the last two bodies overlap at the start.
#[test]
fn a_budget_that_ends_says_nothing_of_pairs_behind_one_that_is_known() {
    let ring = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=600").unwrap()));
    let near = |y: f64, spin: DVec3| {
        let still = ConstantTwist::REST.with_position(DVec3::Y * y);
        // Links of a chain: their boxes overlap from the start.
        let upright = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
        let link = flying(DVec3::new(0.7, y, 0.0), DVec3::X * -1.0).with_orientation(upright);
        [still, link.with_angular_velocity(spin)]
    };
    let mut ended = 0;
    for tests in (0..6000).step_by(40) {
        let budget = Budget::UNLIMITED.with_node_tests(tests);
        let mut world = World::new(QueryOptions::default().with_budget(budget));
        for motion in [near(0.0, DVec3::X), near(9.0, DVec3::Y), near(18.0, DVec3::Z)].into_iter().flatten() {
            world.add(Body::new(Arc::clone(&ring), motion));
        }
        // Cheap to prove of every pair, so that what is left of the first one uses up the same budget later.
        let _ = world.first_contact(Window::try_new(0.0, 0.015_625).unwrap()).unwrap();
        for x in [0.0, 0.5] {
            let place = DVec3::new(x, -9.0, 0.0);
            world.add(Body::new(Arc::clone(&ring), ConstantTwist::REST.with_position(place)));
        }
        match world.first_contact(Window::UNIT).unwrap() {
            FirstContact::Undecided { clear_until, .. } => {
                assert_eq!(clear_until, 0.0, "{tests} tests");
                ended += 1;
            }
            FirstContact::Contact { contact, .. } => assert_eq!(contact.time_lo, 0.0, "{tests} tests"),
            FirstContact::Separated => panic!("{tests} tests: two bodies overlap"),
        }
    }
    assert!(ended > 5, "{ended}");
}

/// A budget is one over all pairs, ends in a proven time, and stops the search.
#[test]
fn a_budget_over_all_pairs_ends_in_a_proven_time() {
    let ring = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=600").unwrap()));
    let filled = |budget: Budget| {
        let mut world = World::new(QueryOptions::default().with_budget(budget));
        for k in 0..12 {
            let place = DVec3::new(1.7 * f64::from(k), 0.0, 0.0);
            let turn = DVec3::new(0.3, 0.2 * f64::from(k), 1.0);
            world.add(Body::new(
                Arc::clone(&ring),
                flying(place, DVec3::X * -0.1 * f64::from(k)).with_angular_velocity(turn),
            ));
        }
        world
    };
    let FirstContact::Contact { contact, .. } =
        filled(Budget::UNLIMITED).first_contact(Window::UNIT).unwrap()
    else {
        panic!("they turn into each other")
    };
    let all = filled(Budget::UNLIMITED).contacts(Window::UNIT).unwrap();
    let (mut undecided, mut decided) = (0, 0);
    for tests in [1, 10, 100, 1_000, 10_000, 100_000, 10_000_000] {
        let budget = Budget::UNLIMITED.with_node_tests(tests);
        match filled(budget).first_contact(Window::UNIT).unwrap() {
            FirstContact::Undecided { clear_until, a, b } => {
                assert!(clear_until <= contact.time_hi, "{tests}");
                assert!(a < b && b.index() < 12, "{tests}");
                undecided += 1;
            }
            FirstContact::Contact { contact: found, .. } => {
                assert!(found.time_lo <= contact.time_hi && contact.time_lo <= found.time_hi, "{tests}");
                decided += 1;
            }
            FirstContact::Separated => panic!("{tests}: a contact was missed"),
        }
        // Nothing that meets is left out of the list.
        let listed = filled(budget).contacts(Window::UNIT).unwrap();
        for met in &all {
            let same = listed.iter().find(|pair| (pair.a, pair.b) == (met.a, met.b)).expect("left out");
            let TimeOfContact::Contact(contact) = met.answer else { panic!("no budget") };
            assert!(same.clear_until() <= contact.time_hi, "{tests}");
        }
    }
    assert!(undecided >= 2 && decided >= 2, "{undecided} {decided}");
}

/// Motions other than constant twists are charged with what they take: a budget of a few times the sum is enough.
#[test]
fn budgets_are_charged_with_the_work_of_any_motion() {
    let ring = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=600").unwrap()));
    let mut world = World::new(QueryOptions::default());
    for k in 0..14 {
        // A stack of rings that wobble, none far from the next.
        let pose = |time: f64| Pose {
            translation: DVec3::Z * (0.85 * f64::from(k) + 0.02 * time),
            rotation: glam::DQuat::from_rotation_x(time * 0.1 * f64::from(k % 3)),
            at: DVec3::ZERO,
        };
        let keyframes: Vec<_> = [0.0, 0.25, 0.6, 1.0].map(|time| (time, pose(time * time))).to_vec();
        let motion = d2m_motion::Spline::try_through(&keyframes, d2m_motion::SplineDegree::Cubic).unwrap();
        world.add(Body::new(Arc::clone(&ring), motion));
    }
    let pairs = world.candidates(Window::UNIT).unwrap();
    assert!(pairs.len() >= 12, "{}", pairs.len());
    let mut work = 0;
    for (a, b) in &pairs {
        let [a, b] = [a, b].map(|&id| world.body(id).moving());
        let options = QueryOptions::default();
        work += d2m_bvh::time_of_contact_counted(a, b, Window::UNIT, &options).unwrap().work.work();
    }
    let within = |tests: u64| {
        let mut limited =
            World::new(QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(tests)));
        for id in world.ids() {
            limited.add(world.body(id).clone());
        }
        limited.contacts(Window::UNIT).unwrap()
    };
    let exact = within(u64::MAX);
    let is_undecided = |pair: &PairContact| pair.answer.contact().is_none();
    assert_eq!(within(2 * work), exact);
    assert!(!exact.iter().any(is_undecided) && within(work / 4).iter().any(is_undecided));
}

/// Progress counts pairs that are done, never more than there are, and changes no answer.
#[test]
fn progress_counts_the_pairs_that_are_done() {
    let cube = cube();
    let mut fresh = World::new(QueryOptions::default());
    for k in 0..24 {
        let motion = flying(DVec3::X * (2.5 * f64::from(k)), DVec3::X * f64::from(k % 3 - 1));
        fresh.add(Body::new(Arc::clone(&cube), motion.with_angular_velocity(DVec3::Z)));
    }
    for first in [true, false] {
        let seen = std::cell::RefCell::new(Vec::new());
        let progress = |done: usize, all: usize| seen.borrow_mut().push([done, all]);
        let (mut quiet, mut watched) = (fresh.clone(), fresh.clone());
        if first {
            let answer = watched.first_contact_with_progress(Window::UNIT, &progress).unwrap();
            assert_eq!(answer, quiet.first_contact(Window::UNIT).unwrap());
        } else {
            let answer = watched.contacts_with_progress(Window::UNIT, &progress).unwrap();
            assert_eq!(answer, quiet.contacts(Window::UNIT).unwrap());
        }
        let seen = seen.into_inner();
        assert!(!seen.is_empty() && seen.iter().all(|[done, all]| done <= all), "{seen:?}");
        assert!(seen.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{seen:?}");
    }
}

/// Pairs that are given with when they may meet: only these count, each in its time, twice given as once, and the ignored ones not.
#[test]
fn given_candidates_are_all_that_is_asked() {
    let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
    let mut world = World::new(QueryOptions::default());
    let mut at =
        |x: f64| world.add(Body::new(Arc::clone(&cube), ConstantTwist::REST.with_position(DVec3::X * x)));
    let [tool, near, far] = [at(0.0), at(3.0), at(6.0)];
    // At 8 t: the near one is met at 0.25, and the far one would be at 0.625.
    let motion = Arc::new(ConstantTwist::REST.with_linear_velocity(DVec3::X * 8.0));
    let plan = [PlannedMotion { body: tool, motion }];
    let given = |b: BodyId, from: f64, until: f64| Candidate { a: tool, b, from, until };
    let ask = |world: &World, candidates: &[Candidate]| {
        world.first_contact_among(&plan, candidates, Window::UNIT, Threads::Own).unwrap()
    };
    let met = |answer: FirstContact, with: BodyId, time: f64| {
        let FirstContact::Contact { a, b, contact, .. } = answer else { panic!("{answer:?}") };
        assert_eq!((a, b), (tool, with));
        assert!(contact.time_lo <= time && contact.time_lo > time - 1e-9, "{contact:?}");
    };
    met(ask(&world, &[given(far, 0.5, 0.75), given(near, 0.0, 1.0)]), near, 0.25);
    met(ask(&world, &[given(far, 0.5, 0.75)]), far, 0.625);
    assert_eq!(ask(&world, &[given(far, 0.0, 0.6)]), FirstContact::Separated);
    assert_eq!(ask(&world, &[]), FirstContact::Separated);
    met(ask(&world, &[given(far, 0.0, 0.1), given(far, 0.6, 0.7), given(far, 0.2, 0.3)]), far, 0.625);
    world.ignore_pair(near, tool, true);
    assert_eq!(ask(&world, &[given(near, 0.0, 1.0)]), FirstContact::Separated);
    world.set_min_separation(far, tool, Some(1.0));
    met(ask(&world, &[given(far, 0.0, 1.0)]), far, 0.5);
}

/// How bodies meet at the start takes a search of its own. Where a budget ends it, a later question without one is answered as by a new world.
#[test]
fn a_budget_that_ends_is_forgotten_at_the_start() {
    let ring = Arc::new(MeshTree::new(d2m_shapes::mesh("torus?triangles=600").unwrap()));
    let turned = ConstantTwist::REST.with_orientation(DQuat::from_rotation_x(1.0));
    let mut fresh = World::new(QueryOptions::default());
    for motion in [ConstantTwist::REST, turned.with_position(DVec3::X * 0.8)] {
        fresh.add(Body::new(Arc::clone(&ring), motion));
    }
    let known = fresh.clone().contacts(Window::UNIT).unwrap();
    for tests in (0..600).step_by(10) {
        let mut world = fresh.clone();
        world.set_budget(Budget::UNLIMITED.with_node_tests(tests));
        let _ = world.contacts(Window::UNIT).unwrap();
        world.set_budget(Budget::UNLIMITED);
        assert_eq!(world.contacts(Window::UNIT).unwrap(), known, "{tests} tests");
    }
}

/// Three pairs that meet at nearly the same time: the third one is searched until the first ones have met, and later from there on, where it is
/// within the tolerance already. Its bodies do not meet at the start.
#[test]
fn what_is_searched_from_a_later_time_on_is_apart_at_the_start() {
    let cube = cube();
    for step in 0..40 {
        let mut world = World::new(QueryOptions::default());
        for (place, later) in [(0.0, 0.0), (9.0, 0.0), (18.0, 2e-11 * f64::from(step))] {
            world.add(Body::new(Arc::clone(&cube), flying(DVec3::Y * place, DVec3::ZERO)));
            let from = DVec3::new(6.0 + later, place, 0.0);
            world.add(Body::new(Arc::clone(&cube), flying(from, DVec3::X * -8.0)));
        }
        assert!(matches!(world.first_contact(Window::UNIT).unwrap(), FirstContact::Contact { .. }));
        let all = world.contacts(Window::UNIT).unwrap();
        let starts = all.iter().map(|pair| pair.answer.contact().map(|contact| contact.start));
        assert!(starts.eq([Some(d2m_bvh::StartState::Apart); 3]), "{step}: {all:?}");
    }
}
