//! A crowd whose first pair that is followed ends the search: at the time proven so far, or because any contact will do.

use d2m_bvh::{MeshTree, Mode, Moving, QueryOptions, TimeOfContact, TriMesh, Window, time_of_contact};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3, dvec3};

/// A cone of so many sides with its apex at the origin, opening along z times `side`.
fn cone(sides: u32, side: f64) -> MeshTree {
    let mut corners = vec![DVec3::ZERO, DVec3::Z * side];
    let mut triangles = Vec::new();
    for k in 0..sides {
        let (sin, cos) = (f64::from(k) / f64::from(sides) * core::f64::consts::TAU).sin_cos();
        corners.push(dvec3(0.5 * cos, 0.5 * side * sin, side));
        let (this, next) = (2 + k, 2 + (k + 1) % sides);
        triangles.extend([[0, next, this], [1, this, next]]);
    }
    MeshTree::new(TriMesh::try_new(corners, triangles).unwrap())
}

/// Cones come apex to apex and cross: any contact will do, and the answer is one.
#[test]
fn crowds_exist() {
    let [up, down] = [1.0, -1.0].map(|side| cone(100, side));
    for (gap, speed, spin) in [(0.25, 1.0, 0.0), (0.0, 1.0, 3.0), (2.5, 5.0, 0.0), (0.1, 0.2, 1.0)] {
        let falling =
            ConstantTwist::try_new(DVec3::Z * gap, DQuat::IDENTITY, DVec3::Z * -speed, DVec3::Z * spin)
                .unwrap();
        let [a, b] = [Moving::new(&up, &falling), Moving::new(&down, &ConstantTwist::REST)];
        let options = QueryOptions::default().with_mode(Mode::Exists);
        let answer = time_of_contact(a, b, Window::UNIT, &options).unwrap();
        assert!(matches!(answer, TimeOfContact::Contact(_)), "{answer:?}");
    }
}
