//! Does each box of a tree enclose the triangles below it?
//!
//! Box, sphere and slabs are convex: a triangle is within if its three corners are. Neighbouring triangles share vertices, so
//! a box takes each vertex below it once: from the leaves upwards, those that the boxes below have taken, without
//! repetitions. Of two million triangles seven levels of boxes would otherwise take 44 million corners; it is 14 million
//! points instead.

use super::node::{Below, OrientedBox, WIDTH, WideNode};
use super::surface::{Extent, Reach};
use super::tree_error::TreeError;
use crate::TriMesh;
use crate::parallel::map_in_order;
use d2m_lanes::{Lanes, Task, run};

/// Boxes above a triangle; a built tree of 2²⁹ triangles has at most 30.
const DEEPEST: usize = 64;
/// Nodes with so many corners below them are checked lane by lane in parallel: a corner takes some 20 nanoseconds, waking a
/// thread a few thousand.
const GRAIN: u32 = 1 << 16;

/// A corner of a triangle.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// The number of its vertex, in the order in which vertices are met.
    point: u32,
    /// One more than the number of the last corner before it at the same vertex; zero if it is the first one there.
    earlier: u32,
}

/// The corners of all triangles, numbered in the order in which a walk down from the root meets them: those below a box are
/// a range.
pub(super) struct TreeCorners {
    corners: Vec<Corner>,
    /// The vertices in local coordinates, in the order in which they are met.
    points: Vec<[f64; 3]>,
    /// The number of the first corner below each node.
    first: Vec<u32>,
    /// Where the range of each box ends, and that of the next one begins.
    ends: Vec<[u32; WIDTH]>,
}

/// What is known of a vertex of the mesh.
#[derive(Clone, Copy, Default)]
struct Met {
    point: u32,
    /// One more than the number of the last corner there; zero if there is none.
    last: u32,
}

impl TreeCorners {
    /// Walks down from the root. The nodes are linked, each at most once, and hold each triangle once; nodes in a cycle
    /// are below no root: they are not met.
    pub(super) fn of(nodes: &[WideNode], mesh: &TriMesh, extent: &Extent) -> Result<Self, TreeError> {
        let mut corners = Vec::with_capacity(3 * mesh.triangle_count());
        let mut points = Vec::with_capacity(mesh.vertex_count());
        let mut met = vec![Met::default(); mesh.vertex_count()];
        let mut first = vec![0; nodes.len()];
        let mut ends = vec![[0; WIDTH]; nodes.len()];
        let mut is_met = vec![false; nodes.len()];
        is_met[0] = true;
        // The nodes from the root to here, each with the next lane.
        let mut path = vec![(0, 0)];
        while let Some((index, lane)) = path.last_mut() {
            let (node, index, current) = (&nodes[*index], *index, *lane);
            if current > 0 {
                ends[index][current - 1] = corners.len() as u32;
            }
            if current >= node.used as usize {
                path.pop();
                continue;
            }
            *lane += 1;
            match node.below(current) {
                Below::Triangle(triangle) => {
                    for vertex in mesh.triangles()[triangle as usize] {
                        let met = &mut met[vertex as usize];
                        if met.last == 0 {
                            met.point = points.len() as u32;
                            points.push(extent.local(mesh.vertices()[vertex as usize]));
                        }
                        corners.push(Corner { point: met.point, earlier: met.last });
                        met.last = corners.len() as u32;
                    }
                }
                Below::Node(child) => {
                    let child = child as usize;
                    if path.len() > DEEPEST {
                        return Err(TreeError::Link { node: child });
                    }
                    first[child] = corners.len() as u32;
                    is_met[child] = true;
                    path.push((child, 0));
                }
            }
        }
        match is_met.iter().position(|&is| !is) {
            Some(node) => Err(TreeError::Link { node }),
            None => Ok(Self { corners, points, first, ends }),
        }
    }

