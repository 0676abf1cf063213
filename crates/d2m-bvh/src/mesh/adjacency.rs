//! What is next to each vertex and edge of a mesh, and which triangle answers for it: what tests of normal cones need.

use super::closedness::first_at_position;
use crate::TriMesh;

/// "Not this triangle's": in the lists of owned features.
pub(crate) const NONE: u32 = u32::MAX;

/// Features that one triangle answers for, so that a search which meets pairs of triangles meets each pair of features
/// once: a vertex and an edge belong to the lowest-numbered triangle that holds them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct OwnedFeatures {
    /// Vertices of the three corners (the lowest vertex at the position), or [`NONE`].
    pub(crate) vertices: [u32; 3],
    /// Edges under the sides from corner k to corner k + 1, or [`NONE`].
    pub(crate) edges: [u32; 3],
}

/// Neighbours of the vertices and edges of a mesh, computed on positions: vertices with equal coordinates count as one.
///
/// Degenerate triangles are the segments or points that their corners span: their sides are edges like any other, and
/// a side without length is none.
#[derive(Clone, Debug)]
pub(crate) struct Adjacency {
    owned: Vec<OwnedFeatures>,
    /// Ends of each edge: the lowest vertices at their positions, smaller first.
    edges: Vec<[u32; 2]>,
    neighbours: Lists,
    opposites: Lists,
}

/// Lists of vertices, one after the other.
#[derive(Clone, Debug)]
struct Lists {
    start: Vec<u32>,
    items: Vec<u32>,
}

impl Lists {
    /// From pairs (number of the list, item), which are sorted and freed of repetitions.
    fn new(count: usize, mut pairs: Vec<(u32, u32)>) -> Self {
        pairs.sort_unstable();
        pairs.dedup();
        let mut start = vec![0u32; count + 1];
        for &(list, _) in &pairs {
            start[list as usize + 1] += 1;
        }
        for list in 0..count {
            start[list + 1] += start[list];
        }
        Self { start, items: pairs.into_iter().map(|(_, item)| item).collect() }
    }

    fn of(&self, list: u32) -> &[u32] {
        &self.items[self.start[list as usize] as usize..self.start[list as usize + 1] as usize]
    }
}

impl Adjacency {
    /// In O(n log n) time.
    pub(crate) fn new(mesh: &TriMesh) -> Self {
        let first = first_at_position(mesh.vertices());
        let welded = |triangle: usize| mesh.triangles()[triangle].map(|vertex| first[vertex as usize]);
        let mut owned = vec![OwnedFeatures { vertices: [NONE; 3], edges: [NONE; 3] }; mesh.triangle_count()];
        let mut seen = vec![false; mesh.vertex_count()];
        // Ends, triangle and side of each side with a length.
        let mut sides: Vec<([u32; 2], u32, u32)> = Vec::with_capacity(3 * mesh.triangle_count());
        for (triangle, own) in owned.iter_mut().enumerate() {
            let corners = welded(triangle);
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                if !core::mem::replace(&mut seen[from as usize], true) {
                    own.vertices[side] = from;
                }
                if from != to {
                    sides.push(([from.min(to), from.max(to)], triangle as u32, side as u32));
                }
            }
        }
        sides.sort_unstable();
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(sides.len() / 2);
        let mut neighbours = Vec::with_capacity(sides.len());
        let mut opposites = Vec::with_capacity(sides.len());
        for &(ends, triangle, side) in &sides {
            if edges.last() != Some(&ends) {
                owned[triangle as usize].edges[side as usize] = edges.len() as u32;
                neighbours.extend([(ends[0], ends[1]), (ends[1], ends[0])]);
                edges.push(ends);
            }
            let opposite = welded(triangle as usize)[(side as usize + 2) % 3];
            if !ends.contains(&opposite) {
                opposites.push((edges.len() as u32 - 1, opposite));
            }
        }
        let neighbours = Lists::new(mesh.vertex_count(), neighbours);
        let opposites = Lists::new(edges.len(), opposites);
        Self { owned, edges, neighbours, opposites }
    }

    /// What a triangle answers for.
    pub(crate) fn owned(&self, triangle: u32) -> &OwnedFeatures {
        &self.owned[triangle as usize]
    }

    /// The ends of an edge.
    pub(crate) fn ends(&self, edge: u32) -> [u32; 2] {
        self.edges[edge as usize]
    }

    /// The other ends of the edges at a vertex.
    pub(crate) fn neighbours(&self, vertex: u32) -> &[u32] {
        self.neighbours.of(vertex)
    }

    /// The third corners of the triangles at an edge.
    pub(crate) fn opposites(&self, edge: u32) -> &[u32] {
        self.opposites.of(edge)
    }

    /// Resident bytes.
    pub(crate) fn memory_bytes(&self) -> usize {
        let lists = [&self.neighbours, &self.opposites];
        let lists: usize = lists.iter().map(|l| size_of_val(&*l.start) + size_of_val(&*l.items)).sum();
        size_of_val(&*self.owned) + size_of_val(&*self.edges) + lists
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn each_vertex_and_edge_belongs_to_one_triangle_and_degenerate_sides_are_edges() {
        // Two triangles at an edge, the second with its own copies of two corners; then a needle and a point.
        let vertices = vec![
            DVec3::ZERO,
            DVec3::X,
            DVec3::Y,
            DVec3::Y,
            DVec3::X,
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::Z,
            DVec3::new(9.0, 0.0, 0.0),
        ];
        let triangles = vec![[0, 1, 2], [4, 5, 3], [0, 0, 6], [7, 7, 7]];
        let adjacency = Adjacency::new(&TriMesh::try_new(vertices, triangles).unwrap());
        let mut edges = adjacency.edges.clone();
        edges.sort_unstable();
        assert_eq!(edges, [[0, 1], [0, 2], [0, 6], [1, 2], [1, 5], [2, 5]]);
        let diagonal = adjacency.edges.iter().position(|e| *e == [1, 2]).unwrap() as u32;
        assert_eq!(adjacency.opposites(diagonal), [0, 5]);
        assert_eq!(adjacency.neighbours(1), [0, 2, 5]);
        assert_eq!(adjacency.neighbours(0), [1, 2, 6]);
        assert_eq!(adjacency.owned(0).vertices, [0, 1, 2]);
        assert_eq!(adjacency.owned(1).vertices, [NONE, 5, NONE]);
        assert_eq!(adjacency.owned(2).vertices, [NONE, NONE, 6]);
        assert_eq!(adjacency.owned(3).vertices, [7, NONE, NONE]);
        let owners: usize =
            (0..4).map(|t| adjacency.owned(t).edges.iter().filter(|&&e| e != NONE).count()).sum();
        assert_eq!(owners, adjacency.edges.len());
    }
}
