//! Units of length and time in which the numbers of a query are near one.
//!
//! Every test works with products of up to six lengths and speeds; in the units of the input these may under- or overflow
//! although each number is finite. So all numbers of a query are multiplied by powers of two first, which rounds nothing:
//! verdicts, brackets relative to the window and feature pairs are the same for every exact scaling of lengths or times.
use crate::contact::{ContactBracket, FirstContact};
use d2m_lanes::{power_of_two, scaled};
use d2m_motion::{Ball, CertifiedState, ConstantTwist, Kinematics};
use glam::DVec3;

/// The exponent of zero: smaller than every other one, with room to add to it.
const OF_ZERO: i32 = i32::MIN / 8;
/// The largest k for which 2ᵏ and 2⁻ᵏ are normal numbers.
const LARGEST_NORMAL: i32 = 1022;
/// Exponent of the powers of two between which features may lie, in units of the motion, without new units: 2±²⁰⁰. Products
/// of four such lengths stay within 2±⁸⁰⁰.
const EXPONENT_OF_RANGE: i32 = 200;
/// The size of features that are too small for the units of the motion, in these.
pub(crate) const SMALL: f64 = power_of_two(-EXPONENT_OF_RANGE);

/// k with |x| in [2ᵏ, 2ᵏ⁺¹); −1023 for subnormal numbers, 1024 for what is not finite, far below all for zero.
pub(crate) fn exponent(x: f64) -> i32 {
    if x == 0.0 { OF_ZERO } else { ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023 }
}

/// The exponent of the largest component.
pub(crate) fn vector_exponent(v: DVec3) -> i32 {
    exponent(v.x).max(exponent(v.y)).max(exponent(v.z))
}

/// `v·2ᵏ`: exact unless it over- or underflows.
pub(crate) fn scaled_vector(v: DVec3, k: i32) -> DVec3 {
    DVec3::new(scaled(v.x, k), scaled(v.y, k), scaled(v.z, k))
}

/// Powers of two that lengths and times are multiplied by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Units {
    /// Lengths are multiplied by `2^-length`.
    length: i32,
    /// Times are multiplied by `2^-time`.
    time: i32,
    /// `2^-length` and its inverse, where both are normal numbers.
    factor: f64,
    inverse: f64,
    /// Sizes of features (in the input's units) that certainly need no other units of length: `[least, greatest]`; empty
    /// if one of these or `factor` is not a normal number.
    range: [f64; 2],
}

impl Units {
    /// Those of the input.
    pub(crate) const NONE: Self =
        Self { length: 0, time: 0, factor: 1.0, inverse: 1.0, range: [0.0, f64::MAX] };

    /// The units of two motions over a window: times in units of its length, lengths in units of how far the reference
    /// points are from the origin and of their body frames'.
    ///
    /// Without any length in the motions themselves lengths stay as they are: the features have the say.
    pub(crate) fn of_motions(motions: &[ConstantTwist; 2], start: f64, end: f64) -> Self {
        let window = exponent(end - start);
        let mut speed = OF_ZERO;
        let mut rate = OF_ZERO;
        let mut place = OF_ZERO;
        let mut until = window;
        for motion in motions {
            speed = speed.max(vector_exponent(motion.linear_velocity()));
            rate = rate.max(vector_exponent(motion.angular_velocity()));
            place = place.max(vector_exponent(motion.position())).max(vector_exponent(motion.at()));
            let reference = motion.reference_time();
            until = until.max(exponent(start - reference)).max(exponent(end - reference));
        }
        let length = place.max(if speed == OF_ZERO { OF_ZERO } else { speed + until + 1 });
        let length = if length < OF_ZERO / 2 { 0 } else { length };
        let time = if window == OF_ZERO {
            // No length of time: so that the rates are at most about one.
            let turning = if rate == OF_ZERO { -OF_ZERO } else { -rate };
            let moving = if speed == OF_ZERO { -OF_ZERO } else { length - speed };
            let least = turning.min(moving);
            if least == -OF_ZERO { 0 } else { least }
        } else {
            window
        };
        Self::new(length, time)
    }

    /// Units in which a length is in [1, 2), or as it is if it is zero.
    #[inline(always)]
    pub(crate) fn of_size(size: f64) -> Self {
        let length = exponent(size);
        Self::new(if length == OF_ZERO { 0 } else { length }, 0)
    }

    #[inline(always)]
    fn new(length: i32, time: i32) -> Self {
        let (factor, inverse, range) = if length.abs() <= LARGEST_NORMAL - EXPONENT_OF_RANGE {
            let size = |k: i32| power_of_two(length + k);
            let range = [size(-EXPONENT_OF_RANGE), size(EXPONENT_OF_RANGE)];
            (power_of_two(-length), power_of_two(length), range)
        } else {
            (1.0, 1.0, [f64::INFINITY, f64::NEG_INFINITY])
        };
        Self { length, time, factor, inverse, range }
    }

