//! A cubic in time, and the part of a piece in which it can be within a band.
//!
//! **Invariant:** the coefficients are taken as they are, exactly; every rounding made here is counted here. The proofs
//! of the constants are in `docs/theory/isolator.md`.
use super::piece::Piece;
use super::quadratic::{LONGEST_REACH, UNDERFLOW, covers};
use super::time_unit::TimeUnit;
use super::{Band, Quadratic};
use d2m_lanes::UNIT;
use d2m_lanes::power_of_two;

/// `value + slope·s + curvature·s²/2 + jerk·s³/6`.
///
/// ```
/// let cubic = d2m_root::Cubic { value: 1.0, slope: 2.0, curvature: 4.0, jerk: 6.0 };
/// assert_eq!(cubic.at(1.0), 1.0 + 2.0 + 2.0 + 1.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic {
    /// At s = 0.
    pub value: f64,
    /// First derivative at s = 0.
    pub slope: f64,
    /// Second derivative at s = 0.
    pub curvature: f64,
    /// Third derivative.
    pub jerk: f64,
}

/// A quadratic in the place of a cubic, over a piece of time.
///
/// ```
/// use d2m_root::Cubic;
/// let cubic = Cubic { value: 0.0, slope: 1.0, curvature: 0.0, jerk: 24.0 }; // s + 4 s³
/// let near = cubic.quadratic_near(0.5, 0.1);
/// // Its times count from the middle of the piece.
/// let difference = |s: f64| (near.quadratic.at(s - 0.5) - cubic.at(s)).abs();
/// assert!((0..=8).all(|k| difference(0.4 + 0.025 * f64::from(k)) <= near.left_out + 1e-15));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearbyQuadratic {
    /// About the middle of the piece.
    pub quadratic: Quadratic,
    /// By how much it differs from the cubic at most.
    pub left_out: f64,
}

/// Contractions by one cubic at most.
const ROUNDS: u32 = 4;
/// Part of what the last round allowed that the next may allow for it to pay.
const PAYS: f64 = 0.5;
/// Error of a contraction, in units of 2⁻⁵³ and parts of |value|, |slope|·h, |curvature|·h² and |jerk|·h³ for times up to
/// h: moving the cubic to the middle of a piece (1, 5, 7, 5⅓), what replacing s³ leaves out (0, 0, 0, ¼), evaluating the
/// quadratic there (9, 18, 22½, 16⅛), times that are rounded by 4·2⁻⁵³·h (0, 4, 4, 2); and the rounding of this bound
/// itself.
const OF_VALUE: f64 = 11.0;
const OF_SLOPE: f64 = 28.0;
const OF_CURVATURE: f64 = 34.0;
const OF_JERK: f64 = 24.0;
/// 2⁻⁹⁰⁰: for a shorter piece the error is bounded as for this one. Half its width may be subnormal, so that an end is off
/// by 2⁻¹⁰⁷⁴, and not by a part of the time.
const SHORTEST_REACH: f64 = power_of_two(-900);

/// Keeps a sum of three bounds above its exact value: more than its two roundings and this one.
const SUM: f64 = 1.0 + 4.0 * UNIT;

// In every product the coefficient comes first and the times after it: then what underflows is multiplied by times alone,
// which `UNDERFLOW` covers. (A cube of a short time may vanish before a huge jerk meets it.)
impl Cubic {
    /// The value at `s`, plain floating point.
    #[inline(always)]
    pub fn at(&self, s: f64) -> f64 {
        self.value + (self.slope + (0.5 * self.curvature + (1.0 / 6.0) * self.jerk * s) * s) * s
    }

