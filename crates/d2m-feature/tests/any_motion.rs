//! Contacts planted on motions that accelerate: never missed, never late, brackets narrow, gaps seen as gaps.
use d2m_feature::{ContactOptions, FirstContact, PairMotion};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Keyframes, Pose, RigidMotion, Span, Twist};
use d2m_root::Evidence;
use d2m_testing::{Blurred, Bounded, CountedStates, Draw, Random};
use glam::{DQuat, DVec3};

/// A cubic with a turn about a fixed axis by the angle w·t + α·t²/2: C∞, but nothing that the tests know about.
#[derive(Debug, Clone, Copy)]
struct SpinUp {
    axis: DVec3,
    w: f64,
    alpha: f64,
    path: [DVec3; 4],
}

impl SpinUp {
    fn random(random: &mut Random) -> Self {
        let axis = [DVec3::X, DVec3::Y, DVec3::Z][(random.unit() * 3.0) as usize];
        let path = [1.0, 2.0, 2.0, 2.0].map(|size| random.vector() * size);
        Self { axis, w: 3.0 * random.signed(), alpha: 6.0 * random.signed(), path }
    }
}

impl RigidMotion for SpinUp {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let [c0, c1, c2, c3] = self.path;
        let rotation = DQuat::from_axis_angle(self.axis, t * (self.w + 0.5 * self.alpha * t));
        let pose = Pose { rotation, translation: c0 + (c1 + (c2 + c3 * t) * t) * t, at: DVec3::ZERO };
        let linear = c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t;
        (pose, Twist { linear, angular: self.axis * (self.w + self.alpha * t) })
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let [c0, c1, c2, c3] = self.path.map(IntervalVec3::point);
        IntervalPose {
            rotation: IntervalMat3::rotation(self.axis, t * (self.w + t * (0.5 * self.alpha))),
            translation: c0 + (c1 + (c2 + c3 * t) * t) * t,
            at: DVec3::ZERO,
        }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let [_, c1, c2, c3] = self.path.map(IntervalVec3::point);
        IntervalTwist {
            linear: c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t,
            angular: IntervalVec3::point(self.axis) * (self.w + t * self.alpha),
        }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let [_, _, c2, c3] = self.path.map(IntervalVec3::point);
        IntervalTwist {
            linear: c2 * 2.0 + c3 * (6.0 * t),
            angular: IntervalVec3::point(self.axis) * self.alpha,
        }
    }
}

#[test]
fn contacts_of_accelerating_motions_are_never_missed_and_never_late() {
    let mut random = Random(31);
    let options = ContactOptions::new();
    let (mut crossings, mut rows) = (0, 0);
    for i in 0..4000 {
        let (mut a, b) = (SpinUp::random(&mut random), SpinUp::random(&mut random));
        let (p, q) = (random.vector(), random.vector());
        let triangle = [random.vector(), random.vector(), random.vector()];
        let (u, v) = (0.05 + 0.4 * random.unit(), 0.05 + 0.4 * random.unit());
        // Also at the ends of the window.
        let time = [random.unit(), random.unit(), 0.0, 1.0][i % 4];
        let ((pose_a, _), (pose_b, _)) = (a.pose_and_twist(time), b.pose_and_twist(time));
        let edges = i % 2 == 1;
        let (mine, theirs) = if edges {
            (p + (q - p) * u, triangle[0] + (triangle[1] - triangle[0]) * v)
        } else {
            (p, triangle[0] + (triangle[1] - triangle[0]) * u + (triangle[2] - triangle[0]) * v)
        };
        a.path[0] += pose_b.transform_point(theirs) - pose_a.transform_point(mine);
        let pair = PairMotion::new(&a, &b, 0.0, 1.0);
        let answer = if edges {
            pair.edge_edge([p, q], [triangle[0], triangle[1]], &options)
        } else {
            pair.point_triangle(p, &triangle, &options)
        };
        let FirstContact::Contact(contact) = answer else {
            // Poses are rounded: at the very ends the contact may be outside by a rounding.
            assert!(i % 4 >= 2, "missed at {time}: {a:?} {b:?} {p} {triangle:?}");
            continue;
        };
        rows += 1;
        assert!(contact.lo <= time + 1e-12, "late: {contact:?} {time}");
        crossings += usize::from(contact.evidence == Evidence::Crossing);
        let details = if edges {
            pair.edge_edge_details([p, q], [triangle[0], triangle[1]], contact.hi)
        } else {
            pair.point_triangle_details(p, &triangle, contact.hi)
        };
        assert!(details.point_a.distance(details.point_b) < 1e-8, "{contact:?} {details:?}");
    }
    assert!(rows > 3500 && crossings > 1900, "{rows} {crossings}");
}

