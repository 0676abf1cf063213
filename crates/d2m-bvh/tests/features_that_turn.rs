//! Features that stay close to each other while their bodies turn fast: a tip over a plate, beside an edge, at another tip. No
//! direction that is fixed in space parts such a pair for longer than the gap takes at the speed of the far ends.

use d2m_bvh::{
    Budget, MeshTree, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact_counted,
};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};

/// With this cap a failure is quick: each of the queries went on for more than ten million node tests.
const BUDGET: Budget = Budget::UNLIMITED.with_node_tests(1 << 21);

/// The sides of a cone with its tip in the origin that opens downwards.
fn cone(sides: u32, radius: f64, height: f64) -> MeshTree {
    let rim = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
        DVec3::new(radius * angle.cos(), radius * angle.sin(), -height)
    };
    let vertices = std::iter::once(DVec3::ZERO).chain((0..sides).map(rim)).collect();
    let faces = (0..sides).map(|k| [0, 1 + k, 1 + (k + 1) % sides]).collect();
    MeshTree::new(TriMesh::try_new(vertices, faces).unwrap())
}

/// Pages that share an edge along the x axis and spread downwards from it.
fn book(pages: u32) -> MeshTree {
    let corner = |k: u32| {
        let across = f64::from(2 * k + 1) / f64::from(pages) - 1.0;
        DVec3::new(across, 0.015 * across, -0.015)
    };
    let vertices = [DVec3::X * -4.5, DVec3::X * 4.5].into_iter().chain((0..pages).map(corner)).collect();
    let faces = (0..pages).map(|k| [0, 1, 2 + k]).collect();
    MeshTree::new(TriMesh::try_new(vertices, faces).unwrap())
}

fn plate() -> MeshTree {
    let corners = [(-2.6, -0.02), (2.6, -0.02), (2.6, 0.02), (-2.6, 0.02)];
    let corners = corners.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
    MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap())
}

/// The answer, and the work in node tests.
fn ask(
    a: (&MeshTree, ConstantTwist),
    b: (&MeshTree, ConstantTwist),
    window: (f64, f64),
) -> (TimeOfContact, u64) {
    let window = Window::try_new(window.0, window.1).unwrap();
    let options = QueryOptions::default().with_solid(Solid::Surface).with_budget(BUDGET);
    let (a, b) = (Moving::new(a.0, &a.1), Moving::new(b.0, &b.1));
    let asked = time_of_contact_counted(a, b, window, &options).unwrap();
    (asked.answer, asked.work.work())
}

fn turned(tilt: f64, spin: DVec3) -> ConstantTwist {
    ConstantTwist::REST.with_orientation(DQuat::from_rotation_y(tilt)).with_angular_velocity(spin)
}

/// Both turn about the line through the tip, the plate at a tilt: twelve turns, with 2e-9 between them.
#[test]
fn a_tip_over_a_plate_that_wobbles() {
    let (tip, plate) = (cone(5, 0.025, 0.18), plate());
    for (tilt, spins) in [(0.09, [73.6, -11.5]), (1e-3, [-5.0, 80.0]), (0.4, [0.0, 60.0])] {
        let flip = DQuat::from_rotation_x(std::f64::consts::PI);
        let above = turned(0.0, DVec3::Z * spins[0]).with_orientation(flip).with_position(DVec3::Z * 2e-9);
        let below = turned(tilt, DVec3::Z * spins[1]);
        for (a, b) in [((&tip, above), (&plate, below)), ((&plate, below), (&tip, above))] {
            let (answer, work) = ask(a, b, (0.0, 1.0));
            assert_eq!(answer, TimeOfContact::Separated, "{tilt} {spins:?}");
            assert!(work < 1 << 16, "{tilt} {spins:?}: {work}");
        }
    }
}

