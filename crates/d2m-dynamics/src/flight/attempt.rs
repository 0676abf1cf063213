//! The velocities of the flights of one island until a given time: their targets, their solution, and the
//! corrections that lead flights to where they have to end.

use crate::body::rigid_body::RigidBody;
use crate::body::turning::Pull;
use crate::flight::common_turn::in_common_turn;
use crate::flight::problem::Problem;
use crate::flight::rows::{LAST, Room, Span, select};
use crate::flight::solved_body::{body_at, moves, still};
use crate::joint::position_error::{Ends, OFF_JOINT};
use crate::joint::pull::{couples, pulls};
use d2m_contact::{
    Accuracy, Company, ContactPoint, Momenta, Present, SolverBody, Start, System, Velocity, add_impulses,
};
use glam::{DMat3, DVec3};
use std::borrow::Cow;

/// A residual below this part of a gap a step is that of a solution.
const PRECISION: f64 = 1e-5;
/// The part of that precision that is aimed at.
const AIM: f64 = 1e-3;
/// Crowds, and bodies beside sleeping ones, may keep a residual of this times the gap in a unit of time: a
/// tenth of the speed of quiet bodies.
const STILL: f64 = 0.05;
/// Moving bodies may also leave this part of their speed.
const RELATIVE: f64 = 1.0 / 1024.0;
/// Where contacts share the room that is left, the relative residual is smaller by this factor: the residual
/// is taken from the room of the same contacts again and again.
const SHARED: f64 = 1.0 / 64.0;
/// The most solutions with the spin of the middle of the flight corrected.
const CORRECTIONS: u32 = 3;
/// The most for crowds, whose solutions are less exact than that.
const CROWD_CORRECTIONS: u32 = 1;
/// The most where the ends of jointed bodies' flights are corrected, too.
const JOINT_CORRECTIONS: u32 = 8;
/// Corrections are given up where joints are missed so many times as far as without any, which saves time
/// where they diverge. With brakes they may come back from there.
const FAR_OFF: f64 = 8.0;
/// Contacts with hardly any room left keep some for this part of a flight.
const LASTING: f64 = 1.0 / 16.0;
/// The part of the rate that restores the gap that counts beforehand: where the law is not obeyed, nothing
/// may be restored.
const RESTORED: f64 = 1.0 / 16.0;
/// Contacts ask for the rates at which they have to open. The velocities that bring these about have at most this
/// many times the kinetic energy of the bodies at the greatest of the rates: eight times that speed.
const ROOM_ENERGY: f64 = 64.0;
/// How strong a motor that stalls is; the later values are tried where no velocities are found with the
/// earlier ones, which are too strong for light bodies among heavy ones.
const STRENGTHS: [f64; 4] = [16.0, 1.0 / 64.0, 1.0 / 65_536.0, 1.0 / 67_108_864.0];
/// Is the rotation of jointed bodies braked where it oscillates faster than flights can follow?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Brakes {
    None,
    OfOscillations,
}

/// A solution: velocities for flights until `end`.
pub(crate) struct Attempt {
    pub(crate) span: Span,
    pub(crate) end: f64,
    pub(crate) system: System,
    pub(crate) accuracy: Accuracy,
    pub(crate) found: Found,
}

/// What the solution has found.
#[derive(Clone)]
pub(crate) struct Found {
    /// The contacts that count, with their impulses.
    pub(crate) contacts: Vec<ContactPoint>,
    /// The least rates of the contacts in the flight, and those that impulses bring about.
    pub(crate) targets: Vec<f64>,
    pub(crate) pushing: Vec<f64>,
    /// The pull on each member.
    pulled: Vec<Option<Pull>>,
    pub(crate) residual: f64,
    /// How far joints are off where flights end, as a rate.
    pub(crate) missed: f64,
    /// Do corrections make that larger?
    pub(crate) diverges: bool,
}

impl Attempt {
    /// Takes the first solution, whose spins are not corrected. Where impulses turn bodies far in a flight
    /// nothing is known of its middle: corrections lead further off, and each would make the bodies faster.
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

