//! What is next to each vertex and edge of a mesh, and which triangle answers for it: what tests of normal cones need.

use super::first_equal::first_at_position;
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
    /// Ascending items without repetitions. `visit` calls its argument with (number of the list, item) for each item, twice
    /// in all, the same both times: items are counted, then put where they belong, so that only short lists are sorted.
    fn new(count: usize, visit: impl Fn(&mut dyn FnMut(u32, u32))) -> Self {
        let mut start = vec![0u32; count + 1];
        visit(&mut |list, _| start[list as usize + 1] += 1);
        for list in 0..count {
            start[list + 1] += start[list];
        }
        let mut items = vec![0; start[count] as usize];
        let mut next = start.clone();
        visit(&mut |list, item| {
            let place = &mut next[list as usize];
            items[*place as usize] = item;
            *place += 1;
        });
        let mut kept = 0;
        for list in 0..count {
            let (from, to) = (start[list] as usize, start[list + 1] as usize);
            items[from..to].sort_unstable();
            start[list] = kept as u32;
            for at in from..to {
                if kept == start[list] as usize || items[kept - 1] != items[at] {
                    items[kept] = items[at];
                    kept += 1;
                }
            }
        }
        start[count] = kept as u32;
        items.truncate(kept);
        items.shrink_to_fit();
        Self { start, items }
    }

    fn of(&self, list: u32) -> &[u32] {
        &self.items[self.start[list as usize] as usize..self.start[list as usize + 1] as usize]
    }
}

/// A side of a triangle with a length, by the higher of its two ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    high: u32,
    triangle: u32,
    /// From corner `slot` to corner `slot + 1`.
    slot: u32,
}

/// All sides with a length, by the lower of their two ends.
struct Sides {
    start: Vec<u32>,
    all: Vec<Side>,
}

impl Sides {
    /// Counted, then put where they belong: only the few sides of one vertex are sorted.
    fn new(mesh: &TriMesh, first: &[u32]) -> Self {
        let each = |put: &mut dyn FnMut(u32, Side)| {
            for (triangle, corners) in mesh.triangles().iter().enumerate() {
                let [i, j, k] = corners.map(|vertex| first[vertex as usize]);
                for (slot, (from, to)) in [(i, j), (j, k), (k, i)].into_iter().enumerate() {
                    if from != to {
                        let (triangle, slot) = (triangle as u32, slot as u32);
                        put(from.min(to), Side { high: from.max(to), triangle, slot });
                    }
                }
            }
        };
        let mut start = vec![0u32; first.len() + 1];
        each(&mut |low, _| start[low as usize + 1] += 1);
        for vertex in 0..first.len() {
            start[vertex + 1] += start[vertex];
        }
        let mut all = vec![Side::default(); start[first.len()] as usize];
        let mut next = start.clone();
        each(&mut |low, side| {
            let place = &mut next[low as usize];
            all[*place as usize] = side;
            *place += 1;
        });
        for range in start.windows(2) {
            all[range[0] as usize..range[1] as usize].sort_unstable();
        }
        Self { start, all }
    }

    fn from(&self, low: u32) -> &[Side] {
        &self.all[self.start[low as usize] as usize..self.start[low as usize + 1] as usize]
    }
}

impl Adjacency {
    /// In time O(n log k), k the most sides at one vertex.
    pub(crate) fn new(mesh: &TriMesh) -> Self {
        let first = first_at_position(mesh.vertices());
        let welded = |triangle: usize| mesh.triangles()[triangle].map(|vertex| first[vertex as usize]);
        let mut owned = vec![OwnedFeatures { vertices: [NONE; 3], edges: [NONE; 3] }; mesh.triangle_count()];
        let mut seen = vec![false; mesh.vertex_count()];
        for (triangle, own) in owned.iter_mut().enumerate() {
            for (side, vertex) in welded(triangle).into_iter().enumerate() {
                if !core::mem::replace(&mut seen[vertex as usize], true) {
                    own.vertices[side] = vertex;
                }
            }
        }
        let sides = Sides::new(mesh, &first);
        let mut edges: Vec<[u32; 2]> = Vec::with_capacity(sides.all.len() / 2);
        // Edge and third corner of each side.
        let mut thirds: Vec<(u32, u32)> = Vec::with_capacity(sides.all.len());
        for low in 0..mesh.vertex_count() as u32 {
            for &Side { high, triangle, slot } in sides.from(low) {
                if edges.last() != Some(&[low, high]) {
                    owned[triangle as usize].edges[slot as usize] = edges.len() as u32;
                    edges.push([low, high]);
                }
                let opposite = welded(triangle as usize)[(slot as usize + 2) % 3];
                if ![low, high].contains(&opposite) {
                    thirds.push((edges.len() as u32 - 1, opposite));
                }
            }
        }
        let neighbours = Lists::new(mesh.vertex_count(), |put| {
            for &[low, high] in &edges {
                put(low, high);
                put(high, low);
            }
        });
        let opposites = Lists::new(edges.len(), |put| {
            for &(edge, third) in &thirds {
                put(edge, third);
            }
        });
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

    /// Against maps and sets, on soups in which vertices, edges and triangles are repeated.
    #[test]
    fn equals_what_maps_and_sets_say() {
        use d2m_testing::{Draw, KnuthRandom};
        use std::collections::{BTreeMap, BTreeSet};
        let index =
            |random: &mut KnuthRandom, count: usize| ((0.5 + 0.5 * random.signed()) * count as f64) as usize;
        let mut random = KnuthRandom(5);
        for _ in 0..200 {
            let count = 4 + index(&mut random, 12);
            let vertices: Vec<_> = (0..count)
                .map(|_| DVec3::new(index(&mut random, 2) as f64, index(&mut random, 4) as f64, 0.0))
                .collect();
            let triangles: Vec<_> = (0..=index(&mut random, 20))
                .map(|_| [0; 3].map(|_: u32| index(&mut random, count) as u32))
                .collect();
            let first = |v: u32| vertices.iter().position(|p| *p == vertices[v as usize]).unwrap() as u32;
            let mut around: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
            let mut thirds: BTreeMap<[u32; 2], BTreeSet<u32>> = BTreeMap::new();
            let mut owner: BTreeMap<[u32; 2], (u32, usize)> = BTreeMap::new();
            for (triangle, corners) in triangles.iter().enumerate() {
                let corners = corners.map(first);
                for side in 0..3 {
                    let [from, to, third] = [0, 1, 2].map(|k| corners[(side + k) % 3]);
                    if from == to {
                        continue;
                    }
                    let ends = [from.min(to), from.max(to)];
                    owner.entry(ends).or_insert((triangle as u32, side));
                    around.entry(from).or_default().insert(to);
                    around.entry(to).or_default().insert(from);
                    let opposite = thirds.entry(ends).or_default();
                    if !ends.contains(&third) {
                        opposite.insert(third);
                    }
                }
            }
            let adjacency = Adjacency::new(&TriMesh::try_new(vertices.clone(), triangles).unwrap());
            assert_eq!(adjacency.edges, thirds.keys().copied().collect::<Vec<_>>());
            for (edge, (ends, opposite)) in thirds.iter().enumerate() {
                assert!(adjacency.opposites(edge as u32).iter().eq(opposite));
                let (triangle, side) = owner[ends];
                assert_eq!(adjacency.owned(triangle).edges[side], edge as u32);
            }
            for vertex in 0..count as u32 {
                assert!(adjacency.neighbours(vertex).iter().eq(around.get(&vertex).into_iter().flatten()));
            }
        }
    }

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
