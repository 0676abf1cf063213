//! The default engine against certified static distances, against itself in other modes, and at extreme scales.

use d2m_bvh::{
    Budget, MeshTree, Mode, Moving, Posed, QueryOptions, Solid, StartState, TimeOfContact, TriMesh, Window,
    distance, time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use d2m_testing::{Draw, KnuthRandom, Opaque, Surface};
use glam::{DQuat, DVec3};

/// A wavy torus of this size.
fn torus(rings: u32, sides: u32, scale: f64) -> MeshTree {
    MeshTree::new(Surface::wavy_torus(rings, sides, 0.3).map(|p| p * scale).into_mesh(TriMesh::try_new))
}

fn motion(x: DVec3, q: DQuat, v: DVec3, w: DVec3) -> ConstantTwist {
    ConstantTwist::try_new(x, q, v, w).unwrap()
}

fn pose_at(m: &ConstantTwist, t: f64) -> Pose {
    let m = m.rebase(t);
    Pose { rotation: m.orientation(), translation: m.position(), at: m.at() }
}

fn distance_at(trees: [&MeshTree; 2], motions: [&ConstantTwist; 2], t: f64) -> (f64, f64) {
    let [a, b] = [0, 1].map(|k| Posed::new(trees[k], pose_at(motions[k], t)));
    let found = distance(a, b, Solid::Filled).unwrap();
    (found.lower, found.upper)
}

fn approach(random: &mut KnuthRandom, speed: f64, spin: f64) -> [ConstantTwist; 2] {
    let from = random.vector().normalize() * 3.5;
    let miss = random.vector() * 0.7;
    let v = (miss - from).normalize() * speed;
    let x = from;
    [
        motion(x, random.moderate_turn(), v, random.vector() * spin),
        motion(DVec3::ZERO, random.moderate_turn(), DVec3::ZERO, random.vector() * spin),
    ]
}

fn query(
    trees: [&MeshTree; 2],
    motions: [&dyn RigidMotion; 2],
    window: Window,
    options: &QueryOptions,
) -> TimeOfContact {
    time_of_contact(Moving::new(trees[0], motions[0]), Moving::new(trees[1], motions[1]), window, options)
        .unwrap()
}

#[test]
fn separation_at_lo_is_what_is_promised_and_nothing_touches_before() {
    let (a, b) = (torus(24, 12, 1.0), torus(17, 9, 0.8));
    let mut random = KnuthRandom(1);
    let options = QueryOptions::default().with_tolerance(1e-10);
    let (mut hits, mut bracketed) = (0, 0);
    for round in 0..300 {
        let speed = [0.5, 4.0, 40.0][round % 3];
        let motions = approach(&mut random, speed, [0.0, 1.0, 6.0][round / 3 % 3]);
        let window = Window::try_new(0.0, 6.0 / speed).unwrap();
        let answer = query([&a, &b], [&motions[0], &motions[1]], window, &options);
        let end = answer.contact().map_or(window.end(), |c| c.time_lo);
        for k in 0..40 {
            let t = end * f64::from(k) / 40.0;
            assert!(distance_at([&a, &b], [&motions[0], &motions[1]], t).0 > 0.0, "round {round} time {t}");
        }
        if let Some(contact) = answer.contact() {
            hits += 1;
            let (low, high) = distance_at([&a, &b], [&motions[0], &motions[1]], contact.time_lo);
            assert!(low > 0.5e-10 && high < 3.3e-10, "round {round}: {low:e} {high:e}");
            assert!((contact.separation - low).abs() < 2e-12);
            assert!((contact.point_b - contact.point_a).length() < 3.3e-10);
            assert!((contact.normal.length() - 1.0).abs() < 1e-12);
            assert_eq!(contact.start, StartState::Apart);
            if contact.time_hi > contact.time_lo {
                bracketed += 1;
                let (_, high) = distance_at([&a, &b], [&motions[0], &motions[1]], contact.time_hi);
                assert!(high <= 1.001e-10, "round {round}: {high:e} at the end of the bracket");
            }
        }
    }
    assert!(hits > 150 && bracketed * 20 > hits * 19, "{hits} {bracketed}");
}

#[test]
fn extreme_speeds_spins_offsets_and_scales() {
    let mut random = KnuthRandom(2);
    let (small_a, small_b) = (torus(10, 6, 1.0), torus(9, 5, 0.8));
    for round in 0..120 {
        let speed = 10f64.powi(round % 13 - 6);
        let spin = [0.0, 3.0, 300.0][round as usize % 3] * speed.min(1.0);
        let offset = [DVec3::ZERO, DVec3::new(1e6, -2e6, 3e6)][round as usize / 3 % 2];
        let at = [0.0, 1e5][round as usize / 6 % 2];
        let motions = approach(&mut random, speed, spin)
            .map(|m| m.with_position(m.position() + offset).with_reference_time(at));
        let window = Window::try_new(at, at + 6.0 / speed).unwrap();
        let options = QueryOptions::default().with_tolerance(1e-10);
        let answer = query([&small_a, &small_b], [&motions[0], &motions[1]], window, &options);
        assert!(!matches!(answer, TimeOfContact::Undecided { .. }), "round {round}");
        // Judge in a frame near the scene, so that the judge's own rounding does not matter.
        let near = motions.map(|m| m.with_position(m.position() - offset));
        let end = answer.contact().map_or(window.end(), |c| c.time_lo);
        for k in 0..60 {
            let t = at + (end - at) * f64::from(k) / 60.0;
            let low = distance_at([&small_a, &small_b], [&near[0], &near[1]], t).0;
            assert!(low > 0.0, "round {round} time {t}: {answer:?}");
        }
        if let Some(contact) = answer.contact() {
            let (low, high) = distance_at([&small_a, &small_b], [&near[0], &near[1]], contact.time_lo);
            // Time itself has a resolution.
            let jump = (speed + spin) * 4.0 * (contact.time_lo.next_up() - contact.time_lo);
            let slack = 3.3 * contact.tolerance + jump + if offset == DVec3::ZERO { 0.0 } else { 2e-9 };
            assert!(low > 0.0 && high < slack, "round {round}: {low:e} {high:e} {contact:?}");
        }
    }
}

/// The same scene in any unit of length: never late, never missed, and the same time.
#[test]
fn any_unit_of_length() {
    let mut random = KnuthRandom(77);
    for round in 0..8 {
        let motions = approach(&mut random, 4.0, 3.0);
        let window = Window::try_new(0.0, 1.5).unwrap();
        let ask = |unit: f64| {
            let trees = [torus(8, 5, unit), torus(7, 4, 0.8 * unit)];
            let [a, b] = motions.map(|m| {
                m.with_position(m.position() * unit).with_linear_velocity(m.linear_velocity() * unit)
            });
            let (a, b) = (Moving::new(&trees[0], &a), Moving::new(&trees[1], &b));
            time_of_contact(a, b, window, &QueryOptions::default())
        };
        let right = ask(1.0).unwrap();
        for power in [-305, -200, -165, -155, -150, -120, -100, -90, -80, -75, -60, -50, -40, -20, 20, 40, 59]
        {
            let answer = ask(10f64.powi(power));
            let exact = power >= -300;
            match (&right, answer) {
                (TimeOfContact::Contact(c), Ok(TimeOfContact::Contact(d))) => {
                    assert!(d.time_lo < c.time_lo + 1e-9, "round {round}, 1e{power}: {right:?} {d:?}");
                    assert!(!exact || d.time_lo > c.time_lo - 1e-9, "round {round}, 1e{power}: {d:?}");
                }
                (TimeOfContact::Contact(c), Ok(TimeOfContact::Undecided { clear_until })) => {
                    assert!(!exact && clear_until < c.time_lo + 1e-9, "round {round}, 1e{power}");
                }
                (TimeOfContact::Separated, Ok(answer)) => {
                    assert!(!exact || answer.is_separated(), "round {round}, 1e{power}: {answer:?}");
                }
                (_, Err(_)) => assert!(!exact, "round {round}, 1e{power}"),
                (right, wrong) => panic!("round {round}, 1e{power}: {right:?}, not {wrong:?}"),
            }
        }
    }
}

#[test]
fn any_motion_agrees_with_the_closed_form() {
    let (a, b) = (torus(10, 6, 1.0), torus(9, 5, 0.8));
    let mut random = KnuthRandom(3);
    let options = QueryOptions::default().with_tolerance(1e-8);
    let mut hits = 0;
    for round in 0..40 {
        let motions = approach(&mut random, 4.0, 1.5);
        let exact = query([&a, &b], [&motions[0], &motions[1]], Window::UNIT, &options);
        let opaque = motions.map(Opaque);
        let general = query([&a, &b], [&opaque[0], &opaque[1]], Window::UNIT, &options);
        match (exact, general) {
            (TimeOfContact::Separated, TimeOfContact::Separated) => {}
            (TimeOfContact::Contact(exact), TimeOfContact::Contact(general)) => {
                hits += 1;
                assert!(
                    general.separation < 3.3e-8 && general.separation > 0.5e-8,
                    "round {round}: {general:?}"
                );
                assert!(
                    (exact.time_lo - general.time_lo).abs() < 1e-6,
                    "round {round}: {exact:?} {general:?}"
                );
                assert!(general.time_lo <= exact.time_hi);
            }
            other => panic!("round {round}: {other:?}"),
        }
    }
    assert!(hits > 15);
}

#[test]
fn modes_and_budgets_are_consistent() {
    let (a, b) = (torus(30, 14, 1.0), torus(25, 13, 0.8));
    let mut random = KnuthRandom(4);
    for round in 0..60 {
        let motions = approach(&mut random, 4.0, 2.0);
        let ask = |options: &QueryOptions| query([&a, &b], [&motions[0], &motions[1]], Window::UNIT, options);
        let options = QueryOptions::default();
        let accurate = ask(&options);
        let exists = ask(&options.with_mode(Mode::Exists));
        assert_eq!(accurate.contact().is_some(), exists.contact().is_some(), "round {round}");
        let early = ask(&options.with_mode(Mode::Capoeira));
        if let Some(contact) = accurate.contact() {
            let early = early.contact().expect("a contact has a pair of near triangles");
            assert!(early.time_lo <= contact.time_hi);
            let (low, high) = distance_at([&a, &b], [&motions[0], &motions[1]], early.time_lo);
            assert!(low > 0.0 && high <= early.separation + 1e-12 && early.separation < 0.6, "round {round}");
        }
        let mut before = 0.0;
        for budget in [0, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 100_000] {
            let limited = ask(&options.with_budget(Budget::default().with_node_tests(budget)));
            match limited {
                TimeOfContact::Undecided { clear_until } => {
                    assert!(clear_until >= before, "round {round} budget {budget}");
                    before = clear_until;
                    let bound = accurate.contact().map_or(1.0, |c| c.time_lo);
                    assert!(clear_until <= bound);
                }
                decided => assert_eq!(decided, accurate, "round {round} budget {budget}"),
            }
        }
        let far = ask(&options.with_min_separation(0.25));
        if let Some(contact) = far.contact() {
            let (low, high) = distance_at([&a, &b], [&motions[0], &motions[1]], contact.time_lo);
            assert!(low > 0.25 && high < 0.25 + 1e-9, "round {round}: {low} {high}");
        } else {
            assert!(accurate.is_separated());
        }
    }
}

#[test]
fn starts_that_touch_cross_or_hold() {
    let (big, small) = (torus(24, 12, 1.0), torus(12, 6, 0.1));
    let rest = ConstantTwist::REST;
    let place = |x: DVec3| rest.with_position(x);
    let ask = |x: DVec3, solid: Solid| {
        let moved = place(x);
        query([&big, &small], [&rest, &moved], Window::UNIT, &QueryOptions::default().with_solid(solid))
    };
    // In the hole: apart.
    assert!(ask(DVec3::ZERO, Solid::Filled).is_separated());
    // Inside the tube.
    let held = ask(DVec3::new(1.0, 0.0, 0.0), Solid::Filled);
    assert_eq!(held.contact().unwrap().start, StartState::Contained);
    assert_eq!(held.contact().unwrap().time_lo, 0.0);
    assert!(ask(DVec3::new(1.0, 0.0, 0.0), Solid::Surface).is_separated());
    // Across the wall.
    let crossing = ask(DVec3::new(1.3, 0.0, 0.0), Solid::Surface);
    assert_eq!(crossing.contact().unwrap().start, StartState::Overlapping);
    assert_eq!(crossing.contact().unwrap().separation, 0.0);
}

/// Faces meet head-on so fast that rounding raises the tolerance: the end of the bracket is still found.
#[test]
fn fast_faces_have_a_bracket() {
    let cube = || MeshTree::new(Surface::cube(0.5).into_mesh(TriMesh::try_new));
    let (a, b) = (cube(), cube());
    let mut random = KnuthRandom(21);
    let mut raised = 0;
    for round in 0..400 {
        let speed = [1e3, 1e5, 1e6][round % 3];
        let from = DVec3::new(0.4 * random.signed(), 0.4 * random.signed(), 1.1 + random.signed().abs());
        let falling = motion(from, DQuat::IDENTITY, DVec3::NEG_Z * speed, DVec3::ZERO);
        let window = Window::try_new(-0.25 * f64::from(round as u32 % 2), 1.0).unwrap();
        let falling = falling.with_position(from + DVec3::Z * -window.start() * speed);
        let still = ConstantTwist::REST;
        let answer = query([&a, &b], [&falling, &still], window, &QueryOptions::default());
        let contact = answer.contact().expect("they meet");
        raised += u32::from(contact.tolerance > 2e-10);
        assert!(contact.time_hi > contact.time_lo, "round {round}: {contact:?}");
        let left = (contact.time_hi - contact.time_lo) * speed;
        assert!(left <= 3.3 * contact.tolerance + 1e-15 * speed, "round {round}: {left:e} {contact:?}");
    }
    assert!(raised > 200, "{raised}");
}
