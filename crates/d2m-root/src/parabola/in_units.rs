//! A parabola in units in which its discriminant neither over- nor underflows.
use super::Parabola;
use d2m_interval::Interval;
use d2m_lanes::{Binary, power_of_two, scaled};

/// Sizes of coefficients that need no other units, 2^±150: the discriminant lies within 2^±303, far above the 2⁻⁵⁰⁰ that
/// interval arithmetic may add to it.
const ORDINARY: core::ops::Range<f64> = power_of_two(-150)..power_of_two(151);
/// Coefficients below 2⁻⁹⁰⁰ in these units are enclosed from zero on: their mantissa would leave the normal numbers.
const NEGLIGIBLE: i32 = -900;

/// `p(2ᵗ·y)/2ᵉ`, exactly but for negligible coefficients.
#[derive(Debug, Clone, Copy)]
pub(super) struct InUnits {
    pub(super) value: Interval,
    pub(super) slope: Interval,
    pub(super) curvature: Interval,
    /// t: an offset y is x = 2ᵗ·y.
    time: i32,
}

impl InUnits {
    /// With the value in [1, 2) and the larger of slope and √curvature about 1; those of the caller if the numbers are
    /// ordinary (or not finite: then nothing is known).
    #[inline(always)]
    pub(super) fn of(p: Parabola) -> Self {
        let is_ordinary = |x: f64| x == 0.0 || ORDINARY.contains(&x.abs());
        if is_ordinary(p.value) && is_ordinary(p.slope) && is_ordinary(p.curvature) {
            Self::of_caller(p)
        } else {
            Self::of_extremes(p)
        }
    }

    #[inline(always)]
    fn of_caller(p: Parabola) -> Self {
        let (value, slope) = (Interval::point(p.value), Interval::point(p.slope));
        Self { value, slope, curvature: Interval::point(p.curvature), time: 0 }
    }

    #[cold]
    fn of_extremes(p: Parabola) -> Self {
        if !(p.value.is_finite() && p.slope.is_finite() && p.curvature.is_finite()) {
            return Self::of_caller(p);
        }
        let (value, slope, curvature) =
            (Binary::from_f64(p.value), Binary::from_f64(p.slope), Binary::from_f64(p.curvature));
        let by_slope = value.exponent - slope.exponent;
        let by_curvature = (value.exponent - curvature.exponent).div_euclid(2);
        let (time, unit) = match (value.is_zero(), slope.is_zero(), curvature.is_zero()) {
            (false, false, false) => (by_slope.min(by_curvature), value.exponent),
            (false, false, true) => (by_slope, value.exponent),
            (false, true, false) => (by_curvature, value.exponent),
            (true, false, false) => {
                let time = slope.exponent - curvature.exponent;
                (time, slope.exponent + time)
            }
            // One coefficient alone: its own size.
            (false, true, true) => (0, value.exponent),
            (true, false, true) => (0, slope.exponent),
            (true, true, _) => (0, curvature.exponent),
        };
        Self {
            value: enclosed(value, -unit),
            slope: enclosed(slope, time - unit),
            curvature: enclosed(curvature, 2 * time - unit),
            time,
        }
    }

    /// Enclosure of the discriminant p′(0)² − 2·p″·p(0).
    ///
    /// Formed in interval arithmetic, so cancellation widens it and never falsifies it.
    #[inline(always)]
    pub(super) fn discriminant(&self) -> Interval {
        self.slope.sqr() - self.curvature * self.value * 2.0
    }

    /// Offsets y ≥ 0 of these units in the caller's, rounded outward.
    #[inline(always)]
    pub(super) fn offset(&self, y: Interval) -> Interval {
        if self.time == 0 { y } else { self.offset_in_other_units(y) }
    }

    #[cold]
    fn offset_in_other_units(&self, y: Interval) -> Interval {
        let (lo, hi) = (scaled(y.lo(), self.time), scaled(y.hi(), self.time));
        let lo = if lo < 2.0 * f64::MIN_POSITIVE && lo > 0.0 { lo.next_down() } else { lo.min(f64::MAX) };
        let hi = if hi < 2.0 * f64::MIN_POSITIVE && y.hi() > 0.0 { hi.next_up() } else { hi };
        Interval::new(lo, hi)
    }
}

/// `x·2ⁿ`, which is below 4.
fn enclosed(x: Binary, n: i32) -> Interval {
    let exponent = x.exponent + n;
    if x.is_zero() {
        Interval::point(0.0)
    } else if exponent >= NEGLIGIBLE {
        Interval::point(x.mantissa * power_of_two(exponent))
    } else if x.mantissa > 0.0 {
        Interval::new(0.0, power_of_two(NEGLIGIBLE))
    } else {
        Interval::new(-power_of_two(NEGLIGIBLE), 0.0)
    }
}
