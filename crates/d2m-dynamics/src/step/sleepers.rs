//! Sleeping bodies in a heap of which parts move.

use super::connected::{Group, Sleepers};
use super::resolve::found_velocities;
use super::{Occasion, Step};
use crate::Simulation;
use crate::flight::group::Solved;
use crate::flight::length::Clock;
use crate::flight::rows::NEAR;
use crate::rest::quiet::QUIET_TIME;
use d2m_contact::{ContactPoint, Momenta};
use std::collections::BTreeMap;

/// A sleeping body wakes, when the step ends, where bodies that touch it change what it bears by more than
/// this part of a limit: the speed that its whole load in a step would give it, and the resting speed, by
/// which its surface would become faster. From the whole limit on it is solved with them at once.
const DISTURBED: f64 = 0.5;
/// The part of the resting speed that counts in that limit where bodies meet: an impact acts only once.
const MET: f64 = 1.0 / 8.0;

/// A sleeping body wakes with a body that it touches and that moves by so much of g t² more than quiet bodies
/// do in flights of length t. A body without support falls four times as far. Speeds of solutions on the way
/// to a precise one are off by less.
const FALLEN: f64 = 0.125;

/// The time over which the load of bodies is averaged, about: as long as a woken body stays awake at least.
const WEIGHED_TIME: f64 = 0.25 * QUIET_TIME;

/// The time over which other impulses on sleeping bodies are averaged, about: solutions shift a tenth and
/// more of the load between contacts from step to step.
const OWED_TIME: f64 = 4.0 * QUIET_TIME;
/// Friction could hold its least coefficient times the load of a body; this part of that may act on the body
/// for any time without waking it.
const HELD: f64 = 0.25;

/// The change of what acts on a sleeping body: the impulses of the solution without its load, and the load in
/// that time.
#[derive(Clone, Copy, Debug, Default)]
struct Change {
    momenta: Momenta,
    borne: f64,
}

