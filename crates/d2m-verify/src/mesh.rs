//! A mesh and its tree of boxes. The boxes are minima and maxima of doubles: they are exact.
use crate::instant::Part;
use crate::solid::Surface;
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;
use std::sync::OnceLock;

/// A mesh that cannot be judged.
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
#[derive(Debug)]
pub struct Mesh {
    pub(crate) vertices: Vec<DVec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// What enclosures are about; any point is right, the middle gives short arms.
    pub(crate) center: DVec3,
    /// The root is node 0.
    pub(crate) nodes: Vec<Node>,
    surface: OnceLock<Surface>,
}

/// A box and what is below it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) part: Part,
    /// Length of the diagonal; it proves nothing.
    pub(crate) size: f64,
    pub(crate) below: Below,
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
        let mut mesh = Self {
            vertices: vertices.to_vec(),
            triangles: triangles.to_vec(),
            center: DVec3::ZERO,
            nodes: Vec::with_capacity(2 * count),
            surface: OnceLock::new(),
        };
        let mut order: Vec<u32> = (0..count as u32).collect();
        let (low, high) = mesh.extent(&order);
        mesh.center = low * 0.5 + high * 0.5;
        mesh.push_node(&order);
        mesh.split(0, &mut order);
        Ok(mesh)
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    pub(crate) fn surface(&self) -> &Surface {
        self.surface.get_or_init(|| Surface::new(&self.vertices, &self.triangles))
    }

    /// Corners of a triangle, from the mesh's center.
    pub(crate) fn corners(&self, triangle: u32) -> [IntervalVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.relative(self.vertices[v as usize]))
    }

    pub(crate) fn relative(&self, p: DVec3) -> IntervalVec3 {
        IntervalVec3::point(p) - IntervalVec3::point(self.center)
    }

    fn extent(&self, part: &[u32]) -> (DVec3, DVec3) {
        let corners =
            part.iter().flat_map(|&t| self.triangles[t as usize]).map(|v| self.vertices[v as usize]);
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)))
    }

    fn push_node(&mut self, part: &[u32]) {
        let (low, high) = self.extent(part);
        let bounds = self.relative(low).hull(self.relative(high));
        let (part, size) = (Part::boxed(bounds), (high - low).length());
        self.nodes.push(Node { part, size, below: Below::Nodes(0) });
    }

    /// Splits a node's triangles at the median along the longest side of its box.
    fn split(&mut self, node: usize, part: &mut [u32]) {
        if let [triangle] = part {
            self.nodes[node].below = Below::Triangle(*triangle);
            return;
        }
        let (low, high) = self.extent(part);
        let along = (high * 0.5 - low * 0.5).max_position();
        let middle = |t: u32| self.triangles[t as usize].map(|v| self.vertices[v as usize][along] / 3.0);
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |&s, &t| {
            let [s_at, t_at] = [s, t].map(|t| middle(t).iter().sum::<f64>());
            s_at.total_cmp(&t_at).then(s.cmp(&t))
        });
        let (left, right) = part.split_at_mut(half);
        let first = self.nodes.len();
        self.nodes[node].below = Below::Nodes(first as u32);
        self.push_node(left);
        self.push_node(right);
        self.split(first, left);
        self.split(first + 1, right);
    }
}

/// What has finite ends. Enclosures that are empty, unbounded or no numbers prove nothing (an empty one would prove everything).
pub(crate) fn finite(v: IntervalVec3) -> Option<IntervalVec3> {
    let is_finite = |i: Interval| i.lo() <= i.hi() && i.lo().is_finite() && i.hi().is_finite();
    (is_finite(v.x) && is_finite(v.y) && is_finite(v.z)).then_some(v)
}