#[test]
fn what_is_clear_stays_apart() {
    let mut random = Random(32);
    let options = ContactOptions::new();
    let mut clear = 0;
    for _ in 0..1500 {
        let (a, b) = (SpinUp::random(&mut random), SpinUp::random(&mut random));
        let (p, triangle) = (random.vector(), [random.vector(), random.vector(), random.vector()]);
        let pair = PairMotion::new(&a, &b, 0.0, 1.0);
        let answer = pair.point_triangle(p, &triangle, &options);
        let until = match answer {
            FirstContact::Clear => {
                clear += 1;
                1.0
            }
            FirstContact::Contact(contact) => contact.lo,
            FirstContact::Undecided { clear_until } => clear_until,
        };
        // Before that the point stays on one side wherever it is over the triangle.
        let mut side = 0.0;
        for j in 0..=400 {
            let t = until * f64::from(j) / 400.0;
            let ((pose_a, _), (pose_b, _)) = (a.pose_and_twist(t), b.pose_and_twist(t));
            let q = pose_b.inverse_transform_point(pose_a.transform_point(p));
            let n = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
            let inside = [0, 1, 2].iter().all(|&k| {
                let (from, to) = (triangle[k], triangle[(k + 1) % 3]);
                (to - from).cross(q - from).dot(n) > 0.0
            });
            let now = (q - triangle[0]).dot(n).signum();
            assert!(!inside || side == 0.0 || now == side || t >= until, "crossed before {until}: {t}");
            side = if inside { now } else { 0.0 };
        }
    }
    assert!(clear > 500, "{clear}");
}

/// Enclosures that are right but so wide that they say nothing useful.
#[test]
fn wide_enclosures_are_no_contact() {
    let falling = d2m_motion::ConstantTwist::REST
        .with_position(DVec3::Z)
        .with_linear_velocity(DVec3::X)
        .with_angular_velocity(DVec3::Z);
    let still = d2m_motion::ConstantTwist::REST;
    let floor = [DVec3::new(-4.0, -4.0, 0.0), DVec3::new(6.0, -4.0, 0.0), DVec3::new(0.0, 8.0, 0.0)];
    for (width, clear) in [(0.0, true), (1e-12, true), (0.3, true), (0.7, false), (f64::MAX, false)] {
        let wide = Blurred::by(falling, width);
        let pair = PairMotion::new(&wide, &still, 0.0, 1.0);
        let answer = pair.point_triangle(DVec3::ZERO, &floor, &ContactOptions::new());
        // A unit above the floor all the time.
        assert!(!matches!(answer, FirstContact::Contact(_)), "{width}: {answer:?}");
        assert!(!clear || width > 0.01 || answer == FirstContact::Clear, "{width}: {answer:?}");
    }
}

/// A point that falls, and is thrown to the side at a joint: the twist jumps.
#[derive(Debug, Clone, Copy)]
struct Bounce {
    joint: f64,
    speeds: [DVec3; 2],
}

impl Bounce {
    fn speed(&self, t: f64) -> DVec3 {
        self.speeds[usize::from(t >= self.joint)]
    }
}

impl RigidMotion for Bounce {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let before = t.min(self.joint);
        let translation = DVec3::Z + self.speeds[0] * before + self.speeds[1] * (t - before);
        let pose = Pose { rotation: DQuat::IDENTITY, translation, at: DVec3::ZERO };
        (pose, Twist { linear: self.speed(t), angular: DVec3::ZERO })
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let joint = Interval::point(self.joint);
        let before = t.min(joint);
        let translation = IntervalVec3::point(DVec3::Z)
            + IntervalVec3::point(self.speeds[0]) * before
            + IntervalVec3::point(self.speeds[1]) * (t.max(joint) - joint);
        IntervalPose { rotation: IntervalMat3::IDENTITY, translation, at: DVec3::ZERO }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        let first = IntervalVec3::point(self.speed(t.lo()));
        let inner = if t.lo() < t.hi() && t.hi() <= self.joint { self.speeds[0] } else { self.speed(t.hi()) };
        let last = IntervalVec3::point(inner);
        let linear = IntervalVec3::new(first.x.hull(last.x), first.y.hull(last.y), first.z.hull(last.z));
        IntervalTwist { linear, angular: IntervalVec3::point(DVec3::ZERO) }
    }
    fn enclose_twist_rate(&self, _: Interval) -> IntervalTwist {
        let zero = IntervalVec3::point(DVec3::ZERO);
        IntervalTwist { linear: zero, angular: zero }
    }
    fn smooth_until(&self, t: f64) -> Option<f64> {
        (t < self.joint).then_some(self.joint)
    }
    fn domain(&self) -> Interval {
        Interval::new(-10.0, 10.0)
    }
}

