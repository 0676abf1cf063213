//! The relative pose and its first two derivatives at one time, shared by all features of a pair of bodies.
use super::RelativeMotion;
use crate::sin_cos::sin_cos_two;
use crate::two::TwoVec3;
use crate::{PathJet, Remainder};
use d2m_interval::F64x2;
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
    /// c_k and M_k for k = 0, 1, 2: `q⁽ᵏ⁾ = c_k + M_k r`.
    ///
    /// # Panics
    /// If `order` is above 2.
    #[inline(always)]
    pub fn affine(&self, order: usize) -> (DVec3, &DMat3) {
        (self.shift[order], &self.turn[order])
    }

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
fn cross_columns(w: DVec3, m: &DMat3) -> DMat3 {
    DMat3::from_cols(w.cross(m.x_axis), w.cross(m.y_axis), w.cross(m.z_axis))
}

/// `mᵀ v` as three dot products.
#[inline(always)]
fn transpose_mul(m: &DMat3, v: DVec3) -> DVec3 {
    DVec3::new(m.x_axis.dot(v), m.y_axis.dot(v), m.z_axis.dot(v))
}

/// A vector of A, prepared for jets at many times: its parts along and across A's axis `k`, and `k × r`. Turned by
/// an angle θ it is `along + cos θ·across + sin θ·turned`.
#[derive(Debug, Clone, Copy)]
pub struct Arm {
    along: DVec3,
    across: DVec3,
    turned: DVec3,
}

/// A point and a direction of A, prepared side by side.
#[derive(Clone, Copy)]
pub struct ArmPair {
    along: TwoVec3,
    across: TwoVec3,
    turned: TwoVec3,
}

impl ArmPair {
    /// Both side by side.
    #[inline]
    pub fn new(point: &Arm, direction: &Arm) -> Self {
        Self {
            along: TwoVec3::new(point.along, direction.along),
            across: TwoVec3::new(point.across, direction.across),
            turned: TwoVec3::new(point.turned, direction.turned),
        }
    }
}

impl RelativeMotion {
    /// Prepares a vector of A ([`RelativeMotion::place_a`], [`RelativeMotion::turn_a`]).
    #[inline]
    pub fn arm(&self, r: DVec3) -> Arm {
        let k = self.spin_a.axis;
        let along = k * k.dot(r);
        Arm { along, across: r - along, turned: k.cross(r) }
    }

    /// Sine and cosine of A's angle, and `R_B` at a time.
    #[inline(always)]
    fn turns(&self, tau: f64) -> ([f64; 2], DMat3) {
        let angles = F64x2::pack(self.spin_a.speed, self.spin_b.speed).times(F64x2::splat(tau));
        let (sin, cos) = sin_cos_two(angles);
        ([sin.first(), cos.first()], self.spin_b.rotation_of(sin.second(), cos.second()))
    }

    /// The jet of one point to third order, in fewer operations than a frame takes; `remainder` is
    /// [`RelativeMotion::point_remainder_third_order`]. Not for anchored motions.
    ///
    /// With `z = R_A r`, `x = g + uτ + z`: `q⁽ᵏ⁾ = R_Bᵀ X_k`, `X₀ = x`, `X₁ = x′ − ω_B × x`,
    /// `X₂ = x″ − ω_B × x′ − ω_B × X₁`, `X₃ = x‴ − ω_B × (2x″ − ω_B × x′ + X₂)`.
    #[inline]
    pub fn point_jet(&self, tau: f64, r: &Arm, remainder: Remainder) -> PathJet {
        debug_assert!(self.anchor.is_none());
        let ([sin, cos], back) = self.turns(tau);
        let (a, omega) = (self.spin_a.speed, self.spin_b.omega);
        let turning = r.across * cos + r.turned * sin;
        let x = (self.offset + self.velocity * tau) + (r.along + turning);
        let swing = (r.turned * cos - r.across * sin) * a;
        let moved = self.velocity + swing;
        let x1 = moved - omega.cross(x);
        let bent = turning * (-a * a);
        let dragged = omega.cross(moved);
        let x2 = bent - dragged - omega.cross(x1);
        let x3 = swing * (-a * a) - omega.cross(bent * 2.0 - dragged + x2);
        PathJet {
            p: transpose_mul(&back, x),
            v: transpose_mul(&back, x1),
            a: transpose_mul(&back, x2),
            j: transpose_mul(&back, x3),
            remainder,
        }
    }

    /// The jets of a point and of a direction at one time. Not for anchored motions.
    #[inline]
    pub fn point_and_direction_jets(
        &self,
        tau: f64,
        arms: &ArmPair,
        (point, direction): (Remainder, Remainder),
    ) -> (PathJet, PathJet) {
        debug_assert!(self.anchor.is_none());
        let ([sin, cos], back) = self.turns(tau);
        let (sin, cos, a) = (F64x2::splat(sin), F64x2::splat(cos), self.spin_a.speed);
        let &ArmPair { along, across, turned } = arms;
        let turning = across.scaled(cos) + turned.scaled(sin);
        let only = |v: DVec3| TwoVec3::new(v, DVec3::ZERO);
        let x = only(self.offset + self.velocity * tau) + (along + turning);
        let swing = (turned.scaled(cos) - across.scaled(sin)).scaled(F64x2::splat(a));
        let moved = only(self.velocity) + swing;
        let omega = TwoVec3::splat(self.spin_b.omega);
        let x1 = moved - omega.cross(x);
        let bent = turning.scaled(F64x2::splat(-a * a));
        let dragged = omega.cross(moved);
        let x2 = bent - dragged - omega.cross(x1);
        let x3 = swing.scaled(F64x2::splat(-a * a)) - omega.cross(bent + bent - dragged + x2);
        let columns = [back.x_axis, back.y_axis, back.z_axis].map(TwoVec3::splat);
        let seen = |v: TwoVec3| TwoVec3 { x: columns[0].dot(v), y: columns[1].dot(v), z: columns[2].dot(v) };
        let (p, v, a, j) = (seen(x), seen(x1), seen(x2), seen(x3));
        (
            PathJet { p: p.first(), v: v.first(), a: a.first(), j: j.first(), remainder: point },
            PathJet { p: p.second(), v: v.second(), a: a.second(), j: j.second(), remainder: direction },
        )
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
