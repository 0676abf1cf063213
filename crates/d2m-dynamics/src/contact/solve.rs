//! Which method solves an island.

use super::newton::{Effort, Start};
use super::system::{SolverBody, System};

/// Moved bodies up to which the direct solution comes first.
const FEW: usize = 20;
/// Moved bodies up to which a direct solution may cost what it takes: tall stacks need it, and their factors are small.
const SOME: usize = 64;
/// Ratio of masses beyond which sweeps converge too slowly.
const MOST_RATIO: f64 = 30.0;
/// Sweeps where they come first, and where they come after the direct solution.
const SWEEPS: u32 = 60;
/// How much more than the precision may be left of bodies that move, at most.
const LOOSE: f64 = 1024.0;

/// How exactly the law is to hold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Accuracy {
    /// Of rates: what is left of bodies at rest.
    pub(crate) precision: f64,
    /// The part of the bodies' mean speed that may be left, no more than [`LOOSE`] times the precision.
    pub(crate) relative: f64,
    /// The part of the precision that is aimed at where bodies rest: what is left of one step is there in the next one.
    pub(crate) aim: f64,
}

impl Accuracy {
    /// What is aimed at where so much may be left.
    pub(super) fn aim(self, tolerance: f64) -> f64 {
        if tolerance > self.precision { tolerance } else { self.aim * self.precision }
    }
}

impl System {
    /// Finds impulses with which the rates of all contacts obey the law, above the targets; the residual that is left. Begins with the
    /// impulses that there are.
    ///
    /// Crowds of bodies of about the same mass that slide are what sweeps do well; few bodies, masses far apart, conforming contacts and
    /// joints are solved directly. Whichever comes first, where it leaves more than the tolerance the other one is tried, too, and the
    /// better of both is taken.
    pub(crate) fn solve(&mut self, targets: &[f64], accuracy: Accuracy, start: Start) -> f64 {
        if self.is_direct() {
            let residual = self.solve_direct(targets, accuracy, start, Effort::FULL);
            if residual <= self.tolerance(accuracy) {
                return residual;
            }
            self.better(residual, |system| system.sweep_until(targets, accuracy, SWEEPS))
        } else {
            let residual = self.sweep_until(targets, accuracy, SWEEPS);
            if residual <= accuracy.aim(self.tolerance(accuracy)) {
                return residual;
            }
            let effort = if self.moved() <= SOME { Effort::FULL } else { Effort::CROWD };
            self.better(residual, |system| system.solve_direct(targets, accuracy, start, effort))
        }
    }

    /// What may be left of these bodies at the speeds that they have.
    pub(crate) fn tolerance(&self, accuracy: Accuracy) -> f64 {
        let moved = |(body, _): &(&SolverBody, &f64)| body.inverse_mass > 0.0;
        let square = |(body, reach): (&SolverBody, &f64)| body.velocity.surface_speed(*reach).powi(2);
        let bodies = || self.bodies.iter().zip(&self.reach).filter(moved);
        let mean = (bodies().map(square).sum::<f64>() / bodies().count().max(1) as f64).sqrt();
        (accuracy.relative * mean).min(LOOSE * accuracy.precision).max(accuracy.precision)
    }

    /// Goes on, unless that ends with a larger residual.
    fn better(&mut self, residual: f64, go_on: impl FnOnce(&mut Self) -> f64) -> f64 {
        let (impulses, velocities) = (self.impulses.clone(), self.velocities());
        let other = go_on(self);
        if other <= residual {
            return other;
        }
        self.impulses = impulses;
        for (body, velocity) in self.bodies.iter_mut().zip(velocities) {
            body.velocity = velocity;
        }
        residual
    }

    fn is_direct(&self) -> bool {
        self.moved() <= FEW || self.mass_ratio() > MOST_RATIO || self.is_conforming
    }

    fn moved(&self) -> usize {
        self.bodies.iter().filter(|body| body.inverse_mass > 0.0).count()
    }

    /// The greatest mass that impulses move, over the least one.
    pub(super) fn mass_ratio(&self) -> f64 {
        let inverses = self.bodies.iter().map(|body| body.inverse_mass).filter(|x| *x > 0.0);
        let (least, most) =
            inverses.fold((f64::INFINITY, 0.0f64), |(least, most), x| (least.min(x), most.max(x)));
        if most > 0.0 { most / least } else { 1.0 }
    }
}
