//! Crowds of equally close pairs, and budgets.

use super::hulls::{Hulls, Measure, Parting};
use super::*;
use crate::tree::node::{Below, WIDTH};
use crate::{MeshTree, TriMesh};
use d2m_motion::Pose;
use d2m_testing::{Draw, KnuthRandom, Surface};

fn tree(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> MeshTree {
    MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap())
}

/// A cone with its apex at the origin, and the disc that closes it.
fn cone(n: u32, up: f64) -> MeshTree {
    MeshTree::new(Surface::cone(n, 1.0, up).into_mesh(TriMesh::try_new))
}

fn soup(vertices: impl IntoIterator<Item = DVec3>) -> MeshTree {
    MeshTree::new(Surface::soup(vertices).into_mesh(TriMesh::try_new))
}

/// One triangle many times.
fn copies(n: usize) -> MeshTree {
    soup([DVec3::ZERO, DVec3::X, DVec3::Y].repeat(n))
}

/// Flat slivers from the origin to all sides.
fn star(random: &mut KnuthRandom, n: u32) -> MeshTree {
    let (mut vertices, mut triangles) = (vec![DVec3::ZERO], Vec::new());
    for _ in 0..n {
        let first = vertices.len() as u32;
        vertices.push(DVec3::new(random.signed(), random.signed(), 0.0).normalize());
        vertices.push(vertices[first as usize] + DVec3::new(random.signed(), random.signed(), 0.0) * 1e-3);
        triangles.push([0, first, first + 1]);
    }
    tree(vertices, triangles)
}

/// The distance, and how many node tests and comparisons are enough.
fn counted(a: &MeshTree, b: &MeshTree, offset: DVec3) -> (Distance, u64) {
    let posed = Posed::new(b, Pose { translation: offset, ..Pose::IDENTITY });
    let within = |tests: u64| {
        let budget = Budget::UNLIMITED.with_node_tests(tests);
        bound_distance(Posed::at_rest(a), posed, Solid::Surface, &budget).unwrap()
    };
    let tests = (0..u64::BITS).map(|k| 1 << k).find(|&tests| within(tests).distance.is_some()).unwrap();
    (distance(Posed::at_rest(a), posed, Solid::Surface).unwrap(), tests)
}

#[test]
fn many_equally_close_pairs_cost_no_more_than_their_triangles() {
    let mut random = KnuthRandom(3);
    let fans = (cone(2000, -1.0), cone(2000, 1.0));
    let sheets = (copies(2000), copies(2000));
    let stars = (star(&mut random, 2000), star(&mut random, 2000));
    for (name, (a, b), offset) in [
        ("fans", &fans, DVec3::Z),
        ("fans", &fans, DVec3::new(0.25, -0.125, 0.5)),
        ("fans", &fans, DVec3::Z * 1e-13),
        ("fans", &fans, DVec3::Z * 100.0),
        ("copies", &sheets, DVec3::Z * 0.25),
        ("copies", &sheets, DVec3::new(-2.0, -2.0, 0.0)),
        ("stars", &stars, DVec3::Z * 0.5),
    ] {
        let (found, tests) = counted(a, b, offset);
        let expected = if name == "copies" && offset.z == 0.0 { 1.5 * 2f64.sqrt() } else { offset.length() };
        assert!(found.lower <= expected && expected <= found.upper, "{name} {offset}: {found:?}");
        assert!(found.upper - found.lower < 1e-12 * (1.0 + expected), "{name} {offset}: {found:?}");
        assert!(tests <= 1 << 17, "{name} {offset}: {tests}");
    }
}

