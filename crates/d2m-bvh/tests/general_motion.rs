//! Motions whose twist is not constant: never late, never missed, as near as was asked, judged by static distances.

mod queries;

use d2m_bvh::{
    Distance, Evidence, MeshTree, Mode, Moving, QueryError, QueryOptions, Solid, StartState, TimeOfContact,
    TriMesh, Window, time_of_contact, time_of_contact_counted,
};
use d2m_motion::{
    Chain, Composed, ConstantTwist, Joint, JointKind, JointValue, Keyframes, OutsideDomain, Pose,
    RigidMotion, Span,
};
use d2m_testing::{Blurred, Draw, KnuthRandom, Opaque, Surface};
use glam::{DQuat, DVec3};
use queries::{distance_at, query};

const DELTA: f64 = 1e-9;

fn torus(rings: u32, sides: u32, scale: f64) -> MeshTree {
    MeshTree::new(Surface::wavy_torus(rings, sides, 0.3).map(|p| p * scale).into_mesh(TriMesh::try_new))
}

fn cube(half: f64) -> MeshTree {
    MeshTree::new(Surface::cube(half).into_mesh(TriMesh::try_new))
}

/// Nothing touches before the answer, what is left then is as promised, and what is free is apart.
fn judge(
    trees: [&MeshTree; 2],
    motions: [&dyn RigidMotion; 2],
    (window, origin): (Window, DVec3),
    answer: &TimeOfContact,
) -> Result<(), String> {
    let end = match answer {
        TimeOfContact::Contact(contact) => contact.time_lo,
        TimeOfContact::Separated => window.end(),
        TimeOfContact::Undecided { clear_until } => *clear_until,
    };
    for k in 0..=100 {
        let t = (window.start() + (end - window.start()) * f64::from(k) / 100.0).min(end);
        let Distance { lower: low, upper: high, .. } = distance_at(trees, motions, t, origin);
        if low <= 0.0 {
            return Err(format!("touching at {t}, before {end}: {high:e}"));
        }
    }
    let Some(contact) = answer.contact() else { return Ok(()) };
    let Distance { lower: low, upper: high, .. } = distance_at(trees, motions, contact.time_lo, origin);
    let delta = contact.tolerance;
    if low < 0.3 * delta || high > 3.5 * delta {
        return Err(format!("{low:e} to {high:e} left at {end}: {contact:?}"));
    }
    if contact.evidence == Evidence::Near {
        let high = distance_at(trees, motions, contact.time_hi, origin).upper;
        if high > 1.001 * delta {
            return Err(format!("{high:e} left at the end of the bracket: {contact:?}"));
        }
    }
    let size = 1e-9 * (1.0 + origin.length());
    if (contact.point_b - contact.point_a).length() > 3.5 * delta + size || contact.start != StartState::Apart
    {
        return Err(format!("{contact:?}"));
    }
    Ok(())
}

fn polynomial(coefficients: &[f64]) -> JointValue {
    JointValue::try_polynomial(coefficients.to_vec()).unwrap()
}

fn revolute(position: DVec3, axis: DVec3, value: JointValue) -> Joint {
    Joint::try_new(position, DQuat::IDENTITY, JointKind::Revolute { axis, value }).unwrap()
}

fn prismatic(position: DVec3, axis: DVec3, value: JointValue) -> Joint {
    Joint::try_new(position, DQuat::IDENTITY, JointKind::Prismatic { axis, value }).unwrap()
}

fn fixed(position: DVec3) -> Joint {
    Joint::try_new(position, DQuat::IDENTITY, JointKind::Fixed).unwrap()
}

/// An arm of several joints that sweeps through a neighbourhood of its base.
fn arm(random: &mut KnuthRandom, joints: usize, base: DVec3, start: f64) -> Chain {
    let mut chain = vec![fixed(base)];
    for k in 0..joints {
        let coefficients: Vec<f64> = (0..4).map(|i| random.signed() * [3.0, 1.5, 1.0, 0.5][i]).collect();
        let value = JointValue::try_pieces(vec![start - 1.0, start + 2.0], vec![coefficients]).unwrap();
        let position = if k == 0 { DVec3::ZERO } else { DVec3::X * 0.8 };
        chain.push(revolute(position, random.vector(), value));
    }
    chain.push(fixed(DVec3::X * 0.8));
    Chain::try_new(chain).unwrap()
}

