//! Both kinds of lanes give the same bits; and the margin is needed: without it a rejection is refuted.
use super::*;
use d2m_motion::ConstantTwist;
use glam::DQuat;

struct Random(u64);

impl Random {
    fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * (0.5_f64).powi(52) - 1.0
    }
    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.signed(), self.signed(), self.signed())
    }
    fn motion(&mut self) -> ConstantTwist {
        let q = DQuat::from_xyzw(self.signed(), self.signed(), self.signed(), self.signed());
        ConstantTwist::try_new(self.vector(), q, self.vector() * 2.0, self.vector() * 3.0).unwrap()
    }
}

#[test]
fn both_kinds_of_lanes_give_the_same_bits() {
    let mut random = Random(41);
    let mut seen = [0; 2];
    for i in 0..4000 {
        let pair = PairMotion::new(&random.motion(), &random.motion(), 0.0, [0.02, 0.1, 1.0][i % 3]);
        let mut v = || random.vector();
        let points = pair.place_points(&[v(), v(), v(), v()]);
        let triangles = pair.place_triangles(&[[v(), v(), v()], [v(), v(), v()], [v(), v(), v()], [v(); 3]]);
        let a = pair.place_edges_a(&[[v(), v()], [v(), v()], [v(), v()], [v(); 2]]);
        let b = pair.place_edges_b(&[[v(), v()], [v(), v()], [v(), v()], [v(); 2]]);
        let (p, e) = (pair.reject_points(&points, &triangles, 0.0), pair.reject_edges(&a, &b, 0.0));
        assert_eq!(p, pair.reject_points_portable(&points, &triangles));
        assert_eq!(e, pair.reject_edges_portable(&a, &b));
        seen[0] += p.iter().filter(|r| **r).count();
        seen[1] += e.iter().filter(|r| **r).count();
    }
    assert!(seen.iter().all(|n| (1000..15000).contains(n)), "{seen:?}");
}

/// What is asked of a mutant: the same quads with another margin.
fn without_margin(points: &PointQuad, a: &EdgeQuad) -> (PointQuad, EdgeQuad) {
    // Nothing is left of the third-order term, of the rounding and of the turning of the edge.
    let points = PointQuad { margin: [0.0; 4], stray: [1e9; 4], ..points.clone() };
    (points, EdgeQuad { margin: [0.0; 4], stray: [1e9; 4], turn: [0.0; 4], bend: [0.0; 4], ..a.clone() })
}

/// Contacts planted at the start, in the middle and at the end of the window: A is placed so that a point of one
/// feature is on the other at that time. Never rejected; without the margin some are.
#[test]
fn planted_contacts_are_never_rejected_and_the_margin_is_needed() {
    let mut random = Random(42);
    let mut mutants = [0; 4];
    for i in 0..30_000 {
        let end = [0.01, 0.1, 1.0][i % 3];
        let time = [0.0, 0.5 * end, end][i / 3 % 3];
        let (a, b) = (random.motion(), random.motion());
        let triangle = [random.vector(), random.vector(), random.vector()];
        let edge = [random.vector(), random.vector()];
        let (pose_a, pose_b) = {
            use d2m_motion::RigidMotion;
            (a.pose_and_twist(time).0, b.pose_and_twist(time).0)
        };
        let share = || 0.5;
        let (s, t) = ([0.0, 1.0, share()][i / 9 % 3], [0.0, 1.0, share()][i / 27 % 3]);
        let on_edge = edge[0] + (edge[1] - edge[0]) * s;
        let on_triangle = triangle[0] + (triangle[1] - triangle[0]) * t;
        let shift = pose_b.transform_point(on_triangle) - pose_a.transform_point(on_edge);
        // Half a rounding beyond the touch is what poses in doubles leave.
        let a = a.with_position(a.position() + shift);
        let pair = PairMotion::new(&a, &b, 0.0, end);
        let points = pair.place_points(&[on_edge; 4]);
        let triangles = pair.place_triangles(&[triangle; 4]);
        let (mine, other) =
            (pair.place_edges_a(&[edge; 4]), pair.place_edges_b(&[[triangle[0], triangle[1]]; 4]));
        assert_eq!(pair.reject_points(&points, &triangles, 0.0), [false; 4], "{i} {a:?} {b:?}");
        assert_eq!(pair.reject_edges(&mine, &other, 0.0), [false; 4], "{i} {a:?} {b:?}");
        let (bare_points, bare_edges) = without_margin(&points, &mine);
        mutants[0] += usize::from(pair.reject_points(&bare_points, &triangles, 0.0)[0]);
        mutants[1] += usize::from(pair.reject_edges(&bare_edges, &other, 0.0)[0]);
        // Without the stray the first spheres reject.
        let (points, mine) = (PointQuad { stray: [0.0; 4], ..points }, EdgeQuad { stray: [0.0; 4], ..mine });
        mutants[2] += usize::from(pair.reject_points(&points, &triangles, 0.0)[0]);
        mutants[3] += usize::from(pair.reject_edges(&mine, &other, 0.0)[0]);
    }
    assert!(mutants.iter().all(|rejected| *rejected > 10), "{mutants:?}");
}

#[test]
fn numbers_that_ran_out_reject_nothing() {
    let still = ConstantTwist::REST;
    let lost = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 1e9);
    for (pair, size) in
        [(PairMotion::new(&lost, &still, 0.0, 1.0), 1.0), (PairMotion::new(&still, &still, 0.0, 1.0), 1e200)]
    {
        let far = DVec3::splat(3.0 * size);
        let points = pair.place_points(&[far; 4]);
        let triangles = pair.place_triangles(&[[DVec3::X * size, DVec3::Y * size, DVec3::ZERO]; 4]);
        let a = pair.place_edges_a(&[[far, far + DVec3::X * size]; 4]);
        let b = pair.place_edges_b(&[[DVec3::ZERO, DVec3::Y * size]; 4]);
        // Three sizes above the plane: true where the numbers still say so.
        assert!(
            size > 1.0 || !pair.reject_points(&points, &triangles, 0.0)[0],
            "too many turns for any proof"
        );
        assert!(!pair.reject_edges(&a, &b, 0.0)[0]);
        let nan = pair.place_points(&[DVec3::splat(f64::NAN); 4]);
        assert_eq!(pair.reject_points(&nan, &triangles, 0.0), [false; 4]);
    }
}
