//! Planted truths, lies, and motions that enclose nothing.
use crate::closest::closest;
use crate::instant::Instant;
use crate::rates::lowest;
use crate::{Body, Claim, Mesh, Query, Reason, Solid, TimeSpan, Verdict, verify};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{
    CertifiedState, Chain, Composed, ConstantTwist, IntervalPose, IntervalTwist, Joint, JointKind,
    JointValue, Keyframes, Kinematics, Pose, RigidMotion, Span, Twist,
};
use d2m_testing::{Draw, KnuthRandom};
use glam::{DQuat, DVec3};

const STEPS: u64 = 100_000;

fn cuboid(low: DVec3, high: DVec3) -> Mesh {
    let corner = |k: usize| DVec3::select(glam::BVec3::new(k & 1 > 0, k & 2 > 0, k & 4 > 0), high, low);
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh::try_new(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner), &triangles).unwrap()
}

fn cube() -> Mesh {
    cuboid(DVec3::splat(-0.5), DVec3::splat(0.5))
}

fn body<'a>(mesh: &'a Mesh, motion: &'a dyn RigidMotion) -> Body<'a> {
    Body { mesh, motion, solid: Solid::Filled, radius: 0.0 }
}

fn between(from: f64, to: f64) -> TimeSpan {
    TimeSpan { from, to }
}

fn clear_until(to: f64) -> Claim {
    Claim::Clear { span: between(0.0, to), distance: 0.0 }
}

fn is_verified(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Verified { .. })
}

fn reason(verdict: Verdict) -> Option<Reason> {
    if let Verdict::Unproven { reason, .. } = verdict { Some(reason) } else { None }
}

/// The bound holds for parabolas (which attain it) and for less bent curves, and is not far below.
#[test]
fn the_bound_between_two_ends_holds_and_is_attained() {
    let mut random = KnuthRandom(3);
    let mut attained = 0;
    for _ in 0..20_000 {
        let [start, end] = [0; 2].map(|_| random.signed() * 2.0);
        let bend = 4.0 * random.signed().abs();
        let bound = lowest([start, end], bend);
        let at = |t: f64| start + (end - start) * t - bend * t * (1.0 - t);
        let least = (0..=64).map(|k| at(f64::from(k) / 64.0)).fold(f64::INFINITY, f64::min);
        assert!(bound <= least + 1e-15, "{start} {end} {bend}");
        attained += u32::from(bound > least - 1e-3 * (1.0 + bend));
    }
    assert!(attained > 19_000, "{attained}");
    assert_eq!(lowest([1e-10; 2], 0.0), 1e-10);
    assert!(lowest([1e-10; 2], 1e-160) > 0.99e-10);
    for nonsense in [f64::NAN, f64::INFINITY] {
        assert!(lowest([1.0; 2], nonsense) <= 0.0 && lowest([nonsense, 1.0], 1.0) <= 1.0);
    }
}

/// Cubes whose faces meet at t = ½, with every minimum separation, radius and speed, near the origin and far from it.
#[test]
fn planted_times_are_told_apart_to_rounding() {
    let cube = cube();
    let mut random = KnuthRandom(11);
    for round in 0..200 {
        let far = random.vector() * [0.0, 10.0, 1e6][round % 3];
        let turned = DQuat::from_rotation_y(0.3 * random.signed()).normalize();
        let speed = 1.0 + random.signed().abs();
        let (separation, radius) = ([0.0, 0.125][round % 2], [0.0, 0.25][round / 2 % 2]);
        // Aside, so that no face of one lies in a plane of the other.
        let apart = turned * DVec3::new(1.0 + separation + radius + 0.5 * speed, 0.1, 0.07);
        let rest = ConstantTwist::REST.with_position(far).with_orientation(turned);
        let moving = rest.with_position(far + apart).with_linear_velocity(turned * -DVec3::X * speed);
        let query = Query {
            bodies: [body(&cube, &rest), Body { radius, ..body(&cube, &moving) }],
            window: between(0.0, 1.0),
        };
        let clear = |to: f64| Claim::Clear { span: between(0.0, to), distance: separation };
        let known = [1e-12, 1e-12, 1e-7][round % 3];
        let early = verify(&query, &clear(0.5 - known), STEPS);
        assert!(is_verified(early), "round {round}: {early:?}");
        for late in [1e-6, 1e-3, 0.5] {
            match verify(&query, &clear(0.5 + late), STEPS) {
                Verdict::Refuted { time, distance, .. } => {
                    assert!(time > 0.5 - known && distance.hi() <= separation + 1e-100, "{time} {distance}");
                }
                other => panic!("round {round}, {late}: {other:?}"),
            }
        }
        let near = Claim::Within { span: between(0.4, 0.5 + known), distance: separation, triangles: None };
        let met = verify(
            &query,
            &Claim::Within { span: between(0.4, 0.6), distance: separation, triangles: None },
            STEPS,
        );
        assert!(is_verified(met), "round {round}: {met:?}");
        assert!(!matches!(verify(&query, &near, STEPS), Verdict::Refuted { .. }));
        let not_yet = Claim::Within { span: between(0.1, 0.4), distance: separation, triangles: None };
        assert!(matches!(verify(&query, &not_yet, STEPS), Verdict::Refuted { .. }));
    }
}

