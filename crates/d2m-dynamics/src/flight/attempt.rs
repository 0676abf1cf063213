//! Velocities of the flights of one island until a given time: targets, solution, and where flights end, put right.

use crate::body::rigid_body::RigidBody;
use crate::body::turning::Pull;
use crate::flight::common_turn::in_common_turn;
use crate::flight::problem::Problem;
use crate::flight::rows::{LAST, Room, Span, select};
use crate::flight::solved_body::{body_at, moves, still};
use crate::joint::position_error::Ends;
use crate::joint::pull::{couples, pulls};
use d2m_contact::{
    Accuracy, Company, ContactPoint, Momenta, Present, SolverBody, Start, System, Velocity, add_impulses,
};
use glam::{DMat3, DVec3};
use std::borrow::Cow;

/// Residuals below this part of a gap a step are those of a solution.
const PRECISION: f64 = 1e-5;
/// The part of that which is aimed at.
const AIM: f64 = 1e-3;
/// And of crowds, and of what lies beside bodies that sleep, a speed, of the gap in a unit of time: a tenth of that of quiet bodies.
const STILL: f64 = 0.05;
/// Of bodies that move, this part of their speed, too.
const RELATIVE: f64 = 1.0 / 1024.0;
/// Where contacts share what room is left, so much less: what is left of solutions is taken from the same contacts again and again.
const SHARED: f64 = 1.0 / 64.0;
/// The part of a gap a step that the ends of flights may be off what joints ask for: what is more is not corrected but diverges, as where the
/// end of a long chain whips round, and shorter flights are solved for.
const OFF_JOINT: f64 = 1e-2;
/// Solutions with the spin of the flight's middle put right.
const CORRECTIONS: u32 = 3;
/// Of crowds, whose solutions are less exact than that.
const CROWD_CORRECTIONS: u32 = 1;
/// And with the ends of jointed bodies' flights put right.
const JOINT_CORRECTIONS: u32 = 8;
/// How many times further off than what is not corrected at all corrections are given up, which saves time where they diverge. Under brakes they may come
/// back from there.
const FAR_OFF: f64 = 8.0;
/// The part of a flight for which contacts with less than that keep some of it.
const LASTING: f64 = 1.0 / 16.0;
/// The part of what restores the gap that counts beforehand: where the law is not obeyed, nothing may be restored.
const RESTORED: f64 = 1.0 / 16.0;
/// How strong motors are where they stall, and then where no velocities are found with that: too strong for what is light among heavy bodies.
const STRENGTHS: [f64; 4] = [16.0, 1.0 / 64.0, 1.0 / 65_536.0, 1.0 / 67_108_864.0];
/// Is the turning of jointed bodies braked, where it is faster than flights?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brakes {
    None,
    OfOscillations,
}

/// Velocities for flights until `end`.
pub(crate) struct Attempt {
    pub(crate) span: Span,
    pub(crate) end: f64,
    pub(crate) system: System,
    pub(crate) accuracy: Accuracy,
    pub(crate) found: Found,
}

/// What a solution has found.
#[derive(Clone)]
pub(crate) struct Found {
    /// Those that count, with their impulses.
    pub(crate) contacts: Vec<ContactPoint>,
    /// Least rates of the contacts, and what impulses see to of that.
    pub(crate) targets: Vec<f64>,
    pub(crate) pushing: Vec<f64>,
    /// Of each member.
    pulled: Vec<Option<Pull>>,
    pub(crate) residual: f64,
    /// How far joints are off what they ask for at the end, as a rate.
    pub(crate) missed: f64,
    /// Do corrections of that lead further off?
    pub(crate) diverges: bool,
}

impl Attempt {
    /// Takes a solution whose spins are not put right: corrections lead further off where impulses have bodies turn far in a flight, of the middle of
    /// which nothing is known then, and each would make them faster.
    fn go_back(&mut self, solved: FirstSolved) {
        (self.found.residual, self.found.pulled) = (solved.residual, solved.pulled);
        self.system.bodies = solved.bodies;
        self.system.take_back(solved.present);
        self.system.store(&mut self.found.contacts);
    }

    /// Puts the couples that brake the bodies behind the other contacts.
    fn couple(&mut self, members: &[usize]) {
        self.found.contacts.truncate(self.found.targets.len());
        self.found.contacts.extend(couples(&self.system, members, &self.found.pulled));
    }

