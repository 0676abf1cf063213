//! The error bounds of the node test, and the same bits from every kind of lanes.

use super::axes::Axes;
use super::directions::gap_across_edge;
use super::node_test::{lower_bounds, margin_free_gaps};
use super::placed_box::{Placed, Side};
use crate::margin::UNIT_F32;
use crate::tree::box_pair::{BoxPair, PlacedBox};
use crate::tree::node::{OrientedBox, WideNode};
use crate::tree::slabs::{MOST, PAIRS, STEPS};
use d2m_lanes::three::cross;
use d2m_lanes::{InstructionSet, Lanes, Portable, Task, run, run_on};
use d2m_testing::{Draw, KnuthRandom};
use glam::{DMat3, DVec3};

/// What rounding takes off a distance that is computed in doubles: at most 1e-12 of it, 4500 units in the last place. The margins
/// that the tests are about are of `f32`, a million times as large.
const ROUNDED_UP: f64 = 1.0 + 1e-12;

fn rotation(random: &mut KnuthRandom) -> DMat3 {
    DMat3::from_quat(random.quaternion().normalize())
}

fn oriented_box(random: &mut KnuthRandom, size: f64, spread: f64) -> OrientedBox {
    let axes = rotation(random);
    let narrow = |v: DVec3| [v.x as f32, v.y as f32, v.z as f32];
    let half = random.vector().abs() * size;
    let (first, second) = (narrow(axes.x_axis), narrow(axes.y_axis));
    OrientedBox {
        center: narrow(random.vector() * spread),
        axes: [first, second, cross(&first, &second)],
        half_extent: narrow(half),
        slabs: [[0; 4]; 3],
        // As a built box: the radius is at least each half extent.
        radius: narrow(half)[0].max(narrow(half)[1]).max(narrow(half)[2]),
    }
}

/// A box with any slabs that cut up to `most` steps off its edges.
fn cut_box(random: &mut KnuthRandom, most: f64) -> OrientedBox {
    let slabs = core::array::from_fn(|_| core::array::from_fn(|_| (random.signed().abs() * most) as u8));
    OrientedBox { slabs, ..oriented_box(random, 1.0, 1.0) }
}

/// A node at the origin that holds one box.
fn node_of_one(boxed: &OrientedBox) -> WideNode {
    let mut node = WideNode::empty([0.0; 3], 0);
    node.set_box(0, boxed);
    node.used = 1;
    node
}

/// Where the single body is, in units `ratio` times as large as the node's.
fn side(rotation: &DMat3, offset: DVec3, ratio: f64) -> Side {
    let rotation = [rotation.x_axis, rotation.y_axis, rotation.z_axis];
    Side { rotation, offset, ratio, floor: 0.0, to_work: 1.0 }
}

fn wide(v: [f32; 3]) -> DVec3 {
    DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]))
}

/// Corners of a box: the body is their hull, cut with the sphere.
fn corners(b: &OrientedBox) -> Vec<DVec3> {
    // Points with axis·p = ±h, by the inverse of the rounded axes.
    let m = DMat3::from_cols(wide(b.axes[0]), wide(b.axes[1]), wide(b.axes[2])).transpose().inverse();
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    (0..8)
        .map(|i| {
            wide(b.center) + m * (DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4)) * wide(b.half_extent))
        })
        .collect()
}

