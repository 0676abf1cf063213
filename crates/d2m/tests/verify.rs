//! The engine's answers proven again, and lies that are not.
#![cfg(feature = "verify")]

use d2m::bvh::{Evidence, StartState};
use d2m::glam::{DQuat, DVec3};
use d2m::interval::{Interval, IntervalVec3};
use d2m::motion::{IntervalPose, IntervalTwist};
use d2m::paper::{self, SphereTree};
use d2m::verify::{Reason, Verdict, Verifier};
use d2m::{
    Budget, ClearanceOptions, Composed, ConstantTwist, Contact, Keyframes, MeshTree, Mode, Moving, Pose,
    QueryOptions, RigidMotion, Solid, Span, SpanStatus, TimeOfContact, TriMesh, Twist, Window, clearance,
    contact_spans, departure, time_of_contact,
};
use d2m_testing::{Draw, KnuthRandom, SmallScene, Surface};

const STEPS: u64 = 100_000;

fn mesh(surface: &Surface) -> TriMesh {
    surface.clone().into_mesh(TriMesh::try_new)
}

/// A scene with the engine's answer.
struct Answered {
    scene: SmallScene,
    trees: [MeshTree; 2],
    verifier: Verifier,
    window: Window,
    options: QueryOptions,
    answer: TimeOfContact,
}

impl Answered {
    fn draw(index: u64) -> Self {
        let scene = SmallScene::draw(7, index, |surface| MeshTree::new(mesh(surface)).is_watertight());
        let trees = [0, 1].map(|k| MeshTree::new(mesh(&scene.surfaces[k])));
        let verifier = Verifier::try_new(trees[0].mesh(), trees[1].mesh()).unwrap();
        let window = Window::try_new(scene.window[0], scene.window[1]).unwrap();
        let mode = if index % 4 == 3 { Mode::Capoeira } else { Mode::Accurate };
        let separation = if index % 3 == 2 { 0.0625 } else { 0.0 };
        let solid = if scene.filled { Solid::Filled } else { Solid::Surface };
        let options =
            QueryOptions::default().with_mode(mode).with_min_separation(separation).with_solid(solid);
        let bodies = [0, 1].map(|k| Moving::new(&trees[k], &scene.motions[k]));
        let answer = time_of_contact(bodies[0], bodies[1], window, &options).unwrap();
        Self { scene, trees, verifier, window, options, answer }
    }

    fn verdict(&self, answer: &TimeOfContact) -> Verdict {
        let bodies = [0, 1].map(|k| Moving::new(&self.trees[k], &self.scene.motions[k]));
        self.verifier.time_of_contact(&bodies, self.window, &self.options, answer, STEPS)
    }
}

const SCENES: u64 = 1500;

/// Hard small scenes: grazing, coplanar sliding, needles, fast spin, contacts at either end.
#[test]
fn answers_of_hard_scenes_are_proven_again() {
    let (mut verified, mut open) = (0, Vec::new());
    for index in 0..SCENES {
        let answered = Answered::draw(index);
        match answered.verdict(&answered.answer) {
            Verdict::Verified { .. } => verified += 1,
            Verdict::Refuted { time, triangles, distance } => panic!(
                "{}: refuted at {time}, {triangles:?}, {distance}: {:?}",
                answered.scene.name, answered.answer
            ),
            Verdict::Unproven { reason, .. } => open.push((answered.scene.name, reason, answered.answer)),
        }
    }
    let show =
        |(name, reason, answer): &(String, Reason, TimeOfContact)| format!("{name}: {reason}: {answer:?}");
    let shown: Vec<String> = open.iter().map(show).collect();
    assert!(verified as f64 > 0.995 * SCENES as f64, "{verified}\n{}", shown.join("\n"));
}

