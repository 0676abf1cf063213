//! Is the surface one whose volume integral counts every point of the solid once?

use crate::MassError;
use crate::union::{join, root};
use d2m_bvh::{MeshTree, Posed, Solid, TriMesh, collide};
use glam::DVec3;
use std::collections::{BTreeMap, HashMap};

/// A position, distinguished by its bits; both zeros are one.
type Key = [u64; 3];

fn key(p: DVec3) -> Key {
    (p + DVec3::ZERO).to_array().map(f64::to_bits)
}

/// Closed, consistently oriented, parts that do not overlap.
pub(super) fn check(mesh: &TriMesh) -> Result<(), MassError> {
    let mut numbers: HashMap<Key, u32> = HashMap::new();
    let number: Vec<u32> = mesh
        .vertices()
        .iter()
        .map(|&p| {
            let next = numbers.len() as u32;
            *numbers.entry(key(p)).or_insert(next)
        })
        .collect();
    let mut balance: HashMap<(u32, u32), i32> = HashMap::new();
    let mut parent: Vec<usize> = (0..numbers.len()).collect();
    for vertices in mesh.triangles() {
        let c = vertices.map(|v| number[v as usize]);
        if c[0] == c[1] || c[1] == c[2] || c[2] == c[0] {
            continue; // a triangle without area bounds nothing
        }
        for k in 0..3 {
            let (from, to) = (c[k], c[(k + 1) % 3]);
            *balance.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            join(&mut parent, from as usize, to as usize);
        }
    }
    if let Some((&(i, j), _)) =
        balance.iter().filter(|(_, count)| **count != 0).min_by_key(|(edge, _)| **edge)
    {
        let place = |wanted: u32| number.iter().position(|&n| n == wanted).map(|v| mesh.vertices()[v]);
        return Err(MassError::Open { from: place(i).unwrap_or_default(), to: place(j).unwrap_or_default() });
    }
    let mut parts: BTreeMap<usize, Vec<[u32; 3]>> = BTreeMap::new();
    for vertices in mesh.triangles() {
        parts.entry(root(&mut parent, number[vertices[0] as usize] as usize)).or_default().push(*vertices);
    }
    if parts.len() > 1 { overlaps(mesh, parts.into_values().collect()) } else { Ok(()) }
}

struct Part {
    tree: MeshTree,
    low: DVec3,
    high: DVec3,
    first_triangle: usize,
}

/// Parts whose surfaces meet, and points that are inside two parts of the same orientation.
fn overlaps(mesh: &TriMesh, parts: Vec<Vec<[u32; 3]>>) -> Result<(), MassError> {
    let parts: Vec<Part> = parts
        .into_iter()
        .filter_map(|triangles| {
            let first = triangles[0];
            let first_triangle = mesh.triangles().iter().position(|t| *t == first).unwrap_or_default();
            let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            for &v in triangles.iter().flatten() {
                let p = mesh.vertices()[v as usize];
                (low, high) = (low.min(p), high.max(p));
            }
            let part = TriMesh::try_new(mesh.vertices().to_vec(), triangles).ok()?;
            Some(Part { tree: MeshTree::new(part), low, high, first_triangle })
        })
        .collect();
    for (j, second) in parts.iter().enumerate() {
        // How often the parts' surfaces go round a point just inside this part.
        let mut winding = 0.0;
        for (i, first) in parts.iter().enumerate() {
            if i == j || first.low.cmpgt(second.high).any() || second.low.cmpgt(first.high).any() {
                continue;
            }
            let names = MassError::PartsOverlap {
                first: first.first_triangle.min(second.first_triangle),
                second: first.first_triangle.max(second.first_triangle),
            };
            let meet = collide(Posed::at_rest(&first.tree), Posed::at_rest(&second.tree), Solid::Surface);
            if i < j && meet.unwrap_or(true) {
                return Err(names);
            }
            let vertex = second.tree.mesh().corners(0)[0];
            winding += winding_number(first.tree.mesh(), vertex);
        }
        let own = orientation(second.tree.mesh());
        // Inside a cavity the sum is zero, inside the solid one (or minus one, for a surface that faces inward).
        if (winding + own).abs() > 1.5 {
            let first = parts[0].first_triangle;
            return Err(MassError::PartsOverlap { first, second: second.first_triangle });
        }
    }
    Ok(())
}

fn orientation(mesh: &TriMesh) -> f64 {
    let origin = mesh.corners(0)[0];
    let volume = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle).map(|p| p - origin);
        a.dot(b.cross(c))
    };
    if (0..mesh.triangle_count()).map(volume).sum::<f64>() < 0.0 { -1.0 } else { 1.0 }
}

/// The solid angle of the surface about a point off it, in whole turns (van Oosterom and Strackee 1983), rounded.
fn winding_number(mesh: &TriMesh, point: DVec3) -> f64 {
    let mut turns = 0.0;
    for triangle in 0..mesh.triangle_count() {
        let [a, b, c] = mesh.corners(triangle).map(|p| p - point);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let above = a.dot(b.cross(c));
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        turns += above.atan2(below);
    }
    (turns / (2.0 * core::f64::consts::PI)).round()
}
