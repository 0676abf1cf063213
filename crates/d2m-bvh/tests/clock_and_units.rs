//! Far times, windows of no length, exact scalings of length and time, steps that a sweep must not overlook.

use d2m_bvh::{
    ClearanceOptions, ClearanceStatus, MeshTree, Moving, PairCache, Posed, QueryOptions, Solid, StartState,
    TimeOfContact, TriMesh, Window, clearance, distance, time_of_contact, time_of_contact_with,
};
use d2m_motion::{ConstantTwist, RigidMotion};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

fn cuboid(half: DVec3, center: DVec3) -> MeshTree {
    MeshTree::new(Surface::cuboid(center - half, center + half).into_mesh(TriMesh::try_new))
}

fn torus(rings: u32, sides: u32, tube: f64) -> MeshTree {
    MeshTree::new(Surface::wavy_torus(rings, sides, tube).into_mesh(TriMesh::try_new))
}

/// A plate with a top of any profile along x, turned.
fn plate(half: f64, low: f64, top: impl Fn(f64) -> f64, turn: DQuat) -> MeshTree {
    const N: u32 = 24;
    let number = |i: u32, j: u32, k: u32| k * (N + 1) * (N + 1) + i * (N + 1) + j;
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for (k, i, j) in (0..2).flat_map(|k| (0..=N).flat_map(move |i| (0..=N).map(move |j| (k, i, j)))) {
        let [x, y] = [i, j].map(|i| half * (2.0 * f64::from(i) / f64::from(N) - 1.0));
        corners.push(turn * DVec3::new(x, y, if k == 1 { top(x) } else { low }));
        if i < N && j < N {
            let [a, b, c, d] =
                [number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    MeshTree::new(TriMesh::try_new(corners, triangles).unwrap())
}

/// A plate slides over another one towards a step of twice its height above the plate. The reference point of the lower
/// plate is far to the side, so that the smallest angle between directions counts.
#[test]
fn a_step_is_never_overlooked_by_sweeps() {
    let mut random = KnuthRandom(4242);
    let options = QueryOptions::default().with_solid(Solid::Surface);
    for (far, step) in [(0.0, 3e-9), (0.5, 3e-9), (10.0, 3e-8), (100.0, 1e-6), (1000.0, 1e-6)] {
        for _ in 0..6 {
            let turn = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), random.signed())
                .normalize();
            let lower = plate(1.0, -0.2, |x| if x > 0.7 { step } else { 0.0 }, turn);
            let upper = plate(0.3, 0.0, |_| 0.2, turn);
            let (x, y, z) = (turn * DVec3::X, turn * DVec3::Y, turn * DVec3::Z);
            let at = y * far * random.signed().signum();
            let rest = ConstantTwist::REST.with_at(at).with_position(at);
            let slide =
                ConstantTwist::REST.with_position(z * (0.5 * step) - x * 0.5).with_linear_velocity(x * 1.2);
            let answer = time_of_contact(
                Moving::new(&lower, &rest),
                Moving::new(&upper, &slide),
                Window::UNIT,
                &options,
            )
            .unwrap();
            let meet = answer.contact().map(|contact| contact.time_lo);
            assert!(meet.is_some_and(|t| t < 0.77), "{far} away, step {step:e}: {answer:?}");
        }
    }
}

/// A block goes round 256 radians in 64 units in the last place of time, however large time is, and sinks upon another one
/// within the same turn.
#[test]
fn windows_are_limited_in_angle_at_any_time() {
    let (a, b) = (cuboid(DVec3::splat(0.1), DVec3::X), cuboid(DVec3::splat(0.1), DVec3::ZERO));
    let mut angles = Vec::new();
    for (start, unit) in [(0.0, 1.0 / 64.0), (1e9, 1.2e-7), (1e12, 1.3e-4), (1e15, 0.125), (1.7e18, 256.0)] {
        let unit: f64 = 2f64.powf(f64::log2(unit).round());
        let (spin, length) = (4.0 / unit, 64.0 * unit);
        let falls = ConstantTwist::REST
            .with_angular_velocity(DVec3::Z * spin)
            .with_position(DVec3::Z)
            .with_linear_velocity(DVec3::Z * (-2.0 / length))
            .with_reference_time(start);
        let rest = ConstantTwist::REST.with_position(-DVec3::X).with_reference_time(start);
        let window = Window::try_new(start, start + length).unwrap();
        let options = QueryOptions::default();
        let answer =
            time_of_contact(Moving::new(&a, &falls), Moving::new(&b, &rest), window, &options).unwrap();
        let contact = *answer.contact().unwrap_or_else(|| panic!("{start:e}: {answer:?}"));
        // Disjoint at `time_lo`, and as far apart as `tolerance` says.
        let [p, q] = [&falls, &rest].map(|m| m.pose_and_twist(contact.time_lo).0);
        let left = distance(Posed::new(&a, p), Posed::new(&b, q), Solid::Filled).unwrap();
        assert!(left.state == StartState::Apart && left.upper <= 3.3 * contact.tolerance, "{contact:?}");
        // One number for time at most, whatever the sum below is rounded to.
        let latest = (contact.time_lo + 1e-6 / spin).max(contact.time_lo.next_up());
        assert!((contact.time_lo..=latest).contains(&contact.time_hi), "{contact:?}");
        angles.push((contact.time_lo - start) * spin);
    }
    // `time_lo` is a multiple of four radians but for the first one.
    assert!(angles[1..].iter().all(|angle| *angle == (angles[0] / 4.0).floor() * 4.0), "{angles:?}");
}

/// The gap closes before the next number for a time: the bodies are apart at the start, and the tolerance says by how
/// much.
#[test]
fn a_start_at_large_times_is_not_a_contact() {
    let block = cuboid(DVec3::ONE, DVec3::ZERO);
    for start in [0.0, 1e6, 1e9, 1.7e9, 1e13] {
        for gap in [1e-6, 5e-5, 0.3] {
            let comes = ConstantTwist::REST
                .with_position(DVec3::X * (2.0 + gap))
                .with_linear_velocity(-DVec3::X * 1e3)
                .with_reference_time(start);
            let window = Window::try_new(start, start + 1.0).unwrap();
            let (a, b) = (Moving::new(&block, &comes), Moving::new(&block, &ConstantTwist::REST));
            let answer = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
            let contact = answer.contact().unwrap();
            let left = gap - 1e3 * (contact.time_lo - start);
            assert_eq!(contact.start, StartState::Apart, "{start:e} {gap:e}");
            assert!((contact.separation - left).abs() < 1e-12 && left > 0.0, "{start:e} {gap:e} {contact:?}");
            assert!(left <= 3.3 * contact.tolerance, "{start:e} {gap:e} {contact:?}");
            let near = (gap - contact.tolerance).max(0.0) / 1e3;
            assert!(start + near <= contact.time_hi.next_up(), "{start:e} {gap:e} {contact:?}");
        }
    }
}

/// Bodies that cross are in contact in a window of no length, and in one of an instant; a cache changes nothing.
#[test]
fn windows_of_no_length_have_contacts() {
    let mut random = KnuthRandom(3);
    let bodies = [torus(60, 24, 0.5), torus(40, 16, 0.4), cuboid(DVec3::splat(0.7), DVec3::ZERO)];
    let mut crossing = 0;
    for round in 0..120 {
        let (a, b) = (&bodies[round % 3], &bodies[round / 3 % 2]);
        let turn = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), random.signed());
        let (v, w) = (random.vector() * [0.0, 1e3][round % 2], random.vector() * [0.0, 40.0][round / 2 % 2]);
        let motion =
            ConstantTwist::try_new(random.vector() * 0.8, turn, v, w).unwrap().with_reference_time(0.5);
        let rest = ConstantTwist::REST;
        let (pose, _) = motion.pose_and_twist(0.5);
        let state = distance(Posed::new(a, pose), Posed::at_rest(b), Solid::Surface).unwrap().state;
        if state != StartState::Overlapping {
            continue;
        }
        crossing += 1;
        let mut cache = PairCache::new();
        let instant = 0.5f64.next_up();
        for end in [0.5, 0.5, instant, 1.0] {
            let window = Window::try_new(0.5, end).unwrap();
            let (p, q) = (Moving::new(a, &motion), Moving::new(b, &rest));
            let options = QueryOptions::default();
            let answer = time_of_contact(p, q, window, &options).unwrap();
            let contact =
                answer.contact().unwrap_or_else(|| panic!("round {round}, until {end}: {answer:?}"));
            assert_eq!((contact.time_lo, contact.start), (0.5, StartState::Overlapping));
            assert_eq!(time_of_contact_with(p, q, window, &options, &mut cache).unwrap(), answer);
        }
    }
    assert!(crossing > 60, "{crossing}");
}