/// Those of the paper's method, too, at the start of a window and later.
#[test]
fn answers_of_the_reference_method_are_proven_again() {
    let (mut asked, mut met, mut open) = (0, 0, Vec::new());
    for index in 0..SCENES / 4 {
        let mut answered = Answered::draw(index);
        answered.options = answered.options.with_min_separation(0.0);
        let spheres = answered.trees.each_ref().map(|tree| SphereTree::new(tree.mesh().clone()));
        let [a, b] = [0, 1].map(|k| paper::Moving::new(&spheres[k], &answered.scene.motions[k]));
        let answer = paper::time_of_contact(a, b, answered.window, &answered.options).unwrap();
        asked += 1;
        met += usize::from(answer.contact().is_some_and(|found| found.evidence != Evidence::Early));
        match answered.verdict(&answer) {
            Verdict::Verified { .. } => {}
            verdict @ Verdict::Refuted { .. } => {
                panic!("{}: {verdict:?}: {answer:?}", answered.scene.name)
            }
            Verdict::Unproven { reason, .. } => {
                open.push(format!("{}: {reason}: {answer:?}", answered.scene.name));
            }
        }
    }
    assert!(open.len() * 50 < asked && met > 100, "{met} of {asked}\n{}", open.join("\n"));
}

/// A time that is later, "separated" for a contact, another separation, other triangles, another tolerance, another start.
#[test]
fn lies_are_not_verified() {
    let mut random = KnuthRandom(5);
    let (mut lies, mut refuted) = (0, 0);
    for index in 0..SCENES {
        let answered = Answered::draw(index);
        let TimeOfContact::Contact(contact) = answered.answer else { continue };
        let mut claims = vec![("separated", TimeOfContact::Separated)];
        let mut edited = |name, edit: &dyn Fn(&mut Contact)| {
            let mut lie = contact;
            edit(&mut lie);
            claims.push((name, TimeOfContact::Contact(lie)));
        };
        let apart = contact.start == StartState::Apart;
        if apart {
            for exponent in [-9, -6, -3] {
                let later = contact.time_lo + 10f64.powi(exponent) * (1.0 + random.signed().abs());
                // Grazing so slowly that the bodies are as far apart then would be no lie.
                if contact.closing_speed * (later - contact.time_lo) > contact.tolerance {
                    edited("later", &|lie| (lie.time_lo, lie.time_hi) = (later, lie.time_hi.max(later)));
                }
            }
        }
        if contact.start != StartState::Contained {
            for factor in [0.5, 2.0] {
                let separation = contact.separation * factor + f64::from(u8::from(contact.separation == 0.0));
                edited("separation", &|lie| lie.separation = separation);
            }
            edited("wide", &|lie| lie.tolerance *= 1e3);
            let aside = contact.normal.any_orthonormal_vector() * 1e-3;
            // Where rounding hides the direction of the closest points, nothing is claimed of it.
            if contact.separation > 1e-3 {
                edited("normal", &|lie| lie.normal = (lie.normal + aside).normalize());
            }
            edited("point", &|lie| lie.point_a += lie.normal * 0.01);
        }
        if apart {
            edited("no such triangle", &|lie| lie.triangle_a = 1 << 20);
            edited("no number", &|lie| lie.time_lo = f64::NAN);
            edited("reversed", &|lie| lie.time_hi = lie.time_lo.next_down());
            edited("before", &|lie| lie.time_lo = answered.window.start() - 1.0);
        }
        for (name, lie) in claims {
            let verdict = answered.verdict(&lie);
            lies += 1;
            refuted += u32::from(matches!(verdict, Verdict::Refuted { .. }));
            let is_verified = matches!(verdict, Verdict::Verified { .. });
            // Not a lie: bodies that come within the tolerance of each other and share no point.
            let is_true = name == "separated" && contact.evidence < Evidence::Crossing;
            assert!(!is_verified || is_true, "{name}: {}: {lie:?} for {contact:?}", answered.scene.name);
        }
    }
    assert!(lies > 3000 && refuted > 1000, "{lies}, {refuted} refuted");
}

