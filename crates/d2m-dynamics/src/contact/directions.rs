//! Conjugate directions of sweeps.

use super::solver::Solver;
use crate::velocity::Velocity;

/// Where an accelerated iteration goes: the nonsmooth nonlinear conjugate gradient method of Silcowitz, Niebe and Erleben 2010, whose
/// gradient is the step of a sweep.
pub(super) struct Directions {
    impulses: Vec<[f64; 3]>,
    /// What those do to the velocities, by body, where the sweeps go over all contacts: velocities follow impulses linearly, and there are
    /// fewer bodies than contacts. Else the impulses are applied one by one.
    velocities: Option<Vec<Velocity>>,
    /// The square of the last step; none: the next one is the first of new directions.
    last: Option<f64>,
}

/// Impulses and velocities before a sweep.
pub(super) struct Before {
    impulses: Vec<[f64; 3]>,
    velocities: Vec<Velocity>,
}

/// When directions begin anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Restart {
    /// Where a step is longer than the one before.
    Growth,
    /// Where a step goes against them.
    Turn,
}

impl Before {
    pub(super) fn new(contacts: usize) -> Self {
        Self { impulses: vec![[0.0; 3]; contacts], velocities: Vec::new() }
    }
}

impl Directions {
    pub(super) fn new(contacts: usize, bodies: usize, is_whole: bool) -> Self {
        let velocities = is_whole.then(|| vec![Velocity::default(); bodies]);
        Self { impulses: vec![[0.0; 3]; contacts], velocities, last: None }
    }

    /// From the next step on.
    pub(super) fn begin_anew(&mut self) {
        self.clear();
        self.last = None;
    }

    fn clear(&mut self) {
        self.impulses.fill([0.0; 3]);
        if let Some(velocities) = &mut self.velocities {
            velocities.fill(Velocity::default());
        }
    }

    /// Keeps what the next sweep over these contacts begins with.
    pub(super) fn note(
        &self,
        before: &mut Before,
        members: &[usize],
        impulses: &[[f64; 3]],
        solver: &Solver,
    ) {
        for &k in members {
            before.impulses[k] = impulses[k];
        }
        if self.velocities.is_some() {
            before.velocities.clear();
            before.velocities.extend(solver.bodies.iter().map(|body| body.velocity));
        }
    }

    /// Adds the part of the directions to the impulses and velocities that conjugacy gives, after a sweep. False where they begin anew
    /// instead.
    pub(super) fn advance(
        &mut self,
        before: &mut Before,
        members: &[usize],
        impulses: &mut [[f64; 3]],
        solver: &mut Solver,
        restart: Restart,
    ) -> bool {
        let (mut square, mut aligned) = (0.0, 0.0);
        for &k in members {
            let (old, new) = (&mut before.impulses[k], impulses[k]);
            *old = [0, 1, 2].map(|i| new[i] - old[i]);
            square += old.iter().map(|x| x * x).sum::<f64>();
            aligned += old.iter().zip(&self.impulses[k]).map(|(x, y)| x * y).sum::<f64>();
        }
        let ratio = self.last.map_or(0.0, |last| square / last);
        self.last = Some(square);
        let turns = match restart {
            Restart::Growth => ratio > 1.0,
            Restart::Turn => aligned < 0.0,
        };
        if ratio.is_nan() || turns {
            self.clear();
            return false;
        }
        let ratio = ratio.min(1.0);
        for &k in members {
            let (impulse, d) = (&mut impulses[k], &mut self.impulses[k]);
            let added = d.map(|x| ratio * x);
            *d = [0, 1, 2].map(|i| added[i] + before.impulses[k][i]);
            if added == [0.0; 3] {
                continue;
            }
            *impulse = [0, 1, 2].map(|i| impulse[i] + added[i]);
            if self.velocities.is_none() {
                solver.apply(k, added);
            }
        }
        let velocities = self.velocities.iter_mut().flatten();
        for ((direction, body), before) in velocities.zip(&mut solver.bodies).zip(&before.velocities) {
            let added = *direction * ratio;
            *direction = added + (body.velocity - *before);
            body.velocity = body.velocity + added;
        }
        true
    }
}
