//! Inverse trigonometric functions.
use super::{
    Ends,
    constants::{ATAN_EIGHTHS, FRAC_PI_2, INVERSE_ODD, PI},
    enclose,
    exp_log::Scaled,
    increasing, odd,
};
use crate::Interval;
use d2m_lanes::{DoubleDouble, power_of_two};

/// The ends of an enclosure of π/2, π.
const HALF_PI: Ends = (core::f64::consts::FRAC_PI_2, Interval::FRAC_PI_2.hi());

/// Below, atan x and asin x are x within a relative x² < 2⁻⁶⁶, on the known side of it.
const LINEAR: f64 = 1e-10;
/// Above, π/2 − atan x < 10⁻²⁰; π/2 is 6·10⁻¹⁷ from the nearer of its two doubles.
const NEARLY_RIGHT: f64 = 1e20;
/// Below, |π/2 − acos x| < 2·10⁻³⁰: between the same two doubles.
const FLAT: f64 = 1e-30;

const fn alternating() -> [DoubleDouble; 12] {
    let mut out = [DoubleDouble::ZERO; 12];
    let mut i = 0;
    while i < 12 {
        let DoubleDouble { hi: a, lo: b } = INVERSE_ODD[i];
        out[i] = if i % 2 == 0 { DoubleDouble::new(a, b) } else { DoubleDouble::new(-a, -b) };
        i += 1;
    }
    out
}

/// `atan(n/d)` for 0 < n ≤ d, neither very large nor very small: relative error below 2⁻⁶⁸.
fn atan_unit(n: DoubleDouble, d: DoubleDouble) -> DoubleDouble {
    const COEFFICIENTS: [DoubleDouble; 12] = alternating();
    let near = 8.0 * (n.hi / d.hi) + 0.5;
    let i = near as usize; // truncation of a number in 0.5 … 8.5
    let c = i as f64 / 8.0;
    // atan(n/d) = atan c + atan((n − c d)/(d + c n)), and the last argument is at most 1/16.
    let t = if i == 0 {
        n / d
    } else {
        (n - d * DoubleDouble::from_f64(c)) / (d + n * DoubleDouble::from_f64(c))
    };
    let small = t * DoubleDouble::polynomial(t.sqr(), &COEFFICIENTS, 5);
    ATAN_EIGHTHS[i] + small
}

