//! A number as a pair of doubles with a bound of its error, and sums, products and quotients of such numbers.
use crate::ball::up;
use core::ops::{Add, Mul, Sub};
use d2m_interval::Interval;
use d2m_lanes::{DoubleDouble, power_of_two};

/// One step of Horner's scheme in pairs of doubles is off by less than this of the magnitudes that it adds.
///
/// A product with a double loses at most 2·2⁻¹⁰⁴ and a sum 4·2⁻¹⁰⁶ of the operands; 2⁻¹⁰⁰ leaves a factor of four.
pub(crate) const STEP: f64 = power_of_two(-100);

/// A number within `radius` of `center`, a pair of doubles.
///
/// Each operation of pairs of doubles is within [`STEP`] of the magnitudes that it adds, or multiplies, away from underflow,
/// which takes at most the smallest normal number. What overflows has no finite radius.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Enclosed {
    pub(crate) center: DoubleDouble,
    pub(crate) radius: f64,
}

impl Enclosed {
    /// Any number.
    pub(crate) const ANY: Self = Self { center: DoubleDouble::ZERO, radius: f64::INFINITY };

    pub(crate) fn hull(self, other: Self) -> Self {
        let center = DoubleDouble::from_f64(0.5 * self.center.hi + 0.5 * other.center.hi);
        let reach = |e: Self| {
            let apart = e.center - center;
            up(apart.hi.abs() + e.radius) + 4.0 * f64::EPSILON * apart.hi.abs()
        };
        Self { center, radius: up(reach(self).max(reach(other))) }
    }

    pub(crate) fn to_interval(self) -> Interval {
        Interval::around(self.center.hi, up(self.radius + self.center.lo.abs()))
    }

    /// Of all numbers that it holds.
    pub(crate) fn magnitude(self) -> f64 {
        up(self.center.hi.abs() * (1.0 + f64::EPSILON) + self.radius)
    }

    pub(crate) const fn exact(value: f64) -> Self {
        Self { center: DoubleDouble::from_f64(value), radius: 0.0 }
    }

    fn center_magnitude(self) -> f64 {
        up(self.center.hi.abs())
    }

    /// Divided by h as often as `times` says; h is exact, and its inverse does not overflow.
    pub(crate) fn over(self, h: DoubleDouble, times: u32) -> Self {
        (0..times).fold(self, |Self { center, radius }, _| {
            let quotient = center / h;
            let lost = up(radius + f64::MIN_POSITIVE) / h.hi + STEP * quotient.hi.abs();
            Self { center: quotient, radius: up(lost) }
        })
    }

    /// `None` where it overflowed.
    pub(crate) fn if_finite(self) -> Option<Self> {
        let is_finite =
            self.center.hi.is_finite() && self.center.lo.is_finite() && self.radius < f64::INFINITY;
        is_finite.then_some(self)
    }
}

impl Add for Enclosed {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let lost = STEP * (self.center_magnitude() + other.center_magnitude());
        Self { center: self.center + other.center, radius: up(self.radius + other.radius + lost) }
    }
}

impl Sub for Enclosed {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + Self { center: -other.center, ..other }
    }
}

impl Mul for Enclosed {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.center_magnitude(), other.center_magnitude());
        let lost = up(a * other.radius + self.radius * (b + other.radius)) + STEP * a * b;
        Self { center: self.center * other.center, radius: up(lost) + f64::MIN_POSITIVE }
    }
}

impl Mul<f64> for Enclosed {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self * Self::exact(factor)
    }
}
