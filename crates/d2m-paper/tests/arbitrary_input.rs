//! Arbitrary floats in meshes, motions, windows and options: every query answers or refuses, in bounded work, and the
//! answer keeps its form. `PROPTEST_CASES=100000` makes a long run of it.
//! Nothing here judges geometry; `cross_check.rs` and `paper.rs` do.

use d2m_bvh::{
    Budget, MeshTree, Mode, Moving, QueryOptions, Solid, TimeOfContact, TriMesh, Window, time_of_contact,
};
use d2m_motion::ConstantTwist;
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use std::time::Duration;

/// Numbers of every kind: everyday ones, any bit pattern, and those that break formulas.
fn number() -> impl Strategy<Value = f64> {
    let awkward = prop::sample::select(vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        1e-10,
        1e6,
        -1e6,
        1e15,
        1e60,
        -1e60,
        1e100,
        1e154,
        1e300,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        f64::EPSILON,
        1e-60,
        1e-160,
        1e-300,
    ]);
    prop_oneof![6 => -4.0..4.0, 2 => awkward, 1 => any::<u64>().prop_map(f64::from_bits)]
}

/// Mostly everyday numbers, so that the queries get past the checks.
fn tame() -> impl Strategy<Value = f64> {
    prop_oneof![20 => -4.0..4.0, 1 => number()]
}

fn vector(of: impl Strategy<Value = f64> + Clone) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(of).prop_map(DVec3::from_array)
}

fn mesh<S: Strategy<Value = f64> + Clone + 'static>(of: S) -> impl Strategy<Value = Option<TriMesh>> {
    (prop::collection::vec(vector(of), 1..7), prop::collection::vec(prop::array::uniform3(0u32..7), 1..9))
        .prop_map(|(vertices, triangles)| {
            let count = vertices.len() as u32;
            TriMesh::try_new(vertices, triangles.into_iter().map(|t| t.map(|i| i % count)).collect()).ok()
        })
}

fn motion<S: Strategy<Value = f64> + Clone + 'static>(of: S) -> impl Strategy<Value = Option<ConstantTwist>> {
    let v = || vector(of.clone());
    (v(), prop::array::uniform4(of.clone()), v(), v(), of.clone(), v()).prop_map(
        |(x, q, linear, angular, t, at)| {
            let q = DQuat::from_xyzw(q[0], q[1], q[2], q[3]);
            let motion = ConstantTwist::try_new(x, q, linear, angular).ok()?;
            motion.try_with_reference_time(t).ok()?.try_with_at(at).ok()
        },
    )
}

fn options<S: Strategy<Value = f64> + Clone>(of: S) -> impl Strategy<Value = QueryOptions> {
    (of.clone(), of, prop::bool::ANY, 0usize..3, 0u64..3000).prop_map(
        |(tolerance, separation, filled, mode, tests)| {
            let options = QueryOptions::default()
                .with_solid(if filled { Solid::Filled } else { Solid::Surface })
                .with_mode([Mode::Accurate, Mode::Capoeira, Mode::Exists][mode])
                .with_budget(
                    Budget::UNLIMITED.with_node_tests(tests).with_wall_clock(Duration::from_millis(50)),
                );
            let options = if tests % 2 == 0 { options.with_tolerance(tolerance) } else { options };
            if tests % 3 == 0 { options.with_min_separation(separation) } else { options }
        },
    )
}

/// One whole question: bodies, motions, ends of the window, options.
type Question = ([Option<TriMesh>; 2], [Option<ConstantTwist>; 2], [f64; 2], QueryOptions);

fn question<S: Strategy<Value = f64> + Clone + 'static>(of: S) -> impl Strategy<Value = Question> {
    let window = (of.clone(), of.clone()).prop_map(|(a, b)| [a, b]);
    let meshes = (mesh(of.clone()), mesh(of.clone())).prop_map(|(a, b)| [a, b]);
    let motions = (motion(of.clone()), motion(of.clone())).prop_map(|(a, b)| [a, b]);
    (meshes, motions, window, options(of))
}

fn keeps_its_form(answer: &TimeOfContact, window: Window) {
    match answer {
        TimeOfContact::Separated => {}
        TimeOfContact::Undecided { clear_until } => assert!(window.contains(*clear_until), "{clear_until}"),
        TimeOfContact::Contact(contact) => {
            assert!(window.contains(contact.time_lo), "{contact:?}");
            assert!(contact.time_hi >= contact.time_lo, "{contact:?}");
            assert!(contact.separation >= 0.0, "{contact:?}");
            assert!((contact.normal.length() - 1.0).abs() < 1e-9, "{contact:?}");
            assert!(contact.point_a.is_finite() && contact.point_b.is_finite(), "{contact:?}");
            for weights in [contact.barycentric_a, contact.barycentric_b] {
                assert!(weights.iter().all(|w| *w >= 0.0), "{contact:?}");
                assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{contact:?}");
            }
        }
    }
}

fn ask((meshes, motions, [start, end], options): Question) {
    let [Some(mesh_a), Some(mesh_b)] = meshes else { return };
    let [Some(motion_a), Some(motion_b)] = motions else { return };
    let Ok(window) = Window::try_new(start.min(end), start.max(end)) else { return };
    let trees = [MeshTree::new(mesh_a.clone()), MeshTree::new(mesh_b.clone())];
    let (a, b) = (Moving::new(&trees[0], &motion_a), Moving::new(&trees[1], &motion_b));
    if let Ok(answer) = time_of_contact(a, b, window, &options) {
        keeps_its_form(&answer, window);
        let again =
            time_of_contact(a, b, window, &options.with_budget(Budget::UNLIMITED.with_node_tests(300)));
        let once_more =
            time_of_contact(a, b, window, &options.with_budget(Budget::UNLIMITED.with_node_tests(300)));
        assert_eq!(format!("{again:?}"), format!("{once_more:?}"));
    }
    let trees = [d2m_paper::SphereTree::new(mesh_a), d2m_paper::SphereTree::new(mesh_b)];
    let (a, b) = (Moving::new(&trees[0], &motion_a), Moving::new(&trees[1], &motion_b));
    if let Ok(answer) = d2m_paper::time_of_contact(a, b, window, &options) {
        keeps_its_form(&answer, window);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 400, ..ProptestConfig::default() })]

    #[test]
    fn everyday_numbers_with_a_few_odd_ones(question in question(tame().boxed())) {
        ask(question);
    }

    #[test]
    fn odd_numbers_everywhere(question in question(number().boxed())) {
        ask(question);
    }
}
