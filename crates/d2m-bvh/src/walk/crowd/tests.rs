//! Planes hold as long as they are said to, and boxes reach as far as what they hold.

use super::places::Places;
use super::*;
use crate::pair::motion::frame::Frame;
use crate::pair::scene::{MovingScene, MovingTree};
use crate::walk::scratch::Scratch;
use crate::walk::state::SubWindow;
use crate::{Budget, MeshTree, QueryOptions, TriMesh, Window};
use d2m_lanes::{F64x4, Portable};
use d2m_mesh::Stop;
use d2m_mesh::node::{Below, WideNode};
use d2m_motion::ConstantTwist;
use d2m_testing::{Draw, KnuthRandom, Surface};
use glam::DQuat;
use std::time::Duration;

fn soup(random: &mut KnuthRandom, shift: DVec3) -> MeshTree {
    let vertices = (0..9).map(|_| random.vector() + shift);
    MeshTree::new(Surface::soup(vertices).into_mesh(TriMesh::try_new))
}

const fn moving(tree: &MeshTree, twist: ConstantTwist) -> MovingTree<'_> {
    MovingTree { tree, twist }
}

/// All vertices of both bodies.
fn vertices(scene: &MovingScene<'_>) -> [Vertices; 2] {
    [&scene.a, &scene.b].map(|body| {
        let mut group = Group::new(body);
        group.add(0, 100, &mut Meter::unlimited()).unwrap();
        group.vertices
    })
}

fn points(scene: &MovingScene<'_>) -> [Vec<DVec3>; 2] {
    vertices(scene).map(|of| of.points)
}

/// Bodies that a plane parts are further apart than the level at all times of the span; not if the gap is measured
/// at one end only, nor without what accelerations take.
#[test]
fn what_a_plane_parts_stays_apart() {
    let mut random = KnuthRandom(23);
    let (mut parted, mut wrong) = ([0; 3], [0; 3]);
    for round in 0..4000 {
        // Also bodies that turn about an axis far from them.
        let shift = [0.0, 4.0][round / 3 % 2];
        let (a, b) = (soup(&mut random, DVec3::X * shift), soup(&mut random, DVec3::Y * shift));
        let spin = [0.5, 4.0, 12.0][round % 3];
        let [motion_a, motion_b] = [2.5 + shift, 0.0].map(|apart| {
            let q = DQuat::from_xyzw(random.signed(), random.signed(), random.signed(), 1.5);
            ConstantTwist::try_new(random.vector() * apart, q, random.vector(), random.vector() * spin)
                .unwrap()
        });
        let options = QueryOptions::default().with_tolerance(1e-3);
        let scene =
            MovingScene::try_new(moving(&a, motion_a), moving(&b, motion_b), Window::UNIT, &options).unwrap();
        let motion = scene.relative_motion(0.0);
        let frame = motion.frame::<F64x4>(0.0);
        let span = scene.longest * (0.6 + 0.4 * random.signed());
        let points = points(&scene);
        let moving = Moving::new(&scene, points.each_ref(), &frame, span, &mut Meter::unlimited()).unwrap();
        let n = moving.between().normalize();
        let mut straight =
            Moving::new(&scene, points.each_ref(), &frame, span, &mut Meter::unlimited()).unwrap();
        straight.paths.iter_mut().flatten().for_each(|path| path.bend = 0.0);
        let [gaps, straight_gaps] = [&moving, &straight].map(|moving| moving.gaps(n).map(|gap| gap.along));
        let world = motion.rotation_b(0.0).transform(n);
        let gap_at = |time: f64| {
            let frame = motion.frame::<F64x4>(time);
            let n = motion.rotation_b(time).transposed::<F64x4>().transform(world);
            Moving::new(&scene, points.each_ref(), &frame, 0.0, &mut Meter::unlimited()).unwrap().gaps(n)[0]
                .along
        };
        let least = (0..=8).map(|k| gap_at(span * f64::from(k) / 8.0)).fold(f64::INFINITY, f64::min);
        // The largest levels that the plane may prove: parts of the gaps at both ends.
        let ends = [gaps[0], gaps[1], straight_gaps[1]];
        for level in ends.into_iter().flat_map(|gap| [0.999, 0.9, 0.7].map(|part| part * gap)) {
            let search = PlaneSearch { first: n, level, most: 1 };
            let proven = moving.separation(&search, &mut Meter::unlimited()).separation;
            let at_one_end = gaps[0] > level;
            let without_bend = straight_gaps.iter().all(|&gap| gap > level);
            let claims = [matches!(proven, Separation::Proven { .. }), at_one_end, without_bend];
            for (k, claim) in claims.into_iter().enumerate() {
                if level > 0.0 && claim {
                    parted[k] += 1;
                    wrong[k] += u32::from(least < level - 2.0 * scene.pair.error);
                }
            }
        }
    }
    assert!(wrong[0] == 0 && parted[0] > 200, "{wrong:?} of {parted:?}");
    assert!(wrong[1] > 0 && wrong[2] > 0, "{wrong:?} of {parted:?}");
}

