//! A motion whose enclosures bound no speed: sound, useless, and never a reason to say "contact" or "clear".

use d2m_bvh::{
    ClearanceOptions, ClearanceStatus, MeshTree, Moving, QueryError, QueryOptions, Solid, TimeOfContact,
    TriMesh, Window, clearance, time_of_contact, time_of_contact_counted,
};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Keyframes, Pose, RigidMotion, Span, Twist};
use d2m_testing::Surface;
use glam::{DQuat, DVec3};

/// The origin and a vertex at `unit` on each axis.
fn tetrahedron(unit: f64) -> MeshTree {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|vertex| vertex * unit);
    MeshTree::new(Surface::tetrahedron(corners).into_mesh(TriMesh::try_new))
}

/// Knows where it is at single times, and nothing about how fast it moves.
struct Unbounded(ConstantTwist);

impl RigidMotion for Unbounded {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.0.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
    fn enclose_twist(&self, _: Interval) -> IntervalTwist {
        let any = IntervalVec3 { x: Interval::ENTIRE, y: Interval::ENTIRE, z: Interval::ENTIRE };
        IntervalTwist { linear: any, angular: any }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.enclose_twist(t)
    }
}

#[test]
fn undecided_from_the_start() {
    let tree = tetrahedron(1.0);
    let away = Unbounded(ConstantTwist::REST.with_position(DVec3::X * 5.0));
    let (a, b) = (Moving::new(&tree, &away), Moving::new(&tree, &ConstantTwist::REST));
    let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
    assert_eq!(answer, TimeOfContact::Undecided { clear_until: 0.0 });
}

/// Knows its pose, and its velocity, to a half-infinite interval on one axis.
struct OneSided(ConstantTwist, [bool; 2]);

impl RigidMotion for OneSided {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.0.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let pose = self.0.enclose_pose(t);
        let x = if self.1[0] { at_least(pose.translation.x) } else { pose.translation.x };
        IntervalPose { translation: IntervalVec3 { x, ..pose.translation }, ..pose }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let twist = self.0.enclose_twist(t);
        let x = if self.1[1] { at_least(twist.linear.x) } else { twist.linear.x };
        IntervalTwist { linear: IntervalVec3 { x, ..twist.linear }, ..twist }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.0.enclose_twist_rate(t)
    }
}

fn at_least(x: Interval) -> Interval {
    Interval::new(x.lo(), f64::INFINITY)
}

/// What is known of a distance is the answer, however little it is: the tolerance is not blamed.
#[test]
fn a_clearance_of_which_nothing_is_known_is_undecided() {
    let tree = tetrahedron(1.0);
    for place in [5.0, 0.5] {
        let twist = ConstantTwist::REST.with_position(DVec3::X * place);
        for unknown in [[true, false], [false, true], [true; 2]] {
            let motion = OneSided(twist, unknown);
            let (a, b) = (Moving::new(&tree, &motion), Moving::new(&tree, &ConstantTwist::REST));
            for window in [Window::UNIT, Window::try_new(0.5, 0.5).unwrap()] {
                for (one, other) in [(a, b), (b, a)] {
                    let found = clearance(one, other, window, &ClearanceOptions::default()).unwrap();
                    let least = (place - 1.0).max(0.0);
                    assert!(found.lower <= least && least <= found.upper, "{place} {unknown:?}: {found:?}");
                    let is_known = found.upper < f64::INFINITY && found.status == ClearanceStatus::Clear;
                    assert!(
                        is_known || found.status != ClearanceStatus::Clear,
                        "{place} {unknown:?}: {found:?}"
                    );
                }
            }
        }
    }
}

/// An angular velocity whose square underflows turns the body all the same when the window is long enough.
#[test]
fn slow_turns_over_long_windows() {
    let arm = vec![DVec3::X * 0.9, DVec3::X, DVec3::new(0.95, 0.0, 0.1)];
    let wall = vec![DVec3::new(-0.1, 0.95, -1.0), DVec3::new(-0.1, 0.95, 1.0), DVec3::new(0.2, 0.95, 0.0)];
    let [a, b] = [arm, wall].map(|c| MeshTree::new(TriMesh::try_new(c, vec![[0, 1, 2]]).unwrap()));
    let options = QueryOptions::default().with_solid(Solid::Surface);
    for (speed, length) in [(1.0, 3.0), (1e-130, 3e130), (1e-160, 3e160), (1e-290, 3e290)] {
        let turn = ConstantTwist::REST.with_angular_velocity(DVec3::Z * speed);
        let (a, b) = (Moving::new(&a, &turn), Moving::new(&b, &ConstantTwist::REST));
        let answer = time_of_contact(a, b, Window::try_new(0.0, length).unwrap(), &options).unwrap();
        let time = answer.contact().map(|contact| contact.time_lo * speed);
        assert!(time.is_some_and(|time| (time - 1.3633001).abs() < 1e-6), "{speed}: {answer:?}");
    }
    // What turns by nothing to speak of is answered.
    let still = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 1e-200);
    let (a, b) = (Moving::new(&a, &still), Moving::new(&b, &ConstantTwist::REST));
    let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
    assert!(answer.is_separated());
}

/// The same of velocities.
#[test]
fn slow_drifts_over_long_windows() {
    let tree = tetrahedron(1.0);
    for (speed, length) in [(1.0, 9.0), (1e-130, 9e130), (1e-160, 9e160), (1e-290, 9e290)] {
        let drift = ConstantTwist::REST.with_position(DVec3::X * 5.0).with_linear_velocity(DVec3::X * -speed);
        let (a, b) = (Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &drift));
        let window = Window::try_new(0.0, length).unwrap();
        let answer = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
        let time = answer.contact().map(|contact| contact.time_lo * speed);
        assert!(time.is_some_and(|time| (time - 4.0).abs() < 1e-6), "{speed}: {answer:?}");
    }
}

