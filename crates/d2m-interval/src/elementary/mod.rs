//! Elementary functions, with this crate's own kernels: the same bits on every platform.
//!
//! `trig` holds the fast sine and cosine (two doubles of a vector at once, proven padding); everything else
//! evaluates in double-double arithmetic, to about 2⁻⁷⁰, and is then rounded outwards, mostly to the
//! tightest enclosure. Bounds are derived in `docs/theory/interval.md`.
mod constants;
mod exp_log;
mod hyperbolic;
mod inverse_trig;
mod power;
mod reduce;
mod rounding_functions;
mod sinc;
mod trig;
mod trig_x4;

use crate::Interval;
use d2m_lanes::{DoubleDouble, power_of_two};

/// Enclosure of one number, as (lower, upper) end.
type Ends = (f64, f64);

/// Doubles around a number that lies within a relative `2⁻⁶²` of `x`.
#[inline]
fn enclose(x: DoubleDouble) -> Ends {
    enclose_within(x, power_of_two(-62))
}

/// Above, the low part of a double-double has not underflowed: it is a multiple of 2⁻¹⁰⁶ of the high part at least.
const WITH_LOW_PART: f64 = 1e-250;

/// Doubles around a number that lies within a relative `error` (at most 2⁻⁵⁸) of `x`.
fn enclose_within(x: DoubleDouble, error: f64) -> Ends {
    let DoubleDouble { hi: high, lo: low } = x;
    if high.is_nan() {
        return (f64::NEG_INFINITY, f64::INFINITY);
    }
    let doubt = high.abs() * error;
    // Far from underflow, the sign of the low part shows on which side of `high` the number is.
    let clear = high.abs() > WITH_LOW_PART;
    (
        if clear && low > doubt { high } else { high.next_down() },
        if clear && low < -doubt { high } else { high.next_up() },
    )
}

/// An odd function from its values at positive numbers.
fn odd(x: f64, at: impl Fn(f64) -> Ends) -> Ends {
    if x == 0.0 {
        (0.0, 0.0)
    } else if x < 0.0 {
        let (lo, hi) = at(-x);
        (-hi, -lo)
    } else {
        at(x)
    }
}

/// A function that grows, evaluated at both ends; `at` encloses its value at a finite number.
#[inline]
fn increasing(x: Interval, at: impl Fn(f64) -> Ends, at_minus_infinity: f64, at_infinity: f64) -> Interval {
    if x.is_empty() {
        return x;
    }
    let lo = if x.lo() == f64::NEG_INFINITY { at_minus_infinity } else { at(x.lo()).0 };
    let hi = if x.hi() == f64::INFINITY { at_infinity } else { at(x.hi()).1 };
    Interval::from_ends(lo, hi)
}