/// Clearances, spans and departures of the same scenes, with radii: proven again; edited they are not.
#[test]
fn other_questions_are_proven_again() {
    let (mut verified, mut all, mut lies) = (0, 0, 0);
    for index in 0..SCENES / 10 {
        let answered = Answered::draw(index);
        let radius = [0.0, 0.03][index as usize % 2];
        let body = |k: usize| Moving::new(&answered.trees[k], &answered.scene.motions[k]).with_radius(radius);
        let (bodies, window) = ([body(0), body(1)], answered.window);
        // Hard scenes stay in contact for long, which takes millions of tests: less is as good here.
        let budget = Budget::UNLIMITED.with_node_tests(10_000);
        let options = answered.options.with_mode(Mode::Accurate).with_budget(budget);
        let verifier = &answered.verifier;
        let mut judge = |name: &str, is_lie: bool, verdict: Verdict| {
            let is_verified = matches!(verdict, Verdict::Verified { .. });
            assert!(!(is_lie && is_verified), "{name}: {}", answered.scene.name);
            let is_refuted = matches!(verdict, Verdict::Refuted { .. });
            assert!(is_lie || !is_refuted, "{name}: {} {verdict:?}", answered.scene.name);
            all += u32::from(!is_lie);
            lies += u32::from(is_lie);
            verified += u32::from(is_verified);
        };
        let contact = time_of_contact(bodies[0], bodies[1], window, &options).unwrap();
        judge("contact", false, verifier.time_of_contact(&bodies, window, &options, &contact, STEPS));
        let wanted = ClearanceOptions::default().with_solid(options.solid).with_budget(budget);
        let found = clearance(bodies[0], bodies[1], window, &wanted).unwrap();
        judge("clearance", false, verifier.clearance(&bodies, window, &wanted, &found, STEPS));
        for part in [1e-3, 1e-2, 0.5] {
            let (mut high, mut low) = (found, found);
            high.lower = found.upper + part * (1.0 + found.upper);
            high.upper = high.lower;
            low.upper = found.lower - part * found.lower;
            low.lower = low.lower.min(low.upper);
            judge("too high", true, verifier.clearance(&bodies, window, &wanted, &high, STEPS));
            if found.lower > 1e-6 {
                judge("too low", true, verifier.clearance(&bodies, window, &wanted, &low, STEPS));
            }
        }
        // As near as at the start they are said to come at most: true there, and no lower bound over the window.
        let start = Window::try_new(window.start(), window.start()).unwrap();
        let there = clearance(bodies[0], bodies[1], start, &wanted).unwrap();
        if there.lower > found.upper + 1e-3 * (1.0 + found.upper) {
            judge("nearest at the start", true, verifier.clearance(&bodies, window, &wanted, &there, STEPS));
        }
        let spans = contact_spans(bodies[0], bodies[1], window, &options, None).unwrap();
        judge("spans", false, verifier.contact_spans(&bodies, window, &options, None, &spans, STEPS));
        for k in 1..spans.len() {
            let mut lie = spans.clone();
            let (met, clear) = match lie[k].status {
                SpanStatus::Contact => (lie[k], lie[k - 1]),
                _ => (lie[k - 1], lie[k]),
            };
            let is_long = met.to - met.from > 1e-3 * window.length();
            if !is_long || (met.status, clear.status) != (SpanStatus::Contact, SpanStatus::Clear) {
                continue;
            }
            let middle = 0.5 * (met.from + met.to);
            (lie[k - 1].to, lie[k].from) = (middle, middle);
            judge(
                "a clear span goes on",
                true,
                verifier.contact_spans(&bodies, window, &options, None, &lie, STEPS),
            );
        }
        let parted = departure(bodies[0], bodies[1], window, &options).unwrap();
        judge("departure", false, verifier.departure(&bodies, window, &options, &parted, STEPS));
        if let Some(left) = parted.left.filter(|left| left.hi > window.start()) {
            let mut lie = parted;
            lie.left.as_mut().unwrap().hi = left.lo;
            judge("parted too early", true, verifier.departure(&bodies, window, &options, &lie, STEPS));
        }
    }
    assert!(verified >= all - 1 && lies > 500, "{verified} of {all}, {lies} lies");
}