/// Where rounding alone is larger than the bodies and what is between them, there is no answer to give; the motion is refused. What can
/// be resolved is answered, also at rest and far away, and for bodies that are points.
#[test]
fn motions_that_hide_the_bodies_are_refused() {
    let tree = tetrahedron(1.0);
    let dot = MeshTree::new(TriMesh::try_new(vec![DVec3::ONE; 3], vec![[0, 1, 2]]).unwrap());
    let options = QueryOptions::default();
    let still = ConstantTwist::REST;
    let ask = |tree: &MeshTree, motion: &ConstantTwist, options: &QueryOptions| {
        time_of_contact(Moving::new(tree, motion), Moving::new(tree, &still), Window::UNIT, options)
    };
    let start = ConstantTwist::REST.with_position(DVec3::X * 5.0);
    for speed in [1e15, 1e100, 1e300] {
        let fast = start.with_linear_velocity(DVec3::X * speed);
        assert_eq!(ask(&tree, &fast, &options), Err(QueryError::BadMotion { body: 0 }), "{speed:e}");
        let back =
            time_of_contact(Moving::new(&tree, &still), Moving::new(&tree, &fast), Window::UNIT, &options);
        assert_eq!(back, Err(QueryError::BadMotion { body: 1 }), "{speed:e}");
        assert!(ask(&tree, &fast, &options.with_tolerance(speed)).is_ok());
    }
    for speed in [1e3, 1e9, 1e12] {
        let fast = start.with_linear_velocity(DVec3::X * speed);
        assert_eq!(ask(&tree, &fast, &options), Ok(TimeOfContact::Separated), "{speed:e}");
        let surfaces = options.with_solid(Solid::Surface);
        let away = ConstantTwist::REST.with_linear_velocity(DVec3::X * speed);
        assert!(ask(&dot, &away, &surfaces).unwrap().contact().is_some(), "{speed:e}");
    }
    let far = start.with_position(DVec3::X * 1e100);
    assert_eq!(ask(&tree, &far, &options), Ok(TimeOfContact::Separated));
}

/// Keyframes over times so long, or in units so small, that squares of speeds or of distances are lost to underflow: the same
/// answer as in ordinary units. Such bodies were called separated.
#[test]
fn keyframes_in_any_unit_and_over_any_time() {
    let time_of = |unit: f64, time: f64, turn: f64, kind: Span| {
        let tree = tetrahedron(unit);
        let pose = |x: f64, turn: f64| Pose {
            rotation: DQuat::from_rotation_z(turn),
            translation: DVec3::X * (x * unit),
            at: DVec3::ZERO,
        };
        let frames = [(0.0, pose(-5.0, 0.0)), (0.6 * time, pose(2.0, turn)), (time, pose(4.0, 0.0))];
        let moving = Keyframes::try_new(&frames, kind).unwrap();
        let (a, b) = (Moving::new(&tree, &moving), Moving::new(&tree, &ConstantTwist::REST));
        let window = Window::try_new(0.0, time).unwrap();
        let answer = time_of_contact(a, b, window, &QueryOptions::default()).unwrap();
        answer.contact().unwrap_or_else(|| panic!("{unit:e} {time:e}: {answer:?}")).time_lo / time
    };
    for (kind, turn) in [(Span::Linear, 0.0), (Span::Screw, 0.0), (Span::Linear, 0.5), (Span::Screw, 0.5)] {
        let usual = time_of(1.0, 1.0, turn, kind);
        assert!((0.3..0.4).contains(&usual), "{usual}");
        for (unit, time) in [(1.0, 1e170), (1.0, 1e280), (1e-100, 1e80), (1e-161, 1.0), (1e-158, 1e-20)] {
            let scaled = time_of(unit, time, turn, kind);
            assert!((scaled - usual).abs() < 1e-9, "{unit:e} {time:e} {turn} {kind:?}: {scaled} {usual}");
        }
    }
}

/// Knows where it is at single times, and how fast it moves to some width.
struct Vague(ConstantTwist, f64);

impl RigidMotion for Vague {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.0.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.0.enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let (twist, off) = (self.0.enclose_twist(t), Interval::new(-self.1, self.1));
        let off = IntervalVec3 { x: off, y: off, z: off };
        IntervalTwist { linear: twist.linear + off, angular: twist.angular + off }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.enclose_twist(t)
    }
}

/// Velocities that are known to a million bodies a window end as undecided soon; those known to a tenth are answered.
#[test]
fn vague_velocities_are_undecided_soon() {
    let tree = tetrahedron(1.0);
    let falling = ConstantTwist::REST.with_position(DVec3::Z * 3.0).with_linear_velocity(DVec3::Z * -4.0);
    let rest = Moving::new(&tree, &ConstantTwist::REST);
    let ask = |width: f64| {
        let motion = Vague(falling, width);
        let options = QueryOptions::default();
        time_of_contact_counted(Moving::new(&tree, &motion), rest, Window::UNIT, &options).unwrap()
    };
    for width in [1e-6, 0.1] {
        let answered = ask(width);
        let time = answered.answer.contact().map(|contact| contact.time_lo);
        assert!(time.is_some_and(|time| (time - 0.5).abs() < 1e-9), "{width}: {answered:?}");
    }
    for width in [1e4, 1e6, 1e9] {
        let answered = ask(width);
        assert!(matches!(answered.answer, TimeOfContact::Undecided { .. }), "{width}: {answered:?}");
        // It shows from a thousand spans, not from all that there may be.
        assert!(answered.work.node_tests < 1 << 20, "{width}: {answered:?}");
    }
}
