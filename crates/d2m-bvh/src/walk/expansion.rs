//! Expanding a pair of boxes: a box of one body against the eight boxes of a node of the other.

use crate::pair::boxes::entry_time::entry_times;
use crate::pair::boxes::node_scale::NodeScale;
use crate::pair::boxes::node_test::{NodeFrame, Placed};
use crate::pair::boxes::whole_span::{SpanDirection, SpanFrame, apart_along_over_span, apart_over_span};
use crate::walk::queue::Item;
use d2m_lanes::{Keys, Lanes, Rows, SingleSide, WideSide};
use d2m_mesh::node::{NodeBox, WIDTH, WideNode};

/// Keys of a sub-window run from 0 to this for its whole unit of time.
pub(crate) const KEY_SCALE: f64 = 536_870_912.0; // 2²⁹
/// Later times get this key: beyond every sub-window, and the sum with a key of the frame is still a number of 31 bits.
const LATEST_KEY: f32 = 1.25 * KEY_SCALE as f32;

/// The keys that pairs below an item may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct KeyRange {
    /// The key of the frame: keys count from it.
    pub(crate) now: u32,
    /// Pairs whose key is not below this are not worth queueing.
    pub(crate) limit: u32,
}

/// What the expansions of one frame share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodePairExpander<'a> {
    /// Wide nodes of A and of B.
    pub(crate) nodes: [&'a [WideNode]; 2],
    /// Constants when nodes of A, of B, are expanded.
    pub(crate) scales: [NodeScale; 2],
    /// Sizes of A's boxes are multiplied by the first, those of B's by the second, before they are compared: between
    /// [`LEAST_SIZE`](d2m_mesh::node::LEAST_SIZE) and its inverse.
    pub(crate) size_ratios: [f32; 2],
}

/// The frames of a span, and a direction that is tried of every pair over all of it: where nodes of A, of B, are expanded.
pub(crate) struct DirectedSpan<'p, L: Lanes> {
    pub(crate) frames: [SpanFrame<'p, L>; 2],
    pub(crate) directions: [SpanDirection; 2],
}

impl NodePairExpander<'_> {
    /// What is to be done with a pair of boxes: the larger one is expanded. A triangle has no size, so it is never the larger.
    pub(crate) fn next_of(&self, a: u32, b: u32) -> u32 {
        let (na, nb) = (&self.nodes[0][a as usize / WIDTH], &self.nodes[1][b as usize / WIDTH]);
        let (la, lb) = (a as usize % WIDTH, b as usize % WIDTH);
        let larger = na.size(la) * self.size_ratios[0] > nb.size(lb) * self.size_ratios[1];
        if larger { na.child[la] } else { nb.child[lb] | Item::OF_B }
    }

    /// The pair of the two roots, with the key zero.
    pub(crate) fn root(&self) -> Item {
        Item { key: 0, boxes: [0; 2], next: self.next_of(0, 0) }
    }

    /// Expands an item that is not a pair of triangles: the pairs of each box of its node with the other body's box, as rows
    /// of an [`Item`]; wanted are those worth queueing,
    /// their keys are times until which they are proven apart.
    #[inline(always)]
    pub(crate) fn expand<L: Lanes>(
        &self,
        item: &Item,
        frames: &[NodeFrame; 2],
        KeyRange { now, limit }: KeyRange,
    ) -> Rows {
        let (wide_index, side) = (item.node(), item.side());
        let other = 1 - side;
        let wide = &self.nodes[side][wide_index as usize];
        let single = NodeBox::new(self.nodes[other], item.boxes[other]);
        let scale = &self.scales[side];
        let placed = Placed::new::<L>(&frames[side], scale, single, wide);
        let times = entry_times::<L>(wide, &placed, scale);
        // What is not a number becomes the key of the item itself.
        let steps = L::splat(LATEST_KEY).min(times * L::splat(KEY_SCALE as f32));
        let Keys { keys, below } = steps.keys(now as i32, item.key as i32, limit as i32);
        self.rows::<L>(item, keys, below)
    }

    /// Expands an item that is not a pair of triangles: wanted are the pairs that are not proven apart over the span. Keys are
    /// zero.
    #[inline(always)]
    pub(crate) fn expand_over_span<L: Lanes>(&self, item: &Item, frames: &[SpanFrame<'_, L>; 2]) -> Rows {
        let side = item.side();
        let wide = &self.nodes[side][item.node() as usize];
        let single = NodeBox::new(self.nodes[1 - side], item.boxes[1 - side]);
        let apart = apart_over_span::<L>(&frames[side], &self.scales[side], single, wide);
        self.rows::<L>(item, [0; WIDTH], !apart)
    }

    /// Bits of the pairs below an item that are apart over the span along the direction.
    #[inline(always)]
    pub(crate) fn apart_along<L: Lanes>(&self, item: &Item, span: &DirectedSpan<'_, L>) -> u32 {
        let side = item.side();
        let wide = &self.nodes[side][item.node() as usize];
        let single = NodeBox::new(self.nodes[1 - side], item.boxes[1 - side]);
        apart_along_over_span::<L>(
            &span.frames[side],
            &span.directions[side],
            &self.scales[side],
            single,
            wide,
        )
    }

    /// The pairs below an item, with these keys; `wanted` among the lanes that are used.
    #[inline(always)]
    fn rows<L: Lanes>(&self, item: &Item, keys: [i32; WIDTH], wanted: u32) -> Rows {
        let (wide_index, side) = (item.node(), item.side());
        let other = 1 - side;
        let single = item.boxes[other];
        let wide = &self.nodes[side][wide_index as usize];
        let NodeBox { node, lane } = NodeBox::new(self.nodes[other], single);
        let flags = [0, Item::OF_B];
        let size = node.size(lane) * self.size_ratios[other];
        let sizes = wide.wide_sizes::<L>() * L::splat(self.size_ratios[side]);
        let tags = sizes.larger(
            WideSide { children: &wide.child, flag: flags[side] },
            SingleSide { size, tag: node.child[lane] | flags[other] },
        );
        Rows {
            keys,
            counting: wide_index * WIDTH as u32,
            constant: single,
            counting_is_third: side == 1,
            tags,
            wanted: wanted & ((1 << wide.used) - 1),
        }
    }
}
