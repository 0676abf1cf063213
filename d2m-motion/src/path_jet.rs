//! The one type between motions and feature tests: a second-order path with a proven remainder.
use glam::DVec3;

/// Remainder of a jet as a function of the distance in time from its centre:
/// `e0 + e1·h + e2·h² + m3·h³/6`, every coefficient ≥ 0, rounded up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Remainder {
    /// Rounding of the position (length).
    pub e0: f64,
    /// Rounding of the velocity (length per time).
    pub e1: f64,
    /// Rounding, or the half-width of an enclosure, of half the acceleration (length per time²).
    pub e2: f64,
    /// Bound of the third derivative (length per time³).
    pub m3: f64,
}

impl Remainder {
    /// Upper bound of the remainder for every |s| ≤ h, h ≥ 0.
    ///
    /// The sum of non-negative products has relative error below 8·2⁻⁵³, which the last factor covers.
    #[inline(always)]
    pub fn bound(&self, h: f64) -> f64 {
        (self.e0 + h * (self.e1 + h * (self.e2 + h * (self.m3 * (1.0 / 6.0))))) * (1.0 + 1e-14)
    }

    /// A remainder that bounds the sum of both (not rounded: add it where a later factor rounds up).
    pub fn plus(self, other: Self) -> Self {
        let up = |x: f64| x * (1.0 + 4.0 * f64::EPSILON);
        Self {
            e0: up(self.e0 + other.e0),
            e1: up(self.e1 + other.e1),
            e2: up(self.e2 + other.e2),
            m3: up(self.m3 + other.m3),
        }
    }
}

/// A path near one time: `|q(t + s) − p − v s − a s²/2| ≤ remainder(h)` for all `|s| ≤ h`, up to the largest `h`
/// for which it was made.
///
/// ```
/// use d2m_motion::{PathJet, Remainder};
/// use glam::DVec3;
/// // q(s) = (cos s, sin s, 0): |q‴| = 1.
/// let jet = PathJet {
///     p: DVec3::X,
///     v: DVec3::Y,
///     a: -DVec3::X,
///     remainder: Remainder { e0: 1e-16, e1: 0.0, e2: 0.0, m3: 1.0 },
/// };
/// let s = 0.1_f64;
/// let q = DVec3::new(s.cos(), s.sin(), 0.0);
/// assert!((q - jet.at(s)).length() <= jet.remainder.bound(s));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathJet {
    /// Position at the centre.
    pub p: DVec3,
    /// Velocity at the centre.
    pub v: DVec3,
    /// Acceleration at the centre.
    pub a: DVec3,
    /// What the three leave out.
    pub remainder: Remainder,
}

impl PathJet {
    /// The polynomial `p + v s + a s²/2` in plain floating point.
    #[inline(always)]
    pub fn at(&self, s: f64) -> DVec3 {
        self.p + (self.v + self.a * (0.5 * s)) * s
    }
}
