//! A motion of one's own: a point on a cubic Bézier curve, the body turning ever faster about a fixed axis. It says
//! how to enclose itself, and the certified tests do the rest.
//!
//! Run with `cargo run -p d2m-feature --example spline_motion`.
use d2m_feature::{ContactOptions, FirstContact, PairMotion};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
use glam::{DQuat, DVec3};

/// x(t) = c₀ + c₁t + c₂t² + c₃t³; turned by the angle ½αt² about `axis` (unit).
struct Spline {
    c: [DVec3; 4],
    axis: DVec3,
    spin_up: f64,
}

impl Spline {
    /// Power form of the Bézier curve with the given control points.
    fn bezier(p: [DVec3; 4], axis: DVec3, spin_up: f64) -> Self {
        let c =
            [p[0], (p[1] - p[0]) * 3.0, (p[0] - p[1] * 2.0 + p[2]) * 3.0, p[3] - p[0] + (p[1] - p[2]) * 3.0];
        Self { c, axis, spin_up }
    }

    /// The angle over an interval of time.
    fn angle(&self, t: Interval) -> Interval {
        t.sqr() * (0.5 * self.spin_up)
    }
}

/// Horner in interval arithmetic.
fn horner(c: &[IntervalVec3], t: Interval) -> IntervalVec3 {
    c.iter().rev().fold(IntervalVec3::ZERO, |sum, c| sum * t + *c)
}

impl RigidMotion for Spline {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let [c0, c1, c2, c3] = self.c;
        let rotation = DQuat::from_axis_angle(self.axis, 0.5 * self.spin_up * t * t);
        let pose = Pose { rotation, translation: c0 + (c1 + (c2 + c3 * t) * t) * t, at: DVec3::ZERO };
        let linear = c1 + (c2 * 2.0 + c3 * (3.0 * t)) * t;
        (pose, Twist { linear, angular: self.axis * (self.spin_up * t) })
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        // exp([axis]·angle): the angle takes the place of time.
        let rotation = IntervalMat3::rotation(self.axis, self.angle(t));
        let translation = horner(&self.c.map(IntervalVec3::point), t);
        IntervalPose { rotation, translation, at: DVec3::ZERO }
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        // Twice and three times the coefficients in interval arithmetic: 3c is rounded.
        let [_, c1, c2, c3] = self.c.map(IntervalVec3::point);
        let linear = horner(&[c1, c2 * 2.0, c3 * 3.0], t);
        IntervalTwist { linear, angular: IntervalVec3::point(self.axis) * (t * self.spin_up) }
    }

    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let [_, _, c2, c3] = self.c.map(IntervalVec3::point);
        let linear = horner(&[c2 * 2.0, c3 * 6.0], t);
        IntervalTwist { linear, angular: IntervalVec3::point(self.axis) * self.spin_up }
    }
}

fn main() {
    let control =
        [DVec3::new(-3.0, 0.0, 1.0), DVec3::new(-1.0, 2.0, 2.0), DVec3::new(1.0, -2.0, 0.0), DVec3::ZERO];
    let spline = Spline::bezier(control, DVec3::Z, 4.0);
    let wall = ConstantTwist::REST.with_angular_velocity(DVec3::new(0.0, 0.1, 0.0));
    let triangle = [DVec3::new(0.2, -4.0, -4.0), DVec3::new(0.2, 4.0, -4.0), DVec3::new(0.2, 0.0, 6.0)];
    let pair = PairMotion::new(&spline, &wall, 0.0, 1.0);
    let vertex = DVec3::new(0.5, 0.0, 0.0);
    match pair.point_triangle(vertex, &triangle, &ContactOptions::new()) {
        FirstContact::Contact(contact) => {
            let details = pair.point_triangle_details(vertex, &triangle, contact.lo);
            println!("contact in [{}, {}] ({:?})", contact.lo, contact.hi, contact.evidence);
            println!(
                "at {} with normal {}, closing at {}",
                details.point_a, details.normal, details.closing_speed
            );
            assert!(contact.hi - contact.lo < 1e-9);
            assert!(details.point_a.distance(details.point_b) < 1e-8);
            // Just before, the vertex is still in front of the wall.
            let before = spline.pose_and_twist(contact.lo - 1e-6).0.transform_point(vertex);
            let behind = wall.pose_and_twist(contact.lo - 1e-6).0.inverse_transform_point(before);
            assert!(behind.x < 0.2);
        }
        other => panic!("the vertex meets the wall: {other:?}"),
    }
}

#[test]
fn its_answers_are_right() {
    main();
}
