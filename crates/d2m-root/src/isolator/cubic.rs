//! A cubic in time, and the part of a piece in which it can be within a band.
use super::{Band, Piece, Quadratic};

/// `value + slope·s + curvature·s²/2 + jerk·s³/6`.
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

/// Contractions by one cubic at most.
const ROUNDS: u32 = 4;
/// Part of what the last round allowed that the next may allow for it to pay.
const PAYS: f64 = 0.5;
const UP: f64 = 1.0 + 1e-14;

impl Cubic {
    /// The value at `s`, plain floating point.
    #[inline(always)]
    pub fn at(&self, s: f64) -> f64 {
        self.value + (self.slope + (0.5 * self.curvature + (1.0 / 6.0) * self.jerk * s) * s) * s
    }

    /// About the time `m`, a quadratic that differs from this cubic by at most `|jerk|·r³/24` within `r` of it, and
    /// that difference: s³ is replaced by ¾r²s (Chebyshev: x³ − ¾x = T₃(x)/4).
    #[inline(always)]
    pub fn quadratic_near(&self, m: f64, r: f64) -> (Quadratic, f64) {
        let quadratic = Quadratic {
            value: self.at(m),
            slope: self.slope + (self.curvature + 0.5 * self.jerk * m) * m + 0.125 * self.jerk * (r * r),
            curvature: self.curvature + self.jerk * m,
        };
        (quadratic, (1.0 / 24.0) * self.jerk.abs() * (r * r * r))
    }

    /// [`Cubic::quadratic_near`] the time 0.
    ///
    /// ```
    /// let cubic = d2m_root::Cubic { value: -0.25, slope: 1.0, curvature: 0.5, jerk: 6.0 };
    /// assert_eq!(cubic.quadratic_about_centre(0.3), cubic.quadratic_near(0.0, 0.3));
    /// ```
    #[inline(always)]
    pub fn quadratic_about_centre(&self, r: f64) -> (Quadratic, f64) {
        let slope = self.slope + 0.125 * self.jerk * (r * r);
        let quadratic = Quadratic { value: self.value, slope, curvature: self.curvature };
        (quadratic, (1.0 / 24.0) * self.jerk.abs() * (r * r * r))
    }

    /// Cuts off both ends of `part` where the cubic is certainly farther from the band than `margin` allows; `None` if
    /// that is all of it.
    ///
    /// `margin(h)` bounds what counts as error for every |s| ≤ h: of the coefficients and of evaluating them, and the
    /// change of the cubic over a time of 16·2⁻⁵³·h (the ends are rounded, four times at most). It grows with h.
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
        let Piece { mut lo, mut hi } = part;
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS {
            let m = lo + 0.5 * (hi - lo);
            let moved = Piece { lo: lo - m, hi: hi - m };
            let r = if -moved.lo > moved.hi { -moved.lo } else { moved.hi };
            let (quadratic, left_out) = self.quadratic_near(m, r);
            let (left, right) = (lo.abs(), hi.abs());
            let allowed = (margin(if left > right { left } else { right }) + left_out) * UP;
            // Another round pays if less is allowed. Also NaN ends here.
            if allowed.is_nan() || allowed >= PAYS * last {
                break;
            }
            last = allowed;
            let kept = quadratic.clip(Band { lo: band.lo - allowed, hi: band.hi + allowed }, moved)?;
            let (from, to) = (m + kept.lo, m + kept.hi);
            lo = if from > lo { from } else { lo };
            hi = if to < hi { to } else { hi };
        }
        Some(Piece { lo, hi })
    }
}