/// A bar that turns about its middle passes a post: whole turns in one window, and a gap that only the turn's speed decides.
#[test]
fn turning_bodies_are_followed() {
    let bar = cuboid(DVec3::new(-2.0, -0.1, -0.1), DVec3::new(2.0, 0.1, 0.1));
    let reach = (2.0f64 * 2.0 + 0.1 * 0.1).sqrt();
    let spinning = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 40.0);
    for (gap, meets) in [(1e-3, false), (1e-9, false), (-1e-6, true)] {
        let post = cuboid(DVec3::new(-0.2, -0.2, -0.2), DVec3::new(0.2, 0.2, 0.2));
        let at = ConstantTwist::REST.with_position(DVec3::new(reach + 0.2 + gap, 0.0, 0.15));
        let query = Query { bodies: [body(&bar, &spinning), body(&post, &at)], window: between(0.0, 1.0) };
        match verify(&query, &clear_until(1.0), 1 << 20) {
            Verdict::Verified { .. } => assert!(!meets, "{gap}"),
            Verdict::Refuted { distance, .. } => assert!(meets && distance.hi() < 1e-100, "{gap}"),
            open @ Verdict::Unproven { .. } => panic!("{gap} {open:?}"),
        }
    }
}

/// A bar that turns above a plate, in windows at whose ends it may be clear while it is not between them; and a plate that turns below.
#[test]
fn what_is_between_the_ends_is_seen() {
    let bar = cuboid(DVec3::new(-2.0, -0.1, -0.1), DVec3::new(2.0, 0.1, 0.1));
    let plate = cuboid(DVec3::new(-9.0, -9.0, -2.0), DVec3::new(9.0, 9.0, 0.0));
    let height = |above: f64, angle: f64| above - 2.0 * angle.sin().abs() - 0.1 * angle.cos().abs();
    let mut random = KnuthRandom(23);
    let mut counts = [0; 2];
    for round in 0..1500 {
        let [s, t] = [0; 2].map(|_| 3.2 * random.signed());
        let (from, to) = (s.min(t), s.max(t));
        let distance = [0.0, 0.3][round % 2];
        let above = [1.5, 2.2][round / 4 % 2];
        let least = (0..=400)
            .map(|k| height(above, from + (to - from) * f64::from(k) / 400.0))
            .fold(f64::MAX, f64::min);
        // Seen from the bar, or from the plate; and the same with a common turn of both.
        let common = [0.0, 3.0][round / 2 % 2] * DVec3::Y;
        let turning = ConstantTwist::REST.with_position(DVec3::Z * above);
        let (turning, below) = (
            turning.with_angular_velocity(DVec3::Y + common).with_linear_velocity(DVec3::ZERO),
            ConstantTwist::REST
                .with_at(DVec3::Z * above)
                .with_position(DVec3::Z * above)
                .with_angular_velocity(common),
        );
        let bodies = [body(&bar, &turning), body(&plate, &below)];
        let bodies = if round % 3 == 0 { [bodies[1], bodies[0]] } else { bodies };
        let claim = Claim::Clear { span: between(from, to), distance };
        let verdict = verify(&Query { bodies, window: between(from, to) }, &claim, STEPS);
        assert!(
            !is_verified(verdict) || least > distance - 1e-9,
            "{from} {to} {distance}: {least} {verdict:?}"
        );
        assert!(
            is_verified(verdict) || least < distance + 1e-3,
            "{from} {to} {distance}: {least} {verdict:?}"
        );
        counts[usize::from(is_verified(verdict))] += 1;
    }
    assert!(counts.iter().all(|&count| count > 20), "{counts:?}");
}

