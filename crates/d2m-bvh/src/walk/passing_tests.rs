//! Boxes that are said to pass each other are apart all the time, by certified distances of their triangles.

use super::tests::{EXPANDED, moving, soup};
use crate::pair::boxes::entry_time::entry_times;
use crate::pair::boxes::node_test::{NodeFrame, Placed};
use crate::pair::scene::MovingScene;
use crate::pair::triangles::separating_axis::place_a;
use crate::{MeshTree, QueryOptions, TriMesh, Window};
use d2m_feature::triangle_distance;
use d2m_lanes::{F64x4, Lanes, Portable};
use d2m_mesh::node::{NodeBox, WIDTH};
use d2m_motion::ConstantTwist;
use d2m_testing::KnuthRandom;
use glam::DVec3;

/// Times at which distances are computed: both ends of the span, and between.
const TIMES: usize = 24;

/// The boxes of a node of each body, the nodes of `side` expanded.
struct Boxes<'a> {
    scene: &'a MovingScene<'a>,
    side: usize,
}

/// Until when the boxes of a node are apart from a single one, without and with the test for passing, in units of time.
struct Apart {
    usual: [f32; WIDTH],
    passing: [f32; WIDTH],
    left: f32,
    unit: f64,
}

impl Boxes<'_> {
    fn trees(&self) -> [&MeshTree; 2] {
        let (a, b) = (self.scene.a.tree, self.scene.b.tree);
        if self.side == 0 { [a, b] } else { [b, a] }
    }

    /// A node of the expanded body, and a box of the other one.
    fn apart(&self, node: usize, index: usize) -> Apart {
        let (scene, [wide, single]) = (self.scene, self.trees());
        let unit = 2f64.powf(scene.longest.log2().ceil());
        let left = (scene.longest / unit) as f32;
        let scale = scene.node_scales(unit)[self.side];
        let frame = scene.relative_motion(0.0).frame::<F64x4>(0.0);
        let mut node_frame = NodeFrame::new::<F64x4>(&frame, &scale, EXPANDED[self.side], left);
        let mut times = || {
            let box_of = NodeBox::new(single.nodes(), index as u32);
            let placed = Placed::new::<Portable>(&node_frame, &scale, box_of, &wide.nodes()[node]);
            let times = entry_times::<Portable>(&wide.nodes()[node], &placed, &scale).store();
            node_frame.passing = Some(left);
            times
        };
        Apart { usual: times(), passing: times(), left, unit }
    }

    /// The least distance of a triangle of the expanded body and one of the other over the level, over a part of the time.
    fn least_ratio(&self, wide: u32, single: u32, until: f64) -> f64 {
        let (a, b) = if self.side == 0 { (wide, single) } else { (single, wide) };
        let scene = self.scene;
        let motion = scene.relative_motion(0.0);
        let at = |step: usize| {
            let frame = motion.frame::<F64x4>(until * step as f64 / TIMES as f64);
            triangle_distance(&place_a::<F64x4>(&frame, &scene.a.corners(a)), &scene.b.corners(b)).lower
        };
        (0..=TIMES).map(at).fold(f64::INFINITY, f64::min) / scene.pair.level
    }
}

