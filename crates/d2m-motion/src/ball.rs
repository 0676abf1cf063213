//! A vector that is known up to a radius: ball arithmetic (midpoints with proven radii).
use crate::rounding::{UNDERFLOW, UNIT, UP};
use core::ops::{Add, Sub};
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::power_of_two;
use glam::{DMat3, DVec3};

/// Squares of components between these keep all digits and three of them stay finite: 2⁻⁴⁵⁰ and 2⁵⁰⁰.
const LEAST_SQUARED: f64 = power_of_two(-450);
const MOST_SQUARED: f64 = power_of_two(500);
/// Above √3 = 1.73205…, by more than the rounding of a product.
const ABOVE_ROOT_OF_THREE: f64 = 1.733;

/// Every vector within `radius` of `center`. An infinite radius (about zero) says that nothing is known.
///
/// ```
/// use d2m_motion::Ball;
/// use glam::DVec3;
/// let sum = Ball::new(DVec3::X, 0.5) + Ball::point(DVec3::Y);
/// assert!(sum.center == DVec3::new(1.0, 1.0, 0.0) && sum.radius >= 0.5 && sum.radius < 0.500_001);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    /// The middle.
    pub center: DVec3,
    /// Bound of the distance of the truth from the middle.
    pub radius: f64,
}

impl Ball {
    /// Exactly zero.
    pub const ZERO: Self = Self { center: DVec3::ZERO, radius: 0.0 };

    /// Nothing is known.
    pub(crate) const ANY: Self = Self { center: DVec3::ZERO, radius: f64::INFINITY };

    /// All vectors within `radius` of `center`; everything when either is not finite.
    pub fn new(center: DVec3, radius: f64) -> Self {
        if center.is_finite() && radius < f64::INFINITY {
            Self { center, radius }
        } else {
            Self { center: DVec3::ZERO, radius: f64::INFINITY }
        }
    }

    /// Exactly this vector.
    pub fn point(center: DVec3) -> Self {
        Self::new(center, 0.0)
    }

    /// A ball about a box: `½(lo + hi)` with the length of the half-widths, plus one rounding of either.
    ///
    /// With `|m − ½(lo + hi)| ≤ u|m|` and `½(hi − lo)` rounded within u of itself, a point of the box is within
    /// `½(hi − lo)(1 + u) + u|m|` of `m` in each coordinate. Of what is not finite nothing is known.
    #[inline]
    pub fn around_box(v: IntervalVec3) -> Self {
        let middle = |i: Interval| 0.5 * (i.lo() + i.hi());
        let half = |i: Interval| 0.5 * (i.hi() - i.lo());
        let m = DVec3::new(middle(v.x), middle(v.y), middle(v.z));
        let r = DVec3::new(half(v.x), half(v.y), half(v.z));
        Self::new(m, (r.length() + f64::EPSILON * m.length()) * UP + UNDERFLOW)
    }

    /// A box about the ball.
    pub fn to_box(self) -> IntervalVec3 {
        IntervalVec3::around(self.center, self.radius)
    }

    /// Upper bound of the lengths of all its vectors.
    pub fn bound_length(self) -> f64 {
        up(length_up(self.center) + self.radius)
    }

    /// Encloses the products with the numbers within `radius` of `factor`.
    #[must_use]
    pub fn times(self, factor: f64, radius: f64) -> Self {
        if self == Self::ZERO || (factor, radius) == (0.0, 0.0) {
            return Self::ZERO;
        }
        let center = self.center * factor;
        let known = times_up(radius, self.bound_length());
        // Of what underflows to zero something is lost, too.
        let rounding = times_up(UNIT, length_up(center).max(f64::MIN_POSITIVE));
        Self::new(center, up(known + times_up(self.radius, factor.abs()) + rounding))
    }

    /// Encloses the cross products.
    ///
    /// A component of a × b is off by 2u(|a_y b_z| + |a_z b_y|) and the like, which is less than 4u|a||b| in length.
    #[must_use]
    pub fn cross(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        let (long, wide) = (length_up(self.center), length_up(other.center));
        let spread = times_up(self.radius, up(wide + other.radius)) + times_up(long, other.radius);
        Self::new(self.center.cross(other.center), up(spread + times_up(4.0 * UNIT, times_up(long, wide))))
    }

    /// Encloses the vectors turned by every rotation within `radius` (operator norm) of the matrix.
    ///
    /// `|R a − R̃ ã| ≤ |a − ã| + ‖R − R̃‖|ã|`; the product rounds by 3u of |R̃||ã| in each component, √3·√3 of it in all.
    #[must_use]
    pub fn turned(self, rotation: &DMat3, radius: f64) -> Self {
        if self == Self::ZERO || (radius == 0.0 && *rotation == DMat3::IDENTITY) {
            return self;
        }
        let long = length_up(self.center);
        let spread = times_up(radius + 10.0 * UNIT * (1.0 + radius), long);
        Self::new(*rotation * self.center, up(self.radius + spread))
    }

    /// A ball about this one and another.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        let center = 0.5 * self.center + 0.5 * other.center;
        let reach = |b: Self| up(length_up(b.center - center) + b.radius + 4.0 * UNIT * length_up(b.center));
        Self::new(center, up(reach(self).max(reach(other))))
    }
}

/// Encloses the sums of vectors of the one and the other: a component of a sum is off by at most u of itself.
impl Add for Ball {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        if other == Self::ZERO {
            return self;
        }
        if self == Self::ZERO {
            return other;
        }
        let center = self.center + other.center;
        Self::new(center, up(self.radius + other.radius + UNIT * length_up(center)))
    }
}

/// Encloses the differences.
impl Sub for Ball {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { center: -other.center, ..other }
    }
}

/// One rounding up of a sum or product of non-negative numbers; what is no number becomes infinite.
pub(crate) fn up(x: f64) -> f64 {
    let x = x * UP;
    if x < f64::INFINITY { x } else { f64::INFINITY }
}

/// Bound of the error of a product of two rotations, computed in doubles, by those of both.
#[inline]
pub(crate) fn product_radius(outer: f64, inner: f64) -> f64 {
    up(outer * (1.0 + inner) + inner + 10.0 * UNIT * (1.0 + outer) * (1.0 + inner))
}

/// Product of non-negative numbers, rounded up also where it underflows; zero times anything is zero.
pub(crate) fn times_up(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { up(a * b) + f64::MIN_POSITIVE }
}

/// |v|, rounded up.
pub(crate) fn length_up(v: DVec3) -> f64 {
    let largest = v.abs().max_element();
    // Squares of such numbers keep their digits; else √3 times the largest component.
    if (LEAST_SQUARED..=MOST_SQUARED).contains(&largest) {
        v.length() * UP
    } else {
        largest * ABOVE_ROOT_OF_THREE
    }
}