/// Soups of triangles at rest: what is proven of all of them at once is true of each two, and nearly as sharp.
#[test]
fn many_triangles_at_once_are_as_far_apart_as_each_two() {
    let mut random = KnuthRandom(29);
    for round in 0..300 {
        let mut soup = |count: usize, size: f64| {
            let vertices: Vec<DVec3> = (0..3 * count).map(|_| random.vector() * size).collect();
            let triangles: Vec<[u32; 3]> = (0..count as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
            Mesh::try_new(&vertices, &triangles).unwrap()
        };
        let (a, b) = (soup(1 + round % 20, 1.0), soup(1 + round % 7, 0.5));
        let at = ConstantTwist::REST.with_position(DVec3::new(1.9, 1.0, 0.3) * (0.5 + random.signed().abs()));
        let of = |mesh, motion| Body { solid: Solid::Surface, ..body(mesh, motion) };
        let bodies = [of(&a, &ConstantTwist::REST), of(&b, &at)];
        let now = Instant::new(&bodies, 0.5);
        let corners =
            |mesh: &Mesh| (0..mesh.triangle_count() as u32).map(|t| mesh.corners(t)).collect::<Vec<_>>();
        let pairs = corners(&a).into_iter().flat_map(|s| corners(&b).into_iter().map(move |t| [s, t]));
        let distance = pairs.map(|pair| now.distance(&pair)).reduce(Interval::min).unwrap();
        let clear = |distance| {
            let claim = Claim::Clear { span: between(0.5, 0.5), distance };
            verify(&Query { bodies, window: between(0.0, 1.0) }, &claim, STEPS)
        };
        assert!(!is_verified(clear(distance.hi() * (1.0 + 1e-12))), "{round}: {distance}");
        if distance.lo() > 1e-6 {
            assert!(is_verified(clear(distance.lo() * (1.0 - 1e-9))), "{round}: {distance}");
        }
    }
}

/// Sliding with faces in contact at a level, and along an edge, are a step or a few, not millions.
#[test]
fn sliding_at_a_constant_gap_is_cheap() {
    let (plate, slider) = (cuboid(DVec3::new(-9.0, -9.0, -1.0), DVec3::new(9.0, 9.0, 0.0)), cube());
    let sliding = ConstantTwist::REST
        .with_position(DVec3::new(-3.0, 0.0, 0.5 + 1e-9))
        .with_linear_velocity(DVec3::X * 6.0)
        .with_angular_velocity(DVec3::Z * 3.0);
    let query = Query {
        bodies: [body(&slider, &sliding), body(&plate, &ConstantTwist::REST)],
        window: between(0.0, 1.0),
    };
    match verify(&query, &clear_until(1.0), STEPS) {
        Verdict::Verified { steps } => assert!(steps < 20_000, "{steps}"),
        other => panic!("{other:?}"),
    }
    let near = Claim::Clear { span: between(0.0, 1.0), distance: 1.01e-9 };
    assert!(matches!(verify(&query, &near, STEPS), Verdict::Refuted { .. }));
}

#[test]
fn triangles_are_as_far_apart_as_they_are() {
    let cube = cube();
    let at = ConstantTwist::REST.with_position(DVec3::X * 3.0);
    let query =
        Query { bodies: [body(&cube, &ConstantTwist::REST), body(&cube, &at)], window: between(0.0, 1.0) };
    let apart = |triangles, least, most| Claim::Apart { time: 0.5, triangles, least, most };
    // The faces towards each other: 10, 11 at x = ½ and 8, 9 at x = −½.
    assert!(is_verified(verify(&query, &apart([10, 8], 2.0 - 1e-12, 2.0 + 1e-12), STEPS)));
    for (least, most) in [(2.001, 3.0), (0.0, 1.999)] {
        let verdict = verify(&query, &apart([10, 8], least, most), STEPS);
        assert!(
            matches!(verdict, Verdict::Refuted { distance, .. } if distance.contains(2.0)),
            "{verdict:?}"
        );
    }
    assert_eq!(reason(verify(&query, &apart([12, 8], 0.0, 9.0), STEPS)), Some(Reason::Malformed));
    assert!(!is_verified(verify(&query, &apart([10, 8], f64::NAN, f64::NAN), STEPS)));
}

/// An arm of eight joints among slanted axes, and a body at rest: what the enclosures of the poses leave open is in the width of a
/// distance once for either end, not multiplied as boxes of rotations multiply it.
#[test]
fn a_distance_is_as_wide_as_the_poses_are_open() {
    let cube = cube();
    let mut random = KnuthRandom(7);
    for _ in 0..50 {
        let joint = |random: &mut KnuthRandom| {
            let value = JointValue::try_polynomial(vec![random.signed() * 3.0, random.signed()]).unwrap();
            let kind = JointKind::Revolute { axis: random.direction(), value };
            Joint::try_new(random.vector() * 0.3, DQuat::IDENTITY, kind).unwrap()
        };
        let arm = Chain::try_new((0..8).map(|_| joint(&mut random)).collect()).unwrap();
        let at = random.vector() * 3.0;
        let rest = ConstantTwist::REST.with_position(at);
        let bodies = [body(&cube, &arm), body(&cube, &rest)];
        let (pose, _) = arm.pose_and_twist(0.5);
        let state = arm.enclose_state_about(0.5, pose.translation);
        let now = Instant::new(&bodies, 0.5);
        let half = 0.75_f64.sqrt(); // of a diagonal
        let rest = rest.enclose_state_about(0.5, pose.translation);
        let open = [state, rest].map(|of| of.position_radius + of.rotation_radius * half);
        // Four times that and more, were it boxes.
        let most = 2.25 * (open[0] + open[1]) + 32.0 * f64::EPSILON;
        for pair in [[0, 5], [3, 9], [10, 2], [7, 7]] {
            let corners = pair.map(|triangle| cube.corners(triangle));
            let found = now.distance(&corners);
            let placed =
                [corners[0].map(|p| pose.transform_point(p.mid())), corners[1].map(|p| p.mid() + at)];
            let about = closest(&placed[0], &placed[1]).gap.length();
            assert!((found.mid() - about).abs() < 1e-13, "{found:?} {about}");
            // The bodies may be anywhere in the balls.
            let least = state.position_radius + rest.position_radius - 1e-15;
            assert!(
                found.hi() - about >= least && about - found.lo() >= least,
                "{found:?} {about} {least:e}"
            );
            assert!(found.width() <= most, "{found:?}: {:e}, not {most:e}", found.width());
        }
    }
}

/// Solids: inside, in a cavity, in an open box, and a surface.
#[test]
fn what_is_inside_is_in_contact() {
    let (inner, outer) = (cube(), cuboid(DVec3::splat(-2.0), DVec3::splat(2.0)));
    let moved = ConstantTwist::REST.with_angular_velocity(DVec3::new(0.3, 0.1, 0.2));
    let of = |mesh, motion, solid| Body { solid, ..body(mesh, motion) };
    let verdict = |bodies, claim: &Claim| verify(&Query { bodies, window: between(0.0, 1.0) }, claim, STEPS);
    let held = Claim::Held { time: 0.0 };
    for swapped in [false, true] {
        let pair = |solid| {
            let bodies = [of(&outer, &ConstantTwist::REST, solid), of(&inner, &moved, Solid::Surface)];
            if swapped { [bodies[1], bodies[0]] } else { bodies }
        };
        assert!(matches!(verdict(pair(Solid::Filled), &clear_until(1.0)), Verdict::Refuted { .. }));
        assert!(is_verified(verdict(pair(Solid::Filled), &held)));
        assert!(is_verified(verdict(pair(Solid::Surface), &clear_until(1.0))));
        assert_eq!(reason(verdict(pair(Solid::Surface), &held)), Some(Reason::Solid));
    }
    // A cavity is a part that is inside out; the outer surface is repeated, which changes nothing.
    let mut vertices = outer.vertices.clone();
    vertices.extend(outer.vertices.iter().map(|&p| p * 2.0));
    let mut triangles: Vec<[u32; 3]> = outer.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    triangles.extend(outer.triangles.iter().map(|t| t.map(|v| v + 8)));
    triangles.extend(outer.triangles.iter().map(|&[a, b, c]| [b + 8, c + 8, a + 8]));
    let hollow = Mesh::try_new(&vertices, &triangles).unwrap();
    let bodies = [body(&hollow, &ConstantTwist::REST), body(&inner, &moved)];
    assert!(is_verified(verdict(bodies, &clear_until(1.0))));
    let open = Mesh::try_new(&outer.vertices, &outer.triangles[1..]).unwrap();
    let bodies = [body(&open, &ConstantTwist::REST), body(&inner, &moved)];
    assert_eq!(reason(verdict(bodies, &clear_until(1.0))), Some(Reason::Solid));
}

/// Through the other body and back again within one window: seen at the joint only.
#[test]
fn pieces_are_taken_one_after_the_other() {
    let cube = cube();
    let pose =
        |x: f64| Pose { rotation: DQuat::IDENTITY, translation: DVec3::new(x, 0.1, 0.07), at: DVec3::ZERO };
    for (deepest, meets) in [(1.0 + 1e-9, false), (1.0 - 1e-9, true), (-3.0, true)] {
        // Clear in the first piece; the third joint is the next number after the second.
        let times = [0.0, 0.25, 0.5, 0.5f64.next_up(), 1.0];
        let frames = times.into_iter().zip([3.0, 3.0, deepest, deepest, 3.0]).map(|(t, x)| (t, pose(x)));
        let motion = Keyframes::try_new(&frames.collect::<Vec<_>>(), Span::Screw).unwrap();
        let bodies = [body(&cube, &ConstantTwist::REST), body(&cube, &motion)];
        let verdict = verify(&Query { bodies, window: between(0.0, 1.0) }, &clear_until(1.0), STEPS);
        assert_eq!(matches!(verdict, Verdict::Refuted { .. }), meets, "{verdict:?}");
        assert_eq!(is_verified(verdict), !meets, "{verdict:?}");
        let beyond = verify(&Query { bodies, window: between(0.0, 1.5) }, &clear_until(0.1), STEPS);
        assert_eq!(reason(beyond), Some(Reason::OutsideMotion));
    }
}

/// A motion that falls on the other body, with something wrong.
struct Broken {
    motion: ConstantTwist,
    fault: Fault,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Fault {
    EmptyPose,
    NoNumberState,
    NegativeRadius,
    EmptyTwist,
    UnboundedRate,
    NoNumberKinematics,
    StandingPiece,
    NoNumberPiece,
}

impl RigidMotion for Broken {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.motion.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let mut pose = self.motion.enclose_pose(t);
        if self.fault == Fault::EmptyPose {
            pose.translation = IntervalVec3::new(Interval::EMPTY, Interval::EMPTY, Interval::EMPTY);
        }
        pose
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let mut twist = self.motion.enclose_twist(t);
        if self.fault == Fault::EmptyTwist {
            twist.linear.x = Interval::EMPTY;
        }
        twist
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let mut rate = self.motion.enclose_twist_rate(t);
        if self.fault == Fault::UnboundedRate {
            rate.angular.y = Interval::ENTIRE;
        }
        rate
    }
    fn enclose_state(&self, t: f64) -> CertifiedState {
        let now = Interval::point(t);
        let mut state = CertifiedState::from_enclosures(&self.enclose_pose(now), &self.enclose_twist(now));
        match self.fault {
            Fault::NoNumberState => state.position.x = f64::NAN,
            Fault::NegativeRadius => state.position_radius = -1.0,
            _ => {}
        }
        state
    }
    fn enclose_kinematics(&self, t: Interval) -> Kinematics {
        let (pose, twist, rate) = (self.enclose_pose(t), self.enclose_twist(t), self.enclose_twist_rate(t));
        let mut kinematics = Kinematics::from_enclosures(&pose, &twist, &rate);
        if self.fault == Fault::NoNumberKinematics {
            kinematics.linear.center = DVec3::NAN;
        }
        kinematics
    }
    fn smooth_until(&self, t: f64) -> Option<f64> {
        match self.fault {
            Fault::StandingPiece => Some(t),
            Fault::NoNumberPiece => Some(f64::NAN),
            _ => None,
        }
    }
}

/// Empty sets satisfy every predicate, and what is no number fails every comparison: neither proves anything. Bodies at rest, far apart, so
/// that nothing else could be the reason.
#[test]
fn enclosures_that_say_nothing_prove_nothing() {
    use Fault::{
        EmptyPose, EmptyTwist, NegativeRadius, NoNumberKinematics, NoNumberPiece, NoNumberState,
        StandingPiece, UnboundedRate,
    };
    let cube = cube();
    let motion = ConstantTwist::REST.with_position(DVec3::X * 9.0).with_linear_velocity(DVec3::Y);
    for (fault, expected) in [
        (EmptyPose, Reason::Enclosure),
        (NoNumberState, Reason::Enclosure),
        (NegativeRadius, Reason::Enclosure),
        (EmptyTwist, Reason::Enclosure),
        (UnboundedRate, Reason::TimeResolution),
        (NoNumberKinematics, Reason::TimeResolution),
        (StandingPiece, Reason::Pieces),
        (NoNumberPiece, Reason::Pieces),
    ] {
        let broken = Broken { motion, fault };
        for swapped in [false, true] {
            let bodies = [body(&cube, &broken), body(&cube, &ConstantTwist::REST)];
            let bodies = if swapped { [bodies[1], bodies[0]] } else { bodies };
            let verdict = verify(&Query { bodies, window: between(0.0, 1.0) }, &clear_until(1.0), STEPS);
            let expected = if fault == EmptyTwist { Reason::TimeResolution } else { expected };
            assert_eq!(reason(verdict), Some(expected), "{fault:?} {verdict:?}");
        }
    }
    let sound = Broken { motion, fault: Fault::EmptyPose };
    let bodies = [body(&cube, &sound.motion), body(&cube, &ConstantTwist::REST)];
    assert!(is_verified(verify(&Query { bodies, window: between(0.0, 1.0) }, &clear_until(1.0), STEPS)));
}

#[test]
fn numbers_out_of_order_are_malformed() {
    let cube = cube();
    let at = ConstantTwist::REST.with_position(DVec3::X * 3.0);
    let bodies = [body(&cube, &ConstantTwist::REST), body(&cube, &at)];
    let clear = |span, distance| Claim::Clear { span, distance };
    for (window, claim) in [
        (between(0.0, 1.0), clear(between(0.0, 1.5), 0.0)),
        (between(0.0, 1.0), clear(between(-0.5, 1.0), 0.0)),
        (between(0.0, 1.0), clear(between(0.5, 0.25), 0.0)),
        (between(0.0, 1.0), clear(between(f64::NAN, 1.0), 0.0)),
        (between(0.0, 1.0), clear(between(0.0, 1.0), -1.0)),
        (between(0.0, 1.0), clear(between(0.0, 1.0), f64::NAN)),
        (between(0.0, f64::INFINITY), clear(between(0.0, 1.0), 0.0)),
        (between(-f64::MAX, f64::MAX), clear(between(0.0, 1.0), 0.0)),
    ] {
        let verdict = verify(&Query { bodies, window }, &Claim::All(vec![claim.clone()]), STEPS);
        assert_eq!(reason(verdict), Some(Reason::Malformed), "{window:?} {claim:?}");
    }
    for radius in [-1.0, f64::NAN, f64::INFINITY] {
        let bodies = [Body { radius, ..bodies[0] }, bodies[1]];
        let verdict = verify(&Query { bodies, window: between(0.0, 1.0) }, &clear_until(1.0), STEPS);
        assert_eq!(reason(verdict), Some(Reason::Malformed));
    }
    // A window of no length, and one far away.
    for t in [0.5, 1e9] {
        let query = Query { bodies, window: between(t, t) };
        assert!(is_verified(verify(&query, &clear(between(t, t), 1.999), STEPS)), "{t}");
        assert!(matches!(verify(&query, &clear(between(t, t), 2.001), STEPS), Verdict::Refuted { .. }));
    }
    let few = verify(&Query { bodies, window: between(0.0, 1.0) }, &clear_until(1.0), 0);
    assert_eq!(few, Verdict::Unproven { clear_until: 0.0, reason: Reason::Steps, pair: None });
}

/// A cube goes through another one flush with its sides: no triangles cross, and what lasts is that they overlap.
#[test]
fn what_overlaps_without_crossing_triangles_is_proven_to_last() {
    let cube = cube();
    let through = ConstantTwist::REST.with_position(DVec3::X * -3.0).with_linear_velocity(DVec3::X * 6.0);
    let query = |to: f64| Query {
        bodies: [body(&cube, &through), body(&cube, &ConstantTwist::REST)],
        window: between(0.0, to),
    };
    let often = |from: f64, to: f64| Claim::Often { span: between(from, to), distance: 1e-10, every: 1e-6 };
    match verify(&query(1.0), &often(1.0 / 3.0, 2.0 / 3.0), STEPS) {
        Verdict::Verified { steps } => assert!(steps < STEPS / 2, "{steps}"),
        other => panic!("{other:?}"),
    }
    // Nothing lasts after they have parted, nor before they have met.
    for (from, to) in [(0.33, 0.66), (0.34, 0.67), (0.0, 1.0)] {
        assert!(!is_verified(verify(&query(1.0), &often(from, to), STEPS)), "{from} {to}");
    }
}

/// At the address of the twist that it holds, and half a length further along x.
#[repr(transparent)]
struct Beside(ConstantTwist);

impl Beside {
    fn twist(&self) -> ConstantTwist {
        self.0.with_position(self.0.position() + DVec3::X * 0.5)
    }
}

impl RigidMotion for Beside {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.twist().pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.twist().enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.twist().enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.twist().enclose_twist_rate(t)
    }
}