/// The angle of the point (x, y), both positive.
fn first_quadrant(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble {
    if y.hi <= x.hi { atan_unit(y, x) } else { FRAC_PI_2 - atan_unit(x, y) }
}

fn atan_at(x: f64) -> Ends {
    odd(x, |x| {
        if x < LINEAR {
            (x.next_down(), x)
        } else if x > NEARLY_RIGHT {
            HALF_PI
        } else {
            enclose(first_quadrant(DoubleDouble::from_f64(x), DoubleDouble::ONE))
        }
    })
}

/// √(1 − x²), relative.
fn co_sine(x: f64) -> DoubleDouble {
    (DoubleDouble::from_sum(1.0, -x) * DoubleDouble::from_sum(1.0, x)).sqrt()
}

fn asin_at(x: f64) -> Ends {
    odd(x, |x| {
        if x < LINEAR {
            (x, x.next_up())
        } else if x >= 1.0 {
            HALF_PI
        } else {
            enclose(first_quadrant(DoubleDouble::from_f64(x), co_sine(x)))
        }
    })
}

fn acos_at(x: f64) -> Ends {
    if x >= 1.0 {
        (0.0, 0.0)
    } else if x <= -1.0 {
        (Interval::PI.lo(), Interval::PI.hi())
    } else if x.abs() < FLAT {
        HALF_PI
    } else if x > 0.0 {
        enclose(first_quadrant(co_sine(x), DoubleDouble::from_f64(x)))
    } else {
        enclose(PI - first_quadrant(co_sine(x), DoubleDouble::from_f64(-x)))
    }
}

/// The angle of (x, y), in [−π, π], neither on an axis nor infinite.
fn angle_at(y: f64, x: f64) -> Ends {
    odd(y, |y| {
        let (a, b) = (x.abs(), y);
        // Bring both to a moderate size; a ratio beyond 2^±70 is known well enough without.
        let exponent = |v: f64| {
            let e = (v.to_bits() >> 52) as i32;
            if e == 0 { -i32::try_from(v.to_bits().leading_zeros()).unwrap_or(0) + 12 } else { e }
        };
        let (ea, eb) = (exponent(a), exponent(b));
        // Beyond 2^±70 the angle is the ratio (up to its cube), or nearer to a right angle or to π than the
        // nearest double.
        if ea - eb > 70 {
            if x < 0.0 {
                return (Interval::PI.lo(), Interval::PI.hi());
            }
            let value = DoubleDouble::from_f64(moderate(b, eb)) / DoubleDouble::from_f64(moderate(a, ea));
            return Scaled { value, exponent: eb - ea }.ends(enclose(value));
        }
        if eb - ea > 70 {
            return HALF_PI;
        }
        let (a, b) = (moderate(a, ea), moderate(b, ea));
        let angle = first_quadrant(DoubleDouble::from_f64(b), DoubleDouble::from_f64(a));
        enclose(if x > 0.0 { angle } else { PI - angle })
    })
}

/// `v·2^(1023 − exponent)`, exactly.
fn moderate(v: f64, exponent: i32) -> f64 {
    let shift = 1023 - exponent;
    let half = shift / 2;
    v * power_of_two(half) * power_of_two(shift - half)
}

impl Interval {
    /// `atan x`.
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// assert!((Interval::ONE.atan() * 4.0).contains(std::f64::consts::PI));
    /// ```
    pub fn atan(self) -> Self {
        increasing(self, atan_at, -HALF_PI.1, HALF_PI.1)
    }

    /// `asin x` over the part of the interval in [−1, 1].
    pub fn asin(self) -> Self {
        increasing(self.intersection(Self::SIGNED_UNIT), asin_at, 0.0, 0.0)
    }

    /// `acos x` over the part of the interval in [−1, 1].
    pub fn acos(self) -> Self {
        let domain = self.intersection(Self::SIGNED_UNIT);
        if domain.is_empty() {
            return domain;
        }
        Self::raw(acos_at(domain.hi()).0, acos_at(domain.lo()).1)
    }

    /// The angles in (−π, π] of the points (x, y) with `y ∈ self`; the origin has none.
    ///
    /// A box that crosses the negative x axis gives [−π, π].
    ///
    /// ```
    /// # use d2m_interval::Interval;
    /// let a = Interval::new(1.0, 2.0).atan2(Interval::point(-1.0));
    /// assert!(a.contains(1.0_f64.atan2(-1.0)) && a.contains(2.0_f64.atan2(-1.0)));
    /// assert!(Interval::new(-1.0, 1.0).atan2(Interval::new(-2.0, -1.0)).contains(-3.1));
    /// ```
    pub fn atan2(self, x: Self) -> Self {
        let y = self;
        if y.is_empty() || x.is_empty() || (x == Self::ZERO && y == Self::ZERO) {
            return Self::EMPTY;
        }
        let pi = Self::PI.hi();
        // Corner angles; infinite or zero coordinates are limits.
        let corner = |y: f64, x: f64| -> Ends {
            if x == 0.0 || y == 0.0 || x.is_infinite() || y.is_infinite() {
                axis_angle(y, x)
            } else {
                angle_at(y, x)
            }
        };
        if y.lo() < 0.0 && y.hi() >= 0.0 && x.lo() < 0.0 {
            // The branch cut is inside, or touched from below.
            return Self::raw(-pi, pi);
        }
        let (x0, x1, y0, y1) = (x.lo(), x.hi(), y.lo(), y.hi());
        if x0 == x1 && y0 == y1 && y0 != 0.0 {
            // One point, not on the branch cut: both ends at once.
            let (lo, hi) = corner(y0, x0);
            return Self::from_ends(lo, hi);
        }
        if y0 >= 0.0 {
            // Upper half plane: the angle falls with x; from the right it grows with y, from the left it falls.
            let lo = if y1 == 0.0 && x1 <= 0.0 && x0 < 0.0 {
                Self::PI.lo()
            } else if x1 > 0.0 {
                if y0 == 0.0 { 0.0 } else { corner(y0, x1).0 }
            } else if x1 == 0.0 {
                HALF_PI.0
            } else {
                corner(y1, x1).0
            };
            let hi = if x0 < 0.0 {
                if y0 == 0.0 { pi } else { corner(y0, x0).1 }
            } else if x0 == 0.0 {
                if y1 == 0.0 { 0.0 } else { HALF_PI.1 }
            } else {
                corner(y1, x0).1
            };
            return Self::from_ends(lo, hi);
        }
        if y1 <= 0.0 && (y1 < 0.0 || x0 >= 0.0) {
            // Lower half plane, without the negative axis: mirrored.
            return -((-y).atan2(x));
        }
        // Both signs of y, and x ≥ 0.
        if x0 == 0.0 {
            return Self::raw(-HALF_PI.1, HALF_PI.1);
        }
        Self::from_ends(corner(y0, x0).0, corner(y1, x0).1)
    }
}

/// Limits of the angle for coordinates that are zero or infinite (not both zero), upper half plane or axis.
fn axis_angle(y: f64, x: f64) -> Ends {
    odd(y, |y| {
        if x.is_infinite() && y.is_infinite() {
            // Anything in between: the callers use one end only.
            return if x > 0.0 { (0.0, HALF_PI.1) } else { (HALF_PI.0, Interval::PI.hi()) };
        }
        if x == 0.0 || y.is_infinite() {
            HALF_PI
        } else if x > 0.0 {
            (0.0, 0.0)
        } else {
            (Interval::PI.lo(), Interval::PI.hi())
        }
    })
}
