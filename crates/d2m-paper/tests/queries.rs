//! The reference method on scenes with a known answer.

// One list of scenes for both methods.
#[path = "../../d2m-bvh/tests/scenes/mod.rs"]
mod scenes;

use d2m_bvh::{
    Budget, Mode, QueryError, QueryOptions, Solid, Start, StartState, TimeOfContact, TriMesh, Window,
};
use d2m_motion::ConstantTwist;
use d2m_paper::{Moving, SphereTree, time_of_contact};
use d2m_testing::Surface;
use glam::DVec3;
use scenes::{Expected, Scene};

fn ask(scene: &Scene, options: &QueryOptions) -> TimeOfContact {
    let trees = scene.meshes.clone().map(SphereTree::new);
    time_of_contact(
        Moving::new(&trees[0], &scene.motions[0]),
        Moving::new(&trees[1], &scene.motions[1]),
        scene.window,
        &options.with_solid(scene.solid),
    )
    .expect("good input")
}

fn default_tolerance(scene: &Scene) -> f64 {
    let radius = |i: usize| SphereTree::new(scene.meshes[i].clone()).bounding_sphere().radius;
    1e-10 * radius(0).max(radius(1))
}

#[test]
fn every_scene_has_its_answer() {
    for scene in scenes::all() {
        let started = std::time::Instant::now();
        let answer = ask(&scene, &QueryOptions::DEFAULT);
        println!("{}: {:.1} ms", scene.name, started.elapsed().as_secs_f64() * 1e3);
        scene.check(&answer, default_tolerance(&scene));
    }
}

#[test]
fn a_wider_tolerance_keeps_its_band() {
    for scene in scenes::all() {
        if matches!(scene.expected, Expected::At { .. }) && !scene.name.contains("small") {
            let answer = ask(&scene, &QueryOptions::DEFAULT.with_tolerance(1e-7));
            scene.check(&answer, 1e-7);
        }
    }
}

/// Capoeira is early, never late, and its "separated" is true; its contact may be none.
#[test]
fn capoeira_is_early_and_never_late() {
    for scene in scenes::all() {
        match (scene.expected, ask(&scene, &QueryOptions::DEFAULT.with_mode(Mode::Capoeira))) {
            (Expected::At { time, slack, .. }, TimeOfContact::Contact(c)) => {
                assert!(c.time_lo <= time + slack, "{}: late", scene.name);
            }
            (Expected::Start(state), TimeOfContact::Contact(c)) => {
                assert_eq!(c.start, state, "{}", scene.name);
            }
            (Expected::Separated, _) => {}
            (expected, answer) => panic!("{}: {expected:?} {answer:?}", scene.name),
        }
    }
}

/// Every budget is kept, and what an undecided answer calls clear is clear.
#[test]
fn budgets_are_kept_and_honest() {
    for scene in scenes::all() {
        for tests in [0, 1, 2, 5, 20, 100, 1000] {
            let options = QueryOptions::DEFAULT.with_budget(Budget::UNLIMITED.with_node_tests(tests));
            match ask(&scene, &options) {
                TimeOfContact::Undecided { clear_until } => match scene.expected {
                    Expected::At { time, slack, .. } => {
                        assert!(clear_until <= time + slack, "{} {tests}: {clear_until}", scene.name);
                        assert!(clear_until >= scene.window.start());
                    }
                    Expected::Start(_) => assert_eq!(clear_until, scene.window.start()),
                    Expected::Separated => assert!(scene.window.contains(clear_until)),
                },
                // They are near each other; whether they touch or overlap the budget left open.
                TimeOfContact::Contact(contact) if contact.start == StartState::Undecided => {
                    assert!(matches!(scene.expected, Expected::Start(_)), "{} {tests}", scene.name);
                }
                answer => scene.check(&answer, default_tolerance(&scene)),
            }
        }
        let clock = Budget::UNLIMITED.with_wall_clock(core::time::Duration::ZERO);
        let answer = ask(&scene, &QueryOptions::DEFAULT.with_budget(clock));
        assert_eq!(answer, TimeOfContact::Undecided { clear_until: scene.window.start() });
    }
}

