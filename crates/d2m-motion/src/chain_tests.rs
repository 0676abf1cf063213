//! Chains, keyframes and compositions held against poses in pairs of doubles (some 30 digits).
use crate::double_double_trig::sin_cos_double;
use crate::rotation::{RotationDd, exponential_dd, rotate_dd};
use crate::tests::random_motion;
use crate::{
    AnyMotion, Chain, Composed, ConstantTwist, IntervalTwist, Joint, JointKind, JointValue, Keyframes, Pose,
    Retimed, RigidMotion, Span,
};
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::DoubleDouble as Dd;
use d2m_testing::{Draw, Random};
use glam::{DQuat, DVec3};

type Vector = [Dd; 3];

#[derive(Clone, Copy)]
struct Truth {
    rotation: RotationDd,
    position: Vector,
}

fn add(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + b[i])
}

fn exact(v: DVec3) -> Vector {
    v.to_array().map(Dd::from_f64)
}

/// The value of a joint at a pair of doubles, by the piece that holds `t`.
fn value_at(value: &JointValue, t: f64, s: Dd) -> Dd {
    let index = value.times().partition_point(|&x| x <= t).saturating_sub(1).min(value.pieces().count() - 1);
    let origin = value.times().get(index).copied().unwrap_or(0.0);
    let local = s - Dd::from_f64(origin);
    value.pieces().nth(index).unwrap().iter().rev().fold(Dd::ZERO, |sum, &c| (sum * local).add_f64(c))
}

/// The pose at `t + offset`, on the piece that holds `t`.
fn truth(chain: &Chain, t: f64, offset: f64) -> Truth {
    let s = Dd::from_f64(t).add_f64(offset);
    let mut frame =
        Truth { rotation: rotate_dd(DVec3::ZERO, Dd::ZERO, DQuat::IDENTITY), position: [Dd::ZERO; 3] };
    for joint in chain.joints() {
        frame.position = add(frame.position, frame.rotation.apply(exact(joint.position())));
        frame.rotation = frame.rotation
            * match joint.rpy() {
                None => rotate_dd(DVec3::ZERO, Dd::ZERO, joint.orientation()),
                Some([roll, pitch, yaw]) => turned_by(roll, pitch, yaw),
            };
        match joint.kind() {
            JointKind::Fixed => {}
            JointKind::Revolute { axis, value } => {
                // exp([k]θ) by an axis of any length.
                let angle = value_at(value, t, s) / length(*axis);
                frame.rotation = frame.rotation * exponential_dd(*axis, angle);
            }
            JointKind::Prismatic { axis, value } => {
                let by = value_at(value, t, s) / length(*axis);
                let shift = axis.to_array().map(|k| by * k);
                frame.position = add(frame.position, frame.rotation.apply(shift));
            }
        }
    }
    frame
}

/// The entries of R_z(yaw)·R_y(pitch)·R_x(roll), written out.
fn turned_by(roll: f64, pitch: f64, yaw: f64) -> RotationDd {
    let [(sr, cr), (sp, cp), (sy, cy)] = [roll, pitch, yaw].map(|angle| sin_cos_double(Dd::from_f64(angle)));
    RotationDd([
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ])
}

fn length(v: DVec3) -> Dd {
    v.to_array().iter().fold(Dd::ZERO, |sum, &x| sum + Dd::from_f64(x) * x).sqrt()
}

fn rounded(v: Vector) -> DVec3 {
    DVec3::new(v[0].hi, v[1].hi, v[2].hi)
}

fn random_value(random: &mut Random, start: f64) -> JointValue {
    let mut polynomial = |count: usize| -> Vec<f64> { (0..count).map(|_| 2.0 * random.signed()).collect() };
    let pieces = [polynomial(3), polynomial(5), polynomial(1), polynomial(11)];
    let count = (pieces[2][0].abs() * 4.0) as usize;
    if start == 0.0 && count < 2 {
        return JointValue::try_polynomial(pieces[count * 2 + 1].clone()).unwrap();
    }
    // Pieces that meet: the constant of the second is what the first ends with.
    let times = vec![start - 1.0, start + 0.5, start + 2.0];
    let end = pieces[1].iter().rev().fold(0.0, |sum, c| sum * 1.5 + c);
    let mut second = pieces[0].clone();
    second[0] = end;
    JointValue::try_pieces(times, vec![pieces[1].clone(), second]).unwrap()
}