#[test]
fn random_arms_are_answered_right() {
    let (a, b) = (torus(12, 7, 0.5), torus(16, 8, 0.8));
    let mut random = KnuthRandom(31);
    let options = QueryOptions::default().with_tolerance(DELTA);
    let mut hits = 0;
    for round in 0..120 {
        let start = [0.0, 1e5][round % 2];
        let offset = [DVec3::ZERO, DVec3::new(1e6, -2e6, 1e6)][round / 2 % 2];
        let link = arm(&mut random, 1 + round % 6, offset, start);
        let still = ConstantTwist::REST
            .with_position(offset + random.vector().normalize() * 2.5)
            .with_angular_velocity(random.vector() * 2.0)
            .with_reference_time(start);
        let window = Window::try_new(start, start + 1.0).unwrap();
        if distance_at([&a, &b], [&link, &still], start, offset).lower < 1e-3 {
            continue;
        }
        let answer = query([&a, &b], [&link, &still], window, &options);
        assert!(!matches!(answer, TimeOfContact::Undecided { .. }), "round {round}: {answer:?}");
        hits += usize::from(answer.contact().is_some());
        if let Err(fault) = judge([&a, &b], [&link, &still], (window, offset), &answer) {
            panic!("round {round}: {fault}");
        }
        if answer.is_separated() {
            for k in 0..=300 {
                let t = start + f64::from(k) / 300.0;
                let low = distance_at([&a, &b], [&link, &still], t, offset).lower;
                assert!(low > 0.0, "round {round}: missed at {t}");
            }
        }
    }
    assert!(hits > 20, "{hits}");
}

/// The answer, and what was done for it in node tests.
fn counted(
    bodies: [&MeshTree; 2],
    motions: [&dyn RigidMotion; 2],
    options: &QueryOptions,
) -> (TimeOfContact, u64) {
    let [a, b] = [0, 1].map(|k| Moving::new(bodies[k], motions[k]));
    let asked = time_of_contact_counted(a, b, Window::UNIT, options).unwrap();
    (asked.answer, asked.work.work())
}

#[test]
fn hidden_twists_take_one_search() {
    let (a, b) = (torus(30, 14, 1.0), torus(25, 13, 0.8));
    let mut random = KnuthRandom(32);
    let options = QueryOptions::default().with_tolerance(DELTA);
    for round in 0..60 {
        let from = random.vector().normalize() * 3.5;
        let v = (random.vector() * 0.7 - from).normalize() * 4.0;
        let motion = |x: DVec3, v: DVec3, w: DVec3| ConstantTwist::try_new(x, DQuat::IDENTITY, v, w).unwrap();
        let m =
            [motion(from, v, random.vector() * 2.0), motion(DVec3::ZERO, DVec3::ZERO, random.vector() * 2.0)];
        let (exact, work) = counted([&a, &b], [&m[0], &m[1]], &options);
        let hidden = m.map(Opaque);
        let (general, again) = counted([&a, &b], [&hidden[0], &hidden[1]], &options);
        // One fit is charged with 256 node tests.
        assert!(again < 2 * work + 300, "{again} {work}");
        match (exact.contact(), general.contact()) {
            (Some(exact), Some(general)) => {
                assert!((exact.time_lo - general.time_lo).abs() < 1e-10, "round {round}");
                assert!((exact.normal - general.normal).length() < 1e-5);
                assert!((exact.point_a - general.point_a).length() < 1e-5);
                assert!((exact.closing_speed - general.closing_speed).abs() < 1e-6);
            }
            (None, None) => {}
            _ => panic!("round {round}: {exact:?} {general:?}"),
        }
    }
}

