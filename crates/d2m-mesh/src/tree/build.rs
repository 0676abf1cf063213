//! Construction: parts are split by count from the top, eight to a node, and their boxes are fitted from the leaves upwards.
//!
//! Nodes are numbered in the order of a walk from the root, lane by lane; where each of them lies follows from the number of
//! triangles alone. Large parts are built side by side, each into its own run of the nodes: the tree has the same bits at
//! any number of threads.

use super::bottom_up::{Fitting, Lanes, Place, Scratch, Subtree};
use super::fit::Moments;
use super::node::{Below, WIDTH, WideNode};
use super::plan::{Cut, NodeCounts, Plan};
use super::split::{PartAxes, Splitter};
use super::surface::{Extent, Surface};
use crate::TriMesh;
use crate::parallel::{MANY, both, map_in_order};
use core::sync::atomic::{AtomicUsize, Ordering};

/// Triangles that a tree can number.
pub(super) const MOST_TRIANGLES: usize = 1 << 29;
/// Parts of at most this many triangles are built by one thread, and reported when done.
const GRAIN: usize = 4096;
/// Of parts of at most this many triangles all are examined, of larger ones a sample.
const TAKEN: usize = 512;

/// Receives the progress of the construction: triangles done, and all.
pub(super) type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

struct Builder<'a> {
    surface: &'a Surface<'a>,
    fitting: Fitting<'a>,
    counts: NodeCounts,
    total: usize,
    done: AtomicUsize,
    progress: Option<Progress<'a>>,
}

/// The boxes of a tree, and where they lie.
pub(super) struct Built {
    pub(super) nodes: Vec<WideNode>,
    pub(super) extent: Extent,
}

/// Triangles that become one box: numbers in the mesh, or places among those that a splitter has taken.
struct Part<'o> {
    order: &'o mut [u32],
    axes: PartAxes,
}

/// A part on the way to be divided into lanes of a node, and the nodes below it.
struct Share<'o, 'n> {
    part: Part<'o>,
    nodes: &'n mut [WideNode],
    /// The number of the first of these nodes.
    first: u32,
    /// The number of the box that the first of the lanes is.
    box_number: u32,
}

/// What the numbers in a part count.
#[derive(Clone, Copy, PartialEq)]
enum Numbers {
    /// Triangles of the mesh.
    OfMesh,
    /// Those that the splitter has taken.
    Taken,
}

/// Builds the boxes.
pub(super) fn build(mesh: &TriMesh, progress: Option<Progress<'_>>) -> Built {
    let total = mesh.triangle_count();
    assert!(total <= MOST_TRIANGLES, "more triangles than a tree can number");
    let extent = Extent::of(mesh);
    let surface = Surface::with_sums(mesh, &extent);
    let counts = NodeCounts::new(total);
    let places = vec![(); 1 + counts.of(total)];
    let mut nodes = map_in_order(&places, MANY, |()| WideNode::empty([0.0; 3], 0));
    let mut order: Vec<u32> = (0..total as u32).collect();
    let mut splitter = Splitter::default();
    splitter.take(&surface, order.iter().step_by(total.div_ceil(TAKEN)));
    let axes = splitter.axes();
    let fitting = Fitting::new(&surface);
    let builder = Builder { surface: &surface, fitting, counts, total, done: AtomicUsize::new(0), progress };
    let (root, rest) = nodes.split_at_mut(1);
    let part = Part { order: &mut order, axes };
    let subtree = builder.subtree(part, rest, Place { node: 1, parent: 0 });
    builder.fitting.root(&subtree, &mut root[0]);
    Built { nodes, extent }
}

