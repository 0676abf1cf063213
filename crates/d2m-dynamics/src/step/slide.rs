//! How far closest points may slide on their features until they may slip off.

use crate::contact::{ASKEW, CROSSING, ContactPoint, LEVER, ROUNDED};
use crate::faces::vertices_of;
use crate::rigid_body::RigidBody;
use d2m_feature::FeaturePair;

/// How far the bodies of a contact may move against each other, up to which its direction turns no faster than they do and its features stay those
/// that are closest: as far as the flat part of the surface below it goes on, or, across two edges that cross at no small angle, the part of
/// [`LEVER`] of what is left of them. None: the direction is none of a face or of two such edges, as that between two corners, which turns anyhow.
pub(super) fn slide(contact: &ContactPoint, bodies: [&RigidBody; 2], time: f64) -> Option<f64> {
    // Half of it is for rounding.
    let most = 0.5 * ASKEW;
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
        let off = [most, ROUNDED * size + most * contact.distance];
        bodies[k].faces.flat_around(meshes[k], &features[k], [point, direction], off)
    };
    let across_edges = || {
        let ends = |k: usize| [features[k][0], features[k][1]].map(|v| meshes[k].vertices()[v as usize]);
        let edge = |k: usize| poses[k].rotation * (ends(k)[1] - ends(k)[0]).normalize_or_zero();
        let across = edge(0).cross(edge(1));
        let along = contact.normal * across.dot(contact.normal).signum();
        let is_steady = across.length() >= CROSSING && (across.normalize_or_zero() - along).length() <= most;
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
    use crate::contact::Material;
    use crate::faces::Faces;
    use crate::measured::{AROUND, measure};
    use d2m_bvh::{MeshTree, TriMesh};
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

    fn slides(bodies: &[RigidBody; 2]) -> Vec<Option<f64>> {
        let material = Material { restitution: 0.0, friction: 0.5 };
        let contacts = measure(bodies, (0, 1), 0.0, AROUND * GAP, GAP, material, &[]).unwrap().contacts;
        assert!(!contacts.is_empty());
        contacts.iter().map(|contact| slide(contact, [&bodies[0], &bodies[1]], 0.0)).collect()
    }

    /// A bar with an edge on top, and one across it, or almost along it, whose lowest edge is a gap above: they cross in their middles, or at 0.3 from
    /// an end of the upper one.
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

    /// A box that stands a gap above a plate, at its middle and near its rim: half of what is left of the plate, whichever triangles meet there.
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
}
