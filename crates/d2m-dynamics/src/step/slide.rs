//! How far closest points may slide before they may slip off their features, and points beside them that may
//! slide further.

use crate::body::rigid_body::RigidBody;
use crate::pairs::closest_features::vertices_of;
use d2m_contact::{ASKEW, CROSSING, ContactPoint, LEVER, ROUNDED};
use d2m_feature::{FeaturePair, estimate_closest_point};
use glam::DVec3;

/// Points beside a closest one are taken at this part of the way from it to the corners and the middle of a
/// triangle, 2⁻⁸. Where that way is as long as an arm, it is 16 times as far as bodies move while they are
/// proven to be crushed.
const BESIDE: f64 = 1.0 / (1u64 << 8) as f64;

/// By how much a direction may be off that of a face: half of what the proof allows, since the other half is
/// for rounding.
const MOST: f64 = 0.5 * ASKEW;

/// A contact, and how far its bodies may move against each other while its direction turns no faster than
/// they do and its features keep its points apart.
pub(super) type Sliding = (ContactPoint, f64);

/// The contact with the way that it may slide, if its direction is that of a face or across edges, and points
/// of one surface beside it that may slide further over a flat part of the other surface. Where faces of the
/// same size lie on each other, the closest points are corners that may slip off at once; points a little
/// further in may not.
pub(super) fn slidings(contact: &ContactPoint, bodies: [&RigidBody; 2], time: f64) -> Vec<Sliding> {
    let own = slide(contact, bodies, time);
    let mut found: Vec<Sliding> = own.map(|slide| (*contact, slide)).into_iter().collect();
    let least = 2.0 * own.unwrap_or(0.0);
    found.extend(beside(contact, bodies, time).into_iter().filter(|(_, slide)| *slide > least));
    found
}

/// Points of each surface near a contact that lie over a flat part of the other surface, on the contact's
/// side of it and off it by more than rounding.
fn beside(contact: &ContactPoint, bodies: [&RigidBody; 2], time: f64) -> Vec<Sliding> {
    let meshes = bodies.map(|body| body.tree.mesh());
    let features = vertices_of(contact.feature, meshes);
    let poses = bodies.map(|body| body.pose_at(time));
    let radii = bodies[0].rounding + bodies[1].rounding;
    // The point as seen from body k, over a flat part of it.
    let over = |point: DVec3, k: usize| {
        let local = poses[k].inverse_transform_point(point);
        // From the flat part to the other body.
        let out = poses[k].rotation.conjugate() * if k == 0 { contact.normal } else { -contact.normal };
        let (triangle, foot) = bodies[k].faces.below(meshes[k], &features[k], [local, out], MOST)?;
        let sizes = meshes[k].corners(triangle as usize).map(DVec3::length);
        let rounded = ROUNDED * (sizes.into_iter().fold(local.length(), f64::max) + point.length());
        let room = bodies[k].faces.flat_around(meshes[k], &features[k], [foot, out], [MOST, rounded])?;
        let apart = foot.distance(local) - radii + rounded;
        let is_out = out.dot(local - foot) > rounded + radii;
        let middle = 0.5 * (point + poses[k].transform_point(foot));
        let [arm_a, arm_b] = poses.map(|pose| middle - pose.translation);
        let feature = FeaturePair::VertexFace { vertex: features[1 - k][0], face: triangle };
        let moved = ContactPoint { feature, distance: apart, arm_a, arm_b, point: middle, ..*contact };
        is_out.then_some((moved, room))
    };
    let mut found = Vec::new();
    for (k, other) in [(0, 1), (1, 0)] {
        for triangle in bodies[other].faces.around(&features[other]) {
            let corners = meshes[other].corners(triangle as usize);
            let nearest =
                estimate_closest_point(poses[other].inverse_transform_point(contact.point), &corners);
            let [a, b, c] = corners;
            let points = [a, b, c, (a + b + c) / 3.0].map(|to| nearest + (to - nearest) * BESIDE);
            found.extend(points.iter().filter_map(|&p| over(poses[other].transform_point(p), k)));
        }
    }
    found
}

