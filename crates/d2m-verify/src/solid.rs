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
