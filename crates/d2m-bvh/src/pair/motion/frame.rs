//! Relative motion of two constant-twist bodies, and its state at one time.
//!
//! Everything is expressed in an inertial frame that coincides with the frame of one body at the time in question (not in
//! a rotating frame: no Coriolis terms). A point r of a body, seen from the reference point, has velocity
//! v + ω × r and an acceleration of length at most |ω|²|r|, at all times.

use super::local_motion::LocalMotion;
use super::track::Track;
use d2m_lanes::{Doubles, F64x4, Matrix, Quad};
use glam::DVec3;

/// The two motions over a window of the search that starts at the offset `start`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeMotion {
    /// First instant of the window; offsets of frames count from it.
    pub(crate) start: f64,
    /// x_A − x_B at the start (reference points), world axes.
    position: Quad,
    velocity: Quad,
    bodies: [BodyRotation; 2],
}

/// Frames hold for so many of the longest windows: for 0.33 radians, and they are proven for 0.35.
pub(crate) const FRAME_REACH: f64 = 1.1;

/// Far frames are proven for so many radians from the start of a motion.
pub(crate) const FAR_ANGLE: f64 = 1.25;

/// Vectors that turn with a body.
const COLUMNS: usize = 5;

/// The rotation of one body over a window.
#[derive(Clone, Copy, Debug)]
struct BodyRotation {
    omega: Quad,
    /// ω in the body's own axes, where it stays.
    omega_own: Quad,
    omega_squared: f64,
    /// The columns of R, the arm R·e and its rate ω × R·e; [ω] and [ω]² times them; all at the start, world axes.
    now: [Quad; COLUMNS],
    first: [Quad; COLUMNS],
    second: [Quad; COLUMNS],
}

/// Vectors that turn with a body, at one time, world axes.
struct Turned {
    /// Axes of the body.
    rotation: Matrix,
    /// From the reference point to the center of the tree, and its rate.
    arm: Quad,
    arm_velocity: Quad,
}

impl BodyRotation {
    /// For p = p₀ + s·u + (1 − c)·w, u = k × p₀, w = k × u: [ω]p = |ω|(c·u + s·w), [ω]²p = |ω|²(c·w − s·u), and
    /// [ω]³ = −|ω|²[ω].
    #[inline(always)]
    fn new(motion: &LocalMotion, start: f64) -> Self {
        let (turning, omega, arm) = (motion.turning(), motion.angular_velocity(), motion.arm());
        let [x, y, z] = turning.start();
        let vectors = [x, y, z, x * arm.x + y * arm.y + z * arm.z];
        let (turn, speed) = (turning.after(motion.elapsed(start)), turning.speed());
        let (square, cos) = (speed * speed, 1.0 - turn.versine);
        let mut out = Self {
            omega: Quad::from_vec(omega),
            omega_own: Quad::from_vec(DVec3::new(x.dot(omega), y.dot(omega), z.dot(omega))),
            omega_squared: square,
            now: [Quad::default(); COLUMNS],
            first: [Quad::default(); COLUMNS],
            second: [Quad::default(); COLUMNS],
        };
        for (k, p) in vectors.into_iter().enumerate() {
            let terms = turning.terms_of(p);
            out.now[k] = Quad::from_vec(terms.at(&turn));
            out.first[k] = Quad::from_vec((terms.across * cos + terms.inward * turn.sin) * speed);
            out.second[k] = Quad::from_vec((terms.inward * cos - terms.across * turn.sin) * square);
        }
        let (arm, arm_velocity) = (3, 4);
        (out.now[arm_velocity], out.first[arm_velocity]) = (out.first[arm], out.second[arm]);
        out.second[arm_velocity] = Quad::from_vec(out.first[arm].to_vec() * -square);
        out
    }

