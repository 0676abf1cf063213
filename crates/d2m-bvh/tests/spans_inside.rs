//! Spans of contact in which no two triangles cross for long: solids deep inside of each other.

use d2m_bvh::{
    Budget, MeshTree, Moving, Posed, QueryOptions, Solid, SpanStatus, TriMesh, Window, collide, contact_spans,
};
use d2m_motion::{Chain, ConstantTwist, Joint, JointKind, JointValue, RigidMotion};
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::{DQuat, DVec3};

/// The default resolution of spans, a part of the window.
const RESOLUTION: f64 = 1e-6;

fn cuboid(half: DVec3) -> MeshTree {
    MeshTree::new(Surface::cuboid(-half, half).into_mesh(TriMesh::try_new))
}

/// Along x by a polynomial in time.
fn along_x(powers: Vec<f64>) -> Chain {
    let value = JointValue::try_polynomial(powers).unwrap();
    let kind = JointKind::Prismatic { axis: DVec3::X, value };
    Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap()
}

/// Clear before, in contact between two planted times, clear again.
fn check(trees: [&MeshTree; 2], motion: &dyn RigidMotion, planted: [f64; 2]) {
    let rest = ConstantTwist::REST;
    for bodies in [
        [Moving::new(trees[0], &rest), Moving::new(trees[1], motion)],
        [Moving::new(trees[1], motion), Moving::new(trees[0], &rest)],
    ] {
        let [a, b] = bodies;
        let spans = contact_spans(a, b, Window::UNIT, &QueryOptions::default(), None).unwrap();
        let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
        assert_eq!(statuses, [SpanStatus::Clear, SpanStatus::Contact, SpanStatus::Clear], "{spans:?}");
        for (found, truth) in [spans[1].from, spans[1].to].into_iter().zip(planted) {
            assert!((found - truth).abs() <= 2.0 * RESOLUTION, "{found} {truth}");
        }
    }
}

/// Sides in common planes: no side of a triangle passes through another one.
#[test]
fn flush_boxes_on_any_motion_are_followed_through_each_other() {
    let cube = cuboid(DVec3::ONE);
    check([&cube, &cube], &along_x(vec![-3.0, 6.0]), [1.0 / 6.0, 5.0 / 6.0]);
    // x = −3 + 4t + 2t² is −2 and 2 at (√6 − 2)/2 and (√14 − 2)/2.
    let ends = [6.0, 14.0].map(|x: f64| (x.sqrt() - 2.0) / 2.0);
    check([&cube, &cube], &along_x(vec![-3.0, 4.0, 2.0]), ends);
    // A long box that comes out on the other side.
    check([&cube, &cuboid(DVec3::new(0.25, 1.0, 1.0))], &along_x(vec![-3.0, 6.0]), [1.75 / 6.0, 4.25 / 6.0]);
}

/// Surfaces have no inside: a small closed surface within a large one is clear of it, whichever of them may be filled.
#[test]
fn surfaces_inside_of_each_other_are_clear() {
    let (large, small) = (cuboid(DVec3::ONE), cuboid(DVec3::splat(0.25)));
    let (rest, motion) = (ConstantTwist::REST, along_x(vec![-3.0, 6.0]));
    let ends = [0.0, 1.75, 2.25, 3.75, 4.25, 6.0].map(|x: f64| x / 6.0);
    use SpanStatus::{Clear, Contact};
    for solids in [[Solid::Surface; 2], [Solid::Surface, Solid::Filled], [Solid::Filled, Solid::Surface]] {
        let a = Moving::new(&large, &rest).with_solid(solids[0]);
        let b = Moving::new(&small, &motion).with_solid(solids[1]);
        for [a, b] in [[a, b], [b, a]] {
            let spans = contact_spans(a, b, Window::UNIT, &QueryOptions::default(), None).unwrap();
            let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
            // What a filled body holds of a surface is in contact with it; a surface holds nothing.
            let holds = solids[0] == Solid::Filled;
            let (expected, times) = if holds {
                (vec![Clear, Contact, Clear], vec![ends[0], ends[1], ends[4]])
            } else {
                (vec![Clear, Contact, Clear, Contact, Clear], ends[..5].to_vec())
            };
            assert_eq!(statuses, expected, "{solids:?} {spans:?}");
            for (span, from) in spans.iter().zip(times) {
                assert!((span.from - from).abs() <= 2.0 * RESOLUTION, "{solids:?} {spans:?}");
            }
        }
    }
}

