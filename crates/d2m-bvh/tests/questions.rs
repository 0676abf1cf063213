//! Clearance, spans and departures against dense sampling by other code: plain poses and the distances of all pairs of triangles.

use d2m_bvh::{
    Budget, ClearanceOptions, ClearanceStatus, MeshTree, Mode, Moving, QueryError, QueryOptions, Solid,
    SpanStatus, Start, StartState, TimeOfContact, TriMesh, Window, clearance, contact_spans, departure,
    time_of_contact,
};
use d2m_feature::triangle_distance;
use d2m_motion::{
    Chain, Composed, ConstantTwist, Joint, JointKind, JointValue, Keyframes, Pose, RigidMotion, Span,
};
use d2m_testing::{Draw, KnuthRandom, Opaque, Surface};
use glam::{DQuat, DVec3};

fn tree(surface: Surface) -> MeshTree {
    MeshTree::new(surface.into_mesh(TriMesh::try_new))
}

fn cuboid(half: DVec3) -> MeshTree {
    tree(Surface::cuboid(-half, half))
}

/// The distance of two surfaces at a time, by all pairs of triangles.
fn sampled(a: &Moving<'_>, b: &Moving<'_>, time: f64) -> f64 {
    let placed = |moving: &Moving<'_>| {
        let (pose, _) = moving.motion.pose_and_twist(time);
        let mesh = moving.body.mesh();
        (0..mesh.triangle_count())
            .map(|t| mesh.corners(t).map(|p| pose.transform_point(p)))
            .collect::<Vec<_>>()
    };
    let (a, b) = (placed(a), placed(b));
    let pairs = a.iter().flat_map(|s| b.iter().map(move |t| triangle_distance(s, t).upper));
    pairs.fold(f64::INFINITY, f64::min)
}

fn least_sampled(a: &Moving<'_>, b: &Moving<'_>, window: Window, parts: u32) -> f64 {
    let time = |i: u32| window.start() + window.length() * f64::from(i) / f64::from(parts);
    (0..=parts).map(|i| sampled(a, b, time(i))).fold(f64::INFINITY, f64::min)
}

fn random_twist(random: &mut KnuthRandom, far: f64, speed: f64) -> ConstantTwist {
    let place = random.vector().normalize() * far;
    let aim = random.vector() * 2.5;
    let velocity = (aim - place).normalize_or_zero() * speed;
    ConstantTwist::try_new(place, random.moderate_turn().normalize(), velocity, random.vector() * speed)
        .unwrap()
}

fn random_keyframes(random: &mut KnuthRandom) -> Keyframes {
    let poses = (0..4).map(|_| Pose {
        translation: random.vector() * 4.0,
        rotation: random.moderate_turn().normalize(),
        at: DVec3::ZERO,
    });
    let keys: Vec<_> = [0.0, 0.3, 0.7, 1.0].into_iter().zip(poses).collect();
    Keyframes::try_new(&keys, Span::Linear).unwrap()
}

/// What is promised of every clearance, against samples.
fn check(a: Moving<'_>, b: Moving<'_>, window: Window, options: &ClearanceOptions) -> ClearanceStatus {
    let found = clearance(a, b, window, options).unwrap();
    let least = least_sampled(&a, &b, window, 30);
    let rounding = 1e-13 * (1.0 + least);
    assert!(found.lower <= least + rounding, "{found:?} sampled {least}");
    assert!(0.0 <= found.lower && found.lower <= found.upper && window.contains(found.time), "{found:?}");
    let width = (options.accuracy * found.upper).max(4.0 * found.tolerance);
    assert!(found.upper - found.lower <= width, "{found:?}");
    let toc = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
    match found.status {
        ClearanceStatus::Clear => {
            assert!(found.lower > 0.0 && toc.is_separated());
            let apart = sampled(&a, &b, found.time);
            assert!(apart <= found.upper + rounding, "{found:?} {apart}");
            assert!((found.point_a.distance(found.point_b) - found.upper).abs() <= 1e-9, "{found:?}");
            assert!((found.point_b - found.point_a - found.normal * found.upper).length() <= 1e-9);
        }
        ClearanceStatus::Contact => {
            let contact = toc.contact().expect("a contact");
            assert!(
                found.upper == 0.0 && (found.time - contact.time_lo).abs() < 1e-6,
                "{found:?} {contact:?}"
            );
        }
        ClearanceStatus::Undecided => panic!("{found:?}"),
    }
    found.status
}

