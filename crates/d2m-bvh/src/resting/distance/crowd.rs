//! A crowd, very many node pairs that may be as close as the closest pair: one plane that separates all of them.
//!
//! Where n triangles of one body and m of the other have a vertex each, and these two vertices are the closest points, all n·m
//! pairs are equally far apart; so are copies of a face, and faces that lie parallel. Boxes never prove it: they
//! are wider than what they hold. The vertices below the boxes do: along the direction n of the closest pair let h be the most that
//! n·p is for any vertex p below a box of A, and l the least n·q of one of B; then all triangles below the two boxes are at least
//! l − h apart. A pair for which that is no less than the best distance, up to the width of its enclosure, needs no
//! more search: the lower bound of the answer holds for it, too.

use super::best::EXPECTED_WIDTH;
use super::queue::Queue;
use crate::resting::node_pair::Scene;
use crate::tree::margin::UNIT_F64;
use crate::tree::node::{Below, WIDTH};
use d2m_feature::TriangleDistance;
use glam::DVec3;
use std::collections::HashMap;

/// Drops the pairs that are proven no closer than the best distance less the width that is expected of its enclosure. True:
/// that distance is no more than the width, and all pairs are dropped, also those that may cross.
#[cold]
#[inline(never)]
pub(super) fn drop_beyond_plane(scene: &Scene<'_>, best: &TriangleDistance, queue: &mut Queue) -> bool {
    // The lower bound is zero then, whatever the other pairs are.
    if best.upper <= EXPECTED_WIDTH {
        queue.clear();
        return true;
    }
    // No longer than one.
    let n = best.direction.normalize_or_zero() * (1.0 - 4.0 * UNIT_F64);
    let mut high_of_a = Heights::new(scene, 0, n);
    let mut low_of_b = Heights::new(scene, 1, -n);
    let need = best.upper - EXPECTED_WIDTH + scene.projection;
    queue.retain(|[a, b]| {
        let gap = -low_of_b.most(b) - high_of_a.most(a);
        // Also when it is not a number.
        gap.is_nan() || gap <= need
    });
    false
}

/// How far the vertices below the boxes of one body reach along a direction, computed once for each box.
struct Heights<'a> {
    scene: &'a Scene<'a>,
    body: usize,
    direction: DVec3,
    known: HashMap<u32, f64>,
}

impl<'a> Heights<'a> {
    fn new(scene: &'a Scene<'a>, body: usize, direction: DVec3) -> Self {
        Self { scene, body, direction, known: HashMap::new() }
    }

    fn most(&mut self, index: u32) -> f64 {
        if let Some(&known) = self.known.get(&index) {
            return known;
        }
        let node = &self.scene.trees[self.body].nodes[index as usize / WIDTH];
        let most = match node.below(index as usize % WIDTH) {
            Below::Triangle(triangle) => {
                let [p, q, r] =
                    self.scene.place(self.body, triangle).map(|corner| self.direction.dot(corner));
                p.max(q).max(r)
            }
            Below::Node(below) => {
                let lanes = self.scene.trees[self.body].nodes[below as usize].used;
                let first = below * WIDTH as u32;
                (first..first + lanes).map(|index| self.most(index)).fold(f64::NEG_INFINITY, f64::max)
            }
        };
        self.known.insert(index, most);
        most
    }
}
