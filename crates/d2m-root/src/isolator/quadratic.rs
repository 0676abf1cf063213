//! A quadratic in time, and the first time at which it can enter a band.
use super::Piece;

const UNIT: f64 = 0.5 * f64::EPSILON;
/// Keeps a proven time of entry early: more than the 12 roundings of its formula.
const EARLY: f64 = 1.0 - 16.0 * UNIT;

/// `value + slope·s + curvature·s²/2`.
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
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
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

    /// The sum, coefficient by coefficient.
    #[inline(always)]
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: self.slope + other.slope,
            curvature: self.curvature + other.curvature,
        }
    }

    /// The difference, coefficient by coefficient.
    #[inline(always)]
    pub fn minus(&self, other: &Self) -> Self {
        Self {
            value: self.value - other.value,
            slope: self.slope - other.slope,
            curvature: self.curvature - other.curvature,
        }
    }

    /// A time σ ≥ 0 such that `gap + slope·x + curvature·x²/2 > 0` for all 0 ≤ x < σ, given `gap > 0`: the first
    /// positive root, rounded down; infinite if there is none.
    ///
    /// `2·gap/(√disc − slope)` for a falling start, `(slope + √disc)/(−curvature)` for a rising one: only sums of
    /// non-negative numbers, except in the discriminant of a falling start that levels out, which is inflated by
    /// more than its error. An underflow in a square is covered by 1e-300. NaN gives 0.
    ///
    /// ```
    /// use d2m_root::Quadratic;
    /// let root = Quadratic::bound_first_zero(2.0, -3.0, 2.0); // 2 − 3x + x² = (x − 1)(x − 2)
    /// assert!(root <= 1.0 && root > 1.0 - 1e-14);
    /// assert_eq!(Quadratic::bound_first_zero(1.0, -1.0, 2.0), f64::INFINITY);
    /// ```
    #[inline(always)]
    pub fn bound_first_zero(gap: f64, slope: f64, curvature: f64) -> f64 {
        let square = slope * slope;
        let product = 2.0 * gap * curvature;
        let root = if slope < 0.0 {
            let inflated = (square - product) + (8.0 * UNIT) * (square + product.abs()) + 1e-300;
            if inflated < 0.0 {
                return f64::INFINITY;
            }
            2.0 * gap / (inflated.sqrt() - slope)
        } else if curvature < 0.0 {
            ((square - product).sqrt() + slope) / -curvature
        } else if slope >= 0.0 && curvature >= 0.0 {
            return f64::INFINITY;
        } else {
            0.0
        };
        let early = root * EARLY;
        // A NaN becomes 0.
        if early > 0.0 { early } else { 0.0 }
    }

    /// Cuts off both ends of `part` (times relative to s = 0) where the quadratic is certainly outside the band;
    /// `None` if that is all of it.
    ///
    /// The caller's band must include the error of the coefficients and of [`Quadratic::at`], and the change of the
    /// quadratic over a time of 4·2⁻⁵³·max(|lo|, |hi|) (the ends are rounded).
    #[inline(always)]
    pub fn clip(&self, band: Band, part: Piece) -> Option<Piece> {
        let Piece { mut lo, mut hi } = part;
        let (left, slope) = (self.at(lo), self.slope_at(lo));
        let advance = if left > band.hi {
            Self::bound_first_zero(left - band.hi, slope, self.curvature)
        } else if left < band.lo {
            Self::bound_first_zero(band.lo - left, -slope, -self.curvature)
        } else {
            0.0
        };
        if advance > 0.0 {
            if advance > hi - lo {
                return None;
            }
            lo += advance;
        }
        let (right, slope) = (self.at(hi), self.slope_at(hi));
        let retreat = if right > band.hi {
            Self::bound_first_zero(right - band.hi, -slope, self.curvature)
        } else if right < band.lo {
            Self::bound_first_zero(band.lo - right, slope, -self.curvature)
        } else {
            0.0
        };
        if retreat > 0.0 {
            if retreat > hi - lo {
                return None;
            }
            hi -= retreat;
        }
        Some(Piece { lo, hi })
    }

    /// Cuts off both ends of `part` where two quadratics certainly share a sign: `self` and `other` both above
    /// `margin` or both below `−margin`. `None` if that is all of it. Same hypotheses as [`Quadratic::clip`].
    #[inline(always)]
    pub fn clip_shared_sign(&self, other: &Self, margin: f64, part: Piece) -> Option<Piece> {
        let Piece { mut lo, mut hi } = part;
        let shared = |f: f64, g: f64| {
            if f > margin && g > margin {
                1.0
            } else if f < -margin && g < -margin {
                -1.0
            } else {
                0.0
            }
        };
        // How far from `s`, where the values are `f` and `g`, both keep the sign.
        let keep = |s: f64, f: f64, g: f64, sign: f64, direction: f64| {
            let first = |q: &Self, value: f64| {
                let slope = sign * direction * q.slope_at(s);
                Self::bound_first_zero(sign * value - margin, slope, sign * q.curvature)
            };
            let (a, b) = (first(self, f), first(other, g));
            if a < b { a } else { b }
        };
        let (f_lo, g_lo) = (self.at(lo), other.at(lo));
        let (f_hi, g_hi) = (self.at(hi), other.at(hi));
        let (at_lo, at_hi) = (shared(f_lo, g_lo), shared(f_hi, g_hi));
        if at_lo != 0.0 {
            let advance = keep(lo, f_lo, g_lo, at_lo, 1.0);
            if advance > hi - lo {
                return None;
            }
            lo += advance;
        }
        if at_hi != 0.0 {
            let retreat = keep(hi, f_hi, g_hi, at_hi, -1.0);
            if retreat > hi - lo {
                return None;
            }
            hi -= retreat;
        }
        Some(Piece { lo, hi })
    }

    /// Bounds from below the minimum over `part`.
    #[inline(always)]
    pub fn bound_below(&self, part: Piece) -> f64 {
        let (left, right) = (self.at(part.lo), self.at(part.hi));
        // NaN stays NaN, and excludes nothing: f64::min would drop it.
        let ends = if left <= right || left.is_nan() { left } else { right };
        if self.curvature > 0.0 {
            // The chord minus the sagitta: exact at the ends, below in between.
            let width = part.hi - part.lo;
            ends - self.curvature * width * width * 0.125 * (1.0 + 8.0 * UNIT)
        } else {
            ends
        }
    }
}

impl core::ops::Neg for Quadratic {
    type Output = Self;
    fn neg(self) -> Self {
        Self { value: -self.value, slope: -self.slope, curvature: -self.curvature }
    }
}
