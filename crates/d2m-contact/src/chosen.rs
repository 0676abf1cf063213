//! Many contacts of one pair, as of a pin in its hole, of which few press: those are solved for, and the others are looked after.

use super::accuracy::Accuracy;
use super::block::Block;
use super::newton::Start;
use super::solve::GROSS;
use super::system::System;

/// Blocks of one pair that are added in a round at most, those that are furthest from their law.
const ADDED: usize = 6;
/// Rounds after which all blocks are solved at once.
const MOST_ROUNDS: u32 = 16;

impl System {
    /// Solves for the blocks that have impulses or are far from their law, adds those that the solution leaves far from it, and so on:
    /// what is left over has no impulse and needs none. The residual is that of all blocks. None: there are always others, or no velocities
    /// obey the law, as of bodies that are crushed, which a choice of blocks would have give way to one side. All is as it was then.
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