    /// Where the range of corners below a box begins.
    fn start(&self, node: usize, lane: usize) -> u32 {
        if lane == 0 { self.first[node] } else { self.ends[node][lane - 1] }
    }

    /// How many corners are below a node.
    fn count(&self, node: usize, used: usize) -> u32 {
        self.ends[node][used - 1] - self.first[node]
    }
}

/// All that is needed to check the boxes.
pub(super) struct Enclosures<'a> {
    pub(super) nodes: &'a [WideNode],
    pub(super) tree: TreeCorners,
}

impl Enclosures<'_> {
    /// Checks all boxes of a node and of the nodes below it; adds to `taken` one corner of each vertex below each of its
    /// boxes. The first fault, the boxes below before those above.
    pub(super) fn check(&self, index: usize, taken: &mut Vec<Corner>) -> Result<(), TreeError> {
        let used = self.nodes[index].used as usize;
        if self.tree.count(index, used) < GRAIN {
            return (0..used).try_for_each(|lane| self.check_lane(index, lane, taken));
        }
        let lanes: Vec<usize> = (0..used).collect();
        let all = map_in_order(&lanes, 1, |&lane| {
            let mut taken = Vec::new();
            self.check_lane(index, lane, &mut taken).map(|()| taken)
        });
        all.into_iter().try_for_each(|lane| lane.map(|lane| taken.extend(lane)))
    }

    fn check_lane(&self, index: usize, lane: usize, taken: &mut Vec<Corner>) -> Result<(), TreeError> {
        let (start, before) = (self.tree.start(index, lane), taken.len());
        let corners = &self.tree.corners[start as usize..self.tree.ends[index][lane] as usize];
        match self.nodes[index].below(lane) {
            Below::Triangle(_) => taken.extend_from_slice(corners),
            Below::Node(child) => {
                self.check(child as usize, taken)?;
                // Without those whose vertex has another corner before in the range of this box.
                let mut kept = before;
                for k in before..taken.len() {
                    let corner = taken[k];
                    taken[kept] = corner;
                    kept += usize::from(corner.earlier <= start);
                }
                taken.truncate(kept);
            }
        }
        if self.encloses(index, lane, &taken[before..]) {
            return Ok(());
        }
        // All points at once have a greater error than those of one triangle: what is no proof for all may be one for each.
        match corners.chunks(3).position(|corners| !self.encloses(index, lane, corners)) {
            None => Ok(()),
            Some(place) => {
                let triangle = self.triangle(index, lane, start + 3 * place as u32);
                Err(TreeError::Enclosure { node: index, lane, triangle })
            }
        }
    }

    /// Are these corners proven to be inside the box and its sphere? The same arithmetic as at construction.
    fn encloses(&self, index: usize, lane: usize, corners: &[Corner]) -> bool {
        let node = &self.nodes[index];
        let boxed = node.oriented_box(lane);
        run(Enclosure { node, boxed: &boxed, corners, points: &self.tree.points })
    }

    /// The triangle with this first corner, below this box.
    fn triangle(&self, mut index: usize, mut lane: usize, corner: u32) -> usize {
        loop {
            match self.nodes[index].below(lane) {
                Below::Triangle(triangle) => return triangle as usize,
                Below::Node(child) => index = child as usize,
            }
            lane = self.tree.ends[index].iter().position(|&end| corner < end).unwrap_or(0);
        }
    }
}

/// Some corners and a box.
struct Enclosure<'a> {
    node: &'a WideNode,
    boxed: &'a OrientedBox,
    corners: &'a [Corner],
    points: &'a [[f64; 3]],
}

impl Task for Enclosure<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Lanes>(self) -> bool {
        let half = self.boxed.half_extent;
        let about = [f64::from(half[0]), f64::from(half[1]), f64::from(half[2])];
        let mut reach = Reach::new(self.node.origin, self.boxed.center, &self.boxed.axes, about);
        for corner in self.corners {
            reach.add(&self.points[corner.point as usize]);
        }
        reach.is_within(self.boxed)
    }
}
