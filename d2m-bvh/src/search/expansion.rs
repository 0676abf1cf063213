//! Opening a pair of boxes: a box of one body against the eight boxes of a node of the other.

use super::lanes::Lanes;
use super::node_test::{NodeFrame, NodeScale, Placed, entry_times};
use super::queue::Item;
use crate::tree::node::{LEAF, WIDTH, WideNode};

/// Keys of a window run from 0 to this for its whole unit of time.
pub(crate) const KEY_SCALE: f64 = 536_870_912.0; // 2²⁹

/// What the expansions of one frame share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Opening<'a> {
    /// Wide nodes of A and of B.
    pub(crate) nodes: [&'a [WideNode]; 2],
    /// Constants when nodes of A, of B, are opened.
    pub(crate) scales: [NodeScale; 2],
    /// Sizes of A's boxes are multiplied by the first, those of B's by the second, before they are compared.
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
    /// The first box of the node that was opened, and whose it is: 0 for A, 1 for B.
    first: u32,
    side: usize,
    /// The box of the other body.
    single: u32,
}

impl Opening<'_> {
    /// What is to be done with a pair of boxes: the larger one is opened.
    pub(crate) fn of_pair(&self, a: u32, b: u32) -> u32 {
        let (na, nb) = (&self.nodes[0][a as usize / WIDTH], &self.nodes[1][b as usize / WIDTH]);
        let (la, lb) = (a as usize % WIDTH, b as usize % WIDTH);
        let (child_a, child_b) = (na.child[la], nb.child[lb]);
        let larger = na.size[la] * self.size_ratios[0] > nb.size[lb] * self.size_ratios[1];
        if opens_first(child_a, child_b, larger) { child_a } else { child_b | Item::OF_B }
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
        let side = usize::from(item.open != wide_index);
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
        let (size, child) = (node.size[lane] * self.size_ratios[other], node.child[lane]);
        let mut open = [0; WIDTH];
        for (lane, open) in open.iter_mut().enumerate() {
            let larger = wide.size[lane] * self.size_ratios[side] > size;
            let first = opens_first(wide.child[lane], child, larger);
            *open = if first { wide.child[lane] | flags[side] } else { child | flags[other] };
        }
        let bits = below & ((1 << wide.used) - 1);
        Expansion { keys, open, bits, first: wide_index * WIDTH as u32, side, single }
    }
}

/// Of two boxes with these children, the first is opened: a box with a node below it, the larger one of two.
#[inline(always)]
fn opens_first(first: u32, second: u32, first_is_larger: bool) -> bool {
    let is_node = |child: u32| child & LEAF == 0;
    if is_node(second) { is_node(first) && first_is_larger } else { is_node(first) }
}

impl Expansion {
    /// Appends the pairs worth queueing. Without a branch: which lanes they are cannot be predicted.
    #[inline(always)]
    pub(crate) fn append_to(&self, list: &mut [Item], count: &mut usize) {
        let flip = |mine: u32| if self.side == 0 { [mine, self.single] } else { [self.single, mine] };
        for lane in 0..WIDTH {
            list[*count] = Item {
                key: self.keys[lane] as u32,
                boxes: flip(self.first + lane as u32),
                open: self.open[lane],
            };
            *count += (self.bits >> lane) as usize & 1;
        }
    }
}
