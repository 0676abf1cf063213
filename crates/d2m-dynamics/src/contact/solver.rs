//! Projected Gauss–Seidel over contact points with Coulomb friction.

use super::directions::{Before, Directions, Restart};
use super::{ContactPoint, Scope};
use crate::velocity::Velocity;
use glam::{DMat3, DVec3};

/// A budget of fewer sweeps than this is one of a large island, which they do not solve to the precision: from 300 contacts on. In a few
/// contacts, steps that grow come from going too far; among many some always begin to stick or slide, which says nothing about the others.
const SHORT: u32 = 200;
/// Plain sweeps at the end of a short budget: what has been extrapolated and not been swept since is an error of its own.
const SETTLING: u32 = 6;

/// Sweeps after which contacts beside those that are worked on may join them.
const BETWEEN: u32 = 4;

/// What the solver needs of a body. A body that impulses cannot move has no inverse masses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SolverBody {
    pub(crate) inverse_mass: f64,
    /// World axes.
    pub(crate) inverse_inertia: DMat3,
    pub(crate) velocity: Velocity,
}

/// How the velocities of two points change along one direction by an impulse of one.
#[derive(Clone, Copy, Debug)]
struct Line {
    direction: DVec3,
    cross_a: DVec3,
    cross_b: DVec3,
    turn_a: DVec3,
    turn_b: DVec3,
    /// Inverse of the change of the rate by a unit impulse.
    mass: f64,
}

impl Line {
    fn new(direction: DVec3, contact: &ContactPoint, a: &SolverBody, b: &SolverBody) -> Self {
        let cross_a = contact.arm_a.cross(direction);
        let cross_b = contact.arm_b.cross(direction);
        let (turn_a, turn_b) = (a.inverse_inertia * cross_a, b.inverse_inertia * cross_b);
        let change = a.inverse_mass + b.inverse_mass + cross_a.dot(turn_a) + cross_b.dot(turn_b);
        let mass = if change > 0.0 { 1.0 / change } else { 0.0 };
        Self { direction, cross_a, cross_b, turn_a, turn_b, mass }
    }

    #[inline]
    fn rate(&self, a: &Velocity, b: &Velocity) -> f64 {
        self.direction.dot(b.linear - a.linear) + self.cross_b.dot(b.angular) - self.cross_a.dot(a.angular)
    }
}

/// One contact, prepared. `a` and `b` are places in the solver's list of bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prepared {
    pub(super) a: usize,
    pub(super) b: usize,
    normal: Line,
    tangents: [Line; 2],
    /// How the rates along the tangents depend on the impulses along them: a symmetric matrix.
    sliding: [f64; 3],
    /// The inverse of a bound on its eigenvalues: one step for both directions, so that what slides is braked against its
    /// velocity and not askew.
    step: f64,
    friction: f64,
}

impl Prepared {
    fn new(contact: &ContactPoint, places: [usize; 2], bodies: &[SolverBody]) -> Self {
        let [a, b] = places;
        let line = |direction| Line::new(direction, contact, &bodies[a], &bodies[b]);
        let tangents = contact.tangents.map(line);
        let change = |t: &Line, u: &Line| t.cross_a.dot(u.turn_a) + t.cross_b.dot(u.turn_b);
        let masses = bodies[a].inverse_mass + bodies[b].inverse_mass;
        let [t, u] = &tangents;
        let (tt, tu, uu) = (masses + change(t, t), change(t, u), masses + change(u, u));
        let largest = 0.5 * (tt + uu) + (0.25 * (tt - uu) * (tt - uu) + tu * tu).sqrt();
        let step = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        Self {
            a,
            b,
            normal: line(contact.normal),
            tangents,
            sliding: [tt, tu, uu],
            step,
            friction: contact.material.friction,
        }
    }

    /// The fastest of the rates along the normal and the tangents.
    pub(super) fn fastest(&self, a: &Velocity, b: &Velocity) -> f64 {
        let [t, u] = &self.tangents;
        [&self.normal, t, u].map(|line| line.rate(a, b).abs()).into_iter().fold(0.0, f64::max)
    }

