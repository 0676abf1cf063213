//! Into how many parts a part is divided, and where: it follows from the number of triangles alone, so that all nodes but the
//! topmost of a tree are full and the place of each node is known before any is built.

use super::node::WIDTH;
use std::collections::HashMap;

/// One cut in two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    /// Triangles in the first half.
    pub(super) half: usize,
    /// Cuts of the two halves; the first cut is none of them.
    pub(super) after: [Option<u8>; 2],
}

/// How a part of more than [`WIDTH`] triangles is divided.
#[derive(Clone, Debug)]
pub(super) struct Plan {
    cuts: [Cut; WIDTH - 1],
    count: usize,
}

/// A part on the way to a plan.
#[derive(Clone, Copy)]
struct Piece {
    count: usize,
    /// Which half of which cut it is; none of the whole.
    half_of: Option<(usize, usize)>,
}

impl Plan {
    /// For this many triangles, more than [`WIDTH`].
    pub(super) fn new(count: usize) -> Self {
        // What a part may hold so that all nodes but the topmost of it are full.
        let mut full = WIDTH;
        while full * WIDTH < count {
            full *= WIDTH;
        }
        let step = full.min(WIDTH * WIDTH);
        let mut plan = Self { cuts: [Cut { half: 0, after: [None; 2] }; WIDTH - 1], count: 0 };
        let mut pieces = [Piece { count, half_of: None }; WIDTH];
        for used in 1..WIDTH {
            // The first one of the largest.
            let mut largest = 0;
            for i in 1..used {
                largest = if pieces[i].count > pieces[largest].count { i } else { largest };
            }
            let Piece { count, half_of } = pieces[largest];
            if count <= full {
                break;
            }
            let half = ((count + step) / (2 * step)).max(1) * step;
            if let Some((cut, side)) = half_of {
                plan.cuts[cut].after[side] = Some(plan.count as u8);
            }
            plan.cuts[plan.count].half = half;
            pieces[largest] = Piece { count: half, half_of: Some((plan.count, 0)) };
            pieces[used] = Piece { count: count - half, half_of: Some((plan.count, 1)) };
            plan.count += 1;
        }
        plan
    }

    /// The first cut, or one that a cut names.
    pub(super) const fn cut(&self, number: Option<u8>) -> Option<Cut> {
        match number {
            None => None,
            Some(number) => Some(self.cuts[number as usize]),
        }
    }

    /// The sizes of the parts, in order, that a cut and those after it make of so many triangles.
    pub(super) fn for_each_part(&self, cut: Option<u8>, count: usize, each: &mut impl FnMut(usize)) {
        match self.cut(cut) {
            None => each(count),
            Some(cut) => {
                self.for_each_part(cut.after[0], cut.half, each);
                self.for_each_part(cut.after[1], count - cut.half, each);
            }
        }
    }
}

/// How many nodes are below boxes, by their triangles.
#[derive(Default)]
pub(super) struct NodeCounts {
    counts: HashMap<usize, usize>,
}

impl NodeCounts {
    /// Of a tree of so many triangles, and of all its parts.
    pub(super) fn new(total: usize) -> Self {
        let mut counts = Self::default();
        counts.add(total);
        counts
    }

    fn add(&mut self, count: usize) -> usize {
        if count <= WIDTH {
            return usize::from(count > 1);
        }
        if let Some(&nodes) = self.counts.get(&count) {
            return nodes;
        }
        let mut nodes = 1;
        Plan::new(count).for_each_part(Some(0), count, &mut |part| nodes += self.add(part));
        self.counts.insert(count, nodes);
        nodes
    }

    /// Nodes below a box with so many triangles, which is a part of the tree.
    pub(super) fn of(&self, count: usize) -> usize {
        if count <= WIDTH { usize::from(count > 1) } else { self.counts.get(&count).copied().unwrap_or(0) }
    }
}
