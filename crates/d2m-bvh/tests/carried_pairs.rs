//! Bodies that one motion carries together stay as they are, however fast it is: queries of every kind say so after a few tests. What only seems
//! to be one motion is searched.

use d2m_bvh::{
    Budget, ClearanceOptions, ClearanceStatus, MeshTree, Moving, PairCache, QueryError, QueryOptions,
    SpanStatus, Start, StartState, TriMesh, Window, clearance, contact_exists, contact_spans, departure,
    time_of_contact, time_of_contact_batch, time_of_contact_counted, time_of_contact_with,
};
use d2m_feature::triangle_distance;
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{
    Chain, Composed, ConstantTwist, IntervalPose, IntervalTwist, Joint, JointKind, JointValue, Pose,
    RigidMotion, Spline, SplineDegree, Twist,
};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

/// What a query of bodies at rest takes, with room.
const FEW_TESTS: u64 = 20_000;

fn cuboid_at(center: DVec3, half: f64) -> MeshTree {
    MeshTree::new(Surface::cuboid(center - half, center + half).into_mesh(TriMesh::try_new))
}

/// Turns by hundreds of radians.
fn joint(place: DVec3, axis: DVec3, rate: f64) -> Joint {
    let value = JointValue::try_polynomial(vec![0.1, rate, -0.3 * rate]).unwrap();
    Joint::try_new(place, DQuat::from_rotation_x(0.4), JointKind::Revolute { axis, value }).unwrap()
}

/// Two joints, the second one on an arm of length one; anew each time.
fn fast_chain() -> Chain {
    Chain::try_new(vec![joint(DVec3::Y, DVec3::Z, 400.0), joint(DVec3::X, DVec3::Y, 250.0)]).unwrap()
}

fn fast_spline() -> Spline {
    let mut random = KnuthRandom(5);
    let pose = |translation, rotation| Pose { translation, rotation, at: DVec3::ZERO };
    let poses = (0..40).map(|_| pose(random.vector() * 3.0, random.moderate_turn().normalize()));
    let keys: Vec<_> = poses.enumerate().map(|(k, pose)| (k as f64 / 39.0, pose)).collect();
    Spline::try_through(&keys, SplineDegree::Cubic).unwrap()
}

fn fast_twist() -> ConstantTwist {
    ConstantTwist::REST
        .with_position(DVec3::new(0.3, 2.0, -1.0))
        .with_linear_velocity(DVec3::X * 7.0)
        .with_angular_velocity(DVec3::new(200.0, 90.0, -170.0))
}

/// The distance of two surfaces with one pose, by all pairs of triangles.
fn at_rest(a: &MeshTree, b: &MeshTree) -> f64 {
    let corners = |tree: &MeshTree| -> Vec<_> {
        (0..tree.mesh().triangle_count()).map(|t| tree.mesh().corners(t)).collect()
    };
    let (a, b) = (corners(a), corners(b));
    let pairs = a.iter().flat_map(|s| b.iter().map(move |t| triangle_distance(s, t).upper));
    pairs.fold(f64::INFINITY, f64::min)
}

