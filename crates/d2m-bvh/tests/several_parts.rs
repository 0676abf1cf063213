//! Solids of several closed parts: overlapping, nested, inside out, repeated; and bodies of which one part is inside.

use d2m_bvh::{
    Budget, Evidence, MeshTree, Moving, Posed, QueryOptions, Solid, StartState, TimeOfContact, TriMesh,
    Window, collide, collide_within, colliding_pairs, distance, time_of_contact,
};
use d2m_motion::ConstantTwist;
use d2m_testing::Surface;
use glam::DVec3;
use std::time::{Duration, Instant};

/// One mesh of several.
fn joined(parts: &[Surface]) -> MeshTree {
    let all = parts[1..].iter().fold(parts[0].clone(), Surface::with);
    MeshTree::new(all.into_mesh(TriMesh::try_new))
}

/// From −half to half about the point.
fn about(point: DVec3, half: f64) -> Surface {
    Surface::cuboid(point - half, point + half)
}

fn start_of(a: &MeshTree, b: &MeshTree) -> TimeOfContact {
    let rest = ConstantTwist::REST;
    time_of_contact(Moving::new(a, &rest), Moving::new(b, &rest), Window::UNIT, &QueryOptions::default())
        .unwrap()
}

/// All queries agree, for both orders of the bodies.
#[track_caller]
fn check(a: &MeshTree, b: &MeshTree, held: bool) {
    for (a, b) in [(a, b), (b, a)] {
        let (p, q) = (Posed::at_rest(a), Posed::at_rest(b));
        assert_eq!(collide(p, q, Solid::Filled).unwrap(), held);
        let state = if held { StartState::Contained } else { StartState::Apart };
        assert_eq!(distance(p, q, Solid::Filled).unwrap().state, state);
        match start_of(a, b) {
            TimeOfContact::Contact(contact) => {
                assert!(held);
                assert_eq!((contact.start, contact.evidence), (StartState::Contained, Evidence::Crossing));
            }
            answer => assert!(!held && answer.is_separated(), "{answer:?}"),
        }
    }
}

#[test]
fn a_solid_is_where_the_winding_number_is_not_zero() {
    let probe = joined(&[about(DVec3::ZERO, 0.25)]);
    let (large, small) = (about(DVec3::ZERO, 4.0), about(DVec3::ZERO, 2.0));
    let beside = about(DVec3::X * 2.0, 3.0);
    check(&joined(std::slice::from_ref(&large)), &probe, true);
    // Two and three parts over the probe, a repeated one, one inside out alone.
    check(&joined(&[large.clone(), beside.clone()]), &probe, true);
    check(&joined(&[large.clone(), beside.clone(), small.clone()]), &probe, true);
    check(&joined(&[large.clone(), large.clone()]), &probe, true);
    check(&joined(&[large.clone().inverted()]), &probe, true);
    check(&joined(&[large.clone().inverted(), beside.inverted()]), &probe, true);
    // A cavity, and parts that cancel each other.
    check(&joined(&[large.clone(), small.clone().inverted()]), &probe, false);
    check(&joined(&[large.clone(), large.clone().inverted()]), &probe, false);
    // An island in the cavity.
    check(&joined(&[large, small.inverted(), about(DVec3::ZERO, 1.0)]), &probe, true);
}

#[test]
fn one_part_of_several_is_enough() {
    let room = joined(&[about(DVec3::ZERO, 2.0)]);
    let far = |k: f64| about(DVec3::new(9.0, k, 0.0), 0.25);
    check(&joined(&[far(0.0), far(1.0), about(DVec3::ONE, 0.25), far(2.0)]), &room, true);
    check(&joined(&[far(0.0), far(1.0), far(2.0)]), &room, false);
    // The room is the last part of its body, and the guest the last of its own.
    let rooms = joined(&[about(DVec3::Y * 20.0, 2.0), about(DVec3::Y * -20.0, 2.0), about(DVec3::ZERO, 2.0)]);
    check(&joined(&[far(0.0), about(DVec3::ZERO, 0.5)]), &rooms, true);
}

/// Sheets of walls: nothing here may take longer than its budget.
#[test]
fn budgets_hold_for_containment() {
    let walls: Vec<_> = (0..4000)
        .map(|k| {
            let x = f64::from(k) * 1e-4;
            Surface::cuboid(DVec3::new(x, -1.0, -1.0), DVec3::new(x + 2e-5, 1.0, 1.0))
        })
        .collect();
    let walls = joined(&walls);
    let guests: Vec<_> = (0..64).map(|k| about(DVec3::new(-0.1, 0.01 * f64::from(k), 0.0), 1e-3)).collect();
    let guests = joined(&guests);
    let rest = ConstantTwist::REST;
    let options =
        QueryOptions::default().with_budget(Budget::UNLIMITED.with_wall_clock(Duration::from_millis(50)));
    let begun = Instant::now();
    let answer =
        time_of_contact(Moving::new(&walls, &rest), Moving::new(&guests, &rest), Window::UNIT, &options)
            .unwrap();
    assert!(begun.elapsed() < Duration::from_millis(100), "{:?}", begun.elapsed());
    assert!(answer.is_separated());
    // Without node tests nothing is known, not even the start.
    let none = Budget::UNLIMITED.with_node_tests(0);
    let options = QueryOptions::default().with_budget(none);
    let answer =
        time_of_contact(Moving::new(&walls, &rest), Moving::new(&guests, &rest), Window::UNIT, &options)
            .unwrap();
    assert_eq!(answer, TimeOfContact::Undecided { clear_until: 0.0 });
    let (p, q) = (Posed::at_rest(&walls), Posed::at_rest(&guests));
    assert_eq!(collide_within(p, p, Solid::Filled, &none).unwrap(), None);
    assert_eq!(collide_within(p, q, Solid::Filled, &Budget::UNLIMITED).unwrap(), Some(false));
}

/// All triangles of a body that is one point up to rounding.
#[test]
fn all_pairs_of_a_body_like_a_point() {
    let p = DVec3::new(-128.0, 256.0, 0.0);
    let dots = |n: u32, size: f64| {
        let vertices = (0..3 * n).map(|k| p + DVec3::new(0.0, 0.0, size * f64::from(k)));
        MeshTree::new(Surface::soup(vertices).into_mesh(TriMesh::try_new))
    };
    let face = vec![DVec3::new(-256.0, 256.0, 0.0), DVec3::new(0.0, 256.0, 0.0), DVec3::new(256.0, 0.0, 0.0)];
    let face = MeshTree::new(TriMesh::try_new(face, vec![[0, 1, 2]]).unwrap());
    for (n, size) in [(2, 0.0), (3, 0.0), (9, 0.0), (9, 1e-18)] {
        let a = dots(n, size);
        let pairs =
            |a: &MeshTree, b: &MeshTree| colliding_pairs(Posed::at_rest(a), Posed::at_rest(b)).unwrap();
        assert_eq!(pairs(&a, &face), (0..n).map(|i| [i, 0]).collect::<Vec<_>>());
        assert_eq!(pairs(&face, &a), (0..n).map(|i| [0, i]).collect::<Vec<_>>());
        assert_eq!(pairs(&a, &dots(2, 0.0)).len() as u32, 2 * n);
    }
}
