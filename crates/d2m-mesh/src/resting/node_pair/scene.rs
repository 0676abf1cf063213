//! Constants of one static query, and what its searches do at a pair of boxes.

use super::node_test::{lower_bounds, overlaps};
use super::placed_box::{Placed, Side};
use super::{InversePose, RelativePose};
use crate::margin::{UNIT_F32, UNIT_F64};
use crate::tree::node::{Below, OrientedBox, WIDTH};
use crate::tree::slabs::reach_both_ways;
use crate::{MeshTree, Posed, QueryError};
use d2m_lanes::{Lanes, power_of_two, power_of_two_above};
use glam::DVec3;

/// Sums and products of up to ten non-negative terms round by 2⁻⁵³ each; 2⁻⁴⁰ covers them all.
const SUM_ROUNDING: f64 = 1.0 + 1.0 / 1_099_511_627_776.0;

/// A body whose radius is below this part of the size is one point up to rounding.
const POINT_LIKE: f64 = 4.0 * UNIT_F64;

/// Two bodies at rest, in the frame of B's tree. Working coordinates are divided by a power of two so that all lengths
/// are at most one.
#[derive(Debug)]
pub(crate) struct RestingScene<'a> {
    pub(crate) trees: [&'a MeshTree; 2],
    pub(crate) pose: RelativePose,
    /// The working unit.
    pub(crate) unit: f64,
    inverse_unit: f64,
    /// Twice the bound on the distance between where triangles are placed and where they are, both bodies together,
    /// working units. Triangles placed further apart than this are apart.
    pub(crate) error: f64,
    /// The same with the rounding of a projected gap: per unit length of the direction.
    pub(crate) need: f64,
    /// Bound on the rounding of a projected gap alone.
    pub(crate) projection: f64,
    offset: DVec3,
    sides: [Side; 2],
    /// What makes sizes of boxes of the two bodies comparable.
    volume: [f64; 2],
    point_like: [bool; 2],
}

/// A box that may be expanded.
struct Candidate {
    size: f64,
    below: Below,
}

/// What there is to do at a pair of boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Step {
    /// Expand the node below the box of the body `wide`.
    Expand { wide: usize, node: u32 },
    /// Compare two triangles.
    Compare([u32; 2]),
}

/// A direction of length at most one, in the axes of A and of B.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Direction {
    axes: [DVec3; 2],
    narrow: [[f32; 3]; 2],
}

/// Directions besides the axes of boxes along which a triangle's distance from boxes is bounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Directions {
    Usual,
    /// Also those across the triangle's longest edge and the longest axis of a box: where slivers lie crosswise, no other
    /// separates them.
    OfEdges,
}

/// What is wanted of the distances of boxes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'a> {
    /// A direction that is tried besides those of the boxes.
    pub(crate) along: &'a Direction,
    /// Bounds above this, in working units, need not be close.
    pub(crate) enough: f32,
    pub(crate) directions: Directions,
}

/// Lower bounds on the distances of the boxes of one node.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeBounds {
    lanes: [f32; WIDTH],
    used: usize,
}

impl NodeBounds {
    /// Of each lane that holds a box. What is not a number bounds nothing.
    pub(crate) fn used(&self) -> &[f32] {
        &self.lanes[..self.used]
    }
}