    /// Velocities of flights that also restore the gap, or make room for rotation; what kinetic energy that adds. The contacts keep the impulses that
    /// they have. None: there is nothing to restore, or no velocities are found that keep what room there is as long as the present ones do,
    /// which stay then.
    pub(crate) fn make_room(&mut self, inertia: &[(f64, DMat3)]) -> Option<f64> {
        if self.found.targets == self.found.pushing {
            return None;
        }
        let (begun, before) = (self.system.present(), self.system.doubled_energy(inertia));
        let could_last = self.may_last();
        // What is left against the speed of a lift may be more than the closest contacts have: then as exactly as of bodies at rest, from the same
        // beginning, since no round gains anything on a solution that is as good as it was to be.
        for relative in [self.accuracy.relative, 0.0] {
            self.system.take_back(begun.clone());
            let accuracy = Accuracy { relative, ..self.accuracy };
            self.system.solve(&self.found.targets, accuracy, Start::Present);
            if !could_last || self.lasts(|_| 0.0) {
                return Some(0.5 * (self.system.doubled_energy(inertia) - before));
            }
        }
        self.system.take_back(begun);
        None
    }

    /// Gives the contacts the impulses of the present velocities.
    pub(crate) fn store(&mut self, members: &[usize]) {
        self.system.store(&mut self.found.contacts);
        self.couple(members);
    }

    /// The part of what restores the gap at a contact that makes up for what the velocities are off the law.
    fn restored(&self, contact: usize) -> f64 {
        RESTORED * (self.found.targets[contact] - self.found.pushing[contact])
    }

    /// Do the contacts last, with some of what is still to be added to restore the gap?
    pub(crate) fn may_last(&self) -> bool {
        self.lasts(|k| self.restored(k))
    }

    /// Does each contact of which hardly any room is left keep some for a part of the flight that counts, if `added` is added to its rate?
    /// Velocities that are off the law by little against what bodies do elsewhere may use up the last of the gap in no time, and their next
    /// ones half of what is left then.
    fn lasts(&self, added: impl Fn(usize) -> f64) -> bool {
        let length = LASTING * self.span.remaining;
        self.found.contacts.iter().enumerate().all(|(k, contact)| {
            let is_met = contact.row.is_none() && !contact.is_expected;
            let is_tight = is_met && contact.distance < LAST * contact.gap;
            !is_tight || contact.shared_room() + (self.system.rate(k) + added(k)) * length >= 0.0
        })
    }
}

