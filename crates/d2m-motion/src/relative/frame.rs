//! The relative pose and its first two derivatives at one time, shared by all features of a pair of bodies.
use super::RelativeMotion;
use crate::sin_cos::sin_cos_two;
use crate::two::TwoVec3;
use crate::{EdgeJets, PathJet, Remainder, TwoJets};
use d2m_lanes::F64x2;
use glam::{DMat3, DVec3};

/// Three matrices and three vectors: `q⁽ᵏ⁾ = c_k + M_k r` for a point of A, `e⁽ᵏ⁾ = M_k d` for a direction.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// c_0, c_1, c_2.
    pub(super) shift: [DVec3; 3],
    /// M_0, M_1, M_2.
    pub(super) turn: [DMat3; 3],
    /// Rounding of c_0 beyond what the point remainder counts (anchored frames only).
    pub(super) extra: f64,
}

impl Frame {
    /// Jet of the point of A at `r` ([`RelativeMotion::place_a`]) with the remainder of its class of points.
    #[inline(always)]
    pub fn point_jet(&self, r: DVec3, remainder: Remainder) -> PathJet {
        PathJet {
            p: self.shift[0] + self.turn[0] * r,
            v: self.shift[1] + self.turn[1] * r,
            a: self.shift[2] + self.turn[2] * r,
            j: DVec3::ZERO,
            remainder: Remainder { e0: remainder.e0 + self.extra, ..remainder },
        }
    }

    /// Jet of a direction of A (world axes at the epoch).
    #[inline(always)]
    pub fn direction_jet(&self, d: DVec3, remainder: Remainder) -> PathJet {
        PathJet { p: self.turn[0] * d, v: self.turn[1] * d, a: self.turn[2] * d, j: DVec3::ZERO, remainder }
    }
}

/// `[w] M`: the cross product with every column.
#[inline(always)]
pub(super) fn cross_columns(w: DVec3, m: &DMat3) -> DMat3 {
    DMat3::from_cols(w.cross(m.x_axis), w.cross(m.y_axis), w.cross(m.z_axis))
}

/// `mᵀ v` as three dot products.
#[inline(always)]
fn transpose_mul(m: &DMat3, v: DVec3) -> DVec3 {
    DVec3::new(m.x_axis.dot(v), m.y_axis.dot(v), m.z_axis.dot(v))
}

/// A vector of a body, prepared for jets at many times: its parts along and across the body's axis `k`, and `k × r`.
/// Turned by an angle θ it is `along + cos θ·across + sin θ·turned`.
#[derive(Debug, Clone, Copy)]
pub struct LeverArm {
    along: DVec3,
    across: DVec3,
    turned: DVec3,
}

impl LeverArm {
    #[inline(always)]
    fn new(k: DVec3, r: DVec3) -> Self {
        let along = k * k.dot(r);
        Self { along, across: r - along, turned: k.cross(r) }
    }
}

/// A point and a direction of one body, prepared side by side.
#[derive(Clone, Copy)]
pub struct ArmPair {
    along: TwoVec3,
    across: TwoVec3,
    turned: TwoVec3,
}

impl ArmPair {
    #[inline(always)]
    fn new(k: DVec3, point: DVec3, direction: DVec3) -> Self {
        let r = TwoVec3::new(point, direction);
        let k = TwoVec3::splat(k);
        let along = k.scaled(k.dot(r));
        Self { along, across: r - along, turned: k.cross(r) }
    }
}

impl RelativeMotion {
    /// Prepares a vector of A ([`RelativeMotion::place_a`], [`RelativeMotion::turn_a`]).
    #[inline]
    pub fn arm(&self, r: DVec3) -> LeverArm {
        LeverArm::new(self.spin_a.axis, r)
    }

    /// Prepares a vector of B ([`RelativeMotion::place_b`], [`RelativeMotion::turn_b`]).
    #[inline]
    fn arm_b(&self, r: DVec3) -> LeverArm {
        LeverArm::new(self.spin_b.axis, r)
    }

    /// Prepares a point and a direction of A.
    #[inline]
    pub fn arms_a(&self, point: DVec3, direction: DVec3) -> ArmPair {
        ArmPair::new(self.spin_a.axis, point, direction)
    }

