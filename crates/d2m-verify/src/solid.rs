//! Is a vertex of one body inside the other? The winding number of the surface, from the faces that a ray passes.
use crate::instant::Instant;
use crate::meeting::sign;
use crate::mesh::Below;
use crate::{Body, Mesh, Solid};
use d2m_interval::IntervalVec3;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Rays of no special direction, one after the other until one passes no side of a face too closely.
const RAYS: [DVec3; 4] = [
    DVec3::new(0.531, 0.672, 0.516),
    DVec3::new(-0.713, 0.388, 0.584),
    DVec3::new(0.287, -0.829, 0.480),
    DVec3::new(0.641, 0.269, -0.719),
];

/// How a surface closes, with equal positions joined, and without the triangles that repeat others or have two equal corners.
#[derive(Debug)]
pub(crate) struct Surface {
    closes: Closes,
    /// A vertex of each connected part.
    parts: Vec<u32>,
    left_out: Vec<bool>,
}

#[derive(Debug, PartialEq)]
enum Closes {
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
                let roots = [root(&mut parent, i), root(&mut parent, j)];
                parent[roots[0].max(roots[1]) as usize] = roots[0].min(roots[1]);
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

    /// Is the point (from the mesh's center) in the solid? `None`: the ray does not tell.
    fn contains(&self, mesh: &Mesh, p: IntervalVec3, ray: DVec3) -> Option<bool> {
        let (mut winding, mut count) = (0, 0);
        let mut stack = vec![0];
        while let Some(node) = stack.pop() {
            let node = &mesh.nodes[node as usize];
            if passes_by(node.part.bounds() - p, ray) {
                continue;
            }
            match node.below {
                Below::Nodes(first) => stack.extend([first, first + 1]),
                Below::Triangle(triangle) if !self.left_out[triangle as usize] => {
                    let crossing = crossing(mesh.corners(triangle).map(|v| v - p), ray)?;
                    (winding, count) = (winding + crossing, count + crossing.abs());
                }
                Below::Triangle(_) => {}
            }
        }
        Some(if self.closes == Closes::Oriented { winding != 0 } else { count % 2 != 0 })
    }
}

fn root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

/// Does a ray from zero certainly miss the box? The box is behind, or beside, seen along a coordinate axis.
fn passes_by(bounds: IntervalVec3, ray: DVec3) -> bool {
    let across = bounds.cross_point(ray);
    let behind = [(bounds.x, ray.x), (bounds.y, ray.y), (bounds.z, ray.z)];
    behind.into_iter().any(|(side, r)| if r > 0.0 { side.hi() < 0.0 } else { side.lo() > 0.0 })
        || [across.x, across.y, across.z].into_iter().any(|side| sign(side) != 0)
}

/// +1 where a ray from zero passes the face the way of its normal, −1 the other way, 0 where it certainly does not pass.
fn crossing([a, b, c]: [IntervalVec3; 3], ray: DVec3) -> Option<i32> {
    let ray = IntervalVec3::point(ray);
    let turns = [(a, b), (b, c), (c, a)].map(|(p, q)| sign(ray.triple_product(p, q)));
    if turns.contains(&1) && turns.contains(&-1) {
        return Some(0);
    }
    let side = sign(a.triple_product(b, c));
    if turns.contains(&0) || side == 0 {
        return None;
    }
    // With the turns of one sign the line passes; ahead where the volume has that sign too.
    Some(if side == turns[0] { turns[0] } else { 0 })
}

/// Does a body hold a part of the other one, at a time at which the surfaces share no point?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Held {
    /// Neither holds any: the solids share no point until the surfaces do.
    Neither,
    /// One does.
    One,
    /// A filled surface does not close, or no ray tells.
    Unknown,
}

pub(crate) fn held(bodies: &[Body<'_>; 2], now: &Instant) -> Held {
    let mut found = Held::Neither;
    for holder in 0..2 {
        let [outer, inner] = [bodies[holder].mesh, bodies[1 - holder].mesh];
        if bodies[holder].solid == Solid::Surface {
            continue;
        }
        if outer.surface().closes == Closes::No {
            return Held::Unknown;
        }
        for &vertex in &inner.surface().parts {
            let p = inner.relative(inner.vertices[vertex as usize]);
            let seen =
                if holder == 0 { now.turn.mul_vec(p) + now.offset } else { now.back.mul_vec(p - now.offset) };
            match RAYS.iter().find_map(|&ray| outer.surface().contains(outer, seen, ray)) {
                Some(false) => {}
                Some(true) => return Held::One,
                None => found = Held::Unknown,
            }
        }
    }
    found
}
