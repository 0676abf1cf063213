//! The motion of body A seen from body B, for two motions of constant twist: closed-form jets and bounds.
//!
//! docs/theory/features.md derives every formula and every constant of this folder.
mod anchor;
mod any;
mod bounds;
mod frame;

#[cfg(test)]
mod any_tests;
#[cfg(test)]
mod tests;

pub use any::{RelativeState, StraightLine};
pub use bounds::OffsetRange;
pub use frame::{ArmPair, Frame, LeverArm};

use crate::ConstantTwist;
use crate::rotation::{RotationDd, Spin};
use crate::rounding::UP;
use anchor::Anchor;
use bounds::Bounds;
use d2m_lanes::DoubleDouble;
use glam::{DMat3, DVec3};

/// Motion of body A relative to body B over a window of time, both of constant twist.
///
/// Everything is expressed in the *epoch frame of B*: it moves with B, and at the start `t0` of the window its axes are
/// the world's and its origin is B's reference point. `τ = t − t0` runs from 0 to [`RelativeMotion::duration`].
/// A point of B is constant in it ([`RelativeMotion::place_b`]); a point of A, given by
/// [`RelativeMotion::place_a`] as the vector `r` from A's reference point in world axes at `t0`, moves on
/// `q(τ) = exp(−[ω_B]τ)·(g + uτ + exp([ω_A]τ)·r)`, `g = x_A − x_B` at `t0`, `u = v_A − v_B`.
///
/// ```
/// use d2m_motion::{ConstantTwist, RelativeMotion};
/// use glam::DVec3;
/// let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-DVec3::Z);
/// let relative = RelativeMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
/// let point = relative.place_a(DVec3::X);
/// let jet = relative.frame(0.5).point_jet(point, relative.point_remainder(point.length(), 0.0));
/// assert_eq!(jet.p, DVec3::new(1.0, 0.0, 0.5));
/// assert_eq!(jet.v, -DVec3::Z);
/// ```
#[derive(Debug, Clone)]
pub struct RelativeMotion {
    start: f64,
    end: f64,
    duration: f64,
    offset: DVec3,
    velocity: DVec3,
    spin_a: Spin,
    spin_b: Spin,
    spin_difference: DVec3,
    at_a: DVec3,
    at_b: DVec3,
    rotation_a: DMat3,
    rotation_b: DMat3,
    /// Radians that A and B turn from their reference times to the epoch, added.
    epoch_angle: f64,
    bounds: Bounds,
    exact: Exact,
    anchor: Option<Anchor>,
}

/// The epoch in extended precision, for anchored frames.
#[derive(Debug, Clone, Copy)]
struct Exact {
    offset: [DoubleDouble; 3],
    velocity: [DoubleDouble; 3],
    rotation_a: RotationDd,
    rotation_b: RotationDd,
}

impl RelativeMotion {
    /// Motion of A relative to B over `[start, end]`.
    ///
    /// Nothing is refused here: if a magnitude overflows or a rotation exceeds 1e9 radians over the window, the
    /// bounds come out infinite or NaN, and no test built on them excludes anything.
    pub fn new(a: &ConstantTwist, b: &ConstantTwist, start: f64, end: f64) -> Self {
        let (position_a, position_b) = (a.position_dd(start), b.position_dd(start));
        let exact = Exact {
            offset: [0, 1, 2].map(|i| position_a[i] - position_b[i]),
            velocity: [0, 1, 2]
                .map(|i| DoubleDouble::from_difference(a.linear_velocity()[i], b.linear_velocity()[i])),
            rotation_a: a.rotation_dd(start),
            rotation_b: b.rotation_dd(start),
        };
        let rounded = |v: [DoubleDouble; 3]| DVec3::new(v[0].hi, v[1].hi, v[2].hi);
        let (offset, velocity) = (rounded(exact.offset), rounded(exact.velocity));
        let length = DoubleDouble::from_difference(end, start);
        let duration = if length.lo > 0.0 { length.hi.next_up() } else { length.hi };
        let (spin_a, spin_b) = (Spin::new(a.angular_velocity()), Spin::new(b.angular_velocity()));
        let spin_difference = spin_a.omega - spin_b.omega;
        let from_reference = |motion: &ConstantTwist, spin: &Spin| {
            if spin.speed == 0.0 { 0.0 } else { spin.speed * (start - motion.reference_time()).abs() }
        };
        let epoch_angle = (from_reference(a, &spin_a) + from_reference(b, &spin_b)) * UP;
        Self {
            start,
            end,
            duration,
            offset,
            velocity,
            spin_a,
            spin_b,
            spin_difference,
            at_a: a.at(),
            at_b: b.at(),
            rotation_a: exact.rotation_a.to_mat3(),
            rotation_b: exact.rotation_b.to_mat3(),
            bounds: Bounds::new(offset, velocity, &spin_a, &spin_b, spin_difference, duration, epoch_angle),
            epoch_angle,
            exact,
            anchor: None,
        }
    }

