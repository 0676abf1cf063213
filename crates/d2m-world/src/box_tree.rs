//! The broad phase of worlds and simulations: a binary tree of axis-aligned boxes over the boxes of bodies, refitted as long as it is good.

use crate::Aabb;

/// A pair of boxes by their numbers, the smaller first.
pub(crate) type IndexPair = [u32; 2];

/// Boxes in a leaf on average, at most: comparing four boxes takes as long as descending one level.
const LEAF: usize = 4;
/// A refitted tree is built anew when its boxes are so many times as long, in all, as when it was built (both against the
/// boxes of the bodies).
const WORN: f64 = 1.5;
/// Comparing two boxes takes about a nanosecond, building a tree so many for each body.
const BUILD: usize = 128;

/// A tree over the boxes of many bodies: which of them may meet.
///
/// It keeps an order of the boxes, not the boxes themselves, so that it is fitted to boxes that move: [`BoxTree::fit`] where all may have,
/// [`BoxTree::refit`] where some have. Never leaves out a pair that may meet: what is dropped is proven apart along one axis. Empty boxes meet
/// nothing. For boxes each of which meets a few others all pairs take n log n steps.
///
/// ```
/// use d2m_world::{Aabb, BoxTree};
/// use glam::DVec3;
/// let at = |x: f64| Aabb { low: DVec3::X * x, high: DVec3::X * x + DVec3::ONE };
/// let mut boxes = vec![at(0.0), at(0.5), at(9.0)];
/// let mut tree = BoxTree::default();
/// tree.fit(&boxes);
/// let mut pairs = Vec::new();
/// tree.pairs(&boxes, 0.0, |pair| pairs.push(pair));
/// assert_eq!(pairs, [[0, 1]]);
/// boxes[2] = at(1.25);
/// tree.refit(&boxes, &[2]);
/// pairs.clear();
/// tree.pairs_of(&boxes, 2, 0.0, |pair| pairs.push(pair));
/// assert_eq!(pairs, [[1, 2]]);
/// ```
// A complete binary tree. Its boxes hold those of the bodies in a range of `order`; the tree's shape follows from their number.
#[derive(Clone, Debug, Default)]
pub struct BoxTree {
    /// The bodies, in the order of the leaves.
    order: Vec<u32>,
    /// Where each body is in the order.
    place: Vec<u32>,
    /// Box 1 is the root; 2k and 2k + 1 are below k. The second half are the leaves.
    bounds: Vec<Aabb>,
    /// Total length of the boxes when the tree was built, against those of the bodies.
    length: f64,
    /// Comparisons that bodies outside of the tree have cost since it was built.
    outside: usize,
}

impl BoxTree {
    /// All boxes may be others than before: keeps the order of the bodies if the tree is still good.
    pub fn fit(&mut self, boxes: &[Aabb]) {
        if self.order.len() == boxes.len() && !boxes.is_empty() {
            self.refit_all(boxes);
            // What is not a number is no reason to keep the tree.
            if self.relative_length(boxes) <= WORN * self.length {
                return;
            }
        }
        self.build(boxes);
    }

    /// Some boxes have changed. Bodies that were added are outside of the tree until there are many.
    pub fn refit(&mut self, boxes: &[Aabb], changed: &[u32]) {
        self.outside += changed.len() * (boxes.len() - self.order.len().min(boxes.len()));
        if self.outside > BUILD * boxes.len() {
            self.build(boxes);
        } else if changed.len() * self.levels() > self.order.len() {
            self.refit_all(boxes);
        } else {
            for &body in changed {
                if let Some(&place) = self.place.get(body as usize) {
                    self.refit_above(boxes, place);
                }
            }
        }
    }

    /// Calls `found` for every pair of boxes that may come within `separation`, each once, the smaller number first, in any order. The tree
    /// was fitted to these boxes, all of them.
    pub fn pairs(&self, boxes: &[Aabb], separation: f64, mut found: impl FnMut(IndexPair)) {
        let mut open = Vec::new();
        let sorted: Vec<Aabb> = self.order.iter().map(|&body| boxes[body as usize]).collect();
        for leaf in self.leaves()..self.bounds.len() {
            let own = self.range(leaf);
            open.push(1);
            while let Some(k) = open.pop() {
                // Pairs with a body before in the order are found from that one.
                let range = self.range(k);
                if range.end <= own.start || !self.bounds[k].may_meet(&self.bounds[leaf], separation) {
                    continue;
                }
                if k < self.leaves() {
                    open.extend([2 * k + 1, 2 * k]);
                    continue;
                }
                for i in own.clone() {
                    for j in range.start.max(i + 1)..range.end {
                        let (a, b) = (&sorted[i], &sorted[j]);
                        if a.may_meet(b, separation) && !a.is_empty() && !b.is_empty() {
                            found(ordered(self.order[i], self.order[j]));
                        }
                    }
                }
            }
        }
    }

