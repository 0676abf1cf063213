use super::*;
use crate::pair::motion::local_motion::LocalMotion;
use crate::skip::swept_volume::swept_clear_until;
use crate::{Budget, MeshTree, QueryOptions, TriMesh, Window};
use d2m_feature::triangle_distance;
use d2m_mesh::Stop;
use d2m_motion::ConstantTwist;
use d2m_testing::{Draw, KnuthRandom};
use glam::DQuat;
use std::f64::consts::PI;

const LIMITS: SkipLimits = SkipLimits {
    least_gain: 0.0,
    most_work: 1 << 13,
    most_a_triangle: 0,
    most_before: 0,
    budget: u64::MAX,
    stop: Stop::NEVER,
    witnesses: [0, 0],
};

/// Random triangles, one a body, on random screws about z, some with a drift: the least distance at times called
/// clear over the level, and how many were called clear for some time.
fn least_ratio(rounds: u32, mutate: impl Fn(&mut Screw)) -> (f64, u32) {
    let mut random = KnuthRandom(9);
    let (level, mut least, mut won) = (0.02, f64::INFINITY, 0);
    let options = QueryOptions::default().with_tolerance(level);
    for round in 0..rounds {
        let mut vec = || random.vector();
        let mut body = |size: f64| {
            let middle = vec();
            let corners = vec![middle + vec() * size, middle + vec() * size, middle + vec() * size];
            MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap())
        };
        let (a, b) = (body(0.5), body(0.5));
        let spins = [(4.0, 0.0), (0.0, -7.0), (5.0, 2.0), (9.0, 8.0)][round as usize % 4];
        let climb = [0.0, 0.3, 3.0][round as usize / 4 % 3];
        let drift = [0.0, 0.3][round as usize / 12 % 2];
        let mut motion = |spin: f64, v: DVec3, x: DVec3| {
            let turn = DQuat::from_xyzw(vec().x, vec().y, vec().z, 0.7);
            ConstantTwist::try_new(x, turn, v, DVec3::Z * spin).unwrap()
        };
        let motions = [
            motion(spins.0, DVec3::new(drift, 0.0, climb), DVec3::X * drift),
            motion(spins.1, DVec3::ZERO, DVec3::ZERO),
        ];
        let scene = MovingScene::new((&a, motions[0]), (&b, motions[1]), Window::UNIT, &options);
        let until = Screw::new(&scene, 0.0).and_then(|mut screw| {
            mutate(&mut screw);
            clear_along(&screw, (&scene, 0.0), &LIMITS, &mut None).clear_until
        });
        let until = until.unwrap_or(0.0);
        won += u32::from(until > 0.0);
        let world = |tree: &MeshTree, motion: &ConstantTwist, t: f64| {
            let turn = LocalMotion::unscaled(motion).rotation(t);
            let x = motion.position() + motion.linear_velocity() * t;
            tree.mesh().corners(0).map(|p| turn[0] * p.x + turn[1] * p.y + turn[2] * p.z + x)
        };
        for k in (0..=100).filter(|_| until > 0.0) {
            let t = until * f64::from(k) / 100.0;
            let found = triangle_distance(&world(&a, &motions[0], t), &world(&b, &motions[1], t)).lower;
            least = least.min(found / level);
        }
    }
    (least, won)
}

