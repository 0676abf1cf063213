//! Layout of the tree in memory. **Everything that walks a tree depends on this file only.**
//!
//! A *box* is one lane of a wide node: an oriented box around a part of the surface. Boxes are numbered
//! `8·node + lane`; box 0 is the root and the only used lane of node 0. A box is either a leaf (one triangle) or has
//! a wide node of at most eight boxes below it; the boxes below together hold the same triangles.
//!
//! Coordinates are *local*: body coordinates minus [`MeshTree::center`](crate::MeshTree::center), divided by the
//! power of two [`MeshTree::unit`](crate::MeshTree::unit), so the body has a radius in (½, 1].
//!
//! Promise, in real arithmetic on the stored numbers: every point p (local) of every triangle of a box has
//! |axisᵢ·(p − origin − center)| ≤ half_extentᵢ for i = 0, 1, 2 and |p − origin − center| ≤ radius, and is within the
//! [`slabs`](super::slabs) of the box.
//! The third axis is the cross product of the two that are stored, each product and difference rounded to `f32`: the same bits wherever it
//! is needed. The axes are orthonormal up to roundings to `f32`: |A·Aᵀ − I| ≤ 5.2·2⁻²⁴ in each entry.

use super::slabs::Slabs;
use crate::margin::round_up;
use d2m_lanes::Lanes;
use d2m_lanes::three::cross;

/// Lanes of a wide node.
pub const WIDTH: usize = 8;

/// Marks a child that is a triangle; the rest of the bits is its number.
pub const LEAF: u32 = 1 << 31;

/// The least size of a box with a node below it: stays positive when it is multiplied by itself.
pub const LEAST_SIZE: f32 = 1e-18;
/// Part of the radius that a box counts as thick at least, in its size.
const LEAST_THICKNESS: f32 = 1e-3;

/// What is below a box.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Below {
    /// A triangle of the mesh, by number.
    Triangle(u32),
    /// A wide node, by number.
    Node(u32),
}

/// Up to eight boxes, lane by lane. 576 bytes, nine cache lines.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct WideNode {
    /// Box centers relative to `origin`, by axis then lane.
    pub center: [[f32; WIDTH]; 3],
    /// The first two axes of each box: `axes[i][k]` is coordinate k of axis i of each lane.
    pub axes: [[[f32; WIDTH]; 3]; 2],
    /// Half extents along the three axes.
    pub half_extent: [[f32; WIDTH]; 3],
    /// For each pair of axes the bits of four bytes, see [`Slabs`]; never those of a NaN.
    pub slabs: [[f32; WIDTH]; 3],
    /// Radius about the box center.
    pub radius: [f32; WIDTH],
    /// Leaf flag and triangle number, or node number.
    pub child: [u32; WIDTH],
    /// Reference point of the centers, local coordinates.
    pub origin: [f32; 3],
    /// At least |center|₁ + radius of every lane.
    pub extent: f32,
    /// How many lanes are used: the first ones.
    pub used: u32,
    /// The box that this node is below (`8·node + lane`).
    pub parent: u32,
}

/// One box of a node.
#[derive(Clone, Copy, Debug)]
pub struct NodeBox<'n> {
    /// The node.
    pub node: &'n WideNode,
    /// Which of its boxes.
    pub lane: usize,
}

impl<'n> NodeBox<'n> {
    /// By its number among all boxes of these nodes (`8·node + lane`).
    #[inline(always)]
    pub fn new(nodes: &'n [WideNode], index: u32) -> Self {
        Self { node: &nodes[index as usize / WIDTH], lane: index as usize % WIDTH }
    }
}

impl WideNode {
    /// A node without boxes. Unused lanes hold a point box so far away that no test meets it.
    pub(crate) const fn empty(origin: [f32; 3], parent: u32) -> Self {
        let mut node = Self {
            center: [[1e15; WIDTH]; 3],
            axes: [[[0.0; WIDTH]; 3]; 2],
            half_extent: [[0.0; WIDTH]; 3],
            slabs: [[0.0; WIDTH]; 3],
            radius: [0.0; WIDTH],
            child: [u32::MAX; WIDTH],
            origin,
            extent: 0.0,
            used: 0,
            parent,
        };
        node.axes[0][0] = [1.0; WIDTH];
        node.axes[1][1] = [1.0; WIDTH];
        node
    }

    /// What is below lane `lane`.
    #[inline(always)]
    pub fn below(&self, lane: usize) -> Below {
        let child = self.child[lane];
        if child & LEAF != 0 { Below::Triangle(child & !LEAF) } else { Below::Node(child) }
    }