    /// The boxes that may come within `separation` of box `i`, each as a pair, in any order.
    pub fn pairs_of(&self, boxes: &[Aabb], i: u32, separation: f64, mut found: impl FnMut(IndexPair)) {
        let own = &boxes[i as usize];
        if own.is_empty() {
            return;
        }
        let mut compare = |j: u32| {
            let other = &boxes[j as usize];
            if own.may_meet(other, separation) && j != i && !other.is_empty() {
                found(ordered(i, j));
            }
        };
        let mut open = if self.bounds.is_empty() { Vec::new() } else { vec![1] };
        while let Some(k) = open.pop() {
            if !self.bounds[k].may_meet(own, separation) {
                continue;
            }
            if k < self.leaves() {
                open.extend([2 * k + 1, 2 * k]);
            } else {
                self.order[self.range(k)].iter().for_each(|&j| compare(j));
            }
        }
        (self.order.len() as u32..boxes.len() as u32).for_each(compare);
    }

    /// How many leaves there are: a power of two.
    fn leaves(&self) -> usize {
        self.bounds.len() / 2
    }

    fn levels(&self) -> usize {
        self.bounds.len().max(1).ilog2() as usize
    }

    /// The part of the order below a box.
    fn range(&self, k: usize) -> core::ops::Range<usize> {
        let level = k.ilog2();
        let start = |k: usize| ((k - (1 << level)) * self.order.len()) >> level;
        start(k)..start(k + 1)
    }

    fn build(&mut self, boxes: &[Aabb]) {
        let leaves = boxes.len().div_ceil(LEAF).next_power_of_two();
        let count = if boxes.is_empty() { 0 } else { 2 * leaves };
        self.order = (0..boxes.len() as u32).collect();
        self.bounds = vec![Aabb::EMPTY; count];
        self.outside = 0;
        let centers: Vec<_> = boxes.iter().map(|swept| swept.low + swept.high).collect();
        for k in 1..self.leaves() {
            let (range, middle) = (self.range(k), self.range(2 * k).end);
            let part = &mut self.order[range.clone()];
            let low = part.iter().fold(glam::DVec3::INFINITY, |low, &body| low.min(centers[body as usize]));
            let high =
                part.iter().fold(glam::DVec3::NEG_INFINITY, |high, &body| high.max(centers[body as usize]));
            // Any order is right; along the axis on which the centers are spread most it is a good one.
            let spread = high - low;
            let axis = (0..3).max_by(|&i, &j| spread[i].total_cmp(&spread[j])).unwrap_or(0);
            let along = |body: u32| centers[body as usize][axis];
            if middle > range.start && middle < range.end {
                part.select_nth_unstable_by(middle - range.start, |&i, &j| {
                    along(i).total_cmp(&along(j)).then(i.cmp(&j))
                });
            }
        }
        self.place = vec![0; boxes.len()];
        for (place, &body) in self.order.iter().enumerate() {
            self.place[body as usize] = place as u32;
        }
        self.refit_all(boxes);
        self.length = self.relative_length(boxes);
    }

    fn refit_all(&mut self, boxes: &[Aabb]) {
        for k in (1..self.bounds.len()).rev() {
            self.bounds[k] = self.bound(boxes, k);
        }
    }

    /// The boxes that hold the body at this place of the order.
    fn refit_above(&mut self, boxes: &[Aabb], place: u32) {
        // Of the leaves the last one that does not begin behind the place.
        let (mut low, mut high) = (self.leaves(), self.bounds.len());
        while high - low > 1 {
            let middle = low.midpoint(high);
            if self.range(middle).start <= place as usize { low = middle } else { high = middle }
        }
        let mut k = low;
        while k > 0 {
            self.bounds[k] = self.bound(boxes, k);
            k /= 2;
        }
    }

    fn bound(&self, boxes: &[Aabb], k: usize) -> Aabb {
        if k < self.leaves() {
            return self.bounds[2 * k].joined(&self.bounds[2 * k + 1]);
        }
        let bodies = self.order[self.range(k)].iter();
        bodies.fold(Aabb::EMPTY, |bound, &body| bound.joined(&boxes[body as usize]))
    }

