//! Some pairs of a crowd, which show for little whether planes part it.
//!
//! A plane that parts all pairs parts some of them. So where no plane parts a few pairs from all over the crowd, for any time, and the
//! directions that were tried hardly part one by one, its vertices need not be gathered: bodies that interlock, as a screw and its nut.
//! This chooses what is tried, and proves nothing.

use super::moving::{Moving, Separation};
use super::paths::Side;
use super::reaches::Reaches;
use super::{Crowd, rest_of_window};
use crate::walk::queue::Item;
use crate::walk::state::{Search, State};
use d2m_lanes::Lanes;
use d2m_mesh::Meter;
use d2m_mesh::node::{Below, WIDTH, WideNode};
use glam::DVec3;

/// How many pairs are examined.
const PAIRS: usize = 64;
/// Directions part a crowd one by one where they part one in so many of its pairs: fewer leave a crowd.
const ONE_IN: usize = 2;

/// Work after which no further plane is tried.
const ONE_PLANE: u64 = 1;

impl Search<'_> {
    /// Whether planes may be of use for the pairs that wait; true where that is not to be seen from a few of them.
    pub(super) fn planes_may_part<L: Lanes>(
        &mut self,
        state: &State<'_>,
        least: u32,
        batch: &[Item],
        clock: &mut Meter,
    ) -> bool {
        let every = ((self.scratch.queue.len() + batch.len()) / PAIRS).max(1);
        let waiting = self.scratch.queue.items().chain(batch).filter(|item| item.key < state.limit);
        let nodes = [self.scene.a.tree.nodes(), self.scene.b.tree.nodes()];
        let leaves =
            |item: &Item| Item { boxes: [0, 1].map(|k| first_leaf(nodes[k], item.boxes[k])), ..*item };
        let items: Vec<Item> = waiting.step_by(every).map(leaves).collect();
        let Some(crowd) = self.gathered(items.iter(), usize::MAX, clock) else { return true };
        let (frame, span) = rest_of_window::<L>(state, f64::from(least) * state.step);
        let Some(moving) = Moving::new(self.scene, crowd.points(), &frame, span, clock) else { return true };
        let mut tried = Vec::new();
        for first in [state.behind.direction, moving.between()].map(DVec3::normalize_or_zero) {
            match self.separation(&moving, (first, crowd.level), &crowd, clock) {
                Separation::Proven { .. } => return true,
                Separation::Unknown { last } => tried.extend([first, last]),
            }
        }
        let parted = self.parted(&moving, &crowd, &tried, &items, clock);
        parted.is_none_or(|parted| ONE_IN * parted > items.len())
            || self.advance_together::<L>(state, least, (&crowd, ONE_PLANE), clock) > least
    }

    /// How many of the pairs one of these directions parts; none: the time is over.
    fn parted(
        &self,
        moving: &Moving<'_>,
        crowd: &Crowd,
        directions: &[DVec3],
        items: &[Item],
        clock: &mut Meter,
    ) -> Option<usize> {
        let mut is_parted = vec![false; items.len()];
        for &n in directions.iter().filter(|&&n| n != DVec3::ZERO) {
            let [of_a, of_b] = &crowd.vertices;
            let mut a = Reaches::new(&self.scene.a, &of_a.places, moving.reaches(Side::A, n));
            let mut b = Reaches::new(&self.scene.b, &of_b.places, moving.reaches(Side::B, n));
            let need = crowd.level * n.length();
            for (item, is_parted) in items.iter().zip(&mut is_parted) {
                let (high, low) = a.measure(item.boxes[0], clock).zip(b.measure(item.boxes[1], clock))?;
                *is_parted |= (0..2).all(|end| -low[end] - high[end] > need);
            }
        }
        Some(is_parted.into_iter().filter(|&parted| parted).count())
    }
}

/// The first box of a triangle in a box.
fn first_leaf(nodes: &[WideNode], index: u32) -> u32 {
    match nodes[index as usize / WIDTH].below(index as usize % WIDTH) {
        Below::Triangle(_) => index,
        Below::Node(node) => first_leaf(nodes, node * WIDTH as u32),
    }
}