/// Boxes a thousandth apart that one fast motion carries, by one object and by equal numbers: what is true of them is proven in a few steps at the
/// end of a long time, what is false is refuted, and times of the motion still count.
#[test]
fn what_one_motion_carries_keeps_its_distance() {
    let pose = |x: f64, angle: f64| Pose::from_axis_angle(DVec3::X * x, DVec3::new(1.0, 2.0, -1.0), angle);
    let keys = [(0.0, pose(1e6, 0.0)), (1.0, pose(-2e6, 2.0)), (2.0, pose(3e6, -1.0))];
    let path = Keyframes::try_new(&keys, Span::Linear).unwrap();
    let spin = ConstantTwist::REST.with_position(DVec3::X * 1e6).with_angular_velocity(DVec3::splat(300.0));
    let [first, second] = [cube(), cuboid(DVec3::new(0.501, -0.5, -0.5), DVec3::new(1.501, 0.5, 0.5))];
    let ask = |[a, b]: [&dyn RigidMotion; 2], from: f64, to: f64, claim: &dyn Fn(TimeSpan) -> Claim| {
        let window = between(from, to);
        let query = Query { bodies: [body(&first, a), body(&second, b)], window };
        verify(&query, &claim(window), 100)
    };
    let clear = |distance: f64| move |span: TimeSpan| Claim::Clear { span, distance };
    let other = spin;
    for motions in [[&path as &dyn RigidMotion, &path], [&spin, &other]] {
        assert!(is_verified(ask(motions, 0.0, 2.0, &clear(0.000_999_999))));
        assert!(matches!(ask(motions, 0.0, 2.0, &clear(0.001_000_001)), Verdict::Refuted { .. }));
        let often = |span: TimeSpan| Claim::Often { span, distance: 0.001_000_001, every: 1e-6 };
        assert!(is_verified(ask(motions, 0.0, 2.0, &often)));
    }
    assert_eq!(reason(ask([&path, &path], 1.0, 3.0, &clear(0.0))), Some(Reason::OutsideMotion));
    // Nearly the same.
    let slower = spin.with_angular_velocity(DVec3::splat(299.0));
    let (hidden, elsewhere) =
        (Composed::new(ConstantTwist::REST, &path), spin.with_position(DVec3::X * 1e6 + 0.5));
    let (beside, still) = (Beside(ConstantTwist::REST), ConstantTwist::REST);
    assert!(
        !is_verified(ask([&beside, &beside.0], 0.0, 2.0, &clear(0.0)))
            && is_verified(ask([&still, &beside.0], 0.0, 2.0, &clear(0.0)))
    );
    for motions in [[&spin as &dyn RigidMotion, &slower], [&spin, &elsewhere], [&path, &hidden]] {
        assert!(!is_verified(ask(motions, 0.0, 2.0, &clear(0.0))));
    }
}

