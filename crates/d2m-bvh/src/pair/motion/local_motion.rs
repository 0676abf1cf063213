//! A constant twist on the clock and in the unit of length of a search.

use super::rotation::{Columns, FixedAxisRotation};
use super::units::Units;
use core::ops::Mul;
use d2m_lanes::DoubleDouble;
use d2m_motion::ConstantTwist;
use glam::DVec3;

/// A constant twist, times and lengths in [`Units`].
///
/// The reference point is moved where it is nearest to the center of the body: along the axis of the spin, or anywhere
/// if there is no spin. That changes its position by a vector that is the same at all times, and nothing else of the
/// motion; so distances from it are distances from the axis as far as the body's center is concerned.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalMotion {
    position: DVec3,
    linear_velocity: DVec3,
    angular_velocity: DVec3,
    /// From the given reference point to the one in use, world axes.
    shift: DVec3,
    /// From the reference point in use, and from the given one, to the center of the tree, body axes.
    arm: DVec3,
    given_arm: DVec3,
    turning: FixedAxisRotation,
    /// From the reference time to the start of the window.
    elapsed: DoubleDouble,
}

impl LocalMotion {
    /// Of a body with this center.
    pub(crate) fn new(motion: &ConstantTwist, center: DVec3, start: f64, units: &Units) -> Self {
        let (per_length, time, per_time) = (1.0 / units.length(), units.time(), 1.0 / units.time());
        let angular_velocity = motion.angular_velocity() * time;
        let speed = per_length * time;
        let linear_velocity = if speed.is_normal() {
            motion.linear_velocity() * speed
        } else {
            motion.linear_velocity() * time * per_length
        };
        let turning = FixedAxisRotation::new(motion.orientation().to_array(), angular_velocity);
        let given_arm = (center - motion.at()) * per_length;
        let [x, y, z] = turning.start();
        let turn = |p: DVec3| x * p.x + y * p.y + z * p.z;
        let (shift, arm) = if angular_velocity == DVec3::ZERO {
            (turn(given_arm), DVec3::ZERO)
        } else {
            // In body axes the axis of the spin stays where it is.
            let k = turning.axis();
            let k = DVec3::new(x.dot(k), y.dot(k), z.dot(k));
            let along = k * k.dot(given_arm);
            (turn(along), given_arm - along)
        };
        // The time means nothing for a body at rest.
        let rests = angular_velocity == DVec3::ZERO && linear_velocity == DVec3::ZERO;
        let since = DoubleDouble::from_sum(start, -motion.reference_time());
        let elapsed = if rests {
            DoubleDouble::new(0.0, 0.0)
        } else {
            DoubleDouble::new(since.hi * per_time, since.lo * per_time)
        };
        let position = motion.position() * per_length;
        Self { position, linear_velocity, angular_velocity, shift, arm, given_arm, turning, elapsed }
    }

    /// The motion as it is: offsets count from time zero, in seconds, and the reference point stays.
    #[cfg(test)]
    pub(crate) fn unscaled(motion: &ConstantTwist) -> Self {
        let units = Units::new(crate::Window::UNIT, 1.0, 1.0);
        Self::new(motion, motion.at(), 0.0, &units)
    }

    /// World position of the given reference point at the reference time.
    pub(crate) const fn position(&self) -> DVec3 {
        self.position
    }

    /// Velocity of the reference point, world axes.
    pub(crate) const fn linear_velocity(&self) -> DVec3 {
        self.linear_velocity
    }

    /// Angular velocity, world axes.
    pub(crate) const fn angular_velocity(&self) -> DVec3 {
        self.angular_velocity
    }

    /// From the given reference point to the one in use, world axes, at all times.
    pub(crate) const fn shift(&self) -> DVec3 {
        self.shift
    }

    /// From the reference point in use to the center of the tree, body axes.
    pub(crate) const fn arm(&self) -> DVec3 {
        self.arm
    }

    /// From the given reference point to the center of the tree, body axes.
    pub(crate) const fn given_arm(&self) -> DVec3 {
        self.given_arm
    }

