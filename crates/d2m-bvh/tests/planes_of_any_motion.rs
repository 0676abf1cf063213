//! Bodies that slide past each other at a small gap by motions of their own: searched in long spans, and no contact is missed.

use d2m_bvh::{
    Answered, MeshTree, Moving, QueryOptions, TimeOfContact, TriMesh, Window, time_of_contact_counted,
};
use d2m_interval::{Interval, IntervalMat3, IntervalVec3};
use d2m_motion::{ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Twist, check_motion};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

const DELTA: f64 = 1e-10;

/// Along z at the height of `gap` − `sinks`·t, swinging along x and y, turning about z by sin(5t); all that in a frame turned by `frame`.
#[derive(Clone, Copy)]
struct Slides {
    gap: f64,
    sinks: f64,
    frame: DQuat,
}

const WAYS: [f64; 2] = [1.0, 0.5];
const RATES: [f64; 2] = [10.0, 7.0];
const TURN: f64 = 5.0;

impl Slides {
    fn seen(&self, v: IntervalVec3) -> IntervalVec3 {
        IntervalMat3::from_quat_normalized(self.frame).mul_vec(v)
    }

    fn swinging(&self, t: Interval, derivative: usize) -> IntervalVec3 {
        let one = |k: usize| {
            let (angle, rate, way) = (t * RATES[k], Interval::point(RATES[k]), Interval::point(WAYS[k]));
            match derivative {
                0 => way * angle.sin(),
                1 => way * rate * angle.cos(),
                _ => -(way * rate.sqr() * angle.sin()),
            }
        };
        let height = match derivative {
            0 => Interval::point(1.0) + Interval::point(self.gap) - t * self.sinks,
            1 => Interval::point(-self.sinks),
            _ => Interval::ZERO,
        };
        self.seen(IntervalVec3::new(one(0), one(1), height))
    }

    fn about_z(&self, rate: Interval) -> IntervalVec3 {
        self.seen(IntervalVec3::new(Interval::ZERO, Interval::ZERO, rate))
    }
}

impl RigidMotion for Slides {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        let now = Interval::point(t);
        let turn = DQuat::from_rotation_z((TURN * t).sin());
        let pose = Pose {
            rotation: self.frame.normalize() * turn,
            translation: self.swinging(now, 0).mid(),
            at: DVec3::ZERO,
        };
        let twist = self.enclose_twist(now);
        (pose, Twist { linear: twist.linear.mid(), angular: twist.angular.mid() })
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let turn = IntervalMat3::rotation(DVec3::Z, (t * TURN).sin());
        let rotation = IntervalMat3::from_quat_normalized(self.frame).mul_mat(turn);
        IntervalPose { rotation, translation: self.swinging(t, 0), at: DVec3::ZERO }
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        IntervalTwist { linear: self.swinging(t, 1), angular: self.about_z((t * TURN).cos() * TURN) }
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        let rate = -((t * TURN).sin() * (TURN * TURN));
        IntervalTwist { linear: self.swinging(t, 2), angular: self.about_z(rate) }
    }
}

fn box_of(half: DVec3) -> MeshTree {
    MeshTree::new(Surface::cube(1.0).map(|p| p * half).into_mesh(TriMesh::try_new))
}

fn asked(slides: &Slides, end: f64) -> Answered<TimeOfContact> {
    let (block, plate) = (box_of(DVec3::splat(0.5)), box_of(DVec3::new(50.0, 50.0, 0.5)));
    let rests = ConstantTwist::REST.with_orientation(slides.frame);
    let options = QueryOptions::default().with_tolerance(DELTA);
    let window = Window::try_new(0.0, end).unwrap();
    time_of_contact_counted(Moving::new(&block, slides), Moving::new(&plate, &rests), window, &options)
        .unwrap()
}

fn frames() -> Vec<DQuat> {
    let mut random = KnuthRandom(5);
    std::iter::once(DQuat::IDENTITY).chain((0..3).map(|_| random.quaternion())).collect()
}

#[test]
fn what_slides_is_free_in_long_spans() {
    for frame in frames() {
        for gap in [1e-5, 1e-6, 1e-7] {
            let slides = Slides { gap, sinks: 0.0, frame };
            assert!(check_motion(&slides, Interval::new(0.0, 60.0), 50).is_empty());
            let answered = asked(&slides, 60.0);
            assert_eq!(answered.answer, TimeOfContact::Separated, "{gap}");
            // Along axes the enclosures know that nothing moves across the plate; turned, they know it to second order.
            let most = if frame == DQuat::IDENTITY { 1 << 12 } else { 1 << 24 };
            assert!(answered.work.work() < most, "{gap:e}: {}", answered.work.work());
        }
    }
}

#[test]
fn what_sinks_while_it_slides_is_found_in_time() {
    for frame in frames() {
        for (gap, touches) in [(1e-4, 3.0), (1e-5, 7.0), (1e-5, 0.25)] {
            let slides = Slides { gap, sinks: gap / touches, frame };
            let answered = asked(&slides, 2.0 * touches);
            let contact = answered.answer.contact().expect("it touches");
            let left = slides.sinks * (touches - contact.time_lo);
            assert!(left > 0.0 && left < 3.4 * contact.tolerance, "{left:e} {contact:?}");
            assert!(answered.work.work() < 1 << 20, "{gap:e}: {}", answered.work.work());
        }
    }
}