/// The tip drifts towards the common edge of many pages, which turns by 15 radians in a unit of time.
#[test]
fn a_tip_beside_an_edge_that_turns() {
    let (tip, pages) = (cone(100, 0.49, 0.15), book(140));
    let meet = 0.5;
    let drift = DVec3::new(-0.019, 0.01, 0.034);
    let moving = turned(0.1, DVec3::new(-0.7, 2.1, 0.0))
        .with_reference_time(meet)
        .with_position(DVec3::new(0.0, 2e-6, -1e-6))
        .with_linear_velocity(drift);
    let flip = DQuat::from_rotation_x(std::f64::consts::PI);
    let against = turned(0.0, DVec3::new(1.0, 10.3, 9.8)).with_reference_time(meet).with_orientation(flip);
    for (a, b) in [((&tip, moving), (&pages, against)), ((&pages, against), (&tip, moving))] {
        let (answer, work) = ask(a, b, (meet - 2e-3, meet + 2e-3));
        let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
        assert!((contact.time_lo - meet).abs() < 1e-3, "{contact:?}");
        assert!(work < 1 << 20, "{work}");
    }
}

/// Two tips 1e-8 from each other, spinning about different axes until a side meets the other cone.
#[test]
fn tips_that_turn_about_each_other() {
    let (a, b) = (cone(12, 0.1, 0.36), cone(6, 0.4, 1.3));
    let flip = DQuat::from_rotation_x(std::f64::consts::PI);
    let first = turned(0.0, DVec3::new(-74.0, 0.0, 1180.0));
    let second =
        turned(0.0, DVec3::new(27.0, 730.0, 100.0)).with_orientation(flip).with_position(DVec3::Z * 1e-8);
    for (a, b) in [((&a, first), (&b, second)), ((&b, second), (&a, first))] {
        let (answer, work) = ask(a, b, (0.0, 1.0));
        let contact = answer.contact().unwrap_or_else(|| panic!("{answer:?}"));
        assert!((1e-3..1e-2).contains(&contact.time_lo), "{contact:?}");
        assert!(work < 1 << 16, "{work}");
    }
}

/// Two edges cross at a gap down to 1e-9 while both triangles spin about lines through the crossing: until the edges are parallel, or
/// for whole turns. The number of tests once grew as one over the gap: 12 million for 1e-8.
#[test]
fn edges_that_cross_while_both_turn() {
    for gap in [1e-5, 1e-7, 1e-9] {
        for (k, axes) in [
            [DVec3::Z, DVec3::new(0.1, 0.05, 1.0)],
            [DVec3::new(0.02, 0.01, -1.0), DVec3::new(0.01, -0.02, 1.0)],
            [DVec3::new(0.02, 0.01, 0.7), DVec3::new(0.01, -0.02, 1.0)],
        ]
        .into_iter()
        .enumerate()
        {
            let triangle = |corners: [DVec3; 3]| {
                MeshTree::new(TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2]]).unwrap())
            };
            let lifted = DVec3::Z * gap;
            let along = DVec3::new(0.54, 0.84, 0.0);
            let upper = triangle([-DVec3::X + lifted, DVec3::X + lifted, DVec3::Z]);
            let lower = triangle([-along, along, -DVec3::Z]);
            let first = turned(0.0, axes[0].normalize() * std::f64::consts::TAU)
                .with_at(lifted)
                .with_position(lifted);
            let second = turned(0.0, axes[1].normalize() * -4.4);
            for (a, b) in [((&upper, first), (&lower, second)), ((&lower, second), (&upper, first))] {
                let (answer, work) = ask(a, b, (0.0, 1.0));
                assert!(work < 2048, "{gap:e} {k}: {work}");
                match answer {
                    TimeOfContact::Contact(contact) => {
                        assert!(k != 1 && (0.09..0.1).contains(&contact.time_lo), "{gap:e} {k}: {contact:?}");
                    }
                    other => assert!(k == 1 && other == TimeOfContact::Separated, "{gap:e} {k}: {other:?}"),
                }
            }
        }
    }
}