    /// Prepares a point and a direction of B ([`RelativeMotion::place_b`], [`RelativeMotion::turn_b`]).
    #[inline]
    pub fn arms_b(&self, point: DVec3, direction: DVec3) -> ArmPair {
        ArmPair::new(self.spin_b.axis, point, direction)
    }

    /// Sine and cosine of the angles of A and B at a time.
    #[inline(always)]
    fn angles(&self, tau: f64) -> (F64x2, F64x2) {
        sin_cos_two(F64x2::pack(self.spin_a.speed, self.spin_b.speed) * F64x2::splat(tau))
    }

    /// The jet of one point to third order, in fewer operations than a frame takes; `remainder` is
    /// [`RelativeMotion::point_remainder_third_order`]. Not for anchored motions.
    ///
    /// With `z = R_A r`, `x = g + uτ + z`: `q⁽ᵏ⁾ = R_Bᵀ X_k`, `X₀ = x`, `X₁ = x′ − ω_B × x`,
    /// `X₂ = x″ − ω_B × x′ − ω_B × X₁`, `X₃ = x‴ − ω_B × (2x″ − ω_B × x′ + X₂)`.
    #[inline]
    pub fn point_jet(&self, tau: f64, r: &LeverArm, remainder: Remainder) -> PathJet {
        debug_assert!(self.anchor.is_none());
        let (sin, cos) = self.angles(tau);
        let back = self.spin_b.rotation_of(sin.second(), cos.second());
        let (sin, cos) = (sin.first(), cos.first());
        let (a, omega) = (self.spin_a.speed, self.spin_b.omega);
        let turning = r.across * cos + r.turned * sin;
        let x = (self.offset + self.velocity * tau) + (r.along + turning);
        let spin_velocity = (r.turned * cos - r.across * sin) * a;
        let moved = self.velocity + spin_velocity;
        let x1 = moved - omega.cross(x);
        let bent = turning * (-a * a);
        let dragged = omega.cross(moved);
        let x2 = bent - dragged - omega.cross(x1);
        let x3 = spin_velocity * (-a * a) - omega.cross(bent * 2.0 - dragged + x2);
        PathJet {
            p: transpose_mul(&back, x),
            v: transpose_mul(&back, x1),
            a: transpose_mul(&back, x2),
            j: transpose_mul(&back, x3),
            remainder,
        }
    }

    /// The jet of [`RelativeMotion::point_jet`] along a direction `n` of B: value and first three derivatives of `n·q`.
    ///
    /// In world axes: `x·N` with `N = R_B n`, differentiated as a product. With the parts `z_t`, `N_t` that turn,
    /// `z″ = −a²z_t`, `z‴ = −a²z′`, `N″ = −b²N_t`, `N‴ = −b²N′`.
    #[inline]
    pub fn point_along(&self, tau: f64, r: &LeverArm, n: DVec3) -> [f64; 4] {
        debug_assert!(self.anchor.is_none());
        let (sin, cos) = self.angles(tau);
        let (a, b) = (self.spin_a.speed, self.spin_b.speed);
        let other = self.arm_b(n);
        let across = TwoVec3::new(r.across, other.across);
        let turned = TwoVec3::new(r.turned, other.turned);
        let turning = across.scaled(cos) + turned.scaled(sin);
        let spin_velocity = (turned.scaled(cos) - across.scaled(sin)).scaled(F64x2::pack(a, b));
        let (z_t, n_t, z1, n1) =
            (turning.first(), turning.second(), spin_velocity.first(), spin_velocity.second());
        let x = (self.offset + self.velocity * tau) + (r.along + z_t);
        let n = other.along + n_t;
        let x1 = self.velocity + z1;
        let (aa, bb) = (a * a, b * b);
        let (across, moved) = (x.dot(n1), x1.dot(n_t));
        [
            x.dot(n),
            x1.dot(n) + across,
            2.0 * x1.dot(n1) - (aa * z_t.dot(n) + bb * x.dot(n_t)),
            -(aa * (z1.dot(n) + 3.0 * z_t.dot(n1)) + bb * (3.0 * moved + across)),
        ]
    }