#[test]
fn bad_input_is_an_error_and_nothing_else() {
    let scene = &scenes::all()[0];
    let trees = scene.meshes.clone().map(SphereTree::new);
    let moving = |i: usize| Moving::new(&trees[i], &scene.motions[i]);
    let ask = |options: &QueryOptions| time_of_contact(moving(0), moving(1), scene.window, options);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let refused = ask(&QueryOptions::DEFAULT.with_tolerance(bad));
        assert!(matches!(refused, Err(QueryError::BadTolerance { .. })), "{bad}");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = ask(&QueryOptions::DEFAULT.with_min_separation(bad));
        assert!(matches!(refused, Err(QueryError::BadMinSeparation { .. })), "{bad}");
    }
    let unsupported = ask(&QueryOptions::DEFAULT.with_min_separation(0.5));
    assert_eq!(unsupported, Ok(TimeOfContact::Undecided { clear_until: scene.window.start() }));
    // Nothing of what it does not know of is passed over.
    for [a, b] in [[moving(0).with_radius(0.5), moving(1)], [moving(0), moving(1).with_radius(0.5)]] {
        assert_eq!(time_of_contact(a, b, scene.window, &QueryOptions::DEFAULT), unsupported);
    }
    assert_eq!(ask(&QueryOptions::DEFAULT.with_start(Start::Leave)), unsupported);
    let sheet = SphereTree::new(scenes::soup(&[[DVec3::ZERO, DVec3::X, DVec3::Y]]));
    let open = Moving::new(&sheet, &scene.motions[0]);
    let refused = time_of_contact(moving(0), open, Window::UNIT, &QueryOptions::DEFAULT);
    assert_eq!(refused, Err(QueryError::NotWatertight { body: 1 }));
    let surface = QueryOptions::DEFAULT.with_solid(Solid::Surface);
    assert!(time_of_contact(moving(0), open, Window::UNIT, &surface).is_ok());
    let runaway = scene.motions[0].with_linear_velocity(DVec3::splat(1e300));
    let refused =
        time_of_contact(moving(0), Moving::new(&trees[1], &runaway), Window::UNIT, &QueryOptions::DEFAULT);
    assert_eq!(refused, Err(QueryError::BadMotion { body: 1 }));
}

/// The same motions given only through the open trait give the same answers.
#[test]
fn any_rigid_motion_through_its_enclosures() {
    use d2m_testing::Opaque;
    for scene in scenes::all() {
        let trees = scene.meshes.clone().map(SphereTree::new);
        let motions = scene.motions.map(Opaque);
        let answer = time_of_contact(
            Moving::new(&trees[0], &motions[0]),
            Moving::new(&trees[1], &motions[1]),
            scene.window,
            &QueryOptions::DEFAULT.with_solid(scene.solid),
        );
        scene.check(&answer.unwrap(), default_tolerance(&scene));
    }
}

/// Erratum 6. A tip dips 1e-8 into a wall, the closing speed at the contact is 2e-4 of the tip's: the paper's step of
/// δ/v_n leaves another separation than it means to, and with a dip of nothing it is unbounded. Ours is measured.
#[test]
fn the_step_back_is_measured() {
    use d2m_motion::ConstantTwist;
    let h = 0.0625;
    let reach = (1.0f64 + h * h).sqrt();
    for depth in [1e-6, 1e-8, 1e-9] {
        let wall = scenes::plank(glam::dvec3(-4.0, reach - depth, -2.0), glam::dvec3(4.0, 2.0, 2.0));
        let bar = scenes::plank(glam::dvec3(-1.0, -h, -h), glam::dvec3(1.0, h, h));
        let turning = ConstantTwist::REST.with_angular_velocity(glam::dvec3(0.0, 0.0, 2.0));
        let trees = [bar, wall].map(SphereTree::new);
        let tolerance = 1e-9;
        let answer = time_of_contact(
            Moving::new(&trees[0], &turning),
            Moving::new(&trees[1], &ConstantTwist::REST),
            Window::UNIT,
            &QueryOptions::DEFAULT.with_tolerance(tolerance),
        )
        .unwrap();
        let contact = answer.contact().expect("the tip dips in");
        assert!((tolerance..=3.3 * tolerance).contains(&contact.separation), "{depth:e}: {contact:?}");
        // The tip is at height reach·sin(2t + atan h); its true distance at time_lo is the separation reported.
        let gap = |t: f64| (reach - depth) - reach * (2.0 * t + h.atan()).sin();
        assert!(
            (gap(contact.time_lo) - contact.separation).abs() < 1e-13,
            "{depth:e}: {:e}",
            gap(contact.time_lo) - contact.separation
        );
        let root = (((reach - depth) / reach).asin() - h.atan()) / 2.0;
        let closing = 2.0 * reach * (2.0 * root + h.atan()).cos();
        let literal = gap(root - tolerance / closing);
        if depth < 2e-9 {
            assert!(
                literal > 1.2 * tolerance,
                "{depth:e}: the literal step would have been right, {literal:e}"
            );
        }
    }
}

