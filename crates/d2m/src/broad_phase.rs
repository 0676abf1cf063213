//! Sweep and prune over the boxes that the bodies sweep.

use crate::Body;
use d2m_bvh::Window;
use d2m_interval::{Interval, IntervalVec3};
use glam::DVec3;

/// An axis-aligned box, world frame, that a body never leaves over a window.
///
/// ```text
/// centre path over the window ⊕ ball of the body's radius
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SweptBox {
    bounds: IntervalVec3,
}

impl SweptBox {
    /// Encloses every point of `body` at every time of `window`, grown by `margin` on all sides.
    pub(crate) fn enclose(body: &Body, window: Window, margin: f64) -> Self {
        let pose = body.motion().enclose_pose(Interval::new(window.start(), window.end()));
        let reach = Interval::point(body.tree().radius()) + margin;
        let grow = Interval::new(-reach.hi(), reach.hi());
        let center = pose.enclose_point(body.tree().center());
        Self { bounds: center + IntervalVec3 { x: grow, y: grow, z: grow } }
    }

    /// Can the two boxes share a point? Answers yes when it cannot be excluded.
    fn may_meet(&self, other: &Self) -> bool {
        let apart = |a: Interval, b: Interval| a.hi() < b.lo() || b.hi() < a.lo();
        let (a, b) = (&self.bounds, &other.bounds);
        !(apart(a.x, b.x) || apart(a.y, b.y) || apart(a.z, b.z))
    }

    /// The axis along which the boxes are spread most.
    fn sweep_axis(boxes: &[Self]) -> usize {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for middle in boxes.iter().map(|b| b.bounds.mid()) {
            low = low.min(middle);
            high = high.max(middle);
        }
        (high - low).max_position()
    }

    fn axis(&self, axis: usize) -> Interval {
        [self.bounds.x, self.bounds.y, self.bounds.z][axis]
    }
}

/// Every pair of boxes that may meet, each pair once with the smaller number first, in ascending order.
///
/// Never leaves out a pair that meets: bodies whose boxes are proven disjoint along one axis are all that is dropped.
pub(crate) fn candidates(boxes: &[SweptBox]) -> Vec<(usize, usize)> {
    let axis = SweptBox::sweep_axis(boxes);
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&i, &j| boxes[i].axis(axis).lo().total_cmp(&boxes[j].axis(axis).lo()).then(i.cmp(&j)));
    let mut open: Vec<usize> = Vec::new();
    let mut pairs = Vec::new();
    for i in order {
        let start = boxes[i].axis(axis).lo();
        // An end that is not a number compares false and stays open.
        let ended = |j: usize| boxes[j].axis(axis).hi() < start;
        open.retain(|&j| !ended(j));
        pairs.extend(open.iter().filter(|&&j| boxes[i].may_meet(&boxes[j])).map(|&j| (i.min(j), i.max(j))));
        open.push(i);
    }
    pairs.sort_unstable();
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cube(center: DVec3, half: f64) -> SweptBox {
        let side = |c: f64| Interval::new(c - half, c + half);
        SweptBox { bounds: IntervalVec3 { x: side(center.x), y: side(center.y), z: side(center.z) } }
    }

    #[test]
    fn finds_exactly_the_pairs_that_brute_force_finds() {
        let mut seed = 0x9e37_79b9_7f4a_7c15_u64;
        let mut next = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 53) as f64
        };
        for _ in 0..200 {
            let boxes: Vec<_> = (0..24)
                .map(|_| cube(DVec3::new(next(), next(), next()) * 10.0, next() * 1.5 + 0.01))
                .collect();
            let mut all = Vec::new();
            for i in 0..boxes.len() {
                for j in i + 1..boxes.len() {
                    if boxes[i].may_meet(&boxes[j]) {
                        all.push((i, j));
                    }
                }
            }
            assert_eq!(candidates(&boxes), all);
        }
    }

    #[test]
    fn touching_boxes_and_unbounded_boxes_are_kept() {
        let boxes = [cube(DVec3::ZERO, 1.0), cube(DVec3::X * 2.0, 1.0), cube(DVec3::X * 50.0, 1.0)];
        assert_eq!(candidates(&boxes), [(0, 1)]);
        let anywhere = SweptBox {
            bounds: IntervalVec3 { x: Interval::ENTIRE, y: Interval::ENTIRE, z: Interval::ENTIRE },
        };
        assert_eq!(candidates(&[boxes[0], anywhere, boxes[2]]), [(0, 1), (1, 2)]);
        assert!(candidates(&[]).is_empty());
    }
}
