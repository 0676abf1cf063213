//! Edges, neighbours, closedness and orientation. A *side* is one of the three directed edges of a triangle (a half-edge).

use super::disjoint_sets::DisjointSets;
use super::first_equal::{first_at_position, first_equal};
use crate::TriMesh;

/// "No triangle" in the neighbour lists.
const NONE: u32 = u32::MAX;

/// An undirected edge of a mesh: two different positions joined by a side of at least one triangle.
///
/// ```
/// use d2m_mesh::{Topology, TriMesh};
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
/// let topology = Topology::new(&TriMesh::try_new(corners, vec![[0, 1, 2]])?);
/// let ends: Vec<_> = topology.edges().iter().map(|edge| edge.vertices).collect();
/// assert_eq!(ends, [[0, 1], [0, 2], [1, 2]]);
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Edge {
    /// The two ends: vertex indices of the mesh (the lowest index at each position), smaller first.
    pub vertices: [u32; 2],
    triangles: [u32; 2],
    forward: u32,
    backward: u32,
}

impl Edge {
    /// How many triangle sides lie on this edge: 1 on a boundary, 2 on a closed manifold.
    pub fn incidence(&self) -> u32 {
        self.forward + self.backward
    }

    /// The lowest-numbered triangle at this edge.
    pub fn first_triangle(&self) -> u32 {
        self.triangles[0]
    }

    /// The second triangle at this edge, in number order; none on a boundary.
    pub(crate) fn second_triangle(&self) -> Option<u32> {
        (self.triangles[1] != NONE).then_some(self.triangles[1])
    }

    /// As many sides run from the first end to the second as the other way: the faces on both sides agree about
    /// which side is out.
    pub fn is_consistently_oriented(&self) -> bool {
        self.forward == self.backward
    }
}

/// The combinatorics of a [`TriMesh`], computed on *positions*: vertices with equal coordinates (−0 = 0) count as one,
/// so a mesh whose corners were duplicated at seams (STL, texture seams) is as closed as it looks.
///
/// A triangle with two corners at one position and a repetition of an earlier triangle (same corners, same
/// orientation) are left out, so they change neither closedness nor orientation.
///
/// ```
/// use d2m_mesh::{Topology, TriMesh};
/// use glam::DVec3;
///
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let topology = Topology::new(&mesh);
/// assert_eq!(topology.edges().len(), 6);
/// assert!(topology.is_watertight());
/// assert_eq!(topology.euler_characteristic(), 2);
/// assert_eq!(topology.neighbour(0, 1), Some(3)); // across the side from corner 1 to corner 2: vertices 2 and 1
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Topology {
    representative: Vec<u32>,
    edges: Vec<Edge>,
    triangle_edges: Vec<[u32; 3]>,
    position_count: usize,
    face_count: usize,
    repeated: Vec<u32>,
    component_count: usize,
}