#[test]
fn clearances_hold_against_dense_sampling() {
    let bodies = [
        cuboid(DVec3::new(1.0, 0.5, 0.25)),
        tree(Surface::wavy_torus(9, 6, 0.35)),
        tree(Surface::tetrahedron([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z])),
    ];
    let mut random = KnuthRandom(41);
    let mut clear = 0;
    for round in 0..60 {
        let (a, b) = (&bodies[round % 3], &bodies[round / 3 % 3]);
        let twists = [3.0, 1.0].map(|far| random_twist(&mut random, far, 3.0));
        let keys = random_keyframes(&mut random);
        let motions: [&dyn RigidMotion; 2] =
            if round % 4 == 3 { [&keys, &ConstantTwist::REST] } else { [&twists[0], &twists[1]] };
        let accuracy = [1e-6, 1e-3, 0.1][round % 3];
        let options = ClearanceOptions::default().with_accuracy(accuracy);
        let status = check(Moving::new(a, motions[0]), Moving::new(b, motions[1]), Window::UNIT, &options);
        clear += usize::from(status == ClearanceStatus::Clear);
    }
    assert!((10..60).contains(&clear), "{clear}");
}

/// Planted: a cube passes another one; where it is nearest is known, at the ends of the window, inside and all the time.
#[test]
fn planted_minima_are_found_at_ends_and_inside_in_any_unit() {
    for unit in [1.0, 1e-9, 1e9] {
        let cube = cuboid(DVec3::splat(0.5 * unit));
        for (x, v, gap) in [(3.0, -1.0, 1.0), (1.5, 2.0, 0.5), (-4.0, 8.0, 0.0), (1.25, 0.0, 0.25)] {
            for height in [0.0, 1.75] {
                let at = |x: f64| DVec3::new(x, height, 0.125) * unit;
                let moving =
                    ConstantTwist::REST.with_position(at(x)).with_linear_velocity(DVec3::X * (v * unit));
                let [a, b] = [Moving::new(&cube, &ConstantTwist::REST), Moving::new(&cube, &moving)];
                let found = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
                let across = if height > 1.0 { height - 1.0 } else { 0.0 };
                let expected = f64::hypot(gap, across) * unit;
                assert!(found.lower <= expected * (1.0 + 1e-12), "{found:?} {expected}");
                assert!(found.upper >= expected * (1.0 - 1e-12), "{found:?} {expected}");
                assert!(found.upper - found.lower <= (1e-6 * found.upper).max(4.0 * found.tolerance));
            }
        }
    }
}

/// Windows before, after and around the time at which bodies are closest, and the way there.
const WINDOWS: [(f64, f64); 6] =
    [(0.0, 1.0), (0.0, 0.375), (0.375, 1.0), (0.25, 0.5), (0.5, 1.0), (0.0, 0.125)];

fn check_planted(bodies: [Moving<'_>; 2], truth: impl Fn(f64) -> f64, nearest: f64) {
    for (start, end) in WINDOWS {
        let window = Window::try_new(start, end).unwrap();
        let expected = truth(nearest.clamp(start, end));
        for accuracy in [1e-3, 1e-6, 1e-9] {
            let options = ClearanceOptions::default().with_accuracy(accuracy);
            let found = clearance(bodies[0], bodies[1], window, &options).unwrap();
            assert_eq!(found.status, ClearanceStatus::Clear);
            assert!(found.lower <= expected * (1.0 + 1e-12), "{start} {end}: {found:?} {expected}");
            assert!(found.upper >= expected * (1.0 - 1e-12), "{start} {end}: {found:?} {expected}");
            assert!(found.upper - found.lower <= (accuracy * found.upper).max(4.0 * found.tolerance));
            assert!((truth(found.time) - expected).abs() <= (accuracy * expected).max(1e-8), "{found:?}");
        }
    }
}

/// Two points on straight lines, and a bar that turns past a point, forwards and backwards in time.
#[test]
fn planted_minima_are_found_wherever_the_window_ends() {
    let nearest = 0.375;
    let point = MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap());
    let bar = MeshTree::new(TriMesh::segment(-DVec3::X, DVec3::X).unwrap());
    for speed in [0.5, 4.0, -512.0] {
        let from = DVec3::new(-speed * nearest, 0.0, 0.25);
        let passing = ConstantTwist::REST.with_position(from).with_linear_velocity(DVec3::X * speed);
        let bodies = [Moving::new(&point, &ConstantTwist::REST), Moving::new(&point, &passing)];
        check_planted(bodies, |t| (speed * (t - nearest)).hypot(0.25), nearest);
    }
    for spin in [0.75, -2.0, 3.0] {
        let turning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * spin).with_reference_time(nearest);
        let at = ConstantTwist::REST.with_position(DVec3::X * 1.5);
        let truth = |t: f64| {
            let (sin, cos) = (spin * (t - nearest)).sin_cos();
            if 1.5 * cos.abs() <= 1.0 { 1.5 * sin.abs() } else { (1.5 - cos.abs()).hypot(sin) }
        };
        check_planted([Moving::new(&bar, &turning), Moving::new(&point, &at)], truth, nearest);
    }
}

