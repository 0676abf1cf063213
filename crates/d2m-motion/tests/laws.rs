//! Laws of motions that are made of motions: what two ways of writing the same motion enclose has common points at every time,
//! and every enclosure over a span holds the certified states inside it.
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{
    Chain, Composed, ConstantTwist, Joint, JointKind, JointValue, Keyframes, Pose, Retimed, RigidMotion,
    Span, Spline, SplineDegree, Twist, check_motion,
};
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use proptest::test_runner::TestCaseResult;

/// Widest enclosure at a single time, as a part of the lengths: some hundred roundings.
const SHARP: f64 = 1e-12;

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

fn turn() -> impl Strategy<Value = DQuat> {
    (vector(1.0), 0.3..1.0).prop_map(|(v, w)| DQuat::from_xyzw(v.x, v.y, v.z, w).normalize())
}

fn twist() -> impl Strategy<Value = ConstantTwist> {
    (vector(3.0), turn(), vector(2.0), vector(4.0), vector(1.0), -2.0..2.0).prop_map(|(x, q, v, w, at, t)| {
        ConstantTwist::try_new(x, q, v, w).unwrap().with_at(at).with_reference_time(t)
    })
}

fn joint() -> impl Strategy<Value = Joint> {
    (vector(1.0), turn(), vector(1.0), prop::collection::vec(-1.5..1.5, 1..5), 0..3).prop_map(
        |(x, q, axis, coefficients, kind)| {
            let value = JointValue::try_polynomial(coefficients).unwrap();
            let axis = axis + DVec3::X * 1.5;
            let kind = match kind {
                0 => JointKind::Fixed,
                1 => JointKind::Revolute { axis, value },
                _ => JointKind::Prismatic { axis, value },
            };
            Joint::try_new(x, q, kind).unwrap()
        },
    )
}

fn chain() -> impl Strategy<Value = Chain> {
    prop::collection::vec(joint(), 1..7).prop_map(|joints| Chain::try_new(joints).unwrap())
}

fn pose() -> impl Strategy<Value = Pose> {
    (vector(2.0), turn()).prop_map(|(translation, rotation)| Pose { translation, rotation, at: DVec3::ZERO })
}

fn share_a_point(a: IntervalVec3, b: IntervalVec3, size: f64) -> TestCaseResult {
    for (a, b) in [a.x, a.y, a.z].into_iter().zip([b.x, b.y, b.z]) {
        prop_assert!(!a.intersection(b).is_empty(), "{a:?} and {b:?} have no common point");
        prop_assert!(a.width().max(b.width()) <= SHARP * size, "{a:?} or {b:?} is wide");
    }
    Ok(())
}

/// The two motions enclose the same poses, twists and rates at time `t`, as points of the body near its origin.
fn are_the_same(a: &dyn RigidMotion, b: &dyn RigidMotion, t: f64) -> TestCaseResult {
    let now = Interval::point(t);
    let at = DVec3::new(0.3, -0.2, 0.5);
    let [a, b] = [a, b].map(|motion| motion.enclose_kinematics(now).following(at));
    let size = |v: IntervalVec3| 1.0 + v.norm().hi();
    let (p, q) = (a.to_pose(), b.to_pose());
    share_a_point(p.translation, q.translation, size(p.translation))?;
    for (c, d) in p.rotation.cols().into_iter().zip(q.rotation.cols()) {
        share_a_point(c, d, 1.0)?;
    }
    for (v, w) in [(a.to_twist(), b.to_twist()), (a.to_twist_rate(), b.to_twist_rate())] {
        let size = 64.0 * (size(v.linear) + size(v.angular).powi(2));
        share_a_point(v.linear, w.linear, size)?;
        share_a_point(v.angular, w.angular, size)?;
    }
    Ok(())
}