    /// Solves the velocities of flights that also restore the gap, or make room for rotation, and returns the
    /// kinetic energy that they add. The contacts keep their impulses. None, and the velocities stay: there
    /// is nothing to restore, or no velocities are found that keep the remaining room for as long as the
    /// present ones do.
    pub(crate) fn make_room(&mut self, inertia: &[(f64, DMat3)]) -> Option<f64> {
        if self.found.targets == self.found.pushing {
            return None;
        }
        let (begun, before) = (self.system.present(), self.system.doubled_energy(inertia));
        let could_last = self.may_last();
        // The residual, relative to the speed of a lift, may be more room than the closest contacts have.
        // Then it is solved as exactly as for bodies at rest, from the same start: a solution that is as good
        // as it had to be gains nothing by further rounds.
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

    /// Reduces the velocities that make room, on top of the `physical` ones, to [`ROOM_ENERGY`], and says
    /// whether they had more. The rate asked for is the greatest of the contacts, or `least`.
    ///
    /// Contacts that hold a body on all sides may ask for more room than there is. Where their normals are not
    /// quite in one plane all could be obeyed only by throwing the body out across that plane.
    pub(crate) fn limit_room(&mut self, physical: &[Velocity], inertia: &[(f64, DMat3)], least: f64) -> bool {
        let asked =
            self.found.targets.iter().zip(&self.found.pushing).map(|(target, pushing)| target - pushing);
        let speed = asked.fold(least, f64::max);
        let (mut energy, mut most) = (0.0, 0.0);
        for ((body, physical), (mass, inertia)) in self.system.bodies.iter().zip(physical).zip(inertia) {
            if body.inverse_mass > 0.0 {
                let room = body.velocity - *physical;
                energy += mass * room.linear.length_squared() + room.angular.dot(*inertia * room.angular);
                most += ROOM_ENERGY * mass * speed * speed;
            }
        }
        let is_limited = energy > most;
        if is_limited {
            let part = (most / energy).sqrt();
            for (body, physical) in self.system.bodies.iter_mut().zip(physical) {
                body.velocity = *physical + (body.velocity - *physical) * part;
            }
        }
        is_limited
    }

    /// Gives the contacts the impulses of the present velocities.
    pub(crate) fn store(&mut self, members: &[usize]) {
        self.system.store(&mut self.found.contacts);
        self.couple(members);
    }

    /// The part of the rate that restores the gap at a contact that may make up for a residual.
    fn restored(&self, contact: usize) -> f64 {
        RESTORED * (self.found.targets[contact] - self.found.pushing[contact])
    }

    /// Do contacts keep room, with some of the rate that is still to be added to restore the gap?
    pub(crate) fn may_last(&self) -> bool {
        self.lasts(|k| self.restored(k))
    }

    /// Does each contact with hardly any room left keep some for a part of the flight that counts, if `added`
    /// is added to its rate? Velocities whose residual is small against the speeds of other bodies may use up
    /// the last of the gap in no time, and the next ones half of what is left then.
    fn lasts(&self, added: impl Fn(usize) -> f64) -> bool {
        let length = LASTING * self.span.remaining;
        let keeps_some = |(k, contact): (usize, &ContactPoint)| {
            contact.shared_room() + (self.system.rate(k) + added(k)) * length >= 0.0
        };
        self.tight().all(keeps_some)
    }

    /// The contacts with hardly any room left, with their indices.
    fn tight(&self) -> impl Iterator<Item = (usize, &ContactPoint)> {
        self.found.contacts.iter().enumerate().filter(|(_, contact)| {
            let is_met = contact.row.is_none() && !contact.is_expected;
            is_met && contact.distance < LAST * contact.gap
        })
    }

    /// The greatest part of these changes of the velocities, one for each body, that leaves contacts with hardly
    /// any room `least` of the rate at which they open.
    pub(crate) fn most_of(&self, changes: impl Fn(usize) -> Velocity, least: f64) -> f64 {
        let most = |(k, contact): (usize, &ContactPoint)| {
            let opens = self.system.rate(k);
            let closes = -contact.rate(changes(contact.a), changes(contact.b));
            if opens > 0.0 && closes > 0.0 { (1.0 - least) * opens / closes } else { 1.0 }
        };
        self.tight().map(most).fold(1.0, f64::min)
    }
}

impl Problem<'_> {
    /// With brakes on fast oscillations. Closed chains, as most mechanisms are, are braked only where flights
    /// would not meet their joints otherwise.
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
        let acting = self.with_forces(end);
        let all: Cow<'_, [&ContactPoint]> = match &acting {
            Some(acting) => acting.iter().collect(),
            None => Cow::Borrowed(self.contacts),
        };
        let rows = select(&all, span, |body| &free[place(body)]);
        let contacts: Vec<ContactPoint> = rows.iter().map(|row| *all[row.contact]).collect();
        let targets: Vec<f64> = rows.iter().map(|row| row.target).collect();
        let precision = PRECISION * options.gap / options.step;
        let slow = span.resting_speed.max(options.gap / options.step);
        let company = self.company;
        let relative = if room == Room::Shared { RELATIVE * SHARED } else { RELATIVE };
        let beside_sleepers = states.iter().any(|state| state.asleep);
        let mut accuracy =
            Accuracy { precision, relative, aim: AIM, slow, company, still: None, beside_sleepers };
        let pushing: Vec<f64> = rows.iter().map(|row| row.pushing).collect();
        // Bodies that a motor drives do not oscillate.
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
            let ends = Ends { joints: self.joints, states, span, options };
            let missed = ends.miss(system, &found.contacts, &found.pushing, place);
            let counted = missed.iter().filter(|missed| missed.counts);
            found.missed = counted.map(|missed| missed.rate.abs()).fold(0.0, f64::max);
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
        // Where no velocities lead to where joints ask for, as in a bridge without slack, each correction
        // leads further off: the nearest one is taken.
        let gets_nearer =
            |found: &Found| found.missed < attempt.found.missed && attempt.found.missed > precision;
        if let Some((found, present)) = nearest.filter(|(found, _)| gets_nearer(found)) {
            attempt.found = Found { diverges: attempt.found.diverges, ..found };
            attempt.system.take_back(present);
        }
        attempt.couple(self.members);
        attempt
    }

    /// No velocities obey both contacts and a motor of unbounded force that leads into them. Where none are
    /// found motors stall: the impulse of each is at most [`STRENGTHS`] times what stops all bodies, with
    /// what forces add in a step, and brings them to a slow speed.
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

    /// Are joints met at the end of a flight, without going half round or more in it?
    pub(crate) fn is_met(&self, attempt: &Attempt) -> bool {
        self.ends_at_joints(attempt) && !self.turns_over(attempt)
    }

    /// Are joints met at the end of a flight, however they got there?
    pub(crate) fn ends_at_joints(&self, attempt: &Attempt) -> bool {
        attempt.found.missed <= OFF_JOINT * self.speed()
    }

    /// Does a flight tear joints by more than a gap, after which nothing brings their bodies together again?
    pub(crate) fn is_torn(&self, attempt: &Attempt) -> bool {
        attempt.found.missed * attempt.span.remaining > self.options.gap || self.turns_over(attempt)
    }

    /// Does a joint go round a center by half a turn or more in a flight? Then the end of the flight says no
    /// more which way it went: joints are met there after any number of whole turns.
    fn turns_over(&self, attempt: &Attempt) -> bool {
        let goes_round = |body: usize, arm: DVec3| {
            let spin = attempt.system.bodies[self.place(body)].velocity.angular;
            spin.cross(arm).length() * attempt.span.remaining > core::f64::consts::PI * arm.length()
        };
        let equations = self.contacts.iter().filter(|c| c.row.is_some_and(|row| row.is_equation()));
        equations.into_iter().any(|c| goes_round(c.a, c.arm_a) || goes_round(c.b, c.arm_b))
    }
}

/// A solution whose spins are not corrected.
struct FirstSolved {
    residual: f64,
    pulled: Vec<Option<Pull>>,
    bodies: Vec<SolverBody>,
    present: Present,
    /// By how much spins and angular momenta did not belong together, as a speed.
    off: f64,
}

/// Sets the spins that belong to the angular momenta with the impulses. Returns by how much they were others,
/// as a speed of the surface.
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