    /// The impulses along the tangents that stop rates at once; none where a direction cannot be moved.
    fn stopping(&self, rates: [f64; 2]) -> Option<[f64; 2]> {
        let [tt, tu, uu] = self.sliding;
        let determinant = tt * uu - tu * tu;
        (determinant > 1e-9 * tt * uu).then(|| {
            [(uu * rates[0] - tu * rates[1]) / determinant, (tt * rates[1] - tu * rates[0]) / determinant]
        })
    }
}

/// How many sweeps at most, and how they go on from each other.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Sweeps {
    /// Along conjugate directions: fast, but before its end it may be further off than it began.
    Accelerated(u32),
    /// One after the other. From impulses of zero and for targets of zero or less no sweep adds energy: each lowers
    /// ½ λᵀAλ + λᵀ(J v − target), which begins at zero, and the energy that λ adds is that and λᵀ target.
    Plain(u32),
}

/// Contacts between bodies, prepared for iteration.
pub(crate) struct Solver {
    pub(crate) bodies: Vec<SolverBody>,
    pub(super) prepared: Vec<Prepared>,
}

impl Solver {
    /// `place` finds a body of a contact in the list.
    pub(crate) fn new(
        bodies: Vec<SolverBody>,
        contacts: &[ContactPoint],
        place: impl Fn(usize) -> usize,
    ) -> Self {
        let prepared = contacts
            .iter()
            .map(|contact| Prepared::new(contact, [place(contact.a), place(contact.b)], &bodies))
            .collect();
        Self { bodies, prepared }
    }

    /// The rate at which the distance of a contact grows.
    pub(crate) fn rate(&self, contact: usize) -> f64 {
        let p = &self.prepared[contact];
        p.normal.rate(&self.bodies[p.a].velocity, &self.bodies[p.b].velocity)
    }

    /// Adds impulses to the velocities: those the contacts hold already.
    pub(crate) fn warm_start(&mut self, contacts: &[ContactPoint]) {
        for (k, contact) in contacts.iter().enumerate() {
            let p = &self.prepared[k];
            push(&mut self.bodies, p, &p.normal, contact.impulse);
            push(&mut self.bodies, p, &p.tangents[0], contact.sliding[0]);
            push(&mut self.bodies, p, &p.tangents[1], contact.sliding[1]);
        }
    }

    /// Iterates until no rate changes by more than `precision` in a sweep, so many sweeps at most. The rates along the normals
    /// end at `targets` at least; impulses along the normals push only, those along the tangents stay in the cone.
    ///
    /// Sweeps of projected Gauss–Seidel, continued along conjugate directions of their steps: a column of ten boxes with friction is as stiff as a
    /// beam, and takes tens of sweeps instead of thousands.
    pub(crate) fn iterate(
        &mut self,
        contacts: &mut [ContactPoint],
        targets: &[f64],
        precision: f64,
        sweeps: Sweeps,
        scope: &mut Scope,
    ) -> f64 {
        let (most, is_plain) = match sweeps {
            Sweeps::Accelerated(most) => (most, false),
            Sweeps::Plain(most) => (most, true),
        };
        // Close to each other in memory, which is what a sweep's time goes to.
        let mut impulses: Vec<[f64; 3]> = contacts.iter().map(ContactPoint::impulses).collect();
        let mut directions = Directions::new(contacts.len(), self.bodies.len(), scope.is_whole());
        let mut before = Before::new(contacts.len());
        let mut sweep = 0;
        let is_short = scope.sweeps() < SHORT;
        // A large island goes on for as long as its steps have the direction that it goes in.
        let restart = if is_short { Restart::Turn } else { Restart::Growth };
        let left = loop {
            sweep += 1;
            directions.note(&mut before, scope.members(), &impulses, self);
            let change = self.sweep(&mut impulses, targets, scope.members());
            if sweep >= most.min(scope.sweeps()) {
                break change;
            }
            if change <= precision {
                if !scope.grow(self) {
                    break change;
                }
                directions.begin_anew();
                continue;
            }
            if is_plain || (is_short && sweep + SETTLING >= most.min(scope.sweeps())) {
                continue;
            }
            let goes_on = directions.advance(&mut before, scope.members(), &mut impulses, self, restart);
            if goes_on && sweep % BETWEEN == 0 {
                scope.grow(self);
            }
        };
        for &k in scope.members() {
            let [along, first, second] = impulses[k];
            (contacts[k].impulse, contacts[k].sliding) = (along, [first, second]);
        }
        left
    }

