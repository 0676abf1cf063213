//! Impacts: restitution and friction where bodies meet faster than they rest.

use super::{ContactPoint, Scope, Solver, Sweeps};
use crate::velocity::Velocity;
use glam::DMat3;

/// Rounds of impacts that are passed on at one time.
const MOST_ROUNDS: u32 = 64;
/// Sweeps of one round.
const MOST_SWEEPS: u32 = 1000;
/// Rates are solved to this part of the fastest closing speed.
const PRECISION: f64 = 1e-13;
/// Relative increase of the energy that counts as rounding.
const ENERGY_ROUNDING: f64 = 1e-12;

/// Applies impulses at the contacts that close faster than `resting_speed` until there is none left, and returns the
/// total impulse on b of each contact.
///
/// Each round takes the contacts that close, and has them separate by Newton's restitution all at once, with Coulomb friction;
/// contacts that close only because of that wait for the next round (Guendelman et al. 2003), so a row of spheres passes on what
/// it is hit by. Newton's restitution with friction can add energy (Kane): then the restitution of the round is
/// reduced until it does not.
pub(crate) fn impact(
    solver: &mut Solver,
    contacts: &[ContactPoint],
    inertia: &[(f64, DMat3)],
    resting_speed: f64,
) -> Vec<ContactPoint> {
    let cleared = |c: &ContactPoint| ContactPoint { impulse: 0.0, sliding: [0.0; 2], ..*c };
    let mut totals: Vec<ContactPoint> = contacts.iter().map(cleared).collect();
    let still = Velocity::default();
    let driven = solver.bodies.iter().any(|body| body.inverse_mass == 0.0 && body.velocity != still);
    for _ in 0..MOST_ROUNDS {
        let rates: Vec<f64> = (0..contacts.len()).map(|k| solver.rate(k)).collect();
        let closing: Vec<usize> = (0..contacts.len())
            .filter(|&k| rates[k] < -resting_speed && contacts[k].material.restitution > 0.0)
            .collect();
        let fastest = closing.iter().map(|&k| -rates[k]).fold(0.0, f64::max);
        if closing.is_empty() {
            break;
        }
        let before = solver.bodies.clone();
        let energy = solver.doubled_energy(inertia);
        let mut scale = 1.0;
        let round = loop {
            let mut round: Vec<ContactPoint> = contacts.iter().map(cleared).collect();
            // Contacts that do not close have no part in this round: a target that they have already.
            let targets: Vec<f64> = (0..contacts.len())
                .map(|k| {
                    if closing.contains(&k) {
                        -scale * contacts[k].material.restitution * rates[k]
                    } else {
                        f64::NEG_INFINITY
                    }
                })
                .collect();
            let sweeps =
                if scale > 0.0 { Sweeps::Accelerated(MOST_SWEEPS) } else { Sweeps::Plain(MOST_SWEEPS) };
            let scope = &mut Scope::whole(round.len()).unlimited();
            solver.iterate(&mut round, &targets, PRECISION * fastest, sweeps, scope);
            // A body that follows its motion may work: then the others may gain.
            if driven || solver.doubled_energy(inertia) <= energy * (1.0 + ENERGY_ROUNDING) || scale == 0.0 {
                break round;
            }
            scale = if scale > 0.1 { scale - 0.125 } else { 0.0 };
            solver.bodies.clone_from(&before);
        };
        for (total, part) in totals.iter_mut().zip(&round) {
            total.impulse += part.impulse;
            total.sliding[0] += part.sliding[0];
            total.sliding[1] += part.sliding[1];
        }
    }
    totals
}
