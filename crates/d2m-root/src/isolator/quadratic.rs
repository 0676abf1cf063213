//! A quadratic in time, and the first time at which it can enter a band.
//!
//! **Invariant:** the coefficients are taken as they are, exactly; every rounding made here is counted here. The proofs
//! of the constants are in `docs/theory/isolator.md`.
use super::first_zero_bound::{USUAL_GAPS, bound_first_zero, bound_scaled};
use super::piece::Piece;
use super::time_unit::TimeUnit;
use d2m_lanes::UNIT;
use d2m_lanes::power_of_two;

/// Error of what [`Quadratic::clip`] and [`Quadratic::bound_below`] compute, in parts of
/// |value| + |slope|·h + |curvature|·h² for times up to h: the value at an end (1, 3, 2 in these terms), the slope there
/// over the width of the piece (0, 2, 4), the band (2, 2, 2), times that are rounded by 3·2⁻⁵³·h (0, 3, 3); and the
/// rounding of this bound itself.
const EVALUATION: f64 = 12.0 * UNIT;

/// 2²⁰: up to this time, `UNDERFLOW` covers every product that underflows. Beyond it another unit of time is taken.
pub(super) const LONGEST_REACH: f64 = power_of_two(20);

/// 2⁻¹⁰⁰⁰: at most 32 products, each off by at most 2⁻¹⁰⁷⁵ when it underflows, and then multiplied by at most the cube
/// of [`LONGEST_REACH`]: below 2⁻¹⁰¹⁰.
pub(super) const UNDERFLOW: f64 = power_of_two(-1000);

/// Keeps the sagitta above its exact value: more than its four roundings and twice that of the width.
const SAGITTA: f64 = 1.0 + 8.0 * UNIT;

/// The hypotheses of [`Quadratic::clip_beyond`] and of the cubics' on what is allowed, where evaluations err by at most `error`. Where
/// everything is zero nothing underflows; what overflows or is not a number cuts nothing.
pub(super) fn covers(allowed: f64, error: f64, part: Piece) -> bool {
    let covered = allowed + UNDERFLOW >= error || allowed.is_nan();
    !error.is_finite() || (part.is_within(LONGEST_REACH) && covered)
}

/// `value + slope·s + curvature·s²/2`.
///
/// ```
/// use d2m_root::Quadratic;
/// let fall = Quadratic { value: 5.0, slope: 0.0, curvature: -10.0 }; // 5 − 5 s²
/// assert_eq!((fall.at(0.5), fall.slope_at(0.5)), (3.75, -5.0));
/// assert!(Quadratic::bound_first_zero(5.0, 0.0, -10.0) <= 1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadratic {
    /// At s = 0.
    pub value: f64,
    /// First derivative at s = 0.
    pub slope: f64,
    /// Second derivative.
    pub curvature: f64,
}

/// The values that count as contact: `[lo, hi]`.
///
/// ```
/// use d2m_root::{Band, Piece, Quadratic};
/// // 2 − 3s is in [−0.5, 0.5] from 0.5 on.
/// let line = Quadratic { value: 2.0, slope: -3.0, curvature: 0.0 };
/// let part = line.clip(Band { lo: -0.5, hi: 0.5 }, Piece { lo: 0.0, hi: 1.0 }).expect("it comes in");
/// assert!(part.lo <= 0.5 && part.lo > 0.499);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

impl Band {
    /// With as much more on either side.
    #[inline(always)]
    pub(super) fn padded(self, by: f64) -> Self {
        Self { lo: self.lo - by, hi: self.hi + by }
    }

    /// How long a quadratic that starts with these numbers is certainly outside of the band; 0 if it starts inside.
    #[inline(always)]
    pub(super) fn bound_entry(self, value: f64, slope: f64, curvature: f64) -> f64 {
        if value > self.hi {
            bound_first_zero(value - self.hi, slope, curvature)
        } else if value < self.lo {
            bound_first_zero(self.lo - value, -slope, -curvature)
        } else {
            0.0
        }
    }
}

impl Quadratic {
    /// The value at `s`, plain floating point: relative to `|value| + |slope·s| + |curvature·s²|` the error is
    /// below 4·2⁻⁵³.
    #[inline(always)]
    pub fn at(&self, s: f64) -> f64 {
        self.value + (self.slope + 0.5 * self.curvature * s) * s
    }

    /// The slope at `s`.
    #[inline(always)]
    pub fn slope_at(&self, s: f64) -> f64 {
        self.slope + self.curvature * s
    }

