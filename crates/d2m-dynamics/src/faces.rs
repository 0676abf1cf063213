//! Which triangles meet at a vertex, and how far flat parts of the surface go on around a point.

use d2m_bvh::TriMesh;
use d2m_feature::FeaturePair;
use d2m_mesh::Simplex;
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

    /// How far the flat part of the surface below a point, near these vertices, goes on around it at least, in all directions. Flat is what
    /// faces along this direction, or all against it, up to so much. None: there is no such part. Coordinates of the mesh.
    ///
    /// Let the outline of the triangles, the sides that no other of them shares, be r away from the point on their plane, and a point of one of
    /// them r/4. A disc of radius 3r/4 about that point has no point of the outline, so the triangles go on in all of it: they do up to r/2 from
    /// the point itself.
    pub(crate) fn flat_around(
        &self,
        mesh: &TriMesh,
        vertices: &[u32],
        [point, direction]: [DVec3; 2],
        most: f64,
    ) -> Option<f64> {
        let off = |t: u32, side: f64| (self.normals[t as usize] * side - direction).length();
        let mut flat: Vec<u32> = vertices.iter().flat_map(|&v| self.at(v)).copied().collect();
        let side = if flat.iter().any(|&t| off(t, 1.0) <= most) { 1.0 } else { -1.0 };
        flat.retain(|&t| off(t, side) <= most);
        flat.sort_unstable();
        flat.dedup();
        let sides = |t: u32| {
            let [i, j, k] = mesh.triangles()[t as usize];
            [[i, j], [j, k], [k, i]]
        };
        let at = |v: u32| mesh.vertices()[v as usize];
        let &first = flat.first()?;
        let point = point - direction * direction.dot(point - mesh.corners(first as usize)[0]);
        let has_outside = |&[from, to]: &[u32; 2]| !flat.iter().any(|&t| sides(t).contains(&[to, from]));
        let outline = flat.iter().flat_map(|&t| sides(t)).filter(has_outside);
        let room =
            outline.map(|[from, to]| to_hull(point, &[at(from), at(to)])).fold(f64::INFINITY, f64::min);
        let below =
            flat.iter().map(|&t| to_hull(point, &mesh.corners(t as usize))).fold(f64::INFINITY, f64::min);
        (below <= 0.25 * room).then_some(0.5 * room)
    }
}

/// How far a point is from the hull of others, at most; exactly for one or two.
fn to_hull(point: DVec3, others: &[DVec3]) -> f64 {
    let mut simplex = Simplex::new(others[0] - point);
    for other in &others[1..] {
        simplex = simplex.with(*other - point).unwrap_or(simplex);
    }
    simplex.nearest().length()
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