/// A body that turns about one of its vertices: that one does not bend, the others as much as they are away from the axis.
#[test]
fn points_bend_by_their_distance_from_the_axis() {
    let corners = vec![DVec3::ZERO, DVec3::new(0.5, 0.0, 1.0), DVec3::new(0.0, 2.0, 1.0)];
    let body = MeshTree::new(TriMesh::try_new(corners.clone(), vec![[0, 1, 2]]).unwrap());
    let spin = DVec3::Z * 0.25;
    let turning = ConstantTwist::REST.with_angular_velocity(spin);
    let options = QueryOptions::default();
    for (a, b, side) in [(turning, ConstantTwist::REST, Side::A), (ConstantTwist::REST, turning, Side::B)] {
        let scene = MovingScene::new((&body, a), (&body, b), Window::UNIT, &options);
        let frame = scene.relative_motion(0.0).frame::<F64x4>(0.0);
        let paths = super::paths::BodyPaths::new(&scene, &frame, side, 1.0);
        for (corner, expected) in corners.iter().zip([0.0, 0.5, 2.0]) {
            let path = paths.of(corner - body.center());
            let bend = paths.turn(DVec3::X) * path.bend;
            assert!((bend - 0.5 * 0.0625 * expected).abs() < 1e-9, "{bend} {expected}");
            assert!(paths.turn(DVec3::Z) < 1e-9);
        }
    }
}

#[test]
fn boxes_reach_as_far_as_their_vertices() {
    let mut random = KnuthRandom(29);
    let (a, b) = (soup(&mut random, DVec3::ZERO), soup(&mut random, DVec3::ZERO));
    let twist =
        ConstantTwist::try_new(random.vector(), random.moderate_turn(), random.vector(), random.vector())
            .unwrap();
    let options = QueryOptions::default();
    let scene =
        MovingScene::try_new(moving(&a, twist), moving(&b, ConstantTwist::REST), Window::UNIT, &options)
            .unwrap();
    let frame: Frame = scene.relative_motion(0.0).frame::<F64x4>(0.0);
    for n in [DVec3::X, random.vector().normalize(), random.vector().normalize()] {
        let [of_a, of_b] = vertices(&scene);
        let points = [&of_a.points, &of_b.points];
        let moving = Moving::new(&scene, points, &frame, 0.25, &mut Meter::unlimited()).unwrap();
        let mut reach_a = Reaches::new(&scene.a, &of_a.places, moving.reaches(Side::A, n));
        let mut reach_b = Reaches::new(&scene.b, &of_b.places, moving.reaches(Side::B, n));
        let (high, low) = (
            reach_a.measure(0, &mut Meter::unlimited()).unwrap(),
            reach_b.measure(0, &mut Meter::unlimited()).unwrap(),
        );
        for end in 0..2 {
            assert_eq!(moving.gaps(n)[end].along, -low[end] - high[end]);
        }
    }
}

/// What a crowd costs besides directions ends with the time too: places of its vertices, and how far boxes reach.
#[test]
fn preparations_end_with_the_time() {
    let mut random = KnuthRandom(3);
    let vertices: Vec<_> = (0..3000).map(|_| random.vector()).collect();
    let tree = MeshTree::new(Surface::soup(vertices.clone()).into_mesh(TriMesh::try_new));
    let rest = ConstantTwist::REST;
    let scene = MovingScene::try_new(
        moving(&tree, rest),
        moving(&tree, rest),
        Window::UNIT,
        &QueryOptions::default(),
    )
    .unwrap();
    let points = [vertices.clone(), vertices];
    let frame = scene.relative_motion(0.0).frame::<F64x4>(0.0);
    let over = || Meter::until(Stop::new(&Budget::UNLIMITED.with_wall_clock(Duration::ZERO)));
    assert!(Moving::new(&scene, points.each_ref(), &frame, 0.25, &mut over()).is_none());
    let moving = Moving::new(&scene, points.each_ref(), &frame, 0.25, &mut Meter::unlimited()).unwrap();
    let mut places = Places::none();
    assert!((0..3000).all(|vertex| places.insert_last(vertex, vertex as usize + 1)));
    let mut reaches = Reaches::new(&scene.a, &places, moving.reaches(Side::A, DVec3::X));
    assert_eq!(reaches.measure(0, &mut over()), None);
    assert!(reaches.measure(0, &mut Meter::unlimited()).is_some());
}

