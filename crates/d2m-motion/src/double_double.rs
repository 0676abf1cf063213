//! Double-double arithmetic without fused multiply-add, for poses at an epoch and for far reference points.
//!
//! Dekker's and Knuth's error-free transformations; every operation is relative-accurate to about 2⁻¹⁰², which is
//! far below what its users need (they round the result once to a double). Magnitudes must stay below 2⁹⁰⁰ so that
//! the split does not overflow.

/// An unevaluated sum `hi + lo` with |lo| ≤ ulp(hi)/2.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct DoubleDouble {
    pub(crate) hi: f64,
    pub(crate) lo: f64,
}

#[inline(always)]
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    let t = s - a;
    (s, (a - (s - t)) + (b - t))
}

#[inline(always)]
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let s = a + b;
    (s, b - (s - a))
}

#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    let t = 134_217_729.0 * a; // 2²⁷ + 1
    let hi = t - (t - a);
    (hi, a - hi)
}

#[inline(always)]
pub(crate) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let p = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl DoubleDouble {
    pub(crate) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    pub(crate) const ONE: Self = Self { hi: 1.0, lo: 0.0 };
    /// π/2 to 2⁻¹⁰⁷.
    const HALF_PI: Self = Self { hi: core::f64::consts::FRAC_PI_2, lo: 6.123_233_995_736_766e-17 };
    /// What [`Self::HALF_PI`] leaves out.
    const HALF_PI_TAIL: f64 = -1.497_384_904_859_17e-33;

    pub(crate) const fn from_f64(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }

    /// a − b, exact.
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let (hi, lo) = two_sum(a, -b);
        Self { hi, lo }
    }

    pub(crate) fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.hi, other.hi);
        let (t, f) = two_sum(self.lo, other.lo);
        let (s, e) = quick_two_sum(s, e + t);
        let (hi, lo) = quick_two_sum(s, e + f);
        Self { hi, lo }
    }

    pub(crate) fn neg(self) -> Self {
        Self { hi: -self.hi, lo: -self.lo }
    }

    pub(crate) fn sub(self, other: Self) -> Self {
        self.add(other.neg())
    }

    pub(crate) fn add_f64(self, other: f64) -> Self {
        self.add(Self::from_f64(other))
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        let (p, e) = two_product(self.hi, other.hi);
        let (hi, lo) = quick_two_sum(p, e + (self.hi * other.lo + self.lo * other.hi));
        Self { hi, lo }
    }

    pub(crate) fn mul_f64(self, other: f64) -> Self {
        let (p, e) = two_product(self.hi, other);
        let (hi, lo) = quick_two_sum(p, e + self.lo * other);
        Self { hi, lo }
    }

    pub(crate) fn div(self, other: Self) -> Self {
        let q1 = self.hi / other.hi;
        let r = self.sub(other.mul_f64(q1));
        let q2 = r.hi / other.hi;
        let r = r.sub(other.mul_f64(q2));
        let (hi, lo) = quick_two_sum(q1, q2);
        Self { hi, lo }.add_f64(r.hi / other.hi)
    }

    pub(crate) fn sqrt(self) -> Self {
        if self.hi <= 0.0 {
            return Self::ZERO;
        }
        let root = self.hi.sqrt();
        let (square, error) = two_product(root, root);
        let rest = self.sub(Self { hi: square, lo: error });
        let (hi, lo) = quick_two_sum(root, rest.hi / (2.0 * root));
        Self { hi, lo }
    }

    /// Sine and cosine: reduction by multiples of π/2 (2⁻¹⁶⁰ left out), then 27 Taylor terms in double-double.
    /// Absolute error below 2⁻⁹⁸ + |x|·2⁻¹⁰⁵ for |x| < 2³⁰.
    pub(crate) fn sin_cos(self) -> (Self, Self) {
        let turns = (self.hi / Self::HALF_PI.hi).round();
        let r = self.sub(Self::HALF_PI.mul_f64(turns)).add_f64(-turns * Self::HALF_PI_TAIL);
        let square = r.mul(r).neg();
        let (mut sin, mut cos) = (r, Self::ONE);
        let (mut odd, mut even) = (r, Self::ONE);
        let mut k = 1.0;
        while k < 28.0 {
            even = even.mul(square).div(Self::from_f64(k * (k + 1.0)));
            odd = odd.mul(square).div(Self::from_f64((k + 1.0) * (k + 2.0)));
            cos = cos.add(even);
            sin = sin.add(odd);
            k += 2.0;
        }
        match turns.rem_euclid(4.0) as u8 {
            0 => (sin, cos),
            1 => (cos, sin.neg()),
            2 => (sin.neg(), cos.neg()),
            _ => (cos.neg(), sin),
        }
    }
}