/// What a small budget proves is true, and no budget proves less than a smaller one.
#[test]
fn small_budgets_give_wide_enclosures_that_hold() {
    let torus = tree(Surface::wavy_torus(17, 9, 0.35));
    let passing = ConstantTwist::REST
        .with_position(DVec3::new(-2.0, 3.25, 0.1))
        .with_linear_velocity(DVec3::X * 4.0)
        .with_angular_velocity(DVec3::new(0.5, 1.0, -0.75));
    let [a, b] = [Moving::new(&torus, &ConstantTwist::REST), Moving::new(&torus, &passing)];
    let all = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
    assert_eq!(all.status, ClearanceStatus::Clear);
    let (mut undecided, mut clear) = (0, 0);
    for exponent in 0..16 {
        let budget = Budget::UNLIMITED.with_node_tests(1 << exponent);
        let some = clearance(a, b, Window::UNIT, &ClearanceOptions::default().with_budget(budget)).unwrap();
        assert!(0.0 <= some.lower && some.lower <= all.upper && some.upper >= all.lower, "{some:?} {all:?}");
        undecided += usize::from(some.status == ClearanceStatus::Undecided);
        clear += usize::from(some.status == ClearanceStatus::Clear);
    }
    assert!(undecided > 2 && clear > 2, "{undecided} {clear}");
}

#[test]
fn windows_of_no_length_bodies_inside_each_other_and_budgets() {
    let (large, small) = (cuboid(DVec3::splat(2.0)), cuboid(DVec3::splat(0.25)));
    let still = ConstantTwist::REST;
    let options = ClearanceOptions::default();
    let [a, b] = [Moving::new(&large, &still), Moving::new(&small, &still)];
    let inside = clearance(a, b, Window::UNIT, &options).unwrap();
    assert_eq!((inside.lower, inside.upper, inside.status), (0.0, 0.0, ClearanceStatus::Contact));
    let surfaces = clearance(a, b, Window::UNIT, &options.with_solid(Solid::Surface)).unwrap();
    assert!((surfaces.upper - 1.75).abs() < 1e-12 && surfaces.status == ClearanceStatus::Clear);
    let aside = ConstantTwist::REST.with_position(DVec3::X * 3.0);
    let b = Moving::new(&small, &aside);
    let instant = Window::try_new(0.5, 0.5).unwrap();
    let found = clearance(a, b, instant, &options).unwrap();
    assert!((found.upper - 0.75).abs() < 1e-12 && found.time == 0.5 && found.lower > 0.7499);
    let turning = ConstantTwist::REST.with_position(DVec3::X * 3.5).with_angular_velocity(DVec3::Z * 40.0);
    for tests in [0, 1, 10, 100] {
        let options = options.with_budget(Budget::UNLIMITED.with_node_tests(tests));
        let some = clearance(a, Moving::new(&small, &turning), Window::UNIT, &options).unwrap();
        let truth = 1.5 - 0.25 * 2f64.sqrt();
        assert!(some.lower <= truth + 1e-12 && some.upper >= truth - 1e-12, "{some:?}");
    }
    let bad =
        |accuracy: f64| clearance(a, b, Window::UNIT, &ClearanceOptions::default().with_accuracy(accuracy));
    assert!(matches!(bad(0.0), Err(QueryError::BadAccuracy { .. })));
    assert!(matches!(bad(f64::NAN), Err(QueryError::BadAccuracy { .. })));
    let cut = clearance(
        a,
        Moving::new(&small, &aside),
        Window::UNIT,
        &ClearanceOptions::default().with_cutoff(0.5),
    );
    assert!(cut.is_ok_and(|cut| cut.lower >= 0.5 && cut.status == ClearanceStatus::Clear));
}

