//! Conclusions of a search, in the bodies' own times and lengths (feature `audit`).

use super::motion::units::{sum_down, sum_up};
use super::node_pair::expansion::NodePairExpander;
use super::queue::{Bucket, Item};
use super::scene::{Scene, SceneBody};
use super::state::{Search, State};
use crate::audit::{Audited, Conclusion, Part, Place, Promise, is_heard, report};
use crate::tree::node::WIDTH;
use d2m_lanes::Rows;

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

impl Scene<'_> {
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

    /// The pairs of boxes of an expansion that are not wanted are apart over the span.
    pub(super) fn conclude_span(
        &self,
        [from, to]: [f64; 2],
        expander: &NodePairExpander<'_>,
        item: &Item,
        rows: &Rows,
    ) {
        let used = expander.nodes[item.side()][item.node() as usize].used as usize;
        for lane in (0..used.min(WIDTH)).filter(|lane| rows.wanted >> lane & 1 == 0) {
            let wide = rows.counting + lane as u32;
            let [a, b] = if rows.counting_is_third { [rows.constant, wide] } else { [wide, rows.constant] };
            let parts = [Part::Boxes(&[a]), Part::Boxes(&[b])];
            self.conclude(Place::WholeSpan, OffsetSpan::of_query(from, to), parts);
        }
    }
}

impl State<'_> {
    /// Each pair of boxes of an expansion is apart from the time of the frame to that of its key, as far as that matters; those with the
    /// key of the item itself only as that is.
    pub(super) fn conclude_rows(&self, scene: &Scene<'_>, item: &Item, rows: &Rows) {
        let used = self.expander.nodes[item.side()][item.node() as usize].used as usize;
        for lane in (0..used.min(WIDTH)).filter(|&lane| rows.keys[lane] > item.key as i32) {
            let key = (rows.keys[lane] as u32).min(self.limit);
            let wide = rows.counting + lane as u32;
            let [a, b] = if rows.counting_is_third { [rows.constant, wide] } else { [wide, rows.constant] };
            let span = self.span([self.frame.offset, f64::from(key) * self.step]);
            scene.conclude(Place::NodePair, span, [Part::Boxes(&[a]), Part::Boxes(&[b])]);
        }
    }

    /// A pair of triangles: pairs that are advanced are a little further apart than others.
    pub(super) fn conclude_pair(&self, scene: &Scene<'_>, place: Place, offsets: [f64; 2], [a, b]: [u32; 2]) {
        let level = if place == Place::Backward { scene.pair.level } else { scene.pair.target() };
        scene.conclude_at(place, self.span(offsets), [Part::Triangle(a), Part::Triangle(b)], level);
    }

    pub(super) fn span(&self, [from, to]: [f64; 2]) -> OffsetSpan {
        OffsetSpan { base: self.motion.start, from, to }
    }
}

impl Search<'_> {
    /// A plane parts all that is below the pairs that wait and matter.
    pub(super) fn conclude_crowd(&self, span: OffsetSpan, batch: &Bucket, limit: u32) {
        let waiting = self.scratch.queue.items().chain(batch.items()).filter(|item| item.key < limit);
        let (a, b): (Vec<u32>, Vec<u32>) = waiting.map(|item| (item.boxes[0], item.boxes[1])).unzip();
        self.scene.conclude(Place::Crowd, span, [Part::Boxes(&a), Part::Boxes(&b)]);
    }
}