/// How far the bodies of a contact may move against each other while its direction turns no faster than they
/// do and its features stay the closest ones: as far as the flat part of the surface below goes on; or,
/// across two edges that cross at no small angle, the part of [`LEVER`] of the rest of these. None: the
/// direction is not that of a face or of two such edges, as between two corners, where it turns in any case.
fn slide(contact: &ContactPoint, bodies: [&RigidBody; 2], time: f64) -> Option<f64> {
    let meshes = bodies.map(|body| body.tree.mesh());
    let features = vertices_of(contact.feature, meshes);
    let poses = bodies.map(|body| body.pose_at(time));
    let local = poses.map(|pose| pose.inverse_transform_point(contact.point));
    let on_face = |k: usize| {
        let direction = poses[k].rotation.conjugate() * contact.normal;
        // From the middle of the closest points to that of this body, and of its mesh.
        let inward = [-1.0, 1.0][k] * (0.5 * contact.distance + bodies[k].rounding);
        let point = local[k] + direction * inward;
        let size = contact.size() + point.length() + bodies[k].rounding;
        let off = [MOST, ROUNDED * size + MOST * contact.distance];
        bodies[k].faces.flat_around(meshes[k], &features[k], [point, direction], off)
    };
    let across_edges = || {
        let ends = |k: usize| [features[k][0], features[k][1]].map(|v| meshes[k].vertices()[v as usize]);
        let edge = |k: usize| poses[k].rotation * (ends(k)[1] - ends(k)[0]).normalize_or_zero();
        let across = edge(0).cross(edge(1));
        let along = contact.normal * across.dot(contact.normal).signum();
        let is_steady = across.length() >= CROSSING && (across.normalize_or_zero() - along).length() <= MOST;
        let left = (0..2).flat_map(|k| ends(k).map(|end| end.distance(local[k]) - contact.distance));
        is_steady.then(|| left.fold(f64::INFINITY, f64::min) / LEVER)
    };
    let edges = matches!(contact.feature, FeaturePair::EdgeEdge { .. }).then(across_edges).flatten();
    [on_face(0), on_face(1), edges].into_iter().flatten().reduce(f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use crate::pairs::closest_features::{AROUND, measure};
    use d2m_bvh::{MeshTree, TriMesh};
    use d2m_contact::Material;
    use d2m_mesh::Faces;
    use glam::{DQuat, DVec3};
    use std::f64::consts::FRAC_PI_4;
    use std::sync::Arc;

    const GAP: f64 = 1e-3;

    /// The mesh begins this far from its origin, so that its center is there.
    const OFF: DVec3 = DVec3::new(-0.3, 0.0, 2.0);

    fn body(shape: &str, position: DVec3, turn: DQuat) -> RigidBody {
        let mesh = d2m_shapes::mesh(shape).unwrap();
        let vertices = mesh.vertices().iter().map(|&vertex| vertex + OFF).collect();
        let mesh = TriMesh::try_new(vertices, mesh.triangles().to_vec()).unwrap();
        let (tree, position) = (Arc::new(MeshTree::new(mesh)), position - turn * OFF);
        let faces = Arc::new(Faces::new(tree.mesh()));
        RigidBody::try_new(&Body::new("", tree).with_position(position).with_orientation(turn), faces, 0.0)
            .unwrap()
    }

    fn contacts(bodies: &[RigidBody; 2]) -> Vec<ContactPoint> {
        let material = Material::new(0.0, 0.5);
        let contacts = measure(bodies, (0, 1), 0.0, AROUND * GAP, GAP, material, &[]).unwrap().contacts;
        assert!(!contacts.is_empty());
        contacts
    }

    fn slides(bodies: &[RigidBody; 2]) -> Vec<Option<f64>> {
        contacts(bodies).iter().map(|contact| slide(contact, [&bodies[0], &bodies[1]], 0.0)).collect()
    }

    /// A bar with an edge on top, and one across it, or almost along it, whose lowest edge is a gap above:
    /// they cross in their middles, or at 0.3 from an end of the upper one.
    #[test]
    fn what_is_left_of_edges_counts_a_tenth() {
        let bar = "box?x=1&y=0.1&z=0.1";
        let turned = DQuat::from_rotation_x(FRAC_PI_4);
        let above = |along: f64, turn: f64| {
            let height = DVec3::Y * (0.2 * 2f64.sqrt() + GAP);
            let turn = DQuat::from_rotation_y(turn);
            [body(bar, DVec3::ZERO, turned), body(bar, height + turn * DVec3::X * along, turn * turned)]
        };
        for (along, left) in [(0.0, 1.0), (0.7, 0.3)] {
            let slides = slides(&above(along, 1.5));
            assert!(
                slides.iter().all(|slide| slide.is_some_and(|s| (s - (left - GAP) / 10.0).abs() < 1e-4)),
                "{slides:?}"
            );
        }
        assert!(slides(&above(0.0, 0.4)).iter().all(Option::is_none));
    }

    /// A box that stands a gap above a plate, at its middle and near its rim, may slide half of the way to
    /// the rim, whichever triangles meet there.
    #[test]
    fn faces_count_half_of_what_is_left_of_them() {
        let plate = "box?x=1&y=0.1&z=1";
        for (middle, least, most) in [(0.0, 0.4, 0.45), (0.85, 0.024, 0.026), (0.899_999, 0.0, 1e-6)] {
            let position = DVec3::new(middle, 0.2 + GAP, 0.0);
            let slides = slides(&[
                body(plate, DVec3::ZERO, DQuat::IDENTITY),
                body("box?x=0.1&y=0.1&z=0.1", position, DQuat::IDENTITY),
            ]);
            let found = slides.iter().flatten().fold(f64::INFINITY, |a: f64, b| a.min(*b));
            assert!(
                slides.iter().all(Option::is_some) && found >= least && found <= most,
                "{middle}: {slides:?}"
            );
        }
    }

    /// A box on one of the same size, upright and leaning: points beside each corner may slide by some of
    /// their distance from it, and are at the distance that the leaning face has there. Behind the face, as
    /// seen along a direction that points into it, there are none.
    #[test]
    fn points_beside_corners_of_equal_faces_may_slide() {
        let cube = "box?x=0.5&y=0.5&z=0.5";
        for lean in [0.0f64, 2e-4] {
            // The lowest corners are a gap above.
            let height = 1.0 + GAP + 0.5 * lean - 0.25 * lean * lean;
            let turn = DQuat::from_rotation_z(lean);
            let bodies = [body(cube, DVec3::ZERO, DQuat::IDENTITY), body(cube, DVec3::Y * height, turn)];
            let both = [&bodies[0], &bodies[1]];
            let on_faces = contacts(&bodies).into_iter().filter_map(|c| Some((c, slide(&c, both, 0.0)?)));
            let on_faces: Vec<_> = on_faces.collect();
            assert!(!on_faces.is_empty());
            for (contact, own) in on_faces {
                assert!(own < 1e-3, "{own:?}");
                let mut found = slidings(&contact, both, 0.0);
                found.retain(|(c, _)| c.distance < 2.0 * GAP);
                let is_near = |c: &ContactPoint| c.point.distance(contact.point) < 2.0 * BESIDE;
                assert!(found.iter().any(|(c, slide)| is_near(c) && *slide > 0.1 * BESIDE), "{found:?}");
                for (c, slide) in found.iter().filter(|(_, slide)| *slide > 1e-4) {
                    let apart = GAP + (c.point.x + 0.5) * lean;
                    assert!(*slide < 0.26 && (c.distance - apart).abs() < 1e-12 + lean * lean, "{c:?}");
                }
                let behind = ContactPoint { normal: -contact.normal, ..contact };
                assert!(beside(&behind, both, 0.0).is_empty());
            }
        }
    }
}