/// Where nothing is decided at the only time of a window, that is its span: it was clear, from there to the number before.
#[test]
fn a_window_of_no_length_in_which_nothing_is_decided_is_undecided() {
    let tree = cuboid(DVec3::splat(0.5));
    let still = ConstantTwist::REST;
    let mut undecided = 0;
    for time in [1.0, 0.3, 0.0, -7.0] {
        for (place, budget) in [(0.25, 1000), (0.25, 0), (0.25, 1), (1.0, 1000), (3.0, 0), (3.0, 1000)] {
            // So fast that the enclosures of its place are as wide as the bodies.
            for speed in [0.0, 1e10, 1e16] {
                let flying = ConstantTwist::REST
                    .with_position(DVec3::X * (place - speed))
                    .with_linear_velocity(DVec3::X * speed)
                    .with_reference_time(time - 1.0);
                let flying = Opaque(flying);
                let [a, b] = [Moving::new(&tree, &still), Moving::new(&tree, &flying)];
                let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(budget));
                let now = Window::try_new(time, time).unwrap();
                let spans = contact_spans(a, b, now, &options, None).unwrap();
                assert!(
                    !spans.is_empty() && spans.iter().all(|span| [span.from, span.to] == [time; 2]),
                    "{spans:?}"
                );
                let is_clear = spans.iter().any(|span| span.status == SpanStatus::Clear);
                assert!(!is_clear || place > 0.5, "{time} {place} {speed:e}: {spans:?}");
                undecided += usize::from(spans[0].status == SpanStatus::Undecided);
            }
        }
    }
    assert!(undecided > 10, "{undecided}");
}

/// A ball is a point with a radius: contact and clearance of spheres and capsules, known in closed form.
#[test]
fn radii_are_exact() {
    let point = MeshTree::new(TriMesh::point(DVec3::ZERO).unwrap());
    let segment = MeshTree::new(TriMesh::segment(DVec3::ZERO, DVec3::Y * 2.0).unwrap());
    let falling =
        ConstantTwist::REST.with_position(DVec3::new(3.0, 1.0, 0.0)).with_linear_velocity(DVec3::X * -4.0);
    let still = ConstantTwist::REST;
    let ball = Moving::new(&point, &falling).with_radius(0.5);
    let capsule = Moving::new(&segment, &still).with_radius(0.25);
    let answer = time_of_contact(ball, capsule, Window::UNIT, &QueryOptions::default()).unwrap();
    let contact = answer.contact().expect("they meet");
    let truth = (3.0 - 0.75) / 4.0;
    assert!(contact.time_lo <= truth && truth - contact.time_lo < 1e-9, "{contact:?}");
    assert!((contact.point_a - contact.point_b).length() < 1e-9 && contact.separation < 1e-9);
    assert!((contact.normal + DVec3::X).length() < 1e-9);
    let passing = falling.with_position(DVec3::new(2.0, 3.0, 0.0));
    let ball = Moving::new(&point, &passing).with_radius(0.5);
    let found = clearance(ball, capsule, Window::UNIT, &ClearanceOptions::default()).unwrap();
    assert!(found.lower <= 0.25 && 0.25 <= found.upper && found.upper - found.lower < 1e-6, "{found:?}");
    assert!(
        (found.point_b - DVec3::Y * 2.25).length() < 1e-3 && (found.point_a - DVec3::Y * 2.5).length() < 1e-3
    );
    let bad = Moving::new(&point, &passing).with_radius(-1.0);
    let refused = time_of_contact(bad, capsule, Window::UNIT, &QueryOptions::default());
    assert_eq!(refused, Err(QueryError::BadRadius { body: 0, value: -1.0 }));
}

/// Bodies that go into each other have no clearance, and meet at a time, also where radii are below what rounding hides of the distance of two
/// triangles.
#[test]
fn radii_below_rounding_are_met() {
    let cube = cuboid(DVec3::splat(0.5));
    let coming = ConstantTwist::REST.with_position(DVec3::X * 3.0).with_linear_velocity(DVec3::X * -4.0);
    let still = Moving::new(&cube, &ConstantTwist::REST);
    for radius in [0.0, 1e-320, 1e-200, 1e-30, 1e-20, 1e-15, 1e-12, 1e-3] {
        let moving = Moving::new(&cube, &coming).with_radius(radius);
        let found = clearance(moving, still, Window::UNIT, &ClearanceOptions::default()).unwrap();
        assert_eq!((found.status, found.upper), (ClearanceStatus::Contact, 0.0), "{radius}: {found:?}");
        let answer = time_of_contact(moving, still, Window::UNIT, &QueryOptions::default()).unwrap();
        let met = answer.contact().expect("they meet");
        assert!(
            (found.time - met.time_lo).abs() < 1e-12 && found.normal == met.normal,
            "{radius}: {found:?}"
        );
    }
}