    /// Jets to third order of a point of A relative to one of B and of a direction of A, and the direction of B: all in
    /// the axes that have turned with B, expressed in world axes at the time. Not for anchored motions.
    ///
    /// Lengths and products of these do not depend on the axes, so nothing of A is turned back by `R_Bᵀ`.
    #[inline(always)]
    pub fn edge_jets(
        &self,
        tau: f64,
        of_a: &ArmPair,
        of_b: &ArmPair,
        remainders: [Remainder; 2],
    ) -> EdgeJets {
        debug_assert!(self.anchor.is_none());
        let (sin, cos) = self.angles(tau);
        let a = self.spin_a.speed;
        let other = of_b.along + of_b.across * cos.second() + of_b.turned * sin.second();
        let (sin, cos) = (F64x2::splat(sin.first()), F64x2::splat(cos.first()));
        let turning = of_a.across.scaled(cos) + of_a.turned.scaled(sin);
        let only = |v: DVec3| TwoVec3::new(v, DVec3::ZERO);
        let x = only(self.offset + self.velocity * tau) + (of_a.along + turning);
        let spin_velocity = (of_a.turned.scaled(cos) - of_a.across.scaled(sin)) * a;
        let moved = only(self.velocity) + spin_velocity;
        let omega = TwoVec3::splat(self.spin_b.omega);
        let x1 = moved - omega.cross(x);
        let bent = turning * (-a * a);
        let dragged = omega.cross(moved);
        let x2 = bent - dragged - omega.cross(x1);
        let x3 = spin_velocity * (-a * a) - omega.cross(bent + bent - dragged + x2);
        let jets = TwoJets { p: x - only(other.first()), v: x1, a: x2, j: x3, remainders };
        EdgeJets { jets, half_b: other.second() }
    }

    /// True if frames are made in extended precision.
    pub const fn is_anchored(&self) -> bool {
        self.anchor.is_some()
    }

    /// The frame at `τ`. With `P = R_Bᵀ(g + uτ)`, `u_B = R_Bᵀu`, `W = R_Bᵀ(ω_A − ω_B)`, `W′ = −ω_B × W`:
    /// `c_0 = P`, `c_1 = u_B − ω_B × P`, `c_2 = −ω_B × (u_B + c_1)`,
    /// `M_0 = R_BᵀR_A`, `M_1 = [W]M_0`, `M_2 = [W′]M_0 + [W]M_1`.
    #[inline]
    pub fn frame(&self, tau: f64) -> Frame {
        let mut frame = self.plain_frame(tau);
        if let Some(anchor) = &self.anchor {
            anchor.apply(self, tau, &mut frame);
        }
        frame
    }

    #[inline(always)]
    fn plain_frame(&self, tau: f64) -> Frame {
        let rotation_a = self.spin_a.rotation(tau);
        let x = self.offset + self.velocity * tau;
        if self.spin_b.speed == 0.0 {
            let w = self.spin_a.omega;
            let m1 = cross_columns(w, &rotation_a);
            let m2 = cross_columns(w, &m1);
            return Frame { shift: [x, self.velocity, DVec3::ZERO], turn: [rotation_a, m1, m2], extra: 0.0 };
        }
        let rotation_b = self.spin_b.rotation(tau);
        let omega = self.spin_b.omega;
        let p = transpose_mul(&rotation_b, x);
        let u = transpose_mul(&rotation_b, self.velocity);
        let w = transpose_mul(&rotation_b, self.spin_difference);
        let w1 = w.cross(omega);
        let m0 = DMat3::from_cols(
            transpose_mul(&rotation_b, rotation_a.x_axis),
            transpose_mul(&rotation_b, rotation_a.y_axis),
            transpose_mul(&rotation_b, rotation_a.z_axis),
        );
        let m1 = cross_columns(w, &m0);
        let m2 = cross_columns(w1, &m0) + cross_columns(w, &m1);
        let c1 = u - omega.cross(p);
        let c2 = (u + c1).cross(omega);
        Frame { shift: [p, c1, c2], turn: [m0, m1, m2], extra: 0.0 }
    }
}
