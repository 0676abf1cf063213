//! Projected Gauss–Seidel: block after block, each with the velocities that the ones before left.

use super::accuracy::{Accuracy, Company};
use super::system::System;

/// Sweeps go forth and back by turns: what one carries to the top of a pile the next one carries to its ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Order {
    Forth,
    Back,
}

/// How sweeps follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pace {
    /// One after the other.
    Steady,
    /// Each two go on along the way of those before.
    Conjugate,
}

impl System {
    /// Sweeps over all blocks until the residual is no more than what may be left, so many at most; the residual.
    pub(super) fn sweep_until(&mut self, targets: &[f64], accuracy: Accuracy, pace: Pace, most: u32) -> f64 {
        let mut off = self.off(targets);
        let mut best = (off.most, self.present());
        let mut descent = (pace == Pace::Conjugate).then(|| Descent::new(self));
        let mut done = 0;
        while !self.is_swept(off, targets, accuracy) && done < most {
            for _ in 0..BETWEEN / 2 {
                if let Some(descent) = &mut descent {
                    descent.begin(self);
                }
                self.sweep(targets, Order::Forth);
                self.sweep(targets, Order::Back);
                if let Some(descent) = &mut descent {
                    descent.go_on(self);
                }
            }
            done += BETWEEN;
            off = self.off(targets);
            if off.most < best.0 || pace == Pace::Steady {
                best = (off.most, self.present());
            }
        }
        // What goes on along a way may be further off for a while.
        if off.most > best.0 && !self.is_swept(off, targets, accuracy) {
            self.take_back(best.1);
            return best.0;
        }
        off.most
    }

    /// May so much be left? Of crowds single blocks may be further from their law than all together. Where something is solved again nothing
    /// that is left may end its flight: that event would find all others solved, and sweep no more than this solution.
    fn is_swept(&self, off: Off, targets: &[f64], accuracy: Accuracy) -> bool {
        let enough = self.enough(accuracy);
        let may_be_left = || off.most <= self.left(accuracy) && off.mean <= MEAN * enough;
        let has_room = || accuracy.company != Company::Heap || self.has_room(targets);
        off.most <= enough || may_be_left() && has_room()
    }

    fn off(&self, targets: &[f64]) -> Off {
        let (mut most, mut sum) = (0.0f64, 0.0);
        for (k, &target) in targets.iter().enumerate() {
            let own = self.own_residual(k, target);
            most = most.max(own);
            sum += own * own;
        }
        Off { most, mean: (sum / targets.len().max(1) as f64).sqrt() }
    }

    fn sweep(&mut self, targets: &[f64], order: Order) {
        let Self { bodies, blocks, impulses, .. } = self;
        for k in 0..blocks.len() {
            let k = if order == Order::Forth { k } else { blocks.len() - 1 - k };
            blocks[k].relax(bodies, &mut impulses[k], targets[k]);
        }
    }
}

/// Natural maps: the largest one, and the quadratic mean of all.
#[derive(Clone, Copy, Debug)]
struct Off {
    most: f64,
    mean: f64,
}

/// The way on which sweeps go on: nonsmooth nonlinear conjugate gradients (Silcowitz-Hansen, Niebe and Erleben 2010). What two sweeps, forth and
/// back, change is the direction of descent; after it the impulses go on along the way of before, the less the more the change has
/// shrunk, and begin a new way where it has grown. A crowd takes about half of the sweeps.
struct Descent {
    /// The impulses before the two sweeps, then what these change.
    step: Vec<[f64; 3]>,
    way: Vec<[f64; 3]>,
    /// The sum of the squares of the changes, each as energy.
    square: f64,
}

impl Descent {
    fn new(system: &System) -> Self {
        let none = vec![[0.0; 3]; system.blocks.len()];
        Self { step: none.clone(), way: none, square: 0.0 }
    }

    fn begin(&mut self, system: &System) {
        self.step.copy_from_slice(&system.impulses);
    }

    fn go_on(&mut self, system: &mut System) {
        let System { bodies, blocks, impulses, .. } = system;
        let mut square = 0.0;
        for ((step, own), block) in self.step.iter_mut().zip(&*impulses).zip(&*blocks) {
            *step = [0, 1, 2].map(|i| own[i] - step[i]);
            square += block.scale * (step[0] * step[0] + step[1] * step[1] + step[2] * step[2]);
        }
        let part = square / core::mem::replace(&mut self.square, square);
        if part.is_nan() || part > 1.0 {
            self.way.fill([0.0; 3]);
            return;
        }
        for (k, block) in blocks.iter().enumerate() {
            let (step, way, own) = (self.step[k], &mut self.way[k], &mut impulses[k]);
            if *way == [0.0; 3] {
                *way = step;
                continue;
            }
            let further = block.law.project([0, 1, 2].map(|i| own[i] + part * way[i]));
            *way = [0, 1, 2].map(|i| part * way[i] + step[i]);
            let added = [0, 1, 2].map(|i| further[i] - own[i]);
            if added != [0.0; 3] {
                block.push(bodies, added);
                *own = further;
            }
        }
    }
}

