//! Bad motions are refused by every constructor, with the place and the value.

use d2m_motion::{
    Chain, ConstantTwist, Joint, JointKind, JointValue, Keyframes, MotionError, Pose, Retimed, RigidMotion,
    Span, Spline, SplineDegree, Twist,
};
use glam::{DQuat, DVec3};

fn pose(x: f64) -> Pose {
    Pose { translation: DVec3::X * x, ..Pose::IDENTITY }
}

/// The message of a refusal, and what it must name.
fn names<T>(result: Result<T, MotionError>, words: &[&str]) {
    let message = result.err().expect("a refusal").to_string();
    for word in words {
        assert!(message.contains(word), "{message}\ndoes not name {word}");
    }
}

#[test]
fn constant_twists() {
    let twist = |x: DVec3, v: DVec3, w: DVec3| ConstantTwist::try_new(x, DQuat::IDENTITY, v, w);
    let bad = DVec3::new(0.0, f64::NAN, 0.0);
    names(twist(bad, DVec3::ZERO, DVec3::ZERO), &["position[1]", "NaN"]);
    names(twist(DVec3::ZERO, bad * f64::INFINITY, DVec3::ZERO), &["velocity[", "NaN"]);
    names(twist(DVec3::ZERO, DVec3::ZERO, DVec3::Z * f64::INFINITY), &["angular", "["]);
    let zero =
        ConstantTwist::try_new(DVec3::ZERO, DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), DVec3::ZERO, DVec3::ZERO);
    names(zero, &["orientation (0.0, 0.0, 0.0, 0.0)"]);
}

#[test]
fn keyframes_and_splines() {
    let half = Pose { rotation: DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0), ..pose(0.0) };
    let not_finite = pose(f64::NAN);
    let zero = Pose { rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..pose(0.0) };
    type Frames = Vec<(f64, Pose)>;
    let cases: Vec<(Frames, Vec<&str>)> = vec![
        (vec![], vec!["times: there are 0", "two"]),
        (vec![(0.0, pose(0.0))], vec!["times: there are 1", "two"]),
        (vec![(0.0, pose(0.0)), (2.0, pose(1.0)), (1.0, pose(2.0))], vec!["keyframe 2", "1.0"]),
        (vec![(0.0, pose(0.0)), (0.0, pose(1.0))], vec!["keyframe 1", "0.0"]),
        (vec![(0.0, pose(0.0)), (f64::NAN, pose(1.0))], vec!["keyframe 1", "NaN"]),
        (vec![(0.0, pose(0.0)), (f64::INFINITY, pose(1.0))], vec!["keyframe 1", "inf"]),
        (vec![(0.0, pose(0.0)), (1.0, half)], vec!["keyframe 1", "half a circle"]),
        (vec![(0.0, pose(0.0)), (1.0, not_finite)], vec!["1", "NaN"]),
        (vec![(0.0, pose(0.0)), (1.0, zero)], vec!["1", "orientation", "0.0"]),
    ];
    for (frames, words) in &cases {
        for span in [Span::Linear, Span::Screw] {
            names(Keyframes::try_new(frames, span), words);
        }
        for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
            names(Spline::try_through(frames, degree), words);
            let rest = Twist { linear: DVec3::ZERO, angular: DVec3::ZERO };
            let with: Vec<(f64, Pose, Twist)> = frames.iter().map(|&(t, pose)| (t, pose, rest)).collect();
            names(Spline::try_with_twists(&with, degree), words);
        }
    }
}

#[test]
fn twists_of_splines() {
    for bad in [f64::NAN, f64::INFINITY] {
        let wrong = [
            Twist { linear: DVec3::X * bad, angular: DVec3::ZERO },
            Twist { linear: DVec3::ZERO, angular: DVec3::new(0.0, 0.0, bad) },
        ];
        for (twist, name) in wrong.into_iter().zip(["linear", "angular"]) {
            let rest = Twist { linear: DVec3::ZERO, angular: DVec3::ZERO };
            let frames = [(0.0, pose(0.0), rest), (1.0, pose(1.0), rest), (2.0, pose(2.0), twist)];
            for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
                let value = if bad.is_nan() { "NaN" } else { "inf" };
                names(Spline::try_with_twists(&frames, degree), &["twists[2]", name, value]);
            }
        }
    }
}

