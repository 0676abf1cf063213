//! Quadratics bounding a function from one side, and their first and last roots, rounded safely.

mod in_units;

use d2m_interval::Interval;
use in_units::InUnits;

/// The quadratic p(x) = `value` + `slope`·x + ½·`curvature`·x² on x ≥ 0, with exact `f64` coefficients.
///
/// `curvature` is the *second derivative*; the ½ is applied here and nowhere else (the paper applies it twice,
/// which makes its parabolas cut the graph of f).
///
/// ```text
///  f │\        upper: value.hi + slope.hi x + ½ curvature.hi x²
///    │ \\·.          ___/
///    │  \ `·._____--'
///    │   `·.  f  `-._
///  0 ┼──────`·x──────`·x────────  x = t − t0
///    │     lower        upper first root
/// ```
///
/// ```
/// use d2m_interval::Interval;
/// use d2m_root::Parabola;
/// let falling = Parabola::new(1.0, 0.0, -2.0); // 1 − x²
/// assert!(falling.enclose(Interval::point(0.5)).contains(0.75));
/// assert!(falling.first_nonpositive().is_some_and(|zero| zero.contains(1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parabola {
    /// p(0).
    pub value: f64,
    /// p′(0).
    pub slope: f64,
    /// p″, constant.
    pub curvature: f64,
}

impl Parabola {
    /// The quadratic with the given value and slope at x = 0 and the given second derivative.
    pub const fn new(value: f64, slope: f64, curvature: f64) -> Self {
        Self { value, slope, curvature }
    }

    /// −p.
    pub fn negated(self) -> Self {
        Self { value: -self.value, slope: -self.slope, curvature: -self.curvature }
    }

    /// Enclosure of p over the offsets `x`.
    pub fn enclose(self, x: Interval) -> Interval {
        Interval::point(self.value)
            + x * (Interval::point(self.slope) + x * (Interval::point(self.curvature) * 0.5))
    }

    /// Enclosure of p′ over the offsets `x`.
    pub(crate) fn enclose_slope(self, x: Interval) -> Interval {
        Interval::point(self.slope) + x * self.curvature
    }

    /// Encloses the smallest x ≥ 0 with p(x) ≤ 0; `None` promises p > 0 on all of x ≥ 0.
    ///
    /// If no such x exists but rounding leaves that open, an interval is returned all the same. In either case p > 0 on
    /// `[0, lo)`. NaN coefficients give `[0, ∞]`.
    ///
    /// The root is 2c/(√D − b) for b ≤ 0 and (b + √D)/(−p″) for b > 0: sums of terms of one sign, no cancellation.
    ///
    /// ```
    /// use d2m_root::Parabola;
    /// let root = Parabola::new(3.0, -4.0, 2.0).first_nonpositive().unwrap(); // x² − 4x + 3
    /// assert!(root.contains(1.0) && root.width() < 1e-14);
    /// assert!(Parabola::new(3.0, -2.0, 2.0).first_nonpositive().is_none()); // x² − 2x + 3
    /// ```
    pub fn first_nonpositive(self) -> Option<Interval> {
        if self.value.is_nan() || self.slope.is_nan() || self.curvature.is_nan() {
            return Some(Interval::new(0.0, f64::INFINITY));
        }
        if self.value <= 0.0 {
            return Some(Interval::point(0.0));
        }
        if self.slope >= 0.0 && self.curvature >= 0.0 {
            return None;
        }
        let p = InUnits::of(self);
        let d = p.discriminant();
        if d.certainly_negative() {
            return None;
        }
        let root = nonnegative(d).sqrt();
        let x = if self.slope <= 0.0 {
            quotient(p.value * 2.0, nonnegative(root - p.slope))
        } else {
            quotient(nonnegative(root + p.slope), nonnegative(-p.curvature))
        };
        Some(p.offset(x))
    }

    /// An upper bound of the largest x ≥ 0 with p(x) ≤ 0, `∞` where p stays nonpositive or rounding leaves that open.
    ///
    /// Meaningful only if such an x exists; otherwise any value may come back.
    pub(crate) fn bound_last_nonpositive(self) -> f64 {
        if self.curvature.is_nan() || self.curvature <= 0.0 {
            return f64::INFINITY;
        }
        let p = InUnits::of(self);
        let d = nonnegative(p.discriminant());
        let x = if self.slope <= 0.0 {
            quotient(nonnegative(d.sqrt() - p.slope), nonnegative(p.curvature))
        } else {
            // −2c/(b + √D): c ≤ 0 wherever a nonnegative root exists.
            quotient(nonnegative(-p.value * 2.0), nonnegative(d.sqrt() + p.slope))
        };
        p.offset(x).hi()
    }