/// Bodies that overlap at the start never begin apart, whatever budget ends the search; where it ends the one of the start nothing is known of it.
#[test]
fn a_start_that_was_not_searched_is_undecided() {
    let ring = tree(Surface::wavy_torus(9, 6, 0.35));
    let pulled = ConstantTwist::REST.with_position(DVec3::X * 0.4).with_linear_velocity(DVec3::Z * 4.0);
    let [a, b] = [Moving::new(&ring, &ConstantTwist::REST), Moving::new(&ring, &pulled)];
    let states = (0..400).step_by(4).map(|tests| {
        let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(tests));
        departure(a, b, Window::UNIT, &options).unwrap().start
    });
    let states: Vec<StartState> = states.collect();
    assert!(!states.contains(&StartState::Apart) && states[0] == StartState::Undecided, "{states:?}");
    assert_eq!(states.last(), Some(&StartState::Overlapping));
}

/// Every span of random flights against samples.
#[test]
fn spans_hold_against_dense_sampling() {
    let bodies = [cuboid(DVec3::new(1.0, 0.5, 0.25)), tree(Surface::wavy_torus(9, 6, 0.35))];
    let mut random = KnuthRandom(5);
    let (mut contacts, mut clears) = (0, 0);
    for round in 0..40 {
        let (a, b) = (&bodies[round % 2], &bodies[round / 2 % 2]);
        let twists = [2.5, 0.5].map(|far| random_twist(&mut random, far, 6.0));
        let keys = random_keyframes(&mut random);
        let motion: &dyn RigidMotion = if round % 4 == 3 { &keys } else { &twists[0] };
        let [a, b] = [Moving::new(a, motion), Moving::new(b, &twists[1])];
        let options = QueryOptions::default().with_solid(Solid::Surface);
        let resolution = 1e-4;
        let spans = contact_spans(a, b, Window::UNIT, &options, Some(resolution)).unwrap();
        assert_eq!((spans[0].from, spans[spans.len() - 1].to), (0.0, 1.0));
        assert!(spans.windows(2).all(|two| two[0].to == two[1].from && two[0].status != two[1].status));
        for span in &spans {
            for i in 0..=20 {
                let time = (span.from + (span.to - span.from) * f64::from(i) / 20.0).min(span.to);
                let distance = sampled(&a, &b, time);
                match span.status {
                    SpanStatus::Clear => assert!(distance > 0.0, "{span:?} {time}"),
                    // Nothing clear for longer than the resolution.
                    SpanStatus::Contact => {
                        let near = |t: f64| sampled(&a, &b, t.clamp(0.0, 1.0)) <= 2e-10;
                        let around = (-8..=8).any(|k| near(time + resolution * f64::from(k) / 8.0));
                        assert!(around, "{span:?} {time} {distance}");
                    }
                    SpanStatus::Undecided => panic!("{span:?}"),
                }
            }
            contacts += usize::from(span.status == SpanStatus::Contact);
            clears += usize::from(span.status == SpanStatus::Clear);
        }
    }
    assert!(contacts > 20 && clears > 40, "{contacts} {clears}");
}

/// Lifted from a table at a known time, carried along it, and never lifted.
/// Which contact there is decides nothing of spans, though the mode that only asks for one finds others first.
#[test]
fn spans_of_the_mode_that_only_asks_for_a_contact_are_the_same() {
    let mut random = KnuthRandom(58);
    let plate = cuboid(DVec3::new(2.0, 0.1, 2.0));
    let bar = cuboid(DVec3::new(0.1, 0.1, 1.0));
    let (mut met, mut later) = (0, 0);
    for _ in 0..24 {
        let motion = random_keyframes(&mut random);
        let bodies = [Moving::new(&plate, &ConstantTwist::REST), Moving::new(&bar, &motion)];
        for [a, b] in [bodies, [bodies[1], bodies[0]]] {
            let [accurate, exists] =
                [Mode::Accurate, Mode::Exists].map(|mode| QueryOptions::default().with_mode(mode));
            let spans = |options| contact_spans(a, b, Window::UNIT, options, Some(1e-3)).unwrap();
            assert_eq!(spans(&accurate), spans(&exists));
            let time =
                |options| time_of_contact(a, b, Window::UNIT, options).unwrap().contact().map(|c| c.time_lo);
            met += u32::from(time(&accurate).is_some());
            later += u32::from(time(&exists) > time(&accurate));
        }
    }
    assert!(met > 10 && later > 0, "{met}, {later}");
}