    /// Total length of the boxes of the tree against those of the bodies.
    fn relative_length(&self, boxes: &[Aabb]) -> f64 {
        let sum = |boxes: &[Aabb]| -> f64 {
            boxes.iter().filter(|b| !b.is_empty()).map(|b| (b.high - b.low).element_sum()).sum()
        };
        sum(&self.bounds) / sum(boxes)
    }
}

fn ordered(i: u32, j: u32) -> IndexPair {
    [i.min(j), i.max(j)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DVec3;

    fn cube(center: DVec3, half: f64) -> Aabb {
        Aabb { low: center - half, high: center + half }
    }

    fn sorted(mut pairs: Vec<IndexPair>) -> Vec<IndexPair> {
        pairs.sort_unstable();
        pairs
    }

    fn all_pairs(tree: &BoxTree, boxes: &[Aabb], separation: f64) -> Vec<IndexPair> {
        let mut pairs = Vec::new();
        tree.pairs(boxes, separation, |pair| pairs.push(pair));
        sorted(pairs)
    }

    fn brute_force(boxes: &[Aabb], separation: f64) -> Vec<IndexPair> {
        let mut all = Vec::new();
        for i in 0..boxes.len() {
            for j in i + 1..boxes.len() {
                if boxes[i].may_meet(&boxes[j], separation) && !boxes[i].is_empty() && !boxes[j].is_empty() {
                    all.push([i as u32, j as u32]);
                }
            }
        }
        all
    }

    /// Boxes that stay, that change, that come and go, that are unbounded or no numbers.
    #[test]
    fn finds_exactly_the_pairs_that_brute_force_finds() {
        let mut random = KnuthRandom(0x9e37_79b9_7f4a_7c15);
        let mut tree = BoxTree::default();
        let mut boxes: Vec<Aabb> = Vec::new();
        for round in 0..600usize {
            let separation = [0.0, 0.3][round % 2];
            let mut changed = Vec::new();
            let one = |random: &mut KnuthRandom| match random.index(40) {
                0 => Aabb::EMPTY,
                1 => Aabb { low: DVec3::NEG_INFINITY, high: DVec3::INFINITY },
                2 => Aabb { low: DVec3::NAN, high: DVec3::NAN },
                3 => Aabb { low: DVec3::ZERO, high: DVec3::new(1.0, f64::NAN, 2.0) },
                _ => cube(random.vector() * 10.0, random.unit() * 1.5 + 0.01),
            };
            for _ in 0..random.index(4) {
                changed.push(boxes.len() as u32);
                boxes.push(one(&mut random));
            }
            for _ in 0..random.index([2, 9, 200][round % 3]).min(boxes.len()) {
                let i = random.index(boxes.len());
                boxes[i] = one(&mut random);
                changed.push(i as u32);
            }
            match round % 5 {
                0 => {
                    for b in &mut boxes {
                        *b = one(&mut random);
                    }
                    tree.fit(&boxes);
                }
                1 => tree.fit(&boxes),
                _ => tree.refit(&boxes, &changed),
            }
            let all = brute_force(&boxes, separation);
            let mut one_by_one = Vec::new();
            for i in 0..boxes.len() as u32 {
                tree.pairs_of(&boxes, i, separation, |pair| one_by_one.push(pair));
            }
            let mut twice = [&all[..], &all[..]].concat();
            twice.sort_unstable();
            assert_eq!(sorted(one_by_one), twice, "round {round}");
            if round % 5 < 2 {
                assert_eq!(all_pairs(&tree, &boxes, separation), all, "round {round}");
            }
            if boxes.len() > 150 {
                boxes.truncate(random.index(150));
                tree.fit(&boxes);
            }
        }
    }

    #[test]
    fn touching_boxes_are_kept_and_a_separation_is_rounded_up() {
        let boxes = [cube(DVec3::ZERO, 1.0), cube(DVec3::X * 2.0, 1.0), cube(DVec3::X * 50.0, 1.0)];
        let mut tree = BoxTree::default();
        tree.fit(&boxes);
        assert_eq!(all_pairs(&tree, &boxes, 0.0), [[0, 1]]);
        assert_eq!(all_pairs(&tree, &boxes, 46.0), [[0, 1], [1, 2]]);
        assert_eq!(all_pairs(&tree, &boxes, 45.9), [[0, 1]]);
        tree.fit(&[]);
        assert!(all_pairs(&tree, &[], 0.0).is_empty());
    }
}
