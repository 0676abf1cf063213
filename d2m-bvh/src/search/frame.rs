//! Relative motion of two constant-twist bodies, and its state at one time.
//!
//! Everything is told in an inertial frame that coincides with the frame of one body at the time in question (not in
//! a rotating frame: no Coriolis terms). A point r of a body, seen from the followed point `at`, has velocity
//! v + ω × r and an acceleration of length at most |ω|²|r|, at all times.

use super::base_pose::{relative_position, rotation_at};
use super::quad::{Doubles, Matrix, Quad};
use crate::MeshTree;
use d2m_motion::LinearMotion;
use glam::DVec3;

/// The two motions over a window that starts at `start`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeMotion {
    /// First instant of the window; offsets count from it.
    pub(crate) start: f64,
    /// x_A − x_B at the start (followed points), world axes.
    position: Quad,
    velocity: Quad,
    bodies: [Spin; 2],
}

/// Rotation of one body.
#[derive(Clone, Copy, Debug)]
struct Spin {
    omega: Quad,
    /// [ω].
    cross: Matrix,
    omega_squared: f64,
    /// R, [ω]R and [ω]²R at the start.
    rotation: Matrix,
    first: Matrix,
    second: Matrix,
    /// From the followed point to the centre of the tree, body axes.
    arm: DVec3,
}

impl Spin {
    fn new(motion: &LinearMotion, arm: DVec3, start: f64) -> Self {
        let omega = motion.angular_velocity();
        let rotation = rotation_at(motion, start);
        let first = rotation.map(|c| omega.cross(c));
        let second = first.map(|c| omega.cross(c));
        Self {
            omega: Quad::from_vec(omega),
            cross: Matrix::cross(&Quad::from_vec(omega)),
            omega_squared: omega.length_squared(),
            rotation: Matrix::from_columns(rotation),
            first: Matrix::from_columns(first),
            second: Matrix::from_columns(second),
            arm,
        }
    }

    /// R(s) = R + s·f₁(θ²)·[ω]R + s²·f₂(θ²)·[ω]²R, θ = |ω|s, f₁ = sin θ/θ, f₂ = (1 − cos θ)/θ². The Taylor sums
    /// leave out less than 2⁻⁶⁰ for |θ| ≤ 0.35.
    #[inline(always)]
    fn at<D: Doubles>(&self, s: f64) -> Matrix {
        let z = self.omega_squared * (s * s);
        let f1 = 1.0
            - z * (1.0 / 6.0
                - z * (1.0 / 120.0
                    - z * (1.0 / 5040.0
                        - z * (1.0 / 362_880.0 - z * (1.0 / 39_916_800.0 - z * (1.0 / 6_227_020_800.0))))));
        let f2 = 0.5
            - z * (1.0 / 24.0
                - z * (1.0 / 720.0
                    - z * (1.0 / 40_320.0
                        - z * (1.0 / 3_628_800.0
                            - z * (1.0 / 479_001_600.0 - z * (1.0 / 87_178_291_200.0))))));
        let (f1, f2) = (D::splat(f1 * s), D::splat(f2 * (s * s)));
        let (r, p, q) = (&self.rotation.0, &self.first.0, &self.second.0);
        Matrix([
            (D::load(&r[0]) + (D::load(&p[0]) * f1 + D::load(&q[0]) * f2)).store(),
            (D::load(&r[1]) + (D::load(&p[1]) * f1 + D::load(&q[1]) * f2)).store(),
            (D::load(&r[2]) + (D::load(&p[2]) * f1 + D::load(&q[2]) * f2)).store(),
        ])
    }
}

/// The relative state at one time, in the frame of B (an inertial one that coincides with it then).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// Offset from the start of the window.
    pub(crate) offset: f64,
    /// Axes of A.
    pub(crate) rotation: Matrix,
    /// Centre of A's tree minus that of B's.
    pub(crate) apart: Quad,
    /// Velocity of the first centre minus that of the second.
    pub(crate) velocity: Quad,
    pub(crate) omega_a: Quad,
    pub(crate) omega_b: Quad,
}

impl Frame {
    /// The same instant of the motion that runs backwards.
    pub(crate) fn reversed<D: Doubles>(&self) -> Self {
        let back = |v: &Quad| (D::splat(0.0) - D::load(v)).store();
        Self {
            velocity: back(&self.velocity),
            omega_a: back(&self.omega_a),
            omega_b: back(&self.omega_b),
            ..*self
        }
    }

    /// Speed at which two points, of A and of B, come together along a unit direction from A to B.
    pub(crate) fn closing_speed(&self, points: [DVec3; 2], normal: DVec3) -> f64 {
        let rate = self.velocity.to_vec() + self.omega_a.to_vec().cross(points[0] - self.apart.to_vec())
            - self.omega_b.to_vec().cross(points[1]);
        rate.dot(normal)
    }
}

impl RelativeMotion {
    pub(crate) fn new(a: (&MeshTree, &LinearMotion), b: (&MeshTree, &LinearMotion), start: f64) -> Self {
        Self {
            start,
            position: Quad::from_vec(relative_position(a.1, b.1, start)),
            velocity: Quad::from_vec(a.1.linear_velocity() - b.1.linear_velocity()),
            bodies: [a, b].map(|(tree, motion)| Spin::new(motion, tree.center() - motion.at(), start)),
        }
    }

    /// Axes of B in the world at an offset.
    pub(crate) fn rotation_b(&self, offset: f64) -> Matrix {
        self.bodies[1].at::<Quad>(offset)
    }

    /// State at an offset with |ω|·|offset| ≤ 0.35 for both bodies.
    #[inline(always)]
    pub(crate) fn frame<D: Doubles>(&self, offset: f64) -> Frame {
        let [body_a, body_b] = &self.bodies;
        let (ra, rb) = (body_a.at::<D>(offset), body_b.at::<D>(offset));
        let (arm_a, arm_b) = (ra.times::<D>(body_a.arm), rb.times::<D>(body_b.arm));
        // Centre of A minus centre of B, and its rate, world axes.
        let velocity = D::load(&self.velocity);
        let apart = D::load(&self.position) + velocity * D::splat(offset) + (arm_a - arm_b);
        let (swing_a, swing_b): (D, D) =
            (body_a.cross.times_quad(&arm_a.store()), body_b.cross.times_quad(&arm_b.store()));
        let rate = velocity + (swing_a - swing_b);
        let to_b = rb.transposed();
        Frame {
            offset,
            rotation: to_b.times_matrix::<D>(&ra),
            apart: to_b.times_quad::<D>(&apart.store()).store(),
            velocity: to_b.times_quad::<D>(&rate.store()).store(),
            omega_a: to_b.times_quad::<D>(&body_a.omega).store(),
            omega_b: to_b.times_quad::<D>(&body_b.omega).store(),
        }
    }
}
