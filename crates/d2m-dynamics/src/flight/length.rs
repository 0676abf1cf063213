//! How long the flights of an island are. A flight is a motion of constant velocities between two events; it
//! ends where no velocities can be solved for any further. Where there are none at all, contacts give way.

use crate::body::rigid_body::RigidBody;
use crate::flight::attempt::{Attempt, Brakes};
use crate::flight::path::Splits;
use crate::flight::problem::Problem;
use crate::flight::rows::{NEAR, Room};
use crate::flight::solved_body::moves;
use crate::joint::energy_gain::{Gained, is_of_joints_alone};
use crate::joint::pull::pulls;
use crate::joint::rows::Ahead;
use d2m_contact::{Company, ContactPoint, LEFT_OVER, Velocity};
use glam::DVec3;
use std::borrow::Cow;

/// An island with more moving bodies than this flies to the end of the step, however its bodies tumble.
const MANY: usize = 20;
/// The square of the angle by which an oscillation advances in a flight, (ω h)². From here on flights amplify
/// it, since impulses act at their starts.
const UNSTABLE: f64 = 4.0;
/// Flights of half the length gain a quarter of the energy if joints are the cause. If they gain more than
/// this part of it, something else is, and flights are not shortened any more.
const LESS: f64 = 0.5;
/// The most halvings of flights whose joints are not met at the end, or which gain energy.
const MOST_HALVINGS: u32 = 6;
/// The most such flights in a step: as many as a kinematic body may have.
const MOST_FLIGHTS: f64 = 4096.0;
/// The most where joints of unlike masses snap taut: light bodies take up the energy of heavy ones there, for
/// which no flight is short enough.
const MOST_OF_A_SNAP: f64 = 16.0;
/// No velocities obey the law where the residual is above this part of the rate at which a kinematic body
/// closes in, and above [`LEFT_OVER`] times what solutions leave anyway.
const UNSOLVED: f64 = 1.0 / 8.0;
/// From this part of that rate on, a residual means that friction holds contacts that would slip otherwise.
const LOCKED: f64 = 0.5;
/// The residual may be this part of the bodies' mean speed in any case.
const OF_SPEED: f64 = 1.0 / 16.0;
/// The first flight that is tried is so many times as long as one that bodies at rest would survive (a power
/// of two): a body that closes in from one side may push a row of so many contacts. It is halved so often,
/// down to the flight of bodies at rest.
const PASSED_ON: f64 = 64.0;
const SHORTENED: u32 = 6;
/// The most halvings of the rest of a step for flights that keep the gap, down to flights that share room.
const KEPT_HALVES: u32 = 16;
/// Two more halvings where bodies could not give way without friction either: in the shortest flights bodies
/// at rest use up a quarter of their room, since solutions are inexact where there is no room to spare.
/// Contacts that friction alone holds would be locked for as long as that.
const SHORTER: u32 = 2;

/// The present time and the end of the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clock {
    pub(crate) now: f64,
    /// End of the step.
    pub(crate) end: f64,
}

/// How fast kinematic bodies close in if the bodies that impulses move stand still, and how long contacts
/// share their room then.
#[derive(Clone, Copy)]
struct Closing {
    rate: f64,
    safe: f64,
}

/// The residuals that solutions may leave.
#[derive(Clone, Copy)]
struct Leaves {
    /// The usual residual. A larger one may come from the same contact in each flight, and use up its room
    /// while others still have some.
    usual: f64,
    /// The largest residual of velocities that count as obeying the law.
    most: f64,
    /// The largest speed of a body in a solution with the usual residual. A faster one would throw a body
    /// that is driven out of its place: it is solved with the largest residual instead.
    fastest: f64,
}

/// What friction does where bodies could move without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Friction {
    Slips,
    Locks,
    /// It has locked for as long as there was room.
    GivesWay,
}

