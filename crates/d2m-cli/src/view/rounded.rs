//! The surface of a body with a radius, for the eye: everything within the radius of a mesh.

use d2m::bvh::TriMesh;
use d2m::shapes::Shape;
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Triangles of a ball and corners of a ring, the finest first.
const DETAIL: [(f64, u32); 3] = [(1280.0, 5), (320.0, 4), (80.0, 3)];

/// Vertices and triangles that are drawn.
#[derive(Default)]
pub(super) struct Shell {
    pub(super) vertices: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// A ball about each vertex, a tube about each edge and each face to either side; they run into each other. Where that would be more than
/// `most` triangles, the mesh with its vertices moved outwards.
pub(super) fn rounded(mesh: &TriMesh, radius: f64, most: usize) -> Shell {
    let corners: BTreeSet<u32> = mesh.triangles().iter().flatten().copied().collect();
    let sides = mesh.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let edges: BTreeSet<[u32; 2]> =
        sides.filter(|[a, b]| a != b).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    let at = |index: u32| mesh.vertices()[index as usize];
    for (triangles, doublings) in DETAIL {
        let ring = ring(doublings);
        let count = corners.len() as f64 * triangles
            + (edges.len() * 2 * ring.len() + 2 * mesh.triangle_count()) as f64;
        let ball = Shape::new("icosphere").and_then(|shape| shape.with("triangles", triangles));
        if let (Ok(ball), true) = (ball.map(|shape| shape.build()), count <= most as f64) {
            let mut shell = Shell::default();
            for &corner in &corners {
                shell.add_ball(&ball, at(corner), radius);
            }
            for edge in &edges {
                shell.add_tube(&ring, edge.map(at), radius);
            }
            for triangle in mesh.triangles() {
                shell.add_faces(triangle.map(at), radius);
            }
            return shell;
        }
    }
    moved_outwards(mesh, radius)
}

/// Directions that divide a turn into 2^`doublings` equal parts, each the middle of its neighbors.
fn ring(doublings: u32) -> Vec<[f64; 2]> {
    let mut ring: Vec<[f64; 2]> = vec![[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    for _ in 2..doublings {
        let next = ring.iter().cycle().skip(1);
        let between = ring.iter().zip(next).flat_map(|(&[x, y], [u, v])| {
            let middle = DVec2::new(x + u, y + v).normalize();
            [[x, y], middle.to_array()]
        });
        ring = between.collect();
    }
    ring
}

impl Shell {
    fn add_ball(&mut self, ball: &TriMesh, center: DVec3, radius: f64) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(ball.vertices().iter().map(|p| center + p.normalize_or_zero() * radius));
        self.triangles.extend(ball.triangles().iter().map(|triangle| triangle.map(|index| first + index)));
    }

    fn add_tube(&mut self, ring: &[[f64; 2]], [from, to]: [DVec3; 2], radius: f64) {
        let Some(axis) = (to - from).try_normalize() else { return };
        let (u, v) = axis.any_orthonormal_pair();
        let (first, count) = (self.vertices.len() as u32, ring.len() as u32);
        for &[x, y] in ring {
            let out = (u * x + v * y) * radius;
            self.vertices.extend([from + out, to + out]);
        }
        for k in 0..count {
            let [a, b] = [k, (k + 1) % count].map(|corner| first + 2 * corner);
            self.triangles.extend([[a, b, a + 1], [b, b + 1, a + 1]]);
        }
    }

    /// The triangle to either side of itself, its back as seen from there.
    fn add_faces(&mut self, [a, b, c]: [DVec3; 3], radius: f64) {
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { return };
        for corners in [[a, b, c].map(|p| p + normal * radius), [c, b, a].map(|p| p - normal * radius)] {
            let first = self.vertices.len() as u32;
            self.vertices.extend(corners);
            self.triangles.push([first, first + 1, first + 2]);
        }
    }
}

fn moved_outwards(mesh: &TriMesh, radius: f64) -> Shell {
    let mut normals = vec![DVec3::ZERO; mesh.vertices().len()];
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|index| mesh.vertices()[index as usize]);
        for &index in triangle {
            normals[index as usize] += (b - a).cross(c - a);
        }
    }
    let moved = mesh.vertices().iter().zip(normals).map(|(p, n)| p + n.normalize_or_zero() * radius);
    Shell { vertices: moved.collect(), triangles: mesh.triangles().to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MOST: usize = 100_000;

    fn reach(shell: &Shell, of: impl Fn(DVec3) -> f64) -> f64 {
        let used = shell.triangles.iter().flatten().map(|&index| shell.vertices[index as usize]);
        used.map(of).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A point becomes a ball, a segment a capsule, a box grows to all sides, a large mesh too.
    #[test]
    fn a_body_is_drawn_with_its_radius() {
        let degenerate = |vertices: Vec<DVec3>| TriMesh::try_new(vertices, vec![[0, 1, 2]]).unwrap();
        let point = rounded(&degenerate(vec![DVec3::X; 3]), 0.5, MOST);
        let far = reach(&point, |p| (p - DVec3::X).length());
        assert!((far - 0.5).abs() < 1e-12 && point.triangles.len() >= 1000);
        let segment = rounded(&degenerate(vec![DVec3::ZERO, DVec3::X * 4.0, DVec3::X * 4.0]), 0.5, MOST);
        assert!(
            (reach(&segment, |p| p.x) - 4.5).abs() < 0.01 && (reach(&segment, |p| p.y) - 0.5).abs() < 1e-9
        );
        for (shape, most) in [("box?x=1&y=1&z=1", 1.25), ("icosphere?triangles=100000", 1.25)] {
            let mesh = d2m::shapes::mesh(shape).unwrap();
            let shell = rounded(&mesh, 0.25, MOST);
            assert!((reach(&shell, |p| p.z) - most).abs() < 1e-3, "{shape}");
            assert!(shell.triangles.len() <= MOST.max(mesh.triangle_count()), "{shape}");
        }
        let ring = ring(5);
        assert!(ring.len() == 32 && ring.iter().all(|[x, y]| (x * x + y * y - 1.0).abs() < 1e-14));
    }
}
