//! Degenerate features and odd input: no panic, no false "clear".
use d2m_feature::{ContactOptions, FirstContact, PairMotion, StraightPaths};
use d2m_motion::ConstantTwist;
use d2m_testing::OpaqueWithState;
use glam::{DQuat, DVec3};

const fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn falling() -> ConstantTwist {
    ConstantTwist::REST.with_position(v(0.0, 0.0, 1.0)).with_linear_velocity(v(0.0, 0.0, -2.0))
}

/// Contact at 0.5, whatever the point meets at the origin.
fn assert_lands(answer: FirstContact, what: &str) {
    match answer {
        FirstContact::Contact(c) => {
            assert!(c.lo <= 0.5 && c.lo > 0.5 - 1e-8 && c.hi >= c.lo, "{what}: {c:?}");
        }
        other => panic!("{what}: {other:?}"),
    }
}

#[test]
fn degenerate_triangles_are_points_and_segments() {
    let options = ContactOptions::new().with_tolerance(1e-10);
    let spin = falling().with_angular_velocity(v(0.3, -0.4, 2.0));
    for motion in [falling(), spin] {
        let still = ConstantTwist::REST;
        let pair = PairMotion::new(&motion, &still, 0.0, 1.0);
        let hidden = OpaqueWithState(motion);
        let enclosed = PairMotion::new(&hidden, &still, 0.0, 1.0);
        for triangle in [
            [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 2.0, 0.0)],
            [DVec3::ZERO; 3],
            [v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(1.0, 0.0, 0.0)],
            [v(-1.0, 0.0, 0.0), v(0.5, 0.0, 0.0), v(1.0, 0.0, 0.0)],
            [v(-1.0, 0.0, 0.0), v(1.0, 1e-17, 0.0), v(0.0, 1e-30, 0.0)],
            [v(0.0, 0.0, 0.0), v(1e6, 1.0, 0.0), v(-1e6, 1.0, 0.0)],
        ] {
            assert_lands(pair.point_triangle(DVec3::ZERO, &triangle, &options), &format!("{triangle:?}"));
            assert_lands(enclosed.point_triangle(DVec3::ZERO, &triangle, &options), &format!("{triangle:?}"));
            let start = [v(0.0, 0.0, 1.0), triangle[0], triangle[1], triangle[2]];
            let end = [v(0.0, 0.0, -1.0), triangle[0], triangle[1], triangle[2]];
            let straight = StraightPaths::new(start, end).point_triangle(&options);
            assert_lands(straight, &format!("straight {triangle:?}"));
        }
    }
}

#[test]
fn degenerate_edges_are_points_and_parallels() {
    let options = ContactOptions::new().with_tolerance(1e-10);
    let falling = falling();
    let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
    let (x, y) = ([v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0)], [v(0.0, -1.0, 0.0), v(0.0, 1.0, 0.0)]);
    let point = [DVec3::ZERO; 2];
    let shifted = [v(0.5, 0.0, 0.0), v(3.0, 0.0, 0.0)];
    let tilted = [v(-1.0, 0.0, 0.0), v(1.0, 1e-13, 0.0)];
    for (a, b) in
        [(x, y), (x, x), (x, point), (point, x), (point, point), (x, shifted), (x, tilted), (tilted, y)]
    {
        assert_lands(pair.edge_edge(a, b, &options), &format!("{a:?} {b:?}"));
        let up = |p: DVec3, z: f64| p + v(0.0, 0.0, z);
        let paths = StraightPaths::new(
            [up(a[0], 1.0), up(a[1], 1.0), b[0], b[1]],
            [up(a[0], -1.0), up(a[1], -1.0), b[0], b[1]],
        );
        assert_lands(paths.edge_edge(&options), &format!("straight {a:?} {b:?}"));
    }
}

#[test]
fn separations_and_spheres() {
    let falling = falling();
    let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
    let floor = [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 2.0, 0.0)];
    let apart = ContactOptions::new().with_tolerance(1e-10).with_min_separation(0.5);
    let FirstContact::Contact(c) = pair.point_triangle(DVec3::ZERO, &floor, &apart) else { panic!() };
    assert!((c.lo - 0.25).abs() < 1e-9 && c.lo <= 0.25);
    let edges = ([v(-1.0, 0.0, 0.0), v(1.0, 0.0, 0.0)], [v(0.0, -1.0, 0.0), v(0.0, 1.0, 0.0)]);
    let FirstContact::Contact(c) = pair.edge_edge(edges.0, edges.1, &apart) else { panic!() };
    assert!((c.lo - 0.25).abs() < 1e-9 && c.lo <= 0.25);
    let options = ContactOptions::new();
    let FirstContact::Contact(c) = pair.sphere_sphere((DVec3::ZERO, 0.25), (DVec3::ZERO, 0.25), &options)
    else {
        panic!()
    };
    assert!((c.lo - 0.25).abs() < 1e-9 && c.lo <= 0.25 && c.hi - c.lo < 1e-9, "{c:?}");
    assert_eq!(pair.sphere_sphere((DVec3::X, 0.1), (-DVec3::X, 0.1), &options), FirstContact::Clear);
}

