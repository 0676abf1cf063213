//! Trials of one pair that a series asks about, and how they are changed from point to point.
use super::super::body::{Body, Pair};
use crate::judge::{Claim, place};
use crate::trials::{self, Law, Movement, Trial};
use glam::DVec3;

/// Trials of one pair; for each the time before which answers found right say that nothing touches.
pub(super) struct Flights<'a> {
    pub(super) pair: &'a Pair,
    pub(super) trials: Vec<Trial>,
    pub(super) known: Vec<f64>,
}

impl<'a> Flights<'a> {
    pub(super) fn new(pair: &'a Pair, trials: Vec<Trial>) -> Self {
        let known = vec![0.0; trials.len()];
        Self { pair, trials, known }
    }

    /// Trials of the bench's law at this speed.
    pub(super) fn at_speed(pair: &'a Pair, speed: f64, seed: u64, count: usize) -> Self {
        Self::new(pair, trials::generate(&Law { speed, ..Law::PAPER }, seed, count))
    }

    /// Notes what an answer that was found right says to be free.
    pub(super) fn learn(&mut self, index: usize, claim: &Claim) {
        self.known[index] = claim.free_until().max(self.known[index]);
    }
}

/// Two pebbles, the pair of most series.
pub(super) fn pebbles() -> Result<Pair, Box<dyn std::error::Error>> {
    let (a, b) = (Body::embedded("pebble?triangles=5856")?, Body::embedded("pebble?triangles=5804&seed=2")?);
    Ok(Pair { name: "pebble/pebble".into(), a, b })
}

/// The same flight from `begin` on, its clock slowed: all speeds times `factor`.
pub(super) fn slowed(trial: &Trial, begin: f64, factor: f64) -> Trial {
    let slow = |movement: &Movement| {
        let at = place(movement, begin);
        Movement {
            rotation: at.rotation,
            position: at.position,
            velocity: movement.velocity * factor,
            angular_velocity: movement.angular_velocity * factor,
        }
    };
    Trial { a: slow(&trial.a), b: slow(&trial.b) }
}

/// The same flight this far from the origin of the world.
pub(super) fn moved(trial: &Trial, by: f64) -> Trial {
    let along = DVec3::new(0.6, 0.48, 0.64) * by;
    let moved = |movement: &Movement| Movement { position: movement.position + along, ..*movement };
    Trial { a: moved(&trial.a), b: moved(&trial.b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_clock_passes_the_same_places() {
        let trial = &trials::generate(&Law::PAPER, 5, 1)[0];
        let slow = slowed(trial, 0.25, 1e-2);
        for (fast, slow) in [(&trial.a, &slow.a), (&trial.b, &slow.b)] {
            let (there, here) = (place(fast, 0.25 + 1e-2 * 0.5), place(slow, 0.5));
            assert!((there.position - here.position).length() < 1e-14);
            assert!((there.matrix.x_axis - here.matrix.x_axis).length() < 1e-14);
        }
    }

    #[test]
    fn both_bodies_move_together() {
        let trial = &trials::generate(&Law::PAPER, 5, 1)[0];
        let far = moved(trial, 1e6);
        let (before, after) = (trial.b.position - trial.a.position, far.b.position - far.a.position);
        assert!((before - after).length() < 1e-9 && far.a.position.length() > 0.9e6);
    }
}
