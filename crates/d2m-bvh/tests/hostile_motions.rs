//! Chains and splines chosen to be hard: planted contacts with a time that is known, and dense static distances.

mod queries;

use d2m_bvh::{Distance, MeshTree, QueryOptions, StartState, TimeOfContact, TriMesh, Window};
use d2m_motion::{
    Chain, ConstantTwist, Joint, JointKind, JointValue, Pose, RigidMotion, Spline, SplineDegree, Twist,
};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};
use queries::{distance_at, query};

const DELTA: f64 = 1e-9;

fn torus(rings: u32, sides: u32, scale: f64) -> MeshTree {
    MeshTree::new(Surface::wavy_torus(rings, sides, 0.3).map(|p| p * scale).into_mesh(TriMesh::try_new))
}

/// A tetrahedron with its tip at the origin, the rest above it.
fn spike() -> MeshTree {
    let corners =
        [DVec3::ZERO, DVec3::new(0.3, 0.0, 1.0), DVec3::new(-0.15, 0.26, 1.0), DVec3::new(-0.15, -0.26, 1.0)];
    MeshTree::new(Surface::tetrahedron(corners).into_mesh(TriMesh::try_new))
}

/// A plate with its upper face at z = 0.
fn plate() -> MeshTree {
    MeshTree::new(
        Surface::cuboid(DVec3::new(-4.0, -4.0, -1.0), DVec3::new(4.0, 4.0, 0.0)).into_mesh(TriMesh::try_new),
    )
}

/// Nothing touches before the answer's time at `samples` times, and a contact is as near as its tolerance says.
fn judge(
    trees: [&MeshTree; 2],
    motions: [&dyn RigidMotion; 2],
    (window, origin, samples): (Window, DVec3, u32),
    answer: &TimeOfContact,
) -> Result<(), String> {
    let end = match answer {
        TimeOfContact::Contact(contact) => contact.time_lo,
        TimeOfContact::Separated => window.end(),
        TimeOfContact::Undecided { clear_until } => return Err(format!("undecided from {clear_until} on")),
    };
    for k in 0..=samples {
        let t = (window.start() + (end - window.start()) * f64::from(k) / f64::from(samples)).min(end);
        let Distance { lower: low, upper: high, .. } = distance_at(trees, motions, t, origin);
        if low <= 0.0 {
            return Err(format!("touching at {t}, before {end}: {high:e}"));
        }
    }
    let Some(contact) = answer.contact() else { return Ok(()) };
    let Distance { lower: low, upper: high, .. } = distance_at(trees, motions, contact.time_lo, origin);
    if low < 0.3 * contact.tolerance || high > 3.5 * contact.tolerance {
        return Err(format!("{low:e} to {high:e} left: {contact:?}"));
    }
    if contact.start != StartState::Apart {
        return Err(format!("{contact:?}"));
    }
    Ok(())
}

fn joint(position: DVec3, kind: JointKind) -> Joint {
    Joint::try_new(position, DQuat::IDENTITY, kind).unwrap()
}

/// Poses through a neighbourhood of the origin at times that are anything but even.
fn poses(random: &mut KnuthRandom, start: f64, offset: DVec3, count: usize) -> Vec<(f64, Pose)> {
    let mut time = start;
    let mut step = 0.0;
    (0..count)
        .map(|_| {
            time += step;
            step = 10f64.powf(random.signed() * 1.2 - 0.8);
            let translation = offset + random.vector() * 2.2;
            (time, Pose { translation, rotation: random.moderate_turn().normalize(), at: DVec3::ZERO })
        })
        .collect()
}