/// A contact at a time that is known: a body is thrown up with v² / 2g just enough to come within `clearance` of a
/// ceiling, at a time when its velocity vanishes.
#[test]
fn velocities_that_vanish_at_the_contact() {
    let (a, b) = (cube(1.0), cube(1.0));
    let options = QueryOptions::default().with_tolerance(DELTA);
    for power in [2, 3, 4, 5] {
        for (clearance, meets) in [(1e-3, false), (1e-6, false), (2e-8, false), (0.0, true), (-1e-6, true)] {
            for start in [0.0, 1e5] {
                // The height is 2 + clearance + (t − ½)^n for even n; for odd n it goes on through.
                let odd = power % 2 == 1;
                let coefficients = binomial(power, -0.5);
                let coefficients: Vec<f64> = coefficients.iter().map(|c| if odd { -c } else { *c }).collect();
                let value = JointValue::try_pieces(vec![start, start + 1.0], vec![coefficients]).unwrap();
                let rise =
                    Chain::try_new(vec![prismatic(DVec3::Z * (2.0 + clearance), DVec3::Z, value)]).unwrap();
                let window = Window::try_new(start, start + 1.0).unwrap();
                let answer = query([&a, &b], [&rise, &ConstantTwist::REST], window, &options);
                assert_eq!(
                    answer.contact().is_some(),
                    meets || odd,
                    "{power} {clearance:e} {start}: {answer:?}"
                );
                judge([&a, &b], [&rise, &ConstantTwist::REST], (window, DVec3::ZERO), &answer)
                    .unwrap_or_else(|fault| panic!("{power} {clearance:e} {start}: {fault}"));
            }
        }
    }
}

/// Coefficients of (t + c)^n.
fn binomial(n: usize, c: f64) -> Vec<f64> {
    let mut out = vec![1.0];
    for _ in 0..n {
        let mut next = vec![0.0; out.len() + 1];
        for (k, x) in out.iter().enumerate() {
            next[k] += x * c;
            next[k + 1] += x;
        }
        out = next;
    }
    out
}

#[test]
fn contacts_at_joints_are_found_once() {
    let (a, b) = (cube(1.0), cube(1.0));
    let pose = |x: f64, y: f64| Pose { translation: DVec3::new(x, y, 0.0), ..Pose::IDENTITY };
    let options = QueryOptions::default().with_tolerance(DELTA);
    for join in [Span::Linear, Span::Screw] {
        for (touch, meets) in [(2.0, true), (2.0 - 1e-6, true), (2.0 + 1e-6, false)] {
            // Comes down to the wall exactly at the joint and goes away again.
            let frames = [(0.0, pose(4.0, 0.3)), (0.3, pose(touch, 0.1)), (1.0, pose(3.0, -0.5))];
            let path = Keyframes::try_new(&frames, join).unwrap();
            let answer = query([&a, &b], [&path, &ConstantTwist::REST], Window::UNIT, &options);
            assert_eq!(answer.contact().is_some(), meets, "{touch} {answer:?}");
            if let Some(contact) = answer.contact() {
                assert!(contact.time_lo <= 0.3 && contact.time_lo > 0.3 - 1e-6);
                assert_eq!(contact.start, StartState::Apart);
            }
            // And from the joint on: there at once, or not at all.
            let rest = Window::try_new(0.3, 1.0).unwrap();
            let later = query([&a, &b], [&path, &ConstantTwist::REST], rest, &options);
            assert_eq!(later.contact().is_some_and(|c| c.time_lo == 0.3), meets);
            // The same joint in a chain, whose pieces are not stated as twists.
            let x = JointValue::try_pieces(
                vec![0.0, 0.3, 1.0],
                vec![vec![4.0, (touch - 4.0) / 0.3], vec![touch, (3.0 - touch) / 0.7]],
            )
            .unwrap();
            let link = Chain::try_new(vec![prismatic(DVec3::ZERO, DVec3::X, x)]).unwrap();
            let answer = query([&a, &b], [&link, &ConstantTwist::REST], Window::UNIT, &options);
            assert_eq!(answer.contact().is_some(), meets, "{touch} {answer:?}");
            if let Some(contact) = answer.contact() {
                assert!(contact.time_lo <= 0.3 && contact.time_lo > 0.3 - 1e-6, "{contact:?}");
            }
        }
    }
}

