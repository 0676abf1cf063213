//! Work that does not depend on what changes nothing, or next to nothing: counted in node and triangle tests, not in time.

use d2m_bvh::{
    Budget, MeshTree, Moving, QueryOptions, TimeOfContact, TriMesh, Window, time_of_contact_counted,
};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// A plate of n × n squares on either side, half extents x and z, centered.
fn plate(n: u32, half: f64, thick: f64) -> MeshTree {
    let number = |i: u32, j: u32, k: u32| (k * (n + 1) + i) * (n + 1) + j;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for (k, i) in (0..2).flat_map(|k| (0..=n).map(move |i| (k, i))) {
        let place = |i: u32| half * (2.0 * f64::from(i) / f64::from(n) - 1.0);
        vertices.extend((0..=n).map(|j| DVec3::new(place(i), place(j), thick * (f64::from(k) - 0.5))));
    }
    for (k, i, j) in (0..2).flat_map(|k| (0..n).flat_map(move |i| (0..n).map(move |j| (k, i, j)))) {
        let [a, b, c, d] =
            [number(i, j, k), number(i + 1, j, k), number(i + 1, j + 1, k), number(i, j + 1, k)];
        let square = if k == 1 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
        triangles.extend(square);
    }
    for i in 0..n {
        let rims = [
            [number(i, 0, 0), number(i + 1, 0, 0)],
            [number(i + 1, n, 0), number(i, n, 0)],
            [number(0, i + 1, 0), number(0, i, 0)],
            [number(n, i, 0), number(n, i + 1, 0)],
        ];
        let up = (n + 1) * (n + 1);
        triangles.extend(rims.into_iter().flat_map(|[a, b]| [[a, b, b + up], [a, b + up, a + up]]));
    }
    MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap())
}

/// A tube with these radii about z, of half length one.
fn tube(around: u32, inner: f64, outer: f64) -> MeshTree {
    let rings = [(outer, -1.0), (outer, 1.0), (inner, 1.0), (inner, -1.0)];
    let mut vertices = Vec::new();
    for (radius, z) in rings {
        vertices.extend((0..around).map(|k| {
            let angle = TAU * f64::from(k) / f64::from(around);
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        }));
    }
    let mut triangles = Vec::new();
    for (ring, k) in (0..4).flat_map(|ring| (0..around).map(move |k| (ring, k))) {
        let (this, next) = (ring * around, (ring + 1) % 4 * around);
        let (i, j) = (k, (k + 1) % around);
        triangles.extend([[this + i, this + j, next + j], [this + i, next + j, next + i]]);
    }
    MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap())
}

fn work_of(a: &MeshTree, b: &MeshTree, motions: [&ConstantTwist; 2]) -> (TimeOfContact, u64) {
    let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(3_000_000));
    let bodies = [Moving::new(a, motions[0]), Moving::new(b, motions[1])];
    let asked = time_of_contact_counted(bodies[0], bodies[1], Window::UNIT, &options).unwrap();
    (asked.answer, asked.work.work())
}

/// Plates that lie a millionth above each other and hardly move: swept volumes take both as at rest with a small speed.
#[test]
fn nearly_still_bodies_are_skipped() {
    let (a, b) = (plate(24, 1.0, 0.2), plate(24, 0.9, 0.2));
    for spin in [0.0, 1e-12, 1e-9, 1e-7] {
        for turn in [DVec3::X, DVec3::Y, DVec3::Z, DVec3::new(0.3, -0.4, 0.8)] {
            let above = ConstantTwist::REST.with_position(DVec3::Z * (0.2 + 1e-6));
            let moving = above.with_angular_velocity(turn * spin).with_linear_velocity(turn * spin);
            let (answer, work) = work_of(&a, &b, [&ConstantTwist::REST, &moving]);
            assert!(answer.is_separated(), "{spin:e} {turn}: {answer:?}");
            assert!(work < 4000, "{spin:e} {turn}: {work}");
        }
    }
}

/// Another reference point on the axis of the spin is the same motion.
#[test]
fn reference_points_along_the_axis_cost_nothing() {
    let (a, b) = (plate(12, 1.0, 0.2), tube(48, 1.5, 1.7));
    let axis = DVec3::new(0.0, 0.0, 1.0);
    let still = ConstantTwist::REST;
    let mut first = None;
    for along in [0.0, 1.0, -30.0, 1000.0] {
        let spinning =
            ConstantTwist::try_new(axis * along, DQuat::IDENTITY, axis * 0.2, axis * 40.0).unwrap();
        let spinning = spinning.try_with_at(axis * along).unwrap();
        let (answer, work) = work_of(&a, &b, [&spinning, &still]);
        let least = *first.get_or_insert(work);
        assert!(answer.is_separated());
        assert!(work <= 2 * least + 64, "{along}: {work} against {least}");
    }
}

/// A tube that spins in another one about their common axis, facets of both far from each other's.
#[test]
fn coaxial_tubes_are_skipped() {
    for around in [64, 512] {
        let (a, b) = (tube(around, 0.5, 0.99), tube(around, 1.0, 1.5));
        for (spin, slide) in [(1.0, 0.0), (40.0, 0.0), (40.0, 0.5), (400.0, 1e-3)] {
            let spinning = ConstantTwist::REST
                .with_angular_velocity(DVec3::Z * spin)
                .with_linear_velocity(DVec3::Z * slide);
            let (answer, work) = work_of(&a, &b, [&spinning, &ConstantTwist::REST]);
            assert!(answer.is_separated(), "{around} {spin} {slide}: {answer:?}");
            assert!(work < 40_000, "{around} {spin} {slide}: {work}");
        }
    }
}
