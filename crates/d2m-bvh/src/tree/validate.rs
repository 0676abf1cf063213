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
    /// Center, radius or unit do not fit the mesh.
    #[error("center, radius or unit of the tree do not fit its mesh")]
    Extent,
    /// A node does not exist, is below two boxes or none, or its number of boxes is wrong.
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
        // Every node is below exactly one box; the walk down from the root shows that there is no cycle.
        match (is_linked.iter().position(|&is| !is), is_held.iter().position(|&is| !is)) {
            (Some(node), _) => Err(TreeError::Link { node }),
            (_, Some(triangle)) => Err(TreeError::Triangle { triangle }),
            _ => Ok(()),
        }
    }

    /// Each box against the triangles below it.
    fn check_enclosures(&self, extent: &Extent) -> Result<(), TreeError> {
        let surface = Surface::new(&self.mesh, extent);
        let below = self.triangles_below()?;
        let check = |(index, node): (usize, &WideNode)| {
            for lane in 0..node.used as usize {
                check_box(index, node, lane, below.of(index, lane), &surface)?;
            }
            Ok(())
        };
        #[cfg(feature = "rayon")]
        {
            use rayon::prelude::*;
            // The first of all faults, whatever the number of threads.
            let fault = self.nodes.par_iter().enumerate().find_map_first(|item| check(item).err());
            fault.map_or(Ok(()), Err)
        }
        #[cfg(not(feature = "rayon"))]
        self.nodes.iter().enumerate().try_for_each(check)
    }

    /// Walks down from the root. Nodes in a cycle are below no root: they are not met.
    fn triangles_below(&self) -> Result<TrianglesBelow, TreeError> {
        let mut triangles = Vec::with_capacity(self.mesh.triangle_count());
        let mut first = vec![0; self.nodes.len()];
        let mut ends = vec![[0; WIDTH]; self.nodes.len()];
        let mut is_met = vec![false; self.nodes.len()];
        is_met[0] = true;
        // The nodes from the root to here, each with the next lane.
        let mut path = vec![(0, 0)];
        while let Some((index, lane)) = path.last_mut() {
            let (node, index, current) = (&self.nodes[*index], *index, *lane);
            if current > 0 {
                ends[index][current - 1] = triangles.len() as u32;
            }
            if current >= node.used as usize {
                path.pop();
                continue;
            }
            *lane += 1;
            match node.below(current) {
                Below::Triangle(triangle) => triangles.push(triangle),
                Below::Node(child) => {
                    let child = child as usize;
                    if path.len() > DEEPEST {
                        return Err(TreeError::Link { node: child });
                    }
                    first[child] = triangles.len() as u32;
                    is_met[child] = true;
                    path.push((child, 0));
                }
            }
        }
        match is_met.iter().position(|&is| !is) {
            Some(node) => Err(TreeError::Link { node }),
            None => Ok(TrianglesBelow { triangles, first, ends }),
        }
    }
}

/// The triangles below each box: a part of one list, in the order of the tree.
struct TrianglesBelow {
    triangles: Vec<u32>,
    /// Where the part of the first box of each node begins.
    first: Vec<u32>,
    /// Where the part of each box ends, and that of the next one begins.
    ends: Vec<[u32; WIDTH]>,
}

impl TrianglesBelow {
    fn of(&self, node: usize, lane: usize) -> &[u32] {
        let start = if lane == 0 { self.first[node] } else { self.ends[node][lane - 1] };
        &self.triangles[start as usize..self.ends[node][lane] as usize]
    }
}

/// All triangles at once, and only where that is no proof one by one: what is proven of all points is proven of each.
fn check_box(
    index: usize,
    node: &WideNode,
    lane: usize,
    triangles: &[u32],
    surface: &Surface<'_>,
) -> Result<(), TreeError> {
    let boxed = node.oriented_box(lane);
    let mut reach = Reach::new(node.origin, boxed.center, &boxed.axes, boxed.half_extent.map(f64::from));
    for &triangle in triangles {
        for corner in &surface.corners(triangle) {
            reach.add(corner);
        }
    }
    if reach.is_within(&boxed) {
        return Ok(());
    }
    match triangles.iter().find(|&&triangle| !encloses(node, lane, &surface.corners(triangle))) {
        None => Ok(()),
        Some(&triangle) => Err(TreeError::Enclosure { node: index, lane, triangle: triangle as usize }),
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