fn random_chain(random: &mut Random, offset: f64, start: f64) -> Chain {
    let count = 1 + (random.unit() * 7.0) as usize;
    let joints = (0..count).map(|index| {
        let kind = match (random.unit() * 4.0) as u8 {
            0 => JointKind::Fixed,
            1 => JointKind::Prismatic { axis: random.vector() * 3.0, value: random_value(random, start) },
            _ => JointKind::Revolute { axis: random.vector() * 3.0, value: random_value(random, start) },
        };
        let q = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), random.signed());
        let x = random.vector() + if index == 0 { DVec3::splat(offset) } else { DVec3::ZERO };
        if random.unit() < 0.3 {
            let angle = std::f64::consts::PI;
            return Joint::try_with_rpy(x, [angle * q.x, angle * q.y, angle * q.z], kind).unwrap();
        }
        Joint::try_new(x, q, kind).unwrap()
    });
    Chain::try_new(joints.collect()).unwrap()
}

fn axial(m: [[f64; 3]; 3]) -> DVec3 {
    DVec3::new(m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]) * 0.5
}

/// Velocity and angular velocity by differences over 2·1e-9 of time: off by less than 1e-14 of what changes.
fn twist_at(chain: &Chain, t: f64) -> [DVec3; 2] {
    let h = 1e-9;
    let [before, now, after] = [-h, 0.0, h].map(|s| truth(chain, t, s));
    let difference = |a: Dd, b: Dd| (a - b) / Dd::from_f64(2.0 * h);
    let v = [0, 1, 2].map(|i| difference(after.position[i], before.position[i]));
    let rate: [[Dd; 3]; 3] =
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| difference(after.rotation.0[i][j], before.rotation.0[i][j])));
    // R′Rᵀ = [ω].
    let spin = [0, 1, 2]
        .map(|i| [0, 1, 2].map(|j| (0..3).fold(Dd::ZERO, |s, k| s + rate[i][k] * now.rotation.0[j][k]).hi));
    [rounded(v), axial(spin)]
}

fn outside(b: IntervalVec3, p: DVec3) -> f64 {
    (b.lo() - p).max(p - b.hi()).max_element().max(0.0)
}

#[test]
fn states_of_chains_are_within_their_radii() {
    let mut random = Random(11);
    for i in 0..600 {
        let (offset, start) = ([0.0, 1e6][i % 2], [0.0, 0.0, 1e5][i % 3]);
        let chain = random_chain(&mut random, offset, start);
        let t = start + [random.unit(), 0.5, 0.0, 1.0][i % 4];
        let true_pose = truth(&chain, t, 0.0);
        let origin = DVec3::splat(offset);
        let state = chain.enclose_state_about(t, origin);
        let apart =
            [0, 1, 2].map(|k| true_pose.position[k].add_f64(-origin[k]).add_f64(-state.position[k]).hi);
        let error = DVec3::from_array(apart).length();
        assert!(error <= state.position_radius, "{error:e} > {:e}", state.position_radius);
        // Also at 1e6 the position is known as well as near the origin.
        assert!(state.position_radius < 1e-11, "{:e} {chain:?}", state.position_radius);
        let rotation = state.rotation.to_cols_array_2d();
        let turn: f64 = (0..9)
            .map(|k| true_pose.rotation.0[k % 3][k / 3].add_f64(-rotation[k / 3][k % 3]).hi.powi(2))
            .sum();
        // The operator norm is at least the Frobenius norm over √3.
        assert!((turn / 3.0).sqrt() <= state.rotation_radius && state.rotation_radius < 1e-12);
        let [v, w] = twist_at(&chain, t);
        let slack = 1e-12 * (1.0 + state.linear.length() + state.angular.length());
        if (t - start - 0.5).abs() > 1e-3 {
            assert!(
                (v - state.linear).length() <= state.linear_radius + slack * 100.0,
                "{v} {}",
                state.linear
            );
            assert!((w - state.angular).length() <= state.angular_radius + slack * 100.0);
        }
    }
}