#[test]
fn twists_that_jump_are_searched_piece_by_piece() {
    let options = ContactOptions::new();
    let still = d2m_motion::ConstantTwist::REST;
    let floor = [DVec3::new(-4.0, -4.0, 0.0), DVec3::new(6.0, -4.0, 0.0), DVec3::new(0.0, 8.0, 0.0)];
    // At rest until the joint, then down by two units per unit of time: contact half a unit of time later.
    for joint in [0.125, 0.25, 0.4, 0.5] {
        let motion = Bounce { joint, speeds: [DVec3::ZERO, -2.0 * DVec3::Z] };
        let pair = PairMotion::new(&motion, &still, 0.0, 1.0);
        let FirstContact::Contact(contact) = pair.point_triangle(DVec3::ZERO, &floor, &options) else {
            panic!("{joint}")
        };
        assert!(contact.lo <= joint + 0.5 && contact.lo > joint + 0.5 - 1e-9, "{joint}: {contact:?}");
        // Down at first, up from the joint on: contact only if the joint comes late.
        let motion = Bounce { joint, speeds: [-2.0 * DVec3::Z, 3.0 * DVec3::Z] };
        let pair = PairMotion::new(&motion, &still, 0.0, 1.0);
        match pair.point_triangle(DVec3::ZERO, &floor, &options) {
            FirstContact::Clear => assert!(joint < 0.5),
            FirstContact::Contact(contact) => assert!(joint == 0.5 && contact.lo <= 0.5, "{contact:?}"),
            other @ FirstContact::Undecided { .. } => panic!("{other:?}"),
        }
        // Nothing is promised outside of the domain.
        let outside = PairMotion::new(&motion, &still, 0.0, 11.0);
        let answer = outside.point_triangle(DVec3::ZERO, &floor, &options);
        assert_eq!(answer, FirstContact::Undecided { clear_until: 0.0 });
    }
}

/// A point turns close above a face through hundreds of spans. However many pieces there are, the budget is one.
#[test]
fn all_pieces_share_one_budget() {
    let poses: Vec<(f64, Pose)> = (0..=400)
        .map(|k| {
            let rotation = DQuat::from_rotation_z(2.0 * f64::from(k));
            (f64::from(k), Pose { translation: DVec3::Z * 1e-3, rotation, at: DVec3::ZERO })
        })
        .collect();
    let floor = [DVec3::new(-4.0, -3.0, 0.0), DVec3::new(4.0, -3.0, 0.0), DVec3::new(0.0, 5.0, 0.0)];
    let tilted = floor.map(|p| DQuat::from_rotation_x(5e-4) * p);
    let ask = |evaluations: u32| {
        let path = Keyframes::try_new(&poses, Span::Linear).unwrap();
        let motion = CountedStates::new(path);
        let options = ContactOptions::new().with_max_evaluations(evaluations);
        let pair = PairMotion::new(&motion, &ConstantTwist::REST, 0.0, 400.0);
        let answer = pair.point_triangle(DVec3::X, &tilted, &options);
        (answer, motion.count())
    };
    let (whole, all) = ask(1 << 19);
    assert_eq!(whole, FirstContact::Clear);
    // An evaluation counts as eight, and takes a state or two.
    let (part, some) = ask(8 * 400);
    let FirstContact::Undecided { clear_until } = part else { panic!("{part:?}") };
    assert!(clear_until < 400.0 && 2 * some < all, "{clear_until}: {some} of {all}");
    assert!(clear_until > 1.0 || some > 200, "{clear_until}: {some}");
}

/// A closed form is no reason to go past the times of a motion.
#[test]
fn nothing_is_promised_outside_of_a_domain() {
    let rising = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z);
    let rising = Bounded(rising, Interval::new(0.0, 1.0));
    let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::X, DVec3::Y];
    let ask = |end| {
        let pair = PairMotion::new(&rising, &ConstantTwist::REST, 0.0, end);
        let placed = pair.place_triangle(&floor);
        let options = ContactOptions::new();
        let answer = pair.point_triangle(DVec3::ZERO, &floor, &options);
        assert_eq!(pair.point_placed(DVec3::ZERO, &placed, &options), answer);
        answer
    };
    assert_eq!(ask(1.0), FirstContact::Clear);
    assert_eq!(ask(1.5), FirstContact::Undecided { clear_until: 0.0 });
}
