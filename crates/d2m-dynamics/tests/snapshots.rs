//! Snapshots that are gone back to, and recordings that begin anew: what they state is where the bodies are.

mod ground;

use d2m_bvh::MeshTree;
use d2m_dynamics::{
    Body, Joint, JointKind, Kind, Motor, MotorTarget, Presence, Simulation, SimulationError,
    SimulationOptions, TouchChange,
};
use d2m_motion::{ConstantTwist, RigidMotion};
use glam::DVec3;
use ground::{cube, floor, tree};
use std::sync::Arc;

/// What is still to be reported of who touches is a part of the state: the end of a touch by a removal comes with the next step, also after the
/// state in between was gone back to.
#[test]
fn what_is_still_to_be_reported_is_kept() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let body = simulation.add(&Body::new("cube", cube()).with_position(DVec3::Y * 0.501)).unwrap();
    let began = simulation.snapshot();
    assert_eq!((0..20).map(|_| simulation.step().unwrap().touches.len()).sum::<usize>(), 1);
    simulation.remove(body);
    let removed = simulation.snapshot();
    let first = simulation.step().unwrap().touches;
    assert!(first.len() == 1 && first[0].b == body && first[0].change == TouchChange::Ended);
    simulation.restore(&removed).unwrap();
    assert_eq!(simulation.step().unwrap().touches, first);
    assert!(simulation.restore(&began).is_err());
    assert_eq!(simulation.step().unwrap().touches, []);
}

/// A snapshot is gone back to after bodies and joints were added, joints taken out, kinds and materials changed: the steps have the same
/// bits, and the names of bodies that are gone mean no others.
#[test]
fn snapshots_survive_additions() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    simulation.add(&floor()).unwrap();
    let [a, b] = [0.0, 1.2].map(|x| {
        let body = Body::new("cube", cube()).with_friction(0.5).with_position(DVec3::new(x, 2.0, 0.0));
        simulation.add(&body).unwrap()
    });
    let mut motor = Motor::new(MotorTarget::Velocity(3.0));
    motor.most = 500.0;
    let hinge = Joint::new(JointKind::Revolute, a, Some(b), DVec3::new(0.6, 2.0, 0.0)).with_motor(motor);
    let hinge = simulation.add_joint(&hinge).unwrap();
    for _ in 0..20 {
        simulation.step().unwrap();
    }
    let snapshot = simulation.snapshot();
    let run = |simulation: &mut Simulation| {
        for _ in 0..60 {
            simulation.step().unwrap();
        }
        ([a, b].map(|id| simulation.pose(id)), simulation.joint_value(hinge))
    };
    let first = run(&mut simulation);
    let late = simulation.add_checked(&Body::new("late", cube()).with_position(DVec3::Y * 9.0)).unwrap();
    simulation.add_joint(&Joint::new(JointKind::Spherical, late, None, DVec3::Y * 9.5)).unwrap();
    simulation.set_kind(b, Kind::Static).unwrap();
    simulation.set_material(a, 1.0, 0.0).unwrap();
    simulation.set_motor(hinge, None).unwrap();
    simulation.remove_joint(hinge);
    simulation.ignore(a, late);
    for _ in 0..60 {
        simulation.step().unwrap();
    }
    simulation.restore(&snapshot).unwrap();
    assert_eq!(simulation.snapshot(), snapshot);
    assert!(!simulation.contains(late) && simulation.len() == 3 && simulation.joint(hinge).is_some());
    assert_eq!(run(&mut simulation), first);
    let later = simulation.add_checked(&Body::new("later", cube()).with_position(DVec3::Y * 9.0)).unwrap();
    assert!(later.index() == late.index() && later != late && !simulation.contains(late));
    // A body of the snapshot that is gone cannot come back.
    simulation.remove(b);
    assert_eq!(simulation.restore(&snapshot), Err(SimulationError::Snapshot { place: b.index() }));
}

