//! Impacts: restitution and friction where bodies meet faster than they rest.

use super::accuracy::Accuracy;
use super::newton::Start;
use super::{ContactPoint, System};
use crate::velocity::Velocity;
use glam::DMat3;

/// Rounds of impacts that are passed on at one time.
const MOST_ROUNDS: u32 = 64;
/// How often one contact may be hit in them. A light body between a wall and a heavy one that comes at it is thrown to and fro, the more often the
/// heavier that is. After so many hits all contacts that have been hit are made to separate at once.
const MOST_HITS: u32 = 16;
/// Rates are solved to this part of the fastest closing speed.
const PRECISION: f64 = 1e-13;
/// Relative increase of the energy that counts as rounding.
const ENERGY_ROUNDING: f64 = 1e-12;
/// Where a body follows its motion, a residual above this part of the fastest closing speed means that no impulses obey the law.
const UNSOLVED: f64 = 1.0 / 8.0;
/// Solutions by which the scale of the restitution is found.
const MOST_SCALES: u32 = 16;

/// Applies impulses at the contacts that close faster than `resting_speed` until there is none left, and returns the
/// total impulse on b of each contact.
///
/// Each round takes the contacts that close, and has them separate by Newton's restitution all at once, with Coulomb friction;
/// contacts that close only because of that wait for the next round (Guendelman et al. 2003), so a row of spheres passes on what
/// it is hit by. Where one is hit 16 times, the impact begins anew, and all that have been hit stay closed or open meanwhile. Newton's restitution with friction can add energy (Kane): then the round's restitution is reduced by the factor, found
/// by regula falsi, with which the energy is what it was.
///
/// The velocities of `system` are those with the impulses afterwards. `inertia`: the mass and the inertia of each of its bodies, world axes,
/// zeros of what impulses do not move.
///
/// ```
/// use d2m_contact::{ContactPoint, Material, SolverBody, System, Velocity, impact};
/// use glam::{DMat3, DVec3};
/// // A ball meets another one like it, which takes over its velocity.
/// let ball = |speed: f64| SolverBody {
///     inverse_mass: 1.0,
///     inverse_inertia: DMat3::IDENTITY,
///     velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::ZERO },
/// };
/// let met = [ContactPoint::new([0, 1], [DVec3::X, DVec3::NEG_X], DVec3::X, Material::new(1.0, 0.0))];
/// let mut system = System::new(vec![ball(3.0), ball(0.0)], &met, |body| body);
/// let impulses = impact(&mut system, &met, &[(1.0, DMat3::IDENTITY); 2], 1e-3);
/// assert!((impulses[0].impulse - 3.0).abs() < 1e-9);
/// assert!((system.bodies[1].velocity.linear.x - 3.0).abs() < 1e-9);
/// ```
pub fn impact(
    system: &mut System,
    contacts: &[ContactPoint],
    inertia: &[(f64, DMat3)],
    resting_speed: f64,
) -> Vec<ContactPoint> {
    let cleared = |c: &ContactPoint| ContactPoint { impulse: 0.0, sliding: [0.0; 2], ..*c };
    let none = || contacts.iter().map(cleared).collect::<Vec<ContactPoint>>();
    let mut totals = none();
    let still = Velocity::default();
    let driven = system.bodies.iter().any(|body| body.inverse_mass == 0.0 && body.velocity != still)
        || contacts.iter().any(|contact| contact.running != [0.0; 2]);
    let first = system.velocities();
    let (mut hits, mut at_once) = (vec![0; contacts.len()], false);
    for _ in 0..MOST_ROUNDS {
        if !at_once && hits.contains(&MOST_HITS) {
            at_once = true;
            system.begin(&first);
            totals = none();
        }
        let rates: Vec<f64> = (0..contacts.len()).map(|k| system.rate(k)).collect();
        let closes = |k: usize| rates[k] < -resting_speed && contacts[k].material.restitution > 0.0;
        let fastest = (0..contacts.len()).filter(|&k| closes(k)).map(|k| -rates[k]).fold(0.0, f64::max);
        if fastest == 0.0 {
            break;
        }
        let closing = (0..contacts.len()).filter(|&k| closes(k));
        let liveliest = closing.map(|k| contacts[k].material.restitution).fold(0.0, f64::max);
        let before = system.velocities();
        let energy = system.doubled_energy(inertia);
        let mut residual = 0.0;
        // What a scale adds to the energy.
        let mut add = |scale: f64| {
            // Contacts that do not close have no part in this round: a target that they have already. Joints hold meanwhile.
            let target = |k: usize| {
                if closes(k) {
                    -scale * contacts[k].material.restitution * rates[k]
                } else if contacts[k].row.is_some() || at_once && hits[k] > 0 {
                    0.0
                } else {
                    f64::NEG_INFINITY
                }
            };
            let targets: Vec<f64> = (0..contacts.len()).map(target).collect();
            system.begin(&before);
            // With a slow speed, however large: bodies between a wall and what comes at it may have nowhere to bounce to, and are not swept for long.
            let accuracy = Accuracy { slow: f64::MAX, ..Accuracy::exact(PRECISION * fastest) };
            residual = system.solve(&targets, accuracy, Start::Sticking);
            system.doubled_energy(inertia) - energy
        };
        // A body that follows its motion may work: then the others may gain.
        if driven {
            add(1.0);
            // Where all that is between a press and a wall closes at once it has nowhere to bounce to: the nearest velocities may be as large as
            // normals are askew. What room is left the flights share.
            if residual > UNSOLVED * fastest {
                break;
            }
        } else {
            // Rates that have been thrown up in between say little of how fast all of it meets: of the energy that is lost where nothing bounces a
            // part e² comes back (Stronge).
            let allowed = if at_once { (1.0 - liveliest * liveliest) * add(0.0) } else { 0.0 };
            keep_energy(&mut |scale| add(scale) - allowed, ENERGY_ROUNDING * energy);
        }
        let mut round = totals.clone();
        system.store(&mut round);
        for (k, (total, part)) in totals.iter_mut().zip(&round).enumerate() {
            hits[k] += u32::from(closes(k));
            total.impulse += part.impulse;
            total.sliding[0] += part.sliding[0];
            total.sliding[1] += part.sliding[1];
        }
    }
    totals
}

/// Leaves the solution of the greatest scale up to one that adds no more energy than rounding.
fn keep_energy(add: &mut impl FnMut(f64) -> f64, rounding: f64) {
    let mut high = (1.0, add(1.0));
    if high.1 <= rounding {
        return;
    }
    let mut low = (0.0, add(0.0));
    if low.1 > 0.0 {
        return;
    }
    for _ in 0..MOST_SCALES {
        // The energy grows with the square of the restitution: through the sums that are linear in that.
        let (x, y) = (low.0 * low.0, high.0 * high.0);
        let scale = ((x * high.1 - y * low.1) / (high.1 - low.1)).max(x).min(y).sqrt();
        let added = add(scale);
        if added.abs() <= rounding {
            return;
        }
        if added > 0.0 {
            high = (scale, added);
            low.1 *= 0.5;
        } else {
            low = (scale, added);
            high.1 *= 0.5;
        }
    }
    add(low.0);
}
