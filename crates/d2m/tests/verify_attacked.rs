//! Lies that were proven: found by an adversary. Each is an edit of an honest answer, which is proven.
#![cfg(feature = "verify")]

use d2m::bvh::{ClearanceStatus, TimeBracket};
use d2m::verify::{Verdict, Verifier};
use d2m::{
    Arm, Budget, Chain, Clearance, ClearanceOptions, ConstantTwist, Contact, ContactSpan, Departure, Joint,
    JointKind, JointValue, Keyframes, MeshTree, Moving, Pose, QueryOptions, RigidMotion, Span, SpanStatus,
    StartState, TimeOfContact, TriMesh, Window, clearance, contact_spans, departure, time_of_contact,
};
use glam::{DAffine3, DQuat, DVec3};

const STEPS: u64 = 1 << 20;

fn tetrahedron() -> MeshTree {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    MeshTree::new(TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap())
}

fn along_x(from: f64, speed: f64) -> ConstantTwist {
    ConstantTwist::REST.with_position(DVec3::X * from).with_linear_velocity(DVec3::X * speed)
}

struct Pair<'a> {
    tree: &'a MeshTree,
    motion: &'a dyn RigidMotion,
}

impl Pair<'_> {
    fn bodies(&self) -> [Moving<'_>; 2] {
        [Moving::new(self.tree, &ConstantTwist::REST), Moving::new(self.tree, self.motion)]
    }

    fn verifier(&self) -> Verifier {
        Verifier::try_new(self.tree.mesh(), self.tree.mesh()).unwrap()
    }

    fn is_proven(&self, spans: &[ContactSpan]) -> bool {
        let options = QueryOptions::default();
        let verdict =
            self.verifier().contact_spans(&self.bodies(), Window::UNIT, &options, None, spans, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    }

    fn spans(&self) -> Vec<ContactSpan> {
        let [a, b] = self.bodies();
        contact_spans(a, b, Window::UNIT, &QueryOptions::default(), None).unwrap()
    }

    fn clearance(&self) -> Clearance {
        let [a, b] = self.bodies();
        clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap()
    }

    /// Of an answer whose accuracy nobody asked for.
    fn is_clearance(&self, answer: &Clearance) -> bool {
        let options = ClearanceOptions::default().with_accuracy(f64::INFINITY);
        let verdict = self.verifier().clearance(&self.bodies(), Window::UNIT, &options, answer, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    }
}

/// A span of contact holds to the tolerance that it states, and that is no more than rounding needs.
#[test]
fn a_span_of_contact_is_proven_to_its_tolerance() {
    let tree = tetrahedron();
    let through = along_x(-3.0, 6.0).with_position(DVec3::new(-3.0, -0.1, -0.05));
    let pair = Pair { tree: &tree, motion: &through };
    let [a, b] = pair.bodies();
    let options = QueryOptions::default();
    let honest = pair.spans();
    let is_proven = |spans: &[ContactSpan]| {
        let verdict = pair.verifier().contact_spans(&[a, b], Window::UNIT, &options, None, spans, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    };
    assert!(honest[1].status == SpanStatus::Contact && honest[1].tolerance < 1e-9, "{honest:?}");
    assert!(is_proven(&honest), "{honest:?}");
    for tolerance in [1e-6, 1.0, f64::INFINITY, f64::NAN, -1.0] {
        let mut lie = honest.clone();
        lie[1] = lie[1].with_tolerance(tolerance);
        assert!(!is_proven(&lie), "{lie:?}");
    }
}

/// Bodies that part, meet again and part: that they only left at last, in a narrow bracket or a wide one, or never, passes over a contact.
#[test]
fn a_meeting_before_bodies_have_left_is_not_passed_over() {
    let tree = tetrahedron();
    let options = QueryOptions::default();
    let aside = DVec3::new(0.0, -0.1, -0.05);
    let at = |time: f64, x: f64| (time, Pose { translation: aside + DVec3::X * x, ..Pose::IDENTITY });
    // In contact up to x = 1.
    let swings = [at(0.0, 0.5), at(0.25, 1.5), at(0.5, 0.5), at(0.75, 1.5), at(1.0, 0.5)];
    let swings = Keyframes::try_new(&swings, Span::Linear).unwrap();
    let pair = Pair { tree: &tree, motion: &swings };
    let [a, b] = pair.bodies();
    let is_proven = |window: Window, answer: &Departure| {
        let verdict = pair.verifier().departure(&[a, b], window, &options, answer, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    };
    let all = |to: f64| Window::try_new(0.0, to).unwrap();
    let window = all(0.7);
    let honest = departure(a, b, window, &options).unwrap();
    let again = departure(a, b, Window::try_new(0.5, 0.7).unwrap(), &options).unwrap();
    let (first, last) = (honest.left.unwrap(), again.left.unwrap());
    assert!(is_proven(window, &honest) && first.hi < 0.13 && honest.answer.contact().is_some(), "{honest:?}");
    for lo in [last.lo, first.lo, 0.0] {
        let mut lie = again;
        (lie.start, lie.left) = (honest.start, Some(TimeBracket { lo, hi: last.hi }));
        assert!(lie.answer.is_separated() && !is_proven(window, &lie), "{lie:?}");
    }
    // They are in contact at the start and at the end, and not between.
    let mut never = honest;
    (never.left, never.answer) = (None, time_of_contact(a, b, all(0.5), &options).unwrap());
    assert!(!is_proven(all(0.5), &never), "{never:?}");
    // What stays all the time is proven to.
    let stays = departure(a, b, all(0.1), &options).unwrap();
    assert!(stays.left.is_none() && is_proven(all(0.1), &stays), "{stays:?}");
}

/// Bodies that part for a moment, at no round time: a claim that they are in contact all the time.
#[test]
fn a_moment_in_which_bodies_are_clear_is_found_in_a_long_span_of_contact() {
    let tree = tetrahedron();
    // The tip at x = 1 comes out of the other one's face at x = 0 by 2e-4, and goes in again.
    let aside = DVec3::new(0.0, -0.1, -0.05);
    let at = |time: f64, x: f64| (time, Pose { translation: aside + DVec3::X * x, ..Pose::IDENTITY });
    let (middle, gap) = (0.4987, 2e-4);
    let ends = [at(0.0, 1.0 + gap - middle), at(middle, 1.0 + gap), at(1.0, gap + middle)];
    let bounces = Keyframes::try_new(&ends, Span::Linear).unwrap();
    let pair = Pair { tree: &tree, motion: &bounces };
    let spans = pair.spans();
    assert_eq!(spans.len(), 3, "{spans:?}");
    assert!(spans[1].status == SpanStatus::Clear && pair.is_proven(&spans));
    let mut all = spans[0];
    all.to = spans[2].to;
    assert!(!pair.is_proven(&[all]));
}

#[test]
fn spans_of_contact_in_which_bodies_are_clear_are_not_proven() {
    let tree = tetrahedron();
    // To the side, so that no faces stay in one plane.
    let aside = DVec3::new(3.0, 0.1, 0.05);
    let (apart, through) = (along_x(5.0, 1.0), along_x(3.0, -6.0).with_position(aside));
    let [apart, through] = [&apart, &through].map(|motion| Pair { tree: &tree, motion });
    let (clear, met) = (apart.spans(), through.spans());
    assert!(apart.is_proven(&clear) && through.is_proven(&met));
    let [first, second, third] = met.as_slice() else { panic!("{met:?}") };
    assert_eq!(second.status, SpanStatus::Contact);
    let contact = |from: f64, to: f64| {
        let mut span = *second;
        (span.from, span.to) = (from, to);
        span
    };
    assert!(!apart.is_proven(&[contact(0.0, 1.0)]));
    for lie in
        [vec![contact(0.0, 1.0)], vec![*first, contact(first.to, 1.0)], vec![contact(0.0, second.to), *third]]
    {
        assert!(!through.is_proven(&lie), "{lie:?}");
    }
}

#[test]
fn contact_before_bodies_meet_and_of_bodies_that_never_do_is_not_proven() {
    let tree = tetrahedron();
    let (apart, through) = (along_x(5.0, 1.0), along_x(3.0, -6.0));
    let [apart, through] = [&apart, &through].map(|motion| Pair { tree: &tree, motion });
    let honest = apart.clearance();
    assert!(apart.is_clearance(&honest) && honest.upper > 3.0);
    let mut lie = honest;
    lie.status = ClearanceStatus::Contact;
    assert!(!apart.is_clearance(&lie));
    lie.lower = 0.0;
    assert!(!apart.is_clearance(&lie));
    // True bounds, and yet not those of its points.
    let mut lie = honest;
    lie.upper = 100.0;
    assert!(!apart.is_clearance(&lie));
    let honest = through.clearance();
    assert!(through.is_clearance(&honest) && honest.status == ClearanceStatus::Contact, "{honest:?}");
    for time in [0.0, 0.125, 0.25] {
        // The triangles meet later.
        let mut lie = honest;
        (lie.time, lie.lower, lie.upper) = (time, 0.0, 0.0);
        assert!(!through.is_clearance(&lie), "{time}");
    }
}

/// The contact of two such bodies at the start, of which the honest answer is proven, and whether an edited one is.
fn is_start_proven(
    tree: &MeshTree,
    motions: [&dyn RigidMotion; 2],
    least: f64,
    edit: impl Fn(&mut Contact),
) -> (StartState, bool) {
    let bodies = motions.map(|motion| Moving::new(tree, motion));
    let options = QueryOptions::default().with_min_separation(least);
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let is_proven = |answer: &TimeOfContact| {
        let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, answer, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    };
    let answer = time_of_contact(bodies[0], bodies[1], Window::UNIT, &options).unwrap();
    let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, &answer, STEPS);
    assert!(is_proven(&answer), "{answer:?} {verdict:?}");
    let mut contact = *answer.contact().unwrap();
    let start = contact.start;
    edit(&mut contact);
    (start, is_proven(&TimeOfContact::Contact(contact)))
}

/// Bodies that overlap by half were proven to touch, along any normal, and bodies 0.1 apart to overlap.
#[test]
fn the_word_of_a_start_is_proven() {
    use StartState::{Overlapping, Touching};
    let cube = MeshTree::new(d2m::shapes::mesh("box?x=1&y=1&z=1").unwrap());
    let at = |x: f64| along_x(x, 0.0);
    let says = |x: f64, least: f64, word: StartState| {
        is_start_proven(&cube, [&at(0.0), &at(x)], least, |contact| {
            contact.start = word;
            if word == Overlapping {
                contact.separation = 0.0;
            }
        })
    };
    for (x, least, honest) in
        [(1.5, 0.0, Overlapping), (1.5, 0.2, Overlapping), (2.0, 0.0, Touching), (2.1, 0.2, Touching)]
    {
        assert_eq!(says(x, least, honest), (honest, true), "{x}");
    }
    assert_eq!(says(2.05, 0.2, Overlapping), (Touching, false));
    assert_eq!(says(2.0, 0.0, Overlapping), (Touching, false));
    assert_eq!(says(1.5, 0.0, Touching), (Overlapping, false));
    assert_eq!(says(1.5, 0.2, Touching), (Overlapping, false));
    assert_eq!(says(2.1, 0.2, Overlapping), (Touching, false));
    // They do meet, but later.
    let falling = along_x(2.1, -1.0);
    let later = is_start_proven(&cube, [&ConstantTwist::REST, &falling], 0.2, |contact| {
        (contact.start, contact.separation, contact.time_hi) = (Overlapping, 0.0, 0.5);
    });
    assert_eq!(later, (Touching, false));
}

/// The normal is a direction of the world, also where links of one arm are seen from the joint that they share.
#[test]
fn links_of_a_turned_arm_part_along_the_normal() {
    let cube = MeshTree::new(d2m::shapes::mesh("box?x=1&y=1&z=1").unwrap());
    let slide = |at: f64| JointKind::Prismatic {
        axis: DVec3::X,
        value: JointValue::try_polynomial(vec![at, -0.1]).unwrap(),
    };
    let turned = DQuat::from_rotation_z(core::f64::consts::FRAC_PI_2);
    let mut arm = Arm::default();
    let base = arm.add("base", None, Joint::try_new(DVec3::Y, turned, JointKind::Fixed).unwrap()).unwrap();
    for (name, at) in [("left", 0.0), ("right", 2.0)] {
        let joint = Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, slide(at)).unwrap();
        arm.add(name, Some(base), joint).unwrap();
    }
    let links = arm.links().unwrap();
    let proven = is_start_proven(&cube, [&links[1], &links[2]], 0.0, |contact| {
        assert!((contact.normal - DVec3::Y).length() < 1e-9, "{}", contact.normal);
    });
    assert_eq!(proven, (StartState::Touching, true));
    let turned_away =
        is_start_proven(&cube, [&links[1], &links[2]], 0.0, |contact| contact.normal = DVec3::X);
    assert!(!turned_away.1);
}

/// Honest words of starts at places where cubes meet by faces, edges and corners, turned and far away, as deep as 2⁻²⁰ and not at all:
/// a point inside of both is found wherever there is one, and no other word is proven.
#[test]
fn cubes_that_overlap_do_not_touch() {
    use StartState::{Overlapping, Touching};
    let cube = MeshTree::new(d2m::shapes::mesh("box?x=1&y=1&z=1").unwrap());
    let turns = [DQuat::IDENTITY, DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5), DQuat::from_rotation_z(0.7)];
    for (number, turn) in turns.into_iter().enumerate() {
        for place in 0..27 {
            let offset = DVec3::from([place % 3, place / 3 % 3, place / 9].map(f64::from));
            for (deep, honest) in [(0.0, Touching), (1.0 / 1_048_576.0, Overlapping), (0.5, Overlapping)] {
                if offset.max_element() < 2.0 && deep < 0.5 {
                    continue;
                }
                let far = DVec3::new(16.0, -32.0, 8.0) * number as f64;
                let at = |p: DVec3| ConstantTwist::REST.with_position(turn * p + far).with_orientation(turn);
                let moved = offset.map(|x| if x == 2.0 { x - deep } else { x });
                let motions: [ConstantTwist; 2] = [at(DVec3::ZERO), at(moved)];
                let lie = if honest == Touching { Overlapping } else { Touching };
                for (word, is_proven) in [(honest, true), (lie, false)] {
                    let edited = is_start_proven(&cube, [&motions[0], &motions[1]], 0.0, |contact| {
                        contact.start = word;
                        if word == Overlapping {
                            contact.separation = 0.0;
                        }
                    });
                    if edited.0 != StartState::Undecided {
                        assert_eq!(edited, (honest, is_proven), "{turn} {moved}");
                    }
                }
            }
        }
    }
}