/// Motions that are not of constant twist: free fall, and a bar that spins up.
#[test]
fn accelerated_motions() {
    use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
    use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
    use glam::{DQuat, dvec3};
    /// x = from + ½ fall t², turned by ½ spin t² about z.
    struct Accelerated {
        from: DVec3,
        fall: DVec3,
        spin: f64,
    }
    impl RigidMotion for Accelerated {
        fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
            let rotation = DQuat::from_rotation_z(0.5 * self.spin * t * t);
            let translation = self.from + self.fall * (0.5 * t * t);
            let twist = Twist { linear: self.fall * t, angular: DVec3::Z * (self.spin * t) };
            (Pose { rotation, translation, at: DVec3::ZERO }, twist)
        }
        fn enclose_pose(&self, t: Interval) -> IntervalPose {
            let half = t.sqr() * 0.5;
            let translation = IntervalVec3::point(self.fall) * half + self.from;
            IntervalPose {
                rotation: IntervalMat3::rotation(DVec3::Z, half * self.spin),
                translation,
                at: DVec3::ZERO,
            }
        }
        fn enclose_twist(&self, t: Interval) -> IntervalTwist {
            IntervalTwist {
                linear: IntervalVec3::point(self.fall) * t,
                angular: IntervalVec3::point(DVec3::Z * self.spin) * t,
            }
        }
        fn enclose_twist_rate(&self, _: Interval) -> IntervalTwist {
            IntervalTwist {
                linear: IntervalVec3::point(self.fall),
                angular: IntervalVec3::point(DVec3::Z * self.spin),
            }
        }
    }
    let first = |bodies: [d2m_bvh::TriMesh; 2], motion: &Accelerated| {
        let trees = bodies.map(SphereTree::new);
        let (a, b) = (Moving::new(&trees[0], motion), Moving::new(&trees[1], &ConstantTwist::REST));
        let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::DEFAULT).unwrap();
        *answer.contact().expect("a contact")
    };
    // A gap of 2 under an acceleration of 16: t = 1/2 exactly.
    let falling = Accelerated { from: dvec3(0.25, 0.125, 3.0), fall: dvec3(0.0, 0.0, -16.0), spin: 0.0 };
    let cube = || scenes::cube(DVec3::ZERO, 1.0);
    let contact = first([cube(), cube()], &falling);
    assert!(contact.time_lo < 0.5 && contact.time_lo > 0.5 - 1e-10, "{contact:?}");
    assert!((contact.closing_speed - 8.0).abs() < 1e-8);
    // The bar of the scenes meets the wall at the same angle.
    let h = 0.0625;
    let bar = scenes::plank(dvec3(-1.0, -h, -h), dvec3(1.0, h, h));
    let wall = scenes::plank(dvec3(-4.0, 0.5, -2.0), dvec3(4.0, 1.0, 2.0));
    let angle = (0.5 / (1.0 + h * h).sqrt()).asin() - h.atan();
    let spinning = Accelerated { from: DVec3::ZERO, fall: DVec3::ZERO, spin: 4.0 };
    let contact = first([bar, wall], &spinning);
    let truth = (angle / 2.0).sqrt();
    assert!(contact.time_lo < truth + 1e-13 && contact.time_lo > truth - 1e-9, "{contact:?} {truth}");
}