    /// The same two motions with the roles exchanged: B seen from A.
    pub fn reversed(&self) -> Self {
        let exact = Exact {
            offset: self.exact.offset.map(|part| -part),
            velocity: self.exact.velocity.map(|part| -part),
            rotation_a: self.exact.rotation_b,
            rotation_b: self.exact.rotation_a,
        };
        let (offset, velocity, spin_difference) = (-self.offset, -self.velocity, -self.spin_difference);
        Self {
            offset,
            velocity,
            spin_a: self.spin_b,
            spin_b: self.spin_a,
            spin_difference,
            at_a: self.at_b,
            at_b: self.at_a,
            rotation_a: self.rotation_b,
            rotation_b: self.rotation_a,
            bounds: Bounds::new(
                offset,
                velocity,
                &self.spin_b,
                &self.spin_a,
                spin_difference,
                self.duration,
                self.epoch_angle,
            ),
            exact,
            anchor: None,
            ..*self
        }
    }

    /// Start of the window (the epoch).
    pub const fn start(&self) -> f64 {
        self.start
    }

    /// End of the window.
    pub const fn end(&self) -> f64 {
        self.end
    }

    /// `end − start`, rounded up.
    pub const fn duration(&self) -> f64 {
        self.duration
    }

    /// Rate of turn of A, rounded to nearest.
    pub const fn speed_a(&self) -> f64 {
        self.spin_a.speed
    }

    /// Rate of turn of B, rounded to nearest.
    pub const fn speed_b(&self) -> f64 {
        self.spin_b.speed
    }

    /// A point of A (body frame) as the vector from A's reference point (from the anchor, if there is one), world
    /// axes at the epoch. Error ≤ 8·2⁻⁵³ of its length, which [`RelativeMotion::point_remainder`] counts.
    #[inline]
    pub fn place_a(&self, point: DVec3) -> DVec3 {
        let origin = self.anchor.as_ref().map_or(self.at_a, |anchor| anchor.point_a);
        self.rotation_a * (point - origin)
    }

    /// A point of B (body frame) in the epoch frame of B (from the anchor, if there is one).
    #[inline]
    pub fn place_b(&self, point: DVec3) -> DVec3 {
        let origin = self.anchor.as_ref().map_or(self.at_b, |anchor| anchor.point_b);
        self.rotation_b * (point - origin)
    }

    /// A difference of two points of A (body frame) in world axes at the epoch. Error ≤ 8·2⁻⁵³ of its length.
    #[inline]
    pub fn turn_a(&self, vector: DVec3) -> DVec3 {
        self.rotation_a * vector
    }

    /// A difference of two points of B (body frame) in the epoch frame of B.
    #[inline]
    pub fn turn_b(&self, vector: DVec3) -> DVec3 {
        self.rotation_b * vector
    }

    /// Real time of `τ`, rounded down, not before the window.
    #[inline]
    pub fn time_down(&self, tau: f64) -> f64 {
        let (sum, error) = d2m_lanes::two_sum(self.start, tau);
        (if error < 0.0 { sum.next_down() } else { sum }).max(self.start)
    }

    /// Real time of `τ`, rounded up, not after the window.
    #[inline]
    pub fn time_up(&self, tau: f64) -> f64 {
        let (sum, error) = d2m_lanes::two_sum(self.start, tau);
        (if error > 0.0 { sum.next_up() } else { sum }).min(self.end)
    }
}
