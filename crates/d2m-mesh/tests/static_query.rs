//! Static queries against brute force over all pairs of triangles, in rational arithmetic where it decides.

mod exact;

use d2m_feature::triangle_distance;
use d2m_mesh::{
    Budget, DistanceOptions, MeshTree, Posed, QueryError, Solid, StartState, TriMesh, bound_distance,
    collide, collide_within, colliding_pairs, distance, distance_within, try_colliding_pair,
};
use d2m_motion::Pose;
use d2m_testing::{Draw, KnuthRandom, Surface};
use dashu_ratio::RBig;
use glam::{DQuat, DVec3};

/// Corners (±1, ±1, ±1), or as moved by the map.
fn cube(map: impl Fn(DVec3) -> DVec3) -> TriMesh {
    Surface::cube(1.0).map(map).into_mesh(TriMesh::try_new)
}

fn tetrahedron(random: &mut KnuthRandom, map: impl Fn(DVec3) -> DVec3) -> TriMesh {
    Surface::tetrahedron([(); 4].map(|()| map(random.vector()))).into_mesh(TriMesh::try_new)
}

/// Triangles with no connection; some flat, some mere points or repeated.
fn soup(random: &mut KnuthRandom, count: usize, map: impl Fn(DVec3) -> DVec3) -> TriMesh {
    let mut corners = Vec::new();
    for i in 0..count {
        let base = random.vector();
        let (e, f) = (random.vector() * 0.3, random.vector() * 0.3);
        let f = match i % 7 {
            0 => e * 0.5,
            1 => DVec3::ZERO,
            _ => f,
        };
        corners.extend([base, base + e, base + f].map(&map));
    }
    Surface::soup(corners).into_mesh(TriMesh::try_new)
}

/// Least squared distance of the surfaces. Pairs that double precision puts far behind the best one are left out.
fn brute_force(a: Posed<'_>, b: Posed<'_>, size: f64) -> RBig {
    let place = |posed: Posed<'_>| -> Vec<[exact::Vector; 3]> {
        let mesh = posed.body.mesh();
        let one = |i: usize| mesh.corners(i).map(|p| exact::pose_point(&posed.pose, p));
        (0..mesh.triangle_count()).map(one).collect()
    };
    let (ta, tb) = (place(a), place(b));
    let round = |t: &[exact::Vector; 3]| {
        t.each_ref().map(|p| DVec3::from_array(p.each_ref().map(|c| c.to_f64().value())))
    };
    let (fa, fb): (Vec<_>, Vec<_>) = (ta.iter().map(round).collect(), tb.iter().map(round).collect());
    let mut pairs = Vec::new();
    for (i, x) in fa.iter().enumerate() {
        for (j, y) in fb.iter().enumerate() {
            pairs.push((triangle_distance(x, y).upper, i, j));
        }
    }
    let best = pairs.iter().map(|p| p.0).fold(f64::INFINITY, f64::min);
    let near = pairs.into_iter().filter(|p| p.0 <= best + 1e-9 * size);
    let mut least: Option<RBig> = None;
    for (_, i, j) in near.take(12) {
        let found = exact::triangle_triangle(&ta[i], &tb[j]);
        if least.as_ref().is_none_or(|l| found < *l) {
            least = Some(found);
        }
        if least == Some(RBig::ZERO) {
            break;
        }
    }
    least.unwrap()
}