impl Builder<'_> {
    fn report(&self, count: usize) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        if let Some(progress) = self.progress {
            progress(done, self.total);
        }
    }

    /// What is below a box: a triangle, or the first of these nodes.
    fn subtree(&self, part: Part<'_>, nodes: &mut [WideNode], place: Place) -> Subtree {
        let count = part.order.len();
        if count > GRAIN {
            let (node, below) = nodes.split_at_mut(1);
            let share =
                Share { part, nodes: below, first: place.node + 1, box_number: place.node * WIDTH as u32 };
            let subtrees = self.divided(&Plan::new(count), Some(0), share);
            return self.fitting.node_above(subtrees, place, &mut node[0]);
        }
        let subtree = self.fitting.subtree(|scratch| self.lane(part, nodes, place, Numbers::OfMesh, scratch));
        self.report(count);
        subtree
    }

    /// The lanes of a node that many triangles are below, in order.
    fn divided(&self, plan: &Plan, cut: Option<u8>, share: Share<'_, '_>) -> Vec<Subtree> {
        let Some(cut) = plan.cut(cut) else {
            let place = Place { node: share.first, parent: share.box_number };
            return vec![self.subtree(share.part, share.nodes, place)];
        };
        let scratch = |scratch: &mut Scratch| self.halves(plan, cut, share, Numbers::OfMesh, scratch);
        let [first, second] = self.fitting.with_scratch(scratch);
        let (mut subtrees, rest) =
            both(|| self.divided(plan, cut.after[0], first), || self.divided(plan, cut.after[1], second));
        subtrees.extend(rest);
        subtrees
    }

    /// A lane of a node: what is below it, with all nodes there.
    fn lane(
        &self,
        part: Part<'_>,
        nodes: &mut [WideNode],
        place: Place,
        mut numbers: Numbers,
        scratch: &mut Scratch,
    ) -> (Below, Moments) {
        let Part { order, axes } = part;
        if order.len() <= TAKEN && numbers == Numbers::OfMesh && order.len() > WIDTH {
            scratch.splitter.take(self.surface, order.iter());
            for (number, slot) in (0..).zip(order.iter_mut()) {
                *slot = number;
            }
            numbers = Numbers::Taken;
        }
        let triangle = |number: u32, scratch: &Scratch| match numbers {
            Numbers::OfMesh => number,
            Numbers::Taken => scratch.splitter.triangle(number),
        };
        if let &mut [number] = order {
            let triangle = triangle(number, scratch);
            return self.fitting.triangle(triangle, scratch);
        }
        let mut lanes = Lanes::new(scratch);
        let (node, below) = nodes.split_at_mut(1);
        if order.len() <= WIDTH {
            for &number in order.iter() {
                let (below, moments) = self.fitting.triangle(triangle(number, scratch), scratch);
                lanes.add(below, moments, scratch);
            }
        } else {
            let plan = Plan::new(order.len());
            let box_number = place.node * WIDTH as u32;
            let share = Share { part: Part { order, axes }, nodes: below, first: place.node + 1, box_number };
            self.lanes(&plan, Some(0), share, numbers, &mut lanes, scratch);
        }
        let moments = self.fitting.node(&mut lanes, place.parent, &mut node[0], scratch);
        (Below::Node(place.node), moments)
    }

    /// The lanes of a node, one after the other.
    fn lanes(
        &self,
        plan: &Plan,
        cut: Option<u8>,
        share: Share<'_, '_>,
        numbers: Numbers,
        lanes: &mut Lanes,
        scratch: &mut Scratch,
    ) {
        if let Some(cut) = plan.cut(cut) {
            let [first, second] = self.halves(plan, cut, share, numbers, scratch);
            self.lanes(plan, cut.after[0], first, numbers, lanes, scratch);
            self.lanes(plan, cut.after[1], second, numbers, lanes, scratch);
        } else {
            let place = Place { node: share.first, parent: share.box_number };
            let (below, moments) = self.lane(share.part, share.nodes, place, numbers, scratch);
            lanes.add(below, moments, scratch);
        }
    }

    /// Cuts a part in two, and the nodes below it.
    fn halves<'o, 'n>(
        &self,
        plan: &Plan,
        cut: Cut,
        share: Share<'o, 'n>,
        numbers: Numbers,
        scratch: &mut Scratch,
    ) -> [Share<'o, 'n>; 2] {
        let Share { part: Part { order, axes }, nodes, first, box_number } = share;
        let [a, b] = match numbers {
            Numbers::OfMesh => scratch.splitter.split(self.surface, order, &axes, cut.half),
            Numbers::Taken => scratch.splitter.split_taken(order, &axes, cut.half),
        };
        let (mut lanes, mut below) = (0, 0);
        plan.for_each_part(cut.after[0], cut.half, &mut |count| {
            lanes += 1;
            below += self.counts.of(count);
        });
        let (low, high) = order.split_at_mut(cut.half);
        let (nodes_low, nodes_high) = nodes.split_at_mut(below);
        [
            Share { part: Part { order: low, axes: a }, nodes: nodes_low, first, box_number },
            Share {
                part: Part { order: high, axes: b },
                nodes: nodes_high,
                first: first + below as u32,
                box_number: box_number + lanes,
            },
        ]
    }
}