/// Boxes a millionth apart, in touch and in each other, with equal chains, with one spline and with equal twists.
#[test]
fn what_one_motion_carries_stays_as_it_is() {
    let (chains, spline) = ([fast_chain(), fast_chain()], fast_spline());
    let twists = [fast_twist(), fast_twist()];
    let motions: [[&dyn RigidMotion; 2]; 3] =
        [[&chains[0], &chains[1]], [&spline, &spline], [&twists[0], &twists[1]]];
    let first = cuboid_at(DVec3::ZERO, 0.5);
    let budget = Budget::UNLIMITED.with_node_tests(FEW_TESTS);
    let options = QueryOptions::default().with_tolerance(1e-9).with_budget(budget);
    for (kind, [of_a, of_b]) in motions.into_iter().enumerate() {
        for gap in [1e-6, 0.0, -0.25, -1.0] {
            let second = cuboid_at(DVec3::X * (1.0 + gap), 0.5);
            let [a, b] = [Moving::new(&first, of_a), Moving::new(&second, of_b)];
            let distance = at_rest(&first, &second);
            assert_eq!(distance > 0.0, gap > 0.0);
            let found = time_of_contact_counted(a, b, Window::UNIT, &options).unwrap();
            let answer = time_of_contact_with(a, b, Window::UNIT, &options, &mut PairCache::new()).unwrap();
            let batch = time_of_contact_batch(&[(a, b), (a, b)], Window::UNIT, &options);
            assert_eq!((found.answer, Ok(found.answer)), (answer, batch[1]), "{kind}, {gap}");
            let exists = contact_exists(a, b, Window::UNIT, &options, &mut PairCache::new()).unwrap();
            assert_eq!(exists, Some(gap <= 0.0), "{kind}, {gap}");
            let parting = departure(a, b, Window::UNIT, &options).unwrap();
            let leaving = time_of_contact(a, b, Window::UNIT, &options.with_start(Start::Leave)).unwrap();
            assert_eq!(parting.answer, leaving);
            let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
            assert_eq!(spans.len(), 1, "{kind}, {gap}: {spans:?}");
            let nearest = ClearanceOptions::default().with_budget(budget);
            let nearest = clearance(a, b, Window::UNIT, &nearest).unwrap();
            if gap > 0.0 {
                assert!(found.answer.is_separated() && parting.answer.is_separated(), "{kind}");
                assert_eq!((parting.start, spans[0].status), (StartState::Apart, SpanStatus::Clear));
                assert_eq!(nearest.status, ClearanceStatus::Clear, "{kind}");
                assert!(nearest.lower <= distance && distance <= nearest.upper && nearest.lower > 0.9 * gap);
                let across = (nearest.point_b - nearest.point_a).length();
                assert!((across - distance).abs() < 1e-12, "{kind}: {across}");
            } else {
                let contact = found.answer.contact().expect("they share points");
                assert_eq!((contact.time_lo, spans[0].status), (0.0, SpanStatus::Contact), "{kind}, {gap}");
                assert_eq!((parting.left, nearest.status), (None, ClearanceStatus::Contact), "{kind}, {gap}");
                let left = parting.answer.contact().expect("they never part");
                for contact in [contact, left] {
                    let corners = first.mesh().corners(contact.triangle_a as usize);
                    let [x, y, z] = contact.barycentric_a;
                    let point = corners[0] * x + corners[1] * y + corners[2] * z;
                    let place = of_a.pose_and_twist(contact.time_lo).0.transform_point(point);
                    assert!((place - contact.point_a).length() < 1e-12, "{kind}, {gap}: {contact:?}");
                }
            }
        }
    }
}

/// Another motion at the address of the one that it holds: pushed along x by 4 in unit time.
#[repr(transparent)]
struct Pushed(Spline);

impl RigidMotion for Pushed {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let (pose, twist) = self.0.pose_and_twist(t);
        let pose = Pose { translation: pose.translation + DVec3::X * (4.0 * t - 2.0), ..pose };
        (pose, Twist { linear: twist.linear + DVec3::X * 4.0, ..twist })
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let pose = self.0.enclose_pose(t);
        let x = Interval::point(4.0) * t - Interval::point(2.0);
        IntervalPose { translation: pose.translation + IntervalVec3 { x, ..IntervalVec3::ZERO }, ..pose }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let twist = self.0.enclose_twist(t);
        let x = Interval::point(4.0);
        IntervalTwist { linear: twist.linear + IntervalVec3 { x, ..IntervalVec3::ZERO }, ..twist }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist_rate(t)
    }
    fn domain(&self) -> Interval {
        self.0.domain()
    }
    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.0.smooth_until(t)
    }
}