fn check(a: Posed<'_>, b: Posed<'_>, what: &str) {
    let length = |p: &Pose| (p.translation.length(), p.at.length());
    let ((xa, aa), (xb, ab)) = (length(&a.pose), length(&b.pose));
    let arms = (a.body.center() - a.pose.at).length() + (b.body.center() - b.pose.at).length();
    let size = a.body.radius() + b.body.radius() + arms + (a.pose.translation - b.pose.translation).length();
    let all = size + 1e-3 * (xa + xb) + 1e-3 * (aa + ab);
    let square = brute_force(a, b, size);
    let found = distance(a, b, Solid::Surface).unwrap();
    let exact = |x: f64| RBig::try_from(x).unwrap();
    assert!(exact(found.lower) * exact(found.lower) <= square, "{what}: lower {found:?}");
    assert!(square <= exact(found.upper) * exact(found.upper), "{what}: upper {found:?}");
    assert!(found.upper - found.lower < 2e-13 * all, "{what}: width {found:?} {all}");
    assert!(found.lower <= found.value && found.value <= found.upper);
    let truth = square.to_f64().value().sqrt();
    assert!(
        (found.point_a.distance(found.point_b) - truth).abs() < 1e-12 * (all + xa + xb),
        "{what}: {found:?}"
    );
    for (weights, triangle, posed, point) in [
        (found.barycentric_a, found.triangle_a, a, found.point_a),
        (found.barycentric_b, found.triangle_b, b, found.point_b),
    ] {
        assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)));
        let [p, q, r] = posed.body.mesh().corners(triangle as usize);
        let mut pose = posed.pose;
        pose.rotation = pose.rotation.normalize();
        let again = pose.transform_point(p * weights[0] + q * weights[1] + r * weights[2]);
        assert!(again.distance(point) <= 1e-12 * (all + xa + xb));
    }
    // Never a false "no", and no "yes" that rounding does not excuse.
    let hit = collide(a, b, Solid::Surface).unwrap();
    assert!(hit || square > RBig::ZERO, "{what}: missed");
    assert!(!hit || truth < 1e-13 * all, "{what}: false contact at {truth}");
    assert_eq!(hit, !colliding_pairs(a, b).unwrap().is_empty());
    assert_eq!(hit, try_colliding_pair(a, b).unwrap().is_some());
    // A cutoff and a warm start change nothing.
    let crossing = colliding_pairs(a, b).unwrap();
    let starts = [[0, 0], [found.triangle_a, found.triangle_b], [u32::MAX, 0]];
    for start in starts.into_iter().chain(crossing) {
        let options = DistanceOptions::default().with_solid(Solid::Surface).with_first(Some(start));
        assert_eq!(distance_within(a, b, &options).unwrap(), Some(found));
        let options = options.with_cutoff(found.upper);
        assert_eq!(distance_within(a, b, &options).unwrap(), Some(found));
        let below = found.lower.next_down();
        if below >= 0.0 {
            let options = options.with_cutoff(below);
            assert_eq!(distance_within(a, b, &options).unwrap(), None);
        }
    }
}

fn pose(random: &mut KnuthRandom, spread: f64) -> Pose {
    Pose {
        rotation: random.quaternion(),
        translation: random.vector() * spread,
        at: random.vector() * 0.1 * spread,
    }
}

#[test]
fn random_solids_and_soups() {
    let mut random = KnuthRandom(7);
    for round in 0..60 {
        let scale = [1.0, 1e-6, 1e6, 1e-3][round % 4];
        let ratio = [1.0, 1.0, 1e-3, 1e3, 1e-30][round % 5];
        let a = MeshTree::new(match round % 3 {
            0 => soup(&mut random, 9, |p| p * scale),
            1 => tetrahedron(&mut random, |p| p * scale),
            _ => cube(|p| p * scale),
        });
        let b = MeshTree::new(tetrahedron(&mut random, |p| p * (scale * ratio)));
        let spread = scale * [0.3, 1.0, 3.0][round / 3 % 3];
        let (pa, pb) = (pose(&mut random, spread), pose(&mut random, spread));
        check(Posed::new(&a, pa), Posed::new(&b, pb), &format!("round {round}"));
        check(Posed::new(&b, pb), Posed::new(&a, pa), &format!("round {round} swapped"));
    }
}

