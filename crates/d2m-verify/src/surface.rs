//! How a surface closes, with equal positions joined, and without the triangles that repeat others or have two equal corners.
use glam::DVec3;
use std::collections::{BTreeSet, HashMap, HashSet};

#[derive(Debug)]
pub(crate) struct Surface {
    /// Each side of a face has one that runs the other way: there are winding numbers.
    pub(crate) has_winding: bool,
    /// Each side has an even number of faces: there is a parity.
    pub(crate) has_parity: bool,
    /// A vertex of each connected part.
    pub(crate) parts: BTreeSet<u32>,
    /// Triangles that repeat others, or have two equal corners.
    pub(crate) left_out: Vec<bool>,
}

impl Surface {
    pub(crate) fn new(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        // With 0 added −0 is 0.
        let place = |p: &DVec3| (*p + DVec3::ZERO).to_array().map(f64::to_bits);
        let mut first = HashMap::new();
        let welded = vertices.iter().zip(0..).map(|(p, v)| *first.entry(place(p)).or_insert(v));
        let welded: Vec<u32> = welded.collect();
        let (mut parent, mut left_out, mut seen) = (welded.clone(), Vec::new(), HashSet::new());
        // How many faces run along a side from its greater vertex to its lesser one, and how many back.
        let mut sides = HashMap::<[u32; 2], [u32; 2]>::new();
        for corners in triangles {
            let [a, b, c] = corners.map(|v| welded[v as usize]);
            for v in [b, c] {
                let [i, j] = [a, v].map(|v| root(&mut parent, v));
                parent[i.max(j) as usize] = i.min(j);
            }
            let turned = [[a, b, c], [b, c, a], [c, a, b]].into_iter().min();
            let is_face = a != b && b != c && c != a && seen.insert(turned);
            left_out.push(!is_face);
            for [i, j] in [[a, b], [b, c], [c, a]].into_iter().filter(|_| is_face) {
                sides.entry([i.min(j), i.max(j)]).or_default()[usize::from(i < j)] += 1;
            }
        }
        Self {
            has_winding: sides.values().all(|[there, back]| there == back),
            has_parity: sides.values().all(|[there, back]| (there + back) % 2 == 0),
            parts: triangles.iter().map(|t| root(&mut parent, t[0])).collect(),
            left_out,
        }
    }
}

/// The vertex that stands for all that are joined with this one.
fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}
