//! Modes of queries about motions whose twists are not constant: what else an answer says holds in each of them. Found by an adversary.

use d2m_bvh::{
    Evidence, MeshTree, Mode, Moving, Posed, QueryOptions, Solid, StartState, TriMesh, Window, contact_spans,
    distance, time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion, Spline, SplineDegree};
use glam::{DQuat, DVec3};

const TOLERANCE: f64 = 1e-9;

fn tetrahedron() -> MeshTree {
    let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    MeshTree::new(TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap())
}

/// Tumbles past the other one, nearer or further away: some of these begin apart and meet, some begin in contact, some do neither.
fn tumbling(number: u32) -> Spline {
    let k = f64::from(number);
    let at = |time: f64, place: DVec3, turn: DVec3| {
        let rotation = DQuat::from_scaled_axis(turn);
        (time, Pose { translation: place, rotation, at: DVec3::ZERO })
    };
    let start = DVec3::new(0.4 + 0.05 * k, 0.3, 0.1 * (k % 5.0));
    Spline::try_through(
        &[
            at(0.0, start, DVec3::ZERO),
            at(0.3, start + DVec3::new(-0.5, 0.2, 0.1), DVec3::new(1.0, 0.3 * (k % 7.0), -0.4)),
            at(0.7, start + DVec3::new(-1.0, -0.3, 0.2), DVec3::new(1.5, -1.0, 0.2)),
            at(1.0, start + DVec3::new(0.2, 0.5, -0.4), DVec3::new(0.5, 1.0, 1.0)),
        ],
        SplineDegree::Cubic,
    )
    .unwrap()
}

fn options(mode: Mode) -> QueryOptions {
    QueryOptions::default().with_mode(mode).with_tolerance(TOLERANCE)
}

/// Contacts that exist had the fit of a motion, a tenth of the body, as their tolerance, and bodies 0.05 apart at the start were "touching" there.
#[test]
fn a_contact_that_exists_says_what_holds() {
    let tree = tetrahedron();
    let mut later = 0;
    for number in 0..40 {
        let motion = tumbling(number);
        let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &motion)];
        let answer = time_of_contact(a, b, Window::UNIT, &options(Mode::Exists)).unwrap();
        let first = time_of_contact(a, b, Window::UNIT, &options(Mode::Accurate)).unwrap();
        assert_eq!(answer.contact().is_some(), first.contact().is_some(), "{number}");
        let (Some(contact), Some(first)) = (answer.contact(), first.contact()) else { continue };
        later += u32::from(contact.start == StartState::Apart);
        assert_eq!(
            contact.start == StartState::Apart,
            first.start == StartState::Apart,
            "{number} {contact:?}"
        );
        assert!(contact.start == StartState::Apart || contact.time_lo == 0.0, "{number} {contact:?}");
        assert!(contact.tolerance <= 1.1 * TOLERANCE, "{number} {contact:?}");
        let there = [Pose::IDENTITY, motion.pose_and_twist(contact.time_lo).0];
        let near = distance(Posed::new(&tree, there[0]), Posed::new(&tree, there[1]), Solid::Filled).unwrap();
        assert!(near.lower <= 3.3 * contact.tolerance, "{number} {contact:?} {near:?}");
        if contact.start == StartState::Apart {
            let between = contact.point_a.distance(contact.point_b);
            assert!((between - contact.separation).abs() < 1e-12, "{number} {contact:?}");
        }
    }
    assert!(later > 5);
}

/// Early contacts had a tolerance that was larger by the fit, and points and a normal of the fit.
#[test]
fn an_early_contact_has_the_tolerance_that_was_asked_for() {
    let tree = tetrahedron();
    let mut early = 0;
    for number in 0..40 {
        let motion = tumbling(number);
        let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &motion)];
        let answer = time_of_contact(a, b, Window::UNIT, &options(Mode::Capoeira)).unwrap();
        let Some(contact) = answer.contact().filter(|contact| contact.evidence == Evidence::Early) else {
            continue;
        };
        early += 1;
        assert!(contact.tolerance <= 1.1 * TOLERANCE && contact.time_lo == contact.time_hi, "{contact:?}");
        let between = contact.point_b - contact.point_a;
        assert!((between.length() - contact.separation).abs() < 1e-12, "{number} {contact:?}");
        assert!((between - contact.normal * contact.separation).length() < 1e-12, "{number} {contact:?}");
    }
    assert!(early > 5);
}

/// Spans ended at early contacts: bodies 0.9 apart were said to be in contact.
#[test]
fn spans_are_the_same_in_every_mode() {
    let tree = tetrahedron();
    let mut met = 0;
    for number in 0..40 {
        let motion = tumbling(number);
        let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &motion)];
        let of = |mode| contact_spans(a, b, Window::UNIT, &options(mode), None).unwrap();
        let accurate = of(Mode::Accurate);
        met += usize::from(accurate.len() > 1);
        assert_eq!(of(Mode::Capoeira), accurate, "{number}");
        assert_eq!(of(Mode::Exists), accurate, "{number}");
    }
    assert!(met > 5);
}