impl<'a> RestingScene<'a> {
    pub(crate) fn try_new(a: Posed<'a>, b: Posed<'a>) -> Result<Self, QueryError> {
        let pose = RelativePose::try_new(a, b)?;
        let trees = [a.body, b.body];
        let unit = power_of_two_above(pose.size.max(LEAST_UNIT));
        let inverse_unit = 1.0 / unit;
        let size = pose.size * inverse_unit;
        let point_like = trees.map(|tree| tree.radius() <= POINT_LIKE * pose.size);
        // All triangles of a point-like body stand for one: it may be off by the diameter.
        let blur: f64 =
            trees.iter().zip(point_like).map(|(t, p)| if p { 2.0 * t.radius() } else { 0.0 }).sum();
        // Placing rounds by at most 9v(ρA + |T|) on A's side and 2v ρB on B's.
        let error = 2.0 * ((pose.error + blur) * inverse_unit + 10.0 * UNIT_F64 * size) * SUM_ROUNDING;
        let projection = 8.0 * UNIT_F64 * size * SUM_ROUNDING;
        let InversePose { rotation: inverse, offset: back } = pose.inverse();
        let side = |wide: &MeshTree, single: &MeshTree, rotation, offset: DVec3| Side {
            rotation,
            offset: offset / wide.unit(),
            ratio: single.unit() / wide.unit(),
            floor: 2.0 * error * (unit / wide.unit()) + power_of_two(-60),
            to_work: (wide.unit() * inverse_unit) as f32,
        };
        let cube = |x: f64| x * x * x;
        Ok(Self {
            trees,
            pose,
            unit,
            inverse_unit,
            error,
            need: (error + projection) * SUM_ROUNDING,
            projection,
            offset: pose.offset * inverse_unit,
            sides: [side(a.body, b.body, inverse, back), side(b.body, a.body, pose.rotation, pose.offset)],
            volume: trees.map(|tree| cube(tree.unit() * inverse_unit)),
            point_like,
        })
    }

    /// Of bodies whose vertices may be so far, both together, from where the poses place them.
    pub(crate) fn try_blurred(a: Posed<'a>, b: Posed<'a>, blur: f64) -> Result<Self, QueryError> {
        let scene = Self::try_new(a, b)?;
        let more = blur / scene.unit;
        // What is no number may be any.
        let more = if more.is_nan() { f64::INFINITY } else { more };
        Ok(if more > 0.0 { scene.reaching(more) } else { scene })
    }

    /// The same for vertices that are off by so much more, or pairs that are so much further apart: working units.
    pub(crate) fn reaching(mut self, more: f64) -> Self {
        // The sum is rounded once, and the error has room for that.
        self.error = (self.error + 2.0 * more) * SUM_ROUNDING;
        self.need = (self.error + self.projection) * SUM_ROUNDING;
        for (side, tree) in self.sides.iter_mut().zip(self.trees) {
            side.floor = 2.0 * self.error * (self.unit / tree.unit()) + power_of_two(-60);
        }
        self
    }

    /// Is the body one point up to rounding? Its first triangle then stands for all of them.
    pub(crate) fn is_point_like(&self, body: usize) -> bool {
        self.point_like[body]
    }

    /// Corners of a triangle in working coordinates.
    #[inline(always)]
    pub(crate) fn place(&self, body: usize, triangle: u32) -> [DVec3; 3] {
        let tree = self.trees[body];
        let [p, q, r] = tree.mesh().corners(triangle as usize);
        [self.place_point(body, p), self.place_point(body, q), self.place_point(body, r)]
    }

    /// A vertex in working coordinates.
    #[inline(always)]
    pub(crate) fn place_vertex(&self, body: usize, vertex: u32) -> DVec3 {
        self.place_point(body, self.trees[body].mesh().vertices()[vertex as usize])
    }

    /// A vector of a body's axes in those of B.
    pub(crate) fn turn(&self, body: usize, v: DVec3) -> DVec3 {
        let r = &self.pose.rotation;
        if body == 1 { v } else { r[0] * v.x + r[1] * v.y + r[2] * v.z }
    }

    /// Where a sphere of a body is at most, in working coordinates.
    pub(crate) fn place_sphere(&self, body: usize, center: DVec3, radius: f64) -> (DVec3, f64) {
        (self.place_point(body, center), radius * self.inverse_unit)
    }

    #[inline(always)]
    fn place_point(&self, body: usize, point: DVec3) -> DVec3 {
        let p = (point - self.trees[body].center()) * self.inverse_unit;
        let r = &self.pose.rotation;
        if body == 1 { p } else { (r[0] * p.x + r[1] * p.y + r[2] * p.z) + self.offset }
    }

