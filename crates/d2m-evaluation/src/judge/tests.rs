use super::answer::Fault;
use super::triangle::{distance, segment_segment};
use super::*;
use crate::trials::{Movement, Trial};
use d2m_testing::{Surface, Xoshiro256 as Random};
use glam::{DQuat, DVec3};

fn cube() -> BoxTree {
    let Surface { vertices, triangles, .. } = Surface::cube(0.5);
    BoxTree::build(&vertices, &triangles)
}

fn movement(position: DVec3, velocity: DVec3) -> Movement {
    Movement { rotation: DQuat::IDENTITY, position, velocity, angular_velocity: DVec3::ZERO }
}

#[test]
fn distance_of_known_triangles() {
    let flat = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let lifted = |h: f64, by: DVec3| flat.map(|p| p + DVec3::Z * h + by);
    assert_eq!(distance(&flat, &lifted(0.25, DVec3::ZERO)), 0.25);
    assert_eq!(distance(&flat, &lifted(0.0, DVec3::X * 3.0)), 2.0);
    // Vertex over face, edge over edge, crossing, and a needle collapsed to a point.
    let spike = [DVec3::new(0.2, 0.2, 0.5), DVec3::new(0.0, 0.0, 2.0), DVec3::new(1.0, 0.0, 2.0)];
    assert!((distance(&flat, &spike) - 0.5).abs() < 1e-15);
    let bridge = [DVec3::new(0.5, -1.0, 0.125), DVec3::new(0.5, 1.0, 0.125), DVec3::new(0.5, 0.0, 3.0)];
    assert!((distance(&flat, &bridge) - 0.125).abs() < 1e-15);
    let through = [DVec3::new(0.2, 0.2, -1.0), DVec3::new(0.2, 0.2, 1.0), DVec3::new(5.0, 5.0, 0.0)];
    assert_eq!(distance(&flat, &through), 0.0);
    assert!((distance(&flat, &[DVec3::new(0.1, 0.1, 0.7); 3]) - 0.7).abs() < 1e-15);
}

/// Segments that cross at an angle of 1e-12 … 1e-3, a known height apart, in any position.
#[test]
fn distance_of_segments_that_are_nearly_parallel() {
    let mut random = Random::new(12);
    for round in 0..2000 {
        let (angle, height) = (10f64.powf(random.range(-12.0, -3.0)), 10f64.powf(random.range(-10.0, -6.0)));
        let (place, turn) = (DVec3::X * random.range(-0.7, 0.7), random.rotation());
        let along = DVec3::new(1.0, angle, 0.0);
        let lower = [-DVec3::X, DVec3::X].map(|p| turn * p);
        let upper = [-along, along].map(|p| turn * (p + place + DVec3::Z * height));
        let found = segment_segment(lower, upper);
        assert!((found - height).abs() < 1e-14, "{round}: {found:e} for {height:e} at {angle:e}");
    }
}

#[test]
fn the_tree_finds_what_all_pairs_give() {
    let mut random = Random::new(11);
    let soup =
        |random: &mut Random| Surface::soup((0..60).map(|_| random.direction() * random.range(0.2, 1.0)));
    for _ in 0..200 {
        let (a, b) = (soup(&mut random), soup(&mut random));
        let at = Placement::new(random.rotation(), random.direction());
        let beside =
            Placement::new(random.rotation(), at.position + random.direction() * random.range(0.5, 3.0));
        let corners = |mesh: &Surface, at: &Placement| -> Vec<[DVec3; 3]> {
            mesh.triangles.iter().map(|t| t.map(|i| at.apply(mesh.vertices[i as usize]))).collect()
        };
        let (ca, cb) = (corners(&a, &at), corners(&b, &beside));
        let least = ca.iter().flat_map(|s| cb.iter().map(|t| distance(s, t))).fold(f64::INFINITY, f64::min);
        let (ta, tb) = (BoxTree::build(&a.vertices, &a.triangles), BoxTree::build(&b.vertices, &b.triangles));
        let found = separation(&ta, &tb, &at, &beside, &mut Hint::default());
        assert!((found - least).abs() < 1e-13, "{found} {least}");
        let bound = bound_separation(&ta, &tb, &at, &beside, &mut Hint::default());
        assert!(bound <= least + 1e-13 && bound >= 0.5 * least - 1e-13, "{bound} {least}");
    }
}

