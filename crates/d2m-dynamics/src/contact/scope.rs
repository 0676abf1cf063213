//! The contacts that an iteration works on.

use super::solver::{Prepared, Solver};
use crate::velocity::Velocity;

/// Sweeps times contacts of one solution: a budget. What a large island is solved less exactly for is met as an event.
const WORK: usize = 60_000;
/// Sweeps at least, and at most.
const SWEEPS: (usize, usize) = (30, 4000);

/// All contacts of an island, or those that are new to a solution and those that they change.
///
/// Of an island that has been solved, the contacts that hold already are left as they are, until the rate of one along its normal or a tangent
/// differs from what it was by more than a tolerance. So the work is that of what changes, not that of the island.
pub(crate) struct Scope {
    is_member: Vec<bool>,
    /// Ascending.
    members: Vec<usize>,
    /// Sweeps times contacts.
    work: usize,
    part: Option<Part>,
}

/// What is known of an island of which some contacts are members.
struct Part {
    /// Velocities with which the contacts outside hold.
    reference: Vec<Velocity>,
    tolerance: f64,
    /// Where the contacts of each body begin in `contacts`, and where the last ones end.
    starts: Vec<usize>,
    contacts: Vec<usize>,
}

impl Scope {
    /// All contacts.
    pub(crate) fn whole(contacts: usize) -> Self {
        Self { is_member: vec![true; contacts], members: (0..contacts).collect(), work: WORK, part: None }
    }

    /// These contacts, and those whose rates change by more than `tolerance` from now on.
    pub(crate) fn part(is_member: Vec<bool>, solver: &Solver, tolerance: f64) -> Self {
        let reference = solver.bodies.iter().map(|body| body.velocity).collect();
        Self::beside(is_member, reference, solver, tolerance)
    }

    /// The contacts whose rates have changed by more than `tolerance` since the bodies had these velocities, or will have.
    pub(crate) fn changed(before: Vec<Velocity>, solver: &Solver, tolerance: f64) -> Self {
        let change = |i: usize| solver.bodies[i].velocity - before[i];
        let has_changed = |p: &Prepared| p.fastest(&change(p.a), &change(p.b)) > tolerance;
        let is_member = solver.prepared.iter().map(has_changed).collect();
        Self::beside(is_member, before, solver, tolerance)
    }

    fn beside(is_member: Vec<bool>, reference: Vec<Velocity>, solver: &Solver, tolerance: f64) -> Self {
        let (bodies, prepared) = (&solver.bodies, &solver.prepared);
        let mut starts = vec![0; bodies.len() + 1];
        let moved = |p: &Prepared| [p.a, p.b].into_iter().filter(|&i| bodies[i].inverse_mass > 0.0);
        for i in prepared.iter().flat_map(moved) {
            starts[i + 1] += 1;
        }
        for k in 1..starts.len() {
            starts[k] += starts[k - 1];
        }
        let mut next = starts.clone();
        let mut contacts = vec![0; starts[bodies.len()]];
        for (k, p) in prepared.iter().enumerate() {
            for i in moved(p) {
                contacts[next[i]] = k;
                next[i] += 1;
            }
        }
        let members = (0..is_member.len()).filter(|&k| is_member[k]).collect();
        Self { is_member, members, work: WORK, part: Some(Part { reference, tolerance, starts, contacts }) }
    }

    /// As many sweeps as are wanted.
    pub(crate) fn unlimited(self) -> Self {
        Self { work: usize::MAX, ..self }
    }

    pub(crate) fn members(&self) -> &[usize] {
        &self.members
    }

    pub(crate) fn is_whole(&self) -> bool {
        self.part.is_none()
    }

    /// How many sweeps the budget allows.
    pub(crate) fn sweeps(&self) -> u32 {
        (self.work / self.members.len().max(1)).clamp(SWEEPS.0, SWEEPS.1) as u32
    }

    /// The velocities have been changed by something that contacts are to hold with, too.
    pub(crate) fn shift(&mut self, before: &[Velocity], solver: &Solver) {
        let Some(part) = &mut self.part else { return };
        for ((reference, old), body) in part.reference.iter_mut().zip(before).zip(&solver.bodies) {
            *reference = *reference + body.velocity - *old;
        }
    }

    /// Admits the contacts beside members whose rates have changed. True if there are any.
    pub(crate) fn grow(&mut self, solver: &Solver) -> bool {
        let Some(part) = &self.part else { return false };
        let (bodies, prepared) = (&solver.bodies, &solver.prepared);
        let change = |i: usize| bodies[i].velocity - part.reference[i];
        let mut admitted = Vec::new();
        for &k in &self.members {
            for i in [prepared[k].a, prepared[k].b] {
                for &other in &part.contacts[part.starts[i]..part.starts[i + 1]] {
                    if self.is_member[other] {
                        continue;
                    }
                    let p = &prepared[other];
                    if p.fastest(&change(p.a), &change(p.b)) > part.tolerance {
                        self.is_member[other] = true;
                        admitted.push(other);
                    }
                }
            }
        }
        let has_grown = !admitted.is_empty();
        if has_grown {
            self.members.append(&mut admitted);
            self.members.sort_unstable();
        }
        has_grown
    }
}
