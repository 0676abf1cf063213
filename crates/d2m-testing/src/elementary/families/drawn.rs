//! What the families draw.

use crate::Random;
use d2m_interval::Interval;

/// What the families draw besides numbers of the unit interval.
impl Random {
    /// A double whose magnitude has an exponent in `exponents`, either sign.
    pub(crate) fn double(&mut self, exponents: (i32, i32)) -> f64 {
        let span = (exponents.1 - exponents.0 + 1) as u64;
        let field = 1023 + exponents.0 + self.below(span) as i32;
        // Few mantissa bits now and then: ties and exact results.
        let mask = if self.below(4) == 0 { !0 << 44 } else { !0 };
        let bits = (self.bits() >> 12 & mask) | (field as u64) << 52;
        let x = f64::from_bits(bits);
        if self.below(2) == 0 { x } else { -x }
    }

    /// An interval: a point, a few last places wide, relatively narrow, or anything.
    pub(crate) fn interval(&mut self, domain: Domain) -> Interval {
        let mut end = || loop {
            let x = self.double(domain.exponents);
            if x >= domain.lo && x <= domain.hi {
                return x;
            }
        };
        let (x, other) = (end(), end());
        let y = match self.below(4) {
            0 => x,
            1 => f64::from_bits(x.to_bits() + self.below(9)),
            2 => x * (1.0 + (0.5_f64).powi(self.below(50) as i32)),
            _ => other,
        }
        .clamp(domain.lo, domain.hi);
        Interval::new(x.min(y), x.max(y))
    }

    pub(super) fn inside(&mut self, x: Interval) -> f64 {
        let share = self.below(1 << 20) as f64 / f64::from(1 << 20);
        (x.lo() + share * (x.hi() - x.lo())).clamp(x.lo(), x.hi())
    }
}

/// Where arguments are drawn from.
#[derive(Clone, Copy)]
pub struct Domain {
    /// Least argument.
    pub lo: f64,
    /// Greatest argument.
    pub hi: f64,
    /// Least and greatest exponent of their magnitudes.
    pub exponents: (i32, i32),
}

pub(super) const fn domain(lo: f64, hi: f64, from: i32, to: i32) -> Domain {
    Domain { lo, hi, exponents: (from, to) }
}