/// A cube that comes down on another one that turns, about points beside their centers, in units of length from 1e-290 to 1e150: what is true is proven and
/// what is not is refuted, at a distance in the unit of the query.
#[test]
fn claims_are_decided_in_any_unit_of_length() {
    for power in [-960, -600, -330, -170, -80, 0, 80, 170, 330, 500] {
        let unit = 2f64.powi(power);
        let mesh = |low: f64, high: f64| cuboid(DVec3::splat(low) * unit, DVec3::splat(high) * unit);
        let (lower, upper) = (mesh(0.25, 1.25), mesh(-1.5, -0.5));
        let turning = ConstantTwist::REST
            .with_position(DVec3::splat(0.75) * unit)
            .with_at(DVec3::splat(0.75) * unit)
            .with_angular_velocity(DVec3::Z * 2.0);
        let falling = ConstantTwist::REST
            .with_position(DVec3::new(2.0, 1.5, 3.75) * unit)
            .with_linear_velocity(DVec3::Z * -2.0 * unit);
        // From z = 1.25 up, and from 2.25 down by 2 a unit of time: they meet at 0.5.
        let query =
            Query { bodies: [body(&lower, &turning), body(&upper, &falling)], window: between(0.0, 1.0) };
        let judged = |claim: Claim| verify(&query, &claim, STEPS);
        let clear = |to: f64, distance: f64| {
            judged(Claim::Clear { span: between(0.0, to), distance: distance * unit })
        };
        assert!(is_verified(clear(0.49, 0.01)) && is_verified(clear(0.25, 0.49)), "{power}");
        let Verdict::Refuted { distance, .. } = clear(0.25, 0.51) else { panic!("{power}") };
        assert!(
            distance.lo() <= 0.51 * unit && distance.hi() >= 0.49 * unit && distance.hi() < 2.0 * unit,
            "{power}: {distance:?}"
        );
        assert!(is_verified(judged(Claim::Overlapping { time: 0.75, triangles: [0, 0] })), "{power}");
        let within = |distance: f64| {
            judged(Claim::Within { span: between(0.0, 0.25), distance: distance * unit, triangles: None })
        };
        assert!(is_verified(within(0.51)) && !is_verified(within(0.49)), "{power}");
        let parted = |most: f64| judged(Claim::Parted { time: 0.505, along: DVec3::Z, most: most * unit });
        assert!(is_verified(parted(0.02)) && !is_verified(parted(0.005)), "{power}");
        let rounded =
            Query { bodies: query.bodies.map(|body| Body { radius: 0.125 * unit, ..body }), ..query };
        let claim = |to: f64| Claim::Clear { span: between(0.0, to), distance: 0.0 };
        assert!(is_verified(verify(&rounded, &claim(0.37), STEPS)), "{power}");
        assert!(!is_verified(verify(&rounded, &claim(0.38), STEPS)), "{power}");
    }
}