#[test]
fn what_holds_at_the_start_is_let_go() {
    let table = cuboid(DVec3::new(4.0, 4.0, 0.5));
    let part = cuboid(DVec3::splat(0.5));
    let still = ConstantTwist::REST;
    let pose = |x: f64, z: f64| Pose { translation: DVec3::new(x, 0.125, z), ..Pose::IDENTITY };
    // Slides along the table, is lifted, moved, and set down again.
    let path = [pose(0.0, 1.0), pose(1.0, 1.0), pose(1.0, 1.5), pose(-1.0, 1.5), pose(-1.0, 0.9)];
    let keys: Vec<_> = [0.0, 1.0, 2.0, 3.0, 4.0].into_iter().zip(path).collect();
    let keys = Keyframes::try_new(&keys, Span::Linear).unwrap();
    let window = Window::try_new(0.0, 4.0).unwrap();
    let [a, b] = [Moving::new(&part, &keys), Moving::new(&table, &still)];
    let options = QueryOptions::default().with_start(Start::Leave);
    let parting = departure(a, b, window, &options).unwrap();
    let left = parting.left.expect("lifted");
    assert!(left.lo >= 1.0 - 1e-9 && left.hi <= 1.0 + 1e-8 && left.lo <= left.hi, "{left:?}");
    let contact = parting.answer.contact().expect("set down");
    assert!((contact.time_lo - (3.0 + 0.5 / 0.6)).abs() < 1e-8, "{contact:?}");
    let same = time_of_contact(a, b, window, &options).unwrap();
    assert_eq!(same.contact().and_then(|contact| contact.left), Some(left));
    let spans = contact_spans(a, b, window, &QueryOptions::default(), None).unwrap();
    let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
    assert_eq!(statuses, [SpanStatus::Contact, SpanStatus::Clear, SpanStatus::Contact], "{spans:?}");
    // Never parts: gripped, by a motion that both make.
    let lifting = ConstantTwist::REST.with_linear_velocity(DVec3::Z).with_angular_velocity(DVec3::Z);
    let gripped = lifting.with_position(DVec3::Z);
    let [a, b] = [Moving::new(&part, &gripped), Moving::new(&table, &lifting)];
    let parting = departure(a, b, Window::UNIT, &options).unwrap();
    assert!(parting.left.is_none() && parting.start != StartState::Apart);
    assert_eq!(parting.answer.contact().map(|contact| contact.time_lo), Some(0.0));
    // Apart from the start.
    let high = ConstantTwist::REST.with_position(DVec3::Z * 3.0).with_linear_velocity(DVec3::Z * -4.0);
    let parting = departure(Moving::new(&part, &high), Moving::new(&table, &still), Window::UNIT, &options);
    let parting = parting.unwrap();
    assert_eq!(parting.left.map(|left| left.hi), Some(0.0));
    assert!(
        matches!(parting.answer, TimeOfContact::Contact(contact) if (contact.time_lo - 0.5).abs() < 1e-9)
    );
}

