//! What is unusual about a mesh: counts for a report, never a refusal.

use super::disjoint_sets::DisjointSets;
use crate::{Topology, TriMesh};
use d2m_feature::orient2d;
use glam::{DVec2, DVec3, Vec3Swizzles};

/// Counts of everything that a careful user would want to know about a mesh before asking about contacts.
///
/// None of it is an error: queries give their promise for every [`TriMesh`]. Only [`watertight`](Self::watertight)
/// decides something: whether the mesh may be used as a filled solid.
///
/// ```
/// use d2m_mesh::{TriMesh, Validation};
/// use glam::DVec3;
///
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// // One face missing, one face twice, one face without area.
/// let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [0, 2, 1], [1, 1, 2]];
/// let validation = Validation::new(&TriMesh::try_new(corners, faces)?);
/// assert_eq!(validation.duplicate_triangles, 1);
/// assert_eq!(validation.degenerate_triangles, 1);
/// assert_eq!(validation.boundary_edges, 3);
/// assert!(!validation.watertight);
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Validation {
    /// Triangles whose corners lie on a line or coincide, decided exactly. They count as segments or points.
    pub degenerate_triangles: usize,
    /// Triangles that repeat an earlier one with the same orientation.
    pub duplicate_triangles: usize,
    /// Vertices at the position of an earlier vertex.
    pub duplicate_vertices: usize,
    /// Vertices that no triangle uses. They are not part of the body.
    pub unused_vertices: usize,
    /// Edges with one triangle.
    pub boundary_edges: usize,
    /// Edges with three or more triangles.
    pub non_manifold_edges: usize,
    /// Edges with two triangles that disagree about the outside.
    pub inconsistent_edges: usize,
    /// Positions at which the surface is connected by the vertex alone: the triangles there form several fans.
    pub pinched_vertices: usize,
    /// Connected parts; shared positions connect.
    pub components: usize,
    /// Positions − edges + faces.
    pub euler_characteristic: i64,
    /// Every edge carries an even number of triangles.
    pub watertight: bool,
    /// Every edge is run through equally often in both directions.
    pub consistently_oriented: bool,
    /// Enclosed volume by the divergence theorem, Σ a·(b × c)/6 about the center of the bounding box, rounded; positive
    /// if the faces are oriented outwards. Meaningful if consistently oriented.
    pub signed_volume: f64,
    /// Sum of the triangles' areas, rounded.
    pub area: f64,
    /// Smallest coordinates of the used vertices.
    pub bounds_low: [f64; 3],
    /// Largest coordinates of the used vertices.
    pub bounds_high: [f64; 3],
}

impl Validation {
    /// Examines the mesh in O(n log n) time.
    pub fn new(mesh: &TriMesh) -> Self {
        Self::with_topology(mesh, &Topology::new(mesh))
    }

    /// As [`new`](Self::new) when the topology is at hand.
    ///
    /// # Panics
    /// May panic if `topology` belongs to another mesh.
    pub fn with_topology(mesh: &TriMesh, topology: &Topology) -> Self {
        let mut used = vec![false; mesh.vertex_count()];
        for &vertex in mesh.triangles().iter().flatten() {
            used[vertex as usize] = true;
        }
        let [low, high] = mesh.extent();
        let middle = low + (high - low) * 0.5;
        let (mut area, mut volume, mut degenerate_triangles) = (0.0, 0.0, 0);
        for triangle in 0..mesh.triangle_count() {
            let [a, b, c] = mesh.corners(triangle);
            let twice = (b - a).cross(c - a);
            degenerate_triangles += usize::from(is_collinear(a, b, c));
            area += twice.length() * 0.5;
            volume += (a - middle).dot((b - middle).cross(c - middle)) / 6.0;
        }
        let count = |test: &dyn Fn(u32) -> bool| {
            topology.edges().iter().filter(|edge| test(edge.incidence())).count()
        };
        let duplicates = |vertex: &u32| topology.representative(*vertex) != *vertex;
        Self {
            degenerate_triangles,
            duplicate_triangles: topology.repeated().len(),
            duplicate_vertices: (0..mesh.vertex_count() as u32).filter(duplicates).count(),
            unused_vertices: used.iter().filter(|&&is_used| !is_used).count(),
            boundary_edges: count(&|incidence| incidence == 1),
            non_manifold_edges: count(&|incidence| incidence > 2),
            inconsistent_edges: topology
                .edges()
                .iter()
                .filter(|edge| edge.incidence() == 2 && !edge.is_consistently_oriented())
                .count(),
            pinched_vertices: pinched_vertices(mesh, topology),
            components: topology.component_count(),
            euler_characteristic: topology.euler_characteristic(),
            watertight: topology.is_watertight(),
            consistently_oriented: topology.is_consistently_oriented(),
            signed_volume: volume,
            area,
            bounds_low: low.to_array(),
            bounds_high: high.to_array(),
        }
    }
}

/// All three axis-parallel projections are on a line, and then the points are.
fn is_collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let flat = |project: fn(DVec3) -> DVec2| orient2d(project(a), project(b), project(c)).is_eq();
    flat(DVec3::xy) && flat(DVec3::yz) && flat(DVec3::zx)
}

/// Positions whose triangles are not all joined through edges at that position.
fn pinched_vertices(mesh: &TriMesh, topology: &Topology) -> usize {
    // Sets of corners of triangles, numbered 3·triangle + slot.
    let corner_count = 3 * mesh.triangle_count();
    let mut joined = DisjointSets::new(corner_count);
    let mut first_side = vec![None; topology.edges().len()];
    let at =
        |corner: u32| topology.representative(mesh.triangles()[corner as usize / 3][corner as usize % 3]);
    let sides = (0..mesh.triangle_count() as u32).flat_map(|t| (0..3).map(move |slot| (t, slot)));
    let mut counted = vec![false; corner_count];
    for (triangle, slot) in sides {
        let Some(edge) = topology.edge_of(triangle, slot) else { continue };
        let ends = [3 * triangle + slot as u32, 3 * triangle + (slot as u32 + 1) % 3];
        counted[ends[0] as usize] = true;
        let Some(first) = first_side[edge as usize] else {
            first_side[edge as usize] = Some(ends);
            continue;
        };
        for end in ends {
            let other: [u32; 2] = first;
            let same = if at(other[0]) == at(end) { other[0] } else { other[1] };
            joined.join([end, same]);
        }
    }
    let mut fans = vec![0u8; mesh.vertex_count()];
    for corner in 0..corner_count as u32 {
        if counted[corner as usize] && joined.root(corner) == corner {
            let fans = &mut fans[at(corner) as usize];
            *fans = fans.saturating_add(1);
        }
    }
    fans.iter().filter(|&&fans| fans > 1).count()
}
