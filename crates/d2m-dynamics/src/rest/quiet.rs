//! How long a body has been quiet: slow enough, for long enough, to sleep.

use crate::SimulationOptions;
use glam::{DQuat, DVec3};

/// The time for which bodies have to be quiet before they sleep, in seconds or the user's unit of time.
pub(crate) const QUIET_TIME: f64 = 0.5;
/// Surfaces of quiet bodies move by this part of the gap at most in that time.
const QUIET_WAY: f64 = 0.1;
/// The same among many bodies: solutions move single bodies of a heap at rest by up to a fifth of a gap in
/// that time.
const SHAKEN_WAY: f64 = 0.25;
/// Up to this part of the speed of quiet bodies a body stands still. One that no friction brakes keeps any
/// other speed.
const STILL: f64 = 1.0 / 1024.0;
/// By this factor a body may be faster than it was in its quiet time.
const GROWTH: f64 = 1.0625;

/// How the rest of a body is recognised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rest {
    /// No friction brakes the body: it rests only where it stands still.
    Unbraked,
    /// By its speed: a body that a force accelerates is not at rest, however slow it is.
    BySpeed,
    /// By its displacement: among many bodies solutions shake it.
    ByWay,
}

/// For how long a body has been quiet, and where it was then.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Quiet {
    time: f64,
    /// The lowest speed of its surface in that time.
    slowest: f64,
    /// Where it was when that began; none: it has not begun.
    place: Option<(DVec3, DQuat)>,
}

/// Where the surface of a body is after a step, and how fast in it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface {
    pub(crate) position: DVec3,
    pub(crate) orientation: DQuat,
    pub(crate) radius: f64,
    pub(crate) speed: f64,
}

impl Quiet {
    /// Has it been quiet for long enough to sleep?
    pub(crate) fn is_long(&self) -> bool {
        self.time >= QUIET_TIME
    }

    /// Has it moved in the last step, by more than quiet bodies do?
    pub(crate) fn has_moved(&self) -> bool {
        self.time == 0.0
    }

    /// Quiet for most of the time: a body that wakes because its load changes falls asleep again soon, unless
    /// it moves.
    pub(crate) fn drowsy(self) -> Self {
        Self { time: 0.75 * QUIET_TIME, ..self }
    }

    /// Counts a step of this length.
    pub(crate) fn go_on(&mut self, surface: Surface, rest: Rest, step: f64, options: &SimulationOptions) {
        let way = QUIET_WAY * options.gap;
        let still = STILL * way / QUIET_TIME;
        let steady = GROWTH * self.slowest + still;
        let is_quiet = match rest {
            Rest::Unbraked => surface.speed <= still.min(steady),
            Rest::BySpeed => surface.speed <= (way / QUIET_TIME).min(steady),
            Rest::ByWay => !self.is_left_by(surface, options.gap, 0.0),
        };
        if is_quiet {
            self.time += step;
            self.slowest = self.slowest.min(surface.speed);
        } else {
            let Surface { position, orientation, speed, .. } = surface;
            *self = Self { time: 0.0, slowest: speed, place: Some((position, orientation)) };
        }
    }

    /// Is a surface off its place of the quiet time by more than solutions shake it, and this much?
    pub(crate) fn is_left_by(&self, surface: Surface, gap: f64, more: f64) -> bool {
        self.way_to(surface).is_none_or(|way| way > SHAKEN_WAY * gap + more)
    }

    /// The largest displacement of a point of the surface since the quiet time began.
    fn way_to(&self, surface: Surface) -> Option<f64> {
        let (position, orientation) = self.place?;
        let turn = surface.orientation * orientation.conjugate();
        // A chord: twice the sine of half of the angle.
        let chord = 2.0 * DVec3::new(turn.x, turn.y, turn.z).length();
        Some((surface.position - position).length() + chord * surface.radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONWARDS: [f64; 2] = [1.0, 1.0];
    const BACK_AND_FORTH: [f64; 2] = [1.0, -1.0];

    /// Steps of a hundredth, two in each of the directions in turn: for how long the body has been quiet
    /// after the quiet time.
    fn quiet_after(rest: Rest, part: f64, directions: [f64; 2]) -> f64 {
        let options = SimulationOptions::default();
        let (way, step) = (QUIET_WAY * options.gap, 0.01);
        let mut surface =
            Surface { position: DVec3::X, orientation: DQuat::IDENTITY, radius: 1.0, speed: 0.0 };
        let mut quiet = Quiet::default();
        for k in 0..100 {
            // A fifth of the speed and all of it in turn.
            let speed = part * way / QUIET_TIME * if k % 2 == 0 { 0.2 } else { 1.0 };
            surface.position.x += directions[k / 2 % 2] * speed * step;
            surface.speed = speed;
            quiet.go_on(surface, rest, step, &options);
        }
        quiet.time
    }

    /// A body that solutions shake at three times the speed of quiet bodies is quiet by its displacement, and
    /// not by its speed; one that goes on in one direction is not.
    #[test]
    fn what_is_shaken_among_many_is_quiet_by_its_way() {
        assert!(quiet_after(Rest::ByWay, 3.0, BACK_AND_FORTH) > QUIET_TIME);
        assert!(quiet_after(Rest::ByWay, 9.0, ONWARDS) < QUIET_TIME);
        for rest in [Rest::BySpeed, Rest::Unbraked] {
            assert!(quiet_after(rest, 3.0, BACK_AND_FORTH) < 0.1 * QUIET_TIME);
        }
    }

    /// A body that turns in place is not quiet.
    #[test]
    fn turns_are_ways() {
        let options = SimulationOptions::default();
        let at = |angle: f64| Surface {
            position: DVec3::ZERO,
            orientation: DQuat::from_rotation_z(angle),
            radius: 2.0,
            speed: 0.0,
        };
        let mut quiet = Quiet::default();
        quiet.go_on(at(0.0), Rest::ByWay, 0.01, &options);
        for (part, is_quiet) in [(0.4, true), (0.6, false)] {
            let mut next = quiet;
            next.go_on(at(part * SHAKEN_WAY * options.gap), Rest::ByWay, 0.01, &options);
            assert_eq!(next.time > quiet.time, is_quiet, "{part}");
        }
    }
}
