//! Meshes as a page draws them: in single precision about their middle, and coarser where there are very many triangles.

use super::base64::base64;
use super::rounded::{Shell, rounded};
use d2m::bvh::TriMesh;
use glam::{DVec3, Vec3};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

/// Triangles of one mesh that a browser draws fluently, and that keep a page below some 5 MB.
const MOST_TRIANGLES: usize = 120_000;

/// A mesh to be drawn.
pub(crate) struct DisplayMesh {
    pub(crate) center: DVec3,
    /// From the center.
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl DisplayMesh {
    /// Everything within `radius` of a mesh.
    pub(crate) fn new(mesh: &TriMesh, radius: f64) -> Self {
        if radius > 0.0 {
            let Shell { vertices, triangles } = rounded(mesh, radius, MOST_TRIANGLES);
            Self::of(&vertices, triangles)
        } else {
            Self::of(mesh.vertices(), mesh.triangles().to_vec())
        }
    }

    fn of(corners: &[DVec3], triangles: Vec<[u32; 3]>) -> Self {
        let used = || triangles.iter().flatten().map(|&i| corners[i as usize]);
        let low = used().fold(DVec3::INFINITY, DVec3::min);
        let high = used().fold(DVec3::NEG_INFINITY, DVec3::max);
        let center = low * 0.5 + high * 0.5;
        // Single precision is enough about the center of the mesh, and all that graphics cards take.
        let vertices = corners.iter().map(|&vertex| (vertex - center).as_vec3()).collect();
        let mut shown = Self { center, vertices, triangles };
        // A surface crosses about as many cells as the square of their number along an axis.
        let mut cells = (MOST_TRIANGLES as f64 / 2.0).sqrt();
        while shown.triangles.len() > MOST_TRIANGLES {
            shown = shown.clustered((high - low).max_element() / cells);
            cells *= 0.8;
        }
        shown
    }

    /// The vertices of each cell of a grid become one: their mean. Triangles that lose a vertex, and repeated ones, go.
    fn clustered(&self, cell: f64) -> Self {
        let key = |p: Vec3| (p.as_dvec3() / cell).to_array().map(|c| c.floor() as i64);
        let mut cells: BTreeMap<[i64; 3], (DVec3, u32, u32)> = BTreeMap::new();
        for &p in &self.vertices {
            let next = cells.len() as u32;
            let (sum, count, _) = cells.entry(key(p)).or_insert((DVec3::ZERO, 0, next));
            *sum += p.as_dvec3();
            *count += 1;
        }
        let mut vertices = vec![Vec3::ZERO; cells.len()];
        for &(sum, count, place) in cells.values() {
            vertices[place as usize] = (sum / f64::from(count)).as_vec3();
        }
        let place = |i: u32| cells[&key(self.vertices[i as usize])].2;
        let moved = self.triangles.iter().map(|triangle| triangle.map(place));
        let whole = moved.filter(|[a, b, c]| a != b && b != c && c != a);
        // The same triangle begins with its least vertex.
        let first_least = |t: [u32; 3]| match t {
            [a, b, c] if b < a && b < c => [b, c, a],
            [a, b, c] if c < a && c < b => [c, a, b],
            _ => t,
        };
        let triangles: BTreeSet<[u32; 3]> = whole.map(first_least).collect();
        Self { center: self.center, vertices, triangles: triangles.into_iter().collect() }
    }

    pub(super) fn to_json(&self) -> Value {
        let vertices: Vec<u8> =
            self.vertices.iter().flat_map(Vec3::to_array).flat_map(f32::to_le_bytes).collect();
        let triangles: Vec<u8> = self.triangles.iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        json!({
            "center": self.center.to_array(),
            "vertices": base64(&vertices),
            "triangles": base64(&triangles),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_meshes_are_drawn_coarser_and_keep_their_extent() {
        let mesh = d2m::shapes::mesh("icosphere?triangles=300000").unwrap();
        let shown = DisplayMesh::new(&mesh, 0.0);
        assert!((10_000..=MOST_TRIANGLES).contains(&shown.triangles.len()), "{}", shown.triangles.len());
        let reach = |points: &mut dyn Iterator<Item = f64>| points.fold(0.0, f64::max);
        let all = reach(&mut mesh.vertices().iter().map(|p| (*p - shown.center).length()));
        let drawn = reach(&mut shown.vertices.iter().map(|p| f64::from(p.length())));
        assert!(drawn <= all * (1.0 + 1e-6) && drawn > 0.98 * all, "{drawn} of {all}");
        let small = d2m::shapes::mesh("box").unwrap();
        assert_eq!(DisplayMesh::new(&small, 0.0).triangles.len(), small.triangle_count());
    }
}
