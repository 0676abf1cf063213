//! Sweep and prune: boxes sorted along the axis on which they are spread most.

use crate::swept_bounds::{SweptBox, round_up_sum};
use glam::DVec3;

/// A pair of boxes by their numbers, the smaller first.
pub(crate) type IndexPair = [u32; 2];

/// The order of the boxes along an axis, kept from one set of boxes to the next: sorting what is nearly in order takes
/// linear time.
#[derive(Clone, Debug, Default)]
pub(crate) struct SweepOrder {
    order: Vec<u32>,
}

impl SweepOrder {
    /// Every pair of boxes that may come within `separation`, each once, in any order. Empty boxes meet nothing.
    ///
    /// Never leaves out a pair that meets: what is dropped is proven apart along one axis.
    pub(crate) fn pairs(&mut self, boxes: &[SweptBox], separation: f64) -> Vec<IndexPair> {
        let axis = widest_axis(boxes);
        let start = |i: u32| boxes[i as usize].low[axis];
        if self.order.len() != boxes.len() {
            self.order = (0..boxes.len() as u32).collect();
        }
        // Stable and adaptive to runs; ends that are not a number sort somewhere and are handled below.
        self.order.sort_by(|&i, &j| start(i).total_cmp(&start(j)));
        let sorted: Vec<SweptBox> = self.order.iter().map(|&i| boxes[i as usize]).collect();
        // A box with an end that is not a number is not excluded by any comparison: it is paired with all.
        let unordered = |b: &SweptBox| b.low.is_nan() || b.high.is_nan();
        let any_unordered = sorted.iter().any(unordered);
        let mut pairs = Vec::new();
        for (at, swept) in sorted.iter().enumerate() {
            let end = round_up_sum(swept.high[axis], separation);
            for (next, other) in sorted.iter().enumerate().skip(at + 1) {
                if other.low[axis] > end && !any_unordered {
                    break;
                }
                if swept.may_meet(other, separation) && !swept.is_empty() && !other.is_empty() {
                    let (i, j) = (self.order[at], self.order[next]);
                    pairs.push([i.min(j), i.max(j)]);
                }
            }
        }
        pairs
    }
}

/// The axis along which the boxes are spread most, against their own size there.
fn widest_axis(boxes: &[SweptBox]) -> usize {
    let (mut low, mut high, mut size) = (DVec3::INFINITY, DVec3::NEG_INFINITY, DVec3::ZERO);
    for swept in boxes.iter().filter(|b| b.low.is_finite() && b.high.is_finite()) {
        low = low.min(swept.low);
        high = high.max(swept.low);
        size += swept.high - swept.low;
    }
    let spread = (high - low) / size;
    // Any axis is right; a spread that is not a number is no reason to choose it.
    (0..3).max_by(|&i, &j| spread[i].total_cmp(&spread[j])).unwrap_or(0)
}

/// The boxes that may come within `separation` of box `i`, each as a pair, in ascending order of the other.
pub(crate) fn pairs_of(boxes: &[SweptBox], i: u32, separation: f64, mut found: impl FnMut(IndexPair)) {
    let own = &boxes[i as usize];
    if own.is_empty() {
        return;
    }
    for (j, other) in boxes.iter().enumerate() {
        let j = j as u32;
        if own.may_meet(other, separation) && j != i && !other.is_empty() {
            found([i.min(j), i.max(j)]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};

    fn cube(center: DVec3, half: f64) -> SweptBox {
        SweptBox { low: center - half, high: center + half }
    }

    fn sorted(mut pairs: Vec<IndexPair>) -> Vec<IndexPair> {
        pairs.sort_unstable();
        pairs
    }

    #[test]
    fn finds_exactly_the_pairs_that_brute_force_finds() {
        let mut random = KnuthRandom(0x9e37_79b9_7f4a_7c15);
        let mut next = || random.unit();
        let mut order = SweepOrder::default();
        for round in 0..200 {
            let mut boxes: Vec<_> = (0..24)
                .map(|_| cube(DVec3::new(next(), next(), next()) * 10.0, next() * 1.5 + 0.01))
                .collect();
            boxes[round % 24] = SweptBox::EMPTY;
            if round % 5 == 0 {
                boxes[3] = SweptBox { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY };
                boxes[4] = SweptBox { low: DVec3::NAN, high: DVec3::NAN };
            }
            let separation = [0.0, 0.3][round % 2];
            let mut all = Vec::new();
            let mut one_by_one = Vec::new();
            for i in 0..boxes.len() {
                for j in i + 1..boxes.len() {
                    if boxes[i].may_meet(&boxes[j], separation)
                        && !boxes[i].is_empty()
                        && !boxes[j].is_empty()
                    {
                        all.push([i as u32, j as u32]);
                    }
                }
                pairs_of(&boxes, i as u32, separation, |pair| one_by_one.push(pair));
            }
            assert_eq!(sorted(order.pairs(&boxes, separation)), all);
            one_by_one.sort_unstable();
            one_by_one.dedup();
            assert_eq!(one_by_one, all);
        }
    }

    #[test]
    fn touching_boxes_are_kept_and_a_separation_is_rounded_up() {
        let boxes = [cube(DVec3::ZERO, 1.0), cube(DVec3::X * 2.0, 1.0), cube(DVec3::X * 50.0, 1.0)];
        let mut order = SweepOrder::default();
        assert_eq!(order.pairs(&boxes, 0.0), [[0, 1]]);
        assert_eq!(sorted(order.pairs(&boxes, 46.0)), [[0, 1], [1, 2]]);
        assert_eq!(order.pairs(&boxes, 45.9), [[0, 1]]);
        assert!(order.pairs(&[], 0.0).is_empty());
    }
}