#[test]
fn boxes_that_pass_each_other_are_apart_all_the_time() {
    let mut random = KnuthRandom(51);
    let (mut passed, mut least) = (0, f64::INFINITY);
    let options = QueryOptions::default().with_tolerance(0.01);
    for round in 0..900 {
        let (a, b) = (soup(&mut random), soup(&mut random));
        let (speed, spin) = ([1.0, 3.0, 30.0][round % 3], [0.0, 1.0, 10.0][round / 3 % 3]);
        let motions = [moving(&mut random, 1.5, speed, spin), moving(&mut random, 0.0, speed, spin)];
        let scene = MovingScene::new((&a, motions[0]), (&b, motions[1]), Window::UNIT, &options);
        for side in 0..2 {
            let boxes = Boxes { scene: &scene, side };
            let [wide, single] = boxes.trees();
            for index in (0..WIDTH).map(|lane| WIDTH + lane) {
                let Apart { usual, passing, left, unit } = boxes.apart(1, index);
                for lane in 0..WIDTH {
                    // Times that end before the window are judged, too.
                    let until = passing[lane];
                    if until.is_nan() || until <= 0.0 {
                        continue;
                    }
                    passed += u32::from(passing[lane] == f32::INFINITY && usual[lane] < 0.9 * left);
                    let of_wide = wide.nodes()[1].triangle(lane);
                    let of_single = single.nodes()[1].triangle(index % WIDTH);
                    least =
                        least.min(boxes.least_ratio(of_wide, of_single, f64::from(until.min(left)) * unit));
                }
            }
        }
    }
    assert!(passed > 1000, "{passed}");
    assert!((1.0..1.2).contains(&least), "{least}");
}

/// A small triangle on a long arm turns towards another one, which its way would pass by 1 − cos 0.3 if it were straight.
#[test]
fn what_bends_towards_a_box_does_not_pass_it() {
    let tree = |middle: DVec3| {
        let corners = [DVec3::ZERO, DVec3::Y, DVec3::Z].map(|corner| middle + corner * 1e-4);
        MeshTree::new(TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2]]).unwrap())
    };
    let spin = ConstantTwist::REST.with_angular_velocity(DVec3::Z);
    let options = QueryOptions::default().with_tolerance(1e-7);
    let window = Window::try_new(0.0, 0.3).unwrap();
    let mut passed = 0;
    for step in 0..24 {
        let beside = 1e-3 * f64::from(step);
        let (a, b) = (tree(DVec3::X), tree(DVec3::new(0.3f64.cos() - beside, 0.3f64.sin(), 0.0)));
        let scene = MovingScene::new((&a, spin), (&b, ConstantTwist::REST), window, &options);
        for side in 0..2 {
            let boxes = Boxes { scene: &scene, side };
            let Apart { passing, left, unit, .. } = boxes.apart(0, 0);
            let ratio = boxes.least_ratio(0, 0, f64::from(passing[0].min(left)) * unit);
            assert!(ratio >= 1.0, "{beside}: {ratio}");
            passed += u32::from(passing[0] == f32::INFINITY);
        }
    }
    assert!(passed > 20, "{passed}");
}

/// A small triangle slides along a needle towards its tip, away from its middle, and comes down on it before it is past the tip.
#[test]
fn what_comes_down_on_a_needle_does_not_pass_it() {
    let tree =
        |corners: [DVec3; 3]| MeshTree::new(TriMesh::try_new(corners.to_vec(), vec![[0, 1, 2]]).unwrap());
    let needle = tree([-DVec3::X, DVec3::X, DVec3::Z * 1e-3]);
    let small = tree([DVec3::ZERO, DVec3::X, DVec3::Z].map(|corner| corner * 1e-3));
    let options = QueryOptions::default().with_tolerance(0.01);
    let mut passed = 0;
    for step in 0..24 {
        let falling = DVec3::new(0.5, -0.004 * f64::from(step), 0.0);
        let slides =
            ConstantTwist::REST.with_position(DVec3::new(0.6, 0.03, 0.0)).with_linear_velocity(falling);
        let scene =
            MovingScene::new((&small, slides), (&needle, ConstantTwist::REST), Window::UNIT, &options);
        for side in 0..2 {
            let boxes = Boxes { scene: &scene, side };
            let Apart { passing, left, unit, .. } = boxes.apart(0, 0);
            let ratio = boxes.least_ratio(0, 0, f64::from(passing[0].min(left)) * unit);
            assert!(ratio >= 1.0, "{falling}: {ratio}");
            passed += u32::from(passing[0] == f32::INFINITY);
        }
    }
    assert!(passed > 4, "{passed}");
}
