//! Opening a pair of boxes: a box of one body against the eight boxes of a node of the other.

use super::lanes::Lanes;
use super::node_test::{NodeFrame, NodeScale, Placed, entry_times};
use super::queue::Item;
use crate::tree::node::{WIDTH, WideNode};

/// Keys of a window run from 0 to this for its whole unit of time.
pub(crate) const KEY_SCALE: f64 = 536_870_912.0; // 2²⁹

/// Where the box of A and that of B are in a pair of boxes in one word.
const SHIFT: [u32; 2] = [0, 32];

/// What the expansions of one frame share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Opening<'a> {
    /// Wide nodes of A and of B.
    pub(crate) nodes: [&'a [WideNode]; 2],
    /// Constants when nodes of A, of B, are opened.
    pub(crate) scales: [NodeScale; 2],
    /// Sizes of A's boxes are multiplied by the first, those of B's by the second, before they are compared: between
    /// [`LEAST_SIZE`](crate::tree::node::LEAST_SIZE) and its inverse.
    pub(crate) size_ratios: [f32; 2],
}

/// The pairs below an opened one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expansion {
    /// Until when the pairs are proven apart.
    keys: [i32; WIDTH],
    /// What is to be done with them: see [`Item::open`].
    open: [u32; WIDTH],
    /// Bit i is set when pair i is worth queueing.
    bits: u32,
    /// The boxes of the first pair: see [`SHIFT`].
    boxes: u64,
    /// What is added to them from one pair to the next: the boxes of the node that was opened follow each other.
    step: u64,
}

impl Opening<'_> {
    /// What is to be done with a pair of boxes: the larger one is opened. A triangle has no size, so it is never the larger.
    pub(crate) fn of_pair(&self, a: u32, b: u32) -> u32 {
        let (na, nb) = (&self.nodes[0][a as usize / WIDTH], &self.nodes[1][b as usize / WIDTH]);
        let (la, lb) = (a as usize % WIDTH, b as usize % WIDTH);
        let larger = na.size[la] * self.size_ratios[0] > nb.size[lb] * self.size_ratios[1];
        if larger { na.child[la] } else { nb.child[lb] | Item::OF_B }
    }

    /// Opens an item that is not a pair of triangles. Keys count from `now`, the key of the frame; pairs whose key is not below
    /// `limit` are not worth queueing.
    #[inline(always)]
    pub(crate) fn expand<L: Lanes>(
        &self,
        item: &Item,
        frames: &[NodeFrame; 2],
        (now, limit): (u32, u32),
    ) -> Expansion {
        let wide_index = item.open & !Item::OF_B;
        let side = (item.open >> Item::OF_B.trailing_zeros()) as usize & 1;
        let other = 1 - side;
        let single = item.boxes[other];
        let wide = &self.nodes[side][wide_index as usize];
        let (node, lane) = (&self.nodes[other][single as usize / WIDTH], single as usize % WIDTH);
        let scale = &self.scales[side];
        let placed = Placed::new::<L>(&frames[side], scale, (node, lane), wide);
        let times = entry_times::<L>(wide, &placed, scale);
        // What is not a number becomes the key of the item itself.
        let steps = L::splat(1.25 * KEY_SCALE as f32).min(times * L::splat(KEY_SCALE as f32));
        let (keys, below) = steps.keys(now as i32, item.key as i32, limit as i32);
        let flags = [0, Item::OF_B];
        let size = node.size[lane] * self.size_ratios[other];
        let open = L::larger(
            (&wide.size, self.size_ratios[side], size),
            (&wide.child, flags[side]),
            node.child[lane] | flags[other],
        );
        let bits = below & ((1 << wide.used) - 1);
        let first = u64::from(wide_index) * WIDTH as u64;
        Expansion {
            keys,
            open,
            bits,
            boxes: (first << SHIFT[side]) | (u64::from(single) << SHIFT[other]),
            step: 1 << SHIFT[side],
        }
    }
}

impl Expansion {
    /// Appends the pairs worth queueing. Without a branch: which lanes they are cannot be predicted.
    #[inline(always)]
    pub(crate) fn append_to(&self, list: &mut [Item], count: &mut usize) {
        let mut boxes = self.boxes;
        for lane in 0..WIDTH {
            list[*count] = Item {
                key: self.keys[lane] as u32,
                boxes: [(boxes >> SHIFT[0]) as u32, (boxes >> SHIFT[1]) as u32],
                open: self.open[lane],
            };
            boxes += self.step;
            *count += (self.bits >> lane) as usize & 1;
        }
    }
}
