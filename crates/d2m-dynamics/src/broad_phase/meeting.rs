//! Which boxes of many meet.

use super::Aabb;
use glam::DVec3;

/// Boxes of a leaf.
const LEAF: usize = 4;

/// A binary tree over boxes: those of a node are `order[first..last]`; children are none, or the next node and `right`.
struct Tree<'b> {
    boxes: &'b [Aabb],
    order: Vec<u32>,
    nodes: Vec<Node>,
}

struct Node {
    hull: Aabb,
    first: u32,
    last: u32,
    right: Option<u32>,
}

/// Calls `found` once for each pair of boxes that may meet, the smaller number first, in some order.
///
/// A tree over the boxes, split at the middle of their order along the longest side of their centers, and descended against itself: for boxes
/// each of which meets a few others n log n steps.
pub(crate) fn meeting(boxes: &[Aabb], mut found: impl FnMut(usize, usize)) {
    if boxes.is_empty() {
        return;
    }
    let mut tree = Tree { boxes, order: (0..boxes.len() as u32).collect(), nodes: Vec::new() };
    tree.build(0, boxes.len());
    let mut stack = vec![(0u32, 0u32)];
    while let Some((i, j)) = stack.pop() {
        let (a, b) = (&tree.nodes[i as usize], &tree.nodes[j as usize]);
        if i == j {
            match a.right {
                Some(right) => stack.extend([(i + 1, i + 1), (right, right), (i + 1, right)]),
                None => tree.compare(a, b, &mut found),
            }
            continue;
        }
        if !a.hull.may_meet(&b.hull) {
            continue;
        }
        match (a.right, b.right) {
            (None, None) => tree.compare(a, b, &mut found),
            (Some(right), None) => stack.extend([(i + 1, j), (right, j)]),
            (None, Some(right)) => stack.extend([(i, j + 1), (i, right)]),
            (Some(of_a), Some(of_b)) => {
                stack.extend([(i + 1, j + 1), (i + 1, of_b), (of_a, j + 1), (of_a, of_b)]);
            }
        }
    }
}

impl Tree<'_> {
    fn build(&mut self, first: usize, last: usize) {
        let center = |i: u32| {
            let b = &self.boxes[i as usize];
            b.low + b.high
        };
        let own = &mut self.order[first..last];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut hull = Aabb { low, high };
        for &i in own.iter() {
            let b = whole(&self.boxes[i as usize]);
            hull = Aabb { low: hull.low.min(b.low), high: hull.high.max(b.high) };
            (low, high) = (low.min(center(i)), high.max(center(i)));
        }
        let node = self.nodes.len();
        self.nodes.push(Node { hull, first: first as u32, last: last as u32, right: None });
        if last - first <= LEAF {
            return;
        }
        let spread = high - low;
        let axis = (1..3).fold(0, |best, axis| if spread[axis] > spread[best] { axis } else { best });
        let half = (last - first) / 2;
        own.select_nth_unstable_by(half, |&i, &j| {
            center(i)[axis].total_cmp(&center(j)[axis]).then(i.cmp(&j))
        });
        self.build(first, first + half);
        self.nodes[node].right = Some(self.nodes.len() as u32);
        self.build(first + half, last);
    }

    fn compare(&self, a: &Node, b: &Node, found: &mut impl FnMut(usize, usize)) {
        let own = |node: &Node| &self.order[node.first as usize..node.last as usize];
        let is_one = a.first == b.first;
        for (k, &i) in own(a).iter().enumerate() {
            for &j in &own(b)[if is_one { k + 1 } else { 0 }..] {
                if self.boxes[i as usize].may_meet(&self.boxes[j as usize]) {
                    found(i.min(j) as usize, i.max(j) as usize);
                }
            }
        }
    }
}

/// A bound that is not a number excludes nothing.
fn whole(b: &Aabb) -> Aabb {
    let or = |value: DVec3, other: DVec3| DVec3::select(value.is_nan_mask(), other, value);
    Aabb { low: or(b.low, DVec3::NEG_INFINITY), high: or(b.high, DVec3::INFINITY) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same as comparing each with each, also boxes that are not numbers.
    #[test]
    fn each_pair_is_found_once() {
        for count in [0, 1, 2, 4, 5, 9, 200] {
            let mut boxes: Vec<Aabb> = (0..count)
                .map(|k| {
                    let at = |n: usize| ((k * 7919 + n * 104_729 + k * k * 31) % 1000) as f64 / 100.0;
                    let (low, size) =
                        (DVec3::new(at(1), at(2), at(3)), DVec3::new(at(4), at(5), at(6)) * 0.2);
                    Aabb { low, high: low + size }
                })
                .collect();
            if count > 100 {
                boxes[17].low.y = f64::NAN;
                boxes[60].high = DVec3::NAN;
                boxes[61] = Aabb { low: DVec3::splat(-50.0), high: DVec3::splat(50.0) };
            }
            let mut found = Vec::new();
            meeting(&boxes, |a, b| found.push((a, b)));
            found.sort_unstable();
            let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
            let expected: Vec<_> = all.filter(|&(a, b)| boxes[a].may_meet(&boxes[b])).collect();
            assert_eq!(found, expected, "{count}");
        }
    }
}