/// A triangle, its copy turned by one radian and lifted a little, and a plate above: the copy's own place counts,
/// although one projection stands for both.
#[test]
fn triangles_of_an_orbit_count_where_they_are() {
    let corners = [DVec3::X, DVec3::new(0.9, 0.1, -0.1), DVec3::new(0.8, 0.0, 0.0)];
    let turn = DQuat::from_rotation_z(1.0);
    let plate =
        [DVec3::new(-2.0, -2.0, 1.02e-7), DVec3::new(2.0, -2.0, 1.02e-7), DVec3::new(0.0, 3.0, 1.02e-7)];
    // With a face below both, beside the path of either, so that neither is left out.
    let post = [(0.82, -0.09), (0.82, -0.08), (0.83, -0.085)].map(|(x, z)| DVec3::new(x, 0.0, z));
    let plate = TriMesh::try_new([plate, post].concat(), vec![[0, 1, 2], [3, 4, 5]]).unwrap();
    let plate = MeshTree::new(plate);
    let options = QueryOptions::default().with_tolerance(1e-7);
    let spin = ConstantTwist::REST.with_angular_velocity(DVec3::Z * 5.0);
    let until = |lift: f64| {
        let lifted = corners.map(|p| turn * p + DVec3::Z * lift);
        let pair = TriMesh::try_new([corners, lifted].concat(), vec![[0, 1, 2], [3, 4, 5]]).unwrap();
        let pair = MeshTree::new(pair);
        let scene = MovingScene::new((&pair, spin), (&plate, ConstantTwist::REST), Window::UNIT, &options);
        screw_clear_until(&scene, 0.0, &LIMITS).clear_until
    };
    assert_eq!((until(0.0), until(1e-9), until(4e-9)), (Some(1.0), Some(1.0), None));
}

#[test]
fn projections_that_are_apart_mean_bodies_that_are_apart() {
    let (least, won) = least_ratio(2400, |_| ());
    assert!((1.0..2.0).contains(&least), "{least}");
    assert!(won > 600, "{won}");
}

#[test]
fn mutants_of_the_screw_die() {
    assert!(least_ratio(2400, |screw| screw.h *= 0.9).0 < 0.99, "another pitch");
    assert!(least_ratio(2400, |screw| screw.across_rate = 0.0).0 < 0.99, "no drift");
    assert!(least_ratio(2400, |screw| screw.climb *= 0.5).0 < 0.99, "half of the climb");
    let still = |screw: &mut Screw| {
        *screw = screw.turn_in_place();
        screw.slide = 0.0;
    };
    assert!(least_ratio(2400, still).0 < 0.99, "a turn in place that does not climb");
}

#[test]
fn turns_in_place_that_climb_keep_bodies_apart() {
    let (least, won) = least_ratio(2400, |screw| *screw = screw.turn_in_place());
    assert!((1.0..2.0).contains(&least), "{least}");
    assert!(won > 400, "{won}");
}

/// A spoke under a short chord of a rim: the spoke is larger, but it is the chord that is nearer to the axis than its corners are.
#[test]
fn of_two_pieces_the_one_whose_bend_counts_is_divided() {
    let spoke = [DVec3::X * 0.5, DVec3::X * 0.9999, DVec3::new(0.5, 0.0, 0.5)];
    let short = [DVec3::X * 0.3, DVec3::X * 0.5, DVec3::new(0.3, 0.0, 0.5)];
    let chord = [(-0.1, 0.0), (0.1, 0.0), (0.1, 0.01)].map(|(y, z)| DVec3::new(1.0, y, z));
    let tree = MeshTree::new(TriMesh::point(DVec3::X).unwrap());
    let turn = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
    let bodies = [(&tree, turn), (&tree, ConstantTwist::REST)];
    let scene = MovingScene::new(bodies[0], bodies[1], Window::UNIT, &QueryOptions::default());
    let screw = Screw::new(&scene, 0.0).unwrap();
    let mut clock = Meter::until(Stop::NEVER);
    let [spoke, short, chord] = [spoke, short, chord].map(|corners| {
        let triangle = SeenTriangle { vertices: [0, 1, 2], near: AnnularBound::of(&corners).near };
        let mut vertices = PlacedVertices::new(corners.into_iter());
        BodyProjections::try_new(&screw, &mut vertices, &[triangle], &mut clock).unwrap().with_angles
    });
    let walk = Walk {
        screw: &screw,
        shift: 0.0,
        angles: true,
        level: 1e-3,
        length: 1.0,
        clear: 1.0,
        gain: 0.0,
        left: 1,
        clock,
    };
    assert!(spoke.size(0) > chord.size(0));
    assert_eq!(walk.division([&spoke, &chord], [0, 0]), Division::OfB);
    assert_eq!(walk.division([&chord, &spoke], [0, 0]), Division::OfA);
    assert_eq!(walk.division([&chord, &short], [0, 0]), Division::GainsLittle);
}

