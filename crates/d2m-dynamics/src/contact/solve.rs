//! Which method solves an island.

use super::newton::Start;
use super::system::{SolverBody, System};

/// Moved bodies up to which the direct solution comes first.
const FEW: usize = 20;
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
}

impl System {
    /// Finds impulses with which the rates of all contacts obey the law, above the targets; the residual that is left. Begins with the
    /// impulses that there are.
    ///
    /// Crowds of bodies of about the same mass that slide are what sweeps do well; few bodies, masses far apart, conforming contacts and
    /// joints are solved directly. Whichever comes first, where it leaves more than the tolerance the other one is tried, too, and the
    /// better of both is taken.
    pub(crate) fn solve(&mut self, targets: &[f64], accuracy: Accuracy, start: Start) -> f64 {
        let tolerance = self.tolerance(accuracy);
        if self.is_direct() {
            let residual = self.solve_direct(targets, accuracy, start);
            if residual <= tolerance {
                return residual;
            }
            self.better(residual, |system| system.sweep_until(targets, tolerance, SWEEPS))
        } else {
            let residual = self.sweep_until(targets, tolerance, SWEEPS);
            if residual <= tolerance {
                return residual;
            }
            self.better(residual, |system| system.solve_direct(targets, accuracy, start))
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
        let moved = || self.bodies.iter().filter(|body| body.inverse_mass > 0.0);
        let masses = moved().map(|body| 1.0 / body.inverse_mass);
        let (least, most) =
            masses.fold((f64::INFINITY, 0.0f64), |(least, most), m| (least.min(m), most.max(m)));
        moved().count() <= FEW || most > MOST_RATIO * least || self.is_conforming
    }
}
