//! parry3d-f64 on the same meshes and motions.
use crate::judge::Placement;
use crate::trials::Movement;
use d2m::bvh::TriMesh;
use glam::{DQuat, DVec3};
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query::{self, NonlinearRigidMotion};

/// A mesh with parry's own tree.
pub(crate) type Mesh = parry3d_f64::shape::TriMesh;

pub(super) fn mesh(mesh: &TriMesh) -> Mesh {
    let vertices = mesh.vertices().iter().map(|&v| vector(v)).collect();
    Mesh::new(vertices, mesh.triangles().to_vec()).expect("a checked mesh has triangles")
}

pub(super) fn vector(v: DVec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

pub(super) fn pose(rotation: DQuat, position: DVec3) -> Pose {
    let q = rotation.normalize();
    Pose::from_parts(vector(position), Rotation::from_xyzw(q.x, q.y, q.z, q.w))
}

fn placed(at: &Placement) -> Pose {
    pose(at.rotation, at.position)
}

/// `intersection_test` of the surfaces.
pub(crate) fn intersect(a: &Mesh, b: &Mesh, at_a: &Placement, at_b: &Placement) -> bool {
    query::intersection_test(&placed(at_a), a, &placed(at_b), b).expect("meshes are supported").intersecting
}

/// `distance` of the surfaces.
pub(crate) fn distance(a: &Mesh, b: &Mesh, at_a: &Placement, at_b: &Placement) -> f64 {
    query::distance(&placed(at_a), a, &placed(at_b), b).expect("meshes are supported").distance
}

/// `cast_shapes_nonlinear` over [0, 1]: time of impact, if there is one.
pub(crate) fn cast(a: &Mesh, b: &Mesh, of_a: &Movement, of_b: &Movement) -> Option<f64> {
    let motion = |m: &Movement| {
        let start = pose(m.rotation, m.position);
        NonlinearRigidMotion::new(start, Vector::ZERO, vector(m.velocity), vector(m.angular_velocity))
    };
    query::cast_shapes_nonlinear(&motion(of_a), a, &motion(of_b), b, 0.0, 1.0, true)
        .expect("meshes are supported")
        .map(|hit| hit.time_of_impact)
}
