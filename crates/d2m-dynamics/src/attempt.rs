//! Velocities of the flights of one island: until when they can be solved for, and by which targets.

use crate::SimulationOptions;
use crate::contact::{
    Accuracy, Company, ContactPoint, LEFT_OVER, NEAR, Present, Room, SolverBody, Span, Start, System, add,
    select,
};
use crate::ends::Ends;
use crate::gained::{Gained, is_of_joints_alone};
use crate::joined::{Ahead, Joined};
use crate::momenta::Momenta;
use crate::pull::{couples, pulls, work};
use crate::rigid_body::{RigidBody, Splits};
use crate::solved_body::{body_at, moves, still, world_inertia};
use crate::taut::locked;
use crate::turning::Pull;
use crate::velocity::Velocity;
use glam::{DMat3, DVec3};
use std::borrow::Cow;

/// Residuals below this part of a gap a step are those of a solution.
const PRECISION: f64 = 1e-5;
/// The part of that which is aimed at.
const AIM: f64 = 1e-3;
/// Of bodies that move, this part of their speed, too.
const RELATIVE: f64 = 1.0 / 1024.0;
/// Solutions with the spin of the flight's middle put right.
const CORRECTIONS: u32 = 3;
/// Of crowds, whose solutions are less exact than that.
const CROWD_CORRECTIONS: u32 = 1;
/// And with the ends of jointed bodies' flights put right.
const JOINT_CORRECTIONS: u32 = 8;
/// How many times further off than what is not corrected at all corrections are given up, which saves time where they diverge. Under brakes they may come
/// back from there.
const FAR_OFF: f64 = 8.0;
/// Solutions, of these, whose impulses may brake what oscillates fast: the first one has no brakes, and what it has is rarely the force.
const PULLS: u32 = 2;
/// The part of twice the kinetic energy that the brakes of a flight may add: in a hundred flights not more than a hundredth.
const WORK: f64 = 1.0 / 16384.0;
/// Ratio of masses up to which jointed bodies are alike.
const LIKE: f64 = 4.0;
/// Moved bodies of an island from which on it flies to the end of the step however its bodies tumble.
const MANY: usize = 20;
/// The part of a gap a step that the ends of flights may be off what joints ask for: what is more is not corrected but diverges, as where the
/// end of a long chain whips round, and shorter flights are solved for.
const OFF_JOINT: f64 = 1e-2;
/// The square of the angle by which an oscillation leads in a flight, from which on flights make more of it: where impulses act at their starts.
const UNSTABLE: f64 = 4.0;
/// The part of the energy that flights gain which flights of half the length may gain: one quarter is due.
const LESS: f64 = 0.5;
/// Halvings of such flights.
const MOST_HALVINGS: u32 = 6;
/// The part of the rate at which something closes in, and how much more than solutions leave anyway, from which on no velocities obey the law.
const UNSOLVED: f64 = 1.0 / 8.0;
/// The part of that rate from which on friction holds what would slip.
const LOCKED: f64 = 0.5;
/// The part of the gap at which it does so no longer, and hardly any is left.
const LAST: f64 = 1.0 / 64.0;
/// The part of a flight for which contacts with less than that keep some of it.
const LASTING: f64 = 1.0 / 16.0;
/// The part of what restores the gap that counts beforehand: where the law is not obeyed, nothing may be restored.
const RESTORED: f64 = 1.0 / 16.0;
/// The part of the bodies' speed that solutions may leave in any case.
const OF_SPEED: f64 = 1.0 / 16.0;
/// How much longer than a flight that bodies at rest would survive one is that is tried first, a power of two: what closes in
/// from one side may be passed on through so many contacts.
const PASSED_ON: f64 = 64.0;
const SHORTENED: u32 = 6;

/// When and how long.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) now: f64,
    /// End of the step.
    pub(crate) end: f64,
}

/// How fast contacts close if what impulses move stands still, and how long they share their room then.
#[derive(Clone, Copy)]
struct Closing {
    rate: f64,
    safe: f64,
}