#[test]
fn details_describe_the_contact() {
    let falling = falling();
    let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.0, 1.0);
    let floor = [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 2.0, 0.0)];
    let options = ContactOptions::new();
    let FirstContact::Contact(c) = pair.point_triangle(DVec3::ZERO, &floor, &options) else { panic!() };
    let at = pair.point_triangle_details(DVec3::ZERO, &floor, c.lo);
    assert_eq!(at.normal, -DVec3::Z);
    assert!((at.closing_speed - 2.0).abs() < 1e-12);
    assert!((at.barycentric_b.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    assert!((at.barycentric_b[2] - 1.0 / 3.0).abs() < 1e-12, "{at:?}");
    assert!(at.point_a.distance(at.point_b) < 1e-9);
    // The same the other way round.
    let turned = PairMotion::new(&ConstantTwist::REST, &falling, 0.0, 1.0);
    let FirstContact::Contact(d) = turned.triangle_point(&floor, DVec3::ZERO, &options) else { panic!() };
    assert!((c.lo - d.lo).abs() < 1e-12);
    let back = turned.triangle_point_details(&floor, DVec3::ZERO, d.lo);
    assert_eq!(back.normal, DVec3::Z);
    assert!((back.closing_speed - 2.0).abs() < 1e-12);
    let edges = ([v(-1.0, 0.0, 0.0), v(3.0, 0.0, 0.0)], [v(0.0, -1.0, 0.0), v(0.0, 1.0, 0.0)]);
    let at = pair.edge_edge_details(edges.0, edges.1, 0.5);
    assert!((at.normal.z + 1.0).abs() < 1e-12 && (at.barycentric_a[1] - 0.25).abs() < 1e-12, "{at:?}");
}

#[test]
fn nothing_is_called_clear_when_the_numbers_run_out() {
    let options = ContactOptions::new().with_max_evaluations(2000);
    let floor = [v(-1.0, -1.0, 0.0), v(1.0, -1.0, 0.0), v(0.0, 2.0, 0.0)];
    // More turns than the rounding is counted for; magnitudes that overflow.
    let spinning = falling().with_angular_velocity(v(0.0, 0.0, 1e7));
    let huge = falling().with_linear_velocity(v(0.0, 0.0, -1e300)).with_position(v(0.0, 0.0, 1e300));
    let vast = falling().with_angular_velocity(v(1e200, 0.0, 0.0));
    for motion in [spinning, huge, vast] {
        let pair = PairMotion::new(&motion, &ConstantTwist::REST, 0.0, 1.0);
        assert_ne!(pair.point_triangle(DVec3::ZERO, &floor, &options), FirstContact::Clear, "{motion:?}");
        let edge = [v(-1.0, 0.0, 0.0), v(1.0, 0.5, 0.0)];
        assert_ne!(pair.edge_edge(edge, [edge[0], floor[2]], &options), FirstContact::Clear, "{motion:?}");
    }
    // Very small and very large scenes.
    for scale in [1e-30, 1e-9, 1e9, 1e30] {
        let motion = ConstantTwist::REST
            .with_position(v(0.0, 0.0, scale))
            .with_linear_velocity(v(0.0, 0.0, -2.0 * scale))
            .with_orientation(DQuat::from_xyzw(0.0, 0.0, 1e-3, 2.0));
        let pair = PairMotion::new(&motion, &ConstantTwist::REST, 0.0, 1.0);
        let triangle = floor.map(|p| p * scale);
        assert_lands(
            pair.point_triangle(DVec3::ZERO, &triangle, &ContactOptions::new()),
            &format!("{scale}"),
        );
    }
    // A window of no length.
    let falling = falling();
    let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.5, 0.5);
    assert!(
        matches!(pair.point_triangle(DVec3::ZERO, &floor, &options), FirstContact::Contact(c) if c.lo == 0.5)
    );
    let pair = PairMotion::new(&falling, &ConstantTwist::REST, 0.25, 0.25);
    assert_eq!(pair.point_triangle(DVec3::ZERO, &floor, &options), FirstContact::Clear);
}

#[test]
fn a_million_radians_a_window_are_decided_where_the_bodies_are_near_for_few() {
    // Spinning on its way down; near the floor for a few thousandths of the window.
    let falling = ConstantTwist::REST.with_position(v(0.0, 0.0, 5e3)).with_linear_velocity(v(0.0, 0.0, -1e4));
    let spinning = falling.with_angular_velocity(v(0.0, 0.0, 1e6));
    let pair = PairMotion::new(&spinning, &ConstantTwist::REST, 0.0, 1.0);
    let floor = [v(-4.0, -4.0, 0.0), v(6.0, -4.0, 0.0), v(0.0, 8.0, 0.0)];
    let options = ContactOptions::new();
    let answer = pair.point_triangle(v(0.5, 0.0, 0.0), &floor, &options);
    assert_lands(answer, "spinning");
    let (a, b) = ([v(0.5, 0.0, 0.0), v(-0.5, 0.0, 0.0)], [v(0.0, 0.0, 0.0), v(0.0, 5.0, 0.0)]);
    assert_lands(pair.edge_edge(a, b, &options), "edges");
    // What never comes near needs no evaluation; what cannot be evaluated is never called clear.
    let aside = floor.map(|p| p + 100.0 * DVec3::X);
    assert_eq!(pair.point_triangle(v(0.5, 0.0, 0.0), &aside, &options), FirstContact::Clear);
    let mad = falling.with_angular_velocity(v(0.0, 0.0, 1e12));
    let mad = PairMotion::new(&mad, &ConstantTwist::REST, 0.0, 1.0);
    let few = options.with_max_evaluations(1000);
    let answer = mad.point_triangle(v(0.5, 0.0, 0.0), &floor, &few);
    let FirstContact::Undecided { clear_until } = answer else { panic!("{answer:?}") };
    assert!((0.0..=0.5).contains(&clear_until));
}
