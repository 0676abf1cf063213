//! Pairs with many contacts of which only a few press, as of a pin in its hole: those few are solved, and others are added where needed.

use super::accuracy::Accuracy;
use super::block::Block;
use super::newton::Start;
use super::solve::GROSS;
use super::system::System;

/// The most blocks of one pair that are added in a round: those with the largest residuals.
const ADDED: usize = 6;
/// Rounds after which all blocks are solved at once.
const MOST_ROUNDS: u32 = 16;

impl System {
    /// Solves the blocks that have impulses or large residuals, adds blocks whose residuals are large then, and so on until there are none. The blocks
    /// left out have no impulse and need none. Returns the residual of all blocks. None, and nothing changed: blocks were still added in the last
    /// round, or no velocities obey the law, as when a body is crushed (solving a part of its blocks would push it to one side).
    pub(super) fn solve_chosen(&mut self, targets: &[f64], accuracy: Accuracy, start: Start) -> Option<f64> {
        let begun = self.present();
        let mut is_chosen: Vec<bool> = self.impulses.iter().map(|impulse| *impulse != [0.0; 3]).collect();
        for round in 0..MOST_ROUNDS {
            let is_new = self.choose(&mut is_chosen, targets, self.enough(accuracy));
            let residual = self.residual(targets);
            if !is_new && (round > 0 || residual <= self.enough(accuracy)) {
                if residual <= GROSS * accuracy.slow {
                    return Some(residual);
                }
                break;
            }
            let places: Vec<usize> = (0..is_chosen.len()).filter(|&k| is_chosen[k]).collect();
            let of_chosen: Vec<f64> = places.iter().map(|&k| targets[k]).collect();
            let mut part = System {
                bodies: core::mem::take(&mut self.bodies),
                blocks: places.iter().map(|&k| self.blocks[k]).collect(),
                impulses: places.iter().map(|&k| self.impulses[k]).collect(),
                spares: places.iter().filter_map(|&k| self.spares.get(k).copied()).collect(),
                reach: core::mem::take(&mut self.reach),
                factor: self.factor.take(),
                wide: None,
                is_conforming: false,
                has_joints: self.has_joints,
                is_row: self.is_row,
            };
            part.solve(&of_chosen, accuracy, start);
            for (k, impulse) in places.into_iter().zip(&part.impulses) {
                self.impulses[k] = *impulse;
            }
            (self.bodies, self.reach, self.factor) = (part.bodies, part.reach, part.factor);
        }
        self.take_back(begun);
        None
    }

    /// Adds blocks whose natural map is greater than this. True: there are some.
    fn choose(&self, is_chosen: &mut [bool], targets: &[f64], most: f64) -> bool {
        let of_pair = |x: &Block, y: &Block| (x.a, x.b) == (y.a, y.b);
        let (mut first, mut found) = (0, false);
        for blocks in self.blocks.chunk_by(of_pair) {
            let all = first..first + blocks.len();
            first = all.end;
            let off = |k: usize| (self.own_residual(k, targets[k]), k);
            let mut far: Vec<(f64, usize)> =
                all.filter(|&k| !is_chosen[k]).map(off).filter(|far| far.0 > most).collect();
            found |= !far.is_empty();
            far.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
            for &(_, k) in far.iter().take(ADDED) {
                is_chosen[k] = true;
            }
        }
        found
    }
}