#[test]
fn gaps_err_by_less_than_the_margin_and_not_by_much_less() {
    let mut random = KnuthRandom(5);
    let (mut worst, mut worst_of_pairs) = (0.0f64, 0.0f64);
    for round in 0..20_000 {
        let mut node = WideNode::empty([random.signed() as f32, random.signed() as f32, 0.0], 0);
        let spread = [1.0, 1e-3, 1e-1][round % 3];
        let boxes: Vec<_> = (0..8).map(|_| oriented_box(&mut random, spread, spread)).collect();
        for (lane, b) in boxes.iter().enumerate() {
            node.set_box(lane, b);
        }
        node.used = 8;
        let single = oriented_box(&mut random, spread * [1.0, 30.0][round % 2], spread);
        let rotation = rotation(&mut random);
        let offset = wide(node.origin) + random.vector() * 3.0 * spread;
        let side = side(&rotation, offset, 1.0);
        let placed = Placed::new(&side, &single, [0.0; 3], &node);
        let gaps = margin_free_gaps::<Portable>(&node, &placed);
        let b: Vec<DVec3> =
            corners(&single).into_iter().map(|p| rotation * p + offset - wide(node.origin)).collect();
        let scale = UNIT_F32 * placed.margin_scale();
        let pairs =
            BoxPair::<Portable>::new(&node, &PlacedBox { margin: 0.0, ..placed.boxed }).gap(0.0).store();
        for lane in 0..8 {
            let a = corners(&boxes[lane]);
            let line =
                (wide([0, 1, 2].map(|k| placed.boxed.center[k])) - wide(boxes[lane].center)).normalize();
            let [_, second, third] = boxes[lane].axes.map(wide);
            let directions = [second, third, wide(placed.axis(1)), wide(placed.axis(2)), line];
            let greatest = directions.into_iter().map(|n| gap_along(n, &a, &b)).fold(f64::MIN, f64::max);
            if pairs[lane] > 0.0 {
                worst_of_pairs = worst_of_pairs.max((f64::from(pairs[lane]) - greatest) / scale);
            }
            for (index, gap) in gaps.iter().enumerate() {
                let axis =
                    if index < 3 { wide(boxes[lane].axes[index]) } else { wide(placed.axis(index - 3)) };
                let truth = gap_along(axis, &a, &b);
                if gap[lane] > 0.0 {
                    worst = worst.max((f64::from(gap[lane]) - truth) / scale);
                }
            }
        }
    }
    assert!(worst < 29.0 && worst > 1.0, "{worst}");
    assert!(worst_of_pairs < 48.0 && worst_of_pairs > 1.0, "{worst_of_pairs}");
}

/// The gap of two sets of points along a direction.
fn gap_along(n: DVec3, a: &[DVec3], b: &[DVec3]) -> f64 {
    let range = |points: &[DVec3]| {
        let along = points.iter().map(|p| n.dot(*p));
        along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
    };
    let ((low_a, high_a), (low_b, high_b)) = (range(a), range(b));
    (low_b - high_a).max(low_a - high_b)
}

/// Along the five directions of a pair, with all cuts of both boxes.
#[test]
fn gaps_of_pairs_are_below_distances_of_points_and_sometimes_close() {
    let mut random = KnuthRandom(10);
    let mut best = 0.0f64;
    for round in 0..6000 {
        let most = if round % 4 == 0 { 0.0 } else { f64::from(MOST) };
        let [boxed, single] = [(); 2].map(|()| cut_box(&mut random, most));
        let node = node_of_one(&boxed);
        let rotation = rotation(&mut random);
        let offset = random.vector() * 4.0;
        let side = side(&rotation, offset, 1.0);
        let placed = Placed::new(&side, &single, [0.0; 3], &node);
        let gap =
            f64::from(BoxPair::<Portable>::new(&node, &placed.boxed).gap(placed.boxed.margin).store()[0]);
        for _ in 0..50 {
            let p = point_within(&boxed, &mut random);
            let apart = p.distance(rotation * point_within(&single, &mut random) + offset);
            assert!(gap <= apart * ROUNDED_UP, "{gap} {apart}");
            best = best.max(gap / apart);
        }
    }
    assert!(best > 0.9, "{best}");
}

