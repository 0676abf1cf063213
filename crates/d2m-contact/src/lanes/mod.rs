//! The blocks of a system arranged for vector instructions: a batch holds four pairs of bodies, and a sweep relaxes four blocks at once.
//!
//! The pairs of a batch share no movable body, and pairs that share one keep their order. So a sweep equals Gauss–Seidel, one block after the
//! other, to the last bit. Most batches share no body with the next one either, so that the processor need not wait for its results.
//! The instructions are chosen when the program runs, and all of them give the same bits.

mod batch;
mod cones;
mod group;
mod lines;
#[cfg(test)]
mod tests;

use super::block::Block;
use super::law::Law;
use super::solver_body::SolverBody;
use crate::velocity::Velocity;
use cones::Cones;
use d2m_lanes::{Doubles, Lanes, Quad, Task, run};
pub(super) use group::Numbers;
use group::{Group, layers};
use lines::Lines;

/// Sweeps alternate in direction: one carries changes to the top of a pile, the next one to the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Forth,
    Back,
}

/// A system as batches, its impulses and velocities.
#[derive(Clone, Debug)]
pub(super) struct Wide {
    /// Of the bodies, and of one that empty lanes push.
    velocities: Vec<Velocity>,
    cones: Group<Cones>,
    lines: Group<Lines>,
}

/// Impulses and velocities to go back to.
pub(super) type Kept = (Vec<Velocity>, Vec<[Quad; 3]>, Vec<[Quad; 3]>);

/// How far blocks are from their law.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    /// The largest natural map.
    pub(super) most: f64,
    /// The quadratic mean of all.
    pub(super) mean: f64,
    /// Is no rate so far below its target that it ends its flight?
    pub(super) has_room: bool,
}

/// When a conjugate direction is given up for a new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ends {
    /// As soon as two sweeps change more than the two before: best for bodies at rest, or that begin to move.
    Grown,
    /// When the change by two sweeps points against the direction (O'Donoghue and Candès 2015). In a large moving pile changes grow every few
    /// sweeps, while the direction is still a good one.
    Back,
}

/// Nonsmooth nonlinear conjugate gradients (Silcowitz-Hansen, Niebe and Erleben 2010). The change by two sweeps, one in each direction, takes the
/// place of the negative gradient. After it the impulses make a step along the last direction (the *way*), weighted by the ratio of the
/// squares of this change and the last one, until the way [`Ends`]. A crowd takes about a third of the sweeps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Descent {
    ends: Ends,
    /// The sum of the squares of what the last two sweeps changed, each as energy.
    square: f64,
    /// Is there a last direction?
    has_way: bool,
}

impl Wide {
    /// For these blocks of a system, without numbers.
    pub(super) fn new(bodies: &[SolverBody], blocks: &[Block]) -> Self {
        let is_cone = |block: &Block| matches!(block.law, Law::Cone { .. });
        Self {
            velocities: vec![Velocity::default(); bodies.len() + 1],
            cones: Group::new(&layers(bodies, blocks, is_cone)),
            lines: Group::new(&layers(bodies, blocks, |block| !is_cone(block))),
        }
    }

    /// With the numbers that these blocks and bodies have now.
    pub(super) fn fill(&mut self, numbers: Numbers<'_>) {
        for (velocity, body) in self.velocities.iter_mut().zip(numbers.bodies) {
            *velocity = body.velocity;
        }
        self.cones.fill(numbers);
        self.lines.fill(numbers);
    }

    /// Makes two sweeps, one in each direction, `twice` times. Returns the residuals.
    pub(super) fn sweep(&mut self, twice: u32, descent: Option<&mut Descent>) -> Off {
        run(Round { wide: self, descent, twice })
    }

    pub(super) fn kept(&self) -> Kept {
        (self.velocities.clone(), self.cones.impulses.clone(), self.lines.impulses.clone())
    }

    /// Overwrites what was kept before.
    pub(super) fn keep(&self, (velocities, cones, lines): &mut Kept) {
        velocities.copy_from_slice(&self.velocities);
        cones.copy_from_slice(&self.cones.impulses);
        lines.copy_from_slice(&self.lines.impulses);
    }

    pub(super) fn take_back(&mut self, (velocities, cones, lines): Kept) {
        (self.velocities, self.cones.impulses, self.lines.impulses) = (velocities, cones, lines);
    }

    /// Writes the velocities to the bodies.
    pub(super) fn move_bodies(&self, bodies: &mut [SolverBody]) {
        for (body, velocity) in bodies.iter_mut().zip(&self.velocities) {
            body.velocity = *velocity;
        }
    }

    /// Writes the impulses of the blocks.
    pub(super) fn write(&self, impulses: &mut [[f64; 3]]) {
        self.cones.write(impulses);
        self.lines.write(impulses);
    }

    #[inline(always)]
    fn sweep_once<D: Doubles>(&mut self, order: Order) {
        match order {
            Order::Forth => {
                self.cones.sweep::<D>(&mut self.velocities, order);
                self.lines.sweep::<D>(&mut self.velocities, order);
            }
            Order::Back => {
                self.lines.sweep::<D>(&mut self.velocities, order);
                self.cones.sweep::<D>(&mut self.velocities, order);
            }
        }
    }

    #[inline(always)]
    fn off<D: Doubles>(&self) -> Off {
        let (cones, lines) = (self.cones.off::<D>(&self.velocities), self.lines.off::<D>(&self.velocities));
        let count = self.cones.count + self.lines.count;
        Off {
            most: cones.most.max(lines.most),
            mean: ((cones.sum + lines.sum) / count.max(1) as f64).sqrt(),
            has_room: cones.has_room && lines.has_room,
        }
    }
}

impl Descent {
    pub(super) fn new(ends: Ends) -> Self {
        Self { ends, square: 0.0, has_way: false }
    }

    fn ends_way(&self, part: f64, along: f64) -> bool {
        match self.ends {
            Ends::Grown => part > 1.0,
            Ends::Back => self.has_way && along < 0.0,
        }
    }

    #[inline(always)]
    fn go_on<D: Doubles>(&mut self, wide: &mut Wide) {
        let (cones, lines) = (wide.cones.changed::<D>(), wide.lines.changed::<D>());
        let (square, along) = (cones.square + lines.square, cones.along + lines.along);
        let part = square / core::mem::replace(&mut self.square, square);
        if part.is_nan() || self.ends_way(part, along) {
            self.has_way = false;
        } else if core::mem::replace(&mut self.has_way, true) {
            wide.cones.go_on::<D>(&mut wide.velocities, part.min(1.0));
            wide.lines.go_on::<D>(&mut wide.velocities, part.min(1.0));
        } else {
            wide.cones.begin_way();
            wide.lines.begin_way();
        }
    }
}

struct Round<'s> {
    wide: &'s mut Wide,
    descent: Option<&'s mut Descent>,
    twice: u32,
}

impl Task for Round<'_> {
    type Output = Off;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Off {
        let Self { wide, mut descent, twice } = self;
        for _ in 0..twice {
            wide.sweep_once::<L::Doubles>(Order::Forth);
            wide.sweep_once::<L::Doubles>(Order::Back);
            if let Some(descent) = &mut descent {
                descent.go_on::<L::Doubles>(wide);
            }
        }
        wide.off::<L::Doubles>()
    }
}