/// What stands for the world of joints may have another place than in the snapshot, or its own may have gone to a body since.
#[test]
fn the_world_of_a_snapshot_has_its_place_again() {
    let free = || Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
    let mut simulation = free();
    let hung = simulation.add(&Body::new("hung", cube())).unwrap();
    let first = simulation.snapshot();
    let others =
        [3.0, 6.0].map(|x| simulation.add(&Body::new("", cube()).with_position(DVec3::X * x)).unwrap());
    let joint = Joint::new(JointKind::Spherical, hung, None, DVec3::Y);
    simulation.add_joint(&joint).unwrap();
    for id in others {
        assert!(simulation.remove(id));
    }
    let last = simulation.snapshot();
    // Nothing at the world's place, nor before it.
    simulation.restore(&first).unwrap();
    simulation.restore(&last).unwrap();
    assert_eq!(simulation.snapshot(), last);
    // Bodies at its place and before it, and another world after them.
    simulation.restore(&first).unwrap();
    let added =
        [3.0, 6.0, 9.0].map(|x| simulation.add(&Body::new("", cube()).with_position(DVec3::X * x)).unwrap());
    simulation.add_joint(&joint).unwrap();
    simulation.restore(&last).unwrap();
    assert_eq!(simulation.snapshot(), last);
    assert!(added.into_iter().all(|id| !simulation.contains(id)) && simulation.len() == 1);
    let next = simulation.add(&Body::new("next", cube()).with_position(DVec3::X * 3.0)).unwrap();
    assert!(next.index() == 1 && !added.contains(&next) && !others.contains(&next));
    simulation.apply_impulse(hung, DVec3::X * 100.0, DVec3::ZERO).unwrap();
    simulation.step().unwrap();
    assert!((simulation.pose(hung).transform_point(DVec3::Y) - DVec3::Y).length() < 1e-6);
}

/// A snapshot of other bodies is checked: it may have them in each other.
#[test]
fn snapshots_of_other_bodies_are_checked() {
    let two = |size: f64| {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        let shape = tree(&format!("box?x={size}&y={size}&z={size}"));
        for x in [0.0, 1.0] {
            simulation
                .add(&Body::new("cube", Arc::clone(&shape)).with_position(DVec3::X * x * 2.0 * size * 1.1))
                .unwrap();
        }
        simulation.step().unwrap();
        simulation
    };
    let (small, mut large) = (two(0.5), two(1.0));
    assert!(matches!(large.restore(&small.snapshot()), Err(SimulationError::Intersecting { .. })));
    // Of the same shapes, but in each other, as a sensor may be.
    let placed = |presence: Presence, shape: &Arc<MeshTree>, x: f64| {
        let mut simulation = Simulation::new(SimulationOptions::default().with_gravity(DVec3::ZERO)).unwrap();
        simulation.add(&Body::new("one", Arc::clone(shape)).with_presence(presence)).unwrap();
        simulation.add(&Body::new("other", Arc::clone(shape)).with_position(DVec3::X * x)).unwrap();
        simulation.step().unwrap();
        simulation
    };
    let shape = cube();
    let overlapping = placed(Presence::Sensor, &shape, 0.5).snapshot();
    let mut solid = placed(Presence::Solid, &shape, 2.0);
    assert!(matches!(solid.restore(&overlapping), Err(SimulationError::Intersecting { .. })));
    let same = two(0.5);
    let mut small = small;
    small.restore(&same.snapshot()).unwrap();
}

/// A body that is removed after the segments were finished is stated by the first one of those that follow.
#[test]
fn what_is_removed_between_two_recordings_is_stated() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let falling = simulation.add(&Body::new("falling", cube())).unwrap();
    let other = simulation.add(&Body::new("other", cube()).with_position(DVec3::X * 3.0)).unwrap();
    simulation.step().unwrap();
    assert!(simulation.finish().iter().all(|segment| segment.removed.is_empty()));
    assert!(simulation.remove(other));
    let mut segments = simulation.step().unwrap().segments;
    segments.extend(simulation.finish());
    assert_eq!(segments[0].removed, [other]);
    assert!(segments[1..].iter().all(|segment| segment.removed.is_empty()));
    assert!(segments[0].changed.iter().any(|(id, _)| *id == falling));
}

/// Each recording begins with where the bodies are, however long they have flown before it.
#[test]
fn a_recording_begins_where_its_bodies_are() {
    let mut simulation = Simulation::new(SimulationOptions::default()).unwrap();
    let turning = ConstantTwist::REST.with_position(DVec3::X * 9.0).with_angular_velocity(DVec3::Z);
    let wheel = Body::new("wheel", cube()).with_kind(Kind::Kinematic(Arc::new(turning)));
    let thrown =
        Body::new("thrown", cube()).with_linear_velocity(DVec3::X).with_angular_velocity(DVec3::Z * 3.0);
    let ids = [wheel, thrown].map(|body| simulation.add(&body).unwrap());
    for _ in 0..5 {
        simulation.step().unwrap();
    }
    let snapshot = simulation.snapshot();
    for restores in [false, true] {
        simulation.finish();
        if restores {
            simulation.restore(&snapshot).unwrap();
        }
        let places = ids.map(|id| simulation.pose(id));
        let segments = simulation.step().unwrap().segments;
        for (id, place) in ids.into_iter().zip(places) {
            let stated = segments[0].changed.iter().find(|(changed, _)| *changed == id).unwrap();
            let pose = stated.1.pose_and_twist(segments[0].start).0;
            let off = pose.transform_point(DVec3::ONE) - place.transform_point(DVec3::ONE);
            assert!(off.length() < 1e-14, "{restores}: {off}");
        }
    }
}
