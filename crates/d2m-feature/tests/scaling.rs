//! Metamorphic twins: lengths and times multiplied by powers of two change no verdict and no relative time.

use d2m_feature::{ContactBracket, ContactOptions, FirstContact, PairMotion, StraightPaths};
use d2m_motion::ConstantTwist;
use d2m_testing::planted::families::{FAMILIES, Kind, Planted, plant};
use d2m_testing::planted::twins::{SCALES, power, scaled, scaled_point, scaled_query};
use d2m_testing::{Opaque, OpaqueWithState, Random};
use glam::DVec3;

fn rigid(query: &Planted) -> FirstContact {
    let pair = PairMotion::new(&query.motion_a, &query.motion_b, query.window.0, query.window.1);
    let options = ContactOptions::new();
    match query.kind {
        Kind::PointTriangle => pair.point_triangle(query.a[0], &query.b, &options),
        Kind::EdgeEdge => pair.edge_edge(query.a, [query.b[0], query.b[1]], &options),
    }
}

/// The answer in the units of the twin.
fn back(answer: FirstContact, length: i32, time: i32) -> FirstContact {
    let (t, d) = (|x: f64| scaled(x, -time).unwrap(), |x: f64| scaled(x, -length).unwrap());
    match answer {
        FirstContact::Clear => FirstContact::Clear,
        FirstContact::Undecided { clear_until } => FirstContact::Undecided { clear_until: t(clear_until) },
        FirstContact::Contact(c) => FirstContact::Contact(ContactBracket {
            lo: t(c.lo),
            hi: t(c.hi),
            distance: d(c.distance),
            tolerance: d(c.tolerance),
            ..c
        }),
    }
}

#[test]
fn exact_scalings_change_no_verdict_and_no_relative_time() {
    let mut random = Random::new(5);
    let (mut same, mut hits) = (0, 0);
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for family in FAMILIES {
            for _ in 0..12 {
                let query = plant(kind, family, &mut random);
                let answer = rigid(&query);
                hits += usize::from(matches!(answer, FirstContact::Contact(_)));
                for (length, time) in SCALES {
                    let Some(twin) = scaled_query(&query, length, time) else { continue };
                    let other = back(rigid(&twin), length, time);
                    assert_eq!(other, answer, "2^{length} 2^{time} {query:?}");
                    same += 1;
                }
            }
        }
    }
    assert!(same > 240 * (SCALES.len() - 2) && hits > 100, "{same} twins, {hits} hits");
}

fn enclosed(query: &Planted, opaque: bool) -> FirstContact {
    let (a, b) = (Opaque(query.motion_a), Opaque(query.motion_b));
    let (state_a, state_b) = (OpaqueWithState(query.motion_a), OpaqueWithState(query.motion_b));
    let (t0, t1) = query.window;
    let pair =
        if opaque { PairMotion::new(&a, &b, t0, t1) } else { PairMotion::new(&state_a, &state_b, t0, t1) };
    let options = ContactOptions::new();
    match query.kind {
        Kind::PointTriangle => pair.point_triangle(query.a[0], &query.b, &options),
        Kind::EdgeEdge => pair.edge_edge(query.a, [query.b[0], query.b[1]], &options),
    }
}

/// Motions that do not say that their twists are constant are evaluated in the units of the input, where enclosures have an absolute
/// width of 2⁻⁵⁰⁰: up to lengths and times of 2±³⁰⁰ the same bits through states in plain floating point, the same verdict through
/// intervals.
#[test]
fn exact_scalings_of_enclosed_motions() {
    let mut random = Random::new(7);
    let mut hits = 0;
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for family in FAMILIES {
            for _ in 0..4 {
                let query = plant(kind, family, &mut random);
                let answers = [enclosed(&query, false), enclosed(&query, true)];
                hits += usize::from(matches!(answers[0], FirstContact::Contact(_)));
                for (length, time) in SCALES {
                    let Some(twin) = scaled_query(&query, length, time) else { continue };
                    if length.abs() + time.abs() > 300 {
                        continue;
                    }
                    let other = back(enclosed(&twin, false), length, time);
                    assert_eq!(other, answers[0], "2^{length} 2^{time} {query:?}");
                    match (back(enclosed(&twin, true), length, time), answers[1]) {
                        (FirstContact::Contact(c), FirstContact::Contact(d)) => {
                            assert!((c.lo - d.lo).abs() < 1e-9, "2^{length} 2^{time} {query:?}");
                        }
                        (other, answer) => assert_eq!(other, answer, "2^{length} 2^{time} {query:?}"),
                    }
                }
            }
        }
    }
    assert!(hits > 30, "{hits}");
}

