//! Settings of a simulation.

use crate::SimulationError;
use glam::DVec3;

/// Settings of a [`Simulation`](crate::Simulation), in any consistent units.
///
/// ```
/// use d2m_dynamics::SimulationOptions;
/// use glam::DVec3;
/// let moon = SimulationOptions::default().with_gravity(DVec3::Y * -1.62).with_step(1.0 / 64.0);
/// assert_eq!(moon.max_events, 128);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[must_use]
pub struct SimulationOptions {
    /// Acceleration of every dynamic body, world axes. Default (0, −9.81, 0).
    pub gravity: DVec3,
    /// Length of a step: how often forces act and resting contacts are solved. Default 0.01.
    pub step: f64,
    /// The distance that resting bodies keep. Default 1e-3.
    pub gap: f64,
    /// Contact events a step at most, besides 16 times as many with kinematic bodies, and 256 times as many
    /// at which other bodies bounce. After that the bodies concerned stand still until the end of the step,
    /// and [`Segment::skipped`](crate::Segment::skipped) says so. Default 128.
    pub max_events: u32,
    /// Node tests of one pair query at most. A query that meets the limit ends the flight early, at a certified time. Default 2²².
    pub node_tests: u64,
    /// Do bodies at rest sleep? An island that friction holds sleeps once its surfaces have been slower than
    /// a tenth of the gap a half second for that long, and not faster than before; among more than 64 bodies,
    /// once they have moved by less than a quarter of the gap in that time. Among more than 256 bodies
    /// without joints each body sleeps for itself, once it and all that it touches are so: it bears the
    /// others as a fixed body does, and wakes where one of them moves or changes what it bears. Default true.
    pub sleeping: bool,
}

impl SimulationOptions {
    /// The defaults.
    pub const DEFAULT: Self = Self {
        gravity: DVec3::new(0.0, -9.81, 0.0),
        step: 0.01,
        gap: 1e-3,
        max_events: 128,
        node_tests: 1 << 22,
        sleeping: true,
    };

    /// With this gravity.
    pub const fn with_gravity(mut self, gravity: DVec3) -> Self {
        self.gravity = gravity;
        self
    }

    /// With steps of this length.
    pub const fn with_step(mut self, step: f64) -> Self {
        self.step = step;
        self
    }

    /// With this distance between resting bodies.
    pub const fn with_gap(mut self, gap: f64) -> Self {
        self.gap = gap;
        self
    }

    /// With at most so many contact events a step.
    pub const fn with_max_events(mut self, max_events: u32) -> Self {
        self.max_events = max_events;
        self
    }

    /// With at most so many node tests a pair query.
    pub const fn with_node_tests(mut self, node_tests: u64) -> Self {
        self.node_tests = node_tests;
        self
    }

    /// With or without sleeping.
    pub const fn with_sleeping(mut self, sleeping: bool) -> Self {
        self.sleeping = sleeping;
        self
    }

    pub(crate) fn check(&self) -> Result<(), SimulationError> {
        for (name, value) in [("step", self.step), ("gap", self.gap)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(SimulationError::BadOption { name, value, wanted: "positive" });
            }
        }
        if !self.gravity.is_finite() {
            let value = self.gravity.to_array().into_iter().find(|x| !x.is_finite()).unwrap_or_default();
            return Err(SimulationError::BadOption { name: "gravity", value, wanted: "a vector of numbers" });
        }
        Ok(())
    }

    /// Closing speed below which a contact neither bounces nor needs an event of its own: the speed that
    /// gravity adds in two steps. Without gravity, a thousandth of the gap in a step.
    pub(crate) fn resting_speed(&self) -> f64 {
        (2.0 * self.gravity.length() * self.step).max(1e-3 * self.gap / self.step)
    }
}

impl Default for SimulationOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}