    /// What to do at a pair of boxes: expand the larger one, the second at a tie.
    #[inline(always)]
    pub(crate) fn step(&self, pair: [u32; 2]) -> Step {
        let (a, b) = (self.candidate(0, pair[0]), self.candidate(1, pair[1]));
        match (a.below, b.below) {
            (Below::Triangle(a), Below::Triangle(b)) => Step::Compare([a, b]),
            (Below::Node(node), Below::Triangle(_)) => Step::Expand { wide: 0, node },
            (Below::Triangle(_), Below::Node(node)) => Step::Expand { wide: 1, node },
            (Below::Node(node_a), Below::Node(node_b)) => {
                if a.size > b.size {
                    Step::Expand { wide: 0, node: node_a }
                } else {
                    Step::Expand { wide: 1, node: node_b }
                }
            }
        }
    }

    /// Size of a box, and what is below it.
    #[inline(always)]
    fn candidate(&self, body: usize, index: u32) -> Candidate {
        let node = &self.trees[body].nodes[index as usize / WIDTH];
        let lane = index as usize % WIDTH;
        if self.point_like[body] {
            return Candidate { size: 0.0, below: Below::Triangle(0) };
        }
        Candidate { size: f64::from(node.size(lane)) * self.volume[body], below: node.below(lane) }
    }

    #[inline(always)]
    fn placed(&self, wide: usize, node: u32, boxed: &OrientedBox, origin: [f32; 3]) -> Placed {
        Placed::new(&self.sides[wide], boxed, origin, &self.trees[wide].nodes[node as usize])
    }

    /// A box of one body, and the reference point of its center.
    #[inline(always)]
    fn single(&self, body: usize, index: u32) -> (OrientedBox, [f32; 3]) {
        let from = &self.trees[body].nodes[index as usize / WIDTH];
        (from.oriented_box(index as usize % WIDTH), from.origin)
    }

    /// A direction, given in B's axes.
    pub(crate) fn direction(&self, n: DVec3) -> Direction {
        // Rounding to f32 adds at most √3·2⁻²⁴ to the length.
        let n = n.normalize_or_zero() * (1.0 - 4.0 * UNIT_F32);
        let r = &self.pose.rotation;
        let axes = [DVec3::new(r[0].dot(n), r[1].dot(n), r[2].dot(n)), n];
        Direction { axes, narrow: axes.map(|v| [v.x as f32, v.y as f32, v.z as f32]) }
    }

    /// Lower bounds on the distances of the boxes of a node of body `wide` from a box of the other body, working
    /// units. Evaluates the axes of both, the direction that is given, and, where a bound is not enough, the shortest ways
    /// between the boxes.
    #[inline(always)]
    pub(crate) fn bounds<L: Lanes>(
        &self,
        (wide, node): (usize, u32),
        single: u32,
        &Wanted { along, enough, directions }: &Wanted<'_>,
    ) -> NodeBounds {
        let (boxed, origin) = self.single(1 - wide, single);
        let placed = self.placed(wide, node, &boxed, origin);
        let tree = self.trees[1 - wide];
        let placed = match tree.nodes[single as usize / WIDTH].below(single as usize % WIDTH) {
            Below::Triangle(triangle) => {
                let corners = self.corners_in(wide, triangle, self.trees[wide].nodes[node as usize].origin);
                let placed = placed.with_triangle_along(along.narrow[wide], &corners);
                if directions == Directions::OfEdges { placed.with_longest_edge(&corners) } else { placed }
            }
            Below::Node(_) => placed.with_box_along(along.narrow[wide], &boxed),
        };
        let node = &self.trees[wide].nodes[node as usize];
        let lanes = lower_bounds::<L>(node, &placed, self.sides[wide].to_work, enough);
        NodeBounds { lanes, used: (node.used as usize).min(WIDTH) }
    }