    /// The same units of time with lengths in units of features whose largest number is `size`.
    pub(crate) fn with_length_of(&self, size: f64) -> Self {
        Self::new(exponent(size), self.time)
    }

    /// The units of any two motions about the middle of a window, from their states there: lengths in units of the
    /// distance of the reference points, of how far they move, of their body frames' and of `size`.
    pub(crate) fn of_states(states: &[CertifiedState; 2], size: f64, start: f64, end: f64) -> Self {
        let window = exponent(end - start);
        let [a, b] = states;
        let place = vector_exponent(a.position - b.position)
            .max(vector_exponent(a.at))
            .max(vector_exponent(b.at))
            .max(exponent(size));
        let speed = vector_exponent(a.linear - b.linear);
        let length = place.max(if speed.min(window) == OF_ZERO { OF_ZERO } else { speed + window });
        let known = |k: i32| if k < OF_ZERO / 2 { 0 } else { k };
        Self::new(known(length), known(window))
    }

    /// Lengths are multiplied by two to the minus this.
    pub(crate) const fn length_exponent(&self) -> i32 {
        self.length
    }

    /// Times are multiplied by two to the minus this, rates by two to this.
    pub(crate) const fn time_exponent(&self) -> i32 {
        self.time
    }

    /// Speeds are multiplied by two to this.
    pub(crate) const fn speed_exponent(&self) -> i32 {
        self.time - self.length
    }

    /// True if features whose largest number is `size` (in the input's units) need no other units.
    #[inline(always)]
    pub(crate) fn serve(&self, size: f64) -> bool {
        (self.range[0] <= size && size <= self.range[1]) || self.serve_slowly(size)
    }

    #[cold]
    fn serve_slowly(&self, size: f64) -> bool {
        size == 0.0 || (exponent(size) - self.length).abs() < EXPONENT_OF_RANGE
    }

    /// True if features whose largest number is `size` are smaller than `2⁻²⁰⁰` of these units.
    pub(crate) fn dwarf(&self, size: f64) -> bool {
        exponent(size) < self.length - EXPONENT_OF_RANGE
    }

    /// A length in these units.
    #[inline(always)]
    pub(crate) fn length(&self, x: f64) -> f64 {
        if self.range[0] <= self.range[1] { x * self.factor } else { scaled(x, -self.length) }
    }

    /// A point in these units.
    #[inline(always)]
    pub(crate) fn point(&self, p: DVec3) -> DVec3 {
        if self.range[0] <= self.range[1] { p * self.factor } else { self.point_slowly(p) }
    }

    /// Points in these units. (Written out: a closure over an array is a call.)
    #[inline(always)]
    pub(crate) fn points<const N: usize>(&self, mut points: [DVec3; N]) -> [DVec3; N] {
        for p in &mut points {
            *p = self.point(*p);
        }
        points
    }

    #[cold]
    fn point_slowly(&self, p: DVec3) -> DVec3 {
        scaled_vector(p, -self.length)
    }

    /// A length of these units in the input's, rounded up where it is subnormal.
    #[inline(always)]
    pub(crate) fn length_up(&self, x: f64) -> f64 {
        let there = if self.range[0] <= self.range[1] { x * self.inverse } else { scaled(x, self.length) };
        if there < f64::MIN_POSITIVE && x > 0.0 { there.next_up() } else { there }
    }

    /// A length of these units in the input's, rounded to nearest where it is subnormal.
    pub(crate) fn length_back(&self, x: f64) -> f64 {
        scaled(x, self.length)
    }

    /// A point of these units in the input's.
    pub(crate) fn point_back(&self, p: DVec3) -> DVec3 {
        scaled_vector(p, self.length)
    }

    /// A speed of these units in the input's.
    pub(crate) fn speed_back(&self, x: f64) -> f64 {
        scaled(x, self.length - self.time)
    }

    /// A time in these units.
    pub(crate) fn time(&self, t: f64) -> f64 {
        scaled(t, -self.time)
    }

    /// A state in these units.
    pub(crate) fn state(&self, state: &CertifiedState) -> CertifiedState {
        let (speed, time) = (self.speed_exponent(), self.time_exponent());
        CertifiedState {
            position: self.point(state.position),
            at: self.point(state.at),
            linear: scaled_vector(state.linear, speed),
            angular: scaled_vector(state.angular, time),
            position_radius: self.length(state.position_radius),
            linear_radius: scaled(state.linear_radius, speed),
            angular_radius: scaled(state.angular_radius, time),
            ..*state
        }
    }