/// Searches stop up to two tolerances above the separation, whether bodies come or go: those that begin there and go have left.
#[test]
fn what_goes_from_just_above_the_level_has_left() {
    let cube = cuboid(DVec3::splat(0.5));
    let options = QueryOptions::default().with_tolerance(1e-6).with_start(Start::Leave);
    let mut begun_apart = 0;
    for parts in [1.01, 1.2, 1.5, 1.9] {
        for radius in [0.0, 0.25] {
            let place = DVec3::X * (1.0 + radius + parts * 1e-6);
            let ways = [1.0, -1.0].map(|way| {
                let motion = ConstantTwist::REST.with_position(place).with_linear_velocity(DVec3::X * way);
                let a = Moving::new(&cube, &ConstantTwist::REST).with_radius(radius);
                departure(a, Moving::new(&cube, &motion), Window::try_new(0.0, 0.5).unwrap(), &options)
                    .unwrap()
            });
            let [going, coming] = ways;
            // At once, or as soon as they are clearly apart where the start itself was not proven to be above the level.
            let is_apart = going.start == StartState::Apart;
            let hi = going.left.map(|left| left.hi);
            assert!(hi.is_some_and(|hi| if is_apart { hi == 0.0 } else { hi < 1e-5 }), "{parts}: {going:?}");
            assert!(going.answer.is_separated(), "{parts}: {going:?}");
            let met = coming.answer.contact().unwrap_or_else(|| panic!("{parts}: {coming:?}"));
            assert!(met.time_lo < parts * 1e-6, "{parts}: {met:?}");
            // They touch after the start, and the tolerance is that of the finer search.
            assert!(!is_apart || met.time_lo > 0.0 && met.tolerance < 1e-6, "{parts}: {met:?}");
            begun_apart += u32::from(is_apart);
        }
    }
    assert!(begun_apart > 1, "{begun_apart}");
}

/// Faces that slide in one plane cross nowhere, and no vertex stays above the inside of a face: the points that wander prove it.
#[test]
fn boxes_with_common_planes_are_followed_through_each_other() {
    let cube = cuboid(DVec3::ONE);
    let flying = ConstantTwist::REST.with_position(DVec3::X * -4.0).with_linear_velocity(DVec3::X * 8.0);
    let [a, b] = [Moving::new(&cube, &ConstantTwist::REST), Moving::new(&cube, &flying)];
    let budget = Budget::UNLIMITED.with_node_tests(1_000_000);
    let options = QueryOptions::default().with_budget(budget);
    let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
    let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
    assert_eq!(statuses, [SpanStatus::Clear, SpanStatus::Contact, SpanStatus::Clear]);
    // Sides of two: they meet at a distance of two and part at two.
    assert!((spans[1].from - 0.25).abs() < 2e-6 && (spans[1].to - 0.75).abs() < 2e-6, "{spans:?}");
}

/// A body that gains speed while it slides over a face, alone and in a frame that turns with both: a straight way would leave it within
/// a part of the window that is as small as the root of the tolerance, thousands of times.
#[test]
fn what_gains_speed_on_a_face_is_followed_in_long_steps() {
    let plate = cuboid(DVec3::new(4.0, 4.0, 1.0));
    let foot = TriMesh::try_new(vec![DVec3::ZERO, DVec3::new(0.1, 0.0, 1.0), DVec3::Z], vec![[0, 1, 2]]);
    let foot = MeshTree::new(foot.unwrap());
    let value = JointValue::try_polynomial(vec![-0.5, 0.3, 2.0, -0.7]).unwrap();
    let joint = Joint::try_new(
        DVec3::Z,
        DQuat::IDENTITY,
        JointKind::Prismatic { axis: DVec3::new(0.6, 0.8, 0.0), value },
    );
    let sliding = Chain::try_new(vec![joint.unwrap()]).unwrap();
    let turning =
        ConstantTwist::try_new(DVec3::Y, DQuat::IDENTITY, DVec3::X, DVec3::new(1.0, 3.0, -2.0)).unwrap();
    let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(1_500_000));
    for frame in [ConstantTwist::REST, turning] {
        let (a, b) = (Composed::new(frame, sliding.clone()), Composed::new(frame, ConstantTwist::REST));
        let foot = Moving::new(&foot, &a).with_solid(Solid::Surface);
        let spans = contact_spans(foot, Moving::new(&plate, &b), Window::UNIT, &options, None).unwrap();
        let [only] = &spans[..] else { panic!("{spans:?}") };
        assert_eq!(only.status, SpanStatus::Contact, "{spans:?}");
    }
}