    /// With the time counted from `s`, up to the rounding of value and slope.
    #[inline(always)]
    fn from(&self, s: f64) -> Self {
        Self { value: self.at(s), slope: self.slope_at(s), curvature: self.curvature }
    }

    /// The same with the time counted backwards.
    #[inline(always)]
    fn back_from(&self, s: f64) -> Self {
        Self { value: self.at(s), slope: -self.slope_at(s), curvature: self.curvature }
    }

    /// A time σ ≥ 0 such that `gap + slope·x + curvature·x²/2 > 0` for all 0 ≤ x ≤ σ, given `gap > 0`: the first
    /// positive zero, rounded down; infinite if there is none.
    ///
    /// It holds for every finite argument, subnormal and huge ones too, and also if `gap` is up to 4·2⁻⁵³ of itself too
    /// large. What is not finite, and a gap that is not positive, give 0: nothing is known.
    ///
    /// `2·gap/(√disc − slope)` for a falling start, `(slope + √disc)/(−curvature)` for a rising one: only sums of
    /// non-negative numbers, except in the discriminant of a falling start that levels out, which is inflated by
    /// more than its error.
    ///
    /// ```
    /// use d2m_root::Quadratic;
    /// let root = Quadratic::bound_first_zero(2.0, -3.0, 2.0); // 2 − 3x + x² = (x − 1)(x − 2)
    /// assert!(root <= 1.0 && root > 1.0 - 1e-14);
    /// assert_eq!(Quadratic::bound_first_zero(1.0, -1.0, 2.0), f64::INFINITY);
    /// let early = Quadratic::bound_first_zero(1e120, 1.0, -1e200); // slope² and gap·curvature are far apart
    /// assert!(early < 1.4143e-40 && early > 1.4142e-40);
    /// ```
    #[inline(always)]
    pub fn bound_first_zero(gap: f64, slope: f64, curvature: f64) -> f64 {
        // Infinite coefficients come from an overflow, and mean nothing. (−∞ makes the discriminant infinite or no number.)
        let usual =
            gap > USUAL_GAPS.0 && gap < USUAL_GAPS.1 && slope < f64::INFINITY && curvature < f64::INFINITY;
        if usual { bound_first_zero(gap, slope, curvature) } else { bound_scaled(gap, slope, curvature) }
    }

    /// Bounds the rounding of everything that is computed on a piece up to the time `h` ≤ 2²⁰: 12·2⁻⁵³ of
    /// |value| + |slope|·h + |curvature|·h², and 2⁻¹⁰⁰⁰ for what underflows. Infinite, or NaN, if anything overflows there:
    /// no sum of the evaluation has larger terms.
    ///
    /// ```
    /// let arch = d2m_root::Quadratic { value: 1.0, slope: 0.0, curvature: 2.0 };
    /// assert!(arch.bound_evaluation(2.0) > 53.0 * f64::EPSILON && arch.bound_evaluation(2.0) < 2e-14);
    /// ```
    #[inline(always)]
    pub fn bound_evaluation(&self, h: f64) -> f64 {
        EVALUATION * (self.value.abs() + (self.slope.abs() + self.curvature.abs() * h) * h) + UNDERFLOW
    }

    /// Cuts off both ends of `part` (times relative to s = 0) where the quadratic is certainly outside the band;
    /// `None` if that is all of it.
    ///
    /// The coefficients count as exact: the caller's band includes their error, and nothing else. Ends are cut to
    /// doubles that are certain; an end from which nothing can be cut stays as it is, and a quadratic or a piece that is
    /// not finite loses nothing. Values within 2⁻¹⁰⁰⁰ of the band are not distinguished from it.
    ///
    /// ```
    /// use d2m_root::{Band, Piece, Quadratic};
    /// let falling = Quadratic { value: 1.0, slope: -1.0, curvature: 0.0 };
    /// let (zero, part) = (Band { lo: 0.0, hi: 0.0 }, Piece { lo: 0.0, hi: 2.0 });
    /// let kept = falling.clip(zero, part).unwrap();
    /// assert!(kept.lo <= 1.0 && kept.hi >= 1.0 && kept.width() < 1e-13);
    /// assert!(falling.clip(zero, Piece { lo: 1.5, hi: 2.0 }).is_none());
    /// ```
    #[inline(always)]
    pub fn clip(&self, band: Band, part: Piece) -> Option<Piece> {
        if part.is_within(LONGEST_REACH) {
            self.clip_beyond(band, self.bound_evaluation(part.reach()), part)
        } else {
            self.clip_far(band, part)
        }
    }

