//! Conclusions of a search in a sub-window or a span (feature `audit`).

use super::expansion::NodePairExpander;
use super::queue::{Bucket, Item};
use super::state::{Search, State};
use crate::pair::concluded::OffsetSpan;
use crate::pair::scene::MovingScene;
use d2m_lanes::Rows;
use d2m_mesh::audit::{Part, Place};
use d2m_mesh::node::WIDTH;

impl MovingScene<'_> {
    /// The pairs of boxes of an expansion that are not wanted are apart over the span.
    pub(crate) fn conclude_span(
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
    pub(super) fn conclude_rows(&self, scene: &MovingScene<'_>, item: &Item, rows: &Rows) {
        let used = self.expander.nodes[item.side()][item.node() as usize].used as usize;
        for lane in (0..used.min(WIDTH)).filter(|&lane| rows.keys[lane] > item.key as i32) {
            let key = (rows.keys[lane] as u32).min(self.limit);
            let wide = rows.counting + lane as u32;
            let [a, b] = if rows.counting_is_third { [rows.constant, wide] } else { [wide, rows.constant] };
            let span = self.span([self.frame.offset, f64::from(key) * self.step]);
            scene.conclude(Place::NodePair, span, [Part::Boxes(&[a]), Part::Boxes(&[b])]);
        }
    }

    /// These pairs of boxes of an expansion are apart over all of the sub-window that matters.
    pub(super) fn conclude_parted(&self, scene: &MovingScene<'_>, item: &Item, rows: &Rows, apart: u32) {
        let used = self.expander.nodes[item.side()][item.node() as usize].used as usize;
        for lane in (0..used.min(WIDTH)).filter(|lane| apart >> lane & 1 == 1) {
            let wide = rows.counting + lane as u32;
            let [a, b] = if rows.counting_is_third { [rows.constant, wide] } else { [wide, rows.constant] };
            let span = self.span([0.0, self.limit_offset]);
            scene.conclude(Place::WholeSpan, span, [Part::Boxes(&[a]), Part::Boxes(&[b])]);
        }
    }

    /// A pair of triangles: pairs that are advanced are a little further apart than others.
    pub(super) fn conclude_pair(
        &self,
        scene: &MovingScene<'_>,
        place: Place,
        offsets: [f64; 2],
        [a, b]: [u32; 2],
    ) {
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
