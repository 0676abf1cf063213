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
    /// The root is node 0.
    pub(crate) nodes: Vec<Node>,
    /// The triangles in the order of the leaves.
    order: Vec<u32>,
    surface: OnceLock<Surface>,
}

/// A box in body axes and what is below it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    pub(crate) below: Below,
    /// Its triangles are those from here on in the order of the leaves, and how many they are.
    pub(crate) leaves: [u32; 2],
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Below {
    Triangle(u32),
    /// This node and the next.
    Nodes(u32),
}

impl Mesh {
    /// The mesh of these triangles.
    ///
    /// # Errors
    /// [`MeshFault`]: no triangles, coordinates that are not finite, vertices that do not exist.
    pub fn try_new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, MeshFault> {
        let count = triangles.len();
        if count == 0 || count > 1 << 30 {
            return Err(MeshFault::Count(count));
        }
        if let Some(vertex) = vertices.iter().position(|p| !p.is_finite()) {
            return Err(MeshFault::NotFinite(vertex));
        }
        let exists = |&v: &u32| (v as usize) < vertices.len();
        if let Some(triangle) = triangles.iter().position(|t| !t.iter().all(exists)) {
            return Err(MeshFault::NoSuchVertex(triangle));
        }
        let leaf = |(number, corners): (usize, &[u32; 3])| {
            let [a, b, c] = corners.map(|v| vertices[v as usize]);
            let (low, high) = (a.min(b).min(c), a.max(b).max(c));
            Node { low, high, below: Below::Triangle(number as u32), leaves: [0, 1] }
        };
        let mut leaves: Vec<Node> = triangles.iter().enumerate().map(leaf).collect();
        let mut nodes = Vec::with_capacity(2 * count);
        nodes.push(leaves[0]);
        build(&mut nodes, 0, 0, &mut leaves);
        let mut order = vec![0; count];
        for node in &nodes {
            if let Below::Triangle(triangle) = node.below {
                order[node.leaves[0] as usize] = triangle;
            }
        }
        let center = nodes[0].low * 0.5 + nodes[0].high * 0.5;
        let (vertices, triangles) = (vertices.to_vec(), triangles.to_vec());
        Ok(Self { vertices, triangles, center, nodes, order, surface: OnceLock::new() })
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    pub(crate) fn surface(&self) -> &Surface {
        self.surface.get_or_init(|| Surface::new(&self.vertices, &self.triangles))
    }

    /// A point of the mesh, from its center.
    pub(crate) fn relative(&self, p: DVec3) -> IntervalVec3 {
        IntervalVec3::point(p) - IntervalVec3::point(self.center)
    }

    pub(crate) fn bounds(&self, node: &Node) -> IntervalVec3 {
        self.relative(node.low).hull(self.relative(node.high))
    }

    /// The corners of all triangles in a box.
    pub(crate) fn points(&self, node: &Node) -> impl Iterator<Item = IntervalVec3> {
        let [first, count] = node.leaves.map(|k| k as usize);
        let corners = self.order[first..first + count].iter().flat_map(|&t| self.triangles[t as usize]);
        corners.map(|v| self.relative(self.vertices[v as usize]))
    }

    /// About the corners of all triangles, from the center.
    pub(crate) fn guesses(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.triangles.iter().map(|ids| ids.map(|v| self.vertices[v as usize] - self.center))
    }

    pub(crate) fn corners(&self, triangle: u32) -> [IntervalVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.relative(self.vertices[v as usize]))
    }
}

/// Puts a tree of these leaves, which `start` others are before, at a node: split at the median of their middles, along the longest side
/// of these, and joined again.
fn build(nodes: &mut Vec<Node>, at: usize, start: u32, leaves: &mut [Node]) {
    if let [leaf] = leaves {
        nodes[at] = Node { leaves: [start, 1], ..*leaf };
        return;
    }
    let middle = |leaf: &Node| leaf.low * 0.5 + leaf.high * 0.5;
    let any = middle(&leaves[0]);
    let (low, high) = leaves.iter().map(middle).fold((any, any), |(l, h), p| (l.min(p), h.max(p)));
    let (along, half) = ((high * 0.5 - low * 0.5).max_position(), leaves.len() / 2);
    leaves.select_nth_unstable_by(half, |s, t| middle(s)[along].total_cmp(&middle(t)[along]));
    let (first, count) = (nodes.len(), leaves.len() as u32);
    let (left, right) = leaves.split_at_mut(half);
    nodes.extend([left[0], right[0]]);
    build(nodes, first, start, left);
    build(nodes, first + 1, start + half as u32, right);
    let [left, right] = [nodes[first], nodes[first + 1]];
    let (low, high) = (left.low.min(right.low), left.high.max(right.high));
    nodes[at] = Node { low, high, below: Below::Nodes(first as u32), leaves: [start, count] };
}

/// What has finite ends. Enclosures that are empty, unbounded or no numbers prove nothing (an empty one would prove everything).
pub(crate) fn finite(v: IntervalVec3) -> Option<IntervalVec3> {
    [v.x, v.y, v.z].iter().all(|i| i.lo() <= i.hi() && i.lo().is_finite() && i.hi().is_finite()).then_some(v)
}