impl Step<'_> {
    /// Wakes a body, which moves from `time` on. Impulses on it at this instant that are about to be taken
    /// back and solved again have acted on what holds it, not on its momenta: they are added to these first.
    pub(super) fn wake(&mut self, i: usize, time: f64, occasion: Occasion) {
        let body = &mut self.sim.bodies[i];
        body.wake(time);
        self.woken[i] = Some(time);
        if matches!(occasion, Occasion::Expected | Occasion::Plan { .. }) {
            for contact in self.undoable.iter().filter(|c| c.a == i || c.b == i) {
                body.push(contact.exerted(usize::from(contact.b == i)));
            }
        }
    }

    /// At the end of a step, averages the impulses on bodies that are awake, pair by pair, and on sleeping
    /// ones the difference to what they bore when they fell asleep. A difference that lasts wakes a body,
    /// however little it is in a step, if it exceeds a part of what friction holds. Bearing less than before,
    /// in the same direction, does not count: on a body that does not move away any push up to that obeys the
    /// law.
    pub(super) fn weigh(&mut self, end: f64) {
        if self.sleepers == Sleepers::Wake {
            return;
        }
        let Simulation { bodies, pairs, options, .. } = &mut *self.sim;
        let since = |i: usize| self.woken[i].unwrap_or(self.start);
        let mut changes = BTreeMap::<usize, (Change, f64)>::new();
        for (&(a, b), pair) in pairs.iter_mut() {
            let lasted = end - since(a).max(since(b));
            let pressed = self.pressed.get(&(a, b)).copied().unwrap_or_default();
            for (k, (i, other)) in [(a, b), (b, a)].into_iter().enumerate() {
                let borne = pair.borne[k];
                if !bodies[i].asleep {
                    pair.owed[k] = Momenta::default();
                    if lasted > 0.0 {
                        let part = (lasted / WEIGHED_TIME).min(1.0);
                        pair.borne[k] = borne.times(1.0 - part) + pressed[k].times(part / lasted);
                    }
                    continue;
                }
                if bodies[other].is_awake() && lasted > 0.0 {
                    let part = (lasted / OWED_TIME).min(1.0);
                    let more = pressed[k].times(1.0 / lasted) + borne.times(-1.0);
                    pair.owed[k] = pair.owed[k].times(1.0 - part) + more.times(part);
                }
                let load = borne.linear.length();
                let (change, friction) = changes.entry(i).or_insert((Change::default(), f64::INFINITY));
                change.momenta = change.momenta + pair.owed[k].without_less_of(borne);
                change.borne += load;
                let borne_by = pair.contacts.iter().filter(|_| load > 0.0);
                *friction = borne_by.map(|contact| contact.material.friction).fold(*friction, f64::min);
            }
        }
        let least = DISTURBED * options.resting_speed() / OWED_TIME;
        for (i, (Change { momenta, borne }, friction)) in changes {
            let body = &bodies[i];
            let held = if borne > 0.0 { HELD * friction * borne * body.inverse_mass } else { 0.0 };
            if body.gain(momenta) > least + held {
                self.disturbed.insert(i);
            }
        }
    }

    /// Was this body woken at this time?
    pub(super) fn has_woken(&self, i: usize, time: f64) -> bool {
        self.woken[i] == Some(time)
    }

    /// The bodies among these that are solved from the beginning. Where parts of heaps sleep, sleeping ones
    /// are left out, unless one of the bodies is kinematic.
    pub(super) fn awake_or_driven(&self, mut seeds: Vec<usize>, sleepers: Sleepers) -> Vec<usize> {
        let bodies = &self.sim.bodies;
        if sleepers == Sleepers::Bear && !seeds.iter().any(|&i| bodies[i].is_kinematic()) {
            seeds.retain(|&i| !bodies[i].asleep);
        }
        seeds
    }

    /// The sleeping bodies, ascending, that these solutions hit. Those that are hit by less will wake when
    /// the step ends.
    pub(super) fn hit(
        &mut self,
        group: &Group,
        solved: &[Solved],
        clock: Clock,
        occasion: Occasion,
    ) -> Vec<usize> {
        let bodies = &self.sim.bodies;
        let is_plan = matches!(occasion, Occasion::Plan { .. });
        if group.sleepers == Sleepers::Wake || is_plan || !bodies.iter().any(|body| body.asleep) {
            return Vec::new();
        }
        let mut changes: BTreeMap<usize, Change> = BTreeMap::new();
        let mut add = |i: usize, by: Momenta, borne: f64| {
            if bodies[i].asleep {
                let change = changes.entry(i).or_default();
                change.momenta = change.momenta + by;
                change.borne += borne;
            }
        };
        for contact in solved.iter().flat_map(|part| part.rests.iter().chain(&part.impacts)) {
            add(contact.a, contact.exerted(0), 0.0);
            add(contact.b, contact.exerted(1), 0.0);
        }
        // Contacts that have been solved in this step before have borne their part of the load already.
        let begins = |i: usize| clock.now == self.start || self.has_woken(i, clock.now);
        let length = clock.end - clock.now;
        for (&(a, b), pair) in &self.sim.pairs {
            for (i, other, borne) in [(a, b, pair.borne[0]), (b, a, pair.borne[1])] {
                let is_anew = group.is_member[other] && begins(other);
                let more = if is_anew { borne.times(-length) } else { Momenta::default() };
                add(i, more, borne.linear.length() * length);
            }
        }
        let resting = self.sim.options.resting_speed() * if occasion.is_event() { MET } else { 1.0 };
        let (mut hit, mut disturbed) = (Vec::new(), Vec::new());
        for (i, Change { momenta, borne }) in changes {
            let body = &bodies[i];
            let part = body.gain(momenta) / (resting + borne * body.inverse_mass);
            if part > 1.0 {
                hit.push(i);
            } else if part > DISTURBED {
                disturbed.push(i);
            }
        }
        self.disturbed.extend(disturbed);
        hit.extend(self.left(group, solved, clock));
        hit.sort_unstable();
        hit.dedup();
        hit
    }

    /// The sleeping bodies that touch a body which these solutions move by more than quiet ones move: they
    /// wake at the same time, not later.
    fn left(&self, group: &Group, solved: &[Solved], clock: Clock) -> Vec<usize> {
        let (bodies, gap) = (&self.sim.bodies, self.sim.options.gap);
        let found = found_velocities(solved);
        let (length, gravity) = (clock.end - clock.now, self.sim.options.gravity.length());
        let moves = |i: usize| {
            let body = &bodies[i];
            group.is_member[i] && group.may_move(body) && {
                let velocity = self.next_velocity(i, group, &found, clock);
                let falls = if body.is_dynamic() { FALLEN * gravity * length * length } else { 0.0 };
                body.quiet.is_left_by(body.surface_after(velocity, length), gap, falls)
            }
        };
        let touch = |contact: &&ContactPoint| contact.distance <= NEAR * contact.gap;
        let ends = group.contacts.iter().filter(touch).flat_map(|c| [(c.a, c.b), (c.b, c.a)]);
        ends.filter(|&(i, other)| bodies[i].asleep && moves(other)).map(|(i, _)| i).collect()
    }
}
