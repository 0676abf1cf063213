//! The contacts of two bodies at one instant: those of their closest features that count.

use crate::body::rigid_body::RigidBody;
use d2m_bvh::{Proximity, ProximityOptions, QueryError, TriMesh, proximities_with, reduce_proximities};
use d2m_contact::{ContactPoint, Material};
use d2m_feature::FeaturePair;
use d2m_motion::Pose;
use glam::DVec3;

/// Features within this many gaps are measured in any case.
pub(crate) const AROUND: f64 = 1.5;
/// The sine of the angle by which features may be tilted and still be one contact, as at the far vertices of
/// a box that lies almost flat.
const TILT: f64 = 0.1;

/// A contact takes the normal of a face beside it, if the closest point lies sideways of the face by no more
/// than this part of the gap (of the distance, if that is more). Where a vertex lies over an edge, the
/// direction between them turns by that offset over the distance, however small both are: without friction
/// equal boxes on each other would slide apart. A fiftieth was chosen by experiment: with zero the boxes of
/// `cubes_without_friction_fall_flat_and_stack` slide apart by 6 gaps.
const FLAT: f64 = 0.02;

/// Below this part of the gap contacts keep their true normals besides those of faces. Flights end between
/// half of the gap and 1.21 times that, so a pair that is closer than 0.3 has been stopped twice: the
/// contacts with the normals of faces, which it has had until then, do not keep it apart.
const TIGHT: f64 = 0.3;

/// The number of contacts along the normal of a face from which on they are those of a face.
const FACE: usize = 3;

/// The part of a pair's load from which on a contact counts as bearing it.
const BEARING: f64 = 1.0 / 16.0;

/// The contacts of a pair, and the number of features from which they were chosen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Measured {
    pub(crate) contacts: Vec<ContactPoint>,
    pub(crate) features: usize,
    /// The distance of the bodies to rounding; the margin, if they are further apart.
    pub(crate) apart: f64,
    /// The direction between the closest features.
    pub(crate) normal: Option<DVec3>,
}

/// Measures the closest features of two bodies within `margin` at a time of their flights. `pair`: the
/// numbers of the bodies; `before`: their last contacts.
pub(crate) fn measure(
    bodies: &[RigidBody],
    pair: (usize, usize),
    time: f64,
    margin: f64,
    gap: f64,
    material: Material,
    before: &[ContactPoint],
) -> Result<Measured, QueryError> {
    let (a, b) = (&bodies[pair.0], &bodies[pair.1]);
    let (posed_a, posed_b) = (a.posed_at(time), b.posed_at(time));
    let radii = [a.rounding, b.rounding];
    let options = ProximityOptions::new(margin + (radii[0] + radii[1])).with_cone_slack(TILT);
    let mut wide = proximities_with(posed_a, posed_b, &options)?;
    let is_round = radii != [0.0; 2];
    if is_round {
        wide = wide.iter().map(|near| near.with_radii(radii)).collect();
    }
    // They are in the order of their distances.
    let (apart, normal) = (wide.first().map_or(margin, |p| p.distance), wide.first().map(|p| p.normal));
    // The points of meshes with radii are far apart, so the directions between them are as exact as those of
    // faces.
    let flatten = |p: &Proximity| {
        if is_round { None } else { flattened(p, [a, b], [&posed_a.pose, &posed_b.pose], gap) }
    };
    let exact = wide.iter().filter(|p| p.tilt == 0.0);
    let mut normals: Vec<DVec3> = exact.map(|p| flatten(p).unwrap_or(*p).normal).collect();
    normals.sort_by(|a, b| order(*a, *b));
    normals.dedup();
    // They are in the order of their first coordinates: normals outside this range are further off.
    let beside = |x: f64| {
        let [from, to] = [x - TILT, x + TILT].map(|end| normals.partition_point(|normal| normal.x < end));
        &normals[from..to]
    };
    let straight = |p: &Proximity| {
        // Two edges whose common normal is outside of their cones would push askew: where faces are almost
        // parallel they take the normal of a locally closest pair. Without one they are no contact.
        if is_edges(p) && p.tilt > 0.0 {
            along(p, beside(p.normal.x), TILT)
        } else {
            Some(flatten(p).unwrap_or(*p))
        }
    };
    let found: Vec<Proximity> = wide.iter().filter_map(straight).collect();
    let chosen = reduce_proximities(&found, TILT);
    let reduced =
        [beside_askew(&chosen, (gap, material.friction), || wide.iter().filter_map(flatten)), chosen]
            .concat();
    // A contact that bears a part of the load stays one as long as it is near: without it the body would tip
    // over it.
    let load: f64 = before.iter().map(|contact| contact.impulse).sum();
    let bears = |p: &&Proximity| {
        before.iter().any(|contact| contact.feature == p.feature && contact.impulse > BEARING * load)
    };
    let kept: Vec<Proximity> = found.iter().filter(bears).filter(|p| !reduced.contains(p)).copied().collect();
    let found = [reduced, kept].concat();
    let middle = |p: &Proximity| 0.5 * (p.point_a + p.point_b);
    let runs = b.surface_velocity_at(posed_b.pose.rotation) - a.surface_velocity_at(posed_a.pose.rotation);
    let contact = |p: &Proximity| {
        let arms = [posed_a, posed_b].map(|body| middle(p) - body.pose.translation);
        let touching = ContactPoint::new([pair.0, pair.1], arms, p.normal, material);
        let running = touching.tangents.map(|tangent| tangent.dot(runs));
        ContactPoint { feature: p.feature, distance: p.distance, gap, point: middle(p), running, ..touching }
    };
    // Where hardly any of the gap is left, sliding bodies must not approach along the true direction either.
    let is_tight = |p: &&Proximity| p.tilt == 0.0 && p.distance < TIGHT * gap && !found.contains(*p);
    let mut all = found.clone();
    all.extend(wide.iter().filter(is_tight));
    let contacts = all.iter().filter(|p| p.normal.is_normalized()).map(contact).collect();
    Ok(Measured { contacts, features: wide.len(), apart, normal })
}