    /// A lower bound on the distance of two boxes along one direction from A to B, working units; zero if they are not apart
    /// along it.
    #[inline(always)]
    pub(crate) fn bound_along(&self, pair: [u32; 2], along: &Direction) -> f32 {
        // The highest point of A along the direction, and the lowest one of B, each from its tree's center.
        let high = self.span_along(0, pair[0], along.axes[0])[1];
        let low = self.span_along(1, pair[1], along.axes[1])[0];
        // Fewer than thirty operations with numbers of at most 2: 64v covers them.
        let gap = low - high - along.axes[1].dot(self.offset) - 2.0 * self.error - 64.0 * UNIT_F64;
        // Rounded down.
        if gap > 0.0 { (gap * (1.0 - 2.0 * UNIT_F32)) as f32 } else { 0.0 }
    }

    /// What a box covers along a direction of its body's axes, from its tree's center, working units.
    #[inline(always)]
    fn span_along(&self, body: usize, index: u32, n: DVec3) -> [f64; 2] {
        let tree = self.trees[body];
        let node = &tree.nodes[index as usize / WIDTH];
        if let Below::Triangle(triangle) = node.below(index as usize % WIDTH) {
            let corners = tree.mesh().corners(triangle as usize);
            let along = |corner: DVec3| n.dot((corner - tree.center()) * self.inverse_unit);
            let [p, q, r] = [along(corners[0]), along(corners[1]), along(corners[2])];
            return [p.min(q).min(r), p.max(q).max(r)];
        }
        let (boxed, origin) = self.single(body, index);
        let dot = |v: [f32; 3]| n.x * f64::from(v[0]) + n.y * f64::from(v[1]) + n.z * f64::from(v[2]);
        let [x, y, z] = boxed.axes;
        let radius = f64::from(boxed.radius);
        let [forth, back] = reach_both_ways(&boxed.half_extent, &boxed.slabs, [dot(x), dot(y), dot(z)]);
        // The axes are orthonormal up to 5.2u.
        let more = 6.0 * UNIT_F32 * radius;
        let (forth, back) = (forth.min(radius) + more, back.min(radius) + more);
        let (middle, unit) = (dot(origin) + dot(boxed.center), tree.unit() * self.inverse_unit);
        [(middle - back) * unit, (middle + forth) * unit]
    }

    /// Corners of a triangle of the other body from the origin of a node of body `wide`, in its axes and unit.
    #[inline(always)]
    fn corners_in(&self, wide: usize, triangle: u32, origin: [f32; 3]) -> [DVec3; 3] {
        let (tree, side) = (self.trees[1 - wide], &self.sides[wide]);
        let scale = 1.0 / self.trees[wide].unit();
        let shift =
            side.offset - DVec3::new(f64::from(origin[0]), f64::from(origin[1]), f64::from(origin[2]));
        let place = |corner: DVec3| {
            let p = (corner - tree.center()) * scale;
            side.rotation[0] * p.x + side.rotation[1] * p.y + side.rotation[2] * p.z + shift
        };
        let [p, q, r] = tree.mesh().corners(triangle as usize);
        [place(p), place(q), place(r)]
    }

    /// Which boxes of a node of body `wide` are not proven apart from a box of the other body.
    #[inline(always)]
    pub(crate) fn overlaps<L: Lanes>(&self, wide: usize, node: u32, single: u32) -> u32 {
        let (boxed, origin) = self.single(1 - wide, single);
        let placed = self.placed(wide, node, &boxed, origin);
        overlaps::<L>(&self.trees[wide].nodes[node as usize], &placed)
    }
}

/// The pair of boxes after one of the two was expanded.
#[inline(always)]
pub(crate) fn child(pair: [u32; 2], wide: usize, node: u32, lane: usize) -> [u32; 2] {
    let mut pair = pair;
    pair[wide] = node * WIDTH as u32 + lane as u32;
    pair
}

/// The least working unit, 2⁻⁶⁰⁰.
const LEAST_UNIT: f64 = power_of_two(-600);
