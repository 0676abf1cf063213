//! Poses of motions that have turned many times since their reference time, against exact arithmetic.

use d2m_motion::{ConstantTwist, RigidMotion};
use d2m_testing::big::{self, number};
use d2m_testing::{Draw, Random};
use glam::{DQuat, DVec3};

/// Bits of the exact arithmetic: an angle of 2²⁹ loses 30 of them as its turn is doubled.
const BITS: usize = 512;

/// The rotation at any time is within its radius of the exact one, and after many turns known to a few roundings: a body whose motion begins long before the window
/// is as certain as one whose motion begins there.
#[test]
fn many_turns_cost_no_precision() {
    let mut random = Random(2711);
    let mut largest = 0.0_f64;
    for i in 0..60 {
        let angle = [900.0, 1025.0, 3e4, 1e6, 4e8][i % 5];
        let time = [1e-3, 1.0, 1e5][i % 3] * (1.0 + random.unit());
        let rate = random.vector().normalize() * (angle / time);
        let (axis, turn) = (random.vector().normalize(), random.signed());
        let motion = ConstantTwist::REST
            .with_orientation(DQuat::from_axis_angle(axis, turn))
            .with_angular_velocity(rate)
            .with_reference_time([0.0, -0.75, 1e6][i / 5 % 3]);
        let t = motion.reference_time() + time;
        let state = motion.enclose_state(t);
        let truth = big::place::<BITS>(&motion, DVec3::AXES, &number::<BITS>(t));
        let error = |column: usize, entries: DVec3| {
            let off = big::sub(&big::vector::<BITS>(entries), &truth[column]);
            DVec3::from_array(off.map(|x| x.to_f64().value()))
        };
        let off = (0..3).map(|k| error(k, state.rotation.col(k)).length_squared()).sum::<f64>().sqrt();
        assert!(off <= state.rotation_radius, "{motion:?} at {t}: {off:e} of {:e}", state.rotation_radius);
        assert!(state.rotation_radius < 1e-12, "{motion:?} at {t}: {:e}", state.rotation_radius);
        let (pose, _) = motion.pose_and_twist(t);
        for (column, axis) in DVec3::AXES.into_iter().enumerate() {
            assert!(error(column, pose.rotation * axis).length() < 1e-15, "{motion:?} at {t}");
        }
        if angle > 1024.0 {
            largest = largest.max(off / state.rotation_radius);
        }
    }
    // Rounding alone may take √3 of the four units that are counted: the count is not empty.
    assert!(largest > 0.2 && largest < 0.44, "{largest}");
}
