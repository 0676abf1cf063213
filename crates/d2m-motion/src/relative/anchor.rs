//! Anchors: reference points far from the centers of rotation, evaluated in double-double.
//!
//! A vertex 1e6 away from its body's center of rotation loses 1e-10 to rounding alone. With a body point near the
//! feature as anchor on either side, the frame's position is made in double-double from the exact inputs, relative
//! to B's anchor, and only short vectors are rounded in double precision.
use super::{Frame, RelativeMotion};
use crate::rotation::exponential_dd;
use crate::rounding::{UNIT, UP};
use d2m_lanes::DoubleDouble;
use glam::DVec3;

/// Rounding of the position of an anchored frame and of all that is made of it, in units of 2⁻⁵³ of its length: 24 are
/// counted in docs/theory/features.md, "Anchors".
const ROUNDING: f64 = 32.0;

#[derive(Debug, Clone, Copy)]
pub(super) struct Anchor {
    /// Anchor on A, body frame, exact.
    pub(super) point_a: DVec3,
    /// Anchor on B, body frame, exact.
    pub(super) point_b: DVec3,
    /// Vector from A's reference point to the anchor, world axes at the epoch.
    arm_a: [DoubleDouble; 3],
    /// The same for B.
    arm_b: [DoubleDouble; 3],
    /// Upper bound of |arm_a|.
    pub(super) arm: f64,
    /// Upper bound of |arm_a| + |arm_b|.
    pub(super) arms: f64,
    /// Upper bound of everything that was added up.
    magnitude: f64,
}

impl RelativeMotion {
    /// The same motion with points measured from `point_a` and `point_b` (body frames) and frames whose position is
    /// made in extended precision: about ten times slower, for features far from their center of rotation.
    pub fn anchored(&self, point_a: DVec3, point_b: DVec3) -> Self {
        let arm = |point: DVec3, at: DVec3| [0, 1, 2].map(|i| DoubleDouble::from_difference(point[i], at[i]));
        let arm_a = self.exact.rotation_a.apply(arm(point_a, self.at_a));
        let arm_b = self.exact.rotation_b.apply(arm(point_b, self.at_b));
        let length = |v: &[DoubleDouble; 3]| DVec3::new(v[0].hi, v[1].hi, v[2].hi).length() * UP;
        let (a, b) = (length(&arm_a), length(&arm_b));
        let magnitude = self.bounds.reach + a + b;
        Self {
            anchor: Some(Anchor { point_a, point_b, arm_a, arm_b, arm: a, arms: (a + b) * UP, magnitude }),
            ..self.clone()
        }
    }
}

impl Anchor {
    /// Replaces the frame's position by the anchored one, and moves its derivatives to A's anchor.
    pub(super) fn apply(&self, motion: &RelativeMotion, tau: f64, frame: &mut Frame) {
        let s = DoubleDouble::from_f64(tau);
        let rotation_a = exponential_dd(motion.spin_a.omega, s);
        let rotation_b = exponential_dd(motion.spin_b.omega, s);
        let turned = rotation_a.apply(self.arm_a);
        let exact = &motion.exact;
        let x = [0, 1, 2].map(|i| exact.offset[i] + exact.velocity[i] * tau + turned[i]);
        let seen = rotation_b.apply_transposed(x);
        let p = [0, 1, 2].map(|i| (seen[i] - self.arm_b[i]).hi);
        let arm = DVec3::new(self.arm_a[0].hi, self.arm_a[1].hi, self.arm_a[2].hi);
        frame.shift[0] = DVec3::from_array(p);
        frame.shift[1] += frame.turn[1] * arm;
        frame.shift[2] += frame.turn[2] * arm;
        // Double-double leaves out less than 2⁻⁸⁵.
        frame.extra = ROUNDING * UNIT * frame.shift[0].length() + self.magnitude * (0.5_f64).powi(80);
    }
}
