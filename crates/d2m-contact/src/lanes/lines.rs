//! Blocks of one row: contacts without friction, joints.

use super::super::block::Block;
use super::super::law::Law;
use super::batch::{Ends, Pushes};
use super::cones::{put, vectors};
use super::group::{Asked, Side};
use d2m_lanes::{Doubles, Quad};

/// As [`Block`], lane by lane.
#[derive(Clone, Debug, Default)]
pub(super) struct Lines {
    direction: [Quad; 3],
    turns: [[Quad; 3]; 2],
    /// What makes an impulse of a rate, by what the row yields.
    mass: Quad,
    lo: Quad,
    hi: Quad,
    softness: Quad,
}

impl Side for Lines {
    fn put(&mut self, lane: usize, block: &Block) {
        let Law::Range { lo, hi, softness } = block.law else { return };
        put(&mut self.direction, lane, block.directions[0]);
        for (turns, vector) in self.turns.iter_mut().zip(block.arms) {
            put(turns, lane, vector);
        }
        let numbers = [
            (&mut self.mass, 1.0 / (1.0 / block.mass + softness)),
            (&mut self.lo, lo),
            (&mut self.hi, hi),
            (&mut self.softness, softness),
        ];
        for (quad, value) in numbers {
            quad.0[lane] = value;
        }
    }

    #[inline(always)]
    fn rates<D: Doubles>(&self, ends: &Ends<D>) -> [D; 3] {
        let (turn_a, turn_b) = (vectors::<D>(&self.turns[0]), vectors::<D>(&self.turns[1]));
        let turns = turn_b.dots(&ends.angular[1]) - turn_a.dots(&ends.angular[0]);
        let along = vectors::<D>(&self.direction).dots(&(ends.linear[1] - ends.linear[0])) + turns;
        [along, D::splat(0.0), D::splat(0.0)]
    }

    #[inline(always)]
    fn relaxed<D: Doubles>(&self, asked: &Asked, rates: &[D; 3], own: &[D; 3]) -> [D; 3] {
        let above = rates[0] - D::load(&asked.target) + D::load(&self.softness) * own[0];
        self.projected(&[own[0] - above * D::load(&self.mass), D::splat(0.0), D::splat(0.0)])
    }

    #[inline(always)]
    fn projected<D: Doubles>(&self, impulses: &[D; 3]) -> [D; 3] {
        let along = impulses[0].max(D::load(&self.lo)).min(D::load(&self.hi));
        [along, D::splat(0.0), D::splat(0.0)]
    }

    #[inline(always)]
    fn natural_map<D: Doubles>(&self, asked: &Asked, rates: &[D; 3], own: &[D; 3]) -> D {
        let scale = D::load(&asked.scale);
        let above = rates[0] - D::load(&asked.target) + D::load(&self.softness) * own[0];
        let nearest = self.projected(&[own[0] - above / scale, D::splat(0.0), D::splat(0.0)]);
        (own[0] - nearest[0]).abs() * scale
    }

    #[inline(always)]
    fn pushes<D: Doubles>(&self, impulses: &[D; 3]) -> Pushes<D> {
        let along = impulses[0];
        let (turn_a, turn_b) = (vectors::<D>(&self.turns[0]), vectors::<D>(&self.turns[1]));
        Pushes { linear: vectors::<D>(&self.direction) * along, angular: [turn_a * along, turn_b * along] }
    }
}
