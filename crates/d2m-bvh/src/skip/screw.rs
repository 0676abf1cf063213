//! The screw about a common axis that two bodies make as seen from each other.

use crate::pair::scene::{MovingScene, SceneBody};
use d2m_mesh::margin::{UNIT_F64, UP};
use glam::DVec3;

/// Error of a unit axis as computed, as an angle.
const AXIS_ERROR: f64 = 8.0 * UNIT_F64;
/// Axes that are further from parallel (radians) are not taken for one: points would leave their screws by that part of
/// their distance.
const MOST_TILT: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰
/// See [`Screw::new`]: 2·1.0001 for both bodies, and roundings.
const TILT_FACTOR: f64 = 2.125;
/// Part of the speeds that the roundings of rate, climb and their quotient stand for: fewer than 16.
const RATE_ERROR: f64 = 16.0 * UNIT_F64;

/// The common axis, and how A moves along it as seen from B.
pub(super) struct Screw {
    axis: DVec3,
    /// Directions of the angles 0 and π/2.
    across: [DVec3; 2],
    /// φ = z − hθ.
    pub(super) h: f64,
    pub(super) lead: f64,
    /// Speed of A's points along the axis.
    pub(super) climb: f64,
    /// Speed at which φ changes: the climb when it is left out of h.
    pub(super) slide: f64,
    /// Distance of the two axes at the start, and how fast it grows: across the axis.
    pub(super) across_now: f64,
    pub(super) across_rate: f64,
    /// What the angle between the axes moves points by, and how fast the rest of the true motion leaves the screw, whatever the direction.
    pub(super) tilted: f64,
    pub(super) drift: f64,
}

impl Screw {
    /// None unless one body is at rest or both turn about parallel axes, and not alike.
    pub(super) fn new(scene: &MovingScene<'_>, start: f64) -> Option<Self> {
        let (a, b) = (&scene.a, &scene.b);
        let [wa, wb] = [a, b].map(|body| body.motion.angular_velocity());
        let [ka, kb] = [a, b].map(|body| body.motion.turning().axis());
        let axis = scene.spin_axis()?;
        let both = wa != DVec3::ZERO && wb != DVec3::ZERO;
        // The sine of the angle between the axes, and the cosine's sign is that of `rate`.
        let tilt = if both { ka.cross(kb).length() + AXIS_ERROR } else { AXIS_ERROR };
        if tilt > MOST_TILT {
            return None;
        }
        let rate = axis.dot(wa - wb);
        let spins = a.spin() + b.spin();
        let velocity = a.motion.linear_velocity() - b.motion.linear_velocity();
        let climb = axis.dot(velocity);
        let flat = |p: DVec3| (p - axis * axis.dot(p)).length();
        let apart = if both { flat(scene.track.at(start)) } else { 0.0 };
        let first = axis.any_orthonormal_vector();
        let h = climb / rate;
        let lead = 2.0 * std::f64::consts::PI * h.abs();
        // A turn by θ about an axis that is tilted by ε moves a point by less than 2.01 ερ from where the turn about the
        // other one does: exp(θ[k′]) = Q exp(θ[k]) Qᵀ with |Q − 1| ≤ 1.0001 ε.
        let reach = a.reach() + b.reach();
        let tilted = TILT_FACTOR * tilt * reach;
        // The speeds as computed err by roundings of the speeds of both bodies, and by what the tilt takes from them.
        let rate_error = (tilt * tilt + RATE_ERROR) * spins;
        // Once for the climb, once for what is left along the axis of the velocity across it.
        let climb_error = 2.0 * RATE_ERROR * velocity.length();
        let speed_error = rate_error * reach + climb_error;
        (h.is_finite() && lead.is_finite()).then_some(Self {
            axis,
            across: [first, axis.cross(first)],
            h,
            lead,
            climb,
            slide: 0.0,
            across_now: apart * UP,
            across_rate: flat(velocity) * UP,
            tilted: tilted * UP,
            drift: speed_error * UP,
        })
    }

    /// The same as a turn in place whose φ, the height, changes by the climb. For leads that are short against the triangles.
    pub(super) fn turn_in_place(&self) -> Self {
        Self { h: 0.0, lead: 0.0, slide: self.climb.abs(), ..*self }
    }

    /// Bound on |∇φ| at distances of at least `rho`.
    pub(super) fn steepness(&self, rho: f64) -> f64 {
        (1.0 + (self.h / rho) * (self.h / rho)).sqrt()
    }

    /// Where points of both bodies (from the trees' centers, body axes) are at the start, from the axis, which is the
    /// third coordinate. Heights count from B's reference point if it turns, else from A's; distances from the own axis,
    /// or the other's.
    pub(super) fn places(&self, scene: &MovingScene<'_>, start: f64) -> [impl Fn(DVec3) -> DVec3; 2] {
        let apart = scene.track.at(start);
        let [spins_a, spins_b] =
            [&scene.a, &scene.b].map(|body| body.motion.angular_velocity() != DVec3::ZERO);
        let (from_a, from_b) = match (spins_a, spins_b) {
            (true, true) => (self.axis * self.axis.dot(apart), DVec3::ZERO),
            (true, false) => (DVec3::ZERO, -apart),
            _ => (apart, DVec3::ZERO),
        };
        [(&scene.a, from_a), (&scene.b, from_b)].map(|(body, from): (&SceneBody<'_>, _)| {
            let r = body.motion.rotation(start);
            let arm = body.motion.arm();
            let ([u, w], axis) = (self.across, self.axis);
            move |p: DVec3| {
                let p = p + arm;
                let placed = r[0] * p.x + r[1] * p.y + r[2] * p.z + from;
                DVec3::new(u.dot(placed), w.dot(placed), axis.dot(placed))
            }
        })
    }
}
