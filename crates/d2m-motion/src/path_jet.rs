//! The one type between motions and feature tests: a path to second or third order with a proven remainder.
use crate::rounding::SUM_ROUNDING;
use core::ops::{Add, Mul};
use glam::DVec3;

/// Remainder of a jet as a function of the distance in time from its center:
/// `e0 + e1·h + e2·h² + m3·h³/6 + m4·h⁴/24`, every coefficient ≥ 0, rounded up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Remainder {
    /// Rounding of the position (length).
    pub e0: f64,
    /// Rounding of the velocity (length per time).
    pub e1: f64,
    /// Rounding, or the half-width of an enclosure, of half the acceleration (length per time²).
    pub e2: f64,
    /// Bound of the third derivative (length per time³), or its rounding where the jet holds it.
    pub m3: f64,
    /// Bound of the fourth derivative (length per time⁴) where the jet holds the third, else 0.
    pub m4: f64,
}

impl Remainder {
    /// Upper bound of the remainder for every |s| ≤ h, h ≥ 0.
    ///
    /// The sum of non-negative products has relative error below 12·2⁻⁵³, which [`SUM_ROUNDING`] covers.
    #[inline(always)]
    pub fn bound(&self, h: f64) -> f64 {
        let third = self.m3 * (1.0 / 6.0) + h * (self.m4 * (1.0 / 24.0));
        (self.e0 + h * (self.e1 + h * (self.e2 + h * third))) * SUM_ROUNDING
    }
}

/// A path near one time: `|q(t + s) − p − v s − a s²/2 − j s³/6| ≤ remainder(h)` for all `|s| ≤ h`, up to the largest `h`
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
///     j: DVec3::ZERO,
///     remainder: Remainder { e0: 1e-16, m3: 1.0, ..Remainder::default() },
/// };
/// let s = 0.1_f64;
/// let q = DVec3::new(s.cos(), s.sin(), 0.0);
/// assert!((q - jet.at(s)).length() <= jet.remainder.bound(s));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathJet {
    /// Position at the center.
    pub p: DVec3,
    /// Velocity at the center.
    pub v: DVec3,
    /// Acceleration at the center.
    pub a: DVec3,
    /// Third derivative at the center; zero where the remainder covers it.
    pub j: DVec3,
    /// What these leave out.
    pub remainder: Remainder,
}

/// `p + v s + a s²/2 + j s³/6`, of one vector or of two side by side.
#[inline(always)]
pub(crate) fn position<V: Copy + Add<Output = V> + Mul<f64, Output = V>>([p, v, a, j]: [V; 4], s: f64) -> V {
    p + (v + (a + j * ((1.0 / 3.0) * s)) * (0.5 * s)) * s
}

/// Its derivative `v + a s + j s²/2`.
#[inline(always)]
pub(crate) fn velocity<V: Copy + Add<Output = V> + Mul<f64, Output = V>>([v, a, j]: [V; 3], s: f64) -> V {
    v + (a + j * (0.5 * s)) * s
}

impl PathJet {
    /// The polynomial `p + v s + a s²/2 + j s³/6` in plain floating point.
    #[inline(always)]
    pub fn at(&self, s: f64) -> DVec3 {
        position([self.p, self.v, self.a, self.j], s)
    }

    /// The same path about the time `m` from the center, without the third derivative: its remainder is that of the
    /// piece plus `|j|·r³/6` within `r` of `m`.
    #[inline(always)]
    pub fn moved(&self, m: f64) -> Self {
        Self {
            p: self.at(m),
            v: velocity([self.v, self.a, self.j], m),
            a: self.a + self.j * m,
            j: DVec3::ZERO,
            remainder: self.remainder,
        }
    }
}