/// Twists with one number that differs, a chain with one joint more, a motion at the address of another one: the bodies meet.
#[test]
fn what_only_seems_one_motion_is_searched() {
    let (small, other) = (cuboid_at(DVec3::ZERO, 0.25), cuboid_at(DVec3::ZERO, 0.25));
    let window = Window::try_new(0.0, 1.0).unwrap();
    let meet = |a: &dyn RigidMotion, b: &dyn RigidMotion| {
        let [a, b] = [Moving::new(&small, a), Moving::new(&other, b)];
        let answer = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
        answer.contact().is_some_and(|contact| contact.time_lo > 1e-3)
    };
    let twist = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 20.0);
    let coming = twist.with_position(DVec3::X * 2.0).with_linear_velocity(DVec3::X * -3.0);
    let reversed = twist.with_angular_velocity(DVec3::Z * -20.0);
    assert!(meet(&twist, &coming) && meet(&reversed, &coming));
    let pushed = Pushed(fast_spline());
    assert!(meet(&pushed, &pushed.0) && meet(&pushed.0, &pushed));
    // A slide on the first link that comes in from outside.
    let base = fast_chain();
    let value = JointValue::try_polynomial(vec![2.0, -3.0]).unwrap();
    let kind = JointKind::Prismatic { axis: DVec3::X, value };
    let slide = base.and(Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()).unwrap();
    assert!(meet(&base, &slide) && meet(&slide, &base));
}

/// In one frame, given by equal twists, by one spline or by equal chains, that turns by hundreds of radians: as in a frame at rest.
#[test]
fn what_moves_in_one_frame_is_seen_from_there() {
    let (spline, chain, twist) = (fast_spline(), fast_chain(), fast_twist());
    let (first, second) = (cuboid_at(DVec3::ZERO, 0.5), cuboid_at(DVec3::ZERO, 0.25));
    let turning = ConstantTwist::REST.with_angular_velocity(DVec3::new(0.3, -0.2, 0.5));
    let budget = Budget::UNLIMITED.with_node_tests(FEW_TESTS);
    let options = QueryOptions::default().with_budget(budget);
    let wanted = ClearanceOptions::default().with_budget(budget);
    for (height, meets) in [(0.25, true), (0.875, false)] {
        let coming = ConstantTwist::REST
            .with_position(DVec3::new(2.0, 0.125, height))
            .with_linear_velocity(DVec3::new(-3.0, 0.0, 0.0))
            .with_angular_velocity(DVec3::X * 0.125);
        let at_rest = [Moving::new(&first, &turning), Moving::new(&second, &coming)];
        let [a, b] = at_rest;
        let alone = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        let nearest_alone = clearance(a, b, Window::UNIT, &wanted).unwrap();
        assert_eq!(alone.contact().is_some(), meets, "{alone:?}");
        let check = |kind: &str, outer: &dyn RigidMotion, motions: [&dyn RigidMotion; 2]| {
            let [a, b] = [Moving::new(&first, motions[0]), Moving::new(&second, motions[1])];
            let found = time_of_contact(a, b, Window::UNIT, &options).unwrap();
            let nearest = clearance(a, b, Window::UNIT, &wanted).unwrap();
            assert_eq!((nearest.lower, nearest.upper), (nearest_alone.lower, nearest_alone.upper), "{kind}");
            let frame = outer.pose_and_twist(nearest.time).0;
            let place = frame.transform_point(nearest_alone.point_b);
            assert!((nearest.point_b - place).length() < 1e-12, "{kind}: {nearest:?}");
            assert_eq!(alone.is_separated(), found.is_separated(), "{kind}");
            if let (Some(found), Some(alone)) = (found.contact(), alone.contact()) {
                assert_eq!((found.time_lo, found.time_hi), (alone.time_lo, alone.time_hi), "{kind}");
                let normal = outer.pose_and_twist(found.time_lo).0.transform_vector(alone.normal);
                assert!((found.normal - normal).length() < 1e-12, "{kind}: {found:?}");
            }
        };
        let twists = [Composed::new(twist, turning), Composed::new(twist, coming)];
        check("twists", &twist, [&twists[0], &twists[1]]);
        let chains = [Composed::new(chain.clone(), turning), Composed::new(fast_chain(), coming)];
        check("chains", &chain, [&chains[0], &chains[1]]);
        // In frames that differ, or of which nothing says that they are one, they are searched.
        let other = twist.with_position(twist.position() + DVec3::X * 1e-3);
        let apart = [Composed::new(twist, turning), Composed::new(other, coming)];
        let splines = [Composed::new(&spline, turning), Composed::new(&spline, coming)];
        let some = Window::try_new(0.0, 0.02).unwrap();
        let least = |[a, b]: [&dyn RigidMotion; 2]| {
            let [a, b] = [Moving::new(&first, a), Moving::new(&second, b)];
            clearance(a, b, some, &ClearanceOptions::default()).unwrap().upper
        };
        let known = least([&turning, &coming]);
        assert!((least([&apart[0], &apart[1]]) - known).abs() > 1e-5);
        assert!((least([&splines[0], &splines[1]]) - known).abs() < 1e-5 * known);
    }
}

