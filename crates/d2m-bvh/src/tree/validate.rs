//! Checks every promise of `node.rs` on a tree that came from elsewhere.

use super::margin::{UNIT_F32, UNIT_F64};
use super::mesh_tree::MeshTree;
use super::node::{Below, LEAST_SIZE, WIDTH, WideNode};
use super::surface::{Extent, Reach, Surface, unit_of};
use glam::DVec3;
use thiserror::Error;

/// Boxes above a triangle; a built tree of 2²⁹ triangles has at most 30.
const DEEPEST: usize = 64;

/// Why a tree is not one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum TreeError {
    /// Centre, radius or unit do not fit the mesh.
    #[error("centre, radius or unit of the tree do not fit its mesh")]
    Extent,
    /// A node does not exist, hangs in two places or nowhere, or its number of boxes is wrong.
    #[error("node {node}: not linked into one tree")]
    Link {
        /// Number of the node.
        node: usize,
    },
    /// A triangle does not exist, or is not in exactly one leaf.
    #[error("triangle {triangle}: not in exactly one leaf")]
    Triangle {
        /// Number of the triangle.
        triangle: usize,
    },
    /// The axes of a box are not orthonormal to the rounding of `f32`, or its numbers are not consistent.
    #[error("box {lane} of node {node}: axes or extents are inconsistent")]
    Shape {
        /// Number of the node.
        node: usize,
        /// Number of the box in the node.
        lane: usize,
    },
    /// A box is not proven to enclose a triangle that is below it.
    #[error("box {lane} of node {node} does not enclose triangle {triangle}")]
    Enclosure {
        /// Number of the node.
        node: usize,
        /// Number of the box in the node.
        lane: usize,
        /// Number of the triangle.
        triangle: usize,
    },
}

impl MeshTree {
    /// Checks that every query may rely on this tree: each box encloses its triangles in real arithmetic, axes are
    /// orthonormal to the rounding of `f32`, the nodes form one tree, and each triangle is in one leaf. A tree that
    /// was built or refitted passes. Takes O(n log n) time.
    ///
    /// The enclosures are checked in `f64` with the error bound that was used to make them: what the check computes
    /// plus its proven error must be within what the box says.
    ///
    /// # Errors
    /// The first broken promise.
    pub fn validate(&self) -> Result<(), TreeError> {
        let least = Extent::about(&self.mesh, self.center);
        let fits = self.center.is_finite() && self.radius.is_finite() && self.radius >= least.radius;
        if !fits || self.unit != unit_of(self.radius) {
            return Err(TreeError::Extent);
        }
        self.check_links()?;
        for (index, node) in self.nodes.iter().enumerate() {
            check_shapes(index, node)?;
        }
        self.check_enclosures(&Extent { center: self.center, radius: self.radius, unit: self.unit })
    }

    fn check_links(&self) -> Result<(), TreeError> {
        let root = self.nodes.first().ok_or(TreeError::Link { node: 0 })?;
        if root.used != 1 || root.parent != 0 || self.nodes.len() > u32::MAX as usize / WIDTH {
            return Err(TreeError::Link { node: 0 });
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
        // Every node hangs below exactly one box; that there is no ring is seen when climbing from the triangles.
        match (is_linked.iter().position(|&is| !is), is_held.iter().position(|&is| !is)) {
            (Some(node), _) => Err(TreeError::Link { node }),
            (_, Some(triangle)) => Err(TreeError::Triangle { triangle }),
            _ => Ok(()),
        }
    }

    /// Climbs from each triangle to the root. Nodes in a ring would have no triangles below; they are counted.
    fn check_enclosures(&self, extent: &Extent) -> Result<(), TreeError> {
        let surface = Surface::new(&self.mesh, extent);
        let mut is_climbed = vec![false; self.nodes.len()];
        for (index, leaf) in self.nodes.iter().enumerate() {
            for lane in 0..leaf.used as usize {
                let Below::Triangle(triangle) = leaf.below(lane) else { continue };
                let corners = surface.corners(triangle);
                let (mut node, mut lane) = (index, lane);
                for depth in 0.. {
                    if !encloses(&self.nodes[node], lane, &corners) {
                        return Err(TreeError::Enclosure { node, lane, triangle: triangle as usize });
                    }
                    is_climbed[node] = true;
                    if node == 0 {
                        break;
                    }
                    if depth > DEEPEST {
                        return Err(TreeError::Link { node });
                    }
                    let parent = self.nodes[node].parent as usize;
                    (node, lane) = (parent / WIDTH, parent % WIDTH);
                }
            }
        }
        match is_climbed.iter().position(|&is| !is) {
            Some(node) => Err(TreeError::Link { node }),
            None => Ok(()),
        }
    }
}

/// Is the triangle proven to be inside the box and its ball? The same arithmetic as at construction.
fn encloses(node: &WideNode, lane: usize, corners: &[[f64; 3]; 3]) -> bool {
    let boxed = node.oriented_box(lane);
    let mut reach = Reach::new(node.origin, boxed.center, &boxed.axes, boxed.half_extent.map(f64::from));
    for p in corners {
        reach.add(p);
    }
    reach.is_within(&boxed)
}

fn check_shapes(index: usize, node: &WideNode) -> Result<(), TreeError> {
    let unused = WideNode::empty([0.0; 3], 0);
    if !node.origin.iter().all(|x| x.is_finite()) || !node.extent.is_finite() {
        return Err(TreeError::Shape { node: index, lane: 0 });
    }
    for lane in 0..WIDTH {
        let boxed = node.oriented_box(lane);
        let fine = if lane >= node.used as usize {
            let blank = unused.oriented_box(lane);
            node.size[lane] < 0.0 && boxed == blank
        } else {
            let numbers = boxed.center.iter().chain(&boxed.half_extent).chain([&boxed.radius]);
            let is_leaf = matches!(node.below(lane), Below::Triangle(_));
            let size = node.size[lane];
            let center: f64 = boxed.center.iter().map(|c| f64::from(c.abs())).sum();
            numbers.clone().all(|x| x.is_finite())
                && boxed
                    .half_extent
                    .iter()
                    .all(|&h| 0.0 <= h && f64::from(h) <= 1.0001 * f64::from(boxed.radius))
                && f64::from(node.extent) >= center + f64::from(boxed.radius)
                && size.is_finite()
                && (if is_leaf { size == 0.0 } else { size >= LEAST_SIZE })
                && is_orthonormal(&boxed.axes)
        };
        if !fine {
            return Err(TreeError::Shape { node: index, lane });
        }
    }
    Ok(())
}

/// ‖A·Aᵀ − I‖ ≤ 5.2·2⁻²⁴ in the Frobenius norm, so in every entry and in the spectral norm. Rounding orthonormal axes
/// gives at most 2√3·2⁻²⁴; the sum below errs by less than 2⁻⁴⁹.
fn is_orthonormal(axes: &[[f32; 3]; 3]) -> bool {
    let axes = axes.map(|a| DVec3::new(f64::from(a[0]), f64::from(a[1]), f64::from(a[2])));
    let deviation = |i: usize, j: usize| axes[i].dot(axes[j]) - f64::from(u8::from(i == j));
    let square: f64 = (0..9).map(|k| deviation(k / 3, k % 3).powi(2)).sum();
    square.sqrt() + 32.0 * UNIT_F64 <= 5.2 * UNIT_F32
}