    /// R(s) = R + s·f₁(θ²)·[ω]R + s²·f₂(θ²)·[ω]²R, θ = |ω|s, f₁ = sin θ/θ, f₂ = (1 − cos θ)/θ², and so every vector
    /// that turns with the body. The Taylor sums leave out less than 2⁻⁶⁰ for |θ| ≤ 0.35; those of a far frame, with three
    /// terms more, less than 2⁻⁵⁸ for |θ| ≤ [`FAR_ANGLE`].
    #[inline(always)]
    fn at<D: Doubles, const FAR: bool>(&self, s: f64) -> Turned {
        let z = self.omega_squared * (s * s);
        let (rest1, rest2) = if FAR {
            (
                z * (1.0 / 1_307_674_368_000.0
                    - z * (1.0 / 355_687_428_096_000.0 - z * (1.0 / 121_645_100_408_832_000.0))),
                z * (1.0 / 20_922_789_888_000.0
                    - z * (1.0 / 6_402_373_705_728_000.0 - z * (1.0 / 2_432_902_008_176_640_000.0))),
            )
        } else {
            (0.0, 0.0)
        };
        let f1 = 1.0
            - z * (1.0 / 6.0
                - z * (1.0 / 120.0
                    - z * (1.0 / 5040.0
                        - z * (1.0 / 362_880.0
                            - z * (1.0 / 39_916_800.0 - z * (1.0 / 6_227_020_800.0 - rest1))))));
        let f2 = 0.5
            - z * (1.0 / 24.0
                - z * (1.0 / 720.0
                    - z * (1.0 / 40_320.0
                        - z * (1.0 / 3_628_800.0
                            - z * (1.0 / 479_001_600.0 - z * (1.0 / 87_178_291_200.0 - rest2))))));
        let (f1, f2) = (D::splat(f1 * s), D::splat(f2 * (s * s)));
        let mut out = [Quad::default(); COLUMNS];
        for (k, column) in out.iter_mut().enumerate() {
            let turned = D::load(&self.first[k]) * f1 + D::load(&self.second[k]) * f2;
            *column = (D::load(&self.now[k]) + turned).store();
        }
        let [x, y, z, arm, arm_velocity] = out;
        Turned { rotation: Matrix([x, y, z]), arm, arm_velocity }
    }
}

/// The relative state at one time, in the frame of B (an inertial one that coincides with it then).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Frame {
    /// Offset from the start of the window.
    pub(crate) offset: f64,
    /// Axes of A.
    pub(crate) rotation: Matrix,
    /// Center of A's tree minus that of B's.
    pub(crate) apart: Quad,
    /// Velocity of the first center minus that of the second.
    pub(crate) velocity: Quad,
    pub(crate) omega_a: Quad,
    pub(crate) omega_b: Quad,
}

/// The relative state at one time, and the axes of B in the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedFrame {
    pub(crate) frame: Frame,
    pub(crate) axes_b: Matrix,
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
    /// Over the window of a search that begins at `start`.
    #[inline(never)]
    pub(crate) fn new([a, b]: [&LocalMotion; 2], track: &Track, start: f64) -> Self {
        Self {
            start,
            position: Quad::from_vec(track.at(start)),
            velocity: Quad::from_vec(a.linear_velocity() - b.linear_velocity()),
            bodies: [BodyRotation::new(a, start), BodyRotation::new(b, start)],
        }
    }

    /// Axes of B in the world at an offset.
    pub(crate) fn rotation_b(&self, offset: f64) -> Matrix {
        self.bodies[1].at::<F64x4, true>(offset).rotation
    }

    /// State at an offset with |ω|·|offset| ≤ 0.35 for both bodies.
    #[inline(always)]
    pub(crate) fn frame<D: Doubles>(&self, offset: f64) -> Frame {
        self.placed_frame::<D, false>(offset).frame
    }

    /// The same, placed in the world, for |ω|·|offset| ≤ [`FAR_ANGLE`]; it errs by at most four times as much.
    #[inline(always)]
    pub(crate) fn far_frame<D: Doubles>(&self, offset: f64) -> PlacedFrame {
        self.placed_frame::<D, true>(offset)
    }

    #[inline(always)]
    fn placed_frame<D: Doubles, const FAR: bool>(&self, offset: f64) -> PlacedFrame {
        let [body_a, body_b] = &self.bodies;
        let (a, b) = (body_a.at::<D, FAR>(offset), body_b.at::<D, FAR>(offset));
        // Center of A minus center of B, and its rate, world axes.
        let velocity = D::load(&self.velocity);
        let moved = D::load(&self.position) + velocity * D::splat(offset);
        let apart = moved + (D::load(&a.arm) - D::load(&b.arm));
        let rate = velocity + (D::load(&a.arm_velocity) - D::load(&b.arm_velocity));
        let to_b = b.rotation.transposed::<D>();
        let frame = Frame {
            offset,
            rotation: to_b.times_matrix::<D>(&a.rotation),
            apart: to_b.times_quad::<D>(&apart.store()).store(),
            velocity: to_b.times_quad::<D>(&rate.store()).store(),
            omega_a: to_b.times_quad::<D>(&body_a.omega).store(),
            omega_b: body_b.omega_own,
        };
        PlacedFrame { frame, axes_b: b.rotation }
    }
}
