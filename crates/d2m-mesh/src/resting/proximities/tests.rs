//! Against brute force over all pairs of features, written to be read and not to be fast.

use super::*;
use crate::{MeshTree, TriMesh};
use d2m_motion::Pose;
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::DQuat;

/// How far two computations of one point may be apart: coordinates below 10 are rounded to 1e-15 a few times, and where two edges
/// cross at a small angle the point is known less well by the inverse of its sine.
const SAME_POINT: f64 = 1e-11;
/// How near to its limit a condition (a sine, or a part of an edge) is undecided in doubles: a sine of two points that are 1e-3 apart or
/// more is known to 1e-12. What is nearer than this may be found or not.
const ROOM_OF_ROUNDING: f64 = 1e-9;

/// The features of a placed mesh: vertices with their neighbours, edges with the third corners, triangles.
struct Brute {
    points: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
    edges: Vec<([usize; 2], Vec<usize>)>,
}

impl Brute {
    /// Of a mesh without repeated positions.
    fn new(mesh: &TriMesh, pose: &Pose) -> Self {
        let points = mesh.vertices().iter().map(|&p| pose.transform_point(p)).collect();
        let triangles: Vec<_> = mesh.triangles().iter().map(|t| t.map(|v| v as usize)).collect();
        let mut edges: Vec<([usize; 2], Vec<usize>)> = Vec::new();
        for t in &triangles {
            for k in 0..3 {
                let (p, q, r) = (t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
                let ends = [p.min(q), p.max(q)];
                match edges.iter_mut().find(|(e, _)| *e == ends) {
                    Some((_, thirds)) => thirds.push(r),
                    None => edges.push((ends, vec![r])),
                }
            }
        }
        Self { points, triangles, edges }
    }

    /// Is n in the cone of a vertex, and how far from its border (a sine; negative outside)?
    fn vertex_room(&self, vertex: usize, n: DVec3) -> f64 {
        let next = self.edges.iter().filter(|(e, _)| e.contains(&vertex)).map(|(e, _)| e[0] + e[1] - vertex);
        next.map(|w| -n.dot((self.points[w] - self.points[vertex]).normalize())).fold(1.0, f64::min)
    }

    fn edge_room(&self, edge: usize, at: DVec3, n: DVec3) -> f64 {
        self.edges[edge].1.iter().map(|&w| -n.dot((self.points[w] - at).normalize())).fold(1.0, f64::min)
    }

    fn ends(&self, edge: usize) -> [DVec3; 2] {
        self.edges[edge].0.map(|v| self.points[v])
    }
}

/// The foot of p on a triangle's inside, and how far from its border (relative).
fn foot_on_face(p: DVec3, [a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let n = (b - a).cross(c - a);
    let weight = |q: DVec3, r: DVec3| n.dot((r - q).cross(p - q)) / n.length_squared();
    let w = [weight(b, c), weight(c, a), weight(a, b)];
    (a * w[0] + b * w[1] + c * w[2], w[0].min(w[1]).min(w[2]))
}

fn foot_on_edge(p: DVec3, [a, b]: [DVec3; 2]) -> (DVec3, f64) {
    let t = (p - a).dot(b - a) / (b - a).length_squared();
    (a + (b - a) * t, t.min(1.0 - t))
}

fn crossing([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> ([DVec3; 2], f64) {
    let (u, v) = (b - a, d - c);
    let n = u.cross(v);
    let s = (c - a).cross(v).dot(n) / n.length_squared();
    let t = (c - a).cross(u).dot(n) / n.length_squared();
    ([a + u * s, c + v * t], s.min(1.0 - s).min(t).min(1.0 - t))
}

/// All locally closest pairs of points, each with the distance of its conditions from their limits.
fn brute_force(a: &Brute, b: &Brute, margin: f64) -> Vec<([DVec3; 2], f64)> {
    let mut found = Vec::new();
    let mut offer = |points: [DVec3; 2], room: &dyn Fn(DVec3) -> f64| {
        let offset = points[1] - points[0];
        if offset.length() <= margin {
            found.push((points, room(offset.normalize())));
        }
    };
    for (v, &p) in a.points.iter().enumerate() {
        for (w, &q) in b.points.iter().enumerate() {
            offer([p, q], &|n| a.vertex_room(v, n).min(b.vertex_room(w, -n)));
        }
        for e in 0..b.edges.len() {
            let (q, inside) = foot_on_edge(p, b.ends(e));
            offer([p, q], &|n| inside.min(a.vertex_room(v, n)).min(b.edge_room(e, q, -n)));
        }
        for t in &b.triangles {
            let (q, inside) = foot_on_face(p, t.map(|v| b.points[v]));
            offer([p, q], &|n| inside.min(a.vertex_room(v, n)));
        }
    }
    for (w, &q) in b.points.iter().enumerate() {
        for e in 0..a.edges.len() {
            let (p, inside) = foot_on_edge(q, a.ends(e));
            offer([p, q], &|n| inside.min(b.vertex_room(w, -n)).min(a.edge_room(e, p, n)));
        }
        for t in &a.triangles {
            let (p, inside) = foot_on_face(q, t.map(|v| a.points[v]));
            offer([p, q], &|n| inside.min(b.vertex_room(w, -n)));
        }
    }
    for e in 0..a.edges.len() {
        for f in 0..b.edges.len() {
            let ([p, q], inside) = crossing(a.ends(e), b.ends(f));
            offer([p, q], &|n| inside.min(a.edge_room(e, p, n)).min(b.edge_room(f, q, -n)));
        }
    }
    found
}

fn cuboid(half: DVec3) -> TriMesh {
    Surface::cuboid(-half, half).into_mesh(TriMesh::try_new)
}

fn bodies() -> Vec<TriMesh> {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let sheet = TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
    vec![
        Surface::wavy_torus(9, 6, 0.35).into_mesh(TriMesh::try_new),
        Surface::tetrahedron(corners).into_mesh(TriMesh::try_new),
        sheet.unwrap(),
        cuboid(DVec3::new(1.0, 0.5, 0.25)),
    ]
}

#[test]
fn holds_every_locally_closest_pair_that_brute_force_finds_once_and_no_other() {
    let trees: Vec<_> = bodies().into_iter().map(MeshTree::new).collect();
    let mut random = KnuthRandom(11);
    let (mut met, mut found_in_all) = (0, 0);
    for round in 0..1200 {
        let (a, b) = (&trees[round % 4], &trees[round / 4 % 4]);
        let mut pose = || Pose {
            rotation: random.moderate_turn().normalize(),
            translation: random.vector() * 1.6,
            at: DVec3::ZERO,
        };
        let poses = [pose(), pose()];
        let margin = [0.05, 0.3, 2.0][round % 3];
        let near = match proximities(Posed::new(a, poses[0]), Posed::new(b, poses[1]), margin) {
            Ok(near) => near,
            Err(QueryError::NotApart { .. }) => {
                met += 1;
                continue;
            }
            Err(error) => panic!("{error}"),
        };
        let (brute_a, brute_b) = (Brute::new(a.mesh(), &poses[0]), Brute::new(b.mesh(), &poses[1]));
        let all = brute_force(&brute_a, &brute_b, margin);
        let same = |points: &[DVec3; 2], p: &Proximity| {
            points[0].distance(p.point_a) < SAME_POINT && points[1].distance(p.point_b) < SAME_POINT
        };
        for (points, room) in all.iter().filter(|(_, room)| *room > ROOM_OF_ROUNDING) {
            let count = near.iter().filter(|p| same(points, p)).count();
            assert_eq!(count, 1, "round {round}: {points:?} {room}");
            found_in_all += 1;
        }
        for p in &near {
            let true_one = |(points, room): &([DVec3; 2], f64)| *room > -ROOM_OF_ROUNDING && same(points, p);
            assert!(all.iter().any(true_one), "round {round}: {p:?}");
            assert!((p.point_b - p.point_a - p.normal * p.distance).length() < 1e-12);
        }
        assert!(near.is_sorted_by(|p, q| p.distance <= q.distance));
        let nearest =
            crate::distance(Posed::new(a, poses[0]), Posed::new(b, poses[1]), crate::Solid::Surface).unwrap();
        assert_eq!(nearest.value <= margin, !near.is_empty(), "round {round}");
        assert!(near.is_empty() || (near[0].distance - nearest.value).abs() < 1e-13, "round {round}");
    }
    assert!(met < 600 && found_in_all > 300, "{met} {found_in_all}");
}

/// A box on a face that is parallel up to rounding: all corners of the patch, in any position and at any distance.
#[test]
fn the_corners_of_a_patch_of_contact_are_all_there_and_once() {
    let (floor, brick) =
        (MeshTree::new(cuboid(DVec3::new(5.0, 5.0, 1.0))), MeshTree::new(cuboid(DVec3::ONE)));
    let mut random = KnuthRandom(3);
    for round in 0..200 {
        let gap = [1e-3, 1e-6, 1e-9, 0.1][round % 4];
        let world = Pose {
            rotation: random.moderate_turn().normalize(),
            translation: random.vector() * 9.0,
            at: DVec3::ZERO,
        };
        // Every other one stands over the border, with its sides along the floor's or turned.
        let over = if round % 2 == 0 {
            random.vector() * DVec3::new(3.0, 3.0, 0.0)
        } else {
            DVec3::new(4.5, 1.25, 0.0)
        };
        let turn = glam::DQuat::from_xyzw(0.0, 0.0, if round % 3 == 0 { 0.0 } else { random.signed() }, 1.0)
            .normalize();
        let at = Pose {
            rotation: world.rotation * turn,
            translation: world.transform_point(over + DVec3::Z * (2.0 + gap)),
            at: DVec3::ZERO,
        };
        let near = proximities(Posed::new(&floor, world), Posed::new(&brick, at), 2.0 * gap).unwrap();
        let up = world.rotation * DVec3::Z;
        for p in &near {
            assert!((p.normal - up).length() < 1e-12 && (p.distance - gap).abs() < 1e-13, "{p:?}");
        }
        // Corners of the intersection of the two rectangles: corners of one in the other, and crossings of sides.
        let flat = |p: DVec3| {
            glam::DVec2::new(world.inverse_transform_point(p).x, world.inverse_transform_point(p).y)
        };
        let square: Vec<_> = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| flat(at.transform_point(DVec3::new(x, y, -1.0))))
            .to_vec();
        let mut patch: Vec<_> = square.iter().copied().filter(|p| p.abs().max_element() < 5.0).collect();
        for k in 0..4 {
            let (p, q) = (square[k], square[(k + 1) % 4]);
            let t = (5.0 - p.x) / (q.x - p.x);
            if t > ROOM_OF_ROUNDING && t < 1.0 - ROOM_OF_ROUNDING {
                patch.push(p + (q - p) * t);
            }
        }
        assert!(patch.len() >= 4);
        for corner in &patch {
            let count = near.iter().filter(|p| flat(p.point_a).distance(*corner) < SAME_POINT).count();
            assert_eq!(count, 1, "round {round}: {corner:?} of {patch:?}");
        }
        let manifold = reduce_proximities(&near, 0.1);
        assert_eq!(manifold.len(), 4);
        // The chosen four span the area of the patch, or nearly.
        assert!(manifold.iter().all(|p| patch.iter().any(|c| flat(p.point_a).distance(*c) < SAME_POINT)));
    }
}

#[test]
fn repeated_positions_and_flat_triangles_are_found_once() {
    // A quad as two triangles that share no vertex ids, one of them twice, and a needle along its side.
    let corners = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
    let vertices =
        vec![corners[0], corners[1], corners[2], corners[0], corners[2], corners[3], DVec3::X * 0.5];
    let triangles = vec![[0, 1, 2], [3, 4, 5], [0, 1, 2], [0, 6, 1], [6, 6, 6]];
    let quad = MeshTree::new(TriMesh::try_new(vertices, triangles).unwrap());
    let point = MeshTree::new(TriMesh::try_new(vec![DVec3::ZERO], vec![[0, 0, 0]]).unwrap());
    let over = |x: f64, y: f64| {
        let pose = Pose { translation: DVec3::new(x, y, 0.25), ..Pose::IDENTITY };
        proximities(Posed::at_rest(&quad), Posed::new(&point, pose), 0.3).unwrap()
    };
    for (x, y) in [(0.25, 0.5), (0.5, 0.5), (0.0, 0.0), (0.5, 0.0), (0.25, 0.0), (1.0, 1.0), (1.0, 0.5)] {
        let near = over(x, y);
        assert_eq!(near.len(), 1, "{x} {y}: {near:?}");
        assert!(near[0].point_a.distance(DVec3::new(x, y, 0.0)) < 1e-15);
        assert!(near[0].distance == 0.25 && near[0].normal.distance(DVec3::Z) < 1e-14);
    }
    assert!(over(1.5, 0.5).is_empty());
}

#[test]
fn bad_margins_and_bodies_that_meet_are_refused() {
    let tree = MeshTree::new(cuboid(DVec3::ONE));
    let here = Posed::at_rest(&tree);
    for margin in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(proximities(here, here, margin), Err(QueryError::BadMinSeparation { .. })));
    }
    let touching = Posed::new(&tree, Pose { translation: DVec3::X * 2.0, ..Pose::IDENTITY });
    let patch = proximities(here, touching, 0.1).unwrap();
    assert_eq!(
        patch.iter().filter(|p| p.distance <= 1e-14 && (p.normal - DVec3::X).length() < 1e-12).count(),
        patch.len()
    );
    assert!(patch.len() >= 4, "{patch:?}");
    let crossing = Posed::new(&tree, Pose { translation: DVec3::new(1.5, 0.5, 0.25), ..Pose::IDENTITY });
    assert!(matches!(proximities(here, crossing, 0.1), Err(QueryError::NotApart { .. })));
    let inside = MeshTree::new(cuboid(DVec3::splat(0.5)));
    assert_eq!(proximities(here, Posed::at_rest(&inside), 0.4), Ok(vec![]));
    assert_eq!(proximities(here, Posed::at_rest(&inside), 0.6).unwrap().len(), 8 * 3);
}

/// One query with wide cones holds what one with exact cones finds, marked by a tilt of zero.
#[test]
fn tilts_tell_exact_cones_from_wide_ones() {
    let mesh = MeshTree::new(Surface::wavy_torus(24, 12, 0.35).into_mesh(TriMesh::try_new));
    let mut random = KnuthRandom(91);
    let mut tilted = 0;
    for _ in 0..40 {
        let pose = Pose {
            rotation: random.moderate_turn(),
            translation: random.vector().normalize() * 2.2,
            ..Pose::IDENTITY
        };
        let near = |slack: f64| {
            let options = ProximityOptions::new(1.5).with_cone_slack(slack);
            proximities_with(crate::Posed::at_rest(&mesh), crate::Posed::new(&mesh, pose), &options)
        };
        let (Ok(exact), Ok(wide)) = (near(0.0), near(0.1)) else { continue };
        assert!(exact.iter().all(|p| p.tilt == 0.0) && wide.iter().all(|p| p.tilt <= 0.1));
        let straight: Vec<_> = wide.iter().filter(|p| p.tilt == 0.0).map(|p| p.feature).collect();
        assert_eq!(straight, exact.iter().map(|p| p.feature).collect::<Vec<_>>());
        tilted += wide.len() - straight.len();
    }
    assert!(tilted > 100, "{tilted}");
}

/// Of a cube that lies half on another one corners lie over a face and its rim, which wide cones let in as well: both have one name.
#[test]
fn a_corner_over_a_rim_is_found_once() {
    let cube = MeshTree::new(cuboid(DVec3::splat(0.5)));
    for k in -20..=20 {
        // Rims lie over each other up to a part of the distance.
        let turn = DQuat::from_rotation_x(1e-10 * f64::from(k));
        let pose = Pose { rotation: turn, translation: DVec3::new(0.525, 1.001, 0.0), ..Pose::IDENTITY };
        let options = ProximityOptions::new(1.5e-3).with_cone_slack(0.1);
        let near = proximities_with(crate::Posed::at_rest(&cube), crate::Posed::new(&cube, pose), &options);
        let near = near.unwrap();
        let is_double = |p: &Proximity| near.iter().filter(|other| other.feature == p.feature).count() > 1;
        assert!(near.len() >= 4 && !near.iter().any(is_double), "{k}: {near:?}");
        let corner = |p: &&Proximity| (p.point_b - pose.translation).abs().max_element() > 0.499_999;
        let straight = near.iter().filter(corner).filter(|p| p.tilt < 1e-12).count();
        assert!(straight >= 2, "{k}: {near:?}");
    }
    // Of one that lies on all of the other, a little aside, corners are outside of the rim by less than the cones let in.
    for off in [DVec3::X, DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::new(-1.0, 0.0, 1.0)] {
        for by in [1e-4, 1e-5, 1e-6] {
            let pose = Pose { translation: DVec3::Y * 1.001 + off * by, ..Pose::IDENTITY };
            let options = ProximityOptions::new(1.5e-3).with_cone_slack(0.1);
            let near =
                proximities_with(crate::Posed::at_rest(&cube), crate::Posed::new(&cube, pose), &options);
            let near = near.unwrap();
            let is_double =
                |p: &Proximity| near.iter().filter(|other| other.feature == p.feature).count() > 1;
            assert!(near.len() >= 4 && !near.iter().any(is_double), "{off} {by}: {near:?}");
        }
    }
}

/// Bodies whose margin is their size: cones of normals drop most pairs of boxes and nothing that is found without them. (Wider normal
/// cones, by a slack that changes no test, are searched without.)
#[test]
fn cones_of_normals_lose_no_pair() {
    let mut random = KnuthRandom(31);
    let wavy = |rings: u32, sides: u32, tube: f64| Surface::wavy_torus(rings, sides, tube);
    let sphere = |count: u32| wavy(count, count / 2, 0.9).map(|p| p.normalize());
    let open = Surface::soup((0..90).map(|_| random.vector()));
    let surfaces = [wavy(30, 16, 0.3), wavy(20, 12, 0.45), sphere(24), Surface::cube(0.5), open];
    let trees = surfaces.map(|surface| MeshTree::new(surface.into_mesh(TriMesh::try_new)));
    let (mut results, mut fewer) = (0, 0);
    for round in 0..60 {
        let (a, b) = (&trees[round % 5], &trees[(round / 5 + round) % 5]);
        let rotation = glam::DQuat::from_scaled_axis(random.vector() * 2.0);
        let apart = (a.radius() + b.radius()) * (0.4 + 0.7 * random.signed().abs());
        let translation = random.vector().normalize() * apart;
        let bodies = [Posed::at_rest(a), Posed::new(b, Pose { rotation, translation, at: DVec3::ZERO })];
        let options = ProximityOptions::new(1.5);
        let all = proximities_with(bodies[0], bodies[1], &options.with_cone_slack(f64::MIN_POSITIVE));
        let Ok(all) = all else { continue };
        let found = proximities_with(bodies[0], bodies[1], &options).unwrap();
        assert_eq!(found, all, "round {round}");
        results += all.len();
        let scene = RestingScene::try_new(bodies[0], bodies[1]).unwrap();
        let mut facing = facing::Facing::new(&scene, 0.0);
        let triangles = a.mesh().triangle_count() + b.mesh().triangle_count();
        (0..triangles).for_each(|_| facing.count());
        let boxes = |tree: &MeshTree| (0..8 * tree.nodes.len() as u32).collect::<Vec<_>>();
        let pairs = boxes(a).into_iter().step_by(7).flat_map(|s| boxes(b).into_iter().map(move |t| [s, t]));
        fewer += pairs.filter(|&pair| !facing.may_be_closest(pair, 0.1)).count();
    }
    assert!(results > 500 && fewer > 100_000, "{results} {fewer}");
}