/// A body that has turned some 10⁴ to 10⁸ times since its reference time, against one that is no single twist: as if it began with the window.
#[test]
fn many_turns_before_the_window_change_no_answer() {
    let (a, b) = (cube(1.0), cube(1.0));
    let options = QueryOptions::default();
    for (start, rate, reach) in [(1e3, 200.0, 3.3), (1e4, 20.0, 40.0), (1e4, 20.0, 3.3), (3e5, 1e3, 3.3)] {
        let pose = |x: f64| Pose { translation: DVec3::new(x, 0.2, 0.0), ..Pose::IDENTITY };
        let times = [start, start + 0.25, start + 0.5];
        let frames =
            [(times[0], pose(-reach)), (times[1], pose(-0.7 * reach)), (times[2], pose(-0.5 * reach))];
        let path = Keyframes::try_new(&frames, Span::Linear).unwrap();
        let far = ConstantTwist::REST.with_angular_velocity(DVec3::Z * rate);
        let window = Window::try_new(times[0], times[2]).unwrap();
        let [early, late] = [far, far.rebase(times[0])].map(|b_moves| {
            let answer = query([&a, &b], [&path, &b_moves], window, &options);
            judge([&a, &b], [&path, &b_moves], (window, DVec3::ZERO), &answer).unwrap();
            assert!(!matches!(answer, TimeOfContact::Undecided { .. }), "{start} {reach}: {answer:?}");
            answer.contact().map(|contact| contact.time_lo)
        });
        assert_eq!(early.is_some(), reach < 10.0, "{start}");
        if let Some((early, late)) = early.zip(late) {
            // Rates, rebased, are as they were; orientations differ by rounding.
            assert!((early - late).abs() < 1e-9, "{early} {late}");
        }
    }
}

#[test]
fn many_spans_are_skipped_by_spheres() {
    let (a, b) = (torus(30, 14, 1.0), torus(25, 13, 0.8));
    let frames: Vec<(f64, Pose)> = (0..=200)
        .map(|i| {
            let t = f64::from(i);
            let x = if i == 200 { 0.0 } else { 30.0 + (0.1 * t).sin() };
            (
                t,
                Pose {
                    translation: DVec3::new(x, 0.0, 0.0),
                    rotation: DQuat::from_rotation_z(0.01 * t),
                    at: DVec3::ZERO,
                },
            )
        })
        .collect();
    let path = Keyframes::try_new(&frames, Span::Linear).unwrap();
    let window = Window::try_new(0.0, 200.0).unwrap();
    let answer = query([&a, &b], [&path, &ConstantTwist::REST], window, &QueryOptions::default());
    let contact = answer.contact().expect("a contact in the last span");
    assert!(contact.time_lo > 199.0 && contact.time_lo < 200.0);
    let alone = query(
        [&a, &b],
        [&path.motions()[199], &ConstantTwist::REST],
        Window::try_new(199.0, 200.0).unwrap(),
        &QueryOptions::default(),
    );
    assert_eq!(answer, alone);
}

#[test]
fn bodies_that_accelerate_together_are_as_at_rest() {
    let (a, b) = (torus(30, 14, 1.0), torus(25, 13, 0.8));
    let fall = |x: DVec3, v: f64| {
        Chain::try_new(vec![
            prismatic(x, DVec3::Z, polynomial(&[0.0, 1.0, -50.0, 7.0])),
            prismatic(DVec3::ZERO, DVec3::X, polynomial(&[0.0, v])),
        ])
        .unwrap()
    };
    let options = QueryOptions::default().with_tolerance(DELTA);
    let (one, other) = (fall(DVec3::X * 4.0, -4.0), fall(DVec3::Y * 0.1, 0.0));
    let answer = query([&a, &b], [&one, &other], Window::UNIT, &options);
    let falling = ConstantTwist::REST.with_position(DVec3::X * 4.0).with_linear_velocity(DVec3::X * -4.0);
    let still = ConstantTwist::REST.with_position(DVec3::Y * 0.1);
    let exact = query([&a, &b], [&falling, &still], Window::UNIT, &options);
    let (answer, exact) = (answer.contact().unwrap(), exact.contact().unwrap());
    assert!((answer.time_lo - exact.time_lo).abs() < 1e-9, "{answer:?} {exact:?}");
    assert!((answer.closing_speed - exact.closing_speed).abs() < 1e-9);
}