/// What friction does where it is in the way of what could move without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Friction {
    Slips,
    Locks,
    /// It has locked for as long as there was room.
    GivesWay,
}

/// Is the turning of jointed bodies braked, where it is faster than flights?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Brakes {
    None,
    OfOscillations,
}

/// What velocities are solved for.
#[derive(Clone, Copy)]
pub(crate) struct Problem<'s> {
    /// Body numbers, ascending, and the bodies, with their impacts.
    pub(crate) members: &'s [usize],
    pub(crate) states: &'s [Cow<'s, RigidBody>],
    pub(crate) contacts: &'s [ContactPoint],
    pub(crate) options: &'s SimulationOptions,
    pub(crate) joints: &'s [Joined],
    pub(crate) company: Company,
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
    missed: f64,
    /// Do corrections of that lead further off?
    diverges: bool,
}

impl Attempt {
    /// Puts the couples that brake the bodies behind the other contacts.
    pub(crate) fn couple(&mut self, members: &[usize]) {
        self.found.contacts.truncate(self.found.targets.len());
        self.found.contacts.extend(couples(&self.system, members, &self.found.pulled));
    }

    /// Velocities of flights that also restore the gap, or make room for rotation; what kinetic energy that adds. None: there is nothing to
    /// restore, or no velocities are found that keep what room there is as long as the present ones do, which stay then.
    pub(crate) fn make_room(&mut self, inertia: &[(f64, DMat3)], gap: f64) -> Option<f64> {
        if self.found.targets == self.found.pushing {
            return None;
        }
        let (begun, before) = (self.system.present(), self.system.doubled_energy(inertia));
        let could_last = self.lasts(gap, |k| self.restored(k));
        self.system.solve(&self.found.targets, self.accuracy, Start::Present);
        if could_last && !self.lasts(gap, |_| 0.0) {
            self.system.take_back(begun);
            return None;
        }
        self.system.store(&mut self.found.contacts);
        Some(0.5 * (self.system.doubled_energy(inertia) - before))
    }

    /// The part of what restores the gap at a contact that makes up for what the velocities are off the law.
    fn restored(&self, contact: usize) -> f64 {
        RESTORED * (self.found.targets[contact] - self.found.pushing[contact])
    }

    /// Does each contact of which hardly any room is left keep some for a part of the flight that counts, if `added` is added to its rate?
    /// Velocities that are off the law by little against what bodies do elsewhere may use up the last of the gap in no time, and their next
    /// ones half of what is left then.
    pub(crate) fn lasts(&self, gap: f64, added: impl Fn(usize) -> f64) -> bool {
        let length = LASTING * self.span.remaining;
        self.found.contacts.iter().enumerate().all(|(k, contact)| {
            let is_met = contact.row.is_none() && !contact.is_expected;
            let is_tight = is_met && contact.distance < LAST * gap;
            !is_tight || contact.shared_room() + (self.system.rate(k) + added(k)) * length >= 0.0
        })
    }
}