/// Vertices are gathered for a plane once the search has done about as much as that costs, not before.
#[test]
fn a_crowd_costs_no_more_than_the_search_before() {
    let mut random = KnuthRandom(41);
    let vertices: Vec<_> = (0..3000).map(|_| random.vector()).collect();
    let tree = MeshTree::new(Surface::soup(vertices.clone()).into_mesh(TriMesh::try_new));
    let (rest, options) = (ConstantTwist::REST, QueryOptions::default());
    let scene =
        MovingScene::try_new(moving(&tree, rest), moving(&tree, rest), Window::UNIT, &options).unwrap();
    let mut scratch = Scratch::new();
    let mut search = Search::new(&scene, &options, &mut scratch);
    let state = search.begin_window(SubWindow { start: 0.0, end: 1.0 });
    search.scratch.queue.push(state.expander.root());
    for (work, is_enough) in [(1500, false), (2999, false), (3000, true)] {
        search.scratch.counts.node_tests = work;
        let crowd = search.crowd(&state, &[], &mut Meter::unlimited());
        assert_eq!(crowd.is_some(), is_enough, "{work}");
        assert!(crowd.is_none_or(|crowd| crowd.points().iter().all(|points| points.len() == vertices.len())));
    }
}

/// Two soups in one place, which no plane parts: that is found by the shortest time alone, and the next attempt waits until the search has
/// done as much as all of this once more.
#[test]
fn a_crowd_that_no_plane_parts_costs_one_attempt() {
    let mut random = KnuthRandom(43);
    let vertices: Vec<_> = (0..300).map(|_| random.vector()).collect();
    let tree = MeshTree::new(Surface::soup(vertices).into_mesh(TriMesh::try_new));
    let (rest, options) = (ConstantTwist::REST, QueryOptions::default());
    let scene =
        MovingScene::try_new(moving(&tree, rest), moving(&tree, rest), Window::UNIT, &options).unwrap();
    let mut scratch = Scratch::new();
    let mut search = Search::new(&scene, &options, &mut scratch);
    let mut state = search.begin_window(SubWindow { start: 0.0, end: 1.0 });
    search.scratch.queue.push(state.expander.root());
    search.scratch.counts.node_tests = 1000;
    let crowd = search.crowd(&state, &[], &mut Meter::unlimited()).unwrap();
    let whole = state.limit;
    let mut cost_until = |limit: u32| {
        state.limit = limit;
        let before = search.work();
        let clock = &mut Meter::unlimited();
        assert_eq!(search.advance_together::<Portable>(&state, 0, (&crowd, u64::MAX / 2), clock), 0);
        search.work() - before
    };
    // Of one step there is one length of time.
    let (one, all) = (cost_until(1), cost_until(whole));
    assert!(one > 0 && all <= 2 * one, "{one} {all}");
    let mut patience = Patience::new(0, 1);
    patience.rest_after(&search, 1000, Planes::PartNothing);
    assert_eq!(patience.rest_until, 2 * search.work());
}

/// Of two soups in one place some pairs show that no plane parts them; of two that are apart, or come together as a whole, they do not.
#[test]
fn some_pairs_show_whether_planes_part_a_crowd() {
    let mut random = KnuthRandom(47);
    let vertices: Vec<_> = (0..300).map(|_| random.vector()).collect();
    let tree = MeshTree::new(Surface::soup(vertices).into_mesh(TriMesh::try_new));
    let options = QueryOptions::default();
    let leaves = |tree: &MeshTree| -> Vec<u32> {
        let boxes = tree.nodes().iter().enumerate();
        let leaf = |(k, node): (usize, &WideNode)| {
            let lanes =
                (0..node.used as usize).filter(|&lane| matches!(node.below(lane), Below::Triangle(_)));
            lanes.map(|lane| (WIDTH * k + lane) as u32).collect::<Vec<_>>()
        };
        boxes.flat_map(leaf).collect()
    };
    for (x, speed, may_part) in [(0.0, 0.0, false), (0.5, 0.0, false), (4.0, 0.0, true), (2.5, -4.0, true)] {
        let motion = ConstantTwist::REST.with_position(DVec3::X * x).with_linear_velocity(DVec3::X * speed);
        let bodies = [moving(&tree, motion), moving(&tree, ConstantTwist::REST)];
        let scene = MovingScene::try_new(bodies[0], bodies[1], Window::UNIT, &options).unwrap();
        let mut scratch = Scratch::new();
        let mut search = Search::new(&scene, &options, &mut scratch);
        let state = search.begin_window(SubWindow { start: 0.0, end: 1.0 });
        for a in leaves(&tree) {
            for b in leaves(&tree) {
                search.scratch.queue.push(Item { key: 0, boxes: [a, b], next: Item::TRIANGLES });
            }
        }
        assert_eq!(search.scratch.queue.len(), 10_000);
        let clock = &mut Meter::unlimited();
        let may = search.planes_may_part::<Portable>(&state, 0, &[], clock);
        assert_eq!(may, may_part, "{x} {speed}");
        assert!(clock.spent() < 2000, "{}", clock.spent());
    }
}