/// Whatever the budget, the bounds hold the distance; they never are worse for more of it than with none.
#[test]
fn budgets_end_in_bounds_that_hold() {
    let mut random = KnuthRandom(17);
    let bodies = (copies(3), cone(60, 1.0), cone(60, -1.0), star(&mut random, 200));
    let pairs =
        [(&bodies.1, &bodies.2), (&bodies.0, &bodies.3), (&bodies.1, &bodies.3), (&bodies.1, &bodies.1)];
    let (mut ended, mut complete) = (0, 0);
    for (round, (a, b)) in pairs.into_iter().cycle().take(60).enumerate() {
        let pose = Pose {
            rotation: glam::DQuat::from_scaled_axis(random.vector() * 3.0),
            translation: random.vector() * [0.3, 2.0, 9.0][round % 3],
            at: DVec3::ZERO,
        };
        let (a, b) = (Posed::at_rest(a), Posed::new(b, pose));
        let closed = [a, b].iter().all(|posed| posed.body.is_watertight());
        let solid = if closed { Solid::Filled } else { Solid::Surface };
        let exact = distance(a, b, solid).unwrap();
        for tests in [0, 1, 2, 5, 10, 20, 50, 100, 300, 1000, 100_000] {
            let bounds = bound_distance(a, b, solid, &Budget::UNLIMITED.with_node_tests(tests)).unwrap();
            assert!(bounds.upper.is_finite() && bounds.lower >= 0.0);
            assert!(
                bounds.lower <= exact.value && exact.lower <= bounds.upper,
                "{tests}: {bounds:?} {exact:?}"
            );
            // The witness is that of the upper bound.
            let apart = bounds.point_a.distance(bounds.point_b);
            assert!((apart - bounds.upper).abs() < 1e-11, "{tests}: {bounds:?}");
            match bounds.distance {
                Some(found) => {
                    assert_eq!(found, exact);
                    complete += 1;
                }
                None => ended += 1,
            }
        }
    }
    assert!(ended > 100 && complete > 100, "{ended} {complete}");
}

/// Sheets that are closer than rounding resolves, and two triangles that cross beside them: the crowd of pairs that touch does
/// not hide those that cross.
#[test]
fn crowds_that_touch_hide_no_crossing() {
    let sheet = |n: u32, extra: [DVec3; 3]| {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].repeat(n as usize);
        soup(corners.into_iter().chain(extra))
    };
    let upright = [DVec3::new(3.2, 0.2, -1.0), DVec3::new(3.2, 0.3, 1.0), DVec3::new(3.3, 0.2, 1.0)];
    let flat = [DVec3::X * 3.0, DVec3::X * 4.0, DVec3::new(3.0, 1.0, 0.0)];
    for n in [1, 40, 200] {
        let (a, b) = (sheet(n, upright), sheet(n, flat));
        let pose = Pose { translation: DVec3::Z * 1e-15, ..Pose::IDENTITY };
        let found = distance(Posed::at_rest(&a), Posed::new(&b, pose), Solid::Surface).unwrap();
        assert_eq!((found.state, found.triangle_a, found.triangle_b), (StartState::Overlapping, n, n));
    }
}

/// The triangles below a box.
fn below(tree: &MeshTree, index: u32) -> Vec<u32> {
    match tree.nodes[index as usize / WIDTH].below(index as usize % WIDTH) {
        Below::Triangle(triangle) => vec![triangle],
        Below::Node(node) => {
            let lanes = tree.nodes[node as usize].used;
            (0..lanes).flat_map(|lane| below(tree, node * WIDTH as u32 + lane)).collect()
        }
    }
}