#[test]
fn faults_are_found() {
    let cube = cube();
    // Faces at distance 2, closing at 4: contact at 1/2 exactly; turned by 45° about z so that an edge leads.
    let trial = Trial {
        a: movement(DVec3::ZERO, DVec3::ZERO),
        b: movement(DVec3::new(3.0, 0.1, 0.2), DVec3::X * -4.0),
    };
    let judge = Judge { a: &cube, b: &cube, trial: &trial };
    let claim = |lo: f64| Claim::Contact { lo, hi: 0.5, tolerance: 1e-10 };
    let left = judge.check(&claim(0.5 - 0.5e-10), true).unwrap();
    assert!((left - 2e-10).abs() < 1e-14);
    assert!(matches!(
        judge.check(&Claim::Contact { lo: 0.5 + 1e-6, hi: 0.6, tolerance: 1e-10 }, true),
        Err(Fault::Missed { .. } | Fault::Penetrates)
    ));
    assert!(matches!(judge.check(&claim(0.49), true), Err(Fault::Far { .. })));
    assert!(judge.check(&claim(0.49), false).is_ok(), "early is allowed where the mode says so");
    assert!(matches!(judge.check(&Claim::Separated, true), Err(Fault::Missed { .. })));
    assert!(matches!(judge.check(&Claim::Undecided { clear_until: 0.75 }, true), Err(Fault::Missed { .. })));
    assert!(judge.check(&Claim::Undecided { clear_until: 0.25 }, true).is_ok());
    assert_eq!(judge.check(&claim(0.7), true), Err(Fault::Nonsense));
    assert!((judge.advance([0.0, 1.0], 1e-9) - 0.5).abs() < 1e-9);

    // What is known to be free is not searched again; what comes after it is.
    let late = Claim::Contact { lo: 0.5 + 1e-6, hi: 0.6, tolerance: 1e-10 };
    assert!(judge.check_after(claim(0.5 - 0.5e-10).free_until(), &late, true).is_err());
    assert!(judge.check_after(0.5 - 0.5e-10, &claim(0.4), false).is_ok());

    // As precise far from the origin of the world, and at speeds of which a rounding is larger than what is judged.
    let far = DVec3::new(1e6, -1e6, 1e6);
    let exact = |by: DVec3| movement(trial.b.position + by, trial.b.velocity);
    let away = Trial { a: movement(far, DVec3::ZERO), b: exact(far) };
    // What the shift itself rounds away.
    let lost = (away.b.position - away.a.position).x - 3.0;
    let left = Judge { a: &cube, b: &cube, trial: &away }.check(&claim(0.5 - 0.5e-10), true).unwrap();
    assert!((left - 2e-10 - lost).abs() < 1e-14, "{left:e}");
    let fast = Trial {
        a: movement(DVec3::X * -2.5e5, DVec3::X * 5e5),
        b: movement(DVec3::X * 250_001.0, DVec3::X * -5e5),
    };
    let late = Claim::Contact { lo: 0.5 + 1e-15, hi: 0.6, tolerance: 1e-10 };
    let judge_fast = Judge { a: &cube, b: &cube, trial: &fast };
    assert!(judge_fast.check(&late, true).is_err());
    let left = judge_fast.separation(0.5 - 2f64.powi(-52));
    assert!((left - 1e6 * 2f64.powi(-52)).abs() < 1e-15, "{left:e}");

    let passing = Trial { b: movement(DVec3::new(3.0, 1.5, 0.0), DVec3::X * -6.0), ..trial };
    let judge = Judge { a: &cube, b: &cube, trial: &passing };
    assert_eq!(judge.check(&Claim::Separated, true), Ok(f64::INFINITY));
    assert!(matches!(judge.check(&claim(0.5), true), Err(Fault::Far { .. })));
}