/// One cube falls onto another one, in units of time in which the square of its speed is no number, or none but zero: answers are proven as in
/// any other one, and no tolerance that nothing explains is accepted.
#[test]
fn answers_are_proven_in_any_unit_of_time() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    for second in [1e-290, 1e-200, 1.0, 1e200, 1e290] {
        let falling = ConstantTwist::REST
            .with_position(DVec3::new(0.25, 0.125, 2.0))
            .with_linear_velocity(DVec3::new(0.0, 0.125, -2.0) / second);
        let bodies = [&ConstantTwist::REST, &falling].map(|motion| Moving::new(&tree, motion));
        let (window, options) = (Window::try_new(0.0, second).unwrap(), QueryOptions::default());
        let [a, b] = bodies;
        let answer = time_of_contact(a, b, window, &options).unwrap();
        let wanted = ClearanceOptions::default();
        let nearest = clearance(a, b, window, &wanted).unwrap();
        let spans = contact_spans(a, b, window, &options, None).unwrap();
        let parted = departure(a, b, window, &options).unwrap();
        let verdicts = [
            verifier.time_of_contact(&bodies, window, &options, &answer, STEPS),
            verifier.clearance(&bodies, window, &wanted, &nearest, STEPS),
            verifier.contact_spans(&bodies, window, &options, None, &spans, STEPS),
            verifier.departure(&bodies, window, &options, &parted, STEPS),
        ];
        let are_verified = verdicts.iter().all(|verdict| matches!(verdict, Verdict::Verified { .. }));
        assert!(are_verified, "{second:e}: {verdicts:?}");
        let TimeOfContact::Contact(mut lie) = answer else { panic!("{answer:?}") };
        lie.tolerance = 0.5;
        let verdict =
            verifier.time_of_contact(&bodies, window, &options, &TimeOfContact::Contact(lie), STEPS);
        assert!(
            matches!(verdict, Verdict::Unproven { reason: Reason::Tolerance, .. }),
            "{second:e}: {verdict:?}"
        );
    }
}

/// What is held, what overlaps and leaves, and what touches, in units of length from 1e-120 to 1e57.
#[test]
fn answers_are_proven_in_any_unit_of_length() {
    for power in [-400, -180, 0, 190] {
        let unit = 2f64.powi(power);
        let [large, small] = [1.0, 0.25].map(|half| MeshTree::new(mesh(&Surface::cube(half * unit))));
        let verifier = Verifier::try_new(large.mesh(), small.mesh()).unwrap();
        for place in [0.5, 1.0, 1.25, 1.5, -2.0] {
            let leaving = ConstantTwist::REST
                .with_position(DVec3::new(place, 0.125, 0.0) * unit)
                .with_linear_velocity(DVec3::new(1.0, 0.0625, -0.25) * unit);
            let bodies = [Moving::new(&large, &ConstantTwist::REST), Moving::new(&small, &leaving)];
            let (window, options, [a, b]) = (Window::UNIT, QueryOptions::default(), bodies);
            let answer = time_of_contact(a, b, window, &options).unwrap();
            let parted = departure(a, b, window, &options).unwrap();
            let spans = contact_spans(a, b, window, &options, Some(0.01)).unwrap();
            let wanted = ClearanceOptions::default();
            let nearest = clearance(a, b, window, &wanted).unwrap();
            let verdicts = [
                verifier.time_of_contact(&bodies, window, &options, &answer, STEPS),
                verifier.departure(&bodies, window, &options, &parted, STEPS),
                verifier.contact_spans(&bodies, window, &options, Some(0.01), &spans, STEPS),
                verifier.clearance(&bodies, window, &wanted, &nearest, STEPS),
            ];
            let are_verified = verdicts.iter().all(|verdict| matches!(verdict, Verdict::Verified { .. }));
            assert!(are_verified, "{power} {place}: {verdicts:?} {answer:?} {parted:?}");
            let verdict =
                verifier.time_of_contact(&bodies, window, &options, &TimeOfContact::Separated, STEPS);
            assert_eq!(
                matches!(verdict, Verdict::Verified { .. }),
                place == 1.5,
                "{power} {place}: {verdict:?}"
            );
        }
    }
}

/// What moves in one frame is proven as seen from there, however fast the frame turns.
#[test]
fn what_moves_in_one_frame_is_proven_in_few_steps() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let spin = ConstantTwist::REST.with_angular_velocity(DVec3::new(200.0, -70.0, 300.0));
    let coming = ConstantTwist::REST
        .with_position(DVec3::new(3.0, 0.25, 0.125))
        .with_linear_velocity(DVec3::new(-3.0, 0.0, 0.0))
        .with_angular_velocity(DVec3::Z * 0.5);
    let motions = [Composed::new(spin, ConstantTwist::REST), Composed::new(spin, coming)];
    let bodies = [&motions[0], &motions[1]].map(|motion| Moving::new(&tree, motion));
    let ([a, b], options) = (bodies, QueryOptions::default());
    let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
    assert!(answer.contact().is_some(), "{answer:?}");
    let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, &answer, 1 << 10);
    assert!(matches!(verdict, Verdict::Verified { .. }), "{answer:?} {verdict:?}");
    let verdict =
        verifier.time_of_contact(&bodies, Window::UNIT, &options, &TimeOfContact::Separated, 1 << 10);
    assert!(matches!(verdict, Verdict::Refuted { .. }), "{verdict:?}");
    // The same in two frames: at rest, and coming.
    let motions = [Composed::new(ConstantTwist::REST, spin), Composed::new(coming, spin)];
    let bodies = [&motions[0], &motions[1]].map(|motion| Moving::new(&tree, motion));
    let early = Window::try_new(0.0, 0.01).unwrap();
    let apart = TimeOfContact::Separated;
    let verdict = verifier.time_of_contact(&bodies, early, &options, &apart, STEPS);
    assert!(matches!(verdict, Verdict::Verified { .. }), "{verdict:?}");
}