/// With a coarse tolerance the normal is not quite the direction from one point to the other, so that the frame's turning moves them along it.
#[test]
fn points_close_as_the_world_sees_them() {
    let mut random = KnuthRandom(8);
    let (first, second) = (cuboid_at(DVec3::ZERO, 0.5), cuboid_at(DVec3::ZERO, 0.25));
    let options = QueryOptions::default().with_tolerance(0.02).with_min_separation(0.05);
    let (mut met, mut turned) = (0, 0);
    for round in 0..40 {
        let poses = |random: &mut KnuthRandom, center: DVec3| {
            let pose = |k: u32| {
                let translation = center * (1.0 - f64::from(k)) + random.vector() * 0.2;
                (f64::from(k), Pose { translation, rotation: random.moderate_turn(), at: DVec3::ZERO })
            };
            let keys = [0, 1, 2].map(pose);
            Spline::try_through(&keys, SplineDegree::Cubic).unwrap()
        };
        let inner = [DVec3::ZERO, random.vector() * 4.0].map(|center| poses(&mut random, center));
        let bodies = inner.each_ref().map(|inner| Composed::new(fast_twist(), inner));
        let links = inner.each_ref().map(|inner| Composed::new(fast_chain(), inner));
        let motions: [[&dyn RigidMotion; 2]; 2] = [[&bodies[0], &bodies[1]], [&links[0], &links[1]]];
        for [of_a, of_b] in motions {
            let (a, b) = (Moving::new(&first, of_a).with_radius(0.01), Moving::new(&second, of_b));
            let answer = time_of_contact(a, b, Window::try_new(0.0, 2.0).unwrap(), &options).unwrap();
            let Some(contact) = answer.contact().filter(|contact| contact.start == StartState::Apart) else {
                continue;
            };
            let velocity = |motion: &dyn RigidMotion, point: DVec3| {
                let (pose, twist) = motion.pose_and_twist(contact.time_lo);
                twist.velocity_of(point - pose.translation)
            };
            let [of_a, of_b] = [velocity(of_a, contact.point_a), velocity(of_b, contact.point_b)];
            let closing = (of_a - of_b).dot(contact.normal);
            assert!(
                (contact.closing_speed - closing).abs() < 1e-10 * (of_a.length() + of_b.length()),
                "{round}"
            );
            let between = contact.point_b - contact.point_a;
            met += 1;
            turned += u32::from(between.normalize().dot(contact.normal) < 1.0 - 1e-6);
        }
    }
    assert!(met > 20 && turned > 5, "{met} {turned}");
}

/// A link that turns by `rate` in unit time, and a slide on it that comes in to two tenths before the end.
fn links(rate: f64) -> [Chain; 2] {
    let base = Chain::try_new(vec![joint(DVec3::Y, DVec3::Z, rate)]).unwrap();
    let value = JointValue::try_polynomial(vec![2.0, -2.0]).unwrap();
    let kind = JointKind::Prismatic { axis: DVec3::X, value };
    let slide = base.and(Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()).unwrap();
    [base, slide]
}

