//! Construction from the top: split by count, eight boxes a node.
//!
//! Nodes are numbered in the order of a walk from the root, lane by lane. Large parts are built side by side, each
//! into its own list, and the lists are joined in that order: the tree has the same bits at any number of threads.

use super::node::{Below, OrientedBox, WIDTH, WideNode};
use super::split::Splitter;
use super::surface::{Extent, SizedBox, Surface};
use crate::TriMesh;
use core::sync::atomic::{AtomicUsize, Ordering};

/// Triangles that a tree can number.
pub(super) const MOST_TRIANGLES: usize = 1 << 29;
/// Parts of at most this many triangles are built by one thread, and reported when done.
const GRAIN: usize = 4096;

/// Receives the progress of the construction: triangles done, and all.
pub(super) type Progress<'a> = &'a (dyn Fn(usize, usize) + Sync);

struct Builder<'a> {
    surface: Surface<'a>,
    total: usize,
    done: AtomicUsize,
    progress: Option<Progress<'a>>,
}

/// Triangles that become one box.
struct Part<'o> {
    order: &'o mut [u32],
    axes: [[f64; 3]; 3],
}

/// What is above a node: the origin of the box above, and that box.
struct Above {
    boxed: OrientedBox,
    origin: [f32; 3],
    parent: u32,
}

/// The boxes of a tree, and where they lie.
pub(super) struct Built {
    pub(super) nodes: Vec<WideNode>,
    pub(super) extent: Extent,
}

/// Builds the boxes.
pub(super) fn build(mesh: &TriMesh, progress: Option<Progress<'_>>) -> Built {
    let total = mesh.triangle_count();
    assert!(total <= MOST_TRIANGLES, "more triangles than a tree can number");
    let extent = Extent::of(mesh);
    let builder =
        Builder { surface: Surface::new(mesh, &extent), total, done: AtomicUsize::new(0), progress };
    let mut order: Vec<u32> = (0..total as u32).collect();
    let axes = builder.surface.axes(&order);
    let mut root = WideNode::empty([0.0; 3], 0);
    let SizedBox { boxed, size } = builder.surface.enclose(&order, &axes, [0.0; 3]);
    root.set_box(0, &boxed, if total == 1 { 0.0 } else { size });
    root.used = 1;
    let mut nodes = Vec::with_capacity(total / 6 + 2);
    nodes.push(root);
    let above = Above { boxed, origin: [0.0; 3], parent: 0 };
    let below = builder.below(Part { order: &mut order, axes }, &above, &mut nodes, &mut Splitter::default());
    nodes[0].set_below(0, below);
    if total <= GRAIN {
        builder.report(total);
    }
    nodes.shrink_to_fit();
    Built { nodes, extent }
}

impl Builder<'_> {
    fn report(&self, count: usize) {
        let done = self.done.fetch_add(count, Ordering::Relaxed) + count;
        if let Some(progress) = self.progress {
            progress(done, self.total);
        }
    }

    /// Splits a part in two, the first with a multiple of `step` triangles.
    fn split<'o>(&self, part: Part<'o>, step: usize, splitter: &mut Splitter) -> (Part<'o>, Part<'o>) {
        let Part { order, axes } = part;
        let half = ((order.len() + step) / (2 * step)).max(1) * step;
        let [a, b] = splitter.split(&self.surface, order, &axes, half);
        let (first, second) = order.split_at_mut(half);
        (Part { order: first, axes: a }, Part { order: second, axes: b })
    }

    /// The up to eight parts of a part.
    fn divide<'o>(&self, part: Part<'o>, splitter: &mut Splitter) -> Vec<Part<'o>> {
        if part.order.len() <= WIDTH {
            let singles = part.order.chunks_mut(1);
            return singles.map(|order| Part { axes: self.surface.axes(order), order }).collect();
        }
        // What a part may hold so that all nodes but the topmost of it are full.
        let mut full = WIDTH;
        while full * WIDTH < part.order.len() {
            full *= WIDTH;
        }
        let step = full.min(WIDTH * WIDTH);
        let mut parts = Vec::with_capacity(WIDTH);
        parts.push(part);
        while parts.len() < WIDTH {
            let count = |i: usize| parts[i].order.len();
            let largest = (0..parts.len()).max_by_key(|&i| (count(i), usize::MAX - i)).unwrap_or(0);
            if count(largest) <= full {
                break;
            }
            let (first, second) = self.split(parts.swap_remove(largest), step, splitter);
            parts.push(first);
            parts.push(second);
        }
        parts
    }

    /// Makes what is below a box: the triangle itself, or a node with up to eight parts, appended to `nodes`.
    fn below(
        &self,
        part: Part<'_>,
        above: &Above,
        nodes: &mut Vec<WideNode>,
        splitter: &mut Splitter,
    ) -> Below {
        if let &mut [triangle] = part.order {
            return Below::Triangle(triangle);
        }
        let is_large = part.order.len() > GRAIN;
        let parts = self.divide(part, splitter);
        let origin = [0, 1, 2].map(|k| above.origin[k] + above.boxed.center[k]);
        let index = nodes.len();
        let mut node = WideNode::empty(origin, above.parent);
        node.used = parts.len() as u32;
        let mut children = Vec::with_capacity(WIDTH);
        for (lane, part) in parts.into_iter().enumerate() {
            let SizedBox { boxed, size } = self.surface.enclose(part.order, &part.axes, origin);
            node.set_box(lane, &boxed, if part.order.len() == 1 { 0.0 } else { size });
            let parent = (index * WIDTH + lane) as u32;
            children.push((part, Above { boxed, origin, parent }));
        }
        nodes.push(node);
        if is_large {
            for (lane, (below, mut subtree)) in self.build_in_parallel(children).into_iter().enumerate() {
                let base = nodes.len();
                for (i, node) in subtree.iter_mut().enumerate() {
                    node.shift(base as u32, i == 0);
                }
                nodes[index].set_below(lane, below.shifted(base as u32));
                nodes.append(&mut subtree);
            }
        } else {
            for (lane, (part, above)) in children.into_iter().enumerate() {
                let below = self.below(part, &above, nodes, splitter);
                nodes[index].set_below(lane, below);
            }
        }
        Below::Node(index as u32)
    }

    /// Builds what is below each box into a list of its own, whose numbers count from zero.
    fn build_in_parallel(&self, children: Vec<(Part<'_>, Above)>) -> Vec<(Below, Vec<WideNode>)> {
        let one = |(part, above): (Part<'_>, Above)| {
            let count = part.order.len();
            let mut nodes = Vec::with_capacity(count / 6 + 2);
            let below = self.below(part, &above, &mut nodes, &mut Splitter::default());
            if count <= GRAIN {
                self.report(count);
            }
            (below, nodes)
        };
        #[cfg(feature = "rayon")]
        {
            use rayon::iter::{IntoParallelIterator, ParallelIterator};
            children.into_par_iter().map(one).collect()
        }
        #[cfg(not(feature = "rayon"))]
        children.into_iter().map(one).collect()
    }
}
