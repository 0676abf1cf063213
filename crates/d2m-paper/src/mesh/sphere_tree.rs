//! The augmented R-tree of the paper (section VI-A): beams subdivided to a smallest rib, with the minimal enclosing
//! sphere of the raw geometry at every node.

use d2m_bvh::{EnclosingSphere, MeshTree, Topology, TriMesh};
use glam::DVec3;
use std::collections::HashSet;

/// ε of the paper, as a part of the body's radius.
const RIB: f64 = 1.0 / 32.0;

/// A node: the smallest sphere around its raw geometry, and two children or the content of a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) sphere: EnclosingSphere,
    /// Indices of the children; equal to 0 (the root) at a leaf.
    pub(crate) children: [u32; 2],
    /// Index of the leaf content, at a leaf.
    pub(crate) leaf: u32,
}

impl Node {
    pub(crate) const fn is_leaf(&self) -> bool {
        self.children[0] == 0
    }
}

/// The collision geometry of a leaf: its triangles, and of their vertices and sides those that no other leaf owns.
///
/// Every vertex and every edge of the mesh belongs to exactly one leaf, which holds a triangle at it. So each pair of
/// features of two bodies is tested by exactly one pair of leaves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Leaf {
    pub(crate) triangles: Vec<u32>,
    /// The vertices at its triangles, each once.
    pub(crate) vertices: Vec<u32>,
    /// The vertices of its triangles, as indices of `vertices`.
    pub(crate) local: Vec<[u32; 3]>,
    pub(crate) owned_vertices: Vec<OwnedVertex>,
    pub(crate) owned_edges: Vec<OwnedEdge>,
}

/// A vertex that belongs to a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OwnedVertex {
    pub(crate) vertex: u32,
    /// A triangle of the leaf at the vertex.
    pub(crate) triangle: u32,
}

/// An edge that belongs to a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OwnedEdge {
    /// The vertices at its ends, the smaller number first.
    pub(crate) ends: [u32; 2],
    /// A triangle of the leaf at the edge.
    pub(crate) triangle: u32,
}

/// The paper's bounding-volume hierarchy of one body: binary, leaf beams no longer than ε = 1/32 of the body's radius
/// unless a single triangle is longer, a minimal enclosing sphere of the raw geometry at every node.
///
/// ```text
///  beam ┌───────┬──────┐   halved across its longest side; a tight beam is fitted around each
///       │ ╱╲    │   ╱╲ │   half's triangles; and so on down to ribs of ε.
///       │╱__╲___│__╱__╲│   Spheres enclose the triangles, not the children's spheres.
///       └───────┴──────┘
/// ```
///
/// ```
/// use d2m_bvh::TriMesh;
/// use d2m_paper::SphereTree;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = SphereTree::new(mesh);
/// assert_eq!(tree.leaf_count(), 4);
/// assert!(tree.is_watertight());
/// # Ok::<(), d2m_bvh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SphereTree {
    /// The mesh, and the tree by which the start of a window is judged.
    boxes: MeshTree,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

impl SphereTree {
    /// The tree with beams subdivided until their longest rib is at most 1/32 of the body's radius.
    ///
    /// # Panics
    /// If `mesh` has no triangle.
    pub fn new(mesh: TriMesh) -> Self {
        let topology = Topology::new(&mesh);
        let count = mesh.triangle_count();
        assert!(count > 0, "a body needs a triangle");
        let centroids: Vec<DVec3> = (0..count)
            .map(|i| {
                let [a, b, c] = mesh.corners(i);
                (a + b + c) / 3.0
            })
            .collect();
        let mut triangles: Vec<u32> = (0..count as u32).collect();
        let mut build = Build { mesh: &mesh, centroids: &centroids, rib: 0.0, nodes: vec![], leaves: vec![] };
        build.rib = RIB * build.sphere(&triangles).radius;
        build.node(&mut triangles);
        let (nodes, mut leaves) = (build.nodes, build.leaves);
        assign_features(&mesh, &topology, &mut leaves);
        Self { boxes: MeshTree::new(mesh), nodes, leaves }
    }

    /// The mesh.
    pub const fn mesh(&self) -> &TriMesh {
        self.boxes.mesh()
    }

    /// The same mesh as the default engine has it.
    pub(crate) const fn boxes(&self) -> &MeshTree {
        &self.boxes
    }

    /// The number of leaves.
    pub fn leaf_count(&self) -> usize {
        self.leaves.len()
    }

    /// The number of nodes, leaves included.
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The smallest sphere around the body, body frame.
    pub fn bounding_sphere(&self) -> EnclosingSphere {
        self.nodes[0].sphere
    }

    /// Does the surface close?
    pub const fn is_watertight(&self) -> bool {
        self.boxes.is_watertight()
    }