/// A point of the body that a box stands for: in the box, in its sphere, and not in what is cut off its edges.
fn point_within(b: &OrientedBox, random: &mut KnuthRandom) -> DVec3 {
    let m = DMat3::from_cols(wide(b.axes[0]), wide(b.axes[1]), wide(b.axes[2])).transpose().inverse();
    // In half extents: on a face or an edge, mostly.
    let mut q: [f64; 3] = core::array::from_fn(|_| (random.signed() * 2.0).clamp(-1.0, 1.0));
    for (&(i, j), cuts) in PAIRS.iter().zip(&b.slabs) {
        for (edge, &cut) in cuts.iter().enumerate() {
            let sign = |bit: usize| if edge & bit == 0 { 1.0 } else { -1.0 };
            let towards = sign(1) * q[i] + sign(2) * q[j];
            let most = 2.0 - f64::from(cut) / f64::from(STEPS);
            if towards > most {
                q = q.map(|x| x * most / towards);
            }
        }
    }
    let from_center = m * (DVec3::from_array(q) * wide(b.half_extent));
    let within = f64::from(b.radius) / from_center.length();
    wide(b.center) + if within < 1.0 { from_center * within } else { from_center }
}

#[test]
fn bounds_of_boxes_are_below_distances_of_points_and_sometimes_close() {
    let mut random = KnuthRandom(9);
    let (mut best, mut best_of_triangles, mut best_across) = (0.0f64, 0.0f64, 0.0f64);
    for round in 0..6000 {
        let most = if round % 4 == 0 { 0.0 } else { f64::from(MOST) };
        let [boxed, single] = [(); 2].map(|()| cut_box(&mut random, most));
        let node = node_of_one(&boxed);
        let rotation = rotation(&mut random);
        let offset = random.vector() * 6.0;
        let side = side(&rotation, offset, 1.0);
        // Without and with one more direction: any, or the one from center to center.
        let n = match round % 3 {
            0 => DVec3::ZERO,
            1 => random.vector().normalize(),
            _ => offset.normalize(),
        };
        let n = n * (1.0 - 4.0 * UNIT_F32);
        let n = [n.x as f32, n.y as f32, n.z as f32];
        let place = |p: DVec3| rotation * p + offset;
        let placed = Placed::new(&side, &single, [0.0; 3], &node);
        let bound =
            |placed: &Placed, enough: f32| f64::from(lower_bounds::<Portable>(&node, placed, 1.0, enough)[0]);
        // With all directions, and with only those that any pair of boxes gets.
        let of_boxes = placed.with_box_along(n, &single);
        let (most, least) = (bound(&of_boxes, f32::INFINITY), bound(&of_boxes, 0.0));
        assert!(least <= most);
        // A triangle of the single box.
        let corners = [(); 3].map(|()| point_within(&single, &mut random));
        let corners_here = corners.map(place);
        let with_triangle = placed.with_triangle_along(n, &corners_here);
        let across = f64::from(gap_across_edge_alone(&node, &with_triangle.with_longest_edge(&corners_here)));
        let of_triangle = bound(&with_triangle.with_longest_edge(&corners_here), f32::INFINITY);
        for _ in 0..50 {
            let p = point_within(&boxed, &mut random);
            let apart = p.distance(place(point_within(&single, &mut random)));
            assert!(most <= apart * ROUNDED_UP, "{most} {apart}");
            best = best.max(most / apart);
            let (x, y) = (random.signed().abs(), random.signed().abs());
            let q = corners[0].lerp(corners[1], x).lerp(corners[2], y);
            let apart = p.distance(place(q));
            assert!(of_triangle <= apart * ROUNDED_UP, "{of_triangle} {apart}");
            best_of_triangles = best_of_triangles.max(of_triangle / apart);
            best_across = best_across.max(across / apart);
        }
    }
    assert!(best > 0.95 && best_of_triangles > 0.95, "{best} {best_of_triangles}");
    assert!(best_across > 0.8, "{best_across}");
}