/// At the end of a long way plain numbers place a body worse than its own ones do, of which the points of answers are.
#[test]
fn points_at_the_end_of_a_long_way_are_those_of_the_triangles() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let mut random = KnuthRandom(3);
    for round in 0..60 {
        let far = random.direction() * 10f64.powf(2.0 + 8.0 * random.unit());
        let place = random.direction() * 2.5;
        let pose = |translation, rotation| Pose { translation, rotation, at: DVec3::ZERO };
        let keys = [
            (0.0, pose(place + far, random.moderate_turn().normalize())),
            (0.7, pose(place, random.moderate_turn().normalize())),
        ];
        let coming = Keyframes::try_new(&keys, Span::Linear).unwrap();
        let bodies =
            [&ConstantTwist::REST as &dyn RigidMotion, &coming].map(|motion| Moving::new(&tree, motion));
        let ([a, b], wanted) = (bodies, ClearanceOptions::default());
        let now = Window::try_new(0.7, 0.7).unwrap();
        let mut answer = clearance(a, b, now, &wanted).unwrap();
        let verdict = verifier.clearance(&bodies, now, &wanted, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{round}: {answer:?} {verdict:?}");
        answer.point_b += DVec3::splat(1e-3);
        let verdict = verifier.clearance(&bodies, now, &wanted, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Unproven { reason: Reason::Witness, .. }), "{round}: {verdict:?}");
    }
}