/// Splines of both degrees, smooth by themselves and with twists that were given, some of them zero: near the origin of time and
/// of space, and far from both.
#[test]
fn random_splines_are_answered_right() {
    let (a, b) = (torus(12, 7, 0.5), torus(16, 8, 0.8));
    let mut random = KnuthRandom(71);
    let options = QueryOptions::default().with_tolerance(DELTA);
    let (mut hits, mut free) = (0, 0);
    for round in 0..72 {
        let start = [0.0, 1e5][round % 2];
        let offset = [DVec3::ZERO, DVec3::new(-1e6, 1e6, 2e6)][round / 2 % 2];
        let degree = [SplineDegree::Cubic, SplineDegree::Quintic][round / 4 % 2];
        let frames = poses(&mut random, start, offset, 2 + round % 5);
        let path = if round % 3 == 0 {
            let twisted = frames.iter().enumerate().map(|(index, (time, pose))| {
                // Every other pose is a rest.
                let of = if index % 2 == 0 { 0.0 } else { 1.0 };
                (*time, *pose, Twist { linear: random.vector() * of, angular: random.vector() * of })
            });
            Spline::try_with_twists(&twisted.collect::<Vec<_>>(), degree)
        } else {
            Spline::try_through(&frames, degree)
        };
        let path = path.unwrap();
        let still = ConstantTwist::REST
            .with_position(offset + random.vector().normalize() * 1.8)
            .with_angular_velocity(random.vector() * [0.0, 3.0][round % 2])
            .with_reference_time(start);
        let (first, last) = (frames[0].0, frames[frames.len() - 1].0);
        let window = Window::try_new(first, last).unwrap();
        if distance_at([&a, &b], [&path, &still], first, offset).lower < 1e-3 {
            continue;
        }
        let answer = query([&a, &b], [&path, &still], window, &options);
        if answer.contact().is_some() {
            hits += 1;
        } else {
            free += 1;
        }
        judge([&a, &b], [&path, &still], (window, offset, 120), &answer)
            .unwrap_or_else(|fault| panic!("round {round}: {fault}"));
        // The bodies exchanged: a bracket that overlaps.
        let swapped = query([&b, &a], [&still, &path], window, &options);
        let close = match (answer.contact(), swapped.contact()) {
            (Some(x), Some(y)) => x.time_lo <= y.time_hi && y.time_lo <= x.time_hi,
            (x, y) => x.is_none() && y.is_none(),
        };
        assert!(close, "round {round}: {answer:?} {swapped:?}");
    }
    assert!(hits > 20 && free > 3, "{hits} {free}");
}

/// A spike is turned about its tip, with a spin that changes its sign, while a carriage brings the tip down so that it touches
/// the plate at a known time: inside a piece, exactly at a joint, at the start of a piece that goes on down, with a
/// velocity that vanishes there to an order of one to four.
#[test]
fn planted_contacts_of_turning_spikes() {
    let (a, b) = (spike(), plate());
    let options = QueryOptions::default().with_tolerance(DELTA);
    let mut random = KnuthRandom(72);
    for round in 0..144 {
        let start = [0.0, 1e5, -3e4][round % 3];
        let offset = [DVec3::ZERO, DVec3::new(1e6, 2e6, -1e6)][round / 3 % 2];
        let order = 1 + round / 6 % 4;
        // At 1, from 0 to 2: the joint is before, at, or after the contact.
        let joint_at = [0.5, 1.0, 1.5][round / 24 % 3];
        // Height (1 − s)^order · c, and through if the order is odd; an even one touches and leaves.
        let scale = 0.3 + random.signed().abs();
        let height = |from: f64| power_about(order, 1.0 - from, scale);
        let turn = [1.5 * random.signed(), -2.0, 1.0 + random.signed()];
        let times = vec![start, start + joint_at, start + 2.0];
        let fall = JointValue::try_pieces(times.clone(), vec![height(0.0), height(joint_at)]).unwrap();
        // ω = turn₀ + 2 turn₁ s changes its sign; it goes on from the joint with another rate.
        let at_joint = turn[0] * joint_at + turn[1] * joint_at * joint_at * 0.3;
        let spin = JointValue::try_pieces(
            times,
            vec![vec![0.0, turn[0], turn[1] * 0.3], vec![at_joint, -turn[0], turn[2] * 0.3]],
        )
        .unwrap();
        let link = Chain::try_new(vec![
            joint(offset, JointKind::Fixed),
            joint(DVec3::ZERO, JointKind::Prismatic { axis: DVec3::Z, value: fall }),
            joint(DVec3::ZERO, JointKind::Revolute { axis: DVec3::new(0.1, -0.2, 1.0), value: spin }),
        ])
        .unwrap();
        let still = ConstantTwist::REST.with_position(offset);
        let window = Window::try_new(start, start + 2.0).unwrap();
        let answer = query([&a, &b], [&link, &still], window, &options);
        let what = format!("round {round}, order {order}, joint at {joint_at}");
        let contact = answer.contact().unwrap_or_else(|| panic!("{what}: {answer:?}"));
        let left = (contact.tolerance * 3.5 / scale).powf(1.0 / order as f64);
        let (early, late) = (start + 1.0 - 1.5 * left - 1e-15 * start.abs(), start + 1.0);
        assert!(early <= contact.time_lo && contact.time_lo <= late, "{what}: {contact:?}");
        assert!(contact.tolerance <= 2e-8, "{what}: {contact:?}");
        judge([&a, &b], [&link, &still], (window, offset, 100), &answer)
            .unwrap_or_else(|fault| panic!("{what}: {fault}"));
    }
}

/// Coefficients of scale · (c − s)^n in s, c = `at`, without what rounding leaves where it is zero.
fn power_about(n: usize, at: f64, scale: f64) -> Vec<f64> {
    let mut out = vec![scale];
    for _ in 0..n {
        let mut next = vec![0.0; out.len() + 1];
        for (k, x) in out.iter().enumerate() {
            next[k] += x * at;
            next[k + 1] -= x;
        }
        out = next;
    }
    out
}

