//! Motions that are followed by fitted twists, at times where the numbers for time are far apart, and in other units of time.

use d2m_bvh::{
    Evidence, MeshTree, Moving, Posed, QueryOptions, Solid, TimeOfContact, TriMesh, Window, distance,
    time_of_contact,
};
use d2m_motion::{
    Chain, Composed, ConstantTwist, Joint, JointKind, JointValue, Pose, Retimed, RigidMotion, Spline,
    SplineDegree,
};
use d2m_testing::Surface;
use glam::{DQuat, DVec3, dvec3};

/// From one double for time to the next the bodies move by many tolerances: what is left at `time_lo` is covered by the
/// tolerance that is reported.
#[test]
fn what_is_left_is_covered() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let tree = MeshTree::new(Surface::tetrahedron(corners).into_mesh(TriMesh::try_new));
    let mut covered = 0;
    for round in 0..40 {
        let start = 1e6 + f64::from(round) * 0.37;
        let pose = |x: f64, turn: f64| Pose {
            rotation: DQuat::from_xyzw(0.3, turn, 0.1, 1.0).normalize(),
            translation: dvec3(x, 0.1, 0.2),
            at: DVec3::ZERO,
        };
        let frames =
            [(start, pose(12.0, 0.1)), (start + 0.5, pose(-3.0, 1.0)), (start + 1.0, pose(9.0, -1.0))];
        let motion = Spline::try_through(&frames, SplineDegree::Cubic).unwrap();
        let window = Window::try_new(start, start + 1.0).unwrap();
        let (a, b) = (Moving::new(&tree, &motion), Moving::new(&tree, &ConstantTwist::REST));
        let TimeOfContact::Contact(contact) =
            time_of_contact(a, b, window, &QueryOptions::default()).unwrap()
        else {
            panic!("they meet")
        };
        let placed = Posed::new(&tree, motion.pose_and_twist(contact.time_lo).0);
        let left = distance(placed, Posed::at_rest(&tree), Solid::Filled).unwrap();
        assert!(left.lower <= 3.3 * contact.tolerance, "{left:?} {contact:?}");
        assert!(left.lower <= contact.separation + contact.tolerance, "{left:?} {contact:?}");
        assert!(contact.evidence >= Evidence::Near);
        covered += u32::from(contact.tolerance > 1e-9);
    }
    assert!(covered > 0, "no scene needs it");
}

/// A body that falls from rest, in units of time whose square is no number: it is nowhere late, and its acceleration is not left out.
#[test]
fn what_falls_is_met_in_any_unit_of_time() {
    let cube = Surface::cube(0.5);
    for (meter, second) in [(0, 0), (-90, -540), (-150, -570), (-60, 400), (0, 450)] {
        let (meter, second) = (2f64.powi(meter), 2f64.powi(second));
        let tree = MeshTree::new(cube.clone().map(|p| p * meter).into_mesh(TriMesh::try_new));
        let fall = -2.0 * (meter / second) / second;
        let value = JointValue::try_polynomial(vec![0.0, 0.0, fall]).unwrap();
        let down = JointKind::Prismatic { axis: DVec3::Z, value };
        let falling = |height: f64| {
            let place = dvec3(0.125, 0.25, height) * meter;
            Chain::try_new(vec![Joint::try_new(place, DQuat::IDENTITY, down.clone()).unwrap()]).unwrap()
        };
        let carried = ConstantTwist::REST.with_position(DVec3::Z * meter);
        let motions: [Box<dyn RigidMotion>; 3] = [
            Box::new(falling(2.0)),
            Box::new(Composed::new(carried, falling(1.0))),
            Box::new(Retimed::try_new(falling(2.0), 1.0, 0.0).unwrap()),
        ];
        // From 1 above the other one.
        let met = 0.5_f64.sqrt();
        for motion in motions {
            let bodies = (Moving::new(&tree, &*motion), Moving::new(&tree, &ConstantTwist::REST));
            let window = Window::try_new(0.0, second).unwrap();
            let found = time_of_contact(bodies.0, bodies.1, window, &QueryOptions::default()).unwrap();
            let contact = found.contact().expect("they meet");
            let time = contact.time_lo / second;
            assert!(time <= met && time > met - 1e-9, "{meter:e} {second:e}: {contact:?}");
        }
    }
}