/// Squares of lengths below 1e-162 are no numbers: the points of rounded bodies were those of their meshes there, and their normal was none.
#[test]
fn rounded_bodies_have_their_points_in_any_unit_of_length() {
    for power in [-900, -700, -520, 0, 180] {
        let unit = 2f64.powi(power);
        let tree = MeshTree::new(mesh(&Surface::cube(0.5 * unit)));
        let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
        let passing = ConstantTwist::REST
            .with_position(DVec3::new(1.5, 1.25, 0.0) * unit)
            .with_linear_velocity(DVec3::new(-1.0, 0.0, 0.25) * unit);
        let bodies = [&ConstantTwist::REST, &passing]
            .map(|motion| Moving::new(&tree, motion).with_radius(0.0625 * unit));
        let (wanted, [a, b]) = (ClearanceOptions::default(), bodies);
        let answer = clearance(a, b, Window::UNIT, &wanted).unwrap();
        let verdict = verifier.clearance(&bodies, Window::UNIT, &wanted, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{power}: {answer:?} {verdict:?}");
        assert!((answer.normal - DVec3::Y).length() < 1e-9, "{power}: {}", answer.normal);
        assert!((answer.point_a.y / unit - 0.5625).abs() < 1e-9, "{power}: {}", answer.point_a);
    }
}

/// What is held a little further from a wall than the tolerance, and slides along it while both turn: its least distance is none from the start on.
#[test]
fn what_slides_along_a_wall_inside_is_proven_to_be_held() {
    let [large, small] = [1.0, 0.125].map(|half| MeshTree::new(mesh(&Surface::cube(half))));
    let verifier = Verifier::try_new(large.mesh(), small.mesh()).unwrap();
    let spin = ConstantTwist::REST.with_angular_velocity(DVec3::new(0.5, 1.0, -2.0));
    let outer = Composed::new(spin, ConstantTwist::REST);
    let inner = ConstantTwist::REST.with_linear_velocity(DVec3::Y * 0.5);
    let inner = Composed::new(spin, inner.with_position(DVec3::new(0.25, -0.25, 0.875 - 2.2e-10)));
    let bodies = [Moving::new(&large, &outer), Moving::new(&small, &inner)];
    let wanted = ClearanceOptions::default();
    let answer = clearance(bodies[0], bodies[1], Window::UNIT, &wanted).unwrap();
    assert_eq!((answer.lower, answer.upper, answer.time), (0.0, 0.0, 0.0), "{answer:?}");
    let verdict = verifier.clearance(&bodies, Window::UNIT, &wanted, &answer, 1 << 16);
    assert!(matches!(verdict, Verdict::Verified { .. }), "{answer:?} {verdict:?}");
}

/// Of bodies a millionth of their size apart the closest points, which are rounded, say their direction to a billionth only: that is no fault of an answer.
#[test]
fn normals_of_close_bodies_are_as_exact_as_their_points() {
    let [large, small] = [1.0, 0.25].map(|half| MeshTree::new(mesh(&Surface::cube(half))));
    let verifier = Verifier::try_new(large.mesh(), small.mesh()).unwrap();
    let mut random = KnuthRandom(7);
    for round in 0..60 {
        let turn = DQuat::from_scaled_axis(random.vector() * 2.0);
        let gap = [1e-6, 3e-7, 1e-7][round % 3];
        let place = turn * DVec3::new(1.25 + gap, 0.8 * random.signed(), 0.8 * random.signed());
        let [at_a, at_b] =
            [DVec3::ZERO, place].map(|place| ConstantTwist::REST.with_position(place).with_orientation(turn));
        let bodies = [Moving::new(&large, &at_a), Moving::new(&small, &at_b)];
        let wanted = ClearanceOptions::default().with_accuracy(1e-2);
        let mut answer = clearance(bodies[0], bodies[1], Window::UNIT, &wanted).unwrap();
        let verdict = verifier.clearance(&bodies, Window::UNIT, &wanted, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{round}: {answer:?} {verdict:?}");
        answer.normal = (answer.normal + 0.1 * answer.normal.any_orthonormal_vector()).normalize();
        let verdict = verifier.clearance(&bodies, Window::UNIT, &wanted, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Unproven { reason: Reason::Witness, .. }), "{round}: {verdict:?}");
    }
}

/// Of a budget that ended the search of the start nothing is claimed, and so nothing is refuted, however the bodies stand.
#[test]
fn a_departure_whose_start_was_not_searched_claims_nothing() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(0));
    for (from, speed) in [(3.0, -1.0), (0.5, 1.0), (0.25, 0.0)] {
        let motion =
            ConstantTwist::REST.with_position(DVec3::X * from).with_linear_velocity(DVec3::X * speed);
        let bodies = [&ConstantTwist::REST, &motion].map(|motion| Moving::new(&tree, motion));
        let [a, b] = bodies;
        let answer = departure(a, b, Window::UNIT, &options).unwrap();
        assert_eq!((answer.start, answer.left), (StartState::Undecided, None));
        let verdict = verifier.departure(&bodies, Window::UNIT, &options, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{from}: {answer:?} {verdict:?}");
        let mut lie = answer;
        lie.start = if from < 1.0 { StartState::Contained } else { StartState::Overlapping };
        let verdict = verifier.departure(&bodies, Window::UNIT, &options, &lie, STEPS);
        assert!(!matches!(verdict, Verdict::Verified { .. }), "{from}: {lie:?} {verdict:?}");
    }
}

/// Radii that are small against the tolerance: what adding both rounds up is no other tolerance.
#[test]
fn answers_of_bodies_with_small_radii_are_proven_again() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let falling = ConstantTwist::REST
        .with_position(DVec3::new(0.25, 0.125, 2.0))
        .with_linear_velocity(DVec3::new(0.0, 0.125, -2.0));
    for (radius, tolerance) in [(1e-13, 1e-6), (1e-16, 1e-3), (1e-5, 1e-5), (1e-3, 1e-3), (0.1, 1e-2)] {
        let bodies =
            [&ConstantTwist::REST, &falling].map(|motion| Moving::new(&tree, motion).with_radius(radius));
        let [a, b] = bodies;
        let (options, wanted) = (
            QueryOptions::default().with_tolerance(tolerance),
            ClearanceOptions::default().with_tolerance(tolerance),
        );
        let found = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let nearest = clearance(a, b, Window::UNIT, &wanted).unwrap();
        let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
        let verdicts = [
            verifier.time_of_contact(&bodies, Window::UNIT, &options, &found, STEPS),
            verifier.clearance(&bodies, Window::UNIT, &wanted, &nearest, STEPS),
            verifier.contact_spans(&bodies, Window::UNIT, &options, None, &spans, STEPS),
        ];
        let are_verified = verdicts.iter().all(|verdict| matches!(verdict, Verdict::Verified { .. }));
        assert!(are_verified, "{radius:e} {tolerance:e}: {verdicts:?}");
    }
}