#[test]
fn links_of_one_arm_are_seen_from_their_common_joint() {
    let (a, b) = (cube(0.3), cube(0.3));
    // The base shakes; the second link turns towards the first.
    let mut random = KnuthRandom(33);
    let base = arm(&mut random, 4, DVec3::ZERO, 0.0).joints().to_vec();
    let first = Chain::try_new([base.clone(), vec![fixed(DVec3::X)]].concat()).unwrap();
    let bend = revolute(DVec3::ZERO, DVec3::Z, polynomial(&[1.5, -1.0]));
    let second = Chain::try_new([base.clone(), vec![bend.clone(), fixed(DVec3::X)]].concat()).unwrap();
    let options = QueryOptions::default().with_tolerance(DELTA);
    let answer = query([&a, &b], [&first, &second], Window::UNIT, &options);
    let alone = [
        Chain::try_new(vec![fixed(DVec3::X)]).unwrap(),
        Chain::try_new(vec![bend, fixed(DVec3::X)]).unwrap(),
    ];
    let seen = query([&a, &b], [&alone[0], &alone[1]], Window::UNIT, &options);
    let (answer, seen) = (*answer.contact().unwrap(), *seen.contact().unwrap());
    assert_eq!(answer.time_lo, seen.time_lo);
    judge([&a, &b], [&first, &second], (Window::UNIT, DVec3::ZERO), &TimeOfContact::Contact(answer)).unwrap();
    let rest = query([&a, &b], [&first, &first], Window::UNIT, &options);
    assert_eq!(rest.contact().unwrap().start, StartState::Overlapping);
    let frame = Chain::try_new(base).unwrap().pose_and_twist(answer.time_lo).0;
    assert!((frame.transform_point(seen.point_a) - answer.point_a).length() < 1e-12);
}

/// Positions that are only known to a width, at all times.
#[test]
fn blurred_enclosures_are_never_wrong() {
    let (a, b) = (cube(1.0), cube(1.0));
    for width in [0.0, 1e-12, 1e-9, 1e-6, 1e-3, 0.1] {
        for clearance in [-0.1, 1e-9, 1e-6, 1e-3, 0.1, 0.5] {
            let start = DVec3::new(-3.0, 2.0 + clearance, 0.0);
            let motion = Blurred::by(
                ConstantTwist::REST.with_position(start).with_linear_velocity(DVec3::X * 6.0),
                width,
            );
            let answer =
                query([&a, &b], [&motion, &ConstantTwist::REST], Window::UNIT, &QueryOptions::default());
            let name = format!("width {width:e}, clearance {clearance:e}: {answer:?}");
            match answer {
                TimeOfContact::Contact(contact) => {
                    assert!(clearance < 3.5 * contact.tolerance && contact.tolerance < 1e-9, "{name}");
                }
                TimeOfContact::Separated => assert!(clearance > width, "{name}"),
                TimeOfContact::Undecided { clear_until } => {
                    assert!(
                        width >= 1e-12 && clearance < 8.0 * width && clear_until < 1.0 / 6.0 + 1e-9,
                        "{name}"
                    );
                }
            }
            if clearance > 16.0 * width.max(1e-9) {
                assert!(answer.is_separated(), "{name}");
            }
        }
    }
}