/// All lengths, and all times, multiplied by powers of two: the same answer, bit by bit.
#[test]
fn exact_scalings_change_nothing() {
    let mut random = KnuthRandom(8);
    for round in 0..12 {
        let tori = [(8, 5, 0.4), (7, 4, 0.5)];
        let x = random.vector() * 2.0 + DVec3::X;
        let (v, w) = (-x * 1.5 + random.vector() * 0.3, random.vector() * [0.0, 3.0, 40.0][round % 3]);
        let (wb, at) = (random.vector() * [0.0, 2.0][round % 2], random.vector());
        let start = [0.0, 3.0, -1e6][round / 3 % 3];
        let ask = |length: i32, time: i32| {
            let (length, time) = (2f64.powi(length), 2f64.powi(time));
            let trees = tori.map(|(rings, sides, tube)| {
                MeshTree::new(
                    Surface::wavy_torus(rings, sides, tube).map(|p| p * length).into_mesh(TriMesh::try_new),
                )
            });
            let motion = |x: DVec3, v: DVec3, w: DVec3, at: DVec3| {
                let q = DQuat::from_xyzw(0.1, 0.2, -0.3, 0.8);
                let scaled = ConstantTwist::try_new(x * length, q, v * (length / time), w / time).unwrap();
                scaled.with_at(at * length).with_reference_time((start - 1.0) * time)
            };
            let (a, b) = (motion(x - v, v, w, at), motion(DVec3::ZERO, DVec3::ZERO, wb, DVec3::ZERO));
            let window = Window::try_new(start * time, (start + 1.5) * time).unwrap();
            let answer = time_of_contact(
                Moving::new(&trees[0], &a),
                Moving::new(&trees[1], &b),
                window,
                &QueryOptions::default(),
            );
            match answer.unwrap() {
                TimeOfContact::Contact(c) => {
                    Some([c.time_lo / time, c.time_hi / time, c.separation / length, c.tolerance / length])
                }
                TimeOfContact::Separated => None,
                undecided @ TimeOfContact::Undecided { .. } => panic!("{undecided:?}"),
            }
        };
        let right = ask(0, 0);
        for length in [-900, -500, -183, -60, -3, 1, 77, 190] {
            assert_eq!(ask(length, 0), right, "round {round}: lengths by 2^{length}");
        }
        for time in [-800, -366, -100, -1, 5, 200, 700] {
            assert_eq!(ask(0, time), right, "round {round}: times by 2^{time}");
        }
        assert_eq!(ask(-300, -250), right, "round {round}: both");
    }
}