/// A motion whose places are known up to a distance in each coordinate.
struct Vague(ConstantTwist, f64);

impl RigidMotion for Vague {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.0.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let (pose, off) = (self.0.enclose_pose(t), Interval::around(0.0, self.1));
        IntervalPose { translation: pose.translation + IntervalVec3::new(off, off, off), ..pose }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist_rate(t)
    }
}

/// Where rounding of poses hides more of a clearance's width than that, the width becomes the tolerance.
#[test]
fn a_width_that_rounding_hides_is_one_that_a_clearance_may_have() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let far = DVec3::new(1e6, -7e5, 3e5);
    let mut raised = 0;
    for (gap, off) in
        [(0.1, 1e-9), (0.12, 1e-9), (0.15, 1e-9), (0.2, 2e-9), (0.3, 3e-9), (0.35, 3e-9), (0.8, 1e-8)]
    {
        let still = Vague(ConstantTwist::REST.with_position(far), off);
        let turning = ConstantTwist::REST
            .with_position(far + DVec3::new(1.0 + gap, 0.1, 0.2))
            .with_angular_velocity(DVec3::new(0.03, 0.06, 0.09));
        let moved = Vague(turning, off);
        let bodies = [&still, &moved].map(|motion| Moving::new(&tree, motion));
        let [a, b] = bodies;
        let options = ClearanceOptions::default();
        let answer = clearance(a, b, Window::UNIT, &options).unwrap();
        raised += u32::from(answer.upper - answer.lower > 4.0 * options.accuracy * answer.upper);
        let verdict = verifier.clearance(&bodies, Window::UNIT, &options, &answer, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{gap}: {answer:?} {verdict:?}");
        let mut lie = answer;
        lie.tolerance = 1e-4;
        let verdict = verifier.clearance(&bodies, Window::UNIT, &options, &lie, STEPS);
        assert!(matches!(verdict, Verdict::Unproven { reason: Reason::Tolerance, .. }), "{gap}: {verdict:?}");
    }
    assert!(raised > 0);
}

/// Over some numbers for a time, and at a time from which the next number is further than any place: as over others.
#[test]
fn answers_are_proven_over_few_numbers_for_a_time() {
    let tree = MeshTree::new(mesh(&Surface::cube(0.5)));
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let windows = [(1.0, 1000.0), (-1e15, 6.0), (1e5, 100.0), (1e299, 1000.0), (1e299, 0.0), (0.0, 1000.0)];
    for (start, numbers) in windows {
        let start: f64 = start;
        let long = numbers * (start.abs().next_up() - start.abs());
        let speed = (2.0 / long).min(1e299);
        // At one time they are in each other.
        let height = if long > 0.0 { 1.5 } else { 0.75 };
        let falling = ConstantTwist::REST
            .with_position(DVec3::new(0.25, 0.125, height))
            .with_linear_velocity(DVec3::Z * -speed)
            .with_reference_time(start);
        let bodies = [&ConstantTwist::REST, &falling].map(|motion| Moving::new(&tree, motion));
        let (window, options) = (Window::try_new(start, start + long).unwrap(), QueryOptions::default());
        let [a, b] = bodies;
        let (wanted, found) = (ClearanceOptions::default(), time_of_contact(a, b, window, &options).unwrap());
        let nearest = clearance(a, b, window, &wanted).unwrap();
        let spans = contact_spans(a, b, window, &options, None).unwrap();
        let parted = departure(a, b, window, &options).unwrap();
        let verdicts = [
            verifier.time_of_contact(&bodies, window, &options, &found, STEPS),
            verifier.clearance(&bodies, window, &wanted, &nearest, STEPS),
            verifier.contact_spans(&bodies, window, &options, None, &spans, STEPS),
            verifier.departure(&bodies, window, &options, &parted, STEPS),
        ];
        let are_verified = verdicts.iter().all(|verdict| matches!(verdict, Verdict::Verified { .. }));
        assert!(are_verified, "{start:e} {numbers}: {verdicts:?}");
    }
}