/// Any finite numbers at all: an answer or an error within the budget, never a panic.
#[test]
fn arbitrary_numbers_neither_panic_nor_hang() {
    use d2m_motion::ConstantTwist;
    use glam::DQuat;
    let mut state = 0x1234_5678_9ABC_DEF0u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        state ^ (state >> 31)
    };
    let special = [0.0, -0.0, 1.0, -1.0, 1e-300, 1e30, -1e59, 0.1, f64::MIN_POSITIVE, 3.0, 5e-324];
    let mut wild = 0.0f64;
    let (mut answered, mut refused) = (0, 0);
    for round in 0..1500 {
        // From tame to wild: a share of the numbers has arbitrary bits.
        let mut number = |tame: f64| {
            let bits = next();
            match bits % 16 {
                0 if round % 3 == 0 => {
                    let x = f64::from_bits(next());
                    if x.is_finite() { x } else { tame }
                }
                1..=3 if round % 3 > 0 => special[(bits >> 8) as usize % special.len()],
                _ => tame * ((bits >> 11) as f64 / (1u64 << 52) as f64 - 1.0),
            }
        };
        let mut vector = |tame: f64| DVec3::new(number(tame), number(tame), number(tame));
        let meshes: Vec<_> = (0..2)
            .map(|_| {
                let v: Vec<DVec3> = (0..5).map(|_| vector(1.0)).collect();
                TriMesh::try_new(v, vec![[0, 1, 2], [2, 1, 3], [0, 3, 4]])
            })
            .collect();
        let motions: Vec<_> = (0..2)
            .map(|_| {
                let (q, w) = (vector(1.0), vector(1.0));
                let q = DQuat::from_xyzw(q.x, q.y, q.z, w.x);
                ConstantTwist::try_new(vector(2.0), q, vector(4.0), vector(3.0))
            })
            .collect();
        let ends = vector(1.0);
        let Ok(window) = Window::try_new(ends.x.min(ends.y), ends.x.max(ends.y)) else { continue };
        let ([Ok(a), Ok(b)], [Ok(m), Ok(n)]) = (&meshes[..], &motions[..]) else { continue };
        let trees = [a, b].map(|t| SphereTree::new(t.clone()));
        let options = QueryOptions::DEFAULT
            .with_solid(Solid::Surface)
            .with_budget(Budget::UNLIMITED.with_node_tests(3000));
        let started = std::time::Instant::now();
        match time_of_contact(Moving::new(&trees[0], m), Moving::new(&trees[1], n), window, &options) {
            Ok(TimeOfContact::Undecided { clear_until }) => assert!(window.contains(clear_until), "{round}"),
            Ok(TimeOfContact::Contact(c)) => assert!(window.contains(c.time_lo), "{round}: {c:?}"),
            Ok(TimeOfContact::Separated) => {}
            Err(_) => refused += 1,
        }
        answered += 1;
        wild = wild.max(started.elapsed().as_secs_f64());
    }
    println!("{answered} answered, {refused} refused, slowest {wild:.3} s");
    assert!(answered > 500, "{answered}");
    assert!(wild < 60.0, "{wild}");
}

/// Two surfaces that coincide: every triangle touches, none crosses, and the answer takes no time. That they part is not looked
/// for among so many pairs.
#[test]
fn coincident_surfaces_are_answered_at_once() {
    let n = 96;
    let v =
        (0..=n).flat_map(|i| (0..=n).map(move |j| glam::dvec3(f64::from(i), f64::from(j), 0.0))).collect();
    let at = |i: i32, j: i32| (i * (n + 1) + j) as u32;
    let cell =
        |i, j| [[at(i, j), at(i + 1, j), at(i, j + 1)], [at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]];
    let t = (0..n).flat_map(|i| (0..n).flat_map(move |j| cell(i, j))).collect();
    let tree = SphereTree::new(d2m_bvh::TriMesh::try_new(v, t).unwrap());
    let rest = d2m_motion::ConstantTwist::REST;
    let body = Moving::new(&tree, &rest);
    let started = std::time::Instant::now();
    let options = QueryOptions::DEFAULT.with_solid(Solid::Surface);
    let answer = time_of_contact(body, body, Window::UNIT, &options).unwrap();
    assert_eq!(answer.contact().map(|c| c.start), Some(StartState::Undecided));
    assert!(started.elapsed().as_secs_f64() < 5.0);
}

/// A small body inside of another one, nearer to its wall than the tolerance, is held, as the default engine says; as surfaces they touch,
/// or nothing is said of how they meet.
#[test]
fn a_body_near_the_wall_of_the_other_is_held() {
    let cube = |half| SphereTree::new(Surface::cube(half).into_mesh(TriMesh::try_new));
    let (large, small) = (cube(0.5), cube(0.05));
    let rest = ConstantTwist::REST;
    for gap in [0.2, 0.04, 1e-9] {
        let place = rest.with_position(DVec3::new(0.45 - gap, 0.1, -0.2));
        let options = QueryOptions::DEFAULT.with_tolerance(0.05);
        for [a, b] in [[(&large, &rest), (&small, &place)], [(&small, &place), (&large, &rest)]] {
            let [a, b] = [a, b].map(|(body, motion)| Moving::new(body, motion));
            let start = |options: &QueryOptions| {
                time_of_contact(a, b, Window::UNIT, options).unwrap().contact().map(|found| found.start)
            };
            assert_eq!(start(&options), Some(StartState::Contained), "{gap}");
            let as_surfaces = start(&options.with_solid(Solid::Surface));
            let is_near = gap < 0.05;
            assert_eq!(as_surfaces.is_some(), is_near, "{gap}");
            assert_ne!(as_surfaces, Some(StartState::Overlapping), "{gap}");
        }
    }
}
