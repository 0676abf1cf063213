//! What a contact claims to prove of the meeting is true, judged by the certified static distance.

use d2m_bvh::{
    Contact, Evidence, MeshTree, Mode, Moving, PairCache, Posed, QueryOptions, Solid, StartState,
    TimeOfContact, TriMesh, Window, contact_exists, distance, time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion};
use d2m_testing::{Blurred, Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

const DELTA: f64 = 1e-6;

/// Of `DELTA`: how far heights of 2 to 4 are rounded, 4.4e-16 each, and the judge's distances.
const ROUNDING: f64 = 1e-9;

fn cube(half: f64) -> MeshTree {
    MeshTree::new(Surface::cube(half).into_mesh(TriMesh::try_new))
}

fn moving(x: DVec3, v: DVec3) -> ConstantTwist {
    ConstantTwist::try_new(x, DQuat::IDENTITY, v, DVec3::ZERO).unwrap()
}

fn options() -> QueryOptions {
    QueryOptions::default().with_tolerance(DELTA)
}

fn contact(a: &ConstantTwist, options: &QueryOptions) -> Contact {
    let tree = cube(1.0);
    let bodies = (Moving::new(&tree, a), Moving::new(&tree, &ConstantTwist::REST));
    *time_of_contact(bodies.0, bodies.1, Window::UNIT, options).unwrap().contact().expect("a contact")
}

/// Upper bound on the distance at a time.
fn upper_at(a: &ConstantTwist, time: f64) -> f64 {
    let tree = cube(1.0);
    let m = a.rebase(time);
    let pose = Pose { rotation: m.orientation(), translation: m.position(), at: m.at() };
    distance(Posed::new(&tree, pose), Posed::at_rest(&tree), Solid::Filled).unwrap().upper
}

#[test]
fn near_is_near_at_the_end_of_the_bracket() {
    for (x, v, separation) in [
        (DVec3::new(0.1, 0.2, 4.0), DVec3::Z * -8.0, 0.0),
        (DVec3::new(0.1, 0.2, 4.0), DVec3::new(0.1, 0.0, -8.0), 0.25),
        (DVec3::new(0.1, 0.2, 2.0), DVec3::Z, 0.0),
        (DVec3::new(0.1, 0.2, 2.25), DVec3::Z, 0.25),
    ] {
        let motion = moving(x, v);
        let found = contact(&motion, &options().with_min_separation(separation));
        assert_eq!(found.evidence, Evidence::Near, "{found:?}");
        let left = upper_at(&motion, found.time_hi);
        assert!(left <= (separation + found.tolerance) * (1.0 + ROUNDING), "{left} {found:?}");
    }
}

#[test]
fn bodies_that_cross_or_hold_each_other_at_the_start_are_proven_to() {
    let crossing = contact(&moving(DVec3::new(0.5, 1.25, 0.75), DVec3::ZERO), &options());
    assert_eq!((crossing.evidence, crossing.start), (Evidence::Crossing, StartState::Overlapping));
    let (large, small) = (cube(8.0), cube(1.0));
    let rest = ConstantTwist::REST;
    let held =
        time_of_contact(Moving::new(&small, &rest), Moving::new(&large, &rest), Window::UNIT, &options());
    let held = *held.unwrap().contact().unwrap();
    assert_eq!((held.evidence, held.start), (Evidence::Crossing, StartState::Contained));
}

/// At the start a little more than a tolerance apart: a contact by the rule of the search. Nothing is proven of bodies
/// that part; bodies that close are near at the end of the bracket.
#[test]
fn a_start_a_little_above_the_tolerance() {
    let place = |tolerances: f64| DVec3::new(0.1, 0.2, 2.0 + tolerances * DELTA);
    let parting = contact(&moving(place(1.004), DVec3::Z), &options());
    assert_eq!((parting.evidence, parting.start), (Evidence::Early, StartState::Touching));
    assert_eq!(parting.time_hi, parting.time_lo);
    for tolerances in [1.004, 1.5] {
        let closing = moving(place(tolerances), DVec3::new(0.0, 0.1, -1.0));
        let found = contact(&closing, &options());
        assert_eq!(found.evidence, Evidence::Near, "{found:?}");
        assert!(found.time_hi > 0.0 && upper_at(&closing, found.time_hi) <= DELTA * (1.0 + ROUNDING));
    }
}

#[test]
fn an_early_stop_proves_no_contact() {
    let passing = moving(DVec3::new(-4.0, 0.2, 2.001), DVec3::X * 8.0);
    let found = contact(&passing, &options().with_mode(Mode::Capoeira));
    assert_eq!((found.evidence, found.time_hi), (Evidence::Early, found.time_lo));
    let exists = contact(&moving(DVec3::Z * 4.0, DVec3::Z * -8.0), &options().with_mode(Mode::Exists));
    assert_eq!(exists.evidence, Evidence::Near);
}

/// A pass at 1.5 tolerances, by a vertex over a face.
#[test]
fn a_grazing_pass_above_the_tolerance_is_early() {
    let passing = moving(DVec3::new(-4.0, 0.2, 2.0 + 1.5 * DELTA), DVec3::X * 8.0);
    let found = contact(&passing, &options());
    assert_eq!((found.evidence, found.time_hi), (Evidence::Early, found.time_lo));
    assert!(found.time_lo > 0.2 && found.separation < 3.3 * DELTA);
}

/// Two needles above two faces, one of them steep, which meet at about the same time: the reported separation is that of the
/// reported pair, and the other pair may be nearer.
#[test]
fn the_separation_is_that_of_the_reported_pair() {
    let mut random = KnuthRandom(71);
    let (mut nearer, mut other) = (0, 0);
    for round in 0..600 {
        let steep: f64 = [0.5, 3.0, 30.0][round % 3];
        let slope = (1.0 + steep * steep).sqrt();
        let face = |x: f64, rise: f64| {
            [DVec3::new(x - 1.0, -1.0, -rise), DVec3::new(x + 1.0, -1.0, rise), DVec3::new(x, 1.0, 0.0)]
        };
        let needle = |x: f64, z: f64| {
            let top = z + 1.0 + x;
            [DVec3::new(x, 0.0, z), DVec3::new(x, 0.01, top), DVec3::new(x + 0.01, 0.0, top)]
        };
        let pair = |one: [DVec3; 3], two: [DVec3; 3]| {
            MeshTree::new(TriMesh::try_new([one, two].concat(), vec![[0, 1, 2], [3, 4, 5]]).unwrap())
        };
        // Both pairs come within the distance at which a search stops at about the same time.
        let height = 1.0 + DELTA * (1.0156 * (slope - 1.0) + 0.02 * random.signed() * slope);
        let (a, b) = (pair(needle(0.0, 1.0), needle(10.0, height)), pair(face(0.0, 0.0), face(10.0, steep)));
        let falling = moving(DVec3::ZERO, DVec3::Z * -2.0);
        let options = options().with_solid(Solid::Surface);
        let rest = ConstantTwist::REST;
        let answer =
            time_of_contact(Moving::new(&a, &falling), Moving::new(&b, &rest), Window::UNIT, &options);
        let found = *answer.unwrap().contact().unwrap();
        let at = Posed::new(&a, falling.pose_and_twist(found.time_lo).0);
        let least = distance(at, Posed::at_rest(&b), Solid::Surface).unwrap();
        let reported = found.point_a.distance(found.point_b);
        assert!((reported - found.separation).abs() < 1e-3 * DELTA, "{found:?}");
        assert!(least.lower > 0.0 && least.lower <= found.separation * (1.0 + 1e-3), "{found:?} {least:?}");
        nearer += u32::from(least.upper < found.separation - 5e-3 * DELTA);
        other += u32::from(least.triangle_a != found.triangle_a);
    }
    assert!(nearer > 0 && other > 0, "{nearer} {other}");
}

/// A yes means at most 3.3 tolerances more than the separation, and as much as the evidence of the same query says; a no is
/// proven. Whatever the cache holds.
#[test]
fn a_yes_is_as_good_as_the_evidence_of_the_mode() {
    let tree = cube(1.0);
    let rest = ConstantTwist::REST;
    let mut seen = [0; 3];
    let mut cache = PairCache::new();
    for step in 0..400 {
        let (separation, tolerances) = ([0.0, 0.25][step % 2], 0.015 * step as f64);
        let height = 2.0 + separation + tolerances * DELTA;
        let passing = moving(DVec3::new(-4.0, 0.2, height), DVec3::X * 8.0);
        let options = options().with_min_separation(separation).with_mode(Mode::Exists);
        let [a, b] = [&passing, &rest].map(|motion| Moving::new(&tree, motion));
        let answer = contact_exists(a, b, Window::UNIT, &options, &mut cache).unwrap();
        assert_eq!(answer, contact_exists(a, b, Window::UNIT, &options, &mut PairCache::new()).unwrap());
        let contact = match time_of_contact(a, b, Window::UNIT, &options).unwrap() {
            TimeOfContact::Contact(contact) => Some(contact.evidence),
            _ => None,
        };
        assert_eq!(answer, Some(contact.is_some()), "{tolerances}");
        match contact {
            Some(Evidence::Early) => assert!(tolerances <= 3.3, "{tolerances}"),
            Some(_) => assert!(tolerances <= 1.0 + ROUNDING, "{tolerances}"),
            None => assert!(tolerances > 1.0 - ROUNDING, "{tolerances}"),
        }
        seen[contact.map_or(0, |evidence| 1 + usize::from(evidence == Evidence::Early))] += 1;
    }
    assert!(seen[0] > 10 && seen[1] > 10, "{seen:?}");
}

#[test]
fn any_motion_claims_only_what_its_enclosures_show() {
    let (tree, large) = (cube(1.0), cube(8.0));
    let ask = |body: &MeshTree, motion: &Blurred<ConstantTwist>| {
        let rest = ConstantTwist::REST;
        time_of_contact(Moving::new(&tree, motion), Moving::new(body, &rest), Window::UNIT, &options())
            .unwrap()
    };
    let query =
        |body: &MeshTree, motion: &Blurred<ConstantTwist>| *ask(body, motion).contact().expect("a contact");
    let undecided = TimeOfContact::Undecided { clear_until: 0.0 };
    let falling = moving(DVec3::new(0.1, 0.2, 4.0), DVec3::Z * -8.0);
    let found = query(&tree, &Blurred::by(falling, 0.0));
    assert_eq!(found.evidence, Evidence::Near);
    assert!(upper_at(&falling, found.time_hi) <= found.tolerance);
    let inside = ConstantTwist::REST;
    assert_eq!(query(&large, &Blurred::by(inside, 0.0)).evidence, Evidence::Crossing);
    assert_eq!(ask(&large, &Blurred::by(inside, 8.0)), undecided);
    let across = moving(DVec3::X * 1.5, DVec3::ZERO);
    assert_eq!(query(&tree, &Blurred::by(across, 0.0)).evidence, Evidence::Near);
    assert_eq!(ask(&tree, &Blurred::by(across, 1.0)), undecided);
}

#[cfg(feature = "serde")]
#[test]
fn answers_options_and_windows_survive_json() {
    use d2m_bvh::Budget;
    use std::time::Duration;
    let found = TimeOfContact::Contact(contact(&moving(DVec3::Z * 4.0, DVec3::Z * -8.0), &options()));
    for answer in [found, TimeOfContact::Separated, TimeOfContact::Undecided { clear_until: 0.5 }] {
        let text = serde_json::to_string(&answer).unwrap();
        assert_eq!(serde_json::from_str::<TimeOfContact>(&text).unwrap(), answer, "{text}");
    }
    let text = serde_json::to_string(&found).unwrap();
    for part in ["\"status\":\"contact\"", "\"evidence\":\"near\"", "\"start\":\"apart\"", "\"time_lo\":"] {
        assert!(text.contains(part), "{text}");
    }
    let options = options()
        .with_mode(Mode::Exists)
        .with_solid(Solid::Surface)
        .with_budget(Budget::UNLIMITED.with_wall_clock(Duration::from_millis(5)));
    let text = serde_json::to_string(&options).unwrap();
    assert_eq!(serde_json::from_str::<QueryOptions>(&text).unwrap(), options);
    assert_eq!(serde_json::from_str::<QueryOptions>("{\"tolerance\":1e-6}").unwrap(), self::options());
    assert_eq!(serde_json::from_str::<Window>("[0,1]").unwrap(), Window::UNIT);
    assert!(serde_json::from_str::<Window>("[1,0]").is_err());
}
