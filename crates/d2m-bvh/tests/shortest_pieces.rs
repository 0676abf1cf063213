//! Pieces of motions that last from one number for a time to the next.

use d2m_bvh::{
    ClearanceOptions, ClearanceStatus, Evidence, MeshTree, Mode, Moving, PairCache, QueryOptions, Solid,
    SpanStatus, TimeOfContact, TriMesh, Window, clearance, contact_exists, contact_spans, time_of_contact,
    time_of_contact_with,
};
use d2m_motion::{
    Chain, Composed, ConstantTwist, Joint, JointKind, JointValue, Keyframes, Pose, Retimed, RigidMotion,
    Span, Spline, SplineDegree, Twist,
};
use d2m_testing::Opaque;
use glam::{DQuat, DVec3};

fn cube() -> MeshTree {
    let vertices =
        (0..8).map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) - 0.5);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
    MeshTree::new(TriMesh::try_new(vertices.collect(), triangles).unwrap())
}

fn slide(value: JointValue) -> Chain {
    let kind = JointKind::Prismatic { axis: DVec3::X, value };
    Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap()
}

/// From 0 to `reach` along x within the first piece, at rest in the second, as every kind of motion.
fn motions(times: [f64; 3], reach: f64) -> Vec<(&'static str, Box<dyn RigidMotion + Send>)> {
    let u = times[1] - times[0];
    let value = |c: Vec<f64>| JointValue::try_pieces(times.to_vec(), vec![c, vec![reach]]).unwrap();
    let steady = || slide(value(vec![0.0, reach / u]));
    // Only smooth motions can be retimed: on the way for both pieces.
    let smooth = JointValue::try_pieces(vec![times[0], times[2]], vec![vec![0.0, 0.5 * reach / u]]).unwrap();
    let pose = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
    let frames = [(times[0], pose(0.0)), (times[1], pose(reach)), (times[2], pose(reach))];
    let resting = frames.map(|(t, pose)| (t, pose, Twist { linear: DVec3::ZERO, angular: DVec3::ZERO }));
    let spline = |degree| Box::new(Spline::try_with_twists(&resting, degree).unwrap());
    vec![
        ("chain", Box::new(steady())),
        (
            "smooth chain",
            Box::new(slide(value(vec![0.0, 0.0, 3.0 * reach / (u * u), -2.0 * reach / (u * u * u)]))),
        ),
        ("cubic spline", spline(SplineDegree::Cubic)),
        ("quintic spline", spline(SplineDegree::Quintic)),
        ("keyframes", Box::new(Keyframes::try_new(&frames, Span::Linear).unwrap())),
        ("retimed", Box::new(Retimed::try_new(slide(smooth), 1.0, 0.0).unwrap())),
        ("composed", Box::new(Composed::new(ConstantTwist::REST, steady()))),
        ("own", Box::new(Opaque(steady()))),
    ]
}

/// Numbers for time at odd and even places, from coarse to fine ones.
fn times() -> impl Iterator<Item = [f64; 3]> {
    [-3, 0, 1, 30, 52, 53, 54, 60].into_iter().flat_map(|e| {
        let (base, u) = (2f64.powi(e), 2f64.powi(e - 52));
        [0.0, 1.0].map(|odd| [odd, odd + 1.0, odd + 2.0].map(|k| base + k * u))
    })
}

#[test]
fn what_is_passed_between_two_numbers_is_met() {
    let cube = cube();
    let wall = ConstantTwist::REST.with_position(DVec3::X * 5.0);
    for times in times() {
        let window = Window::try_new(times[0], times[2]).unwrap();
        for (name, motion) in motions(times, 10.0) {
            let bodies = [Moving::new(&cube, &*motion), Moving::new(&cube, &wall)];
            for bodies in [bodies, [bodies[1], bodies[0]]] {
                let [a, b] = bodies;
                for mode in [Mode::Accurate, Mode::Exists] {
                    let options = QueryOptions::default().with_mode(mode);
                    let answer = time_of_contact(a, b, window, &options).unwrap();
                    let TimeOfContact::Contact(contact) = answer else {
                        panic!("{name} from {:?}: {answer:?}", times[0])
                    };
                    assert_eq!([contact.time_lo, contact.time_hi][0], times[0], "{name}: {contact:?}");
                    assert!(contact.time_hi <= times[1], "{name}: {contact:?}");
                    // What is left is 4, and the tolerance says so.
                    assert!(contact.separation <= 3.3 * contact.tolerance, "{name}: {contact:?}");
                    assert!(contact.evidence >= Evidence::Near, "{name}: {contact:?}");
                    let mut cache = PairCache::new();
                    for _ in 0..2 {
                        let same = time_of_contact_with(a, b, window, &options, &mut cache).unwrap();
                        assert_eq!(same, answer, "{name}");
                        let exists = contact_exists(a, b, window, &options, &mut cache).unwrap();
                        assert_eq!(exists, Some(true), "{name}");
                    }
                }
            }
        }
    }
}