    /// About the time `m`, a quadratic that differs from this cubic by at most `left_out` = `|jerk|·r³/24` within `r` of it:
    /// s³ is replaced by ¾r²s (Chebyshev: x³ − ¾x = T₃(x)/4).
    #[inline(always)]
    pub fn quadratic_near(&self, m: f64, r: f64) -> NearbyQuadratic {
        let quadratic = Quadratic {
            value: self.at(m),
            slope: self.slope + (self.curvature + 0.5 * self.jerk * m) * m + 0.125 * self.jerk * r * r,
            curvature: self.curvature + self.jerk * m,
        };
        NearbyQuadratic { quadratic, left_out: (1.0 / 24.0) * self.jerk.abs() * r * r * r }
    }

    /// [`Cubic::quadratic_near`] the time 0.
    ///
    /// ```
    /// let cubic = d2m_root::Cubic { value: -0.25, slope: 1.0, curvature: 0.5, jerk: 6.0 };
    /// assert_eq!(cubic.quadratic_about_center(0.3), cubic.quadratic_near(0.0, 0.3));
    /// ```
    #[inline(always)]
    pub fn quadratic_about_center(&self, r: f64) -> NearbyQuadratic {
        let slope = self.slope + 0.125 * self.jerk * r * r;
        let quadratic = Quadratic { value: self.value, slope, curvature: self.curvature };
        NearbyQuadratic { quadratic, left_out: (1.0 / 24.0) * self.jerk.abs() * r * r * r }
    }

    /// Bounds the rounding of everything that is computed on a piece up to the time `h` ≤ 2²⁰: 2⁻⁵³ of
    /// 11|value| + 28|slope|·h + 34|curvature|·h² + 24|jerk|·h³, and 2⁻¹⁰⁰⁰ for what underflows. Infinite, or NaN, if
    /// anything overflows there: no sum of the evaluation has larger terms.
    ///
    /// ```
    /// let cube = d2m_root::Cubic { value: 0.0, slope: 0.0, curvature: 0.0, jerk: 6.0 };
    /// assert!(cube.bound_evaluation(1.0) > 71.0 * f64::EPSILON && cube.bound_evaluation(1.0) < 1e-13);
    /// ```
    #[inline(always)]
    pub fn bound_evaluation(&self, h: f64) -> f64 {
        let h = if h > SHORTEST_REACH { h } else { SHORTEST_REACH };
        let higher = OF_CURVATURE * self.curvature.abs() + OF_JERK * self.jerk.abs() * h;
        (OF_VALUE * self.value.abs() + (OF_SLOPE * self.slope.abs() + higher * h) * h) * UNIT + UNDERFLOW
    }

    /// Cuts off both ends of `part` where the cubic is certainly farther from the band than `margin` allows; `None` if
    /// that is all of it.
    ///
    /// `margin(h)` bounds the error of the coefficients for every |s| ≤ h, and grows with h. For it the coefficients
    /// count as exact: what is rounded here is counted here. An end from which nothing can be cut stays as it is, and
    /// a cubic or a piece that is not finite loses nothing. Values within 2⁻¹⁰⁰⁰ of the band are not distinguished from it.
    ///
    /// The cubic is moved to the middle of what is left as long as that pays: it converges cubically to a simple
    /// root, down to the margin there.
    ///
    /// ```
    /// use d2m_root::{Band, Cubic, Piece};
    /// // s³ + s − ¼ has one root, 0.2367…
    /// let cubic = Cubic { value: -0.25, slope: 1.0, curvature: 0.0, jerk: 6.0 };
    /// let zero = Band { lo: 0.0, hi: 0.0 };
    /// let part = cubic.clip(zero, |_| 1e-15, Piece { lo: -1.0, hi: 1.0 }).unwrap();
    /// assert!(part.width() < 1e-5 && cubic.at(part.lo) < 0.0 && cubic.at(part.hi) > 0.0);
    /// assert!(cubic.clip(zero, |_| 1e-15, Piece { lo: 0.3, hi: 1.0 }).is_none());
    /// ```
    #[inline(always)]
    pub fn clip(&self, band: Band, margin: impl Fn(f64) -> f64, part: Piece) -> Option<Piece> {
        if part.is_within(LONGEST_REACH) {
            // Parts of the piece reach no farther.
            let error = self.bound_evaluation(part.reach());
            self.clip_rounds(band, |h| margin(h) + error, part)
        } else {
            self.clip_far(band, &margin, part)
        }
    }