#[test]
fn spans_that_jump() {
    let still = ConstantTwist::REST;
    let spans = |times: Vec<f64>, motions: Vec<ConstantTwist>| Keyframes::try_from_spans(times, motions);
    names(
        spans(vec![0.0, 1.0, 2.0], vec![still, still.with_position(DVec3::X)]),
        &["keyframe 1", "1.0", "position"],
    );
    names(spans(vec![0.0, 1.0], vec![still, still]), &["2"]);
    names(spans(vec![0.0, f64::NAN], vec![still]), &["keyframe 1", "NaN"]);
}

#[test]
fn chains_and_values() {
    names(Chain::try_new(vec![]), &["chain", "empty"]);
    let value = || JointValue::try_constant(1.0).unwrap();
    let joint = |kind: JointKind| Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind);
    names(joint(JointKind::Revolute { axis: DVec3::ZERO, value: value() }), &["axis", "[0, 0, 0]"]);
    names(joint(JointKind::Prismatic { axis: DVec3::ZERO, value: value() }), &["axis", "[0, 0, 0]"]);
    names(
        joint(JointKind::Revolute { axis: DVec3::new(0.0, f64::NAN, 1.0), value: value() }),
        &["axis", "NaN"],
    );
    names(JointValue::try_constant(f64::NAN), &["NaN"]);
    names(JointValue::try_polynomial(vec![]), &["polynomial"]);
    names(JointValue::try_polynomial(vec![0.0, f64::INFINITY]), &["1", "inf"]);
    let pieces = JointValue::try_pieces;
    names(pieces(vec![0.0, 1.0, 0.5], vec![vec![0.0], vec![0.0]]), &["times[2]", "0.5"]);
    names(pieces(vec![0.0, f64::NAN], vec![vec![0.0]]), &["times[1]", "NaN"]);
    names(pieces(vec![0.0, 1.0, 2.0], vec![vec![0.0, 1.0], vec![0.5]]), &["pieces[1]", "jumps by 0.5"]);
    names(pieces(vec![0.0, 1.0, 2.0], vec![vec![0.0], vec![]]), &["pieces[1]"]);
    names(pieces(vec![0.0, 1.0], vec![vec![0.0, f64::NAN]]), &["pieces[0]", "NaN"]);
    names(pieces(vec![0.0], vec![]), &["times"]);
    // 1e300·1e20: neither piece's value at 1e20 is a double, and nothing is known of how far apart they are.
    let far = vec![vec![0.0, 1e300], vec![0.0]];
    names(pieces(vec![0.0, 1e20, 2e20], far), &["pieces[1]", "beyond the numbers"]);
}

/// Powers of shorter and of longer spans are no doubles: what a spline did over them was the identity.
#[test]
fn splines_over_spans_beyond_fifth_powers() {
    let frames = |length: f64| {
        let turned = Pose { rotation: DQuat::from_rotation_z(1.0), translation: DVec3::X, ..Pose::IDENTITY };
        [(0.0, Pose::IDENTITY), (length, turned)]
    };
    for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
        for length in [1e-100, 0.9e-50, 1.1e50, 1e300] {
            names(Spline::try_through(&frames(length), degree), &["times[1]", &format!("{length:?}")]);
        }
        for length in [1e-50, 1.0, 1e50] {
            let spline = Spline::try_through(&frames(length), degree).unwrap();
            let middle = spline.pose_and_twist(0.5 * length).0.transform_point(DVec3::X);
            let expected = DVec3::X * 0.5 + DQuat::from_rotation_z(0.5) * DVec3::X;
            assert!((middle - expected).length() < 1e-15, "{length:?}: {middle}");
        }
    }
}

#[test]
fn other_paces() {
    for rate in [0.0, f64::NAN, f64::INFINITY] {
        names(Retimed::try_new(ConstantTwist::REST, rate, 0.0), &["rate", &format!("{rate}")]);
    }
    names(Retimed::try_new(ConstantTwist::REST, 1.0, f64::NAN), &["offset", "NaN"]);
}

/// Who does not want to handle an error reads the same sentence.
#[test]
#[should_panic(expected = "linear_velocity[0] is inf: every component of a motion must be finite")]
fn what_panics_says_what_is_wrong() {
    let _ = ConstantTwist::REST.with_linear_velocity(DVec3::X * f64::INFINITY);
}