#[test]
fn far_from_the_origin() {
    let mut random = KnuthRandom(21);
    for round in 0..12 {
        let far = random.vector() * 1e6;
        // Far in the body, in the world, or both.
        let (in_body, in_world) = (round % 3 != 1, round % 3 != 0);
        let shift = if in_body { far } else { DVec3::ZERO };
        let (a, b) = (
            MeshTree::new(tetrahedron(&mut random, |p| p + shift)),
            MeshTree::new(tetrahedron(&mut random, |p| p + shift)),
        );
        let (mut pa, mut pb) = (pose(&mut random, 2.0), pose(&mut random, 2.0));
        for pose in [&mut pa, &mut pb] {
            pose.at += shift;
            if in_world {
                pose.translation += far;
            }
        }
        check(Posed::new(&a, pa), Posed::new(&b, pb), &format!("offset {round}"));
    }
}

#[test]
fn touching_and_coplanar() {
    let unit = MeshTree::new(cube(|p| p));
    let at = |x: f64, y: f64, z: f64| {
        Posed::new(&unit, Pose { translation: DVec3::new(x, y, z), ..Pose::IDENTITY })
    };
    // Face on face, edge on edge, corner on corner, shifted within the plane, and the same place.
    for other in
        [at(2.0, 0.0, 0.0), at(2.0, 2.0, 0.0), at(2.0, 2.0, 2.0), at(2.0, 0.5, 1.3), at(0.0, 0.0, 0.0)]
    {
        check(at(0.0, 0.0, 0.0), other, "touching");
        assert!(collide(at(0.0, 0.0, 0.0), other, Solid::Filled).unwrap());
    }
    for gap in [1e-13, 1e-12, 1e-6] {
        let other = at(2.0 + gap, 2.0 + gap, 2.0 + gap);
        check(at(0.0, 0.0, 0.0), other, "nearly touching");
        assert!(!collide(at(0.0, 0.0, 0.0), other, Solid::Filled).unwrap());
    }
    // A corner that stands on a face, turned by a rotation that is not exact.
    let tilt = DQuat::from_xyzw(0.3, 0.1, -0.2, 0.9);
    for gap in [-1e-9, 0.0, 1e-15, 1e-9] {
        let corner = tilt.normalize() * DVec3::new(-1.0, -1.0, -1.0);
        let pose =
            Pose { rotation: tilt, translation: DVec3::new(0.1, 0.2, 1.0 - corner.z + gap), at: DVec3::ZERO };
        check(at(0.0, 0.0, 0.0), Posed::new(&unit, pose), "corner on face");
    }
}