#[test]
fn enclosures_of_chains_hold_and_are_tight() {
    let mut random = Random(12);
    let mut looseness = Vec::new();
    for i in 0..200 {
        let start = [0.0, 1e5][i % 2];
        let chain = random_chain(&mut random, 0.0, start);
        let width = [0.05, 1e-3, 1.0][i % 3];
        let lo = start + random.unit() * (1.0 - width);
        let t = Interval::new(lo, lo + width);
        let (pose, twist, rate) =
            (chain.enclose_pose(t), chain.enclose_twist(t), chain.enclose_twist_rate(t));
        let kinematics = chain.enclose_kinematics(t);
        let mut spread = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        for k in 0..=8 {
            let time = if k == 8 { t.hi() } else { t.lo() + width * f64::from(k) / 8.0 };
            let at = truth(&chain, time, 0.0);
            let p = rounded(at.position);
            spread = [spread[0].min(p), spread[1].max(p)];
            for part in [pose, kinematics.to_pose()] {
                assert!(outside(part.translation, p) <= 1e-14 * (1.0 + p.length()), "{p} {part:?}");
                for (row, enclosure) in part.rotation.rows().iter().enumerate() {
                    assert!(outside(*enclosure, rounded(at.rotation.0[row])) < 1e-15);
                }
            }
            let off_joint = (time - start - 0.5).abs() > 1e-6;
            if off_joint {
                let [v, w] = twist_at(&chain, time);
                let slack = 1e-10 * (1.0 + v.length() + w.length());
                for IntervalTwist { linear, angular } in [twist, kinematics.to_twist()] {
                    assert!(outside(linear, v) < slack && outside(angular, w) < slack, "{i} {v} {linear:?}");
                }
                // The rate by differences of twists.
                let h = 1e-5;
                let [[v0, w0], [v1, w1]] = [time - h, time + h].map(|t| twist_at(&chain, t));
                if (time - start - 0.5).abs() > 2.0 * h && k > 0 && k < 8 {
                    let (a, alpha) = ((v1 - v0) / (2.0 * h), (w1 - w0) / (2.0 * h));
                    let slack = 1e-6 * (1.0 + a.length() + alpha.length()).powi(2);
                    for IntervalTwist { linear, angular } in [rate, kinematics.to_twist_rate()] {
                        assert!(outside(linear, a) < slack, "{i}: {a} {linear:?}");
                        assert!(outside(angular, alpha) < slack, "{i}: {alpha} {angular:?}");
                    }
                }
            }
        }
        let moved = (spread[1] - spread[0]).length();
        if width < 0.1 && moved > 1e-6 {
            looseness.push(2.0 * kinematics.position.radius / moved);
        }
    }
    looseness.sort_by(f64::total_cmp);
    let (least, median) = (looseness[0], looseness[looseness.len() / 2]);
    assert!(least > 0.99 && median < 3.0, "{least} {median}");
}

#[test]
fn rates_shrink_with_the_span() {
    let mut random = Random(13);
    for _ in 0..50 {
        let chain = random_chain(&mut random, 0.0, 0.0);
        let radius = |h: f64| chain.enclose_kinematics(Interval::new(0.25, 0.25 + h)).linear_rate.radius;
        let (wide, narrow) = (radius(1e-3), radius(1e-5));
        assert!(narrow <= 0.02 * wide + 1e-9, "{wide} {narrow}");
    }
}

#[test]
fn common_joints_are_found_and_left_out() {
    let mut random = Random(14);
    let chain = loop {
        let chain = random_chain(&mut random, 0.0, 0.0);
        if chain.joints().len() > 3 {
            break chain;
        }
    };
    let shorter = Chain::try_new(chain.joints()[..3].to_vec()).unwrap();
    assert_eq!(chain.common_joints(&shorter), 3);
    let rest = shorter.without_first(3).enclose_state(0.3);
    assert_eq!((rest.position, rest.position_radius, rest.linear), (DVec3::ZERO, 0.0, DVec3::ZERO));
    let outer = shorter.enclose_kinematics(Interval::point(0.3));
    let inner = chain.without_first(3).enclose_kinematics(Interval::point(0.3));
    let whole = outer.then(&inner).state_about(DVec3::ZERO);
    assert!((whole.position - chain.enclose_state(0.3).position).length() < 1e-12);
}

