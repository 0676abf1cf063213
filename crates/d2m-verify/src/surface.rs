//! How a surface closes, with equal positions joined, and without the triangles that repeat others or have two equal corners.
use glam::DVec3;
use std::collections::{HashMap, HashSet};

#[derive(Debug)]
pub(crate) struct Surface {
    pub(crate) closes: Closes,
    /// A vertex of each connected part.
    pub(crate) parts: Vec<u32>,
    /// Triangles that repeat others, or have two equal corners.
    pub(crate) left_out: Vec<bool>,
}

#[derive(Debug, PartialEq)]
pub(crate) enum Closes {
    /// Each side of a face has one that runs the other way: there are winding numbers.
    Oriented,
    /// Each side has an even number of faces: there is a parity.
    Even,
    No,
}

impl Surface {
    pub(crate) fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        // With 0 added −0 is 0.
        let place = |v: u32| (vertices[v as usize] + DVec3::ZERO).to_array().map(f64::to_bits);
        let mut first = HashMap::new();
        let welded: Vec<u32> =
            (0..vertices.len() as u32).map(|v| *first.entry(place(v)).or_insert(v)).collect();
        let (mut seen, mut sides) = (HashSet::new(), HashMap::<[u32; 2], [u32; 2]>::new());
        let (mut parent, mut left_out) = (welded.clone(), vec![false; triangles.len()]);
        for (number, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| welded[v as usize]);
            for [i, j] in [[a, b], [b, c]] {
                let [i, j] = [root(&mut parent, i), root(&mut parent, j)];
                parent[i.max(j) as usize] = i.min(j);
            }
            let turned = [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
            left_out[number] = a == b || b == c || c == a || !seen.insert(turned);
            if !left_out[number] {
                for [i, j] in [[a, b], [b, c], [c, a]] {
                    sides.entry([i.min(j), i.max(j)]).or_default()[usize::from(i < j)] += 1;
                }
            }
        }
        let closes = if sides.values().all(|[there, back]| there == back) {
            Closes::Oriented
        } else if sides.values().all(|[there, back]| (there + back) % 2 == 0) {
            Closes::Even
        } else {
            Closes::No
        };
        let mut parts: Vec<u32> =
            triangles.iter().map(|t| root(&mut parent, welded[t[0] as usize])).collect();
        parts.sort_unstable();
        parts.dedup();
        Self { closes, parts, left_out }
    }
}

fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}