impl Topology {
    /// Computes the combinatorics in O(n log n) time.
    pub fn new(mesh: &TriMesh) -> Self {
        let representative = first_at_position(mesh.vertices());
        let ends = |corners: &[u32; 3]| corners.map(|vertex| representative[vertex as usize]);
        let first = first_equal(mesh.triangles(), |corners| smallest_first(ends(corners)).map(u64::from));
        let mut sides: Vec<Side> = Vec::with_capacity(3 * mesh.triangle_count());
        let mut used = vec![false; mesh.vertex_count()];
        let mut components = DisjointSets::new(mesh.vertex_count());
        let mut repeated = Vec::new();
        let mut face_count = 0;
        for (triangle, corners) in mesh.triangles().iter().enumerate() {
            let corners = ends(corners);
            if first[triangle] as usize != triangle {
                repeated.push(triangle as u32);
                continue;
            }
            if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
                continue;
            }
            face_count += 1;
            components.join(corners);
            for vertex in corners {
                used[vertex as usize] = true;
            }
            for slot in 0..3 {
                let (from, to) = (corners[slot], corners[(slot + 1) % 3]);
                let slot = slot as u8;
                sides.push(Side {
                    low: from.min(to),
                    high: from.max(to),
                    triangle: triangle as u32,
                    slot,
                    forward: from < to,
                });
            }
        }
        sides.sort_unstable_by_key(|side| (side.low, side.high, side.triangle, side.slot));
        let mut edges: Vec<Edge> = Vec::with_capacity(sides.len() / 2);
        let mut triangle_edges = vec![[NONE; 3]; mesh.triangle_count()];
        for side in &sides {
            let ends = [side.low, side.high];
            if edges.last().is_none_or(|edge| edge.vertices != ends) {
                edges.push(Edge {
                    vertices: ends,
                    triangles: [side.triangle, NONE],
                    forward: 0,
                    backward: 0,
                });
            }
            let number = edges.len() as u32 - 1;
            let edge = &mut edges[number as usize];
            if side.triangle != edge.triangles[0] && edge.triangles[1] == NONE {
                edge.triangles[1] = side.triangle;
            }
            if side.forward {
                edge.forward += 1;
            } else {
                edge.backward += 1;
            }
            triangle_edges[side.triangle as usize][side.slot as usize] = number;
        }
        let position_count = used.iter().filter(|&&is_used| is_used).count();
        let roots = (0..mesh.vertex_count() as u32)
            .filter(|&vertex| used[vertex as usize] && components.root(vertex) == vertex);
        let component_count = roots.count();
        Self { representative, edges, triangle_edges, position_count, face_count, repeated, component_count }
    }

    /// The unique edges, sorted by their ends.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The number of the edge under side `side` of a triangle (from corner `side` to corner `side + 1`); none if the
    /// side has length zero or the triangle repeats an earlier one.
    ///
    /// # Panics
    /// If `triangle` or `side` is out of range.
    pub fn edge_of(&self, triangle: u32, side: usize) -> Option<u32> {
        let number = self.triangle_edges[triangle as usize][side];
        (number != NONE).then_some(number)
    }

    /// The triangle across side `side`, on an edge with exactly two triangles.
    ///
    /// # Panics
    /// If `triangle` or `side` is out of range.
    pub fn neighbour(&self, triangle: u32, side: usize) -> Option<u32> {
        let edge = &self.edges[self.edge_of(triangle, side)? as usize];
        let other = edge.second_triangle().filter(|_| edge.incidence() == 2)?;
        Some(if other == triangle { edge.first_triangle() } else { other })
    }

    /// The lowest vertex index at the position of `vertex`.
    ///
    /// # Panics
    /// If `vertex` is out of range.
    pub fn representative(&self, vertex: u32) -> u32 {
        self.representative[vertex as usize]
    }

    /// Every edge carries an even number of sides: the surface is a cycle modulo 2, so "inside" is well defined by
    /// counting crossings. This is what `Solid::Filled` needs.
    pub fn is_watertight(&self) -> bool {
        self.edges.iter().all(|edge| edge.incidence() % 2 == 0)
    }

    /// Every edge is run through equally often in both directions (so the mesh is also watertight).
    pub fn is_consistently_oriented(&self) -> bool {
        self.edges.iter().all(Edge::is_consistently_oriented)
    }

    /// Every edge carries exactly two sides, run through in opposite directions.
    pub fn is_oriented_manifold(&self) -> bool {
        self.edges.iter().all(|edge| edge.forward == 1 && edge.backward == 1)
    }

    /// Positions − edges + faces: 2 for each sphere-like part, 0 for each torus-like one.
    pub fn euler_characteristic(&self) -> i64 {
        self.position_count as i64 - self.edges.len() as i64 + self.face_count as i64
    }

    /// How many connected parts there are: shared positions connect (of triangles that are not left out).
    pub fn component_count(&self) -> usize {
        self.component_count
    }

    /// Different positions that are used by triangles.
    pub fn position_count(&self) -> usize {
        self.position_count
    }

    /// The triangles that repeat an earlier one with the same orientation, ascending.
    pub(crate) fn repeated(&self) -> &[u32] {
        &self.repeated
    }
}

struct Side {
    low: u32,
    high: u32,
    triangle: u32,
    slot: u8,
    forward: bool,
}

/// Rotates the triple so that its smallest member comes first; the orientation stays.
fn smallest_first([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
