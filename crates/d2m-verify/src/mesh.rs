//! A mesh and its tree of boxes. The boxes are minima and maxima of doubles: they are exact.
use crate::surface::Surface;
use d2m_interval::IntervalVec3;
use glam::DVec3;
use std::sync::OnceLock;

/// A mesh that cannot be judged.
///
/// ```
/// use d2m_verify::{Mesh, MeshFault};
/// use glam::DVec3;
/// let fault = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 7]]).unwrap_err();
/// assert_eq!(fault, MeshFault::NoSuchVertex(0));
/// assert_eq!(fault.to_string(), "triangle 0 has a vertex that does not exist");
/// ```
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFault {
    /// A vertex, by its number, with a coordinate that is no finite number.
    #[error("vertex {0} is not a finite point")]
    NotFinite(usize),
    /// A triangle, by its number, with a vertex that does not exist.
    #[error("triangle {0} has a vertex that does not exist")]
    NoSuchVertex(usize),
    /// There is no triangle, or more than 2³⁰.
    #[error("{0} triangles are none, or too many")]
    Count(usize),
}

/// Triangles in body axes, with a binary tree of boxes along these axes.
///
/// ```
/// use d2m_verify::{Mesh, MeshFault};
/// use glam::DVec3;
/// let mesh = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]])?;
/// assert_eq!(mesh.triangle_count(), 1);
/// assert!(Mesh::try_new(&[DVec3::ZERO], &[]).is_err());
/// # Ok::<(), MeshFault>(())
/// ```
#[derive(Debug)]
pub struct Mesh {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// What enclosures are about; any point is right, the middle gives short arms.
    pub(crate) center: DVec3,
    /// The root is node 0, and each node is before those below it.
    pub(crate) nodes: Vec<Node>,
    /// The triangles in the order of the leaves.
    order: Vec<u32>,
    surface: OnceLock<Surface>,
}

/// A box in body axes. Its triangles are `count` from `first` on, in the order of the leaves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    first: u32,
    count: u32,
}

impl Mesh {
    /// The mesh of these triangles.
    ///
    /// # Errors
    /// [`MeshFault`]: no triangles, coordinates that are not finite, vertices that do not exist.
    pub fn try_new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, MeshFault> {
        if triangles.is_empty() || triangles.len() > 1 << 30 {
            return Err(MeshFault::Count(triangles.len()));
        }
        if let Some(vertex) = vertices.iter().position(|p| !p.is_finite()) {
            return Err(MeshFault::NotFinite(vertex));
        }
        let exists = |&v: &u32| (v as usize) < vertices.len();
        if let Some(triangle) = triangles.iter().position(|t| !t.iter().all(exists)) {
            return Err(MeshFault::NoSuchVertex(triangle));
        }
        let leaf = |(corners, first): (&[u32; 3], u32)| {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            Node { low: a.min(b).min(c), high: a.max(b).max(c), first, count: 1 }
        };
        let mut leaves: Vec<Node> = triangles.iter().zip(0..).map(leaf).collect();
        let mut nodes = Vec::with_capacity(2 * leaves.len());
        build(&mut nodes, 0, &mut leaves);
        let (center, order) = (middle(&nodes[0]), leaves.iter().map(|leaf| leaf.first).collect());
        let (vertices, triangles) = (vertices.to_vec(), triangles.to_vec());
        Ok(Self { vertices, triangles, center, nodes, order, surface: OnceLock::new() })
    }

    /// The same mesh with other points, in the order of the old ones along each axis. `None`: a point, or the center, has no other.
    pub(crate) fn try_map(&self, point: impl Fn(DVec3) -> Option<DVec3>) -> Option<Self> {
        let node = |node: &Node| Some(Node { low: point(node.low)?, high: point(node.high)?, ..*node });
        Some(Self {
            vertices: self.vertices.iter().map(|&p| point(p)).collect::<Option<_>>()?,
            triangles: self.triangles.clone(),
            center: point(self.center)?,
            nodes: self.nodes.iter().map(node).collect::<Option<_>>()?,
            order: self.order.clone(),
            surface: OnceLock::new(),
        })
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    pub(crate) fn surface(&self) -> &Surface {
        self.surface.get_or_init(|| Surface::new(&self.vertices, &self.triangles))
    }

    /// The two nodes below one that has more than one triangle: `build` puts those of the first half before the second half.
    pub(crate) fn below(&self, node: u32) -> [u32; 2] {
        [node + 1, node + self.nodes[node as usize].count / 2 * 2]
    }

    pub(crate) fn triangles_of(&self, node: &Node) -> &[u32] {
        &self.order[node.first as usize..][..node.count as usize]
    }

    /// A box, from the mesh's center.
    pub(crate) fn bounds(&self, node: &Node) -> IntervalVec3 {
        IntervalVec3::between(node.low, node.high) - self.center
    }

    /// Three points, from the mesh's center.
    pub(crate) fn corners(&self, triangle: u32) -> [IntervalVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.vertex(v))
    }

    pub(crate) fn vertex(&self, vertex: u32) -> IntervalVec3 {
        IntervalVec3::point(self.vertices[vertex as usize]) - self.center
    }
}

fn middle(node: &Node) -> DVec3 {
    node.low * 0.5 + node.high * 0.5
}

/// Adds the tree of these leaves, which `first` others are before: split at the median of their middles, along the longest side of these.
fn build(nodes: &mut Vec<Node>, first: u32, leaves: &mut [Node]) {
    let (mut low, mut high) = (leaves[0].low, leaves[0].high);
    let (mut least, mut most) = (middle(&leaves[0]), middle(&leaves[0]));
    for leaf in leaves.iter() {
        (low, high) = (low.min(leaf.low), high.max(leaf.high));
        (least, most) = (least.min(middle(leaf)), most.max(middle(leaf)));
    }
    nodes.push(Node { low, high, first, count: leaves.len() as u32 });
    if leaves.len() > 1 {
        let (along, half) = ((most * 0.5 - least * 0.5).max_position(), leaves.len() / 2);
        leaves.select_nth_unstable_by(half, |s, t| middle(s)[along].total_cmp(&middle(t)[along]));
        let (left, right) = leaves.split_at_mut(half);
        build(nodes, first, left);
        build(nodes, first + half as u32, right);
    }
}