    /// The triangle of a lane that has no node below it.
    #[inline(always)]
    pub fn triangle(&self, lane: usize) -> u32 {
        self.child[lane] & !LEAF
    }

    /// Sets what is below lane `lane`.
    pub(crate) fn set_below(&mut self, lane: usize, below: Below) {
        self.child[lane] = match below {
            Below::Triangle(triangle) => triangle | LEAF,
            Below::Node(node) => node,
        };
    }

    /// Sets the box of lane `lane`.
    pub(crate) fn set_box(&mut self, lane: usize, oriented: &OrientedBox) {
        for i in 0..3 {
            self.center[i][lane] = oriented.center[i];
            self.half_extent[i][lane] = oriented.half_extent[i];
            self.slabs[i][lane] = f32::from_bits(u32::from_le_bytes(oriented.slabs[i]));
        }
        for i in 0..2 {
            for k in 0..3 {
                self.axes[i][k][lane] = oriented.axes[i][k];
            }
        }
        self.radius[lane] = oriented.radius;
        self.extent = self.extent.max(round_up(self.reach_of(lane)));
    }

    /// |center|₁ + radius of lane `lane`, as far as doubles hold the sum.
    #[inline(always)]
    pub(crate) fn reach_of(&self, lane: usize) -> f64 {
        let [x, y, z] = [self.center[0][lane], self.center[1][lane], self.center[2][lane]].map(f32::abs);
        f64::from(x) + f64::from(y) + f64::from(z) + f64::from(self.radius[lane])
    }

    /// All three axes of the boxes.
    #[inline(always)]
    pub fn wide_axes<L: Lanes>(&self) -> [[L; 3]; 3] {
        let a = &self.axes;
        let first = [L::load(&a[0][0]), L::load(&a[0][1]), L::load(&a[0][2])];
        let second = [L::load(&a[1][0]), L::load(&a[1][1]), L::load(&a[1][2])];
        [first, second, cross(&first, &second)]
    }

    /// All three axes of the box of lane `lane`.
    #[inline(always)]
    pub fn axes_of(&self, lane: usize) -> [[f32; 3]; 3] {
        let a = &self.axes;
        let first = [a[0][0][lane], a[0][1][lane], a[0][2][lane]];
        let second = [a[1][0][lane], a[1][1][lane], a[1][2][lane]];
        [first, second, cross(&first, &second)]
    }

    /// What decides which of two boxes is expanded: the larger one. Its volume, flat boxes taken a little thicker, so at least
    /// [`LEAST_SIZE`]; zero for a leaf, which is never the larger one.
    #[inline(always)]
    pub fn size(&self, lane: usize) -> f32 {
        if self.child[lane] & LEAF != 0 {
            return 0.0;
        }
        let (h, least) = (&self.half_extent, LEAST_THICKNESS * self.radius[lane]);
        let [x, y, z] = [greater(h[0][lane], least), greater(h[1][lane], least), greater(h[2][lane], least)];
        greater(x * y * z, LEAST_SIZE)
    }

    /// The same of all lanes, leaves or not.
    #[inline(always)]
    pub fn wide_sizes<L: Lanes>(&self) -> L {
        let (h, least) = (&self.half_extent, L::splat(LEAST_THICKNESS) * L::load(&self.radius));
        let [x, y, z] = [L::load(&h[0]).max(least), L::load(&h[1]).max(least), L::load(&h[2]).max(least)];
        (x * y * z).max(L::splat(LEAST_SIZE))
    }

    /// The box of lane `lane`, read out.
    #[inline(always)]
    pub fn oriented_box(&self, lane: usize) -> OrientedBox {
        let (c, h, b) = (&self.center, &self.half_extent, &self.slabs);
        OrientedBox {
            center: [c[0][lane], c[1][lane], c[2][lane]],
            axes: self.axes_of(lane),
            half_extent: [h[0][lane], h[1][lane], h[2][lane]],
            slabs: [
                b[0][lane].to_bits().to_le_bytes(),
                b[1][lane].to_bits().to_le_bytes(),
                b[2][lane].to_bits().to_le_bytes(),
            ],
            radius: self.radius[lane],
        }
    }
}

/// The greater one as lanes take it, in one instruction: `max` takes care of what is no number as well, which no size is.
#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// One box, with its center relative to the origin of its wide node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrientedBox {
    /// Its center.
    pub center: [f32; 3],
    /// Its axes: `axes[i][k]` is coordinate k of axis i. The third is the cross product of the others in `f32`.
    pub axes: [[f32; 3]; 3],
    /// Half extents along them.
    pub half_extent: [f32; 3],
    /// The diagonal slabs.
    pub slabs: Slabs,
    /// Radius about the center.
    pub radius: f32,
}