    #[cold]
    #[inline(never)]
    fn clip_far(&self, band: Band, part: Piece) -> Option<Piece> {
        let Some(unit) = TimeUnit::of(part) else { return Some(part) };
        let kept = self.in_unit(unit).clip(band, unit.piece(part))?;
        Some(unit.restored(kept, part))
    }

    /// [`Quadratic::clip`] for callers that know a bound of all errors: cuts where the quadratic is more than `allowed`
    /// outside the band.
    ///
    /// Hypotheses, which debug builds check: `allowed` is at least [`Quadratic::bound_evaluation`] of the piece's largest
    /// |s| (besides the error of the coefficients, where they have one), and that is at most 2²⁰.
    ///
    /// ```
    /// use d2m_root::{Band, Piece, Quadratic};
    /// let falling = Quadratic { value: 1.0, slope: -1.0, curvature: 0.0 };
    /// let (zero, part) = (Band { lo: 0.0, hi: 0.0 }, Piece { lo: 0.0, hi: 2.0 });
    /// let kept = falling.clip_beyond(zero, 0.125, part).unwrap();
    /// assert!(kept.lo <= 0.875 && kept.hi >= 1.125 && kept.width() < 0.25 + 1e-13);
    /// ```
    #[inline(always)]
    pub fn clip_beyond(&self, band: Band, allowed: f64, part: Piece) -> Option<Piece> {
        debug_assert!(covers(allowed, self.bound_evaluation(part.reach()), part));
        let Piece { lo, hi } = part;
        let band = band.padded(allowed);
        let width = hi - lo;
        let advance = band.bound_entry(self.at(lo), self.slope_at(lo), self.curvature);
        if advance > width {
            return None;
        }
        let retreat = band.bound_entry(self.at(hi), -self.slope_at(hi), self.curvature);
        if retreat > width {
            return None;
        }
        part.shortened(advance, retreat)
    }

    /// Cuts off both ends of `part` where two quadratics certainly share a sign: `self` and `other` both above
    /// `margin` or both below `−margin`. `None` if that is all of it. `margin` is for the error of the coefficients; all
    /// else is as with [`Quadratic::clip`].
    ///
    /// ```
    /// use d2m_root::{Piece, Quadratic};
    /// let (f, g) = (Quadratic { value: -1.0, slope: 1.0, curvature: 0.0 },
    ///               Quadratic { value: -3.0, slope: 1.0, curvature: 0.0 });
    /// let kept = f.clip_shared_sign(&g, 0.0, Piece { lo: 0.0, hi: 4.0 }).unwrap(); // signs differ on [1, 3]
    /// assert!(kept.lo <= 1.0 && kept.hi >= 3.0 && kept.width() < 2.0 + 1e-13);
    /// ```
    #[inline(always)]
    pub fn clip_shared_sign(&self, other: &Self, margin: f64, part: Piece) -> Option<Piece> {
        if part.is_within(LONGEST_REACH) {
            let h = part.reach();
            let (mine, others) = (self.bound_evaluation(h), other.bound_evaluation(h));
            self.clip_shared_sign_beyond(other, margin + if mine > others { mine } else { others }, part)
        } else {
            self.clip_shared_sign_far(other, margin, part)
        }
    }

    /// [`Quadratic::clip_shared_sign`] where both quadratics are more than `allowed` on the same side of zero, under the
    /// hypotheses of [`Quadratic::clip_beyond`].
    ///
    /// ```
    /// use d2m_root::{Piece, Quadratic};
    /// let (f, g) = (Quadratic { value: -1.0, slope: 1.0, curvature: 0.0 },
    ///               Quadratic { value: -3.0, slope: 1.0, curvature: 0.0 });
    /// let kept = f.clip_shared_sign_beyond(&g, 0.25, Piece { lo: 0.0, hi: 4.0 }).unwrap();
    /// assert!(kept.lo <= 0.75 && kept.hi >= 3.25 && kept.width() < 2.5 + 1e-13);
    /// ```
    #[inline(always)]
    pub fn clip_shared_sign_beyond(&self, other: &Self, allowed: f64, part: Piece) -> Option<Piece> {
        debug_assert!([self, other].iter().all(|f| covers(allowed, f.bound_evaluation(part.reach()), part)));
        let Piece { lo, hi } = part;
        let width = hi - lo;
        /// How far both keep a sign that they share at zero. (A function: a closure is a call.)
        #[inline(always)]
        fn shared([f, g]: [&Quadratic; 2], allowed: f64) -> f64 {
            let sign = if f.value > allowed && g.value > allowed {
                1.0
            } else if f.value < -allowed && g.value < -allowed {
                -1.0
            } else {
                return 0.0;
            };
            let first = |q: &Quadratic| {
                bound_first_zero(sign * q.value - allowed, sign * q.slope, sign * q.curvature)
            };
            let (a, b) = (first(f), first(g));
            if a < b { a } else { b }
        }
        let advance = shared([&self.from(lo), &other.from(lo)], allowed);
        if advance > width {
            return None;
        }
        let retreat = shared([&self.back_from(hi), &other.back_from(hi)], allowed);
        if retreat > width {
            return None;
        }
        part.shortened(advance, retreat)
    }