    /// What holds over a span of time, in these units.
    pub(crate) fn kinematics(&self, over: &Kinematics) -> Kinematics {
        let in_units = |ball: Ball, k: i32| Ball::new(scaled_vector(ball.center, k), scaled(ball.radius, k));
        let (length, speed, time) = (-self.length, self.speed_exponent(), self.time_exponent());
        Kinematics {
            position: in_units(over.position, length),
            position_tail: self.point(over.position_tail),
            at: self.point(over.at),
            linear: in_units(over.linear, speed),
            angular: in_units(over.angular, time),
            linear_rate: in_units(over.linear_rate, speed + time),
            angular_rate: in_units(over.angular_rate, 2 * time),
            ..*over
        }
    }

    /// A time of these units in the input's, rounded down.
    #[inline]
    pub(crate) fn time_down(&self, t: f64) -> f64 {
        let there = scaled(t, self.time);
        // Exact where it is normal.
        if there.abs() < f64::MIN_POSITIVE && scaled(there, -self.time) > t {
            there.next_down()
        } else {
            there
        }
    }

    /// A time of these units in the input's, rounded up.
    #[inline]
    pub(crate) fn time_up(&self, t: f64) -> f64 {
        let there = scaled(t, self.time);
        if there.abs() < f64::MIN_POSITIVE && scaled(there, -self.time) < t { there.next_up() } else { there }
    }

    /// An answer in these units as one in the input's, its times within `[start, end]`.
    #[inline(always)]
    pub(crate) fn answer_back(&self, answer: FirstContact, start: f64, end: f64) -> FirstContact {
        match answer {
            FirstContact::Clear => FirstContact::Clear,
            FirstContact::Undecided { clear_until } => {
                FirstContact::Undecided { clear_until: self.time_down(clear_until).max(start) }
            }
            FirstContact::Contact(contact) => {
                let lo = self.time_down(contact.lo).max(start);
                let hi = self.time_up(contact.hi).min(end).max(lo);
                let (distance, tolerance) =
                    (self.length_up(contact.distance), self.length_up(contact.tolerance));
                FirstContact::Contact(ContactBracket { lo, hi, distance, tolerance, ..contact })
            }
        }
    }

    /// A motion in these units; `None` where a number of it overflows.
    pub(crate) fn try_motion(&self, motion: &ConstantTwist, epoch: f64) -> Option<ConstantTwist> {
        let (linear, angular) = (motion.linear_velocity(), motion.angular_velocity());
        // A body at rest is where it is at every time.
        let rests = linear == DVec3::ZERO && angular == DVec3::ZERO;
        let reference = if rests { epoch } else { motion.reference_time() };
        ConstantTwist::try_new(
            scaled_vector(motion.position(), -self.length),
            motion.orientation(),
            scaled_vector(linear, self.time - self.length),
            scaled_vector(angular, self.time),
        )
        .and_then(|scaled| scaled.try_with_reference_time(self.time(reference)))
        .and_then(|scaled| scaled.try_with_at(scaled_vector(motion.at(), -self.length)))
        .ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_round_nothing_and_come_back() {
        for k in [-2000, -1100, -1022, -400, 0, 3, 1022, 1500, 2040] {
            for x in [1.0, -1.75, 0.3] {
                let there = scaled(x, k);
                assert!(!there.is_normal() || scaled(there, -k) == x, "{x} 2^{k}");
            }
        }
        assert_eq!(scaled(f64::from_bits(1), 1074), 1.0);
        assert_eq!(scaled(1.0, -1074), f64::from_bits(1));
        assert_eq!((exponent(1.0), exponent(-7.9), exponent(0.25)), (0, 2, -2));
    }

    #[test]
    fn units_follow_the_input() {
        let motion = |k: i32, m: i32| {
            let unit = |x: f64, k: i32| scaled(x, k);
            let a = ConstantTwist::REST
                .with_position(DVec3::new(unit(1.3, k), 0.0, unit(-0.7, k)))
                .with_linear_velocity(DVec3::new(0.0, unit(5.0, k - m), 0.0))
                .with_angular_velocity(DVec3::new(unit(0.2, -m), 0.0, 0.0));
            let units = Units::of_motions(&[a, ConstantTwist::REST], 0.0, unit(1.0, m));
            (units.try_motion(&a, 0.0), units.time(unit(1.0, m)))
        };
        let plain = motion(0, 0);
        assert!(plain.0.is_some());
        for (k, m) in [(900, 0), (-900, 0), (0, 900), (0, -900), (500, -300), (-500, -300)] {
            assert_eq!(motion(k, m), plain, "2^{k} 2^{m}");
        }
    }

    #[test]
    fn times_come_back_rounded_outward() {
        let units = Units::new(0, -1040);
        let t = 1.0 + f64::EPSILON;
        assert!(units.time(units.time_down(t)) <= t && units.time(units.time_up(t)) >= t);
        let units = Units::new(0, 700);
        assert_eq!((units.time_down(t), units.time_up(t)), (scaled(t, 700), scaled(t, 700)));
    }
}