/// Wavy rings pass through each other, turned and not: the bodies at rest at many times say the same.
#[test]
fn rings_that_pass_through_each_other_are_followed() {
    let ring = |rings: u32| MeshTree::new(Surface::wavy_torus(rings, 8, 0.3).into_mesh(TriMesh::try_new));
    let (a, b) = (ring(24), ring(17));
    let rest = ConstantTwist::REST;
    for (number, powers) in
        [vec![-4.0, 8.0], vec![-4.0, 2.0, 6.0], vec![0.3, 0.5, -1.0]].into_iter().enumerate()
    {
        let motion = along_x(powers);
        let spans = contact_spans(
            Moving::new(&a, &rest),
            Moving::new(&b, &motion),
            Window::UNIT,
            &QueryOptions::default(),
            None,
        )
        .unwrap();
        for span in &spans {
            assert!(span.status != SpanStatus::Undecided || span.to - span.from < 1e-3, "{number}: {span:?}");
            for part in 0..=100 {
                let time = span.from + (span.to - span.from) * f64::from(part) / 100.0;
                let posed = Posed::new(&b, motion.pose_and_twist(time).0);
                let meets = collide(Posed::at_rest(&a), posed, Solid::Filled).unwrap();
                let is_end = time - span.from < RESOLUTION || span.to - time < RESOLUTION;
                let expected = span.status == SpanStatus::Contact;
                assert!(
                    is_end || span.status == SpanStatus::Undecided || meets == expected,
                    "{number}: {span:?} {time}"
                );
            }
        }
        let contact: f64 = spans
            .iter()
            .filter(|span| span.status == SpanStatus::Contact)
            .map(|span| span.to - span.from)
            .sum();
        assert!(contact > 0.1, "{number}: {spans:?}");
    }
}

/// Triangles that leave a filled box, both turning. From where they are proven apart a search stops at once for as long as they are within some
/// tolerances of each other: it took 10⁵ searches, each from 10⁻¹⁵ of the window after the one before.
#[test]
fn a_sheet_that_leaves_a_solid_takes_few_searches() {
    let corners = [DVec3::new(-0.5, -0.5, 0.0), DVec3::new(0.5, -0.5, 0.0), DVec3::new(0.0, 0.5, 0.0)];
    let sheet = MeshTree::new(Surface::soup(corners).into_mesh(TriMesh::try_new));
    let solid = cuboid(DVec3::splat(0.5));
    let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(400_000));
    let mut leave = 0;
    for seed in 0..12 {
        let mut random = KnuthRandom(seed);
        let [leaving, turning] = [(); 2].map(|()| {
            let (place, turn) = (random.vector() * 0.6, random.moderate_turn().normalize());
            ConstantTwist::try_new(place, turn, random.vector(), random.vector() * 2.0).unwrap()
        });
        let a = Moving::new(&sheet, &leaving).with_solid(Solid::Surface);
        let b = Moving::new(&solid, &turning).with_solid(Solid::Filled);
        for [a, b] in [[a, b], [b, a]] {
            let spans = contact_spans(a, b, Window::UNIT, &options, None).unwrap();
            assert_ne!(spans.last().unwrap().status, SpanStatus::Undecided, "{seed}: {spans:?}");
            let statuses: Vec<_> = spans.iter().map(|span| span.status).collect();
            let leaves = |pair: &[SpanStatus]| pair == [SpanStatus::Contact, SpanStatus::Clear];
            leave += usize::from(statuses.windows(2).any(leaves));
        }
    }
    assert!(leave >= 8, "{leave}");
}

/// A resolution that is finer than numbers for time: a body that is deep inside of the other one for a few of them is followed from each to the next.
#[test]
fn solids_are_followed_where_time_is_coarser_than_the_resolution() {
    let (large, small) = (cuboid(DVec3::ONE), cuboid(DVec3::splat(0.125)));
    let begin = 2f64.powi(30);
    let unit = begin.next_up() - begin;
    for numbers in [2.0, 5.0, 12.0] {
        let (end, speed) = (begin + 64.0 * unit, 2.0 / numbers);
        let value =
            JointValue::try_pieces(vec![begin, end], vec![vec![-20.0 * speed, speed / unit]]).unwrap();
        let kind = JointKind::Prismatic { axis: DVec3::X, value };
        let motion =
            Chain::try_new(vec![Joint::try_new(DVec3::ZERO, DQuat::IDENTITY, kind).unwrap()]).unwrap();
        let bodies = [Moving::new(&large, &ConstantTwist::REST), Moving::new(&small, &motion)];
        for [a, b] in [bodies, [bodies[1], bodies[0]]] {
            let window = Window::try_new(begin, end).unwrap();
            let spans = contact_spans(a, b, window, &QueryOptions::default(), None).unwrap();
            let near = |time: f64| ((time - begin) / unit - 20.0).abs() * speed <= 1.125 + speed;
            let contacts = spans.iter().filter(|span| span.status == SpanStatus::Contact);
            let [first, last] = [&spans[0], &spans[spans.len() - 1]];
            assert_eq!([first.status, last.status], [SpanStatus::Clear; 2], "{numbers}: {spans:?}");
            assert!(contacts.clone().count() > 0, "{numbers}: {spans:?}");
            assert!(contacts.clone().all(|span| near(span.from) && near(span.to)), "{numbers}: {spans:?}");
        }
    }
}
