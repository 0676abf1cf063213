//! Vertices at one place become one.

use glam::DVec3;
use std::collections::HashMap;

/// Vertices by their bits, numbered as they come first.
#[derive(Debug, Default)]
pub(super) struct Merged {
    pub(super) vertices: Vec<DVec3>,
    known: HashMap<[u64; 3], u32>,
}

impl Merged {
    /// The number of the vertex at a place.
    pub(super) fn number(&mut self, position: DVec3) -> u32 {
        // Adding 0 turns −0 into +0.
        let position = position + DVec3::ZERO;
        *self.known.entry(position.to_array().map(f64::to_bits)).or_insert_with(|| {
            self.vertices.push(position);
            (self.vertices.len() - 1) as u32
        })
    }
}

/// Merges equal vertices; the triangles keep their numbers and corners. Indices out of range stay as they are: checking them comes later.
pub(super) fn merge(vertices: &mut Vec<DVec3>, triangles: &mut [[u32; 3]]) {
    let count = vertices.len();
    let mut merged = Merged::default();
    let numbers: Vec<u32> = vertices.iter().map(|&position| merged.number(position)).collect();
    // The mesh will name indices out of range by the vertices of the file.
    if triangles.iter().flatten().any(|&index| index as usize >= count) {
        return;
    }
    for corner in triangles.iter_mut().flatten() {
        *corner = numbers[*corner as usize];
    }
    *vertices = merged.vertices;
}
