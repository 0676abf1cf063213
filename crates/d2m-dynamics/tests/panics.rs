//! Listeners and motions are others' code: where one panics, the simulation is as after an error, and can go on.

mod ground;

use d2m_bvh::{QueryOptions, StartState};
use d2m_dynamics::{Body, BodyId, ContactImpulse, Kind, Simulation, SimulationOptions};
use d2m_interval::{Interval, IntervalVec3};
use d2m_motion::{IntervalPose, IntervalTwist, Pose, RigidMotion, Twist};
use glam::DVec3;
use ground::cube;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Two cubes fly along x, one after the other, in steps of a tenth.
fn followed() -> (Simulation, [BodyId; 2]) {
    let options = SimulationOptions::default().with_gravity(DVec3::ZERO).with_step(0.1);
    let mut simulation = Simulation::new(options).unwrap();
    let flying = |name: &str, x: f64, speed: f64| {
        let body = Body::new(name, cube()).with_restitution(1.0).with_position(DVec3::X * x);
        body.with_linear_velocity(DVec3::X * speed)
    };
    let ids = [("first", 0.0, 60.0), ("next", -2.5, 59.0)];
    let ids = ids.map(|(name, x, speed)| simulation.add(&flying(name, x, speed)).unwrap());
    (simulation, ids)
}

/// The bodies stand where they were flown to, at the time that is left, and go on from there, apart from each other.
fn goes_on(simulation: &mut Simulation, ids: [BodyId; 2]) {
    let (time, before) = (simulation.time(), ids.map(|id| simulation.position(id)));
    assert!(time > 0.0 && before[0].x > 0.0, "{time} {before:?}");
    simulation.step_to(time + 1e-9).unwrap();
    for (id, before) in ids.into_iter().zip(before) {
        assert!((simulation.position(id) - before).length() < 1e-6, "{before} {}", simulation.position(id));
    }
    while simulation.time() < 0.5 {
        simulation.step().unwrap();
        let frozen = simulation.frozen(QueryOptions::default());
        assert_eq!(frozen.distance(ids[0], ids[1]).unwrap().state, StartState::Apart);
    }
}

/// The bodies were at the start of the step again, in others that had moved on; a listener hears all of a step until it panics, and the
/// recording has what came last.
#[test]
fn a_listener_that_panics_moves_no_body() {
    let (mut simulation, ids) = followed();
    let wall = Body::new("wall", cube()).with_kind(Kind::Static).with_position(DVec3::X * 6.0);
    let wall = simulation.add(&wall).unwrap();
    let mut heard = 0;
    let unwound = catch_unwind(AssertUnwindSafe(|| {
        let listener = &mut |_: &ContactImpulse| {
            heard += 1;
            panic!("a listener of the test");
        };
        simulation.step_with(listener)
    }));
    assert!(unwound.is_err() && heard == 1);
    assert!(simulation.time() > 0.08 && simulation.time() < 0.09);
    assert!(simulation.touch(wall, ids[0]));
    goes_on(&mut simulation, ids);
}

/// Goes ever faster, so that a step has several flights. The first query of its pose within the second half of a step panics.
struct Fails {
    failed: AtomicBool,
}

impl RigidMotion for Fails {
    fn pose_and_twist(&self, t: f64) -> (Pose, Twist) {
        assert!(t <= 0.05 || t >= 0.1 || self.failed.swap(true, Ordering::Relaxed), "a motion of the test");
        let twist = Twist { linear: DVec3::Y * t, ..Twist::ZERO };
        (Pose { translation: DVec3::Y * (9.0 + 0.5 * t * t), ..Pose::IDENTITY }, twist)
    }

    fn enclose_pose(&self, t: Interval) -> IntervalPose {
        let y = Interval::point(9.0) + Interval::point(0.5) * (t * t);
        IntervalPose { translation: IntervalVec3 { y, ..IntervalVec3::ZERO }, ..IntervalPose::IDENTITY }
    }

    fn enclose_twist(&self, t: Interval) -> IntervalTwist {
        IntervalTwist { linear: IntervalVec3 { y: t, ..IntervalVec3::ZERO }, angular: IntervalVec3::ZERO }
    }

    fn enclose_twist_rate(&self, _: Interval) -> IntervalTwist {
        let y = Interval::point(1.0);
        IntervalTwist { linear: IntervalVec3 { y, ..IntervalVec3::ZERO }, angular: IntervalVec3::ZERO }
    }
}

#[test]
fn a_motion_that_panics_moves_no_body() {
    let (mut simulation, ids) = followed();
    let motion = Arc::new(Fails { failed: AtomicBool::new(false) });
    simulation.add(&Body::new("driven", cube()).with_kind(Kind::Kinematic(motion))).unwrap();
    assert!(catch_unwind(AssertUnwindSafe(|| simulation.step())).is_err());
    assert!(simulation.time() > 0.005 && simulation.time() < 0.1, "{}", simulation.time());
    goes_on(&mut simulation, ids);
}

/// A step that began with momenta beyond all numbers, after the segments of a run were taken, was a panic of the simulation's own.
#[test]
fn momenta_beyond_all_numbers_are_an_error_of_every_step() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let floor = Body::new("floor", cube()).with_kind(Kind::Static).with_position(DVec3::Y * -0.5);
    simulation.add(&floor).unwrap();
    simulation.add(&Body::new("cube", cube()).with_position(DVec3::Y * 0.501)).unwrap();
    simulation.step().unwrap();
    simulation.set_gravity(DVec3::Y * -1e300).unwrap();
    let mut errors = 0;
    for _ in 0..6 {
        errors += u32::from(simulation.step().is_err());
        simulation.finish();
    }
    assert!(errors > 2, "{errors}");
}
