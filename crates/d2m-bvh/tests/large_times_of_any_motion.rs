//! Motions that are followed by fitted twists, at times where the numbers for time are far apart.

use d2m_bvh::{
    Evidence, MeshTree, Moving, Posed, QueryOptions, Solid, TimeOfContact, TriMesh, Window, distance,
    time_of_contact,
};
use d2m_motion::{ConstantTwist, Pose, RigidMotion, Spline, SplineDegree};
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