    #[cold]
    #[inline(never)]
    fn clip_shared_sign_far(&self, other: &Self, margin: f64, part: Piece) -> Option<Piece> {
        let Some(unit) = TimeUnit::of(part) else { return Some(part) };
        let (f, g) = (self.in_unit(unit), other.in_unit(unit));
        let kept = f.clip_shared_sign(&g, margin, unit.piece(part))?;
        Some(unit.restored(kept, part))
    }

    /// Bounds from below the minimum over `part`, for coefficients that count as exact; NaN or −∞ where nothing is known.
    ///
    /// The smaller value at an end, less the sagitta `curvature·width²/8` of an arch that hangs below its chord, less
    /// the error of computing.
    ///
    /// ```
    /// use d2m_root::{Piece, Quadratic};
    /// let arch = Quadratic { value: 1.0, slope: 0.0, curvature: 2.0 }; // 1 + s²
    /// let least = arch.bound_below(Piece { lo: -1.0, hi: 1.0 });
    /// assert!(least <= 1.0 && least > 1.0 - 1e-14);
    /// ```
    #[inline(always)]
    pub fn bound_below(&self, part: Piece) -> f64 {
        if part.is_within(LONGEST_REACH) {
            self.least(part) - self.bound_evaluation(part.reach())
        } else {
            self.bound_below_far(part)
        }
    }

    /// True if the quadratic is certainly above `margin` throughout a piece, under the hypotheses of
    /// [`Quadratic::clip_beyond`]: the margin includes all errors. Nothing is above NaN, and NaN is above nothing.
    ///
    /// ```
    /// use d2m_root::{Piece, Quadratic};
    /// let arch = Quadratic { value: 1.0, slope: 0.0, curvature: 2.0 }; // 1 + s²
    /// let piece = Piece { lo: -1.0, hi: 1.0 };
    /// assert!(arch.exceeds(0.99, piece) && !arch.exceeds(1.01, piece));
    /// ```
    #[inline(always)]
    pub fn exceeds(&self, margin: f64, part: Piece) -> bool {
        debug_assert!(covers(margin, self.bound_evaluation(part.reach()), part));
        self.least(part) > margin
    }

    /// The minimum over a piece within [`LONGEST_REACH`], below the true one but for [`Quadratic::bound_evaluation`].
    #[inline(always)]
    fn least(&self, part: Piece) -> f64 {
        let (left, right) = (self.at(part.lo), self.at(part.hi));
        // NaN stays NaN, and excludes nothing: f64::min would drop it.
        let ends = if left <= right || left.is_nan() { left } else { right };
        if self.curvature > 0.0 {
            // Exact at the ends, below in between.
            let width = part.hi - part.lo;
            ends - self.curvature * width * width * 0.125 * SAGITTA
        } else {
            ends
        }
    }

    #[cold]
    #[inline(never)]
    fn bound_below_far(&self, part: Piece) -> f64 {
        let Some(unit) = TimeUnit::of(part) else { return f64::NEG_INFINITY };
        self.in_unit(unit).bound_below(unit.piece(part))
    }

    /// The same function of the time in another unit.
    fn in_unit(&self, unit: TimeUnit) -> Self {
        let unit = unit.length();
        Self { value: self.value, slope: self.slope * unit, curvature: self.curvature * unit * unit }
    }
}

/// Coefficient by coefficient, in plain floating point.
impl core::ops::Add for Quadratic {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
            curvature: self.curvature + other.curvature,
        }
    }
}

/// Coefficient by coefficient, in plain floating point.
impl core::ops::Sub for Quadratic {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
            curvature: self.curvature - other.curvature,
        }
    }
}

impl core::ops::Neg for Quadratic {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope, curvature: -self.curvature }
    }
}