impl Problem<'_> {
    /// Velocities until the end of the step, or until the end of shorter flights: where bodies tumble; where joints are not met at the end of
    /// longer ones; and where bodies that follow their motions leave the others no velocities with which contacts keep the gap. There all
    /// contacts may close by a part of their distance, for as long as there are velocities with which none closes by more: then what room is
    /// left is shared by all, however little it is.
    pub(crate) fn solve(&self, clock: Clock) -> Attempt {
        let Clock { now, end } = clock;
        let moved = || self.states.iter().filter(|s| moves(s));
        // Bodies that are held keep their momenta and the time at which they were held: they have no flight that ends. Bodies that tumble in a
        // crowd meet others before the energy of their turning counts: it is not divided for one of them.
        let is_whole = self.company != Company::Few || moved().count() > MANY;
        let splits = if self.has_like_joints() { Splits::Jointed } else { Splits::Own };
        let horizon = |s: &Cow<'_, RigidBody>| s.horizon_within(end, self.options.step, splits);
        let mut end = if is_whole { end } else { moved().map(horizon).fold(end, f64::min) };
        let mut tried = self.attempt(now, end, Room::Kept);
        if let Some(stopped) = self.stopped(&tried, [now, end]) {
            return stopped;
        }
        let is_of_joints = is_of_joints_alone(self.states, self.contacts);
        let gained = |tried: &Attempt, end: f64| {
            Gained::of(self.states, &tried.system, self.options, [now, end - now])
        };
        for _ in 0..MOST_HALVINGS {
            let is_met = tried.found.missed <= OFF_JOINT * self.speed();
            let before = is_of_joints.then(|| gained(&tried, end)).filter(|gained| gained.is_much());
            if is_met && before.is_none() {
                break;
            }
            let half = now + 0.5 * (end - now);
            let shorter = self.attempt(now, half, Room::Kept);
            // What shorter flights gain as well comes from elsewhere.
            let gains_as_much = |before: Gained| gained(&shorter, half).energy > LESS * before.energy;
            if is_met && before.is_some_and(gains_as_much) {
                break;
            }
            (end, tried) = (half, shorter);
        }
        let closing = self.closing();
        let rate = closing.map_or(0.0, |closing| closing.rate);
        // Where no velocities obey the law the nearest ones may be as large as normals are askew: no faster than bodies were, or are driven.
        let speed = |s: &Cow<'_, RigidBody>| s.present_velocity().surface_speed(s.radius);
        let speed = tried.system.mean_speed().min(moved().map(speed).fold(rate, f64::max));
        let left = LEFT_OVER * tried.system.left(tried.accuracy);
        let most = left.max(OF_SPEED * speed).max(UNSOLVED * rate);
        let is_cramped = !self.lasts(&tried);
        if !is_cramped && (tried.found.residual <= most || closing.is_none()) {
            return tried;
        }
        let friction = match closing {
            _ if is_cramped => Friction::GivesWay,
            Some(closing) if tried.found.residual >= LOCKED * closing.rate => Friction::Locks,
            _ => Friction::Slips,
        };
        self.squeezed([now, end], closing, most, friction).unwrap_or(tried)
    }

    /// The bodies of closed chains as one, where their joints cannot be met at the end of a flight, nor of one half as long, because what pulls
    /// them taut turns them to and fro faster than flights could follow.
    fn stopped(&self, tried: &Attempt, [now, end]: [f64; 2]) -> Option<Attempt> {
        let half = now + 0.5 * (end - now);
        if !tried.found.diverges
            || !self.is_taut(tried)
            || !self.attempt(now, half, Room::Kept).found.diverges
        {
            return None;
        }
        let ahead = Ahead { length: end - now, step: self.options.step, forces: false };
        let (contacts, joints) = locked(self.members, self.states, self.contacts, self.joints, ahead)?;
        let attempt = Problem { contacts: &contacts, joints: &joints, ..*self }.attempt(now, end, Room::Kept);
        (attempt.found.missed <= OFF_JOINT * self.speed() && self.lasts(&attempt)).then_some(attempt)
    }

    /// Do joints pull bodies to and fro faster than flights could follow?
    fn is_taut(&self, attempt: &Attempt) -> bool {
        let spins: Vec<DVec3> = attempt.system.bodies.iter().map(|body| body.velocity.angular).collect();
        let length = attempt.span.remaining;
        let found = &attempt.found.contacts;
        let pulls = pulls(&[], self.states, &spins, found, length, |body| self.place(body));
        pulls.into_iter().flatten().any(|pull| pull.speed >= UNSTABLE)
    }

    /// Do joints hold bodies of like masses? Light ones between heavy ones are pulled to and fro faster than they turn.
    fn has_like_joints(&self) -> bool {
        let masses = || self.states.iter().filter(|s| moves(s)).map(|s| s.mass);
        let (least, most) = masses().fold((f64::INFINITY, 0.0f64), |(lo, hi), m| (lo.min(m), hi.max(m)));
        self.contacts.iter().any(|contact| contact.row.is_some()) && most <= LIKE * least
    }

    /// Do joints connect bodies of unlike masses?
    fn hangs_by_light_bodies(&self) -> bool {
        let rows = self.contacts.iter().filter(|contact| contact.row.is_some());
        let ends = rows.flat_map(|contact| [contact.a, contact.b]).map(|body| &self.states[self.place(body)]);
        let masses = ends.filter(|s| moves(s)).map(|s| s.mass);
        let (least, most) = masses.fold((f64::INFINITY, 0.0f64), |(lo, hi), m| (lo.min(m), hi.max(m)));
        most > LIKE * least
    }

    /// Do the contacts last, with some of what is still to be added to restore the gap?
    fn lasts(&self, attempt: &Attempt) -> bool {
        attempt.lasts(self.options.gap, |k| attempt.restored(k))
    }

    /// The longest flights, of some lengths, in which contacts close by no more than the room that they share, and solutions leave no more
    /// than `most`. If friction allows none, without: it can only hold what room there is. Where all is possible without friction, only what
    /// that locks shares room, as between wedges, and slips where hardly any is left: it crushes nothing by itself.
    fn squeezed(
        &self,
        [now, end]: [f64; 2],
        closing: Option<Closing>,
        most: f64,
        friction: Friction,
    ) -> Option<Attempt> {
        let contacts: Vec<ContactPoint> = self.contacts.iter().map(ContactPoint::without_friction).collect();
        let smooth = Problem { contacts: &contacts, ..*self };
        let slipping = smooth.attempt(now, end, Room::Kept);
        let obeys = |attempt: &Attempt| attempt.found.residual <= most && self.lasts(attempt);
        let is_possible = obeys(&slipping);
        match friction {
            Friction::Slips if is_possible => return None,
            Friction::GivesWay if is_possible => return Some(slipping),
            _ => {}
        }
        let Closing { safe, .. } = closing?;
        let lengths = (0..=SHORTENED).map(|k| PASSED_ON * safe / f64::from(1u32 << k));
        let ends = lengths.map(|length| if length < end - now { now + length } else { end });
        let ends: Vec<f64> = ends.filter(|&until| until > now).collect();
        let shared = |problem: &Problem<'_>, until: f64| {
            Some(problem.attempt(now, until, Room::Shared)).filter(|attempt| obeys(attempt))
        };
        if friction == Friction::GivesWay {
            // With friction, as long as that has flights no shorter than without.
            return longest(&ends, |until| shared(self, until).or_else(|| shared(&smooth, until)));
        }
        let of = |problem: &Problem<'_>| longest(&ends, |until| shared(problem, until));
        of(self).or_else(|| if is_possible { None } else { of(&smooth) })
    }

    /// A gap in a step.
    fn speed(&self) -> f64 {
        self.options.gap / self.options.step
    }

    /// How fast, and for how long, what follows its motion closes in on bodies that stand still. None: nothing does, within the gap or so.
    fn closing(&self) -> Option<Closing> {
        let of = |contact: &ContactPoint| {
            let state = |body: usize| &self.states[self.place(body)];
            let velocity = |body: usize| {
                if moves(state(body)) { Velocity::default() } else { state(body).present_velocity() }
            };
            let rate = -contact.rate(velocity(contact.a), velocity(contact.b));
            let is_moved = moves(state(contact.a)) || moves(state(contact.b));
            let is_near = contact.row.is_none() && contact.distance <= NEAR * contact.gap;
            let closing = || Closing { rate, safe: contact.shared_room() / rate };
            (is_near && is_moved && rate > 0.0).then(closing)
        };
        let worst = |x: Closing, y: Closing| Closing { rate: x.rate.max(y.rate), safe: x.safe.min(y.safe) };
        self.contacts.iter().filter_map(of).reduce(worst)
    }

    fn place(&self, body: usize) -> usize {
        self.members.binary_search(&body).unwrap_or_default()
    }

    /// With brakes on what oscillates fast, unless these do work that counts.
    fn attempt(&self, now: f64, end: f64, room: Room) -> Attempt {
        if self.hangs_by_light_bodies() {
            let braked = self.attempt_with(now, end, room, Brakes::OfOscillations);
            if self.is_quietly_braked(&braked) {
                return braked;
            }
        }
        self.attempt_with(now, end, room, Brakes::None)
    }

    /// Do the brakes add no energy that counts? What forces have pulled taut for longer than a flight turns little, and gives back what the
    /// brakes took; where something snaps taut they could add any.
    fn is_quietly_braked(&self, attempt: &Attempt) -> bool {
        let work = work(&attempt.system, &attempt.found.pulled);
        let inertia: Vec<(f64, DMat3)> = self.states.iter().map(|s| world_inertia(s)).collect();
        work <= WORK * attempt.system.doubled_energy(&inertia)
    }

    fn attempt_with(&self, now: f64, end: f64, room: Room, brakes: Brakes) -> Attempt {
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
        let rows = select(self.contacts, span, |body| free[place(body)].velocity);
        let contacts: Vec<ContactPoint> = rows.iter().map(|row| self.contacts[row.contact]).collect();
        let targets: Vec<f64> = rows.iter().map(|row| row.target).collect();
        let precision = PRECISION * options.gap / options.step;
        let slow = span.resting_speed.max(options.gap / options.step);
        let accuracy = Accuracy { precision, relative: RELATIVE, aim: AIM, slow, company: self.company };
        let pushing: Vec<f64> = rows.iter().map(|row| row.pushing).collect();
        let spins: Vec<DVec3> = free.iter().map(|body| body.velocity.angular).collect();
        let mut system = System::new(free, &contacts, place).for_flights(&contacts, &targets, span.remaining);
        system.warm_start(&contacts);
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
        let mut uncorrected = None;
        for correction in 0.. {
            let Attempt { system, found, .. } = &mut attempt;
            let start = if correction == 0 { Start::Sticking } else { Start::Present };
            found.residual = system.solve(&found.pushing, accuracy, start);
            system.store(&mut found.contacts);
            let tolerance = system.tolerance(accuracy);
            if brakes == Brakes::OfOscillations && correction < PULLS {
                found.pulled = pulls(&found.pulled, states, &spins, &found.contacts, span.remaining, place);
            }
            let is_off = put_right(system, states, &found.contacts, span, place, (&found.pulled, tolerance));
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
}

/// What is found for the latest of these times, descending, by bisection: the shorter flights are, the more may close in.
fn longest<T>(ends: &[f64], found: impl Fn(f64) -> Option<T>) -> Option<T> {
    let (mut from, mut to, mut best) = (0, ends.len(), None);
    while from < to {
        let middle = from + (to - from) / 2;
        match found(ends[middle]) {
            Some(answer) => (to, best) = (middle, Some(answer)),
            None => from = middle + 1,
        }
    }
    best
}

/// The spins that belong to the angular momenta with the impulses, where the linear ones are off by more than rounding.
fn put_right(
    system: &mut System,
    states: &[Cow<'_, RigidBody>],
    contacts: &[ContactPoint],
    span: Span,
    place: impl Fn(usize) -> usize,
    (pulled, tolerance): (&[Option<Pull>], f64),
) -> bool {
    let mut added = vec![Momenta::default(); states.len()];
    add(contacts, &mut added, place);
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
    worst > tolerance
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::Cell;

    /// Of seven lengths three are tried.
    #[test]
    fn the_longest_flights_are_found_by_bisection() {
        let ends: Vec<f64> = (1..=7).rev().map(f64::from).collect();
        for most in 0..=7 {
            let tried = Cell::new(0);
            let found = longest(&ends, |end| {
                tried.set(tried.get() + 1);
                Some(end).filter(|&end| end <= f64::from(most))
            });
            assert_eq!(found, (most > 0).then_some(f64::from(most)));
            assert_eq!(tried.get(), 3);
        }
    }
}
