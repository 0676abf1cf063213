//! Queries that are cancelled from elsewhere end undecided, in the middle too, and what they proved until then holds.

use d2m_bvh::{
    Budget, CancelFlag, Canceller, ClearanceOptions, ClearanceStatus, MeshTree, Moving, PairCache, Posed,
    ProximityOptions, QueryOptions, Solid, TimeOfContact, TriMesh, Window, bound_distance, clearance,
    collide_within, proximities_within, time_of_contact, time_of_contact_batch, time_of_contact_with,
};
use d2m_interval::Interval;
use d2m_motion::{
    CertifiedState, ConstantTwist, IntervalPose, IntervalTwist, Pose, RigidMotion, Spline, Twist,
};
use d2m_testing::Surface;
use glam::{DQuat, DVec3};
use std::sync::atomic::{AtomicU32, Ordering};

/// A motion whose owner loses patience after so many questions.
struct Impatient<'a> {
    motion: &'a Spline,
    canceller: &'a Canceller,
    questions: AtomicU32,
    patience: u32,
}

impl RigidMotion for Impatient<'_> {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        self.motion.pose_and_twist(t)
    }
    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        self.motion.enclose_pose(t)
    }
    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist(t)
    }
    fn enclose_twist_rate(&self, t: Interval) -> IntervalTwist {
        self.motion.enclose_twist_rate(t)
    }
    fn domain(&self) -> Interval {
        self.motion.domain()
    }
    fn smooth_until(&self, t: f64) -> Option<f64> {
        self.motion.smooth_until(t)
    }
    fn enclose_state(&self, t: f64) -> CertifiedState {
        if self.questions.fetch_add(1, Ordering::Relaxed) >= self.patience {
            self.canceller.cancel();
        }
        self.motion.enclose_state(t)
    }
}

fn ring() -> MeshTree {
    MeshTree::new(Surface::wavy_torus(24, 10, 0.3).into_mesh(TriMesh::try_new))
}

/// Comes near twelve times and goes away again.
fn visits() -> Spline {
    let pose = |k: u32| Pose {
        translation: DVec3::new(if k.is_multiple_of(2) { 4.0 } else { 2.75 }, 0.0, 0.1),
        rotation: DQuat::from_rotation_z(f64::from(k)),
        at: DVec3::ZERO,
    };
    let keys: Vec<_> = (0..=24).map(|k| (f64::from(k), pose(k))).collect();
    Spline::try_through(&keys, d2m_motion::SplineDegree::Cubic).unwrap()
}

fn until(flag: CancelFlag) -> Budget {
    Budget::UNLIMITED.with_cancel(flag)
}

#[test]
fn a_query_ends_in_the_middle() {
    let (ring, visits) = (ring(), visits());
    let window = Window::try_new(0.0, 24.0).unwrap();
    let ask = |patience: u32| {
        let canceller = Canceller::new();
        let motion =
            Impatient { motion: &visits, canceller: &canceller, questions: AtomicU32::new(0), patience };
        let options = QueryOptions::default().with_budget(until(canceller.flag()));
        let [a, b] = [Moving::new(&ring, &motion), Moving::new(&ring, &ConstantTwist::REST)];
        let answer = time_of_contact(a, b, window, &options).unwrap();
        (answer, motion.questions.load(Ordering::Relaxed))
    };
    let (whole, all) = ask(u32::MAX);
    assert!(whole.is_separated() && all > 24, "{whole:?} {all}");
    let mut last = 0.0;
    for patience in [0, all / 4, all / 2, all - 2] {
        let (answer, questions) = ask(patience);
        let TimeOfContact::Undecided { clear_until } = answer else { panic!("{patience}: {answer:?}") };
        assert!(clear_until >= last && clear_until < 24.0, "{patience}: {clear_until} {last}");
        assert!(questions <= patience + 4, "{questions} {patience}");
        last = clear_until;
    }
    assert!(last > 12.0, "{last}");
}

#[test]
fn every_kind_of_query_is_cancelled() {
    let ring = ring();
    let canceller = Canceller::new();
    let options = QueryOptions::default().with_budget(until(canceller.flag()));
    let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
    let [a, b] = [Moving::new(&ring, &falling), Moving::new(&ring, &ConstantTwist::REST)];
    let still = |z: f64| Posed::new(&ring, Pose { translation: DVec3::Z * z, ..Pose::IDENTITY });
    let ask = || {
        let mut cache = PairCache::new();
        let pairs = vec![(a, b); 9];
        let batch = time_of_contact_batch(&pairs, Window::UNIT, &options);
        let budget = &options.budget;
        let bounds = bound_distance(still(1.5), still(0.0), Solid::Surface, budget).unwrap();
        [
            time_of_contact(a, b, Window::UNIT, &options).unwrap().contact().is_some(),
            time_of_contact_with(a, b, Window::UNIT, &options, &mut cache).unwrap().contact().is_some(),
            batch.into_iter().all(|answer| answer.unwrap().contact().is_some()),
            collide_within(still(0.1), still(0.0), Solid::Surface, budget).unwrap().is_some(),
            proximities_within(still(1.5), still(0.0), &ProximityOptions::new(1.5), budget)
                .unwrap()
                .is_some(),
            bounds.upper - bounds.lower < 1e-3,
        ]
    };
    assert_eq!(ask(), [true; 6]);
    canceller.cancel();
    assert_eq!(ask(), [false; 6]);
}

/// Of bodies that lie on each other all over it takes many tests to prove that they share a point: what a small budget does not pay for is not done.
#[test]
fn clearances_of_bodies_that_meet_keep_the_budget() {
    let ring = ring();
    let turned = DQuat::from_rotation_x(0.7);
    let still = ConstantTwist::REST.with_orientation(turned);
    let [a, b] = [still, still.with_linear_velocity(DVec3::X)];
    let bodies = [&a, &b].map(|motion| Moving::new(&ring, motion));
    let within = |budget: Budget| {
        let options = ClearanceOptions::default().with_budget(budget);
        clearance(bodies[0], bodies[1], Window::UNIT, &options).unwrap()
    };
    assert_eq!(within(Budget::UNLIMITED).upper, 0.0);
    let small = (0..30).map(|k| within(Budget::UNLIMITED.with_node_tests(1 << k)));
    let first = small.into_iter().find(|found| found.status == ClearanceStatus::Contact).unwrap();
    assert!(first.upper > 0.0 && first.upper < 1e-9, "{first:?}");
}