/// Beside the rim of a face that lies on another one normals are askew. Where friction does not hold them,
/// such contacts give way sideways: a body that stands on one tips, as a heavy body on a light one. Where one
/// was chosen for a corner of the faces, this gives the corners along the faces' own normals. A slant that
/// friction holds needs none, nor does a body that is touched from several sides, as a pin in its hole.
fn beside_askew<F: Iterator<Item = Proximity>>(
    chosen: &[Proximity],
    (gap, friction): (f64, f64),
    flat: impl Fn() -> F,
) -> Vec<Proximity> {
    let mut added: Vec<Proximity> = Vec::new();
    let is_of_one_side = |p: &Proximity| (p.normal - chosen[0].normal).length() <= TILT;
    if friction >= TILT || !chosen.iter().all(is_of_one_side) {
        return added;
    }
    for askew in chosen {
        let near = |p: &Proximity| (p.normal - askew.normal).length() <= TILT;
        let mut of_face: Vec<Proximity> = flat().filter(near).collect();
        let Some(closest) = of_face.first().copied() else { continue };
        let is_along = |p: &Proximity, most: f64| (p.normal - closest.normal).length() <= most;
        of_face.retain(|p| is_along(p, FLAT));
        if of_face.len() >= FACE && !is_along(askew, flat_within(askew, gap).max(friction)) {
            let corners = reduce_proximities(&of_face, TILT);
            added.extend(corners.into_iter().filter(|p| !chosen.contains(p)));
        }
    }
    added.sort_by(|x, y| x.distance.total_cmp(&y.distance));
    added.dedup();
    added
}

/// Any total order.
fn order(a: DVec3, b: DVec3) -> core::cmp::Ordering {
    a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)).then(a.z.total_cmp(&b.z))
}

fn is_edges(p: &Proximity) -> bool {
    matches!(p.feature, FeaturePair::EdgeEdge { .. })
}

/// The proximity with the normal of a face at its features, if that is almost its own.
fn flattened(p: &Proximity, bodies: [&RigidBody; 2], poses: [&Pose; 2], gap: f64) -> Option<Proximity> {
    let vertices = vertices_of(p.feature, bodies.map(|body| body.tree.mesh()));
    let normal = |k: usize| {
        let direction = poses[k].rotation.conjugate() * p.normal;
        bodies[k].faces.nearest(&vertices[k], direction).map(|normal| poses[k].transform_vector(normal))
    };
    let normals: Vec<DVec3> = (0..2).filter_map(normal).collect();
    along(p, &normals, flat_within(p, gap))
}

/// How far the direction of a proximity may be off the normal of a face to be replaced by it.
fn flat_within(p: &Proximity, gap: f64) -> f64 {
    (FLAT * gap / p.distance).clamp(FLAT, TILT)
}

/// The proximity with the nearest of these normals and the distance along it, if there is one within `most`.
fn along(p: &Proximity, normals: &[DVec3], most: f64) -> Option<Proximity> {
    let nearest =
        normals.iter().copied().reduce(|m, n| if n.dot(p.normal) > m.dot(p.normal) { n } else { m })?;
    let distance = nearest.dot(p.point_b - p.point_a);
    let mut straight = *p;
    (straight.normal, straight.distance) = (nearest, distance);
    ((nearest - p.normal).length() <= most && distance > 0.0).then_some(straight)
}

