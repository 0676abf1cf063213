//! The clock and the unit of length of one search.

use crate::Window;
use d2m_lanes::{power_of_two, power_of_two_above, two_sum};

/// Units are powers of two between this one and its inverse: both can be multiplied with and divided by.
const LEAST_UNIT: f64 = power_of_two(-1000);

/// Times of a search are *offsets*: they count from the first instant of the query's window, in units of a power of two
/// that is about as long as the window. Lengths are in units of a power of two that is about as large as the scene.
///
/// So neither a window far from time zero nor a scene in unusual units costs precision or range, and a query whose
/// numbers are all multiplied by a power of two is searched in the same way, bit by bit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Units {
    window: Window,
    time: f64,
    length: f64,
}

impl Units {
    /// Units for a window, with a unit of time and of length that are at least about as large as these.
    pub(crate) fn new(window: Window, time: f64, length: f64) -> Self {
        Self { window, time: unit_from(time), length: unit_from(length) }
    }

    /// Seconds in the unit of time.
    pub(crate) const fn time(&self) -> f64 {
        self.time
    }

    /// The unit of length in that of the meshes.
    pub(crate) const fn length(&self) -> f64 {
        self.length
    }

    /// The offset of the end of the window, not early.
    pub(crate) fn end_up(&self) -> f64 {
        sum_up(self.window.end(), -self.window.start()) / self.time
    }

    /// The offset of the end of the window, not late.
    pub(crate) fn end_down(&self) -> f64 {
        sum_down(self.window.end(), -self.window.start()) / self.time
    }

    /// The time at an offset, not late.
    pub(crate) fn time_down(&self, offset: f64) -> f64 {
        // Exact, if not below the normal numbers.
        let seconds = offset * self.time;
        let seconds = if seconds < f64::MIN_POSITIVE { 0.0 } else { seconds };
        sum_down(self.window.start(), seconds)
    }

    /// The time at an offset, not early.
    pub(crate) fn time_up(&self, offset: f64) -> f64 {
        let seconds = offset * self.time;
        let seconds = if offset > 0.0 { seconds.max(f64::MIN_POSITIVE) } else { 0.0 };
        sum_up(self.window.start(), seconds)
    }

    /// The offset of a time, to half a unit in the last place.
    pub(crate) fn offset(&self, time: f64) -> f64 {
        (time - self.window.start()) / self.time
    }
}

/// The sum of two numbers, rounded down.
pub(crate) fn sum_down(a: f64, b: f64) -> f64 {
    let (sum, rest) = two_sum(a, b);
    if rest < 0.0 { sum.next_down() } else { sum }
}

/// The sum of two numbers, rounded up.
pub(crate) fn sum_up(a: f64, b: f64) -> f64 {
    let (sum, rest) = two_sum(a, b);
    if rest > 0.0 { sum.next_up() } else { sum }
}

/// The least power of two that is not below a number, within the range of units; one for zero.
fn unit_from(value: f64) -> f64 {
    if value == 0.0 {
        return 1.0;
    }
    power_of_two_above(value.clamp(LEAST_UNIT, 1.0 / LEAST_UNIT))
}
