//! Which triangles meet at a vertex.

use d2m_bvh::TriMesh;
use d2m_feature::FeaturePair;
use glam::DVec3;

/// Triangles by vertex, and their normals.
#[derive(Debug)]
pub(crate) struct Faces {
    /// Where the triangles of each vertex begin in `triangles`, and where the last ones end.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// Mesh frame; zero where a triangle has no area.
    normals: Vec<DVec3>,
}

impl Faces {
    pub(crate) fn new(mesh: &TriMesh) -> Self {
        let mut starts = vec![0u32; mesh.vertex_count() + 1];
        for &vertex in mesh.triangles().iter().flatten() {
            starts[vertex as usize + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut triangles = vec![0; 3 * mesh.triangle_count()];
        for (triangle, vertices) in mesh.triangles().iter().enumerate() {
            for &vertex in vertices {
                triangles[next[vertex as usize] as usize] = triangle as u32;
                next[vertex as usize] += 1;
            }
        }
        let normal = |triangle: usize| {
            let [a, b, c] = mesh.corners(triangle);
            (b - a).cross(c - a).normalize_or_zero()
        };
        let normals = (0..mesh.triangle_count()).map(normal).collect();
        Self { starts, triangles, normals }
    }

    fn at(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.triangles[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }

    /// The normal, or its opposite, of a triangle at one of these vertices that is nearest to a direction of the mesh frame.
    pub(crate) fn nearest(&self, vertices: &[u32], direction: DVec3) -> Option<DVec3> {
        let normals = vertices.iter().flat_map(|&v| self.at(v)).map(|&t| self.normals[t as usize]);
        let nearest =
            normals.reduce(|m, n| if n.dot(direction).abs() > m.dot(direction).abs() { n } else { m })?;
        (nearest != DVec3::ZERO).then(|| if nearest.dot(direction) < 0.0 { -nearest } else { nearest })
    }
}

/// The vertices of the features of A and of B.
pub(crate) fn vertices_of(feature: FeaturePair, meshes: [&TriMesh; 2]) -> [[u32; 3]; 2] {
    let face = |body: usize, triangle: u32| meshes[body].triangles()[triangle as usize];
    match feature {
        FeaturePair::VertexFace { vertex, face: triangle } => [[vertex; 3], face(1, triangle)],
        FeaturePair::FaceVertex { face: triangle, vertex } => [face(0, triangle), [vertex; 3]],
        FeaturePair::EdgeEdge { edge_a: [a, b], edge_b: [c, d] } => [[a, b, b], [c, d, d]],
    }
}