/// Turns beyond what sines are known of: how the links meet is known, and where in the world they do is not.
#[test]
fn places_that_nothing_is_known_of_are_refused() {
    let box_of_links = cuboid_at(DVec3::ZERO, 0.25);
    let options = QueryOptions::default();
    let bad = QueryError::BadMotion { body: 0 };
    for (rate, is_known) in [(400.0, true), (1e20, false)] {
        let [base, slide] = links(rate);
        let [a, b] = [&base, &slide].map(|link| Moving::new(&box_of_links, link));
        let found = time_of_contact(a, b, Window::UNIT, &options);
        let cached = time_of_contact_with(a, b, Window::UNIT, &options, &mut PairCache::new());
        let leaving = time_of_contact(a, b, Window::UNIT, &options.with_start(Start::Leave));
        let parting = departure(a, b, Window::UNIT, &options).map(|parting| parting.answer);
        let nearest = clearance(a, b, Window::UNIT, &ClearanceOptions::default());
        assert_eq!(contact_exists(a, b, Window::UNIT, &options, &mut PairCache::new()), Ok(Some(true)));
        let early = Window::try_new(0.0, 0.5).unwrap();
        assert!(time_of_contact(a, b, early, &options).unwrap().is_separated());
        if !is_known {
            for answer in [found, cached, leaving, parting] {
                assert_eq!(answer, Err(bad));
            }
            assert_eq!(nearest, Err(bad));
            continue;
        }
        let contact = *found.unwrap().contact().expect("they meet");
        let nearest = nearest.unwrap();
        for (time, normal, points) in [
            (contact.time_lo, contact.normal, [contact.point_a, contact.point_b]),
            (nearest.time, nearest.normal, [nearest.point_a, nearest.point_b]),
        ] {
            let pose = base.pose_and_twist(time).0;
            assert!(
                (time - 0.75).abs() < 1e-9 && (normal - pose.transform_vector(DVec3::X)).length() < 1e-12
            );
            for point in points {
                let place = pose.inverse_transform_point(point);
                assert!((place.x - 0.25).abs() < 1e-9 && place.abs().max_element() < 0.25 + 1e-9);
            }
        }
    }
}

/// Says nothing of itself but its pose, in any numbers.
struct Posed(Pose);

impl RigidMotion for Posed {
    fn pose_and_twist(&self, _: f64) -> (Pose, Twist) {
        (self.0, Twist::ZERO)
    }
    fn enclose_pose(&self, _: Interval) -> IntervalPose {
        let any = IntervalVec3 { x: Interval::ENTIRE, y: Interval::ENTIRE, z: Interval::ENTIRE };
        IntervalPose { translation: any, ..IntervalPose::IDENTITY }
    }
    fn enclose_twist(&self, _: Interval) -> IntervalTwist {
        IntervalTwist { linear: IntervalVec3::ZERO, angular: IntervalVec3::ZERO }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.enclose_twist(t)
    }
}

/// A quaternion stands for the rotation that it has divided by its length; a pose that is no number places nothing.
#[test]
fn poses_of_any_numbers_place_what_they_carry() {
    let [first, second] = [0.0, 0.8].map(|x| cuboid_at(DVec3::X * x, 0.5));
    let turn = DQuat::from_rotation_z(0.7);
    let answers = |rotation: DQuat, at: DVec3| {
        let motion = Posed(Pose { rotation, translation: DVec3::Y, at });
        let [a, b] = [&first, &second].map(|tree| Moving::new(tree, &motion));
        let found = time_of_contact(a, b, Window::UNIT, &QueryOptions::default());
        let nearest = clearance(a, b, Window::UNIT, &ClearanceOptions::default());
        (found.map(|answer| answer.contact().copied()), nearest)
    };
    let (contact, nearest) = answers(turn, DVec3::ZERO);
    let (contact, nearest) = (contact.unwrap().expect("they overlap"), nearest.unwrap());
    for length in [1.0 + 1e-9, 3.0] {
        let (longer, wider) = answers(turn * length, DVec3::ZERO);
        let (longer, wider) = (longer.unwrap().expect("they overlap"), wider.unwrap());
        for (is, was) in [
            (
                [longer.normal, longer.point_a, longer.point_b],
                [contact.normal, contact.point_a, contact.point_b],
            ),
            (
                [wider.normal, wider.point_a, wider.point_b],
                [nearest.normal, nearest.point_a, nearest.point_b],
            ),
        ] {
            for (is, was) in is.into_iter().zip(was) {
                assert!((is - was).length() < 1e-14, "{length}: {is} {was}");
            }
        }
    }
    for (rotation, at) in [(turn * 0.0, DVec3::ZERO), (turn, DVec3::splat(f64::INFINITY))] {
        let (found, nearest) = answers(rotation, at);
        assert!(matches!(found, Ok(None) | Err(QueryError::BadMotion { .. })), "{found:?}");
        assert!(nearest.map_or(true, |nearest| nearest.status == ClearanceStatus::Undecided));
    }
}