/// The vertices of the features of A and of B.
pub(crate) fn vertices_of(feature: FeaturePair, meshes: [&TriMesh; 2]) -> [[u32; 3]; 2] {
    let face = |body: usize, triangle: u32| meshes[body].triangles()[triangle as usize];
    match feature {
        FeaturePair::VertexFace { vertex, face: triangle } => [[vertex; 3], face(1, triangle)],
        FeaturePair::FaceVertex { face: triangle, vertex } => [face(0, triangle), [vertex; 3]],
        FeaturePair::EdgeEdge { edge_a: [a, b], edge_b: [c, d] } => [[a, b, b], [c, d, d]],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use d2m_bvh::MeshTree;
    use d2m_mesh::Faces;
    use glam::DQuat;
    use std::f64::consts::FRAC_PI_4;
    use std::sync::Arc;

    /// Where corners lie beyond the rim of the face below by a thirtieth of the gap, there are contacts along
    /// the face's normal, too, without friction.
    #[test]
    fn corners_beside_a_rim_push_along_the_face() {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=0.5&y=0.5&z=0.5").unwrap()));
        let faces = Arc::new(Faces::new(tree.mesh()));
        let gap = 1e-3;
        let cube = |place: DVec3, turn: f64| {
            let body = Body::new("", Arc::clone(&tree)).with_position(place);
            let body = body.with_orientation(DQuat::from_rotation_y(turn));
            RigidBody::try_new(&body, Arc::clone(&faces), 0.0).unwrap()
        };
        let upright = |turn: f64, friction: f64| {
            let corner = 0.5 * (turn.cos() + turn.sin());
            let off = DVec3::new(0.5 + 0.04 * gap - corner, 1.0 + gap, 0.0);
            let bodies = [cube(DVec3::ZERO, 0.0), cube(off, turn)];
            let material = Material::new(0.0, friction);
            let found = measure(&bodies, (0, 1), 0.0, AROUND * gap, gap, material, &[]).unwrap().contacts;
            found.iter().filter(|c| c.normal.y > 1.0 - 1e-12).count()
        };
        let counts: Vec<[usize; 2]> =
            (1..20).map(|k| 0.02 * f64::from(k)).map(|turn| [0.0, 0.5].map(|f| upright(turn, f))).collect();
        assert!(counts.iter().all(|[free, held]| *free >= 4 && free >= held), "{counts:?}");
        assert!(counts.iter().any(|[_, held]| *held < 4), "{counts:?}");
    }

    /// Two plates that lie on each other turned by 40 degrees: eight corners, of which rounding decides which
    /// four are contacts.
    #[test]
    fn what_bears_the_load_stays_a_contact() {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=0.1&z=1").unwrap()));
        let faces = Arc::new(Faces::new(tree.mesh()));
        let gap = 1e-3;
        let plate = |place: DVec3, turn: DQuat| {
            let body = Body::new("", Arc::clone(&tree)).with_position(place).with_orientation(turn);
            RigidBody::try_new(&body, Arc::clone(&faces), 0.0).unwrap()
        };
        let measured = |tilt: DVec3, before: &[ContactPoint]| {
            let turn = DQuat::from_scaled_axis(tilt) * DQuat::from_rotation_y(0.7);
            let bodies = [plate(DVec3::ZERO, DQuat::IDENTITY), plate(DVec3::Y * (0.2 + gap), turn)];
            let material = Material::new(0.0, 0.5);
            measure(&bodies, (0, 1), 0.0, AROUND * gap, gap, material, before).unwrap().contacts
        };
        let tilt = |eighth: u32| DQuat::from_rotation_y(f64::from(eighth) * FRAC_PI_4) * DVec3::X * 1e-5;
        let has = |contacts: &[ContactPoint], feature| contacts.iter().any(|c| c.feature == feature);
        let mut before = measured(tilt(0), &[]);
        let differs = |&eighth: &u32| {
            let others = measured(tilt(eighth), &[]);
            before.iter().any(|contact| !has(&others, contact.feature))
        };
        let other = tilt((1..8).find(differs).unwrap());
        let others = measured(other, &[]);
        assert!(before.len() == 4 && others.len() == 4);
        let gone = before.iter().position(|contact| !has(&others, contact.feature)).unwrap();
        let feature = before[gone].feature;
        for (load, stays) in [(0.3, true), (0.01, false), (0.0, false)] {
            let count = before.len() as f64;
            for contact in &mut before {
                contact.impulse = 1.0 / count;
            }
            before[gone].impulse = load;
            let now = measured(other, &before);
            assert_eq!(has(&now, feature), stays, "{load}");
            assert!(others.iter().all(|contact| has(&now, contact.feature)));
        }
    }
}
