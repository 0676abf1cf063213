//! Which method solves an island.

use super::newton::Start;
use super::system::System;

/// Moved bodies up to which the direct solution comes first.
const FEW: usize = 20;
/// Ratio of masses beyond which sweeps converge too slowly.
const MOST_RATIO: f64 = 30.0;
/// Sweeps where they come first, and where they come after the direct solution.
const SWEEPS: u32 = 100;

impl System {
    /// Finds impulses with which the rates of all contacts obey the law, above the targets; the residual that is left. Begins with the
    /// impulses that there are. `precision`: of rates.
    ///
    /// Crowds of bodies of about the same mass that slide are what sweeps do well; few bodies, masses far apart, conforming contacts and
    /// joints are solved directly. Whichever comes first, where it leaves more than the precision the other one is tried, too, and the better
    /// of both is taken.
    pub(crate) fn solve(&mut self, targets: &[f64], precision: f64, start: Start) -> f64 {
        if self.is_direct() {
            let residual = self.solve_direct(targets, precision, start);
            if residual <= precision {
                return residual;
            }
            self.better(residual, |system| system.sweep_until(targets, precision, SWEEPS))
        } else {
            let residual = self.sweep_until(targets, precision, SWEEPS);
            if residual <= precision {
                return residual;
            }
            self.better(residual, |system| system.solve_direct(targets, precision, start))
        }
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
