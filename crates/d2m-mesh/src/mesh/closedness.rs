//! Does a surface close, and into how many parts does it fall? The two questions a solid needs answered, quickly.

use super::disjoint_sets::DisjointSets;
use super::first_equal::{are_distinct, first_at_position};
use crate::{Topology, TriMesh};

/// Answer of both questions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Closedness {
    /// As [`Topology::is_watertight`].
    pub(crate) watertight: bool,
    /// As [`Topology::is_consistently_oriented`].
    pub(crate) oriented: bool,
    /// Triangles that repeat an earlier one with the same orientation, ascending.
    pub(crate) repeated: Vec<u32>,
    /// The lowest vertex of each connected part (equal positions connect), ascending.
    pub(crate) components: Vec<u32>,
    /// No two vertices have equal positions. All else then follows from the triangles alone.
    pub(crate) distinct: bool,
}

impl Closedness {
    pub(crate) fn of(mesh: &TriMesh) -> Self {
        let first = first_at_position(mesh.vertices());
        // An oriented manifold closes and repeats no triangle. Anything else is examined in full.
        let (watertight, oriented, repeated) = if is_oriented_manifold(mesh, &first) {
            (true, true, Vec::new())
        } else {
            let topology = Topology::new(mesh);
            (topology.is_watertight(), topology.is_consistently_oriented(), topology.repeated().to_vec())
        };
        let distinct = (0..).zip(&first).all(|(vertex, &first)| vertex == first);
        Self { watertight, oriented, repeated, components: components(mesh, first), distinct }
    }

    /// That of a mesh with the same triangles and vertices elsewhere.
    pub(crate) fn of_moved(self, mesh: &TriMesh) -> Self {
        if self.distinct && are_distinct(mesh.vertices()) { self } else { Self::of(mesh) }
    }
}

/// Does each side of a triangle run along an edge that exactly one other side runs along, the other way round?
/// Sides without length, and meshes with more than 2³¹ vertices, are answered with no.
fn is_oriented_manifold(mesh: &TriMesh, first: &[u32]) -> bool {
    if first.len() >= 1 << 31 {
        return false;
    }
    // The sides of each lower end, as (higher end, direction), one after the other.
    let mut start = vec![0u32; first.len() + 1];
    let sides = |triangle: &[u32; 3]| {
        let [i, j, k] = triangle.map(|v| first[v as usize]);
        [(i, j), (j, k), (k, i)]
    };
    for triangle in mesh.triangles() {
        for (from, to) in sides(triangle) {
            if from == to {
                return false;
            }
            start[from.min(to) as usize + 1] += 1;
        }
    }
    for i in 1..start.len() {
        start[i] += start[i - 1];
    }
    let mut next = start.clone();
    let mut other = vec![0u32; 3 * mesh.triangle_count()];
    for triangle in mesh.triangles() {
        for (from, to) in sides(triangle) {
            let slot = &mut next[from.min(to) as usize];
            other[*slot as usize] = from.max(to) << 1 | u32::from(from < to);
            *slot += 1;
        }
    }
    start.windows(2).all(|range| {
        let around = &mut other[range[0] as usize..range[1] as usize];
        around.sort_unstable();
        // Sorted, and each pair with both directions: a third side along an edge would break a pair.
        around.chunks(2).all(|pair| pair.len() == 2 && pair[0] & 1 == 0 && pair[1] == pair[0] + 1)
    })
}

/// For each vertex that a triangle uses a vertex that stands for its connected part.
pub(crate) fn part_roots(mesh: &TriMesh) -> Vec<u32> {
    joined(mesh, first_at_position(mesh.vertices()))
}

/// The lowest vertex of each set of triangles that share positions. `first` is what [`first_at_position`] gives.
fn components(mesh: &TriMesh, first: Vec<u32>) -> Vec<u32> {
    let roots = joined(mesh, first);
    let mut used = vec![false; roots.len()];
    for triangle in mesh.triangles() {
        used[roots[triangle[0] as usize] as usize] = true;
    }
    (0..used.len() as u32).filter(|&i| used[i as usize]).collect()
}

/// For each vertex the lowest one of its set.
fn joined(mesh: &TriMesh, first: Vec<u32>) -> Vec<u32> {
    let mut sets = DisjointSets::from_parents(first);
    for &corners in mesh.triangles() {
        sets.join(corners);
    }
    (0..mesh.vertex_count() as u32).map(|i| sets.root(i)).collect()
}