    pub(crate) fn node(&self, index: u32) -> &Node {
        &self.nodes[index as usize]
    }

    pub(crate) fn leaf(&self, node: &Node) -> &Leaf {
        &self.leaves[node.leaf as usize]
    }

    pub(crate) fn vertex(&self, index: u32) -> DVec3 {
        self.mesh().vertices()[index as usize]
    }

    pub(crate) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.mesh().corners(triangle as usize)
    }
}

struct Build<'a> {
    mesh: &'a TriMesh,
    centroids: &'a [DVec3],
    rib: f64,
    nodes: Vec<Node>,
    leaves: Vec<Leaf>,
}

impl Build<'_> {
    /// The smallest sphere around the vertices of the triangles.
    fn sphere(&self, triangles: &[u32]) -> EnclosingSphere {
        let mut ids: Vec<u32> = triangles.iter().flat_map(|&t| self.mesh.triangles()[t as usize]).collect();
        ids.sort_unstable();
        ids.dedup();
        let points: Vec<DVec3> = ids.iter().map(|&i| self.mesh.vertices()[i as usize]).collect();
        EnclosingSphere::of_points(&points).expect("a node holds a triangle")
    }

    /// The tight beam around the vertices of the triangles: its least and greatest coordinates.
    fn beam(&self, triangles: &[u32]) -> (DVec3, DVec3) {
        let corners = triangles.iter().flat_map(|&t| self.mesh.corners(t as usize));
        corners.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)))
    }

    fn leaf(&self, triangles: &[u32]) -> Leaf {
        let ids = |t: u32| self.mesh.triangles()[t as usize];
        let mut vertices: Vec<u32> = triangles.iter().flat_map(|&t| ids(t)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let place = |v: u32| vertices.partition_point(|&c| c < v) as u32;
        let local = triangles.iter().map(|&t| ids(t).map(place)).collect();
        Leaf { triangles: triangles.to_vec(), vertices, local, ..Leaf::default() }
    }

    fn node(&mut self, triangles: &mut [u32]) -> u32 {
        let index = self.nodes.len() as u32;
        let sphere = self.sphere(triangles);
        self.nodes.push(Node { sphere, children: [0, 0], leaf: 0 });
        let (lo, hi) = self.beam(triangles);
        let ribs = hi - lo;
        if triangles.len() == 1 || ribs.max_element() <= self.rib {
            self.nodes[index as usize].leaf = self.leaves.len() as u32;
            self.leaves.push(self.leaf(triangles));
            return index;
        }
        let middle = self.split(triangles, lo, hi);
        let (left, right) = triangles.split_at_mut(middle);
        let children = [self.node(left), self.node(right)];
        self.nodes[index as usize].children = children;
        index
    }

    /// Parts the triangles at the middle of the beam's broadest dimension, by centroid; where that leaves one side
    /// empty, at the middle of the centroids, and at last by number.
    fn split(&self, triangles: &mut [u32], lo: DVec3, hi: DVec3) -> usize {
        let (c_lo, c_hi) = triangles.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), &t| {
            let c = self.centroids[t as usize];
            (lo.min(c), hi.max(c))
        });
        for (lo, hi) in [(lo, hi), (c_lo, c_hi)] {
            let ribs = hi - lo;
            let axis = (0..3).max_by(|&i, &j| ribs[i].total_cmp(&ribs[j])).unwrap_or(0);
            let plane = 0.5 * lo[axis] + 0.5 * hi[axis];
            triangles.sort_unstable_by_key(|&t| (self.centroids[t as usize][axis] > plane, t));
            let left = triangles.partition_point(|&t| self.centroids[t as usize][axis] <= plane);
            if left > 0 && left < triangles.len() {
                return left;
            }
        }
        triangles.len() / 2
    }
}

/// Gives every vertex and every edge to the first leaf that holds a triangle at it. Equal positions are one vertex.
fn assign_features(mesh: &TriMesh, topology: &Topology, leaves: &mut [Leaf]) {
    let mut vertices = vec![false; mesh.vertex_count()];
    let mut edges = HashSet::new();
    for leaf in leaves {
        for &t in &leaf.triangles {
            let corners = mesh.triangles()[t as usize].map(|v| topology.representative(v));
            for (i, &v) in corners.iter().enumerate() {
                if !core::mem::replace(&mut vertices[v as usize], true) {
                    leaf.owned_vertices.push(OwnedVertex { vertex: v, triangle: t });
                }
                let w = corners[(i + 1) % 3];
                let ends = [v.min(w), v.max(w)];
                if v != w && edges.insert(ends) {
                    leaf.owned_edges.push(OwnedEdge { ends, triangle: t });
                }
            }
        }
    }
}