/// From gaps that no pose resolves to those above the tolerance, with numbers that are exact and with others: what is stated as no distance is
/// below the errors of placing the bodies.
#[test]
fn only_what_placing_hides_is_stated_as_no_distance() {
    let cube = cuboid(DVec3::splat(0.5));
    // Both errors of placing, twice, for lengths of less than two; and by how much the turned numbers move the bodies.
    let (hidden, rounding) = (256.0 * f64::EPSILON, 4.0 * f64::EPSILON);
    let mut stated = [0; 2];
    for turn in [DQuat::IDENTITY, DQuat::from_xyzw(0.1, 0.2, 0.3, 0.9).normalize()] {
        for gap in (9..=17).map(|digits| 10_f64.powi(-digits)) {
            let height = 1.0 + gap;
            let sliding = ConstantTwist::try_new(
                turn * (DVec3::Y * height),
                turn,
                turn * (DVec3::X * 0.3),
                DVec3::ZERO,
            );
            let resting = ConstantTwist::try_new(DVec3::ZERO, turn, DVec3::ZERO, DVec3::ZERO).unwrap();
            let (sliding, gap) = (sliding.unwrap(), height - 1.0);
            let (a, b) = (Moving::new(&cube, &resting), Moving::new(&cube, &sliding));
            let found = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
            assert!(found.lower <= gap + rounding, "{gap:e}: {found:?}");
            assert!(
                found.upper >= gap - rounding || found.upper == 0.0 && gap <= hidden,
                "{gap:e}: {found:?}"
            );
            stated[usize::from(found.upper == 0.0)] += 1;
        }
    }
    assert!(stated[0] > 8 && stated[1] >= 4, "{stated:?}");
}

/// Boxes that slide past each other at a gap that the tolerance does not resolve come near each other and no nearer than that gap, though
/// they part by some roundings: only what shares points has no distance.
#[test]
fn a_gap_below_the_tolerance_is_a_distance() {
    let cube = cuboid(DVec3::splat(0.5));
    let aside = DVec3::new(0.3, 1.0, 0.2);
    for (gap, motion) in [1e-13, 1e-12, 1e-11, 2e-11, 5e-11, 1e-10].into_iter().flat_map(|gap| {
        let sliding = ConstantTwist::REST
            .with_position(DVec3::new(-3.0, 1.0 + gap, 0.1))
            .with_linear_velocity(DVec3::X * 6.0);
        [(gap, sliding), (gap, ConstantTwist::REST.with_position(aside + DVec3::Y * gap))]
    }) {
        let (a, b) = (Moving::new(&cube, &motion), Moving::new(&cube, &ConstantTwist::REST));
        for (a, b) in [(a, b), (b, a)] {
            let found = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
            assert!(found.lower <= gap && 0.99 * gap <= found.upper, "{gap:e}: {found:?}");
            assert!(found.upper - found.lower <= 4.0 * found.tolerance, "{gap:e}: {found:?}");
            assert!(
                (found.point_a.distance(found.point_b) - found.upper).abs() < 1e-12,
                "{gap:e}: {found:?}"
            );
        }
    }
    // Flush with each other, resting and sliding by.
    for motion in [
        ConstantTwist::REST.with_position(aside),
        ConstantTwist::REST.with_position(DVec3::new(-3.0, 1.0, 0.1)).with_linear_velocity(DVec3::X * 6.0),
    ] {
        let (a, b) = (Moving::new(&cube, &motion), Moving::new(&cube, &ConstantTwist::REST));
        let found = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
        assert_eq!([found.lower, found.upper], [0.0; 2], "{found:?}");
    }
}

/// Where rounding resolves no less than is asked for, spans of contact say so, as contacts do; also of bodies with radii.
#[test]
fn spans_of_contact_state_the_tolerance_that_rounding_leaves() {
    let tree = MeshTree::new(Surface::cube(0.5).into_mesh(TriMesh::try_new));
    let through = ConstantTwist::REST.with_position(DVec3::X * -3.0).with_linear_velocity(DVec3::X * 6.0);
    for (radius, asked) in [(0.0, 1e-30), (0.0, 1e-9), (0.1, 1e-30)] {
        let [a, b] =
            [&through, &ConstantTwist::REST].map(|motion| Moving::new(&tree, motion).with_radius(radius));
        let options = QueryOptions::default().with_tolerance(asked);
        let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
        let found = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let tolerance = found.contact().unwrap().tolerance;
        let contact = spans[1];
        assert_eq!(contact.status, SpanStatus::Contact);
        assert!(
            contact.tolerance >= asked && (contact.tolerance > asked) == (tolerance > asked),
            "{spans:?} {found:?}"
        );
        assert!(contact.tolerance <= 2.0 * tolerance, "{spans:?} {found:?}");
        // The walk's level is that tolerance.
        for end in [contact.from, contact.to] {
            let apart = sampled(&a, &b, end) - 2.0 * radius;
            assert!(apart <= 3.4 * contact.tolerance + 1e-15, "{apart} {spans:?}");
        }
    }
}