/// Sweeps after which the residual is judged, which costs about as much as one; even.
const BETWEEN: u32 = 6;
/// The part of what may be left of a block that may be left of a crowd in the quadratic mean: a half leads to twice as many contacts that
/// are expected afterwards, an eighth takes longer than it saves.
const MEAN: f64 = 0.25;
#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::contact::{ContactPoint, SolverBody};
    use crate::velocity::Velocity;
    use glam::{DMat3, DVec3};

    const ACCURACY: Accuracy =
        Accuracy { precision: 1e-7, relative: 1.0 / 1024.0, aim: 1e-3, company: Company::Crowd, slow: 1.0 };

    /// So many bodies of mass one on each other, the lowest one on the ground, which is the last body; all fall at one speed.
    pub(in crate::contact) fn column(count: usize, speed: f64) -> System {
        let body = |mass: f64, speed: f64| SolverBody {
            inverse_mass: mass,
            inverse_inertia: DMat3::IDENTITY * mass,
            velocity: Velocity { linear: DVec3::NEG_Y * speed, angular: DVec3::ZERO },
        };
        let mut bodies = vec![body(1.0, speed); count];
        bodies.push(body(0.0, 0.0));
        let contact = |upper: usize| {
            let lower = upper.checked_sub(1).unwrap_or(count);
            crate::contact::point::upright([lower, upper])
        };
        let contacts: Vec<_> = (0..count).map(contact).collect();
        // Taken for a crowd, and for no row, which is not swept.
        System { is_row: false, ..System::new(bodies, &contacts, |body| body) }
    }

    /// Sweeps of a column pass on what is at one end by a body each; along a way they gain more than three times as much.
    #[test]
    fn sweeps_that_go_on_along_their_way_gain_more() {
        let left = |pace: Pace| {
            let mut system = column(24, 0.01);
            let residual = system.sweep_until(&[0.0; 24], ACCURACY, pace, 48);
            assert_eq!(residual, system.residual(&[0.0; 24]));
            residual
        };
        let (steady, conjugate) = (left(Pace::Steady), left(Pace::Conjugate));
        assert!(3.0 * conjugate < steady, "{conjugate} {steady}");
    }

    /// A crowd that moves may leave more at one place, if little is left of all; a few bodies may not, unless they are of a crowd.
    #[test]
    fn single_blocks_of_crowds_may_be_further_from_their_law() {
        let crowd = column(64, 10.0);
        let enough = crowd.enough(ACCURACY);
        let swept = |most: f64, mean: f64| crowd.is_swept(Off { most, mean }, &[0.0; 64], ACCURACY);
        assert!(swept(enough, enough) && swept(40.0 * enough, 0.2 * enough));
        assert!(!swept(40.0 * enough, 0.3 * enough) && !swept(1.0, 0.0));
        // The lowest contact closes at 10, which ends a flight of this length unless it has that much room.
        let heap = Accuracy { company: Company::Heap, ..ACCURACY };
        for (distance, lasts) in [(0.0, false), (1.0, false), (20.0, true)] {
            let contact = ContactPoint { distance, ..crate::contact::point::upright([64, 0]) };
            let crowd = column(64, 10.0).for_flights(&[contact], &[0.0], 1.0);
            let off = Off { most: 40.0 * enough, mean: 0.2 * enough };
            assert!(crowd.is_swept(off, &[0.0; 64], ACCURACY));
            assert_eq!(crowd.is_swept(off, &[0.0; 64], heap), lasts, "{distance}");
            assert!(crowd.is_swept(Off { most: enough, mean: enough }, &[0.0; 64], heap));
        }
        let alone = Accuracy { company: Company::Few, ..ACCURACY };
        assert!(!crowd.is_swept(Off { most: 2.0 * enough, mean: 0.0 }, &[0.0; 64], alone));
        // Two at rest are solved exactly, unless others are connected with them.
        let calm = column(2, 0.0);
        assert!(calm.enough(ACCURACY) < 0.1 * calm.enough(heap));
        let pair = column(2, 10.0);
        assert!(pair.enough(alone) < 0.1 * pair.enough(ACCURACY) && pair.enough(ACCURACY) == enough);
    }
}
