//! Conclusions of a search, in the bodies' own times and lengths (feature `audit`).

use super::scene::{MovingScene, SceneBody};
use crate::pair::motion::units::{sum_down, sum_up};
use d2m_mesh::audit::{Audited, Conclusion, Part, Place, Promise, is_heard, report};

/// A span of a search: from one offset to another, both counted from a third.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OffsetSpan {
    pub(crate) base: f64,
    pub(crate) from: f64,
    pub(crate) to: f64,
}

impl OffsetSpan {
    /// Offsets of the query.
    pub(crate) const fn of_query(from: f64, to: f64) -> Self {
        Self { base: 0.0, from, to }
    }
}

impl MovingScene<'_> {
    /// Parts of the bodies stay further apart than the level.
    pub(crate) fn conclude(&self, place: Place, span: OffsetSpan, parts: [Part<'_>; 2]) {
        self.conclude_at(place, span, parts, self.pair.level);
    }

    /// The bodies are apart from one offset of the query to another, if there is one.
    pub(crate) fn conclude_whole(&self, place: Place, from: f64, to: Option<f64>) {
        if let Some(to) = to {
            self.conclude(place, OffsetSpan::of_query(from, to), [Part::Whole; 2]);
        }
    }

    /// Further apart than another distance, in the unit of the scene.
    pub(crate) fn conclude_at(&self, place: Place, span: OffsetSpan, parts: [Part<'_>; 2], level: f64) {
        if is_heard() {
            let OffsetSpan { base, from, to } = span;
            // Inwards, by less than the resolution of time.
            let from = self.units.time_up(sum_up(base, from));
            let to = self.units.time_down(sum_down(base, to));
            let (promise, distance) = (Promise::Apart, level * self.units.length());
            report(&Conclusion { place, bodies: self.audited(parts), from, to, distance, promise });
        }
    }

    /// Two triangles are within the level at an offset of the query, to the resolution of time.
    pub(crate) fn conclude_meeting(&self, offset: f64, [a, b]: [u32; 2]) {
        let (from, to) = (self.units.time_down(offset), self.units.time_up(offset));
        let (promise, distance) = (Promise::Meets, self.pair.level * self.units.length());
        let bodies = self.audited([Part::Triangle(a), Part::Triangle(b)]);
        report(&Conclusion { place: Place::MeetAgain, bodies, from, to, distance, promise });
    }

    fn audited<'s>(&'s self, parts: [Part<'s>; 2]) -> [Audited<'s>; 2] {
        let body = |body: &'s SceneBody<'_>, part| Audited::new(body.tree, &body.given, part);
        [body(&self.a, parts[0]), body(&self.b, parts[1])]
    }
}
