//! Checks every promise of `node.rs` on a tree that came from elsewhere.

use super::build::MOST_TRIANGLES;
use super::enclosures::{Enclosures, TreeCorners};
use super::frame::{DEVIATION_ERROR, MOST_DEVIATION, deviation};
use super::mesh_tree::MeshTree;
use super::node::{Below, WIDTH, WideNode};
use super::slabs::MOST;
use super::surface::{Extent, unit_of};
use super::tree_error::TreeError;
use crate::TriMesh;
use crate::parallel::{both, map_in_order};
use d2m_lanes::{Doubles, F64x4};

/// No length of a node is more, in units of the tree: the body lies in a sphere of radius one, so boxes made around its points have half
/// extents up to 1 and radii up to √3, origins are within √3 in each sum of coordinates, centers within twice that of them, and what
/// is rounded away is less than that again. Tests in `f32` may multiply such lengths without overflow.
const MOST_LENGTH: f32 = 16.0;
/// Nodes that are checked at a time: one takes a tenth of a microsecond, waking a thread several.
const NODES: usize = 4096;

impl MeshTree {
    /// Checks that every query may rely on this tree: each box encloses its triangles in real arithmetic, axes are
    /// orthonormal to the rounding of `f32`, the nodes form one tree, and each triangle is in one leaf. A tree that
    /// was built or refitted passes. Takes O(n log n) time.
    ///
    /// The enclosures are checked in `f64` with the error bound that was used to make them: what the check computes
    /// plus its proven error must be within what the box says.
    ///
    /// # Errors
    /// The first broken promise; the same one at any number of threads.
    pub fn validate(&self) -> Result<(), TreeError> {
        let extent = Extent { center: self.center, radius: self.radius, unit: self.unit };
        ClaimedTree { mesh: &self.mesh, nodes: &self.nodes, extent }.check()
    }
}

/// What is said to be a tree.
pub(super) struct ClaimedTree<'a> {
    pub(super) mesh: &'a TriMesh,
    pub(super) nodes: &'a [WideNode],
    pub(super) extent: Extent,
}

impl ClaimedTree<'_> {
    /// As [`MeshTree::validate`].
    pub(super) fn check(&self) -> Result<(), TreeError> {
        let (sizes, corners) = both(
            || (self.check_extent(), self.check_shapes()),
            || self.check_links().and_then(|()| TreeCorners::of(self.nodes, self.mesh, &self.extent)),
        );
        sizes.0?;
        let corners = corners?;
        sizes.1?;
        Enclosures { nodes: self.nodes, tree: corners }.check(0, &mut Vec::new())
    }

    fn check_shapes(&self) -> Result<(), TreeError> {
        let chunks: Vec<_> = self.nodes.chunks(NODES).enumerate().collect();
        let checked = map_in_order(&chunks, 1, |(chunk, nodes)| {
            nodes.iter().enumerate().try_for_each(|(k, node)| check_node(chunk * NODES + k, node))
        });
        checked.into_iter().collect()
    }

    fn check_extent(&self) -> Result<(), TreeError> {
        let Extent { center, radius, unit } = self.extent;
        let least = Extent::about(self.mesh, center).radius;
        // Errors grow with the radius: a center or radius of choice may cost one bit of them, not all.
        let most = 2.0 * Extent::of(self.mesh).radius;
        let fits = center.is_finite() && radius.is_finite() && least <= radius && radius <= most;
        if fits && unit == unit_of(radius) { Ok(()) } else { Err(TreeError::Extent) }
    }

    fn check_links(&self) -> Result<(), TreeError> {
        let root = self.nodes.first().ok_or(TreeError::Link { node: 0 })?;
        if root.used != 1 || root.parent != 0 || self.nodes.len() > u32::MAX as usize / WIDTH {
            return Err(TreeError::Link { node: 0 });
        }
        if self.mesh.triangle_count() > MOST_TRIANGLES {
            return Err(TreeError::Triangle { triangle: MOST_TRIANGLES });
        }
        let mut is_linked = vec![false; self.nodes.len()];
        let mut is_held = vec![false; self.mesh.triangle_count()];
        is_linked[0] = true;
        for (index, node) in self.nodes.iter().enumerate() {
            let used = node.used as usize;
            if !(1..=WIDTH).contains(&used) {
                return Err(TreeError::Link { node: index });
            }
            for lane in 0..used {
                match node.below(lane) {
                    Below::Triangle(triangle) => match is_held.get_mut(triangle as usize) {
                        Some(held) if !*held => *held = true,
                        _ => return Err(TreeError::Triangle { triangle: triangle as usize }),
                    },
                    Below::Node(child) => {
                        let link = TreeError::Link { node: child as usize };
                        let below = self.nodes.get(child as usize).ok_or(link)?;
                        if is_linked[child as usize] || below.parent as usize != index * WIDTH + lane {
                            return Err(link);
                        }
                        is_linked[child as usize] = true;
                    }
                }
            }
        }
        // Every node is below exactly one box; the walk down from the root shows that there is no cycle.
        match (is_linked.iter().position(|&is| !is), is_held.iter().position(|&is| !is)) {
            (Some(node), _) => Err(TreeError::Link { node }),
            (_, Some(triangle)) => Err(TreeError::Triangle { triangle }),
            _ => Ok(()),
        }
    }
}

fn check_node(index: usize, node: &WideNode) -> Result<(), TreeError> {
    let unused = WideNode::empty([0.0; 3], 0);
    let sizes = node.origin.iter().chain([&node.extent]);
    if !sizes.into_iter().all(|x| x.abs() <= MOST_LENGTH) {
        return Err(TreeError::Shape { node: index, lane: 0 });
    }
    for lane in 0..WIDTH {
        let boxed = node.oriented_box(lane);
        let fine = if lane >= node.used as usize {
            let blank = unused.oriented_box(lane);
            node.child[lane] == unused.child[lane] && boxed == blank
        } else {
            let numbers = boxed.center.iter().chain(&boxed.half_extent).chain([&boxed.radius]);
            let center: f64 = boxed.center.iter().map(|c| f64::from(c.abs())).sum();
            numbers.into_iter().all(|x| x.abs() <= MOST_LENGTH)
                && boxed
                    .half_extent
                    .iter()
                    .all(|&h| 0.0 <= h && f64::from(h) <= 1.0001 * f64::from(boxed.radius))
                && f64::from(node.extent) >= center + f64::from(boxed.radius)
                && boxed.slabs.iter().flatten().all(|&steps| steps <= MOST)
                && is_orthonormal(&boxed.axes)
        };
        if !fine {
            return Err(TreeError::Shape { node: index, lane });
        }
    }
    Ok(())
}

fn is_orthonormal(axes: &[[f32; 3]; 3]) -> bool {
    let frame = axes.map(|axis| axis.map(|x| F64x4::splat(f64::from(x))));
    let [off, ..] = deviation(&frame).store().0;
    off + DEVIATION_ERROR <= MOST_DEVIATION
}