/// The offset until which the screw alone proves two triangles apart, A spinning at 6 while it climbs.
fn clear_until(a: [DVec3; 3], b: [DVec3; 3], climb: f64) -> Option<f64> {
    let [a, b] = [a, b].map(|t| MeshTree::new(TriMesh::try_new(t.to_vec(), vec![[0, 1, 2]]).unwrap()));
    let screw =
        ConstantTwist::REST.with_angular_velocity(DVec3::Z * 6.0).with_linear_velocity(DVec3::Z * climb);
    let options = QueryOptions::default().with_tolerance(1e-7);
    let scene = MovingScene::new((&a, screw), (&b, ConstantTwist::REST), Window::UNIT, &options);
    screw_clear_until(&scene, 0.0, &LIMITS).clear_until
}

/// A face of a screw and one of its nut, a third of the lead apart, and the screw drifts across its axis by twice that gap: along a flat thread
/// a tenth of the drift counts.
#[test]
fn drift_across_the_axis_closes_little_of_a_gap_along_it() {
    let face = |z: f64| [(1.0, 0.0), (1.0, 0.01), (1.01, 0.0)].map(|(x, y)| DVec3::new(x, y, z + y));
    let [a, b] =
        [0.0, 0.1].map(|z| MeshTree::new(TriMesh::try_new(face(z).to_vec(), vec![[0, 1, 2]]).unwrap()));
    let screw = ConstantTwist::REST
        .with_angular_velocity(DVec3::Z * 6.0)
        .with_linear_velocity(DVec3::new(0.2, 0.0, 0.3));
    let options = QueryOptions::default().with_tolerance(1e-7);
    let scene = MovingScene::new((&a, screw), (&b, ConstantTwist::REST), Window::UNIT, &options);
    assert_eq!(screw_clear_until(&scene, 0.0, &LIMITS).clear_until, Some(1.0));
}

/// A quarter of a turn later the drift is along the circle: it takes the face of a screw as far beside its helix as it takes the angle back.
#[test]
fn drift_across_the_axis_turns_too() {
    let motion = ConstantTwist::REST
        .with_angular_velocity(DVec3::Z * 6.0)
        .with_linear_velocity(DVec3::new(-1.2, 0.0, 6.0));
    let met_at = PI / 12.0;
    let place = |p: DVec3| DQuat::from_rotation_z(6.0 * met_at) * p + motion.linear_velocity() * met_at;
    let face = [(0.0, 0.0), (0.01, 0.0), (0.0, 0.01)].map(|(y, z)| DVec3::new(1.0, y, z));
    let other = face.map(|p| place(DVec3::new(p.x, 0.01 - p.y, 0.01 - p.z)));
    let [a, b] = [face, other].map(|t| MeshTree::new(TriMesh::try_new(t.to_vec(), vec![[0, 1, 2]]).unwrap()));
    let options = QueryOptions::default().with_tolerance(1e-7);
    let scene = MovingScene::new((&a, motion), (&b, ConstantTwist::REST), Window::UNIT, &options);
    let until = screw_clear_until(&scene, 0.0, &LIMITS).clear_until;
    assert!(until.is_some_and(|until| (0.2 * met_at..met_at).contains(&until)), "{until:?}");
}

/// The end of a shaft has faces that meet in the axis. What turns past its rim, as a thread in a nut does, passes its
/// height beside it, or through it.
#[test]
fn faces_that_meet_in_the_axis_have_angles_beside_it() {
    let rim = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    let end = [DVec3::ZERO, rim(0.0), rim(0.5)];
    let thread = |angle: f64| {
        [0.9, 0.92, 0.94].map(|rho| rim(angle + rho - 0.9) * rho - DVec3::Z * (1.5 + (rho - 0.92).abs()))
    };
    // At the height of the end after half of the time, 3 rad further.
    assert_eq!(clear_until(thread(0.0), end, 3.0), Some(1.0));
    assert_eq!(clear_until(thread(1.5), end, 3.0), Some(1.0));
    let through = clear_until(thread(-2.8), end, 3.0);
    assert!(through.is_none_or(|until| until < 0.5), "{through:?}");
}