#[test]
fn one_inside_the_other() {
    let mut random = KnuthRandom(3);
    let (big, small) = (MeshTree::new(cube(|p| p)), MeshTree::new(cube(|p| p * 0.1)));
    // A shell: a cube with a cubic hole, whose surface has its outside towards the middle. What is in the hole is not in
    // the body.
    let shell = Surface::cube(1.0).with(&Surface::cube(0.5).inverted());
    let shell = MeshTree::new(shell.into_mesh(TriMesh::try_new));
    let mut held = 0;
    for round in 0..200 {
        // Also exactly at the middle and on planes of symmetry, where rays meet edges and corners.
        let grid = |x: f64| (x * 4.0).round() * 0.2;
        let place = random.vector();
        let place =
            if round % 2 == 0 { place } else { DVec3::new(grid(place.x), grid(place.y), grid(place.z)) };
        let rotation = if round % 3 == 0 { DQuat::IDENTITY } else { random.quaternion() };
        let pose = Pose { rotation, translation: place, at: DVec3::ZERO };
        let (a, b) = (Posed::at_rest(&big), Posed::new(&small, pose));
        let crosses = collide(a, b, Solid::Surface).unwrap();
        assert!(
            collide(a, b, Solid::Filled).unwrap() && collide(b, a, Solid::Filled).unwrap()
                || !crosses && place.abs().max_element() > 1.0
        );
        let found = distance(b, a, Solid::Filled).unwrap();
        if !crosses && place.abs().max_element() < 1.0 {
            assert_eq!((found.state, found.value, found.lower), (StartState::Contained, 0.0, 0.0));
            // What is filled holds what is not, and not the other way round.
            let as_these = |solids| {
                let options = DistanceOptions::default().with_solids(solids);
                distance_within(a, b, &options).unwrap().unwrap()
            };
            assert_eq!(as_these([Solid::Filled, Solid::Surface]), distance(a, b, Solid::Filled).unwrap());
            for (solids, is_held) in
                [([Solid::Filled, Solid::Surface], true), ([Solid::Surface, Solid::Filled], false)]
            {
                let [of_a, of_b] = solids;
                for (a, b, solids) in [(a, b, solids), (b, a, [of_b, of_a])] {
                    assert_eq!(collide(a, b, solids).unwrap(), is_held);
                    let within = collide_within(a, b, solids, &Budget::UNLIMITED).unwrap();
                    let bounds = bound_distance(a, b, solids, &Budget::UNLIMITED).unwrap();
                    assert_eq!((within, bounds.lower == 0.0), (Some(is_held), is_held));
                }
            }
            let around = as_these([Solid::Surface, Solid::Filled]);
            assert_eq!(around, distance(a, b, Solid::Surface).unwrap());
            assert!(around.state == StartState::Apart && around.lower > 0.0, "{around:?}");
            held += 1;
        }
        let cutoff = DistanceOptions::default().with_cutoff(1e-12);
        let near = distance_within(a, b, &cutoff).unwrap();
        assert_eq!(near.is_some(), found.value == 0.0);
        let in_shell = Posed::at_rest(&shell);
        let hit = collide(in_shell, b, Solid::Filled).unwrap();
        if !collide(in_shell, b, Solid::Surface).unwrap() {
            let depth = place.abs().max_element();
            assert_eq!(hit, depth > 0.5 && depth < 1.0, "{place}");
        }
    }
    assert!(held > 100, "{held}");
}

#[test]
fn bad_input() {
    let mut random = KnuthRandom(1);
    let (closed, open) = (MeshTree::new(cube(|p| p)), MeshTree::new(soup(&mut random, 3, |p| p)));
    let good = Posed::at_rest(&closed);
    assert_eq!(
        collide(good, Posed::at_rest(&open), Solid::Filled),
        Err(QueryError::NotWatertight { body: 1 })
    );
    for pose in [
        Pose { rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..Pose::IDENTITY },
        Pose { rotation: DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0), ..Pose::IDENTITY },
        Pose { translation: DVec3::X * f64::INFINITY, ..Pose::IDENTITY },
        Pose { at: DVec3::X * 1e200, ..Pose::IDENTITY },
    ] {
        let bad = Posed::new(&closed, pose);
        assert_eq!(collide(good, bad, Solid::Filled), Err(QueryError::BadPose { body: 1 }));
        assert_eq!(distance(bad, good, Solid::Filled), Err(QueryError::BadPose { body: 0 }));
    }
    let options = DistanceOptions::default().with_cutoff(-1.0);
    assert!(distance_within(good, good, &options).is_err());
}

/// Of crowds of triangles that lie on each other the pair that is reported is the same one, whichever is met first.
#[test]
fn crowds_report_one_pair_whatever_is_met_first() {
    let sheets = |count: usize| {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].repeat(count);
        MeshTree::new(Surface::soup(corners).into_mesh(TriMesh::try_new))
    };
    for count in [2, 40, 300] {
        let (a, b) = (sheets(count), sheets(count));
        let (a, b) = (Posed::at_rest(&a), Posed::at_rest(&b));
        let found = distance(a, b, Solid::Surface).unwrap();
        let last = count as u32 - 1;
        for start in [[0, 0], [last, 0], [1, last], [last, last]] {
            let options = DistanceOptions::default().with_solid(Solid::Surface).with_first(Some(start));
            let again = distance_within(a, b, &options).unwrap();
            assert_eq!(again, Some(found), "{count}: {start:?}");
        }
    }
}