/// What is not on the way is not met, and what is behind the end neither.
#[test]
fn what_is_beside_the_way_is_not_met() {
    let cube = cube();
    // Enclosures of polynomials over the whole of a piece are wide.
    for wall in [DVec3::Y * 4000.0, DVec3::X * 4000.0, DVec3::X * -4000.0] {
        let wall = ConstantTwist::REST.with_position(wall);
        for times in times() {
            let window = Window::try_new(times[0], times[2]).unwrap();
            for (name, motion) in motions(times, 10.0) {
                let (a, b) = (Moving::new(&cube, &*motion), Moving::new(&cube, &wall));
                let answer = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
                assert!(answer.is_separated(), "{name} from {:?}: {answer:?}", times[0]);
            }
        }
    }
}

/// The same within one piece of eight numbers, faster and faster: no joint of pieces is there that would be examined besides.
#[test]
fn what_is_passed_between_two_numbers_of_a_piece_is_met() {
    let cube = cube();
    for [begin, next, _] in times() {
        let u = next - begin;
        let place = |k: f64| 10.0 * k + 2.0 * k.powi(3);
        let times = vec![begin, begin + 8.0 * u];
        let value = JointValue::try_pieces(times, vec![vec![0.0, 10.0 / u, 0.0, 2.0 / (u * u * u)]]).unwrap();
        let motion = slide(value);
        let own = Opaque(motion.clone());
        for motion in [&motion as &(dyn RigidMotion + Send), &own] {
            for k in [0.0, 1.0, 4.0] {
                let wall = ConstantTwist::REST.with_position(DVec3::X * (0.5 * (place(k) + place(k + 1.0))));
                let (a, b) = (Moving::new(&cube, motion), Moving::new(&cube, &wall));
                let window = Window::try_new(begin, begin + 8.0 * u).unwrap();
                let answer = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
                let TimeOfContact::Contact(contact) = answer else { panic!("{begin}, {k}: {answer:?}") };
                let (from, to) = (begin + k * u, begin + (k + 1.0) * u);
                assert!(from <= contact.time_hi && contact.time_lo <= to, "{begin}, {k}: {contact:?}");
            }
        }
    }
}

/// What lies between two numbers is not decided there, and says nothing of the bodies after it: they are far from each other to the end.
#[test]
fn what_is_passed_between_two_numbers_is_no_contact_after_it() {
    let cube = cube();
    let wall = ConstantTwist::REST.with_position(DVec3::X * 5.0);
    for [begin, next, _] in times() {
        let unit = next - begin;
        let times = [begin, next, begin + 1024.0 * unit];
        let window = Window::try_new(begin, times[2]).unwrap();
        for (name, motion) in motions(times, 10.0) {
            // One of them goes at half the speed, and is at the wall then.
            let is_met = (motion.pose_and_twist(next).0.translation.x - 5.0).abs() <= 1.0;
            let first = if is_met { SpanStatus::Contact } else { SpanStatus::Undecided };
            let bodies = [Moving::new(&cube, &*motion), Moving::new(&cube, &wall)];
            for [a, b] in [bodies, [bodies[1], bodies[0]]] {
                let spans = contact_spans(a, b, window, &QueryOptions::default(), Some(2.0 * unit)).unwrap();
                let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
                assert_eq!(statuses, [first, SpanStatus::Clear], "{name}: {spans:?}");
                assert!(spans[0].to <= begin + 4.0 * unit, "{name}: {spans:?}");
            }
        }
    }
}

/// Cubes that pass through each other between two numbers for time, there and back, at little distances before and after: the tolerance of
/// their clearance says how wide it is, though the first time is not the one at which they are closest.
#[test]
fn a_clearance_between_two_numbers_is_as_wide_as_its_tolerance() {
    let cube = cube();
    let unit = 2f64.powi(-33);
    let at = |k: f64| -1e6 + k * unit;
    let mut wide = 0;
    for part in 1..=20 {
        // So far apart there, and on the way back; turned around after a hundred numbers.
        let (there, back) = (0.02 + 0.002 * f64::from(part), 0.005);
        let speed = 2.0 + 2.0 * there;
        let turn = -1.0 - there + 100.0 * speed;
        let pieces = vec![
            vec![-1.0 - there - 100.0 * speed, speed / unit],
            vec![turn, (1.0 + back - turn) / (98.0 * unit)],
        ];
        let motion = slide(JointValue::try_pieces(vec![at(0.0), at(200.0), at(400.0)], pieces).unwrap());
        let (motion, rest) = (Opaque(motion), ConstantTwist::REST);
        let window = Window::try_new(at(0.0), at(400.0)).unwrap();
        let bodies = [Moving::new(&cube, &motion), Moving::new(&cube, &rest)];
        for [a, b] in [bodies, [bodies[1], bodies[0]]] {
            let found = clearance(a, b, window, &ClearanceOptions::default()).unwrap();
            assert_eq!((found.status, found.lower), (ClearanceStatus::Contact, 0.0), "{part}: {found:?}");
            assert!(found.upper <= 4.0 * found.tolerance, "{part}: {found:?}");
            wide += u32::from(found.upper > 0.9 * there);
        }
    }
    assert!(wide > 20, "{wide}");
}

