//! Bodies that are inside others when the query begins.

use d2m_bvh::{MeshTree, Moving, QueryOptions, StartState, TriMesh, Window, time_of_contact};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};

/// A closed cube.
fn cube(half: f64) -> MeshTree {
    let vertex =
        |i: u32| (DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0) * half;
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let halves = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]);
    MeshTree::new(TriMesh::try_new((0..8).map(vertex).collect(), halves.collect()).unwrap())
}

/// A small cube in the very corner of a large one, where the balls about both nearly part; whatever the reference points and
/// spins are.
#[test]
fn a_body_in_a_corner_of_the_other_is_held() {
    let (large, small) = (cube(1.0), cube(0.01));
    for spin in [DVec3::ZERO, DVec3::Z, DVec3::new(3.0, -2.0, 1.0)] {
        for at in [DVec3::ZERO, DVec3::new(0.3, -2.0, 5.0)] {
            for q in [DQuat::IDENTITY, DQuat::from_xyzw(0.1, -0.2, 0.3, 0.9).normalize()] {
                let place = q * (DVec3::splat(0.98) - at * 0.5);
                let outer = ConstantTwist::try_new(DVec3::ZERO, q, DVec3::X, spin).unwrap();
                let outer = outer.try_with_at(at * 0.5).unwrap();
                let inner = ConstantTwist::try_new(place, q, -DVec3::Y, -spin).unwrap();
                let [a, b] = [Moving::new(&large, &outer), Moving::new(&small, &inner)];
                for [a, b] in [[a, b], [b, a]] {
                    let answer = time_of_contact(a, b, Window::UNIT, &QueryOptions::default()).unwrap();
                    let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
                    assert_eq!((contact.start, contact.time_lo), (StartState::Contained, 0.0));
                }
            }
        }
    }
}