/// What a plane drops is no closer than the best pair, and what it proves of others is true.
#[test]
fn planes_drop_no_closer_pair() {
    let mut random = KnuthRandom(29);
    let (mut dropped, mut kept, mut close) = (0, 0, 0);
    for _ in 0..60 {
        let mut body = || {
            soup((0..40).flat_map(|_| {
                let corner = random.vector();
                [corner, corner + random.vector() * 0.2, corner + random.vector() * 0.2]
            }))
        };
        let (a, b) = (body(), body());
        let pose = Pose { translation: random.vector() * 2.5, ..Pose::IDENTITY };
        let scene = RestingScene::try_new(Posed::at_rest(&a), Posed::new(&b, pose)).unwrap();
        let apart = |[a, b]: [u32; 2]| triangle_distance(&scene.place(0, a), &scene.place(1, b));
        let boxes = |tree: &MeshTree| -> Vec<u32> {
            let lanes = |(k, node): (usize, &crate::tree::node::WideNode)| {
                (0..node.used).map(move |lane| (k * WIDTH) as u32 + lane)
            };
            tree.nodes.iter().enumerate().flat_map(lanes).collect()
        };
        let best = apart([7, 11]);
        let clock = &mut Meter::unlimited();
        let mut hulls = Hulls::new(&scene, clock).unwrap();
        let measure = Measure { upper: best.upper, direction: best.direction };
        for i in boxes(&a) {
            for j in boxes(&b) {
                let least = below(&a, i)
                    .into_iter()
                    .flat_map(|i| below(&b, j).into_iter().map(move |j| [i, j]))
                    .map(|pair| apart(pair).upper)
                    .fold(f64::INFINITY, f64::min);
                match hulls.part([i, j], measure, u64::MAX / 100, clock).unwrap() {
                    Parting::Beyond => {
                        dropped += 1;
                        assert!(least >= best.upper - EXPECTED_WIDTH, "{least} {best:?}");
                    }
                    Parting::AtLeast(bound) => {
                        kept += 1;
                        close += u32::from(bound > 0.0 && f64::from(bound) > 0.99 * least);
                        assert!(f64::from(bound) <= least, "{bound} {least}");
                    }
                }
            }
        }
    }
    assert!(dropped > 1000 && kept > 1000 && close > 100, "{dropped} {kept} {close}");
}

/// Cones whose apexes come together in several places, each along a line of its own.
fn cones(n: u32, radius: f64, depth: f64) -> MeshTree {
    let sides = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis, -axis]);
    let mut corners = Vec::new();
    for axis in sides {
        let (u, v) = (axis.any_orthonormal_vector(), axis.cross(axis.any_orthonormal_vector()));
        let rim = |k: u32| {
            let angle = f64::from(k) * core::f64::consts::TAU / f64::from(n / 6);
            axis * (radius + depth) + (u * angle.cos() + v * angle.sin()) * 0.3
        };
        corners.extend((0..n / 6).flat_map(|k| [axis * radius, rim(k), rim(k + 1)]));
    }
    soup(corners)
}

/// Large triangles whose corners deviate from a plane.
fn sheets(random: &mut KnuthRandom, n: u32, height: f64, bumps: f64) -> MeshTree {
    let corners = (0..n).flat_map(|_| {
        let turn = 3.0 * random.signed();
        [0.0, 2.1, 4.2].map(|angle: f64| {
            let (sin, cos) = (turn + angle).sin_cos();
            DVec3::new(cos, sin, height + bumps * random.signed())
        })
    });
    soup(corners)
}

/// The rulings of one family of a hyperboloid, as slivers: each passes every one of the other family.
fn rulings(n: u32, radius: f64, sense: f64) -> MeshTree {
    let corners = (0..n).flat_map(|k| {
        let angle = f64::from(k) * core::f64::consts::TAU / f64::from(n);
        let (waist, across) =
            (DVec3::new(angle.cos(), angle.sin(), 0.0) * radius, DVec3::new(-angle.sin(), angle.cos(), 0.0));
        let along = across * sense + DVec3::Z;
        [waist - along, waist + along, waist + along + across * 1e-3]
    });
    soup(corners)
}

/// Crowds that no common plane parts: the work is that of few pairs, or of one test for eight where each pair is different.
#[test]
fn crowds_without_a_common_plane_fall_apart() {
    let mut random = KnuthRandom(41);
    let n = 700;
    let gap = 1e-7;
    let at_rest = DVec3::ZERO;
    let cases = [
        ("cones", cones(n, 1.0 - 1e-2, -0.4), cones(n, 1.0, 0.4), 1 << 14),
        ("cones close", cones(n, 1.0 - gap, -0.4), cones(n, 1.0, 0.4), 1 << 14),
        ("sheets", sheets(&mut random, n, 0.0, gap), sheets(&mut random, n, 2.1 * gap, gap), 1 << 17),
        ("rulings", rulings(n, 0.9, 1.0), rulings(n, 1.0, -1.0), 1 << 18),
    ];
    for (name, a, b, most) in &cases {
        let (found, tests) = counted(a, b, at_rest);
        assert!(tests <= *most, "{name}: {tests}");
        assert!(found.upper - found.lower < 1e-12 && found.state == StartState::Apart, "{name}: {found:?}");
        let scene = RestingScene::try_new(Posed::at_rest(a), Posed::at_rest(b)).unwrap();
        let corners = |body: usize, tree: &MeshTree| -> Vec<[DVec3; 3]> {
            (0..tree.mesh().triangle_count()).map(|k| scene.place(body, k as u32)).collect()
        };
        let (a, b) = (corners(0, a), corners(1, b));
        let mut least = f64::INFINITY;
        for p in &a {
            for q in &b {
                // Along the line of the reported points, and exactly where that does not decide.
                if !crate::resting::node_pair::gap_exceeds(found.normal, p, q, least) {
                    least = least.min(triangle_distance(p, q).upper);
                }
            }
        }
        let least = least * scene.unit;
        assert!(found.lower <= least && least <= found.upper, "{name}: {found:?} {least}");
    }
}

