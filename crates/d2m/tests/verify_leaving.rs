//! Lies about starts, and about what stands beside a clearance, that were proven, and answers to `Start::Leave`, which were refuted: found
//! by an adversary. Each lie is an edit of an honest answer, which is proven.
#![cfg(feature = "verify")]

use d2m::bvh::{ClearanceStatus, TimeBracket};
use d2m::feature::FeaturePair;
use d2m::verify::{Reason, Verdict, Verifier};
use d2m::{
    Budget, Clearance, ClearanceOptions, ConstantTwist, Contact, ContactSpan, Departure, Evidence, Keyframes,
    MeshTree, Mode, Moving, Pose, QueryOptions, RigidMotion, Span, SpanStatus, Start, StartState,
    TimeOfContact, Window, clearance, contact_spans, departure, time_of_contact,
};
use d2m_testing::{Draw, KnuthRandom, Opaque};
use glam::DVec3;
use std::time::Duration;

const STEPS: u64 = 1 << 20;

fn cube(half: f64) -> MeshTree {
    MeshTree::new(d2m::shapes::mesh(&format!("box?x={half}&y={half}&z={half}")).unwrap())
}

fn along_x(from: f64, speed: f64) -> ConstantTwist {
    ConstantTwist::REST.with_position(DVec3::X * from).with_linear_velocity(DVec3::X * speed)
}

/// Two bodies, the first at rest, with what is proven of answers about them.
struct Pair<'a> {
    trees: [&'a MeshTree; 2],
    motion: &'a dyn RigidMotion,
    options: QueryOptions,
}

