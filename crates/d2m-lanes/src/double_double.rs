//! Double-double arithmetic: a number as the unevaluated sum of two doubles.
//!
//! Relative errors per operation (Joldes, Muller, Popescu 2017, doi:10.1145/3121432): sum ≤ 3u²(1 + …),
//! product ≤ 7u², quotient ≤ 15u², u = 2⁻⁵³; all below 2⁻¹⁰¹, away from underflow and overflow. Magnitudes must stay below
//! 2⁹⁰⁰, so that no product overflows on the way. No fused multiply-add: the same bits everywhere.

use crate::fixed::sqrt;
use crate::{fast_two_sum, two_product, two_sum};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// The unevaluated sum `hi + lo` with |lo| ≤ ulp(hi)/2.
///
/// ```
/// use d2m_lanes::DoubleDouble;
/// let tenth = DoubleDouble::from_f64(1.0) / DoubleDouble::from_f64(10.0);
/// let rest = tenth * 10.0 - DoubleDouble::from_f64(1.0);
/// assert!(tenth.lo != 0.0 && rest.hi.abs() < 1e-31);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The nearest double.
    pub hi: f64,
    /// What it leaves.
    pub lo: f64,
}

impl DoubleDouble {
    /// 0.
    pub const ZERO: Self = Self::new(0.0, 0.0);
    /// 1.
    pub const ONE: Self = Self::new(1.0, 0.0);

    /// From both parts.
    #[inline(always)]
    pub const fn new(hi: f64, lo: f64) -> Self {
        Self { hi, lo }
    }

    /// A double.
    #[inline(always)]
    pub const fn from_f64(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// a + b, exactly.
    #[inline(always)]
    pub fn from_sum(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, b);
        Self { hi, lo }
    }

    /// a − b, exactly.
    #[inline(always)]
    pub fn from_difference(a: f64, b: f64) -> Self {
        Self::from_sum(a, -b)
    }

    /// a·b, exactly.
    #[inline(always)]
    pub fn from_product(a: f64, b: f64) -> Self {
        let (hi, lo) = two_product(a, b);
        Self { hi, lo }
    }

    /// The sum, in fewer operations: its error is below 2⁻¹⁰⁰ of the sum of the magnitudes, not of the result.
    #[inline(always)]
    pub fn add_sloppily(self, other: Self) -> Self {
        let s = Self::from_sum(self.hi, other.hi);
        Self::from_sum(s.hi, s.lo + (self.lo + other.lo))
    }

    /// Plus a double.
    #[inline]
    pub fn add_f64(self, other: f64) -> Self {
        self + Self::from_f64(other)
    }

    /// The square.
    #[inline]
    pub fn sqr(self) -> Self {
        self * self
    }

    /// Times a power of two.
    #[inline]
    pub fn scaled(self, power_of_two: f64) -> Self {
        Self { hi: self.hi * power_of_two, lo: self.lo * power_of_two }
    }

    /// The quotient in three steps: its error is that of a sum.
    pub fn div_accurately(self, other: Self) -> Self {
        let q1 = self.hi / other.hi;
        let rest = self - other * q1;
        let q2 = rest.hi / other.hi;
        let rest = rest - other * q2;
        let (hi, lo) = fast_two_sum(q1, q2);
        Self { hi, lo }.add_f64(rest.hi / other.hi)
    }

    /// The square root; zero for what is not positive.
    pub fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        let root = sqrt(self.hi);
        let rest = self - Self::from_product(root, root);
        let (hi, lo) = fast_two_sum(root, rest.hi / (2.0 * root));
        Self { hi, lo }
    }

    /// Σ coefficient_i · x^i for the first `exact` coefficients in double-double arithmetic, the rest, which must
    /// not matter beyond a double's precision, in doubles.
    pub fn polynomial(x: Self, coefficients: &[Self], exact: usize) -> Self {
        let (head, tail) = coefficients.split_at(exact);
        let mut rest = 0.0;
        for c in tail.iter().rev() {
            rest = rest * x.hi + c.hi;
        }
        let mut value = Self::from_f64(rest);
        for c in head.iter().rev() {
            value = value * x + *c;
        }
        value
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.hi, other.hi);
        let (t, f) = two_sum(self.lo, other.lo);
        let (s, e) = fast_two_sum(s, e + t);
        let (hi, lo) = fast_two_sum(s, e + f);
        Self { hi, lo }
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: Self) -> Self {
        let (p, e) = two_product(self.hi, other.hi);
        let (hi, lo) = fast_two_sum(p, e + (self.hi * other.lo + self.lo * other.hi));
        Self { hi, lo }
    }
}

impl Mul<f64> for DoubleDouble {
    type Output = Self;
    #[inline]
    fn mul(self, other: f64) -> Self {
        let (p, e) = two_product(self.hi, other);
        let (hi, lo) = fast_two_sum(p, e + self.lo * other);
        Self { hi, lo }
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline]
    fn div(self, other: Self) -> Self {
        let q = self.hi / other.hi;
        // The rest self − q·other, to first order, gives the correction.
        let (p, e) = two_product(q, other.hi);
        let rest = ((self.hi - p) - e) + (self.lo - q * other.lo);
        let (hi, lo) = fast_two_sum(q, rest / other.hi);
        Self { hi, lo }
    }
}