/// A blade above a plate turns down to it from one number for time to the next, at rest at first: what is proven of the way is above a level,
/// and the bound of the clearance counts no more than that.
#[test]
fn a_clearance_between_two_numbers_is_no_more_than_what_is_left_at_its_end() {
    let corners = vec![DVec3::NEG_X, DVec3::X, DVec3::Z * 0.01];
    let blade = MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap());
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]].map(|[x, z]| DVec3::new(x, 0.0, z));
    let plate = MeshTree::new(TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]).unwrap());
    let options = ClearanceOptions::default().with_accuracy(1.0).with_solid(Solid::Surface);
    for [begin, next, _] in times() {
        let unit = next - begin;
        for part in [0.84, 0.86, 0.88] {
            // The blade's end is lowered by this part of the height, all but what the third power of the angle is.
            let (angle, height) = (0.1, 0.1 / part);
            let value =
                JointValue::try_pieces(vec![begin, next], vec![vec![0.0, 0.0, angle / (unit * unit)]]);
            let kind = JointKind::Revolute { axis: DVec3::Z, value: value.unwrap() };
            let joint = Joint::try_new(DVec3::Y * height, DQuat::IDENTITY, kind).unwrap();
            let (turning, rest) = (Chain::try_new(vec![joint]).unwrap(), ConstantTwist::REST);
            let left = turning.pose_and_twist(next).0.transform_point(DVec3::NEG_X).y;
            let bodies = [Moving::new(&blade, &turning), Moving::new(&plate, &rest)];
            for [a, b] in [bodies, [bodies[1], bodies[0]]] {
                let found = clearance(a, b, Window::try_new(begin, next).unwrap(), &options).unwrap();
                assert!(found.lower <= left && left <= height, "{begin}, {part}: {found:?}, {left}");
            }
        }
    }
}

/// Cubes that meet between two numbers, and are further apart at the later one: a span of contact begins and ends within the resolution of a time
/// at which they are near.
#[test]
fn a_contact_between_two_numbers_is_one_within_the_resolution() {
    let cube = cube();
    let wall = ConstantTwist::REST.with_position(DVec3::X * 5.0);
    let places = [4.0 - 2e-10, 6.9, 5.9, 5.0, 5.0];
    let gap = |k: f64| {
        let piece = k.clamp(0.0, 3.0) as usize;
        let place = places[piece] + (k - piece as f64) * (places[piece + 1] - places[piece]);
        (place - 5.0).abs() - 1.0
    };
    for [begin, next, _] in times() {
        let unit = next - begin;
        let at = |k: u32| begin + f64::from(k) * unit;
        let pieces = places.windows(2).map(|w| vec![w[0], (w[1] - w[0]) / unit]).collect();
        let sliding = slide(JointValue::try_pieces((0..=4).map(at).collect(), pieces).unwrap());
        let composed = Composed::new(ConstantTwist::REST, sliding.clone());
        for motion in [&sliding as &(dyn RigidMotion + Send), &composed] {
            for resolution in [0.125, 0.5, 1.0] {
                let bodies = [Moving::new(&cube, motion), Moving::new(&cube, &wall)];
                for [a, b] in [bodies, [bodies[1], bodies[0]]] {
                    let window = Window::try_new(begin, at(4)).unwrap();
                    let spans =
                        contact_spans(a, b, window, &QueryOptions::default(), Some(resolution * unit))
                            .unwrap();
                    let contacts = spans.iter().filter(|span| span.status == SpanStatus::Contact);
                    for time in contacts.flat_map(|span| [span.from, span.to]) {
                        let around =
                            (-64..=64).map(|j| (time - begin) / unit + resolution * f64::from(j) / 64.0);
                        let least = around.map(|k| gap(k.clamp(0.0, 4.0))).fold(f64::INFINITY, f64::min);
                        assert!(least < 1e-9, "{begin}, {resolution}: {least}, {spans:?}");
                    }
                    assert_eq!(spans[spans.len() - 1].status, SpanStatus::Contact, "{spans:?}");
                }
            }
        }
    }
}