    /// How the body turns.
    pub(crate) const fn turning(&self) -> &FixedAxisRotation {
        &self.turning
    }

    /// From the reference time to the start of the window.
    pub(crate) const fn elapsed_at_start(&self) -> DoubleDouble {
        self.elapsed
    }

    /// From the reference time to an offset.
    pub(crate) fn elapsed(&self, offset: f64) -> DoubleDouble {
        let sum = DoubleDouble::from_sum(self.elapsed.hi, offset);
        DoubleDouble::from_sum(sum.hi, sum.lo + self.elapsed.lo)
    }

    /// World position of the reference point in use at an offset: for witness points, no bound rests on it.
    pub(crate) fn estimate_position(&self, offset: f64) -> DVec3 {
        let elapsed = self.elapsed(offset);
        let one = |k: usize| {
            elapsed.mul(self.linear_velocity[k]).add_sloppily(DoubleDouble::new(self.position[k], 0.0)).hi
        };
        DVec3::new(one(0), one(1), one(2)) + self.shift
    }

    /// The axes of the body at an offset: exp([ω](t − t_ref))·R(q/|q|) as columns, each entry within 16·2⁻⁵³ of the true
    /// one, for an angle of less than 2⁵⁰ radians.
    pub(crate) fn rotation(&self, offset: f64) -> Columns {
        let turn = self.turning.after(self.elapsed(offset));
        self.turning.start().map(|p| self.turning.terms_of(p).at(&turn))
    }

    /// Bound on the terms of the position, up to an offset of one, by which its rounding is measured.
    pub(crate) fn terms(&self) -> f64 {
        let largest = |v: DVec3| v.abs().max_element();
        let longest = (self.elapsed.hi.abs() + 1.0).max(self.elapsed(1.0).hi.abs());
        largest(self.position) + largest(self.shift) + largest(self.linear_velocity) * longest
    }

    /// Bound on the angle between the reference time and any offset up to `end`.
    pub(crate) fn angle(&self, end: f64) -> f64 {
        let longest = self.elapsed.hi.abs().max(self.elapsed(end).hi.abs());
        self.turning.speed() * longest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_motion::{ConstantTwist, RigidMotion};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DQuat;

    #[test]
    fn rotations_lie_in_the_enclosures_of_the_motion_crate() {
        let mut random = KnuthRandom(1);
        for round in 0..2000 {
            let q = random.quaternion();
            let w = random.vector() * 10f64.powi(round % 5 - 2);
            let motion = ConstantTwist::try_new(DVec3::ZERO, q, DVec3::ZERO, w).unwrap();
            let t = random.signed() * 10.0;
            let got = LocalMotion::unscaled(&motion).rotation(t);
            let enclosure = motion.enclose_pose(d2m_interval::Interval::point(t)).rotation.cols();
            for (column, enclosed) in got.iter().zip(enclosure) {
                for (value, interval) in
                    [(column.x, enclosed.x), (column.y, enclosed.y), (column.z, enclosed.z)]
                {
                    assert!(value >= interval.lo() - 2e-15 && value <= interval.hi() + 2e-15);
                    assert!(
                        (value - interval.mid()).abs() < 16.0 / 9_007_199_254_740_992.0 + interval.width()
                    );
                }
            }
        }
    }

    #[test]
    fn far_times_lose_nothing() {
        let motion =
            ConstantTwist::try_new(DVec3::ZERO, DQuat::IDENTITY, DVec3::ZERO, DVec3::new(0.0, 0.0, 3.0))
                .unwrap();
        // sin and cos of exactly 300000 radians.
        let got = LocalMotion::unscaled(&motion).rotation(100_000.0);
        let (sin, cos) = (0.107_063_649_413_132_36, -0.994_252_168_704_872_3);
        assert!((got[0].x - cos).abs() < 1e-14);
        assert!((got[0].y - sin).abs() < 1e-14);
        assert!((got[0].length() - 1.0).abs() < 1e-15);
    }
}