    /// Adds impulses of one contact to the velocities.
    pub(super) fn apply(&mut self, contact: usize, [along, first, second]: [f64; 3]) {
        let p = &self.prepared[contact];
        push(&mut self.bodies, p, &p.normal, along);
        if p.friction > 0.0 {
            push(&mut self.bodies, p, &p.tangents[0], first);
            push(&mut self.bodies, p, &p.tangents[1], second);
        }
    }

    /// Adds what makes room to the impulses of the contacts, and to the velocities.
    pub(crate) fn make_room(&mut self, contacts: &mut [ContactPoint]) {
        for (k, contact) in contacts.iter_mut().enumerate() {
            let [along, first, second] = contact.room;
            // Impulses push.
            let along = along.max(-contact.impulse);
            contact.impulse += along;
            contact.sliding = [contact.sliding[0] + first, contact.sliding[1] + second];
            let p = &self.prepared[k];
            for (line, added) in [(&p.normal, along), (&p.tangents[0], first), (&p.tangents[1], second)] {
                push(&mut self.bodies, p, line, added);
            }
        }
    }

    /// One sweep over the members; the largest change of a rate.
    fn sweep(&mut self, impulses: &mut [[f64; 3]], targets: &[f64], members: &[usize]) -> f64 {
        let mut change = 0.0f64;
        for &k in members {
            let own = &mut impulses[k];
            let p = &self.prepared[k];
            let rate = p.normal.rate(&self.bodies[p.a].velocity, &self.bodies[p.b].velocity);
            let impulse = (own[0] - (rate - targets[k]) * p.normal.mass).max(0.0);
            let added = impulse - own[0];
            if added != 0.0 {
                own[0] = impulse;
                push(&mut self.bodies, p, &p.normal, added);
                change = change.max(added.abs() / p.normal.mass);
            }
            if p.friction > 0.0 {
                change = change.max(slide(&mut self.bodies, p, own));
            }
        }
        change
    }

    /// Twice the kinetic energy of the bodies that impulses move.
    pub(crate) fn doubled_energy(&self, inertia: &[(f64, DMat3)]) -> f64 {
        self.bodies
            .iter()
            .zip(inertia)
            .map(|(body, (mass, inertia))| {
                let v = &body.velocity;
                mass * v.linear.length_squared() + v.angular.dot(*inertia * v.angular)
            })
            .sum()
    }
}

/// Adds an impulse along a line of a contact to the velocities.
#[inline]
fn push(bodies: &mut [SolverBody], p: &Prepared, line: &Line, impulse: f64) {
    let a = &mut bodies[p.a];
    a.velocity.linear -= line.direction * (a.inverse_mass * impulse);
    a.velocity.angular -= line.turn_a * impulse;
    let b = &mut bodies[p.b];
    b.velocity.linear += line.direction * (b.inverse_mass * impulse);
    b.velocity.angular += line.turn_b * impulse;
}

/// The impulse along the tangents that stops sliding, or the one of Coulomb's length nearest to it.
#[inline]
fn slide(bodies: &mut [SolverBody], p: &Prepared, own: &mut [f64; 3]) -> f64 {
    let (a, b) = (&bodies[p.a].velocity, &bodies[p.b].velocity);
    let rates = [p.tangents[0].rate(a, b), p.tangents[1].rate(a, b)];
    let limit = p.friction * own[0];
    let length = |x: [f64; 2]| (x[0] * x[0] + x[1] * x[1]).sqrt();
    let stopped = p.stopping(rates).map(|less| [0, 1].map(|k| own[k + 1] - less[k]));
    let wanted = if let Some(stopped) = stopped.filter(|x| length(*x) <= limit) {
        stopped
    } else {
        let wanted = [0, 1].map(|k| own[k + 1] - rates[k] * p.step);
        let shorten = (limit / length(wanted)).min(1.0);
        if limit > 0.0 { wanted.map(|x| x * shorten) } else { [0.0; 2] }
    };
    let mut change = 0.0f64;
    for (k, wanted) in wanted.into_iter().enumerate() {
        let added = wanted - own[k + 1];
        if added != 0.0 {
            own[k + 1] = wanted;
            push(bodies, p, &p.tangents[k], added);
            change = change.max(added.abs() / p.tangents[k].mass);
        }
    }
    change
}
