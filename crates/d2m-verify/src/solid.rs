//! Is a vertex of one body inside the other? The winding number of the surface, from the faces that a ray passes.
use crate::instant::Instant;
use crate::prove::{Obstacle, Proof, surfaces_clear};
use crate::{Body, Mesh, Reason, Solid, TimeSpan};
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// Rays of no special direction, one after the other until one passes no side of a face too closely.
const RAYS: [DVec3; 4] = [
    DVec3::new(0.531, 0.672, 0.516),
    DVec3::new(-0.713, 0.388, 0.584),
    DVec3::new(0.287, -0.829, 0.480),
    DVec3::new(0.641, 0.269, -0.719),
];

/// The bodies are further apart than the level all the time: their surfaces are, and at the start no body holds a part of the other, so none
/// ever does.
pub(crate) fn clear(bodies: &[Body<'_>; 2], span: TimeSpan, level: f64, left: &mut u64) -> Proof {
    surfaces_clear(bodies, span, level, left)?;
    match is_held(bodies, &Instant::new(bodies, span.from)) {
        Some(false) => Ok(()),
        Some(true) => Err(Obstacle::Met { time: span.from, triangles: None, distance: Interval::ZERO }),
        None => Err(Obstacle::Open { clear_until: span.from, reason: Reason::Solid, pair: None }),
    }
}

/// Does a body hold a part of the other one, at a time at which the surfaces share no point? If neither does, the solids share none until
/// the surfaces do. `None`: a filled surface does not close, or no ray decides.
fn is_held(bodies: &[Body<'_>; 2], now: &Instant) -> Option<bool> {
    let mut found = Some(false);
    for holder in (0..2).filter(|&holder| bodies[holder].solid == Solid::Filled) {
        let inner = bodies[1 - holder].mesh;
        for p in inner.surface().parts.iter().map(|&vertex| inner.vertex(vertex)) {
            let seen = if holder == 0 { now.seen(p) } else { now.seen_back(p) };
            match is_inside(bodies[holder].mesh, seen) {
                Some(false) => {}
                Some(true) => return Some(true),
                None => found = None,
            }
        }
    }
    found
}

/// How far from the middles of triangles points are tried, in parts of their sizes: against the normal, and along it.
const DEPTHS: [f64; 4] = [0.25, 0.03125, 0.000_976_562_5, 0.000_000_953_674_316_406_25];
/// About so many of them are tried.
const MOST: usize = 1024;
/// Triangles that are placed in the time of a step, and steps that a point takes.
const PLACED: usize = 64;
const TRIED: u64 = 4;

/// Do the triangles cross, or is a point found inside of both solids, at all times that are enclosed? Looked for in the middle of what the
/// bounding boxes share, and above and below the middles of these triangles and then of others there.
pub(crate) fn overlap(bodies: &[Body<'_>; 2], now: &Instant, pair: [u32; 2], left: &mut u64) -> bool {
    let meshes = bodies.map(|body| body.mesh);
    if now.most_distance(&[0, 1].map(|k| meshes[k].corners(pair[k]))) == 0.0 {
        return true;
    }
    if bodies.iter().any(|body| body.solid == Solid::Surface || !body.mesh.surface().has_parity) {
        return false;
    }
    let count = meshes.map(Mesh::triangle_count);
    *left = left.saturating_sub(((count[0] + count[1]) / PLACED) as u64);
    let common =
        meshes[0].bounds(&meshes[0].nodes[0]).intersection(now.seen(meshes[1].bounds(&meshes[1].nodes[0])));
    let about = |k: usize, triangle: u32| {
        let place = |p: IntervalVec3| if k == 0 { p.mid() } else { now.guess(p.mid()) };
        let [p, q, r] = meshes[k].corners(triangle).map(place);
        let size = p.distance(q).max(q.distance(r)).max(r.distance(p));
        [(p + q + r) / 3.0, (q - p).cross(r - p).normalize_or_zero() * size]
    };
    let all: Vec<_> = (0..2).flat_map(|k| (0..count[k] as u32).map(move |t| about(k, t))).collect();
    let points = |all: &[[DVec3; 2]]| {
        let depths = DEPTHS.into_iter().flat_map(|depth| [-depth, depth]);
        let points =
            depths.flat_map(|depth| all.iter().map(move |&[middle, normal]| middle + normal * depth));
        points.filter(|p| common.contains(*p)).collect::<Vec<DVec3>>()
    };
    let (first, there) = (points(&[about(0, pair[0]), about(1, pair[1])]), points(&all));
    let step = 1 + there.len() / MOST;
    let tried = [common.mid()].into_iter().chain(first).chain(there.into_iter().step_by(step));
    for p in tried.map(IntervalVec3::point) {
        *left = left.saturating_sub(TRIED);
        if *left == 0 {
            return false;
        }
        if is_inside(meshes[0], p) == Some(true) && is_inside(meshes[1], now.seen_back(p)) == Some(true) {
            return true;
        }
    }
    false
}

/// Is the point (from the mesh's center) in the solid? `None`: it has no inside, or no ray decides.
fn is_inside(mesh: &Mesh, p: IntervalVec3) -> Option<bool> {
    if !mesh.surface().has_parity {
        return None;
    }
    let winding = RAYS.iter().find_map(|&ray| winding(mesh, p, ray))?;
    Some(if mesh.surface().has_winding { winding != 0 } else { winding % 2 != 0 })
}

/// How often a ray from the point passes faces along their normals, less how often against them. `None`: the ray does not decide.
fn winding(mesh: &Mesh, p: IntervalVec3, ray: DVec3) -> Option<i32> {
    let (mut winding, mut open) = (0, vec![0]);
    while let Some(number) = open.pop() {
        let node = &mesh.nodes[number as usize];
        if passes_by(mesh.bounds(node) - p, ray) {
            continue;
        }
        let ray = IntervalVec3::point(ray);
        match *mesh.triangles_of(node) {
            [triangle] if mesh.surface().left_out[triangle as usize] => {}
            [triangle] => winding += crossing(mesh.corners(triangle).map(|v| v - p), ray)?,
            _ => open.extend(mesh.below(number)),
        }
    }
    Some(winding)
}

/// Does a ray from zero certainly miss the box? The box is behind, or beside, seen along a coordinate axis.
fn passes_by(bounds: IntervalVec3, ray: DVec3) -> bool {
    let across = bounds.cross_point(ray);
    let behind = [(bounds.x, ray.x), (bounds.y, ray.y), (bounds.z, ray.z)];
    behind.into_iter().any(|(side, r)| if r > 0.0 { side.hi() < 0.0 } else { side.lo() > 0.0 })
        || [across.x, across.y, across.z].into_iter().any(|side| side.certain_sign() != 0)
}

/// 1 where a ray from zero passes the face the way of its normal, −1 the other way, 0 where it certainly does not pass.
fn crossing([a, b, c]: [IntervalVec3; 3], ray: IntervalVec3) -> Option<i32> {
    let turns = [(a, b), (b, c), (c, a)].map(|(p, q)| ray.triple_product(p, q).certain_sign());
    if turns.contains(&1) && turns.contains(&-1) {
        return Some(0);
    }
    match a.triple_product(b, c).certain_sign() {
        0 => None,
        _ if turns.contains(&0) => None,
        // With the turns of one sign the line passes; ahead where the volume has that sign too.
        side => Some(if side == turns[0] { side } else { 0 }),
    }
}