#[test]
fn modes_separations_and_windows_hold_for_every_motion() {
    let (a, b) = (torus(20, 10, 0.5), torus(16, 8, 0.8));
    let mut random = KnuthRandom(35);
    let mut hits = 0;
    for round in 0..40 {
        let link = arm(&mut random, 3, DVec3::ZERO, 0.0);
        let still = ConstantTwist::REST.with_position(random.vector().normalize() * 2.3);
        let motions: [&dyn RigidMotion; 2] = [&link, &still];
        if distance_at([&a, &b], motions, 0.0, DVec3::ZERO).lower < 0.2 {
            continue;
        }
        let options = QueryOptions::default().with_tolerance(DELTA);
        let accurate = query([&a, &b], motions, Window::UNIT, &options);
        let exists = query([&a, &b], motions, Window::UNIT, &options.with_mode(Mode::Exists));
        assert_eq!(accurate.contact().is_some(), exists.contact().is_some());
        let early = query([&a, &b], motions, Window::UNIT, &options.with_mode(Mode::Capoeira));
        let far = query([&a, &b], motions, Window::UNIT, &options.with_min_separation(0.1));
        if let Some(contact) = accurate.contact() {
            hits += 1;
            let early = early.contact().expect("a contact has a pair of near triangles");
            assert!(early.time_lo <= contact.time_hi);
            let Distance { lower: low, upper: high, .. } =
                distance_at([&a, &b], motions, early.time_lo, DVec3::ZERO);
            assert!(low > 0.0 && high < 0.6, "round {round}");
            let far = far.contact().expect("nearer than a contact");
            let Distance { lower: low, upper: high, .. } =
                distance_at([&a, &b], motions, far.time_lo, DVec3::ZERO);
            assert!(low > 0.1 && high < 0.1 + 4.0 * DELTA, "round {round}: {low} {high}");
        }
        if let Some(contact) = far.contact() {
            for k in 0..100 {
                let t = contact.time_lo * f64::from(k) / 100.0;
                assert!(distance_at([&a, &b], motions, t, DVec3::ZERO).lower > 0.1);
            }
        }
        let mut before = 0.0;
        for budget in [0, 10, 100, 1000, 10_000, 1_000_000] {
            let limited = options.with_budget(d2m_bvh::Budget::default().with_node_tests(budget));
            match query([&a, &b], motions, Window::UNIT, &limited) {
                TimeOfContact::Undecided { clear_until } => {
                    assert!(clear_until >= before);
                    before = clear_until;
                    assert!(clear_until <= accurate.contact().map_or(1.0, |c| c.time_lo));
                }
                decided => assert_eq!(decided, accurate),
            }
        }
    }
    assert!(hits > 5, "{hits}");
    let value = JointValue::try_pieces(vec![0.0, 1.0], vec![vec![0.0, 1.0]]).unwrap();
    let link = Chain::try_new(vec![revolute(DVec3::ZERO, DVec3::Z, value)]).unwrap();
    let outside = Window::try_new(0.0, 1.5).unwrap();
    let (a, b) = (
        Moving::new(&a, &link as &dyn RigidMotion),
        Moving::new(&b, &ConstantTwist::REST as &dyn RigidMotion),
    );
    let error = time_of_contact(a, b, outside, &QueryOptions::default()).unwrap_err();
    let outside = OutsideDomain { start: 0.0, end: 1.0, from: 0.0, to: 1.5 };
    assert_eq!(error, QueryError::OutsideMotion { body: 0, outside });
}

/// Bodies inside each other, at the start and never.
#[test]
fn a_body_inside_another_is_in_contact() {
    let (big, small) = (cube(4.0), cube(0.5));
    let spinning =
        Chain::try_new(vec![revolute(DVec3::ZERO, DVec3::Z, polynomial(&[0.0, 1.0, 1.0])), fixed(DVec3::X)])
            .unwrap();
    let options = QueryOptions::default();
    let rest = ConstantTwist::REST;
    let filled = query([&small, &big], [&spinning, &rest], Window::UNIT, &options);
    let contact = filled.contact().unwrap();
    assert_eq!(
        (contact.start, contact.evidence, contact.time_lo),
        (StartState::Contained, Evidence::Crossing, 0.0)
    );
    assert!(
        query([&small, &big], [&spinning, &rest], Window::UNIT, &options.with_solid(Solid::Surface))
            .is_separated()
    );
}

#[test]
fn moving_frames_and_their_contents_meet() {
    let (a, b) = (torus(12, 7, 0.5), torus(16, 8, 0.8));
    let mut random = KnuthRandom(36);
    let options = QueryOptions::default().with_tolerance(DELTA);
    for round in 0..40 {
        let turn = |random: &mut KnuthRandom| {
            ConstantTwist::try_new(
                random.vector(),
                random.moderate_turn(),
                random.vector() * 2.0,
                random.vector() * 3.0,
            )
            .unwrap()
        };
        let motion = Composed::new(turn(&mut random), turn(&mut random));
        let still = ConstantTwist::REST.with_position(random.vector().normalize() * 3.0);
        if distance_at([&a, &b], [&motion, &still], 0.0, DVec3::ZERO).lower < 1e-3 {
            continue;
        }
        let answer = query([&a, &b], [&motion, &still], Window::UNIT, &options);
        judge([&a, &b], [&motion, &still], (Window::UNIT, DVec3::ZERO), &answer)
            .unwrap_or_else(|fault| panic!("round {round}: {fault}"));
    }
}
