//! Relative motion of two constant-twist bodies, and its state at one time.
//!
//! Everything is told in an inertial frame that coincides with the frame of one body at the time in question (not in
//! a rotating frame: no Coriolis terms). A point r of a body, seen from the followed point `at`, has velocity
//! v + ω × r and an acceleration of length at most |ω|²|r|, at all times.

use super::base_pose::{Columns, relative_position, rotation_at};
use crate::MeshTree;
use d2m_motion::LinearMotion;
use glam::DVec3;

/// The two motions over a window that starts at `start`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeMotion {
    /// First instant of the window; offsets count from it.
    pub(crate) start: f64,
    /// x_A − x_B at the start (followed points), world axes.
    position: DVec3,
    velocity: DVec3,
    bodies: [Spin; 2],
}

/// Rotation of one body.
#[derive(Clone, Copy, Debug)]
struct Spin {
    omega: DVec3,
    omega_squared: f64,
    /// Columns of R, [ω]R and [ω]²R at the start.
    rotation: Columns,
    first: Columns,
    second: Columns,
    /// From the followed point to the centre of the tree, body axes.
    arm: DVec3,
}

impl Spin {
    fn new(motion: &LinearMotion, arm: DVec3, start: f64) -> Self {
        let omega = motion.angular_velocity();
        let rotation = rotation_at(motion, start);
        let first = rotation.map(|c| omega.cross(c));
        let second = first.map(|c| omega.cross(c));
        Self { omega, omega_squared: omega.length_squared(), rotation, first, second, arm }
    }

    /// R(s) = R + s·f₁(θ²)·[ω]R + s²·f₂(θ²)·[ω]²R, θ = |ω|s, f₁ = sin θ/θ, f₂ = (1 − cos θ)/θ². The Taylor sums
    /// leave out less than 2⁻⁶⁰ for |θ| ≤ 0.35.
    #[inline(always)]
    fn at(&self, s: f64) -> Columns {
        let z = self.omega_squared * (s * s);
        let f1 = 1.0
            - z * (1.0 / 6.0
                - z * (1.0 / 120.0
                    - z * (1.0 / 5040.0
                        - z * (1.0 / 362_880.0 - z * (1.0 / 39_916_800.0 - z / 6_227_020_800.0)))));
        let f2 = 0.5
            - z * (1.0 / 24.0
                - z * (1.0 / 720.0
                    - z * (1.0 / 40_320.0
                        - z * (1.0 / 3_628_800.0 - z * (1.0 / 479_001_600.0 - z / 87_178_291_200.0)))));
        let (f1, f2) = (f1 * s, f2 * (s * s));
        let one = |k: usize| self.rotation[k] + (self.first[k] * f1 + self.second[k] * f2);
        [one(0), one(1), one(2)]
    }
}

/// The single body seen from the wide body at one time: "wide" is the body whose node is opened.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    /// Axes of the single body in the wide body's frame.
    pub(crate) rotation: Columns,
    /// Centre of the single body's tree minus the wide one's, wide body's axes.
    pub(crate) offset: DVec3,
    /// Velocity of the first centre minus that of the second, wide body's axes.
    pub(crate) velocity: DVec3,
    pub(crate) omega_wide: DVec3,
    pub(crate) omega_single: DVec3,
}

/// The relative state at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// Offset from the start of the window.
    pub(crate) offset: f64,
    /// `sides[0]`: nodes of A are opened against boxes of B; `sides[1]`: nodes of B against boxes of A.
    pub(crate) sides: [Side; 2],
    /// Axes of B in the world.
    pub(crate) rotation_b: Columns,
}

#[inline(always)]
fn transpose_mul(m: &Columns, p: DVec3) -> DVec3 {
    DVec3::new(m[0].dot(p), m[1].dot(p), m[2].dot(p))
}

impl RelativeMotion {
    pub(crate) fn new(a: (&MeshTree, &LinearMotion), b: (&MeshTree, &LinearMotion), start: f64) -> Self {
        Self {
            start,
            position: relative_position(a.1, b.1, start),
            velocity: a.1.linear_velocity() - b.1.linear_velocity(),
            bodies: [a, b].map(|(tree, motion)| Spin::new(motion, tree.center() - motion.at(), start)),
        }
    }

    /// State at an offset with |ω|·|offset| ≤ 0.35 for both bodies.
    #[inline(always)]
    pub(crate) fn frame(&self, offset: f64) -> Frame {
        let (ra, rb) = (self.bodies[0].at(offset), self.bodies[1].at(offset));
        let apply = |m: &Columns, p: DVec3| m[0] * p.x + m[1] * p.y + m[2] * p.z;
        let (arm_a, arm_b) = (apply(&ra, self.bodies[0].arm), apply(&rb, self.bodies[1].arm));
        let (wa, wb) = (self.bodies[0].omega, self.bodies[1].omega);
        // Centre of A minus centre of B, and its rate, world axes.
        let apart = self.position + self.velocity * offset + (arm_a - arm_b);
        let rate = self.velocity + (wa.cross(arm_a) - wb.cross(arm_b));
        let a_in_b = [transpose_mul(&rb, ra[0]), transpose_mul(&rb, ra[1]), transpose_mul(&rb, ra[2])];
        let b_in_a = [
            DVec3::new(a_in_b[0].x, a_in_b[1].x, a_in_b[2].x),
            DVec3::new(a_in_b[0].y, a_in_b[1].y, a_in_b[2].y),
            DVec3::new(a_in_b[0].z, a_in_b[1].z, a_in_b[2].z),
        ];
        let side = |frame: &Columns, rotation: Columns, sign: f64, wide: DVec3, single: DVec3| Side {
            rotation,
            offset: transpose_mul(frame, apart) * sign,
            velocity: transpose_mul(frame, rate) * sign,
            omega_wide: transpose_mul(frame, wide),
            omega_single: transpose_mul(frame, single),
        };
        Frame {
            offset,
            sides: [side(&ra, b_in_a, -1.0, wa, wb), side(&rb, a_in_b, 1.0, wb, wa)],
            rotation_b: rb,
        }
    }
}