/// A budget that ends a clearance where the bodies meet: they do at that time, which need not be the first one.
#[test]
fn a_clearance_that_a_budget_ends_claims_no_first_time() {
    let (tree, passing) = (tetrahedron(), along_x(-2.0, 4.0));
    let pair = Pair { tree: &tree, motion: &passing };
    let [a, b] = pair.bodies().map(|body| body.with_radius(0.1));
    let mut within = 0;
    for tests in 0..200 {
        let options = ClearanceOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(tests));
        let answer = clearance(a, b, Window::UNIT, &options).unwrap();
        let verdict = pair.verifier().clearance(&[a, b], Window::UNIT, &options, &answer, STEPS);
        assert!(!matches!(verdict, Verdict::Refuted { .. }), "{tests}: {answer:?} {verdict:?}");
        let is_later = answer.upper == 0.0 && answer.time > 0.3;
        within += usize::from(is_later && answer.status == ClearanceStatus::Undecided);
    }
    assert!(within > 0);
}

/// A link of an arm whose mesh lies far from the origin of its frame: what its enclosures leave open at one time raises the tolerance of
/// an answer, also of those that do not say it.
#[test]
fn a_tolerance_that_enclosures_raise_refutes_no_answer() {
    // What follows is refuted soon or not at all.
    const FEW: u64 = 1 << 12;
    let near = tetrahedron();
    let mut raised = 0;
    for (index, far) in [3e2, 1e3, 3e3].into_iter().enumerate() {
        let tree = near.mesh().clone().transformed(&DAffine3::from_translation(DVec3::X * far)).unwrap();
        let tree = MeshTree::new(tree);
        let value = |from: f64, rate: f64| JointValue::try_polynomial(vec![from, rate]).unwrap();
        let turn = |axis: DVec3, rate: f64| JointKind::Revolute { axis, value: value(0.1, rate) };
        let part = index as f64 * 0.1;
        let joint =
            |at: DVec3, kind: JointKind| Joint::try_new(at, DQuat::from_rotation_y(part), kind).unwrap();
        let link = Chain::try_new(vec![
            joint(DVec3::X * 0.1, JointKind::Prismatic { axis: DVec3::Y, value: value(-2.0, 4.0) }),
            joint(DVec3::ZERO, turn(DVec3::Z, 1.0)),
            joint(DVec3::ZERO, turn(DVec3::new(1.0, 0.3, 0.2), 1.5)),
            joint(DVec3::ZERO, turn(DVec3::Y, 0.7)),
            Joint::try_new(-DVec3::X * far, DQuat::IDENTITY, JointKind::Fixed).unwrap(),
        ])
        .unwrap();
        let bodies = [Moving::new(&near, &ConstantTwist::REST), Moving::new(&tree, &link)];
        let [a, b] = bodies;
        let (verifier, options) =
            (Verifier::try_new(near.mesh(), tree.mesh()).unwrap(), QueryOptions::default());
        let found = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        raised += usize::from(found.contact().is_some_and(|contact| contact.tolerance > 3e-10));
        let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
        let verdict = verifier.contact_spans(&bodies, Window::UNIT, &options, None, &spans, FEW);
        assert!(!matches!(verdict, Verdict::Refuted { .. }), "{far}: {spans:?} {verdict:?}");
        for from in [0.45, 0.5, 0.55] {
            let window = Window::try_new(from, 1.0).unwrap();
            let answer = departure(a, b, window, &options).unwrap();
            let verdict = verifier.departure(&bodies, window, &options, &answer, FEW);
            assert!(!matches!(verdict, Verdict::Refuted { .. }), "{far} {from}: {answer:?} {verdict:?}");
        }
    }
    assert!(raised > 0);
}