/// The single box, its offset or both are up to 2¹²⁷ times as large as the boxes of the node: bounds are numbers that hold.
#[test]
fn bounds_of_boxes_of_unlike_sizes_are_finite_and_hold() {
    let mut random = KnuthRandom(19);
    let mut known = 0;
    for round in 0..12_700 {
        let mut any_box = || OrientedBox {
            slabs: core::array::from_fn(|_| core::array::from_fn(|k| MOST - k as u8)),
            ..oriented_box(&mut random, 1.0, 1.0)
        };
        let (boxed, single) = (any_box(), any_box());
        let node = node_of_one(&boxed);
        let (power, far) = (f64::from(round % 127).exp2(), f64::from(round / 3 % 127).exp2());
        let rotation = rotation(&mut random);
        let offset = random.vector() * power.max(far) * 3.0;
        let side = side(&rotation, offset, power);
        let n = offset.normalize() * (1.0 - 4.0 * UNIT_F32);
        let n = [n.x as f32, n.y as f32, n.z as f32];
        let place = |p: DVec3| rotation * p * power + offset;
        let corners = [(); 3].map(|()| place(point_within(&single, &mut random)));
        let placed = Placed::new(&side, &single, [0.0; 3], &node);
        let triangle = placed.with_triangle_along(n, &corners).with_longest_edge(&corners);
        let apart = point_within(&boxed, &mut random).distance(corners[0]);
        for (placed, enough) in [
            (placed.with_box_along(n, &single), f32::INFINITY),
            (placed.with_box_along(n, &single), 0.0),
            (triangle, f32::INFINITY),
        ] {
            let bound = f64::from(lower_bounds::<Portable>(&node, &placed, 1.0, enough)[0]);
            let holds = bound.is_nan() || (bound < f64::INFINITY && bound <= apart * ROUNDED_UP);
            assert!(holds, "{round}: {bound:e} {apart:e}");
            known += u32::from(bound > 0.0);
        }
    }
    assert!(known > 10_000, "{known}");
}

/// The gap of lane 0 across the triangle's longest edge.
fn gap_across_edge_alone(node: &WideNode, placed: &Placed) -> f32 {
    let axes = Axes::<Portable>::new(node, placed);
    let (corners, edge) = (placed.corners.unwrap(), placed.edge.unwrap());
    gap_across_edge(node, placed, &axes, &corners, &edge).store()[0]
}

struct Kernel<'a>(&'a WideNode, &'a Placed);

impl Task for Kernel<'_> {
    type Output = ([f32; 8], u32);
    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        (
            lower_bounds::<L>(self.0, self.1, 0.25, f32::INFINITY),
            super::node_test::overlaps::<L>(self.0, self.1),
        )
    }
}

#[test]
fn every_kind_of_lanes_gives_the_same_bits() {
    let mut random = KnuthRandom(2);
    for round in 0..500 {
        let mut node = WideNode::empty([0.1, 0.2, 0.3], 0);
        node.used = 8;
        for lane in 0..8 {
            node.set_box(lane, &oriented_box(&mut random, 0.4, 1.0));
        }
        let single = oriented_box(&mut random, 0.5, 1.0);
        let rotation = rotation(&mut random);
        let side = Side { floor: 1e-9, to_work: 0.5, ..side(&rotation, random.vector(), 2.0) };
        let placed = Placed::new(&side, &single, [0.0; 3], &node);
        let placed = if round % 2 == 0 {
            placed.with_box_along([0.3, -0.6, 0.7], &single)
        } else {
            let corners = [(); 3].map(|()| random.vector() * 3.0);
            placed.with_triangle_along([0.3, -0.6, 0.7], &corners).with_longest_edge(&corners)
        };
        let (bounds, bits) = run_on(InstructionSet::Portable, Kernel(&node, &placed));
        let (best_bounds, best_bits) = run(Kernel(&node, &placed));
        assert_eq!(bounds.map(f32::to_bits), best_bounds.map(f32::to_bits));
        assert_eq!(bits, best_bits);
    }
}
