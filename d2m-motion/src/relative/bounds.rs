//! Closed-form bounds of the relative motion and of the rounding of its frames.
use super::{RelativeMotion, Spin, UNIT, UP};
use crate::Remainder;
use glam::DVec3;

/// Rounding of a frame and of all dot products made with it, in units of 2⁻⁵³·S0 (docs/theory/features.md).
const ROUNDING: f64 = 128.0;
/// The same per radian of rotation: the angle ωτ is rounded.
const ROUNDING_PER_RADIAN: f64 = 6.0;

/// Scalars that every bound is made of; each is an upper bound.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// U = |u|.
    pub(super) speed: f64,
    /// Y = max |g + uτ| over the window (convex: at one of the ends).
    pub(super) reach: f64,
    /// a = |ω_A|.
    pub(super) a: f64,
    /// b = |ω_B|.
    pub(super) b: f64,
    /// w = |ω_A − ω_B|.
    pub(super) w: f64,
    /// K2 = c + w², c = |ω_A × ω_B|.
    pub(super) k2: f64,
    /// K3 = bc + 3wc + w³.
    pub(super) k3: f64,
    /// k = 2⁻⁵³·(128 + 6(a + b)T).
    pub(super) rounding: f64,
}

impl Bounds {
    pub(super) fn new(
        offset: DVec3,
        velocity: DVec3,
        spin_a: &Spin,
        spin_b: &Spin,
        difference: DVec3,
        duration: f64,
    ) -> Self {
        let speed = velocity.length() * UP;
        let reach = offset.length().max((offset + velocity * duration).length()) * UP
            + 8.0 * UNIT * (offset.length() + speed * duration);
        let (a, b) = (spin_a.speed * UP, spin_b.speed * UP);
        let w = difference.length() * UP;
        // |ω_A × ω_B| = |Ω × ω_B|; the rounding of the product is below 4u·wb.
        let c = difference.cross(spin_b.omega).length() * UP + 8.0 * UNIT * w * b;
        let k2 = (c + w * w) * UP;
        let k3 = (b * c + 3.0 * w * c + w * w * w) * UP;
        let turn = (a + b) * duration;
        let rounding = if turn <= crate::sin_cos::LARGEST_ANGLE {
            UNIT * (ROUNDING + ROUNDING_PER_RADIAN * turn) * UP
        } else {
            f64::INFINITY
        };
        Self { speed, reach, a, b, w, k2, k3, rounding }
    }
}

impl RelativeMotion {
    /// Bound of the distance from B's followed point of a point of A within `radius`: `Y + ρ`.
    pub fn bound_reach(&self, radius: f64) -> f64 {
        (self.bounds.reach + radius + self.arm()) * UP
    }

    /// Bound V of the speed of a point of A within `radius` of A's followed point: `U + bY + wρ`.
    ///
    /// With an anchor, `radius` is from the anchor and the arm of the anchor is added.
    pub fn bound_speed(&self, radius: f64) -> f64 {
        let k = &self.bounds;
        (k.speed + k.b * k.reach + k.w * (radius + self.arm())) * UP
    }

    /// Bound of the acceleration: `b(2U + bY) + K2·ρ`.
    pub fn bound_acceleration(&self, radius: f64) -> f64 {
        let k = &self.bounds;
        (k.b * (2.0 * k.speed + k.b * k.reach) + k.k2 * (radius + self.arm())) * UP
    }

    /// Bound M3 of the third derivative: `b²(3U + bY) + K3·ρ`.
    pub fn bound_jerk(&self, radius: f64) -> f64 {
        let k = &self.bounds;
        (k.b * k.b * (3.0 * k.speed + k.b * k.reach) + k.k3 * (radius + self.arm())) * UP
    }

    /// Bound of the k-th derivative of a direction of A of length 1, k = 1, 2, 3: `w`, `K2`, `K3`.
    ///
    /// # Panics
    /// If `order` is not 1, 2 or 3.
    pub fn bound_direction_derivative(&self, order: u32) -> f64 {
        match order {
            1 => self.bounds.w,
            2 => self.bounds.k2,
            3 => self.bounds.k3,
            _ => panic!("derivative of order {order}: 1, 2 or 3 expected"),
        }
    }

    /// Remainder of every point jet with `|r| ≤ radius`, dotted with a vector of length at most 1 and compared with
    /// points of B of length at most `extent`: `E(h) + M3·h³/6`, `E(h) = k(S0 + S1·h + S2·h²)`,
    /// `S0 = Y + ρ + extent`, `S1 = 2(U + (a + b)S0)`, `S2 = 4((a + b)²S0 + bU)`.
    pub fn point_remainder(&self, radius: f64, extent: f64) -> Remainder {
        let k = &self.bounds;
        let s0 = k.reach + radius + extent + self.arm();
        let turn = k.a + k.b;
        // An anchored frame brings the rounding of its own position: see `Frame::point_jet`.
        let e0 = if self.anchor.is_some() { (radius + extent) * k.rounding } else { s0 * k.rounding };
        Remainder {
            e0: e0 * UP,
            e1: 2.0 * (k.speed + turn * s0) * k.rounding * UP,
            e2: 4.0 * (turn * turn * s0 + k.b * k.speed) * k.rounding * UP,
            m3: self.bound_jerk(radius),
        }
    }

    /// Remainder of the jet of a direction of A of the given length: as a point with `g = u = 0`.
    pub fn direction_remainder(&self, length: f64) -> Remainder {
        let k = &self.bounds;
        let turn = k.a + k.b;
        let e0 = length * k.rounding * UP;
        Remainder { e0, e1: 2.0 * turn * e0 * UP, e2: 4.0 * turn * turn * e0 * UP, m3: k.k3 * length * UP }
    }

    fn arm(&self) -> f64 {
        self.anchor.as_ref().map_or(0.0, |anchor| anchor.arm)
    }
}
