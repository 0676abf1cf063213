//! Which triangles meet at a vertex, and how far flat parts of the surface go on around a point.

use crate::{Simplex, TriMesh};
use d2m_feature::estimate_closest_point;
use glam::DVec3;

/// The triangles at each vertex of a mesh, and their normals: what contacts ask of a surface around closest points. All in the mesh's frame; normals and
/// distances to rounding, which proves nothing.
///
/// Vertices count by their numbers, not by their positions.
///
/// ```
/// use d2m_mesh::{Faces, TriMesh};
/// use glam::DVec3;
/// let square = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
/// let mesh = TriMesh::try_new(square, vec![[0, 1, 2], [0, 2, 3]])?;
/// let faces = Faces::new(&mesh);
/// assert_eq!(faces.around(&[1]), [0]);
/// assert_eq!(faces.around(&[0, 2]), [0, 1]);
/// assert_eq!(faces.nearest(&[1], DVec3::new(0.1, 0.0, -1.0)), Some(-DVec3::Z));
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Faces {
    /// Where the triangles of each vertex begin in `triangles`, and where the last ones end.
    starts: Vec<u32>,
    triangles: Vec<u32>,
    /// Mesh frame; zero where a triangle has no area.
    normals: Vec<DVec3>,
}

impl Faces {
    /// In time linear in the mesh.
    ///
    /// ```
    /// use d2m_mesh::{Faces, TriMesh};
    /// use glam::DVec3;
    /// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
    /// assert_eq!(Faces::new(&mesh).around(&[2]), [0]);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    #[must_use]
    pub fn new(mesh: &TriMesh) -> Self {
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

    /// The normal, or its opposite, of a triangle at one of these vertices that is nearest to a direction. None: the triangle has no area, or there is none.
    ///
    /// ```
    /// use d2m_mesh::{Faces, TriMesh};
    /// use glam::DVec3;
    /// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
    /// assert_eq!(Faces::new(&mesh).nearest(&[0], DVec3::new(0.0, 0.1, 1.0)), Some(DVec3::Z));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Panics
    /// If a vertex is none of the mesh's.
    #[must_use]
    pub fn nearest(&self, vertices: &[u32], direction: DVec3) -> Option<DVec3> {
        let normals = vertices.iter().flat_map(|&v| self.at(v)).map(|&t| self.normals[t as usize]);
        let nearest =
            normals.reduce(|m, n| if n.dot(direction).abs() > m.dot(direction).abs() { n } else { m })?;
        (nearest != DVec3::ZERO).then(|| if nearest.dot(direction) < 0.0 { -nearest } else { nearest })
    }

    /// How far the flat part of the surface around a point of it, near these vertices, goes on at least, in all directions. Flat is what
    /// faces along this direction, or all against it, up to so much, and the point lies on it, up to `rounding`: not on what faces that way behind
    /// it, as behind a fold. None: there is no such part. The mesh is the one that this was made of.
    ///
    /// Let the outline of the triangles, the sides that no other of them shares, be r away from the point. A disc of that radius about the point,
    /// which is in one of them, has no point of the outline, so the triangles go on in all of it. Half of it counts.
    ///
    /// ```
    /// use d2m_mesh::{Faces, TriMesh};
    /// use glam::DVec3;
    /// let square = vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
    /// let mesh = TriMesh::try_new(square, vec![[0, 1, 2], [0, 2, 3]])?;
    /// let middle = DVec3::new(0.5, 0.5, 0.0);
    /// let around = Faces::new(&mesh).flat_around(&mesh, &[0, 2], [middle, DVec3::Z], [1e-9, 1e-12]);
    /// assert_eq!(around, Some(0.25));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Panics
    /// If a vertex is none of the mesh's.
    #[must_use]
    pub fn flat_around(
        &self,
        mesh: &TriMesh,
        vertices: &[u32],
        [point, direction]: [DVec3; 2],
        [most, rounding]: [f64; 2],
    ) -> Option<f64> {
        let near = self.around(vertices);
        let sides = |t: u32| {
            let [i, j, k] = mesh.triangles()[t as usize];
            [[i, j], [j, k], [k, i]]
        };
        let at = |v: u32| mesh.vertices()[v as usize];
        let facing = |side: f64| {
            let is_flat = |&t: &u32| (self.normals[t as usize] * side - direction).length() <= most;
            let flat: Vec<u32> = near.iter().copied().filter(is_flat).collect();
            let has_outside = |&[from, to]: &[u32; 2]| !flat.iter().any(|&t| sides(t).contains(&[to, from]));
            let outline = flat.iter().flat_map(|&t| sides(t)).filter(has_outside);
            let room =
                outline.map(|[from, to]| to_segment(point, [at(from), at(to)])).fold(f64::INFINITY, f64::min);
            let is_on = |&t: &u32| {
                estimate_closest_point(point, &mesh.corners(t as usize)).distance(point) <= rounding
            };
            flat.iter().any(is_on).then_some(0.5 * room)
        };
        [1.0, -1.0].into_iter().filter_map(facing).reduce(f64::max)
    }

    /// The triangle at these vertices nearest to a point, of those that face along this direction or against it, up to so much, and its point
    /// nearest to that one. The mesh is the one that this was made of.
    ///
    /// ```
    /// use d2m_mesh::{Faces, TriMesh};
    /// use glam::DVec3;
    /// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
    /// let above = DVec3::new(0.25, 0.25, 3.0);
    /// let below = Faces::new(&mesh).below(&mesh, &[0], [above, DVec3::Z], 1e-9);
    /// assert_eq!(below, Some((0, DVec3::new(0.25, 0.25, 0.0))));
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Panics
    /// If a vertex is none of the mesh's.
    #[must_use]
    pub fn below(
        &self,
        mesh: &TriMesh,
        vertices: &[u32],
        [point, direction]: [DVec3; 2],
        most: f64,
    ) -> Option<(u32, DVec3)> {
        let off = |t: u32| {
            let normal = self.normals[t as usize];
            (normal - direction).length().min((normal + direction).length())
        };
        let flat = self.around(vertices).into_iter().filter(|&t| off(t) <= most);
        let feet = flat.map(|t| (t, estimate_closest_point(point, &mesh.corners(t as usize))));
        let away = |foot: DVec3| foot.distance_squared(point);
        feet.min_by(|(_, x), (_, y)| away(*x).total_cmp(&away(*y)))
    }

    /// The triangles at some vertices, each once, in order.
    ///
    /// ```
    /// use d2m_mesh::{Faces, TriMesh};
    /// use glam::DVec3;
    /// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
    /// assert_eq!(Faces::new(&mesh).around(&[0, 1]), [0]);
    /// # Ok::<(), d2m_mesh::MeshError>(())
    /// ```
    ///
    /// # Panics
    /// If a vertex is none of the mesh's.
    #[must_use]
    pub fn around(&self, vertices: &[u32]) -> Vec<u32> {
        let mut triangles: Vec<u32> = vertices.iter().flat_map(|&v| self.at(v)).copied().collect();
        triangles.sort_unstable();
        triangles.dedup();
        triangles
    }
}

/// Exactly, but for rounding.
fn to_segment(point: DVec3, [from, to]: [DVec3; 2]) -> f64 {
    let nearest = Simplex::new(from - point);
    nearest.with(to - point).unwrap_or(nearest).nearest().length()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plate and a hem on it, folded over at its edge by a hundred-millionth: what slips off the hem has more room.
    #[test]
    fn what_lies_behind_a_fold_is_not_flat_with_it() {
        let edge = [DVec3::new(-10.0, 0.0, -1.0), DVec3::new(-10.0, 0.0, 1.0)];
        let plate = [DVec3::new(10.0, 0.0, 1.0), DVec3::new(10.0, 0.0, -1.0)];
        let hem = [DVec3::new(0.0, 1e-7, -1.0), DVec3::new(0.0, 1e-7, 1.0)];
        let vertices = [edge, plate, hem].concat();
        let mesh = TriMesh::try_new(vertices, vec![[0, 1, 2], [0, 2, 3], [1, 0, 4], [1, 4, 5]]).unwrap();
        let faces = Faces::new(&mesh);
        let (point, tiny) = (DVec3::new(-0.1, 0.99e-7, 0.0), [1.0 / (1u64 << 25) as f64, 1e-12]);
        for direction in [DVec3::Y, DVec3::NEG_Y] {
            let around = faces.flat_around(&mesh, &[0, 4, 5], [point, direction], tiny).unwrap();
            assert!((around - 0.05).abs() < 1e-6, "{around}");
        }
        // On the plate beyond the hem, and beneath it.
        let plate = DVec3::new(0.5, 0.0, 0.0);
        assert!(faces.flat_around(&mesh, &[0, 2, 3], [plate, DVec3::Y], tiny).unwrap() > 0.4);
        assert_eq!(faces.flat_around(&mesh, &[0, 2, 3], [plate - DVec3::Y * 1e-7, DVec3::Y], tiny), None);
    }
}