impl<'a> Pair<'a> {
    fn new(trees: [&'a MeshTree; 2], motion: &'a dyn RigidMotion) -> Self {
        Self { trees, motion, options: QueryOptions::default() }
    }

    fn bodies(&self) -> [Moving<'_>; 2] {
        let [a, b] = self.trees;
        [Moving::new(a, &ConstantTwist::REST), Moving::new(b, self.motion)]
    }

    fn verifier(&self) -> Verifier {
        let [a, b] = self.trees;
        Verifier::try_new(a.mesh(), b.mesh()).unwrap()
    }

    fn first(&self) -> TimeOfContact {
        let [a, b] = self.bodies();
        time_of_contact(a, b, Window::UNIT, &self.options).unwrap()
    }

    fn of_first(&self, answer: &TimeOfContact) -> Verdict {
        self.verifier().time_of_contact(&self.bodies(), Window::UNIT, &self.options, answer, STEPS)
    }

    fn is_first(&self, answer: &TimeOfContact) -> bool {
        matches!(self.of_first(answer), Verdict::Verified { .. })
    }

    fn departure(&self) -> Departure {
        let [a, b] = self.bodies();
        departure(a, b, Window::UNIT, &self.options).unwrap()
    }

    fn is_departure(&self, answer: &Departure) -> bool {
        let verdict = self.verifier().departure(&self.bodies(), Window::UNIT, &self.options, answer, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    }

    fn is_clearance(&self, answer: &Clearance) -> bool {
        let options = ClearanceOptions::default();
        let verdict = self.verifier().clearance(&self.bodies(), Window::UNIT, &options, answer, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    }
}

/// Out of the other one, and into it again.
fn out_and_back() -> Keyframes {
    let at = |time: f64, x: f64| (time, Pose { translation: DVec3::X * x, ..Pose::IDENTITY });
    Keyframes::try_new(&[at(0.0, 1.5), at(0.5, 3.0), at(1.0, 1.5)], Span::Linear).unwrap()
}

#[test]
fn answers_that_let_go_are_proven_and_never_refuted() {
    let cube = cube(1.0);
    let (away, back, slowly) = (along_x(1.5, 2.0), out_and_back(), along_x(1.5, 0.25));
    for motion in [&away as &dyn RigidMotion, &back, &slowly, &along_x(5.0, -1.0), &along_x(5.0, -4.0)] {
        let mut pair = Pair::new([&cube; 2], motion);
        pair.options = pair.options.with_start(Start::Leave);
        let honest = pair.first();
        assert!(pair.is_first(&honest), "{honest:?} {:?}", pair.of_first(&honest));
        // Nothing is said of the time after it, by then they have parted, or are still in contact that is let go.
        let until = honest.contact().map_or(1.0, |contact| contact.time_lo);
        for part in [0.0, 0.1, 0.5, 0.9] {
            let clear_until = part * until;
            assert!(pair.is_first(&TimeOfContact::Undecided { clear_until }), "{part} {honest:?}");
        }
    }
    // What meets again is not passed over, and what never parts is in contact.
    for motion in [&back as &dyn RigidMotion, &slowly] {
        let mut pair = Pair::new([&cube; 2], motion);
        pair.options = pair.options.with_start(Start::Leave);
        assert!(!pair.is_first(&TimeOfContact::Separated));
        assert!(!pair.is_first(&TimeOfContact::Undecided { clear_until: 0.95 }));
    }
    let mut pair = Pair::new([&cube; 2], &slowly);
    pair.options = pair.options.with_start(Start::Leave);
    let verdict = pair.of_first(&TimeOfContact::Separated);
    assert!(matches!(verdict, Verdict::Unproven { reason: Reason::NotLeft, .. }), "{verdict:?}");
}

#[test]
fn when_bodies_had_parted_is_proven_of_a_contact() {
    let (cube, back, meets) = (cube(1.0), out_and_back(), along_x(5.0, -4.0));
    let pair = Pair::new([&cube; 2], &back);
    let honest = pair.departure();
    let left = honest.left.unwrap();
    assert!(pair.is_departure(&honest) && honest.answer.contact().unwrap().left == Some(left), "{honest:?}");
    let mut leaving = Pair::new([&cube; 2], &back);
    leaving.options = leaving.options.with_start(Start::Leave);
    let plain = Pair::new([&cube; 2], &meets);
    let [again, first] = [leaving.first(), plain.first()].map(|answer| *answer.contact().unwrap());
    for lie in [None, Some(TimeBracket { lo: 0.0, hi: 0.0 }), Some(TimeBracket { lo: 0.3, hi: 0.4 })] {
        let with = |mut contact: Contact| {
            contact.left = lie;
            TimeOfContact::Contact(contact)
        };
        let mut parting = honest;
        parting.answer = with(*honest.answer.contact().unwrap());
        // There it says nothing; of the answer alone, that they never parted.
        assert_eq!(pair.is_departure(&parting), lie.is_none(), "{lie:?}");
        assert!(!leaving.is_first(&with(again)), "{lie:?}");
        assert_eq!(plain.is_first(&with(first)), lie.is_none(), "{lie:?}");
    }
}

/// Bodies that overlap, touch or are inside each other were proven to begin in any other of these ways.
#[test]
fn how_bodies_that_leave_stood_at_the_start_is_proven() {
    use StartState::{Apart, Contained, Overlapping, Touching};
    let (large, small) = (cube(1.0), cube(0.1));
    for (tree, from, speed, start) in
        [(&large, 1.5, 2.0, Overlapping), (&large, 2.0, 1.0, Touching), (&small, 0.0, 4.0, Contained)]
    {
        let motion = along_x(from, speed);
        let mut pair = Pair::new([&large, tree], &motion);
        let honest = pair.departure();
        assert!(pair.is_departure(&honest) && honest.start == start, "{honest:?}");
        for lie in [Overlapping, Touching, Contained, Apart].into_iter().filter(|lie| *lie != start) {
            let mut said = honest;
            said.start = lie;
            // What is inside has a point inside of both.
            assert!(!pair.is_departure(&said), "{start:?} {lie:?}");
        }
        let mut never = honest;
        never.left = None;
        assert!(!pair.is_departure(&never), "{never:?}");
        // A question of existence promises how they stand at the start, too.
        pair.options = pair.options.with_mode(Mode::Exists);
        let honest = pair.first();
        assert!(pair.is_first(&honest), "{honest:?}");
        for lie in [Touching, Contained, Apart].into_iter().filter(|lie| *lie != start) {
            let mut contact = *honest.contact().unwrap();
            contact.start = lie;
            assert!(!pair.is_first(&TimeOfContact::Contact(contact)), "{start:?} {lie:?}");
        }
    }
    // Bodies that begin apart leave nothing, and are not in contact at once.
    let (passing, meets) = (along_x(5.0, 1.0), along_x(5.0, -4.0));
    let pair = Pair::new([&large; 2], &passing);
    let mut never = pair.departure();
    assert!(pair.is_departure(&never));
    never.left = None;
    assert!(!pair.is_departure(&never), "{never:?}");
    let mut pair = Pair::new([&large; 2], &meets);
    pair.options = pair.options.with_mode(Mode::Exists);
    let honest = pair.first();
    assert!(pair.is_first(&honest), "{honest:?}");
    for lie in [Touching, Contained, Overlapping] {
        let mut contact = *honest.contact().unwrap();
        contact.start = lie;
        assert!(!pair.is_first(&TimeOfContact::Contact(contact)), "{lie:?}");
    }
}

/// How fast bodies go is no part of how near they are said to come: at 1e12 a unit of time rounding explained any distance.
#[test]
fn fast_bodies_come_no_nearer_than_they_do() {
    let cube = cube(1.0);
    for speed in [1.0, 1e6, 1e9, 1e12] {
        // Past the other one, half a unit beside it.
        let place = DVec3::new(-0.25 * speed - 0.3, 2.5, 0.1);
        let passing = along_x(0.0, speed).with_position(place);
        let pair = Pair::new([&cube; 2], &passing);
        let [a, b] = pair.bodies();
        let honest = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
        assert!(honest.upper > 0.499 && pair.is_clearance(&honest), "{speed:e}: {honest:?}");
        for nearer in [1e-9, 1e-6, 1e-3, 0.02] {
            let mut lie = honest;
            lie.upper -= nearer;
            lie.lower = lie.lower.min(lie.upper - 1e-11);
            lie.tolerance = lie.tolerance.min(1e-10);
            lie.point_a += lie.normal * nearer;
            assert!(!pair.is_clearance(&lie), "{speed:e} {nearer:e}: {lie:?}");
        }
    }
}

/// A time limit that ended a search is no limit of the search of what its answer claims.
#[test]
fn a_time_limit_is_none_of_the_proof() {
    let cube = cube(1.0);
    for (from, start) in [(1.5, StartState::Overlapping), (2.0, StartState::Touching)] {
        let away = along_x(from, 2.0);
        let mut pair = Pair::new([&cube; 2], &away);
        let honest = pair.departure();
        assert!(honest.start == start && honest.left.is_some(), "{honest:?}");
        pair.options = pair.options.with_budget(Budget::UNLIMITED.with_wall_clock(Duration::ZERO));
        assert!(pair.is_departure(&honest), "{honest:?}");
    }
}

/// Bodies that begin apart have left at once: no answer says so of a start of which nothing else is proven.
#[test]
fn what_begins_apart_is_proven_apart() {
    let cube = cube(1.0);
    for (from, speed) in [(1.5, 1.0), (2.0, 0.0), (5.0, 1.0)] {
        let motion = along_x(from, speed);
        let pair = Pair::new([&cube; 2], &motion);
        let mut said = pair.departure();
        assert!(pair.is_departure(&said), "{said:?}");
        (said.start, said.left) = (StartState::Apart, None);
        said.answer = TimeOfContact::Undecided { clear_until: 0.0 };
        assert!(!pair.is_departure(&said), "{said:?}");
    }
}

/// How fast bodies go is no part of how deep they may be in each other where they are said to touch: at 1e12 a unit of time rounding explained
/// any depth.
#[test]
fn what_overlaps_does_not_touch_however_fast_it_goes() {
    let cube = cube(1.0);
    for speed in [1.0, 1e9, 1e10, 1e12] {
        for (from, start) in [
            (1.5, StartState::Overlapping),
            (2.0 - 1e-4, StartState::Overlapping),
            (2.0, StartState::Touching),
        ] {
            let away = along_x(from, speed);
            let pair = Pair::new([&cube; 2], &away);
            let mut contact = *pair.first().contact().unwrap();
            assert!(
                contact.start == start && pair.is_first(&TimeOfContact::Contact(contact)),
                "{speed:e}: {contact:?}"
            );
            (contact.start, contact.normal) = (StartState::Touching, DVec3::X);
            assert_eq!(
                pair.is_first(&TimeOfContact::Contact(contact)),
                start == StartState::Touching,
                "{speed:e} {from}"
            );
        }
    }
}

/// A bracket of a meeting that nothing is shown of has no later end.
#[test]
fn what_is_not_shown_has_no_later_end() {
    let cube = cube(1.0);
    let meets = along_x(5.0, -4.0);
    let pair = Pair::new([&cube; 2], &meets);
    let contact = *pair.first().contact().unwrap();
    let is_proven = |evidence: Evidence, time_hi: f64| {
        let mut edited = contact;
        (edited.evidence, edited.time_hi) = (evidence, time_hi);
        pair.is_first(&TimeOfContact::Contact(edited))
    };
    let later = contact.time_lo + 0.01;
    assert!(is_proven(Evidence::Near, later) && is_proven(Evidence::Early, contact.time_lo));
    assert!(!is_proven(Evidence::Early, later));
}

#[test]
fn what_stands_beside_a_clearance_is_that_of_its_triangles() {
    let (large, small) = (cube(1.0), cube(0.1));
    let passing = along_x(-4.0, 8.0).with_position(DVec3::new(-4.0, 3.0, 0.1));
    let (meets, overlaps, inside) = (along_x(5.0, -4.0), along_x(1.5, 2.0), along_x(0.0, 0.5));
    let asked = |trees: [&MeshTree; 2], motion: &dyn RigidMotion, edit: &dyn Fn(&mut Clearance)| {
        let pair = Pair { trees, motion, options: QueryOptions::default() };
        let [a, b] = pair.bodies();
        let mut answer = clearance(a, b, Window::UNIT, &ClearanceOptions::default()).unwrap();
        assert!(pair.is_clearance(&answer), "{answer:?}");
        edit(&mut answer);
        pair.is_clearance(&answer)
    };
    let (alike, held) = ([&large; 2], [&large, &small]);
    for motion in [&passing, &meets] {
        assert!(!asked(alike, motion, &|lie| lie.feature = FeaturePair::VertexFace { vertex: 0, face: 99 }));
        assert!(!asked(alike, motion, &|lie| lie.triangle_a = 1_000_000));
        // Both points, by as much.
        assert!(
            !asked(alike, motion, &|lie| (lie.point_a, lie.point_b) = (lie.point_a + 1.0, lie.point_b + 1.0))
        );
        assert!(!asked(alike, motion, &|lie| lie.normal *= 2.0));
    }
    assert!(!asked(alike, &passing, &|lie| lie.normal = -lie.normal));
    assert!(!asked(alike, &passing, &|lie| lie.normal = DVec3::X));
    for tolerance in [f64::NAN, -1.0, 1e-3, f64::INFINITY] {
        for motion in [&passing, &meets] {
            assert!(!asked(alike, motion, &|lie| lie.tolerance = tolerance), "{tolerance}");
        }
    }
    // Triangles that are not near are of bodies one of which holds the other.
    assert!(asked(held, &inside, &|lie| lie.status = ClearanceStatus::Contact));
    let opposite = |lie: &mut Clearance| {
        let x_of = |triangle: usize| large.mesh().corners(triangle).iter().map(|p| p.x).sum::<f64>();
        let far = (0..12).min_by(|a, b| x_of(*a).total_cmp(&x_of(*b))).unwrap();
        lie.triangle_a = far as u32;
    };
    assert!(!asked(alike, &meets, &opposite) && !asked(alike, &overlaps, &opposite));
}

#[test]
fn a_clear_span_has_the_tolerance_of_the_query() {
    let cube = cube(1.0);
    let meets = along_x(5.0, -4.0);
    let pair = Pair::new([&cube; 2], &meets);
    let [a, b] = pair.bodies();
    let honest = contact_spans(a, b, Window::UNIT, &pair.options, None).unwrap();
    let is_proven = |spans: &[ContactSpan]| {
        let verdict = pair.verifier().contact_spans(&[a, b], Window::UNIT, &pair.options, None, spans, STEPS);
        matches!(verdict, Verdict::Verified { .. })
    };
    assert!(is_proven(&honest) && honest[0].status == SpanStatus::Clear, "{honest:?}");
    for tolerance in [1e-3, f64::NAN, f64::INFINITY, -1.0] {
        let mut lie = honest.clone();
        lie[0] = lie[0].with_tolerance(tolerance);
        assert!(!is_proven(&lie), "{lie:?}");
    }
}

/// Far from the origin enclosures of poses raise the tolerance: bodies that part, and that meet, do so at that, and answers are proven.
#[test]
fn a_tolerance_that_rounding_of_poses_raises_is_one_that_an_answer_may_have() {
    let tree = cube(1.0);
    let verifier = Verifier::try_new(tree.mesh(), tree.mesh()).unwrap();
    let far = |x: f64, speed: f64| Opaque(along_x(1e9 + x, speed));
    let still = far(0.0, 0.0);
    let options = QueryOptions::default();
    for (from, speed) in [(1.5, 1.0), (1.75, 0.5), (3.0, -2.0), (2.5, -1.0)] {
        let moved = far(from, speed);
        let bodies = [Moving::new(&tree, &still), Moving::new(&tree, &moved)];
        let [a, b] = bodies;
        let found = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        assert!(found.contact().is_some_and(|contact| contact.tolerance > 1e-6), "{found:?}");
        let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, &found, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{from}: {found:?} {verdict:?}");
        let parting = departure(a, b, Window::UNIT, &options).unwrap();
        assert!(parting.left.is_some(), "{parting:?}");
        let verdict = verifier.departure(&bodies, Window::UNIT, &options, &parting, STEPS);
        assert!(matches!(verdict, Verdict::Verified { .. }), "{from}: {parting:?} {verdict:?}");
        let mut lie = found;
        if let TimeOfContact::Contact(contact) = &mut lie {
            contact.tolerance *= 4.0;
        }
        let verdict = verifier.time_of_contact(&bodies, Window::UNIT, &options, &lie, STEPS);
        assert!(matches!(verdict, Verdict::Unproven { reason: Reason::Tolerance, .. }), "{verdict:?}");
    }
}

/// Bodies that are up to four tolerances apart at the start, and at the end: searches stop up to 3.3 above the separation, so they may be said to be
/// in contact.
#[test]
fn bodies_a_few_tolerances_apart_may_be_in_contact() {
    let mut random = KnuthRandom(2);
    let (large, small) = (cube(0.5), cube(0.2));
    let (mut left, mut stayed) = (0, 0);
    for case in 0..600 {
        let tolerance = 10f64.powf(-2.0 - 3.0 * random.unit());
        // Or just above the tolerance, where searches stop and nothing proves the bodies within it.
        let mut some = |from: f64, to: f64| tolerance * (from + (to - from) * random.unit());
        let [first, last] = match case % 3 {
            0 => [some(0.0, 4.0), some(0.0, 4.0)],
            1 => [some(0.0, 1.0), some(1.0, 1.05)],
            _ => [some(1.0, 1.05), some(0.0, 1.2)],
        };
        let min_separation = if case % 4 == 0 { 0.05 } else { 0.0 };
        // Beside the inside of a face, so that no other distance is less.
        let place = DVec3::new(0.7 + min_separation + first, 0.2 * random.signed(), 0.2 * random.signed());
        let going = ConstantTwist::REST.with_position(place).with_linear_velocity(DVec3::X * (last - first));
        let options = QueryOptions::default().with_tolerance(tolerance).with_min_separation(min_separation);
        let pair = Pair { options, ..Pair::new([&large, &small], &going) };
        let answer = pair.departure();
        assert!(pair.is_departure(&answer), "{case}: from {first:e} to {last:e}, {tolerance:e}: {answer:?}");
        left += usize::from(answer.left.is_some());
        stayed += usize::from(answer.left.is_none());
    }
    assert!(left > 200 && stayed > 50, "{left} {stayed}");
}