/// What the motion encloses over a span holds its certified states at times inside.
fn encloses_its_states(motion: &dyn RigidMotion, from: f64, length: f64) -> TestCaseResult {
    let joint = motion.smooth_until(from);
    let end = joint.unwrap_or(f64::INFINITY).min(from + length).min(motion.domain().hi());
    let span = Interval::new(from, end.max(from));
    let (pose, twist) = (motion.enclose_pose(span), motion.enclose_twist(span));
    for k in 0..=16 {
        let t = (from + (end - from) * f64::from(k) / 16.0).min(end.next_down()).max(from);
        let state = motion.enclose_state(t).following(pose.at);
        let holds = |what: &str, enclosure: IntervalVec3, value: DVec3, radius: f64| {
            for (range, x) in [enclosure.x, enclosure.y, enclosure.z].into_iter().zip(value.to_array()) {
                let near = Interval::new(x - radius, x + radius);
                prop_assert!(
                    !range.intersection(near).is_empty(),
                    "{what} at {t}: {x} ± {radius} not in {range:?}"
                );
            }
            Ok(())
        };
        holds("position", pose.translation, state.position, state.position_radius)?;
        holds("linear", twist.linear, state.linear, state.linear_radius)?;
        holds("angular", twist.angular, state.angular, state.angular_radius)?;
        for (column, axis) in pose.rotation.cols().into_iter().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
            holds("rotation", column, state.rotation * axis, state.rotation_radius)?;
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// A fixed transform and its inverse before a motion, or after it, leave it as it is, up to the rounding of the inverse.
    #[test]
    fn a_transform_and_its_inverse_cancel(motion in twist(), fixed in pose(), t in -1.0..1.0f64) {
        let there = ConstantTwist::REST.with_position(fixed.translation).with_orientation(fixed.rotation);
        let turned = fixed.rotation.conjugate();
        let back = ConstantTwist::REST.with_position(turned * -fixed.translation).with_orientation(turned);
        let before = Composed::new(back, Composed::new(there, motion));
        let after = Composed::new(Composed::new(motion, there), back);
        let plain = motion.enclose_state(t);
        for composed in [&before as &dyn RigidMotion, &after] {
            let state = composed.enclose_state(t).following(plain.at);
            let size = 16.0 * (1.0 + plain.position.length() + fixed.translation.length());
            prop_assert!((state.position - plain.position).length() <= SHARP * size);
            prop_assert!((state.linear - plain.linear).length() <= SHARP * size * (1.0 + plain.angular.length()));
            prop_assert!((state.angular - plain.angular).length() <= SHARP * (1.0 + plain.angular.length()));
            prop_assert!((state.rotation * DVec3::Y - plain.rotation * DVec3::Y).length() <= SHARP);
            prop_assert!(state.position_radius <= SHARP * size);
        }
    }

    /// Composition is associative.
    #[test]
    fn composition_is_associative(a in twist(), b in twist(), c in chain(), t in -1.0..1.0f64) {
        let left = Composed::new(Composed::new(a, b), c.clone());
        are_the_same(&left, &Composed::new(a, Composed::new(b, c)), t)?;
    }

    /// Backwards twice, and twice as fast after half as fast, is the motion itself: the sums are exact.
    #[test]
    fn retimed_twice_is_the_motion(motion in chain(), t in -1.0..1.0f64) {
        let reversed = Retimed::try_reversed(motion.clone(), -1.0, 2.0).unwrap();
        are_the_same(&Retimed::try_reversed(reversed, -1.0, 2.0).unwrap(), &motion, t)?;
        let slow = Retimed::try_new(motion.clone(), 0.5, 0.25).unwrap();
        are_the_same(&Retimed::try_new(slow, 2.0, -0.5).unwrap(), &motion, t)?;
    }

    /// A chain is its joints, composed one by one, wherever it is cut.
    #[test]
    fn chains_are_compositions_of_their_joints(whole in chain(), cut in 0..7usize, t in -1.0..1.0f64) {
        let cut = cut.min(whole.joints().len());
        if 0 < cut && cut < whole.joints().len() {
            let parts = Composed::new(whole.only_first(cut), whole.without_first(cut));
            are_the_same(&parts, &whole, t)?;
        }
        let mut by_hand: Box<dyn RigidMotion + Send> = Box::new(ConstantTwist::REST);
        for joint in whole.joints() {
            let link = Chain::try_new(vec![joint.clone()]).unwrap();
            by_hand = Box::new(Composed::new(by_hand, link));
        }
        are_the_same(&*by_hand, &whole, t)?;
    }

    /// Enclosures over spans of every length hold the states inside, for every kind of motion.
    #[test]
    fn enclosures_hold_the_states_inside(
        screw in twist(),
        arm in chain(),
        poses in prop::collection::vec(pose(), 4),
        from in -1.0..1.0f64,
        power in -8..1i32,
    ) {
        let length = 10f64.powi(power);
        let frames: Vec<(f64, Pose)> = poses.iter().enumerate().map(|(i, p)| (i as f64 - 1.5, *p)).collect();
        let moving: Vec<(f64, Pose, Twist)> = frames.iter().map(|&(t, p)| (t, p, screw.pose_and_twist(t).1)).collect();
        let mut motions: Vec<Box<dyn RigidMotion + Send>> = vec![
            Box::new(screw),
            Box::new(arm.clone()),
            Box::new(Composed::new(arm.clone(), screw)),
            Box::new(Retimed::try_new(arm, -0.7, 0.1).unwrap()),
        ];
        for span in [Span::Linear, Span::Screw] {
            motions.extend(Keyframes::try_new(&frames, span).ok().map(|path| Box::new(path) as Box<dyn RigidMotion + Send>));
        }
        for degree in [SplineDegree::Cubic, SplineDegree::Quintic] {
            let path = Spline::try_with_twists(&moving, degree).ok();
            motions.extend(path.map(|path| Box::new(path) as Box<dyn RigidMotion + Send>));
        }
        for motion in &motions {
            encloses_its_states(&**motion, from, length)?;
            let faults = check_motion(&**motion, Interval::new(from, (from + length).min(1.5)), 4);
            prop_assert!(faults.is_empty(), "{}", faults[0]);
        }
    }
}
