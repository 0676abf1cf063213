//! Double-double arithmetic: a number as the unevaluated sum of two doubles, |low| ≤ ulp(high)/2.
//!
//! Relative errors per operation (Joldes, Muller, Popescu 2017, doi:10.1145/3121432): sum ≤ 3u²(1 + …),
//! product ≤ 7u², quotient ≤ 15u², u = 2⁻⁵³; all below 2⁻¹⁰¹, away from underflow and overflow.
use crate::{
    round::{fast_two_sum, two_product, two_sum},
    simd::sqrt,
};

/// `self.0 + self.1`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dd(pub(super) f64, pub(super) f64);

impl Dd {
    pub(super) const ONE: Self = Self(1.0, 0.0);

    #[inline]
    pub(super) fn sum(a: f64, b: f64) -> Self {
        let (s, e) = two_sum(a, b);
        Self(s, e)
    }

    #[inline]
    pub(super) fn product(a: f64, b: f64) -> Self {
        let (p, e) = two_product(a, b);
        Self(p, e)
    }

    #[inline]
    pub(super) fn plus(self, o: Self) -> Self {
        let (s, e) = two_sum(self.0, o.0);
        let (t, f) = two_sum(self.1, o.1);
        let (s, e) = fast_two_sum(s, e + t);
        let (s, e) = fast_two_sum(s, e + f);
        Self(s, e)
    }

    #[inline]
    pub(super) fn neg(self) -> Self {
        Self(-self.0, -self.1)
    }

    #[inline]
    pub(super) fn minus(self, o: Self) -> Self {
        self.plus(o.neg())
    }

    #[inline]
    pub(super) fn times(self, o: Self) -> Self {
        let (p, e) = two_product(self.0, o.0);
        let (p, e) = fast_two_sum(p, e + (self.0 * o.1 + self.1 * o.0));
        Self(p, e)
    }

    #[inline]
    pub(super) fn sqr(self) -> Self {
        self.times(self)
    }

    /// Times a power of two.
    #[inline]
    pub(super) fn scaled(self, power_of_two: f64) -> Self {
        Self(self.0 * power_of_two, self.1 * power_of_two)
    }

    #[inline]
    pub(super) fn over(self, o: Self) -> Self {
        let q = self.0 / o.0;
        // The rest self − q·o, to first order, gives the correction.
        let (p, e) = two_product(q, o.0);
        let rest = ((self.0 - p) - e) + (self.1 - q * o.1);
        let (q, e) = fast_two_sum(q, rest / o.0);
        Self(q, e)
    }

    /// For a positive number.
    #[inline]
    pub(super) fn sqrt(self) -> Self {
        let s = sqrt(self.0);
        let (p, e) = two_product(s, s);
        let rest = ((self.0 - p) - e) + self.1;
        let (s, e) = fast_two_sum(s, rest / (2.0 * s));
        Self(s, e)
    }

    /// Σ coefficient_i · x^i for the first `exact` coefficients in double-double arithmetic, the rest, which must
    /// not matter beyond a double's precision, in doubles.
    pub(super) fn polynomial(x: Self, coefficients: &[Self], exact: usize) -> Self {
        let (head, tail) = coefficients.split_at(exact);
        let mut rest = 0.0;
        for c in tail.iter().rev() {
            rest = rest * x.0 + c.0;
        }
        let mut value = Self(rest, 0.0);
        for c in head.iter().rev() {
            value = value.times(x).plus(*c);
        }
        value
    }
}