#[test]
fn exact_scalings_of_straight_paths_change_nothing() {
    let mut random = Random::new(6);
    let (mut same, mut hits) = (0, 0);
    let ask = |kind: Kind, start: [DVec3; 4], end: [DVec3; 4]| {
        let paths = StraightPaths::new(start, end);
        match kind {
            Kind::PointTriangle => paths.point_triangle(&ContactOptions::new()),
            Kind::EdgeEdge => paths.edge_edge(&ContactOptions::new()),
        }
    };
    for kind in [Kind::PointTriangle, Kind::EdgeEdge] {
        for family in FAMILIES {
            for _ in 0..12 {
                let query = plant(kind, family, &mut random);
                let (start, end) = query.straight();
                let answer = ask(kind, start, end);
                hits += usize::from(matches!(answer, FirstContact::Contact(_)));
                for length in [1, -1, 127, 128, 131, -180, -250, 300, 340, -340, 600, -600, 900, -900] {
                    let twin = |p: [DVec3; 4]| p.map(|p| scaled_point(p, length).unwrap());
                    let other = back(ask(kind, twin(start), twin(end)), length, 0);
                    assert_eq!(other, answer, "2^{length} {query:?}");
                    same += 1;
                }
            }
        }
    }
    assert!(same == 240 * 14 && hits > 100, "{same} twins, {hits} hits");
}

/// Features that are many powers of two larger or smaller than the motion: never clear when they meet.
#[test]
fn features_and_motions_of_different_sizes() {
    let options = ContactOptions::new();
    let falling = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(-2.0 * DVec3::Z);
    let floor = [DVec3::new(-1.0, -1.0, 0.0), DVec3::new(1.0, -1.0, 0.0), DVec3::new(0.0, 1.0, 0.0)];
    let edges = [[-DVec3::X, DVec3::X], [-DVec3::Y, DVec3::Y]];
    for spin in [0.0, 1.0, 1e3] {
        let falling = falling.with_angular_velocity(spin * DVec3::Z);
        let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
        for k in (-1000..=1000).step_by(50) {
            let s = power(k);
            let answers = [
                pair.point_triangle(DVec3::ZERO, &floor.map(|p| p * s), &options),
                pair.triangle_point(&floor.map(|p| p * s), DVec3::ZERO, &options),
                pair.edge_edge(edges[0].map(|p| p * s), edges[1].map(|p| p * s), &options),
                pair.sphere_sphere((DVec3::ZERO, 0.25 * s), (DVec3::ZERO, 0.25 * s), &options),
            ];
            for (i, answer) in answers.into_iter().enumerate() {
                match answer {
                    FirstContact::Clear => panic!("2^{k} spin {spin} form {i}: clear"),
                    // Spheres larger than the distance overlap at the start.
                    FirstContact::Contact(c) => assert!(c.lo <= 0.5, "2^{k} spin {spin} form {i}: {c:?}"),
                    FirstContact::Undecided { clear_until } => {
                        assert!(k.abs() > 20 && clear_until <= 0.5, "2^{k} spin {spin} form {i}: {answer:?}");
                    }
                }
            }
            // Beside each other by two units: clear as long as the features are smaller; a floor that is larger is hit.
            let beside = falling.with_position(DVec3::new(2.0, 0.0, 1.0));
            let aside = PairMotion::new(&beside, &ConstantTwist::REST, 0.0, 1.0);
            let answer = aside.point_triangle(DVec3::ZERO, &floor.map(|p| p * s), &options);
            if k <= -50 {
                assert_eq!(answer, FirstContact::Clear, "2^{k} spin {spin}");
            }
            if k >= 50 {
                assert_ne!(answer, FirstContact::Clear, "2^{k} spin {spin}");
            }
        }
    }
}