    /// [`Cubic::clip`] for callers that know a bound of all errors: cuts where the cubic is more than `allowed(h)` outside
    /// the band, for every |s| ≤ h.
    ///
    /// Hypotheses, which debug builds check for the whole piece: `allowed(h)` is at least [`Cubic::bound_evaluation`] of h
    /// (besides the error of the coefficients, where they have one) and grows with h, and |s| is at most 2²⁰.
    ///
    /// ```
    /// use d2m_root::{Band, Cubic, Piece};
    /// let cubic = Cubic { value: -0.25, slope: 1.0, curvature: 0.0, jerk: 6.0 };
    /// let part = cubic.clip_beyond(Band { lo: 0.0, hi: 0.0 }, |_| 1e-13, Piece { lo: -1.0, hi: 1.0 }).unwrap();
    /// assert!(part.width() < 1e-5 && cubic.at(part.lo) < 0.0 && cubic.at(part.hi) > 0.0);
    /// ```
    #[inline(always)]
    pub fn clip_beyond(&self, band: Band, allowed: impl Fn(f64) -> f64, part: Piece) -> Option<Piece> {
        debug_assert!(covers(allowed(part.reach()), self.bound_evaluation(part.reach()), part));
        self.clip_rounds(band, allowed, part)
    }

    #[cold]
    #[inline(never)]
    fn clip_far(&self, band: Band, margin: &dyn Fn(f64) -> f64, part: Piece) -> Option<Piece> {
        let Some(unit) = TimeUnit::of(part) else { return Some(part) };
        let margin = |h: f64| margin(h * unit.length());
        let kept = self.in_unit(unit).clip(band, margin, unit.piece(part))?;
        Some(unit.restored(kept, part))
    }

    /// In rounds, each about the middle of what is left; `allowed` includes [`Cubic::bound_evaluation`] of the piece.
    #[inline(always)]
    fn clip_rounds(&self, band: Band, allowed: impl Fn(f64) -> f64, part: Piece) -> Option<Piece> {
        let mut part = part;
        let mut reach = part.reach();
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS {
            // The piece is [m − r, m + r] up to rounding, which is counted with the times.
            let width = part.hi - part.lo;
            let r = 0.5 * width;
            let m = part.lo + r;
            let NearbyQuadratic { quadratic, left_out } = self.quadratic_near(m, r);
            let allowed = (allowed(reach) + left_out) * SUM;
            // Another round pays if less is allowed. Also NaN ends here.
            let pays = allowed < PAYS * last;
            if !pays {
                break;
            }
            last = allowed;
            let band = band.padded(allowed);
            let Quadratic { value, slope, curvature } = quadratic;
            // At both ends at once: even and odd powers of the time.
            let bend = curvature * r;
            let (even, odd) = (value + 0.5 * bend * r, slope * r);
            let advance = band.bound_entry(even - odd, slope - bend, curvature);
            if advance > width {
                return None;
            }
            let retreat = band.bound_entry(even + odd, -(slope + bend), curvature);
            if retreat > width {
                return None;
            }
            // An end that is not cut stays: the middle plus what was subtracted from it may be another double, and once
            // the piece has shrunk, so has what is allowed for that.
            part = part.shortened(advance, retreat)?;
            reach = part.reach();
        }
        Some(part)
    }

    /// The same function of the time in another unit.
    fn in_unit(&self, unit: TimeUnit) -> Self {
        let unit = unit.length();
        Self {
            value: self.value,
            slope: self.slope * unit,
            curvature: self.curvature * unit * unit,
            jerk: self.jerk * unit * unit * unit,
        }
    }
}