/// A face that comes within a fiftieth of its length to the axis: its angles are between those of its corners.
#[test]
fn faces_that_pass_close_to_the_axis_have_angles() {
    let rim = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    let end = [DVec3::X * 0.02, rim(0.0), rim(0.5)];
    let thread = |angle: f64| {
        [0.9, 0.92, 0.94].map(|rho| rim(angle + rho - 0.9) * rho - DVec3::Z * (1.5 + (rho - 0.92).abs()))
    };
    assert_eq!(clear_until(thread(0.0), end, 3.0), Some(1.0));
    let through = clear_until(thread(-2.8), end, 3.0);
    assert!(through.is_none_or(|until| until < 0.5), "{through:?}");
}

/// Two plates that turn about axes tilted against each other by half a millionth, a tenth of a millionth apart at the start: half a
/// turn later the one's rim is nine tenths of a millionth below the other one's.
#[test]
fn heights_change_where_axes_are_tilted() {
    let plate = |z: f64| {
        let corners = [(-2.0, -2.0), (2.0, -2.0), (0.0, 3.0)].map(|(x, y)| DVec3::new(x, y, z));
        MeshTree::new(TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2]]).unwrap())
    };
    let (below, above) = (plate(0.0), plate(1e-7));
    let options = QueryOptions::default().with_tolerance(1e-10);
    let until = |tilt: f64| {
        let spin = |rate: f64, tilt: f64| {
            ConstantTwist::REST.with_angular_velocity(DVec3::new(tilt, 0.0, 1.0).normalize() * rate)
        };
        let bodies = [(&below, spin(9.6, 0.0)), (&above, spin(3.2, tilt))];
        let scene = MovingScene::new(bodies[0], bodies[1], Window::UNIT, &options);
        screw_clear_until(&scene, 0.0, &LIMITS).clear_until
    };
    assert_eq!((until(0.0), until(1e-9), until(-5e-7)), (Some(1.0), Some(1.0), None));
}

/// Of two faces that climb towards a plate, the one that is tested last gets nowhere near it, the other one there at three quarters of
/// the time.
#[test]
fn what_comes_near_late_is_projected() {
    let face = |z: f64| [(0.5, 0.0), (1.0, 0.2), (1.0, -0.2)].map(|(x, y)| DVec3::new(x, y, z));
    let faces = TriMesh::try_new([face(-5.0), face(-0.75)].concat(), vec![[0, 1, 2], [3, 4, 5]]);
    let plate = [(-9.0, -9.0), (9.0, -9.0), (0.0, 9.0)].map(|(x, y)| DVec3::new(x, y, 0.0));
    let plate = TriMesh::try_new(plate.to_vec(), vec![[0, 1, 2]]);
    let [faces, plate] = [faces, plate].map(|mesh| MeshTree::new(mesh.unwrap()));
    let climb = ConstantTwist::REST.with_linear_velocity(DVec3::Z).with_angular_velocity(DVec3::Z * 6.0);
    let options = QueryOptions::default().with_tolerance(1e-7);
    let scene = MovingScene::new((&faces, climb), (&plate, ConstantTwist::REST), Window::UNIT, &options);
    let until = screw_clear_until(&scene, 0.0, &LIMITS).clear_until;
    assert!(until.is_some_and(|until| (0.74..=0.75).contains(&until)), "{until:?}");
}

/// Rings of vertices about z, one for each radius, at two heights in turn, and the triangles between them.
fn ring(around: u32, radii: &[f64], z: [f64; 2]) -> MeshTree {
    let rows = radii.len() as u32;
    let vertices = (0..around * rows).map(|k| {
        let (angle, row) = (f64::from(k % around) * 2.0 * PI / f64::from(around), k / around);
        let height = if row % 2 == 0 { z[0] } else { z[1] };
        DVec3::new(angle.cos(), angle.sin(), 0.0) * radii[row as usize] + DVec3::Z * height
    });
    let triangles = (0..around * (rows - 1)).flat_map(|k| {
        let next = k / around * around + (k + 1) % around;
        [[k, next, k + around], [next, next + around, k + around]]
    });
    MeshTree::new(TriMesh::try_new(vertices.collect(), triangles.collect()).unwrap())
}

