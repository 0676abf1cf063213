//! `sin x / x` and `(1 − cos x)/x²`, continued at 0: Rodrigues' formula without a division by the angle.
use super::{Ends, enclose, reduce::Reduced};
use crate::Interval;
use d2m_lanes::DoubleDouble;

/// Below, `sinc` falls: its derivative vanishes first at 4.493….
const SINC_FALLS: f64 = 4.49;
/// The least value of `sinc` on the line is −0.217 233 628 211 22….
const SINC_LEAST: f64 = -0.217_233_628_211_23;

/// Behind `SINC_FALLS` `sinc` is at most its next maximum, 0.128 374 553 525 9… at 7.725….
const SINC_LATER: f64 = 0.128_5;
/// Below, (1 − cos x)/x² falls: from ½ at 0 to 0 at 2π = 6.283….
const VERSINE_RATIO_FALLS: f64 = 6.25;
/// Behind `VERSINE_RATIO_FALLS` it is at most ½·0.217 233 628 211 22…² = 0.023 595 224 61….
const VERSINE_RATIO_LATER: f64 = 0.0236;
/// Below, both functions are next to their value at 0: x²/6 < 2⁻²⁰⁰.
const FLAT: f64 = 1e-30;
/// Up to here a single number is evaluated as such, with its own reduction; the general formula serves beyond.
const LARGEST_POINT: f64 = 1e15;

fn sinc_at(x: f64) -> Ends {
    if x == 0.0 {
        return (1.0, 1.0);
    }
    if x < FLAT {
        return (1.0_f64.next_down(), 1.0);
    }
    let (lo, hi) = enclose(Reduced::new(x).sin_value() / DoubleDouble::from_f64(x));
    (lo, if hi > 1.0 { 1.0 } else { hi })
}

/// `2 (sin(x/2)/x)²`.
fn versine_ratio_at(x: f64) -> Ends {
    if x == 0.0 {
        return (0.5, 0.5);
    }
    if x < FLAT {
        return (0.5_f64.next_down(), 0.5);
    }
    let ratio = Reduced::new(0.5 * x).sin_value() / DoubleDouble::from_f64(x);
    let (lo, hi) = enclose(ratio.sqr().scaled(2.0));
    (if lo < 0.0 { 0.0 } else { lo }, if hi > 0.5 { 0.5 } else { hi })
}

impl Interval {
    /// `sin x / x`, continued by 1 at 0.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let s = Interval::new(0.0, 1.0).sinc();
    /// assert!(s.hi() == 1.0 && s.contains(1.0_f64.sin()) && s.lo() > 0.841);
    /// ```
    pub fn sinc(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let x = self.abs();
        if x.hi() <= SINC_FALLS {
            return Self::raw(sinc_at(x.hi()).0, sinc_at(x.lo()).1);
        }
        let range = Self::raw(SINC_LEAST, 1.0);
        if x.is_singleton() && x.hi() < LARGEST_POINT {
            let (lo, hi) = sinc_at(x.hi());
            return Self::raw(lo, hi);
        }
        if x.lo() <= SINC_FALLS {
            // Down to the least value, and later up again.
            let at_start = sinc_at(x.lo()).1;
            return Self::raw(SINC_LEAST, if at_start > SINC_LATER { at_start } else { SINC_LATER });
        }
        (x.sin() / x).intersection(range)
    }

    /// `(1 − cos x)/x²`, continued by ½ at 0.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let v = Interval::new(-1e-9, 1.0).versine_ratio();
    /// assert!(v.hi() == 0.5 && v.contains(1.0 - 1.0_f64.cos()) && v.lo() > 0.459);
    /// ```
    pub fn versine_ratio(self) -> Self {
        if self.is_empty() {
            return self;
        }
        let x = self.abs();
        if x.hi() <= VERSINE_RATIO_FALLS {
            return Self::raw(versine_ratio_at(x.hi()).0, versine_ratio_at(x.lo()).1);
        }
        if x.is_singleton() && x.hi() < LARGEST_POINT {
            let (lo, hi) = versine_ratio_at(x.hi());
            return Self::raw(lo, hi);
        }
        if x.lo() <= VERSINE_RATIO_FALLS {
            // Down to zero, and later up again.
            let at_start = versine_ratio_at(x.lo()).1;
            return Self::raw(
                0.0,
                if at_start > VERSINE_RATIO_LATER { at_start } else { VERSINE_RATIO_LATER },
            );
        }
        let half = x * 0.5;
        ((half.sin() / half).sqr() * 0.5).intersection(Self::raw(0.0, VERSINE_RATIO_LATER))
    }
}
