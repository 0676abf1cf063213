//! Is a vertex of one body inside the other? The winding number of the surface, from the faces that a ray passes.
use crate::instant::{Instant, sign};
use crate::mesh::Below;
use crate::surface::Closes;
use crate::{Body, Mesh, Solid};
use d2m_interval::IntervalVec3;
use glam::DVec3;

/// Rays of no special direction, one after the other until one passes no side of a face too closely.
const RAYS: [DVec3; 4] = [
    DVec3::new(0.531, 0.672, 0.516),
    DVec3::new(-0.713, 0.388, 0.584),
    DVec3::new(0.287, -0.829, 0.480),
    DVec3::new(0.641, 0.269, -0.719),
];

/// Does a body hold a part of the other one, at a time at which the surfaces share no point? If neither does, the solids share none until
/// the surfaces do. `None`: a filled surface does not close, or no ray decides.
pub(crate) fn is_held(bodies: &[Body<'_>; 2], now: &Instant) -> Option<bool> {
    let mut found = Some(false);
    for holder in 0..2 {
        let [outer, inner] = [bodies[holder].mesh, bodies[1 - holder].mesh];
        if bodies[holder].solid == Solid::Surface {
            continue;
        }
        if outer.surface().closes == Closes::No {
            return None;
        }
        for &vertex in &inner.surface().parts {
            let p = inner.relative(inner.vertices[vertex as usize]);
            let seen = if holder == 0 { now.seen(p) } else { now.seen_back(p) };
            match RAYS.iter().find_map(|&ray| contains(outer, seen, ray)) {
                Some(false) => {}
                Some(true) => return Some(true),
                None => found = None,
            }
        }
    }
    found
}

/// How far from the middles of triangles points are tried, in parts of their sizes.
const DEPTHS: [f64; 4] = [0.25, 0.03125, 0.000_976_562_5, 0.000_000_953_674_316_406_25];
/// Triangles of each body at most that points are tried about.
const MOST: usize = 64;

/// Triangles that are placed in the time of a step, and steps that a point takes.
const PLACED: usize = 64;
const TRIED: u64 = 4;

/// Do the triangles cross, or is a point found inside of both solids, at all times that are enclosed? Looked for in the middle of what the
/// bounding boxes share, and above and below the middles of these triangles and then of others there.
pub(crate) fn overlap(bodies: &[Body<'_>; 2], now: &Instant, triangles: [u32; 2], left: &mut u64) -> bool {
    let [base, other] = bodies.map(|body| body.mesh);
    if now.most_distance(&[base.corners(triangles[0]), other.corners(triangles[1])]) == 0.0 {
        return true;
    }
    if bodies.iter().any(|body| body.solid == Solid::Surface || body.mesh.surface().closes == Closes::No) {
        return false;
    }
    *left = left.saturating_sub(((base.triangle_count() + other.triangle_count()) / PLACED) as u64);
    let placed = [
        base.guesses().collect::<Vec<[DVec3; 3]>>(),
        other.guesses().map(|corners| corners.map(|q| now.guess(q))).collect(),
    ];
    let [(low, high), (low_b, high_b)] = placed.each_ref().map(|all| {
        all.iter()
            .flatten()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
    });
    let (low, high) = (low.max(low_b), high.min(high_b));
    let is_there =
        |[p, q, r]: &[DVec3; 3]| p.min(*q).min(*r).cmple(high).all() && p.max(*q).max(*r).cmpge(low).all();
    let there = placed.iter().flat_map(|all| {
        let there: Vec<_> = all.iter().copied().filter(is_there).collect();
        let step = 1 + there.len() / MOST;
        there.into_iter().step_by(step)
    });
    let first = [0, 1].map(|k| placed[k][triangles[k] as usize]);
    let about = first.into_iter().chain(there).flat_map(|[p, q, r]| {
        let size = p.distance(q).max(q.distance(r)).max(r.distance(p));
        let normal = (q - p).cross(r - p).normalize_or_zero() * size;
        DEPTHS.into_iter().flat_map(move |depth| [-depth, depth].map(|d| (p + q + r) / 3.0 + normal * d))
    });
    let is_in = |mesh, p| RAYS.iter().find_map(|&ray| contains(mesh, p, ray)) == Some(true);
    [low * 0.5 + high * 0.5]
        .into_iter()
        .chain(about)
        .map(IntervalVec3::point)
        .take_while(|_| {
            *left = left.saturating_sub(TRIED);
            *left > 0
        })
        .any(|p| is_in(base, p) && is_in(other, now.seen_back(p)))
}

/// Is the point (from the mesh's center) in the solid? `None`: the ray does not decide.
fn contains(mesh: &Mesh, p: IntervalVec3, ray: DVec3) -> Option<bool> {
    let (mut winding, mut count) = (0, 0);
    let mut stack = vec![0];
    while let Some(node) = stack.pop() {
        let node = &mesh.nodes[node as usize];
        if passes_by(mesh.bounds(node) - p, ray) {
            continue;
        }
        match node.below {
            Below::Nodes(first) => stack.extend([first, first + 1]),
            Below::Triangle(triangle) if !mesh.surface().left_out[triangle as usize] => {
                let crossing = crossing(mesh.corners(triangle).map(|v| v - p), ray)?;
                (winding, count) = (winding + crossing, count + crossing.abs());
            }
            Below::Triangle(_) => {}
        }
    }
    Some(if mesh.surface().closes == Closes::Oriented { winding != 0 } else { count % 2 != 0 })
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