/// A ring that turns about a post, and is wide: only its inner rim is near the post, and only that is projected.
#[test]
fn what_is_never_near_is_not_projected() {
    let post = ring(24, &[1.0, 1.0], [-3.0, 3.0]);
    let wide = ring(64, &[1.01, 1.2, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0], [0.0, 0.1]);
    let triangles = (post.mesh().triangle_count() + wide.mesh().triangle_count()) as u64;
    let options = QueryOptions::default();
    let climb = ConstantTwist::REST.with_linear_velocity(DVec3::Z * 1e-3);
    let turn = climb.with_angular_velocity(DVec3::Z * 5.0);
    let scene = MovingScene::new((&wide, turn), (&post, ConstantTwist::REST), Window::UNIT, &options);
    let skip = screw_clear_until(&scene, 0.0, &LIMITS);
    assert_eq!(skip.clear_until, Some(1.0));
    assert!(skip.work < triangles / 4 + triangles / 16, "{skip:?}, {triangles} triangles");
}

/// A face a thousand leads long, along the wall that it slides on and through one that it meets in the end.
#[test]
fn faces_longer_than_many_leads_are_turned_in_place() {
    let face = |rho: f64, z: [f64; 3]| [0, 1, 2].map(|k| DVec3::new(rho, [-0.1, 0.1, 0.0][k], z[k]));
    let shaft = face(1.0, [-5.0, -5.0, 5.0]);
    assert_eq!(clear_until(shaft, face(1.2, [-8.0, -8.0, 8.0]), 1e-3), Some(1.0));
    let above = face(1.0, [5.0005, 5.0005, 6.0]);
    let until = clear_until(shaft, above, 1e-3);
    assert!(until.is_some_and(|until| (0.4..=0.5).contains(&until)), "{until:?}");
}

/// An attempt ends when its time has come, wherever it is: at the first reading of the clock, after 64 steps.
#[test]
fn attempts_end_with_their_time() {
    let ring = |n: u32| {
        let vertices = (0..2 * n).map(|k| {
            let angle = f64::from(k / 2) * 0.01;
            DVec3::new(angle.cos(), angle.sin(), f64::from(k % 2))
        });
        let triangles = (0..2 * n - 2).map(|k| [k, k + 1, k + 2]).collect();
        MeshTree::new(TriMesh::try_new(vertices.collect(), triangles).unwrap())
    };
    let (a, b) = (ring(500), ring(500));
    let spin = |speed: f64| ConstantTwist::REST.with_angular_velocity(DVec3::Z * speed);
    let far = spin(3.0).with_position(DVec3::Z * 1.5);
    let scene = MovingScene::new((&a, far), (&b, spin(0.0)), Window::UNIT, &QueryOptions::default());
    let over = Stop::new(&Budget::UNLIMITED.with_wall_clock(std::time::Duration::ZERO));
    for (stop, ends) in [(Stop::NEVER, false), (over, true)] {
        let limits = SkipLimits { stop, ..LIMITS };
        let skip = screw_clear_until(&scene, 0.0, &limits);
        assert_eq!(skip.clear_until.is_none(), ends, "{skip:?}");
        let skip = swept_clear_until(&scene, 0.0, &limits, DVec3::Y);
        assert_eq!(skip.clear_until.is_none(), ends, "{skip:?}");
        let screw = Screw::new(&scene, 0.0).unwrap();
        let mut clock = Meter::until(stop);
        let mut vertices = PlacedVertices::new(a.mesh().vertices().iter().copied());
        let seen = |&vertices| SeenTriangle { vertices, near: 1.0 };
        let triangles: Vec<_> = a.mesh().triangles().iter().map(seen).collect();
        let projected = BodyProjections::try_new(&screw, &mut vertices, &triangles, &mut clock);
        assert_eq!(projected.is_err(), ends);
    }
}
