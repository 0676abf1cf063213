//! Boxes from the leaves upwards: what construction and refit share.
//!
//! A box is fitted to the vertices below it, each once: those that the boxes below have taken, without repetitions, and to
//! their moments, which are sums of the triangles'. So no box but a leaf ever visits a triangle.

use super::fit::Moments;
use super::node::{Below, WIDTH, WideNode};
use super::siblings::{Rows, Siblings};
use super::split::Splitter;
use super::surface::Surface;
use d2m_lanes::run;
use std::sync::{Mutex, PoisonError};

/// Where a node is among all nodes, and the box above it.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) node: u32,
    pub(super) parent: u32,
}

/// What a box needs to know of all that is below it.
pub(super) struct Subtree {
    pub(super) below: Below,
    pub(super) moments: Moments,
    /// Each vertex once; the corners of a triangle.
    pub(super) points: Vec<u32>,
}

/// The lanes of a node on the way: what is below each, and where its vertices are in the list of the taken ones.
pub(super) struct Lanes {
    below: [Below; WIDTH],
    moments: [Moments; WIDTH],
    ends: [usize; WIDTH + 1],
    used: usize,
}

/// Memory of one thread.
#[derive(Default)]
pub(super) struct Scratch {
    pub(super) splitter: Splitter,
    rows: Rows,
    /// Vertices below the boxes that are in work.
    taken: Vec<u32>,
    /// The last list that has each vertex.
    lists: Vec<u32>,
    list: u32,
}

impl Scratch {
    /// A number that no vertex of so many has.
    fn next_list(&mut self, vertices: usize) -> u32 {
        if self.lists.is_empty() {
            self.lists.resize(vertices, 0);
        }
        self.list += 1;
        self.list
    }
}

/// Fits the boxes of one tree.
pub(super) struct Fitting<'a> {
    surface: &'a Surface<'a>,
    /// Memory that no thread uses at the time.
    free: Mutex<Vec<Scratch>>,
}

impl<'a> Fitting<'a> {
    pub(super) const fn new(surface: &'a Surface<'a>) -> Self {
        Self { surface, free: Mutex::new(Vec::new()) }
    }

    /// Does some work with memory of its own.
    pub(super) fn with_scratch<R>(&self, work: impl FnOnce(&mut Scratch) -> R) -> R {
        let free = || self.free.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = free().pop();
        let mut scratch = kept.unwrap_or_default();
        let result = work(&mut scratch);
        free().push(scratch);
        result
    }

    /// A part of the tree with its vertices, by work that leaves the vertices in the list of the taken ones.
    pub(super) fn subtree(&self, work: impl FnOnce(&mut Scratch) -> (Below, Moments)) -> Subtree {
        self.with_scratch(|scratch| {
            scratch.taken.clear();
            let (below, moments) = work(scratch);
            Subtree { below, moments, points: scratch.taken.clone() }
        })
    }

    /// The topmost node: one box around all.
    pub(super) fn root(&self, tree: &Subtree, node: &mut WideNode) {
        self.with_scratch(|scratch| {
            run(Siblings {
                points: &self.surface.points,
                parts: &[&tree.points],
                below: &[tree.below],
                moments: &mut [tree.moments],
                origin: Some([0.0; 3]),
                parent: 0,
                rows: &mut scratch.rows,
                node,
            });
        });
    }

    /// What a lane with a triangle is; its moments are computed with its box.
    pub(super) fn triangle(&self, triangle: u32, scratch: &mut Scratch) -> (Below, Moments) {
        scratch.taken.extend(self.surface.triangles[triangle as usize]);
        (Below::Triangle(triangle), Moments::default())
    }

    /// Fits a node to these lanes; leaves each vertex below it once in the list of the taken ones. The moments of all.
    pub(super) fn node(
        &self,
        lanes: &mut Lanes,
        parent: u32,
        node: &mut WideNode,
        scratch: &mut Scratch,
    ) -> Moments {
        let Scratch { rows, taken, .. } = &mut *scratch;
        let mut parts: [&[u32]; WIDTH] = [&[]; WIDTH];
        for lane in 0..lanes.used {
            parts[lane] = &taken[lanes.ends[lane]..lanes.ends[lane + 1]];
        }
        let moments = run(Siblings {
            points: &self.surface.points,
            parts: &parts[..lanes.used],
            below: &lanes.below[..lanes.used],
            moments: &mut lanes.moments[..lanes.used],
            origin: None,
            parent,
            rows,
            node,
        });
        let list = scratch.next_list(self.surface.points.len());
        let Scratch { taken, lists, .. } = scratch;
        let start = lanes.ends[0];
        let mut kept = 0;
        let vertices = &mut taken[start..];
        for k in 0..vertices.len() {
            let vertex = vertices[k];
            vertices[kept] = vertex;
            let last = &mut lists[vertex as usize];
            kept += usize::from(*last != list);
            *last = list;
        }
        taken.truncate(start + kept);
        moments
    }

    /// The same of a node of which each lane is a triangle.
    pub(super) fn node_of_triangles(
        &self,
        triangles: &[u32],
        parent: u32,
        node: &mut WideNode,
        scratch: &mut Scratch,
    ) -> Moments {
        let mut parts: [&[u32]; WIDTH] = [&[]; WIDTH];
        let mut below = [Below::Triangle(0); WIDTH];
        for (lane, &triangle) in triangles.iter().enumerate() {
            parts[lane] = &self.surface.triangles[triangle as usize];
            below[lane] = Below::Triangle(triangle);
        }
        let parts = &parts[..triangles.len()];
        let moments = run(Siblings {
            points: &self.surface.points,
            parts,
            below: &below[..triangles.len()],
            // Those of triangles are computed with their boxes.
            moments: &mut [],
            origin: None,
            parent,
            rows: &mut scratch.rows,
            node,
        });
        let list = scratch.next_list(self.surface.points.len());
        let (mut vertices, mut kept) = ([0; 3 * WIDTH], 0);
        for &vertex in parts.iter().copied().flatten() {
            vertices[kept] = vertex;
            let last = &mut scratch.lists[vertex as usize];
            kept += usize::from(*last != list);
            *last = list;
        }
        scratch.taken.extend_from_slice(&vertices[..kept]);
        moments
    }

    /// The same from parts that have been made elsewhere.
    pub(super) fn node_above(&self, subtrees: Vec<Subtree>, place: Place, node: &mut WideNode) -> Subtree {
        self.subtree(|scratch| {
            let mut lanes = Lanes::new(scratch);
            for Subtree { below, moments, points } in subtrees {
                scratch.taken.extend(points);
                lanes.add(below, moments, scratch);
            }
            let moments = self.node(&mut lanes, place.parent, node, scratch);
            (Below::Node(place.node), moments)
        })
    }
}

impl Lanes {
    /// None so far.
    pub(super) const fn new(scratch: &Scratch) -> Self {
        Self {
            below: [Below::Node(0); WIDTH],
            moments: [Moments([0.0; Moments::LENGTH]); WIDTH],
            ends: [scratch.taken.len(); WIDTH + 1],
            used: 0,
        }
    }

    /// Adds a lane whose vertices are those that have been taken since the last one.
    pub(super) fn add(&mut self, below: Below, moments: Moments, scratch: &Scratch) {
        (self.below[self.used], self.moments[self.used]) = (below, moments);
        self.used += 1;
        self.ends[self.used] = scratch.taken.len();
    }
}