/// Bodies that begin apart, or one in the other: an answer that lets go of what they meet later, or of what they touch, is none.
#[test]
fn only_what_is_in_contact_at_the_start_leaves() {
    let tree = tetrahedron();
    let options = QueryOptions::default();
    let (passing, parting) = (along_x(-3.0, 6.0), along_x(0.5, 6.0));
    for motion in [&passing, &parting] {
        let pair = Pair { tree: &tree, motion };
        let [a, b] = pair.bodies();
        let is_proven = |answer: &Departure| {
            let verdict = pair.verifier().departure(&[a, b], Window::UNIT, &options, answer, STEPS);
            matches!(verdict, Verdict::Verified { .. })
        };
        let honest = departure(a, b, Window::UNIT, &options).unwrap();
        assert!(is_proven(&honest), "{honest:?}");
        let begins_apart = honest.start == StartState::Apart;
        assert_eq!(begins_apart, honest.answer.contact().is_some(), "{honest:?}");
        for [lo, hi] in [[0.9, 0.9], [0.0, 0.9], [0.0, 0.0]] {
            let mut lie = honest;
            (lie.start, lie.answer) = (StartState::Apart, TimeOfContact::Separated);
            lie.left = Some(TimeBracket { lo, hi });
            assert!(!is_proven(&lie), "{lie:?}");
        }
        // The contact at the start, of bodies that are said to begin apart.
        let mut apart = honest;
        (apart.start, apart.left) = (StartState::Apart, Some(TimeBracket { lo: 0.0, hi: 0.0 }));
        apart.answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        assert_eq!(is_proven(&apart), begins_apart, "{apart:?}");
        let mut held = honest;
        held.start = StartState::Contained;
        assert!(!is_proven(&held), "{held:?}");
    }
}