impl Problem<'_> {
    /// Solves the velocities of the flights from now to the end of the step, or of shorter ones. Flights are
    /// shorter where bodies tumble, and where joints are not met at the end of longer ones. Where kinematic
    /// bodies leave no velocities with which contacts keep the gap, all contacts may close by a part of their
    /// distance; the flights last as long as there are velocities with which none closes by more. So all
    /// share what room is left, however little it is.
    pub(crate) fn solve(&self, clock: Clock) -> Attempt {
        let Clock { now, end } = clock;
        let moved = || self.states.iter().filter(|s| moves(s));
        // Held bodies keep their momenta and the time at which they were held: they have no flight that ends.
        // Bodies that tumble in a crowd meet others before the energy of their rotation counts: flights
        // aren't split for them.
        let is_whole = self.company != Company::Few || moved().count() > MANY;
        let splits = if self.has_like_joints() { Splits::Jointed } else { Splits::Own };
        let horizon = |s: &Cow<'_, RigidBody>| s.horizon_within(end, self.options.step, splits);
        let mut end = if is_whole { end } else { moved().map(horizon).fold(end, f64::min) };
        if self.has_rows() {
            // Joints are met where a kinematic body ends its flight, not where that would lead on.
            let driven = self.states.iter().filter(|s| s.is_kinematic() && s.horizon > now);
            end = driven.map(|s| s.horizon).fold(end, f64::min);
        }
        let mut tried = self.attempt(now, end, Room::Kept);
        while !self.keeps_energy_of_turning(&tried) {
            let half = now + 0.5 * (end - now);
            if half - now < self.options.step / MOST_FLIGHTS {
                break;
            }
            (end, tried) = (half, self.attempt(now, half, Room::Kept));
        }
        let longest = end;
        if let Some(stopped) = self.stopped(&tried, [now, end]) {
            return stopped;
        }
        let is_of_joints = is_of_joints_alone(self.states, self.contacts);
        let gained = |tried: &Attempt, end: f64| {
            Gained::of(self.states, &tried.system, self.options, [now, end - now])
        };
        // Flights of like bodies are halved down to the shortest before the joints' bodies are made one;
        // those of unlike bodies less often, and further only if they could not be made one.
        let limits =
            if self.has_like_joints() { &[MOST_FLIGHTS][..] } else { &[MOST_OF_A_SNAP, MOST_FLIGHTS] };
        for &most_flights in limits {
            for _ in 0..MOST_HALVINGS {
                let is_met = self.is_met(&tried);
                let before = is_of_joints.then(|| gained(&tried, end)).filter(|gained| gained.is_much());
                let half = now + 0.5 * (end - now);
                let shortest = self.options.step / if is_met { MOST_FLIGHTS } else { most_flights };
                if is_met && before.is_none() || half - now < shortest {
                    break;
                }
                let shorter = self.attempt(now, half, Room::Kept);
                // What shorter flights gain as well is not due to joints.
                let gains_as_much = |before: Gained| gained(&shorter, half).energy > LESS * before.energy;
                if is_met && before.is_some_and(gains_as_much) {
                    break;
                }
                (end, tried) = (half, shorter);
            }
            if self.is_met(&tried) {
                break;
            }
            if let Some(rigid) = self.snapped(&tried, [now, longest]) {
                return rigid;
            }
        }
        let closing = self.closing();
        let rate = closing.map_or(0.0, |closing| closing.rate);
        // Where no velocities obey the law the nearest ones may be very large, if normals are askew. So the
        // speed counts up to that of the fastest body before, or of what is driven.
        let speed = |s: &Cow<'_, RigidBody>| s.present_velocity().surface_speed(s.radius);
        let fastest = moved().map(speed).fold(rate, f64::max);
        let speed = tried.system.mean_speed().min(fastest);
        let left = LEFT_OVER * tried.system.left(tried.accuracy);
        let most = left.max(OF_SPEED * speed).max(UNSOLVED * rate);
        let is_cramped = !tried.may_last();
        if !is_cramped && (tried.found.residual <= most || closing.is_none()) {
            return tried;
        }
        let friction = match closing {
            _ if is_cramped => Friction::GivesWay,
            Some(closing) if tried.found.residual >= LOCKED * closing.rate => Friction::Locks,
            _ => Friction::Slips,
        };
        let leaves = Leaves { usual: left, most, fastest: fastest.max(self.speed()) };
        self.squeezed([now, end], closing, leaves, friction).unwrap_or(tried)
    }

    /// The speed of the fastest surface point of the bodies.
    fn fastest(&self, attempt: &Attempt) -> f64 {
        let bodies = self.states.iter().zip(&attempt.system.bodies).filter(|(s, _)| moves(s));
        bodies.map(|(s, body)| body.velocity.surface_speed(s.radius)).fold(0.0, f64::max)
    }

    /// The bodies of closed chains as one rigid body, where their joints cannot be met at the end of a
    /// flight, nor of one half as long, because forces that pull them taut turn them to and fro faster than
    /// flights can follow.
    fn stopped(&self, tried: &Attempt, [now, end]: [f64; 2]) -> Option<Attempt> {
        let half = now + 0.5 * (end - now);
        if !tried.found.diverges
            || !self.is_taut(tried)
            || !self.attempt(now, half, Room::Kept).found.diverges
        {
            return None;
        }
        self.closed_as_one([now, end])
    }

    /// The bodies of closed chains as one rigid body.
    fn closed_as_one(&self, span: [f64; 2]) -> Option<Attempt> {
        self.with_rigid(&self.of_closed_chains()?, span)
    }

    /// One rigid body where no flight is short enough for the joints: closed chains that motors drive, or
    /// otherwise the moving bodies that joints without motors connect.
    fn snapped(&self, tried: &Attempt, span: [f64; 2]) -> Option<Attempt> {
        let is_driven = self.driven().next().is_some();
        if let Some(stopped) = self.closed_as_one(span).filter(|_| is_driven) {
            return Some(stopped);
        }
        if self.has_like_joints() && !self.is_torn(tried) {
            return None;
        }
        self.with_rigid(&self.between_moved()?, span)
    }

    /// The bodies of these joints as one rigid body; motors do nothing then.
    fn with_rigid(&self, numbers: &[usize], [now, end]: [f64; 2]) -> Option<Attempt> {
        let ahead = Ahead { length: end - now, step: self.options.step, passed: 0.0, spent: 0.0 };
        let (contacts, joints) = self.locked(numbers, ahead);
        let contacts: Vec<&ContactPoint> = contacts.iter().collect();
        let rigid = Problem { contacts: &contacts, joints: &joints, ..*self };
        let attempt = rigid.attempt_with(now, end, Room::Kept, Brakes::None);
        (self.ends_at_joints(&attempt) && attempt.may_last()).then_some(attempt)
    }

    /// Do joints pull bodies to and fro faster than flights can follow?
    fn is_taut(&self, attempt: &Attempt) -> bool {
        let spins: Vec<Option<DVec3>> =
            attempt.system.bodies.iter().map(|body| Some(body.velocity.angular)).collect();
        let length = attempt.span.remaining;
        let found = &attempt.found.contacts;
        let pulls = pulls(&[], self.states, &spins, found, length, |body| self.place(body));
        pulls.into_iter().flatten().any(|pull| pull.speed >= UNSTABLE)
    }

    /// The longest flights, of some lengths, in which contacts close by no more than the room that they
    /// share, with the usual residual; or with the largest one, if there are none or they make bodies too
    /// fast. If there are none with friction, they are solved without: friction can only hold as long as
    /// there is room. Where all is possible without friction, only contacts that it locks share room, as
    /// between wedges, and they slip where hardly any is left: friction alone crushes nothing.
    fn squeezed(
        &self,
        [now, end]: [f64; 2],
        closing: Option<Closing>,
        leaves: Leaves,
        friction: Friction,
    ) -> Option<Attempt> {
        let contacts: Vec<ContactPoint> = self.contacts.iter().map(|c| c.without_friction()).collect();
        let contacts: Vec<&ContactPoint> = contacts.iter().collect();
        let smooth = Problem { contacts: &contacts, ..*self };
        let slipping = smooth.attempt(now, end, Room::Kept);
        let obeys = |attempt: &Attempt, most: f64| attempt.found.residual <= most && attempt.may_last();
        let is_possible = obeys(&slipping, leaves.most);
        match friction {
            Friction::Slips if is_possible => return None,
            Friction::GivesWay if is_possible => return Some(slipping),
            _ => {}
        }
        let Closing { safe, .. } = closing?;
        if let Some(kept) = self.kept([now, end], closing?, leaves) {
            return Some(kept);
        }
        let shortened = if is_possible { SHORTENED } else { SHORTENED + SHORTER };
        let lengths = (0..=shortened).map(|k| PASSED_ON * safe / f64::from(1u32 << k));
        let ends = lengths.map(|length| if length < end - now { now + length } else { end });
        let ends: Vec<f64> = ends.filter(|&until| until > now).collect();
        let found = |most: f64| {
            let shared = |problem: &Problem<'_>, until: f64| {
                Some(problem.attempt(now, until, Room::Shared)).filter(|attempt| obeys(attempt, most))
            };
            if friction == Friction::GivesWay {
                // With friction, as long as its flights are no shorter than those without.
                return longest(&ends, |until| shared(self, until).or_else(|| shared(&smooth, until)));
            }
            let of = |problem: &Problem<'_>| longest(&ends, |until| shared(problem, until));
            of(self).or_else(|| if is_possible { None } else { of(&smooth) })
        };
        let usual = found(leaves.usual).filter(|attempt| self.fastest(attempt) <= leaves.fastest);
        usual.or_else(|| found(leaves.most))
    }

    /// The longest flights that keep the gap, of a half, a quarter and so on of the rest of the step, where
    /// they are longer than those that would share room: bodies pushed towards a wall share none before they
    /// are there. None: too little room is left, or no such flights are found.
    fn kept(&self, [now, end]: [f64; 2], closing: Closing, leaves: Leaves) -> Option<Attempt> {
        let shared = PASSED_ON * closing.safe;
        let contacts = self.contacts.iter().filter(|contact| contact.row.is_none());
        let widest = contacts.map(|contact| contact.distance).fold(0.0, f64::max);
        if widest <= NEAR * self.options.gap {
            return None;
        }
        let whole = (end - now).min(widest / closing.rate);
        let lengths = (1..=KEPT_HALVES).map(|k| whole / f64::from(1u32 << k));
        let ends: Vec<f64> =
            lengths.take_while(|&length| length > shared).map(|length| now + length).collect();
        let keeps = |kept: &Attempt| kept.found.residual <= leaves.most && kept.may_last();
        let is_slow = |kept: &Attempt| self.fastest(kept) <= leaves.fastest + self.speed();
        let tried = |until: f64| Some(self.attempt(now, until, Room::Kept));
        longest(&ends, |until| tried(until).filter(|kept| keeps(kept) && is_slow(kept)))
    }

    /// How fast kinematic bodies close in on bodies that stand still, and for how long. None: none does, at
    /// contacts that are within one and a half gaps or expected.
    fn closing(&self) -> Option<Closing> {
        let of = |contact: &ContactPoint| {
            let state = |body: usize| &self.states[self.place(body)];
            let velocity = |body: usize| {
                if moves(state(body)) { Velocity::default() } else { state(body).present_velocity() }
            };
            let rate = -contact.rate(velocity(contact.a), velocity(contact.b));
            let is_moved = moves(state(contact.a)) || moves(state(contact.b));
            // Expected contacts count at any distance: bodies make way there before the other one has come.
            let is_met = contact.is_expected || contact.distance <= NEAR * contact.gap;
            let is_near = contact.row.is_none() && is_met;
            let closing = || Closing { rate, safe: contact.shared_room() / rate };
            (is_near && is_moved && rate > 0.0).then(closing)
        };
        let worst = |x: Closing, y: Closing| Closing { rate: x.rate.max(y.rate), safe: x.safe.min(y.safe) };
        self.contacts.iter().filter_map(|contact| of(contact)).reduce(worst)
    }
}

/// The answer for the latest of these times (descending) for which there is one, by bisection: if there is
/// one for some time there is one for every earlier time, since less closes in.
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
