//! Arguments of trigonometric functions minus the nearest multiple of π/2, to about 100 bits, at any size
//! (Payne and Hanek 1983, doi:10.1145/1057600.1057602): the slow path of `trig`.
use super::{
    Ends,
    constants::{FRAC_PI_2, INVERSE_FACTORIAL, TWO_OVER_PI},
    enclose,
};
use crate::Interval;
use d2m_lanes::{DoubleDouble, power_of_two};

/// `x = (4k + quadrant) π/2 + r` with |r| ≤ π/4 (and a little).
pub(super) struct Reduced {
    quadrant: i32,
    r: DoubleDouble,
}

/// Binary digits `start .. start + 64` of 2/π, counted from 1 = first digit after the point.
fn digits(start: i32) -> u64 {
    let word = |i: i32| usize::try_from(i).ok().and_then(|i| TWO_OVER_PI.get(i)).copied().unwrap_or(0);
    let from = start - 1;
    let (index, offset) = (from.div_euclid(64), from.rem_euclid(64));
    if offset == 0 { word(index) } else { word(index) << offset | word(index + 1) >> (64 - offset) }
}

/// Below, sin r and tan r are r to within a relative 10⁻²⁰⁰, and products of the series would underflow.
const LINEAR: f64 = 1e-100;

impl Reduced {
    /// `x` finite.
    pub(super) fn new(x: f64) -> Self {
        if x.abs() < 0.78 {
            return Self { quadrant: 0, r: DoubleDouble::from_f64(x) };
        }
        // |x| = mantissa · 2^exponent. Digits of 2/π with index below exponent − 1 give multiples of 4.
        let bits = x.abs().to_bits();
        let exponent = (bits >> 52) as i32 - 1075;
        let mantissa = bits & ((1 << 52) - 1) | 1 << 52;
        // 256 digits times the mantissa, modulo 2²⁵⁶: two bits of quadrant, 254 bits of fraction.
        let mut product = [0u64; 4];
        let mut carry = 0u128;
        for i in (0..4).rev() {
            let wide = u128::from(digits(exponent - 1 + 64 * i)) * u128::from(mantissa) + carry;
            product[i as usize] = wide as u64;
            carry = wide >> 64;
        }
        let mut quadrant = (product[0] >> 62) as i32;
        let mut fraction = [0u64; 4];
        for i in 0..4 {
            fraction[i] = product[i] << 2 | product.get(i + 1).map_or(0, |next| next >> 62);
        }
        let negative = fraction[0] >> 63 == 1;
        if negative {
            quadrant += 1;
            // 1 − fraction, short of one unit in place 254 … 256.
            fraction = fraction.map(|word| !word);
        }
        let zeros = fraction.iter().position(|&word| word != 0).unwrap_or(3);
        let word = |i: usize| fraction.get(i).copied().unwrap_or(0);
        // 128 significant bits from the first non-zero word on, shifted to the top.
        let shift = word(zeros).leading_zeros();
        let top = u128::from(word(zeros)) << 64 | u128::from(word(zeros + 1));
        let top = if shift == 0 { top } else { top << shift | u128::from(word(zeros + 2) >> (64 - shift)) };
        // Into two doubles: 53 bits each (the rest is below 2⁻¹⁰⁵ of the value).
        let high = (top >> 75) as u64;
        let low = (top >> 22) as u64 & ((1 << 53) - 1);
        let lead = -(64 * zeros as i32) - shift as i32;
        let value = DoubleDouble::from_sum(
            high as f64 * power_of_two(lead - 53),
            low as f64 * power_of_two(lead - 106),
        );
        let r = value * FRAC_PI_2;
        let (quadrant, r) = if negative { (quadrant, -r) } else { (quadrant, r) };
        if x < 0.0 { Self { quadrant: -quadrant & 3, r: -r } } else { Self { quadrant: quadrant & 3, r } }
    }

    /// Bit j is set when a multiple of π/2 that is ≡ j (mod 4) lies between; `x` goes from here to `end`, is
    /// not empty and narrower than 2π.
    pub(super) fn multiples_to(&self, end: &Self, x: Interval) -> u32 {
        let floor = |p: &Self| p.quadrant - i32::from(p.r.hi < 0.0);
        let mut count = (floor(end) - floor(self)) & 3;
        if count == 0 && x.hi() - x.lo() > 3.0 {
            count = 4;
        }
        let mut first = (floor(self) + 1) & 3;
        if self.r.hi == 0.0 {
            first = self.quadrant & 3;
            count = (count + 1).min(4);
        }
        let run = ((1u32 << count) - 1) << first;
        (run | run >> 4) & 15
    }

    /// Sine and cosine of `r`.
    fn kernel(&self) -> (DoubleDouble, DoubleDouble) {
        const SIN: [DoubleDouble; 12] = signed_factorials(1);
        const COS: [DoubleDouble; 12] = signed_factorials(0);
        let z = self.r.sqr();
        (self.r * DoubleDouble::polynomial(z, &SIN, 5), DoubleDouble::polynomial(z, &COS, 5))
    }

    fn sin_cos(&self) -> (DoubleDouble, DoubleDouble) {
        let (s, c) = self.kernel();
        match self.quadrant & 3 {
            0 => (s, c),
            1 => (c, -s),
            2 => (-s, -c),
            _ => (-c, s),
        }
    }

    pub(super) fn sin_value(&self) -> DoubleDouble {
        if self.r.hi.abs() < LINEAR && self.quadrant & 1 == 0 {
            return if self.quadrant == 0 { self.r } else { -self.r };
        }
        self.sin_cos().0
    }

    pub(super) fn sin(&self) -> Ends {
        if self.r.hi == 0.0 { (0.0, 0.0) } else { enclose(self.sin_value()) }
    }

    pub(super) fn cos(&self) -> Ends {
        if self.r.hi == 0.0 { (1.0, 1.0) } else { enclose(self.sin_cos().1) }
    }

    /// Not for x = 0.
    pub(super) fn tan(&self) -> DoubleDouble {
        if self.r.hi.abs() < LINEAR && self.quadrant & 1 == 0 {
            return self.r;
        }
        let (s, c) = self.sin_cos();
        s / c
    }
}

/// ±1/n! for n = start, start + 2, …
const fn signed_factorials(start: usize) -> [DoubleDouble; 12] {
    let mut out = [DoubleDouble::ZERO; 12];
    let mut i = 0;
    while i < 12 {
        let DoubleDouble { hi: a, lo: b } = INVERSE_FACTORIAL[start + 2 * i];
        out[i] = if i % 2 == 0 { DoubleDouble::new(a, b) } else { DoubleDouble::new(-a, -b) };
        i += 1;
    }
    out
}