impl Problem<'_> {
    /// With brakes on what oscillates fast; in closed chains, as most mechanisms are, only where flights would not meet their joints without.
    pub(crate) fn attempt(&self, now: f64, end: f64, room: Room) -> Attempt {
        let attempt = |brakes: Brakes| self.attempt_with(now, end, room, brakes);
        if !self.may_be_braked() {
            return attempt(Brakes::None);
        }
        let is_closed = self.of_closed_chains().is_some();
        let free = is_closed.then(|| attempt(Brakes::None)).filter(|free| self.is_met(free));
        free.unwrap_or_else(|| attempt(Brakes::OfOscillations))
    }

    pub(crate) fn attempt_with(&self, now: f64, end: f64, room: Room, brakes: Brakes) -> Attempt {
        let (states, options) = (self.states, self.options);
        let place = |body: usize| self.place(body);
        let span =
            Span { remaining: end - now, step: options.step, resting_speed: options.resting_speed(), room };
        let prepare = |s: &RigidBody, v: Velocity| {
            let middle = s.turned(v.angular, 0.5 * span.remaining);
            body_at(s, v, s.inverse_inertia_at(middle))
        };
        let start = |s: &Cow<'_, RigidBody>| {
            if moves(s) { prepare(s, s.flight_velocity(span.remaining, options.gravity)) } else { still(s) }
        };
        let free: Vec<SolverBody> = states.iter().map(start).collect();
        let rows = select(self.contacts, span, |body| &free[place(body)]);
        let contacts: Vec<ContactPoint> = rows.iter().map(|row| *self.contacts[row.contact]).collect();
        let targets: Vec<f64> = rows.iter().map(|row| row.target).collect();
        let precision = PRECISION * options.gap / options.step;
        let slow = span.resting_speed.max(options.gap / options.step);
        let company = self.company;
        let relative = if room == Room::Shared { RELATIVE * SHARED } else { RELATIVE };
        let beside_sleepers = states.iter().any(|state| state.asleep);
        let mut accuracy =
            Accuracy { precision, relative, aim: AIM, slow, company, still: None, beside_sleepers };
        let pushing: Vec<f64> = rows.iter().map(|row| row.pushing).collect();
        // What a motor drives does not oscillate.
        let mut spins: Vec<Option<DVec3>> = free.iter().map(|body| Some(body.velocity.angular)).collect();
        self.driven().for_each(|driven| spins[driven] = None);
        let velocities = |c: &ContactPoint| [c.a, c.b].map(|body| free[place(body)].velocity);
        let in_turn = |c: &ContactPoint| in_common_turn(c, velocities(c), span.remaining);
        let running: Vec<[f64; 2]> = contacts.iter().map(in_turn).collect();
        let mut system = System::new(free, &contacts, place)
            .for_flights(&contacts, &targets, span.remaining)
            .with_running(&running);
        system.warm_start(&contacts);
        if beside_sleepers || accuracy.company == Company::Crowd && system.is_crowd() {
            accuracy.still = Some(STILL * options.gap);
        }
        let found = Found {
            contacts,
            targets,
            pushing,
            pulled: Vec::new(),
            residual: 0.0,
            missed: 0.0,
            diverges: false,
        };
        let mut attempt = Attempt { span, end, system, accuracy, found };
        let mut nearest: Option<(Found, Present)> = None;
        let (mut uncorrected, mut first_solved) = (None, None::<FirstSolved>);
        for correction in 0.. {
            let Attempt { system, found, .. } = &mut attempt;
            let start = if correction == 0 { Start::Sticking } else { Start::Present };
            found.residual = system.solve(&found.pushing, accuracy, start);
            if correction == 0 && found.residual > system.tolerance(accuracy) {
                self.stall_motors(system, found, accuracy);
            }
            system.store(&mut found.contacts);
            let tolerance = system.tolerance(accuracy);
            let solved = (correction == 0).then(|| (system.bodies.clone(), system.present()));
            if brakes == Brakes::OfOscillations {
                found.pulled = pulls(&found.pulled, states, &spins, &found.contacts, span.remaining, place);
            }
            let off = put_right(system, states, &found.contacts, span, place, &found.pulled);
            let is_off = off > tolerance;
            if let Some((bodies, present)) = solved.filter(|_| is_off) {
                let (residual, pulled) = (found.residual, found.pulled.clone());
                first_solved = Some(FirstSolved { residual, pulled, bodies, present, off });
            }
            let ends = Ends { joints: self.joints, states, span };
            let missed = ends.miss(system, &found.contacts, place);
            found.missed = missed.iter().map(|missed| missed.rate.abs()).fold(0.0, f64::max);
            let first = *uncorrected.get_or_insert(found.missed);
            found.diverges = found.missed > first;
            let is_far_off = brakes == Brakes::None && found.missed > FAR_OFF * first;
            let most = match (missed.is_empty(), system.is_crowd()) {
                (true, true) => CROWD_CORRECTIONS,
                (true, false) => CORRECTIONS,
                (false, _) => JOINT_CORRECTIONS,
            };
            if correction == most || is_far_off || !is_off && found.missed <= precision {
                let leads_off = |solved: &FirstSolved| missed.is_empty() && off > solved.off;
                if let Some(solved) = first_solved.filter(leads_off) {
                    attempt.go_back(solved);
                }
                if is_off {
                    attempt.system.renew();
                }
                break;
            }
            if nearest.as_ref().is_none_or(|(nearest, _)| found.missed < nearest.missed) && !missed.is_empty()
            {
                nearest = Some((found.clone(), system.present()));
            }
            for missed in missed {
                found.pushing[missed.row] -= missed.rate;
                found.targets[missed.row] -= missed.rate;
            }
            system.renew();
        }
        // Where no velocities lead to what joints ask for, as of a bridge without slack, corrections lead further and further off.
        let gets_nearer =
            |found: &Found| found.missed < attempt.found.missed && attempt.found.missed > precision;
        if let Some((found, present)) = nearest.filter(|(found, _)| gets_nearer(found)) {
            attempt.found = Found { diverges: attempt.found.diverges, ..found };
            attempt.system.take_back(present);
        }
        attempt.couple(self.members);
        attempt
    }

    /// No velocities obey contacts and a motor without a bound on its force that leads into them. Where none are found motors stall: they push with
    /// [`STRENGTHS`] times, at most, what stops all bodies there are, with what forces add in a step, and brings them to a slow speed.
    fn stall_motors(&self, system: &mut System, found: &mut Found, accuracy: Accuracy) {
        let rows = || found.contacts.iter().enumerate().filter_map(|(k, c)| Some((k, c, c.row?)));
        if rows().count() == found.contacts.len() || !rows().any(|(.., row)| row.is_motor) {
            return;
        }
        let moved = || self.states.iter().filter(|state| moves(state));
        let push = |state: &RigidBody| {
            let speed = state.velocity().surface_speed(state.radius)
                + self.options.gravity.length() * self.options.step;
            state.mass * speed
                + (state.force.length() + state.torque.length() / state.radius) * self.options.step
        };
        let (mass, pushes) = moved().fold((0.0, 0.0), |(mass, pushes), s| (mass + s.mass, pushes + push(s)));
        for strength in STRENGTHS {
            for (k, contact, row) in rows().filter(|(.., row)| row.is_motor) {
                let reach = || moved().map(|s| s.position.distance(contact.point) + s.radius);
                let arm = if row.is_angular { reach().fold(0.0, f64::max) } else { 1.0 };
                system
                    .bound(k, strength * arm * (pushes + mass * (arm * row.target.abs()).min(accuracy.slow)));
            }
            let (residual, before) = (found.residual, system.present());
            found.residual = system.solve(&found.pushing, accuracy, Start::Sticking);
            if found.residual <= system.tolerance(accuracy) {
                return;
            }
            if found.residual > residual {
                found.residual = residual;
                system.take_back(before);
            }
        }
    }

    /// Are joints met at the end of a flight, and do they go less than half round in it?
    pub(crate) fn is_met(&self, attempt: &Attempt) -> bool {
        self.ends_at_joints(attempt) && !self.turns_over(attempt)
    }

    /// Are joints met at the end of a flight, by whichever way?
    pub(crate) fn ends_at_joints(&self, attempt: &Attempt) -> bool {
        attempt.found.missed <= OFF_JOINT * self.speed()
    }

    /// Does a flight tear joints by more than a gap, after which nothing brings their bodies together again?
    pub(crate) fn is_torn(&self, attempt: &Attempt) -> bool {
        attempt.found.missed * attempt.span.remaining > self.options.gap || self.turns_over(attempt)
    }

    /// Does a joint go round a center by half a turn or more in a flight? Then where the flight ends says no more which way that was: joints are met
    /// there by any whole turns.
    fn turns_over(&self, attempt: &Attempt) -> bool {
        let goes_round = |body: usize, arm: DVec3| {
            let spin = attempt.system.bodies[self.place(body)].velocity.angular;
            spin.cross(arm).length() * attempt.span.remaining > core::f64::consts::PI * arm.length()
        };
        let equations = self.contacts.iter().filter(|c| c.row.is_some_and(|row| row.equation.is_some()));
        equations.into_iter().any(|c| goes_round(c.a, c.arm_a) || goes_round(c.b, c.arm_b))
    }
}