/// Where a number for time is far from the next one, more is left at the time of contact than the tolerance that was asked for, and the clearance
/// of bodies that meet says so.
#[test]
fn a_clearance_on_a_coarse_clock_says_what_is_left() {
    let tree = torus(12, 8, 0.3);
    let mut coarse = 0;
    for k in 0..40 {
        let start = 1e5;
        let motion = ConstantTwist::REST
            .with_position(DVec3::new(0.03 * f64::from(k), 0.1, 5.0))
            .with_linear_velocity(DVec3::new(10.0, 20.0, -6e3))
            .with_reference_time(start);
        let bodies = [Moving::new(&tree, &motion), Moving::new(&tree, &ConstantTwist::REST)];
        let window = Window::try_new(start, start + 1e-3).unwrap();
        let found = clearance(bodies[0], bodies[1], window, &ClearanceOptions::default()).unwrap();
        assert_eq!((found.status, found.upper), (ClearanceStatus::Contact, 0.0), "{k}");
        let placed = bodies.map(|body| Posed::new(body.body, body.motion.pose_and_twist(found.time).0));
        let left = distance(placed[0], placed[1], Solid::Filled).unwrap().lower;
        assert!(left <= 3.3 * found.tolerance, "{k}: {left} {found:?}");
        coarse += usize::from(left > 1e-9);
    }
    assert!(coarse > 10, "{coarse}");
}