#[test]
fn faults_of_chains_name_joint_and_value() {
    let fixed = |x: f64| Joint::try_new(DVec3::new(x, 0.0, 0.0), DQuat::IDENTITY, JointKind::Fixed);
    assert!(fixed(f64::NAN).unwrap_err().to_string().contains("position[0] is NaN"));
    let message = |result: Result<AnyMotion, String>| result.unwrap_err();
    let read = |text: &str| serde_json::from_str::<AnyMotion>(text).map_err(|error| error.to_string());
    for (text, expected) in [
        (r#"{"chain": []}"#, "chain: it is empty"),
        // Keys are read from objects, never from lists.
        ("[]", "sequence, expected an object with keys"),
        ("[[1, 2, 3]]", "sequence, expected an object with keys"),
        (r#"{"chain": [[]]}"#, "sequence, expected an object with keys"),
        (r#"{"times": [0, 1], "poses": [[], {}]}"#, "sequence, expected an object with keys"),
        (r#"{"times": [0, 1], "spans": [[]]}"#, "sequence, expected an object with keys"),
        (
            r#"{"times": [0, 1], "poses": [{}, {}], "join": "cubic", "twists": [{}, []]}"#,
            "sequence, expected an object with keys",
        ),
        (
            r#"{"chain": [{"joint": "revolute", "axis": [0,0,1], "value": [[0, 1], [[0, 1]]]}]}"#,
            "expected a polynomial",
        ),
        (r#"{"chain": [{"joint": "spherical"}]}"#, "chain[0], joint: \"spherical\" is unknown"),
        (
            r#"{"chain": [{"joint": "fixed"}, {"joint": "revolute", "axis": [0,0,0], "value": [1]}]}"#,
            "chain[1], axis: [0, 0, 0]",
        ),
        (
            r#"{"chain": [{"joint": "revolute", "axis": [0,0,1]}]}"#,
            "chain[0], value: a revolute joint needs it",
        ),
        (
            r#"{"chain": [{"joint": "prismatic", "value": [1]}]}"#,
            "chain[0], axis: a prismatic joint needs it",
        ),
        (r#"{"chain": [{"joint": "fixed", "axis": [0,0,1]}]}"#, "chain[0], axis: a fixed joint has none"),
        (r#"{"chain": [{"value": [1]}]}"#, "chain[0], joint: it is missing"),
        (r#"{"chain": [{"joint": "fixed", "q": [0,0,0,0]}]}"#, "chain[0], pose"),
        (r#"{"chain": [{"joint": "fixed", "turn": 3}]}"#, "unknown field `turn`"),
        (
            r#"{"chain": [{"joint": "revolute", "axis": [0,0,1], "value": []}]}"#,
            "chain[0], value: a polynomial needs",
        ),
        (
            r#"{"chain": [{"joint": "revolute", "axis": [0,0,1], "value": {"times": [0, 1, 1], "pieces": [[1], [1]]}}]}"#,
            "chain[0], value, times[2]: 1.0 does not come after 1.0",
        ),
        (
            r#"{"chain": [{"joint": "revolute", "axis": [0,0,1], "value": {"times": [0, 1, 2], "pieces": [[1], [1.1]]}}]}"#,
            "chain[0], value, pieces[1]: the value jumps by 0.1",
        ),
        (
            r#"{"chain": [{"joint": "revolute", "axis": [0,0,1], "value": {"times": [0, 1], "pieces": [[1], [1]]}}]}"#,
            "chain[0], value, times: 2 times for 2 pieces",
        ),
        (r#"{"chain": [{"joint": "fixed"}], "v": [1, 0, 0]}"#, "v: this key does not belong to a chain"),
        (
            r#"{"times": [0, 1], "poses": [{}, {"q": [0, 0, 0, 1]}]}"#,
            "keyframe 1, time 1.0: the turn from the keyframe before is half a circle",
        ),
        (r#"{"times": [0, 1], "poses": [{}, {"q": [0, 0, 0, 0]}]}"#, "poses[1]: orientation"),
        (r#"{"times": [0, 1], "poses": [{}], "join": "linear"}"#, "times: 2 times for 1 poses"),
        (r#"{"times": [0, 1], "poses": [{}, {}], "join": "spline"}"#, "join: \"spline\" is unknown"),
        (r#"{"times": [0, 1], "poses": [{}, {}], "spans": [{}]}"#, "spans: poses and spans"),
        (r#"{"times": [0, 2, 1], "poses": [{}, {}, {}]}"#, "keyframe 2, time 1.0: times must increase"),
        (
            r#"{"times": [0, 1, 2], "spans": [{"v": [1, 0, 0]}, {"x": [1.001, 0, 0], "t": 1}]}"#,
            "keyframe 1, time 1.0",
        ),
        (r#"{"times": [0, 1, 2], "spans": [{"w": [0, 0, 1]}, {"q": [1, 0, 0, 0]}]}"#, "in rotation"),
        (r#"{"poses": [{}, {}]}"#, "times: keyframes need it"),
        (r#"{"v": [1, 0]}"#, "invalid length 2"),
        (r#"{"spin": [1, 0]}"#, "unknown field `spin`"),
    ] {
        let found = message(read(text));
        assert!(found.contains(expected), "{text}\n{found}\n{expected}");
    }
}

#[test]
fn json_forms_round_trip() {
    let mut random = Random(15);
    for i in 0..30 {
        let chain = random_chain(&mut random, 0.0, [0.0, 1.0][i % 2]);
        let text = serde_json::to_string(&AnyMotion::from(chain.clone())).unwrap();
        assert_eq!(serde_json::from_str::<AnyMotion>(&text).unwrap(), AnyMotion::Chain(chain.clone()));
        assert_eq!(serde_json::from_str::<Chain>(&text).unwrap(), chain);
    }
    let text =
        r#"{"times": [0, 1, 4], "poses": [{}, {"x": [1, 0, 0]}, {"q": [1, 1, 0, 0]}], "join": "screw"}"#;
    let path: Keyframes = serde_json::from_str(text).unwrap();
    let again: Keyframes = serde_json::from_str(&serde_json::to_string(&path).unwrap()).unwrap();
    assert_eq!(again.motions(), path.motions());
    let rest: AnyMotion = serde_json::from_str("{}").unwrap();
    assert_eq!(rest, AnyMotion::from(ConstantTwist::REST));
}

#[test]
fn keyframes_as_a_motion_are_one_sided_at_their_joints() {
    let pose = |x: f64| Pose { translation: DVec3::X * x, ..Pose::IDENTITY };
    let path =
        Keyframes::try_new(&[(0.0, pose(0.0)), (1.0, pose(2.0)), (3.0, pose(1.0))], Span::Linear).unwrap();
    let velocity = |lo: f64, hi: f64| path.enclose_twist(Interval::new(lo, hi)).linear.x;
    assert!(velocity(0.0, 1.0).contains(2.0) && !velocity(0.0, 1.0).contains(-0.5));
    assert!(velocity(1.0, 1.0).contains(-0.5) && !velocity(1.0, 1.0).contains(2.0));
    assert!(velocity(0.5, 1.5).contains(-0.5) && velocity(0.5, 1.5).contains(2.0));
    assert_eq!(path.smooth_until(0.0), Some(1.0));
    assert_eq!((path.smooth_until(1.0), path.smooth_until(3.0)), (None, None));
    assert_eq!(path.constant_twist_from(1.0).unwrap().until, None);
    assert_eq!(path.constant_twist_from(0.5).unwrap().motion, path.motions()[0]);
    let piece = path.enclose_pose(Interval::new(0.5, 2.0)).translation.x;
    assert!(piece.contains(1.0) && piece.contains(2.0) && piece.contains(1.5) && piece.hi() < 2.001);
}

#[test]
fn spans_of_a_screw_have_one_reference_point() {
    let mut random = Random(16);
    for _ in 0..100 {
        let frames: Vec<(f64, Pose)> = (0..5)
            .map(|i| {
                (f64::from(i), random_motion(&mut random, 1.0).with_at(DVec3::ZERO).pose_and_twist(0.0).0)
            })
            .collect();
        let path = Keyframes::try_new(&frames, Span::Screw).unwrap();
        for (i, (time, pose)) in frames.iter().enumerate() {
            let state = path.enclose_state(*time);
            let (plain, _) = path.pose_and_twist(*time);
            assert_eq!((state.at, plain.at), (path.motions()[0].at(), state.at));
            for point in [DVec3::ZERO, DVec3::X] {
                let there = pose.transform_point(point);
                let certified = state.rotation * (point - state.at) + state.position;
                assert!((certified - there).length() < 1e-10, "{i} {certified} {there}");
                assert!((plain.transform_point(point) - there).length() < 1e-10);
            }
        }
        // Rates of the common point: ω × v between keyframes.
        let t = Interval::new(1.25, 1.25 + 1e-3);
        let (first, last) = (path.enclose_state(t.lo()), path.enclose_state(t.hi()));
        let rate = (last.linear - first.linear) / (t.hi() - t.lo());
        assert!(outside(path.enclose_twist_rate(t).linear, rate) < 1e-8 * (1.0 + rate.length()));
    }
}

#[test]
fn gaps_depend_on_the_body() {
    let span = |x: f64, t: f64| ConstantTwist::REST.with_position(DVec3::X * x).with_reference_time(t);
    let path =
        |gap: f64| Keyframes::try_from_spans(vec![0.0, 1.0, 2.0], vec![span(1e6, 0.0), span(1e6 + gap, 1.0)]);
    assert!(path(1e-2).is_err());
    let small = path(1e-4).unwrap();
    assert!(small.check_size(1e6).is_ok());
    let message = small.check_size(1.0).unwrap_err().to_string();
    assert!(message.contains("keyframe 1, time 1.0") && message.contains("position"), "{message}");
    assert!(path(0.0).unwrap().check_size(1e-3).is_ok());
}

#[test]
fn many_spans_are_searched_by_halves() {
    let frames: Vec<(f64, Pose)> = (0..60_000)
        .map(|i| {
            let x = f64::from(i) * 1e-3;
            (x, Pose { translation: DVec3::new(x.sin(), x, 0.0), ..Pose::IDENTITY })
        })
        .collect();
    let path = Keyframes::try_new(&frames, Span::Linear).unwrap();
    let start = std::time::Instant::now();
    let mut sum = 0.0;
    for i in 0..100_000 {
        sum += path.pose_and_twist(f64::from(i) * 6e-4).0.translation.y;
    }
    assert!(sum > 0.0 && start.elapsed().as_secs_f64() < 2.0);
}

#[test]
fn compositions_and_retimed_motions_enclose_themselves() {
    let mut random = Random(17);
    for _ in 0..200 {
        let (outer, inner) = (random_motion(&mut random, 2.0), random_motion(&mut random, 2.0));
        let motion = Composed::new(outer, inner);
        let backwards = Retimed::try_reversed(motion, 0.25, 1.0).unwrap();
        let twice = Retimed::try_new(motion, 2.0, -0.5).unwrap();
        for (faults, name) in [
            (crate::check_motion(&motion, Interval::UNIT, 20), "composed"),
            (crate::check_motion(&backwards, Interval::UNIT, 20), "reversed"),
            (crate::check_motion(&twice, Interval::UNIT, 20), "retimed"),
        ] {
            assert!(faults.is_empty(), "{name}: {}", faults[0]);
        }
        let t = random.unit();
        let (a, b) = (motion.enclose_state(t), backwards.enclose_state(1.25 - t));
        assert!((a.position - b.position).length() < 1e-13 && (a.linear + b.linear).length() < 1e-13);
    }
    let path = Keyframes::try_new(
        &[0.0, 1.0, 2.0].map(|t| (t, Pose { translation: DVec3::X * t * t, ..Pose::IDENTITY })),
        Span::Linear,
    )
    .unwrap();
    assert!(Retimed::try_new(path, 2.0, 0.0).unwrap_err().to_string().contains("joint at the time 1.0"));
}

/// Turns and ways beyond all bounds: plain poses do not make one up, neither do those of motions that hold the chain.
#[test]
fn poses_of_what_is_not_known_are_no_numbers() {
    let value = |rate: f64| JointValue::try_polynomial(vec![0.0, rate]).unwrap();
    let axis = DVec3::Z;
    let turn = |rate: f64| JointKind::Revolute { axis, value: value(rate) };
    let slide = |rate: f64| JointKind::Prismatic { axis, value: value(rate) };
    let link = |kind| Chain::try_new(vec![Joint::try_new(DVec3::X, DQuat::IDENTITY, kind).unwrap()]).unwrap();
    let poses = |chain: &Chain, t: f64| {
        [
            chain.pose_and_twist(t).0,
            Composed::new(ConstantTwist::REST, chain).pose_and_twist(t).0,
            Retimed::try_new(chain, 0.3, 0.7 * t).unwrap().pose_and_twist(t).0,
        ]
    };
    for pose in poses(&link(turn(1e20)), 1.0) {
        assert!(pose.rotation.is_nan() && pose.translation == DVec3::X, "{pose:?}");
    }
    for pose in poses(&link(slide(1e308)), 10.0) {
        assert!(pose.translation.is_nan() && pose.rotation == DQuat::IDENTITY, "{pose:?}");
    }
    for pose in poses(&link(turn(1e8)), 1.0).into_iter().chain(poses(&link(slide(1e300)), 1.0)) {
        assert!(pose.rotation.is_finite() && pose.translation.is_finite(), "{pose:?}");
    }
}