/// A body that is one point up to rounding is measured by its first triangle, also when a cache remembers another one.
#[test]
fn a_cache_changes_no_bit_of_bodies_that_are_points() {
    let triangle = |at: f64, size: f64| {
        let at = DVec3::X * at;
        [at, at + DVec3::new(size, size, 0.0), at + DVec3::new(size, -size, 0.25 * size)]
    };
    let tree = |triangles: &[[DVec3; 3]]| {
        let faces = (0..triangles.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        MeshTree::new(TriMesh::try_new(triangles.concat(), faces).unwrap())
    };
    let large = tree(&[[DVec3::ZERO, DVec3::new(-1.0, 1.0, 0.0), DVec3::new(-1.0, -1.0, 0.25)]]);
    for size in [1e-15, 4e-16, 2e-16, 1e-16, 1e-20, 1e-30] {
        // The second triangle of both is the nearer one; of the other body by far.
        let [point, far] = [size, 1e9].map(|at| tree(&[triangle(at, size), triangle(0.0, size)]));
        let pose = Pose { translation: DVec3::X * 0.5, ..Pose::IDENTITY };
        let ask = |body: &MeshTree, first: Option<[u32; 2]>| {
            let options = DistanceOptions::default().with_solid(Solid::Surface).with_first(first);
            distance_within(Posed::at_rest(&large), Posed::new(body, pose), &options).unwrap().unwrap()
        };
        let before = ask(&far, None);
        assert_eq!(before.triangle_b, 1);
        let first = Some([before.triangle_a, before.triangle_b]);
        assert_eq!(ask(&point, first), ask(&point, None), "{size:e}");
    }
}

/// A search for a pair that is near enough ends sooner than one for the closest, and what it leaves is no further apart than it says.
#[test]
fn near_enough_is_found_sooner_and_bounds_hold() {
    let mut random = KnuthRandom(53);
    let mut steps = [0; 2];
    for round in 0..60 {
        let [a, b] = [0.0, 2.5].map(|shift| {
            soup((0..120).map(|_| {
                let corner = DVec3::new(random.signed(), random.signed(), random.signed());
                corner.normalize_or(DVec3::X) + DVec3::X * shift
            }))
        });
        let scene = RestingScene::try_new(Posed::at_rest(&a), Posed::at_rest(&b)).unwrap();
        let mut nearest = f64::INFINITY;
        for (k, slack) in [0.0, 1.0 / 64.0].into_iter().enumerate() {
            let meter = &mut Meter::unlimited().at_most(1 << 20);
            let found = run(Search { scene: &scene, first: None, limit: f64::INFINITY, slack, meter });
            let (Found::Pair(best) | Found::Exhausted(best)) = found else { panic!("{round}: {found:?}") };
            if k == 0 {
                nearest = best.distance.upper;
            }
            assert!(best.distance.upper * (1.0 - slack) <= nearest, "{round}");
            let least = nearest * (1.0 - 2.0 * slack) - 2.0 * EXPECTED_WIDTH;
            assert!(least <= best.lower && best.lower <= nearest, "{round}");
            steps[k] += meter.spent();
        }
    }
    assert!(steps[1] < steps[0], "{steps:?}");
}