/// A solution whose spins are not put right.
struct FirstSolved {
    residual: f64,
    pulled: Vec<Option<Pull>>,
    bodies: Vec<SolverBody>,
    present: Present,
    /// By how much spins and angular momenta were off each other, as a speed.
    off: f64,
}

/// The spins that belong to the angular momenta with the impulses, and by how much they were others, as a speed of the surface.
fn put_right(
    system: &mut System,
    states: &[Cow<'_, RigidBody>],
    contacts: &[ContactPoint],
    span: Span,
    place: impl Fn(usize) -> usize,
    pulled: &[Option<Pull>],
) -> f64 {
    let mut added = vec![Momenta::default(); states.len()];
    add_impulses(contacts, &mut added, place);
    let mut worst = 0.0f64;
    for (k, ((body, state), added)) in system.bodies.iter_mut().zip(states).zip(&added).enumerate() {
        let pull = pulled.get(k).copied().flatten();
        if body.inverse_mass == 0.0 {
            continue;
        }
        let middle = state.angular_momentum
            + state.torque * state.lead.unwrap_or(0.5 * span.remaining)
            + added.angular;
        let spin = state.midpoint_spin(middle, span.remaining, pull);
        worst = worst.max((spin - body.velocity.angular).length() * state.radius);
        body.velocity.angular = spin;
        body.inverse_inertia = state.inverse_inertia_under(state.turned(spin, 0.5 * span.remaining), pull);
    }
    worst
}
