//! The relative pose and its first two derivatives at one time, shared by all features of a pair of bodies.
use super::RelativeMotion;
use crate::{PathJet, Remainder};
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
            remainder: Remainder { e0: remainder.e0 + self.extra, ..remainder },
        }
    }

    /// Jet of a direction of A (world axes at the epoch).
    #[inline(always)]
    pub fn direction_jet(&self, d: DVec3, remainder: Remainder) -> PathJet {
        PathJet { p: self.turn[0] * d, v: self.turn[1] * d, a: self.turn[2] * d, remainder }
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

/// What the jets of single vectors need of a time: `R_A`, `R_B`, `P`, `W`, `W′`, `c_1`, `c_2` of [`Frame`].
struct Turning {
    rotation_a: DMat3,
    rotation_b: DMat3,
    w: DVec3,
    w1: DVec3,
    shift: [DVec3; 3],
}

impl Turning {
    /// `z`, `W × z`, `W′ × z + W × (W × z)` for `z = R_BᵀR_A v`.
    #[inline(always)]
    fn turn(&self, v: DVec3) -> [DVec3; 3] {
        let z = transpose_mul(&self.rotation_b, self.rotation_a * v);
        let first = self.w.cross(z);
        [z, first, self.w1.cross(z) + self.w.cross(first)]
    }
}

impl RelativeMotion {
    #[inline(always)]
    fn turning(&self, tau: f64) -> Turning {
        let rotation_a = self.spin_a.rotation(tau);
        let rotation_b = self.spin_b.rotation(tau);
        let omega = self.spin_b.omega;
        let p = transpose_mul(&rotation_b, self.offset + self.velocity * tau);
        let u = transpose_mul(&rotation_b, self.velocity);
        let w = transpose_mul(&rotation_b, self.spin_difference);
        let c1 = u - omega.cross(p);
        let c2 = (u + c1).cross(omega);
        Turning { rotation_a, rotation_b, w, w1: w.cross(omega), shift: [p, c1, c2] }
    }

    /// The jet of one point, as [`RelativeMotion::frame`] and [`Frame::point_jet`] give it, in fewer operations than
    /// a frame takes. Not for anchored motions.
    #[inline]
    pub fn point_jet(&self, tau: f64, r: DVec3, remainder: Remainder) -> PathJet {
        debug_assert!(self.anchor.is_none());
        let turning = self.turning(tau);
        let [z, z1, z2] = turning.turn(r);
        let [p, v, a] = turning.shift;
        PathJet { p: p + z, v: v + z1, a: a + z2, remainder }
    }

    /// The jets of a point and of a direction at one time. Not for anchored motions.
    #[inline]
    pub fn point_and_direction_jets(
        &self,
        tau: f64,
        point: (DVec3, Remainder),
        direction: (DVec3, Remainder),
    ) -> (PathJet, PathJet) {
        debug_assert!(self.anchor.is_none());
        let turning = self.turning(tau);
        let [z, z1, z2] = turning.turn(point.0);
        let [e, e1, e2] = turning.turn(direction.0);
        let [p, v, a] = turning.shift;
        (
            PathJet { p: p + z, v: v + z1, a: a + z2, remainder: point.1 },
            PathJet { p: e, v: e1, a: e2, remainder: direction.1 },
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
