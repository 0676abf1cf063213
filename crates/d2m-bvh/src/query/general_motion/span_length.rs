//! How long spans are: what chooses them and proves nothing.

use super::{Advance, EXPECTED, GROWTH, SMALL_PART};
use crate::{Contact, Mode};
use d2m_feature::triangle_distance;
use d2m_motion::Pose;

/// Part of the room between the bodies that a deviation may take.
const PART_OF_ROOM: f64 = 0.25;
/// The same for queries that ask only whether bodies meet: a contact of approximated motions that deviate so little is mostly one of the true motions.
const PART_TO_MEET: f64 = 0.0625;
/// A contact is expected after the gap has closed at the speed it closes with, and searched for this much longer.
const OVERSHOOT: f64 = 1.25;
/// A span says nothing of one that is longer by more than this.
const MOST_EXPECTED: f64 = 16.0;
/// Spans at most that are as short as they are because velocities at single times are not known better: the enclosures of such motions are
/// too wide to come near anything, and after so many the answer is undecided. Velocities that are known to rounding need none.
const MOST_DRIFTING: u32 = 1 << 16;
/// After so many of them it is estimated how many more there would be.
const DRIFTING: u32 = 1 << 10;

/// What the next fit goes by: the length of a span, and its deviation less the floor, which goes like the square of that.
#[derive(Clone, Copy)]
pub(super) struct LastFit {
    pub(super) length: f64,
    pub(super) bend: f64,
}

/// Spans so far whose velocities are enclosed too widely.
pub(super) struct Drifting {
    pub(super) spans: u32,
    /// When the last ones that were counted together began.
    pub(super) since: f64,
}

impl Drifting {
    /// Counts a span that begins now. Would there be too many up to the end, as many for as much time as of late?
    pub(super) fn is_hopeless(&mut self, now: f64, end: f64) -> bool {
        self.spans += 1;
        if !self.spans.is_multiple_of(DRIFTING) {
            return false;
        }
        let more = f64::from(DRIFTING) * ((end - now) / (now - self.since));
        self.since = now;
        f64::from(self.spans) + more > f64::from(MOST_DRIFTING)
    }
}

/// A span in which fitted twists came near although they deviate by more than the tolerance allows.
pub(super) struct Shortfall {
    /// Of the fitted twists.
    pub(super) deviation: f64,
    /// The part of it that no shorter span takes away.
    pub(super) floor: f64,
    pub(super) tolerance: f64,
    /// The end of the span.
    pub(super) until: f64,
}

impl Advance<'_> {
    /// How long the next span may be, and how far it may deviate, after the fitted twists came near.
    pub(super) fn shorten(&mut self, contact: &Contact, shortfall: &Shortfall) {
        let Shortfall { deviation, floor, tolerance, until } = *shortfall;
        let room = self.room_at(contact);
        let part = if self.options.mode == Mode::Exists { PART_TO_MEET } else { PART_OF_ROOM };
        let wanted = if room > GROWTH * tolerance { room * part } else { 0.0 };
        let least = SMALL_PART * tolerance;
        self.largest = wanted.max(least).min(0.5 * deviation);
        let span = until - self.now;
        // Enclosures that are this wide at single times get no better.
        let hopeless = floor > 0.5 * self.largest.max(least) && deviation <= 2.0 * floor;
        let closes = if contact.closing_speed > 0.0 {
            OVERSHOOT * (room.max(0.0) + tolerance) / contact.closing_speed
        } else {
            span
        };
        self.longest = if hopeless { 0.0 } else { span.min(closes) };
    }

    /// About how far apart the two triangles of a contact are in truth, less the wanted separation.
    pub(super) fn room_at(&mut self, contact: &Contact) -> f64 {
        let poses = self.poses_at(contact.time_lo);
        let corners = |k: usize, triangle: u32| {
            let pose = poses[k].0;
            self.bodies[k].body.mesh().corners(triangle as usize).map(|p| pose.transform_point(p))
        };
        let apart = triangle_distance(&corners(0, contact.triangle_a), &corners(1, contact.triangle_b));
        apart.upper - self.options.min_separation
    }

    /// A deviation that is little against the bodies, or against the room between the spheres about them.
    pub(super) fn usual_deviation(&self, poses: &[Pose; 2]) -> f64 {
        let [a, b] = [0, 1].map(|k| {
            let body = self.bodies[k].body;
            (poses[k].transform_point(body.center()), body.radius())
        });
        let room = (a.0 - b.0).length() - a.1 - b.1;
        PART_OF_ROOM * room.max(a.1.min(b.1)).max(SMALL_PART * a.1.max(b.1))
    }

    /// About how long a span may be to deviate by so much, or by the least that matters, if the motions go on as in the last span;
    /// the longest one if nothing is known. It saves fits of spans that are too long, and proves nothing.
    pub(super) fn expected_span(&self, deviation: f64) -> f64 {
        let Some(LastFit { length, bend }) = self.last else { return self.longest };
        let deviation = deviation.max(SMALL_PART * self.tolerance);
        let expected = length * (EXPECTED * deviation / bend).sqrt();
        // What rounding leaves of a short span says nothing of a long one.
        let says_nothing = expected.is_nan() || self.longest > MOST_EXPECTED * length;
        if says_nothing { self.longest } else { self.longest.min(expected) }
    }
}