    /// Given p(0) ≤ 0, p″ ≤ 0 and p(w) > 0 for some w: an upper bound of the offset at which p turns positive.
    pub(crate) fn bound_first_rise(self) -> f64 {
        let p = InUnits::of(self);
        let d = nonnegative(p.discriminant());
        p.offset(quotient(nonnegative(-p.value * 2.0), nonnegative(d.sqrt() + p.slope))).hi()
    }
}

/// Clamps to [0, ∞]; anything undefined becomes [0, ∞].
fn nonnegative(x: Interval) -> Interval {
    let hi = x.hi();
    if hi.is_nan() || x.lo().is_nan() {
        return Interval::new(0.0, f64::INFINITY);
    }
    Interval::new(x.lo().max(0.0), hi.max(0.0))
}

/// Quotient of two nonnegative intervals; a divisor that holds 0 gives an unbounded upper end.
fn quotient(a: Interval, b: Interval) -> Interval {
    if b.lo() > 0.0 {
        return nonnegative(a / b);
    }
    if b.hi() > 0.0 && b.hi() < f64::INFINITY {
        let lo = (Interval::point(a.lo()) / Interval::point(b.hi())).lo();
        return Interval::new(lo.max(0.0), f64::INFINITY);
    }
    Interval::new(0.0, f64::INFINITY)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planted_roots_of_either_order_and_sign() {
        for &(r, s) in &[(1.0, 3.0), (0.25, 0.25), (1e-9, 7.0), (2.0, 1e12), (1e-80, 1.0)] {
            for scale in [1.0, 1e-30, 1e30, 3.7] {
                // scale (x − r)(x − s)
                let p = Parabola::new(scale * r * s, -scale * (r + s), 2.0 * scale);
                let x = p.first_nonpositive().expect("planted root");
                assert!(x.lo() <= r * (1.0 + 1e-7) && x.lo() >= 0.0, "{r} {s} {scale} {x:?}");
                assert!(x.lo() >= r * (1.0 - 1e-6), "{r} {s} {scale} {x:?}");
                assert!(p.bound_last_nonpositive() >= s * (1.0 - 1e-15));
                assert!(p.bound_last_nonpositive() <= s * (1.0 + 1e-6));
                // one negative root: −scale (x − s)(x + r)
                let q = Parabola::new(scale * s * r, scale * (s - r), -2.0 * scale);
                let y = q.first_nonpositive().expect("planted root");
                assert!(y.lo() <= s && y.hi() >= s * (1.0 - 1e-15) && y.width() <= s * 1e-6, "{y:?} {s}");
            }
        }
    }

    #[test]
    fn the_half_is_applied_once() {
        // 1 − x²/2·2 = 1 − x²: root at 1, not at √2.
        let x = Parabola::new(1.0, 0.0, -2.0).first_nonpositive().unwrap();
        assert!(x.contains(1.0) && x.width() < 1e-14);
    }

    #[test]
    fn lines_and_constants() {
        assert_eq!(Parabola::new(1.0, 0.0, 0.0).first_nonpositive(), None);
        assert_eq!(Parabola::new(1.0, 2.0, 0.0).first_nonpositive(), None);
        let x = Parabola::new(1.0, -4.0, 0.0).first_nonpositive().unwrap();
        assert!(x.contains(0.25) && x.width() < 1e-15);
        assert_eq!(Parabola::new(0.0, 1.0, 0.0).first_nonpositive(), Some(Interval::point(0.0)));
    }

    #[test]
    fn overflow_and_not_a_number_stay_sound() {
        for p in [
            Parabola::new(f64::NAN, 1.0, 1.0),
            Parabola::new(1.0, f64::NAN, 1.0),
            Parabola::new(1.0, 1.0, f64::NAN),
        ] {
            assert_eq!(p.first_nonpositive(), Some(Interval::new(0.0, f64::INFINITY)));
        }
        for p in [
            Parabola::new(1e300, -1e300, 1e300),
            Parabola::new(f64::INFINITY, -1.0, -1.0),
            Parabola::new(1.0, f64::NEG_INFINITY, f64::NEG_INFINITY),
            Parabola::new(1.0, f64::NAN, 1.0),
        ] {
            if let Some(x) = p.first_nonpositive() {
                assert!(x.lo() >= 0.0 && !x.lo().is_nan());
            }
        }
        // 1e300 (1 − x + x²/2) has no root
        let none = Parabola::new(1e300, -1e300, 1e300).first_nonpositive();
        assert!(none.is_none_or(|x| x.lo() == 0.0));
    }

    /// The same roots in units of value and offset from one end of the range of doubles to the other.
    #[test]
    fn roots_follow_every_exact_scaling() {
        use d2m_lanes::scaled;
        for (c, b, k, first) in
            [(3.0, -4.0, 2.0, 1.0), (1.0, 0.0, -2.0, 1.0), (1.0, -4.0, 0.0, 0.25), (2.0, 1.0, -2.0, 2.0)]
        {
            for time in [-900, -600, -160, 0, 160, 450, 900] {
                for unit in [-900, -500, -160, 0, 160, 500, 900] {
                    let numbers = [(c, unit), (b, unit - time), (k, unit - 2 * time)];
                    let [value, slope, curvature] = numbers.map(|(x, n)| scaled(x, n));
                    let exact = numbers.iter().all(|&(x, n)| scaled(scaled(x, n), -n) == x);
                    if exact {
                        let x = Parabola::new(value, slope, curvature).first_nonpositive().expect("a root");
                        let root = scaled(first, time);
                        assert!(x.lo() <= root && root <= x.hi(), "{time} {unit} {x:?}");
                        assert!(x.width() <= root * 1e-14, "{time} {unit} {x:?}");
                    }
                }
            }
        }
        assert_eq!(Parabola::new(1e300, -1e300, 1e300).first_nonpositive(), None);
        // A slope or a curvature that is nothing beside the rest.
        let x = Parabola::new(1e200, 5e-324, -1e200).first_nonpositive().expect("a root");
        assert!(x.contains(2.0_f64.sqrt()) && x.width() < 1e-14);
        let x = Parabola::new(1e300, 1e-5, -1e-320).first_nonpositive().expect("a root");
        assert!(x.lo() > 1e308 && x.lo() < f64::INFINITY);
    }

    /// A coefficient too small for these units is enclosed together with zero, on its own side of it.
    #[test]
    fn negligible_coefficients_are_enclosed() {
        let p = InUnits::of(Parabola::new(1e200, 5e-324, -1e200));
        assert!(p.slope.contains(0.0) && p.slope.lo() == 0.0 && p.slope.hi() > 0.0 && p.slope.hi() < 1e-200);
        let p = InUnits::of(Parabola::new(1e200, -5e-324, -1e200));
        assert!(p.slope.contains(0.0) && p.slope.hi() == 0.0 && p.slope.lo() < 0.0 && p.slope.lo() > -1e-200);
        // A function that is not finite stays as it is.
        assert_eq!(InUnits::of(Parabola::new(f64::INFINITY, 1.0, 1.0)).slope, Interval::point(1.0));
    }

    /// What rises last, and what has turned positive, in far units.
    #[test]
    fn last_roots_follow_every_exact_scaling() {
        use d2m_lanes::scaled;
        for n in [-900, -450, 0, 450, 900] {
            let p = Parabola::new(scaled(3.0, n), scaled(-4.0, n), scaled(2.0, n));
            let last = p.bound_last_nonpositive();
            assert!((3.0..3.0 + 1e-13).contains(&last), "{n} {last}");
            // −2 + 3x − x² is positive between 1 and 2.
            let rising = Parabola::new(scaled(-2.0, n), scaled(3.0, n), scaled(-2.0, n));
            let rise = rising.bound_first_rise();
            assert!((1.0..1.0 + 1e-13).contains(&rise), "{n} {rise}");
        }
    }

    /// p(x) is evaluated exactly in integers: the certified lower end is never past the first sign change.
    #[test]
    fn never_late_against_exact_integers() {
        for c in 1i64..=12 {
            for b in -12i64..=12 {
                for a in -6i64..=6 {
                    let p = Parabola::new(c as f64, b as f64, 2.0 * a as f64);
                    // first k/64 with p ≤ 0, exactly: c + b k/64 + a k²/4096
                    let first = (0..=64 * 40i64).find(|&k| c * 4096 + b * k * 64 + a * k * k <= 0);
                    match (p.first_nonpositive(), first) {
                        (Some(x), Some(k)) => {
                            assert!(x.lo() <= k as f64 / 64.0, "{c} {b} {a}");
                            // exact sign just before: p(lo) > 0 up to one unit of the grid
                            assert!(x.hi() >= (k - 1) as f64 / 64.0, "{c} {b} {a}");
                        }
                        (None, Some(_)) => panic!("root lost: {c} {b} {a}"),
                        _ => {}
                    }
                }
            }
        }
    }
}