/// A spline whose pose at a joint touches the plate with no velocity, coming from above and going back: one contact, at the joint;
/// raised by a little, none.
#[test]
fn splines_that_touch_at_a_joint_with_no_velocity() {
    let (a, b) = (spike(), plate());
    let options = QueryOptions::default().with_tolerance(DELTA);
    for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
        for start in [0.0, 1e5] {
            for (raised, meets) in [(0.0, true), (-1e-7, true), (1e-7, false), (1e-4, false)] {
                let pose = |height: f64, turn: f64| Pose {
                    translation: DVec3::Z * height,
                    rotation: DQuat::from_rotation_z(turn),
                    at: DVec3::ZERO,
                };
                let rest = Twist { linear: DVec3::ZERO, angular: DVec3::ZERO };
                let frames = [
                    (start, pose(1.0, 0.0), rest),
                    (start + 0.75, pose(raised, 1.0), rest),
                    (start + 2.0, pose(0.8, -0.7), rest),
                ];
                let path = Spline::try_with_twists(&frames, degree).unwrap();
                let window = Window::try_new(start, start + 2.0).unwrap();
                let answer = query([&a, &b], [&path, &ConstantTwist::REST], window, &options);
                assert_eq!(answer.contact().is_some(), meets, "{degree:?} {start} {raised:e}: {answer:?}");
                if let Some(contact) = answer.contact() {
                    assert!(contact.time_lo <= start + 0.75 && contact.time_lo > start + 0.74, "{contact:?}");
                }
                judge([&a, &b], [&path, &ConstantTwist::REST], (window, DVec3::ZERO, 200), &answer)
                    .unwrap_or_else(|fault| panic!("{degree:?} {start} {raised:e}: {fault}"));
            }
        }
    }
}

/// Two arms of up to six joints with piecewise quintic values, whose joints have times of their own.
#[test]
fn random_chains_of_piecewise_quintics() {
    let (a, b) = (torus(12, 7, 0.4), torus(14, 8, 0.5));
    let mut random = KnuthRandom(73);
    let options = QueryOptions::default().with_tolerance(DELTA);
    let (mut hits, mut free) = (0, 0);
    for round in 0..60 {
        let start = [0.0, 1e5][round % 2];
        let offset = [DVec3::ZERO, DVec3::new(1e6, -1e6, 1e6)][round / 2 % 2];
        let mut arm = |base: DVec3, joints: usize| {
            let mut chain = vec![joint(base, JointKind::Fixed)];
            for k in 0..joints {
                let value = quintic(&mut random, start);
                let axis = random.vector();
                let kind = if k % 3 == 2 {
                    JointKind::Prismatic { axis, value }
                } else {
                    JointKind::Revolute { axis, value }
                };
                chain.push(joint(if k == 0 { DVec3::ZERO } else { DVec3::X * 0.5 }, kind));
            }
            Chain::try_new(chain).unwrap()
        };
        let (left, right) =
            (arm(offset - DVec3::X, 1 + round % 6), arm(offset + DVec3::X, 1 + round / 6 % 3));
        let window = Window::try_new(start, start + 1.0).unwrap();
        if distance_at([&a, &b], [&left, &right], start, offset).lower < 1e-3 {
            continue;
        }
        let answer = query([&a, &b], [&left, &right], window, &options);
        if answer.contact().is_some() {
            hits += 1;
        } else {
            free += 1;
        }
        judge([&a, &b], [&left, &right], (window, offset, 120), &answer)
            .unwrap_or_else(|fault| panic!("round {round}: {fault}"));
    }
    assert!(hits > 8 && free > 8, "{hits} {free}");
}

/// A value with two continuous derivatives over three pieces of unlike lengths.
fn quintic(random: &mut KnuthRandom, start: f64) -> JointValue {
    let inner = [0.3 + 0.25 * random.signed(), 0.7 + 0.1 * random.signed()];
    let times = [0.0, inner[0], inner[1], 1.0];
    // Value, slope and second derivative at the times.
    let data: Vec<[f64; 3]> =
        (0..4).map(|_| [1.2 * random.signed(), 2.0 * random.signed(), 6.0 * random.signed()]).collect();
    let pieces = (0..3).map(|k| {
        let h = times[k + 1] - times[k];
        let ([p, v, a], [q, w, b]) = (data[k], data[k + 1]);
        let (d, e, f) = (q - p - v * h - 0.5 * a * h * h, (w - v - a * h) * h, (b - a) * h * h);
        let (c3, c4, c5) =
            (10.0 * d - 4.0 * e + 0.5 * f, -15.0 * d + 7.0 * e - f, 6.0 * d - 3.0 * e + 0.5 * f);
        vec![p, v, 0.5 * a, c3 / h.powi(3), c4 / h.powi(4), c5 / h.powi(5)]
    });
    JointValue::try_pieces(times.map(|t| start + t).to_vec(), pieces.collect()).unwrap()
}
