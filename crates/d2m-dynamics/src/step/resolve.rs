//! Solves the velocities of the flights that begin at an event.

use super::connected::{Group, Sleepers};
use super::{FEW_ITEMS, Key, Occasion, Step};
use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::flight::group::{CROWD, Push, Solved, islands, solve};
use crate::flight::length::Clock;
use crate::flight::path::Splits;
use crate::flight::solved_body::moves;
use crate::numbers::LEEWAY;
use d2m_contact::{Company, ContactPoint, Velocity};
use d2m_mesh::parallel::map_owned;
use std::collections::BTreeMap;

/// Rounds in which bodies are added on which others press; then all bodies that contacts connect are solved.
const MOST_ROUNDS: u32 = 4;
/// Rounds in which sleeping bodies wake where they are hit; then all sleeping bodies that contacts connect
/// wake.
const MOST_HITS: u32 = 16;
/// Flights of pairs that meet closer and closer are halved so often at most: 64 of them are a step.
const MOST_SHORTENED: u32 = 6;
/// A solution that moves no surface point of a body by more than this part of the gap in a step leaves its
/// flight as it is: a sixty-fourth of [`LEEWAY`], so that all contacts of a body together stay within that.
const SAME: f64 = 1.0 / 1024.0;
/// Expected contacts of up to so many bodies of a crowd are solved with the bodies on which these press, and
/// not with all that are connected.
const FEW: usize = 8;

/// The bodies that are solved at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Scope {
    /// Some bodies, and then those on which they press or that they let go.
    Nearby,
    /// All bodies that contacts connect.
    Connected,
}

impl Step<'_> {
    /// Solves the velocities of the seeds and of all that are in contact with them, and starts their flights.
    pub(super) fn resolve(
        &mut self,
        time: f64,
        seeds: Vec<usize>,
        occasion: Occasion,
    ) -> Result<(), StepError> {
        let sleepers = self.sleepers;
        let mut group = Group::new(self.sim.bodies.len(), sleepers);
        let seeds = self.awake_or_driven(seeds, sleepers);
        let until =
            if let Occasion::Plan { until } = occasion { until } else { self.end_of_flights(time, &seeds) };
        let clock = Clock { now: time, end: until };
        let renewed = if occasion.is_event() { seeds.clone() } else { Vec::new() };
        let is_local = match occasion {
            Occasion::Event => true,
            Occasion::Expected => self.count > CROWD && seeds.len() <= FEW,
            _ => false,
        };
        let scope = if is_local && !self.has_joints { Scope::Nearby } else { Scope::Connected };
        let solved = self.solve_in_rounds(&mut group, seeds, clock, occasion, scope)?;
        if !matches!(occasion, Occasion::Plan { .. } | Occasion::Expected) {
            append(&mut self.impulses, core::mem::take(&mut self.undoable));
        }
        if occasion == Occasion::Start {
            let bodies = &self.sim.bodies;
            self.sim.pairs.retain(|&key, _| {
                group.has_measured(key) || !(bodies[key.0].is_awake() || bodies[key.1].is_awake())
            });
        }
        // The bodies of an event begin another flight in any case: their present ones are certified no
        // further.
        let most = SAME * self.sim.options.gap / self.sim.options.step;
        let is_same = |body: &RigidBody, i: usize, velocity: Velocity, horizon: f64| {
            let off = velocity - body.present_velocity();
            occasion != Occasion::Start
                && renewed.binary_search(&i).is_err()
                && body.horizon == horizon
                && off.surface_speed(body.radius) <= most
        };
        let (gravity, step) = (self.sim.options.gravity, self.sim.options.step);
        let mut changed: Vec<usize> = Vec::new();
        let mut solved_for = vec![false; self.sim.bodies.len()];
        for part in solved {
            self.report.residual = self.report.residual.max(part.residual);
            if part.is_torn {
                return Err(self.too_fast(&part, time));
            }
            for push in &part.bodies {
                for joint in part.rests.iter().filter_map(ContactPoint::joint) {
                    self.sim.joints[joint].acted.fly_until(push.horizon);
                }
                let body = &mut self.sim.bodies[push.body];
                body.push(push.impact);
                body.push(push.rest);
                body.gained = push.gained;
                body.lead = Some(push.lead);
                body.free = false;
                if !is_same(body, push.body, push.velocity, push.horizon) {
                    body.try_fly(push.velocity, push.horizon, gravity)?;
                    changed.push(push.body);
                }
                solved_for[push.body] = true;
            }
            self.keep(part, occasion);
        }
        let splits = if self.count > CROWD { Splits::Common } else { Splits::Own };
        for &i in &group.members {
            let body = &mut self.sim.bodies[i];
            if moves(body) && !solved_for[i] {
                let horizon = body.horizon_within(until, step, splits);
                let length = horizon - time;
                let velocity = body.flight_velocity(length, gravity);
                body.lead = Some(body.lead.unwrap_or(0.5 * length));
                body.free = true;
                if !is_same(body, i, velocity, horizon) {
                    body.try_fly(velocity, horizon, gravity)?;
                    changed.push(i);
                }
            } else if body.is_kinematic() && body.flight.reference_time() == time {
                changed.push(i);
            }
        }
        changed.sort_unstable();
        for &i in &changed {
            self.sim.recorder.change(self.sim.bodies[i].id, self.sim.bodies[i].flight);
        }
        self.query(time, &changed)
    }

    /// When flights of these bodies that begin now end: with the step, or sooner where a pair of them has met closer
    /// and closer in it, each time after half as long. What spins together with a body that lies all round it goes
    /// on a curve: its straight flights lead into that, from any side, unless they are short.
    fn end_of_flights(&self, time: f64, bodies: &[usize]) -> f64 {
        let is_among = |(a, b): &Key| bodies.contains(a) || bodies.contains(b);
        let times = self.cramped.iter().filter(|(pair, _)| is_among(pair)).map(|(_, &times)| times).max();
        times.map_or(self.end, |times| {
            self.end.min(time + (self.end - self.start) / f64::from(1u32 << times.min(MOST_SHORTENED)))
        })
    }

    /// The error that names the fastest body of a solution.
    fn too_fast(&self, part: &Solved, time: f64) -> StepError {
        let speed = |push: &&Push| push.velocity.surface_speed(self.sim.bodies[push.body].radius);
        let fastest = part.bodies.iter().max_by(|x, y| speed(x).total_cmp(&speed(y)));
        let body = fastest.map_or_else(String::new, |push| self.sim.bodies[push.body].name.to_string());
        StepError::TooFast { body, time }
    }

    /// Kinematic members begin their next flight if the last one ends here.
    fn follow_motions(&mut self, group: &Group, clock: Clock, occasion: Occasion) -> Result<(), StepError> {
        for &i in &group.members {
            let body = &mut self.sim.bodies[i];
            if body.is_kinematic() && (occasion == Occasion::Start || body.horizon <= clock.now) {
                body.advance(clock.now, self.sim.options.gravity);
                body.follow(self.end, &self.sim.options)?;
                self.sim.recorder.change(body.id, body.flight);
            }
        }
        Ok(())
    }

    /// Among how many bodies a solution is: only residuals of the solve at the start of a step are solved
    /// again anyway.
    fn company(&self, occasion: Occasion) -> Company {
        match occasion {
            _ if self.count <= CROWD => Company::Few,
            Occasion::Start => Company::Crowd,
            _ => Company::Heap,
        }
    }

    /// The velocities of the members from the contacts between them and with bodies that impulses do not
    /// move. Islands without a `renewed` body (ascending) keep their solution `before`; the others begin with
    /// its impulses.
    fn solve_islands(
        &self,
        group: &mut Group,
        clock: Clock,
        before: Vec<Solved>,
        renewed: &[usize],
        occasion: Occasion,
    ) -> Vec<Solved> {
        let (bodies, options, joints) = (&self.sim.bodies, &self.sim.options, &self.sim.joints);
        let company = self.company(occasion);
        for part in &before {
            group.warm(&part.rests, 1.0);
        }
        let settled = |i: usize| group.is_member[i] || !group.may_move(&bodies[i]);
        let within = group.contacts.iter().filter(|c| settled(c.a) && settled(c.b)).collect();
        let mut known: BTreeMap<usize, Solved> = BTreeMap::new();
        for part in before {
            if let Some(first) = part.bodies.first() {
                known.insert(first.body, part);
            }
        }
        let islands = islands(bodies, within).into_iter().map(|island| {
            let ends = || island.contacts.iter().flat_map(|c| [c.a, c.b]);
            let is_new = ends().any(|i| renewed.binary_search(&i).is_ok());
            let first = ends().filter(|&i| moves(&bodies[i])).min();
            let part = first.filter(|_| !is_new).and_then(|first| known.remove(&first));
            (island, part)
        });
        let islands: Vec<_> = islands.collect();
        map_owned(islands, FEW_ITEMS, |(island, part)| {
            part.unwrap_or_else(|| solve(bodies, &island, clock, options, joints, company))
        })
    }

    /// An event changes the velocities of its bodies, and of those on which they then press or that they let
    /// go: a heap of bodies at rest is not solved again for an event on top of it. The same holds for
    /// contacts that are expected in a crowd. Sleeping bodies of a crowd are solved where the load on them
    /// changes.
    fn solve_in_rounds(
        &mut self,
        group: &mut Group,
        seeds: Vec<usize>,
        clock: Clock,
        occasion: Occasion,
        scope: Scope,
    ) -> Result<Vec<Solved>, StepError> {
        let (mut ring, mut solved, mut scope) = (seeds, Vec::new(), scope);
        for round in 0.. {
            if round == MOST_HITS {
                group.sleepers = Sleepers::Wake;
            }
            let goes_far = round == MOST_ROUNDS && scope == Scope::Nearby || round == MOST_HITS;
            if goes_far {
                scope = Scope::Connected;
            }
            match scope {
                Scope::Nearby => {
                    self.admit(group, clock.now, &ring, occasion)?;
                }
                Scope::Connected => self.admit_connected(group, clock.now, ring.clone(), occasion)?,
            }
            if goes_far {
                let rest = self.beyond(group);
                self.admit_connected(group, clock.now, rest, occasion)?;
                ring.clone_from(&group.members);
            }
            solved = self.solve_admitted(group, clock, occasion, solved, ring)?;
            ring = self.pressed(group, &solved, clock, scope);
            ring.extend(self.hit(group, &solved, clock, occasion));
            if ring.is_empty() {
                break;
            }
        }
        Ok(solved)
    }

    /// The bodies that the group's contacts connect with it and that are not members yet.
    fn beyond(&self, group: &Group) -> Vec<usize> {
        let is_beyond = |i: &usize| !group.is_member[*i] && group.may_move(&self.sim.bodies[*i]);
        group.contacts.iter().flat_map(|c| [c.a, c.b]).filter(is_beyond).collect()
    }

    /// Solves the velocities of the members after some have been admitted.
    fn solve_admitted(
        &mut self,
        group: &mut Group,
        clock: Clock,
        occasion: Occasion,
        before: Vec<Solved>,
        admitted: Vec<usize>,
    ) -> Result<Vec<Solved>, StepError> {
        group.sort();
        let mut renewed = admitted;
        if matches!(occasion, Occasion::Expected | Occasion::Plan { .. }) {
            renewed.extend(self.retract(group, (clock.end - clock.now) / (self.end - clock.now)));
        }
        renewed.sort_unstable();
        self.follow_motions(group, clock, occasion)?;
        Ok(self.solve_islands(group, clock, before, &renewed, occasion))
    }

    /// The velocity with which a body flies on.
    pub(super) fn next_velocity(
        &self,
        i: usize,
        group: &Group,
        found: &BTreeMap<usize, Velocity>,
        clock: Clock,
    ) -> Velocity {
        let body = &self.sim.bodies[i];
        match found.get(&i) {
            Some(velocity) => *velocity,
            None if group.is_member[i] && moves(body) => {
                body.flight_velocity(clock.end - clock.now, self.sim.options.gravity)
            }
            None => body.present_velocity(),
        }
    }

    /// The bodies outside of the group, ascending, that members with these velocities approach more closely
    /// than contacts allow, or that pressed on members that leave them.
    fn pressed(&self, group: &Group, solved: &[Solved], clock: Clock, scope: Scope) -> Vec<usize> {
        if scope == Scope::Connected {
            return Vec::new();
        }
        let velocities = found_velocities(solved);
        let velocity = |i: usize| self.next_velocity(i, group, &velocities, clock);
        let outside = |i: usize| !group.is_member[i] && group.may_move(&self.sim.bodies[i]);
        let length = clock.end - clock.now;
        let closes = |contact: &&ContactPoint| {
            let rate = contact.rate(velocity(contact.a), velocity(contact.b));
            let (distance, gap) = (contact.distance, contact.gap);
            distance + rate * length < distance.min(gap) - LEEWAY * gap
        };
        // A body outside pressed on a member and does so no more.
        let lets_go = |contact: &&ContactPoint| {
            let before = [contact.a, contact.b].map(|i| self.sim.bodies[i].present_velocity());
            let rate = contact.rate(velocity(contact.a), velocity(contact.b));
            let opens = rate - contact.rate(before[0], before[1]);
            contact.impulse > 0.0 && opens * length > LEEWAY * contact.gap
        };
        let crosses = |c: &&ContactPoint| {
            let ends = [c.a, c.b];
            ends.into_iter().any(outside) && ends.into_iter().any(|i| group.is_member[i])
        };
        let closing = group.contacts.iter().filter(crosses).filter(closes);
        let opening = self.undoable.iter().filter(crosses).filter(lets_go);
        let ends = closing.chain(opening).flat_map(|contact| [contact.a, contact.b]);
        let mut pressed: Vec<usize> = ends.filter(|&i| outside(i)).collect();
        pressed.sort_unstable();
        pressed.dedup();
        pressed
    }

    /// Keeps the impulses until the flights are flown. Those of the solve at the start of the step are the
    /// warm start of the next step.
    fn keep(&mut self, solved: Solved, occasion: Occasion) {
        let is_start =
            occasion == Occasion::Start || (occasion == Occasion::Expected && self.sim.time == self.start);
        if is_start {
            for contact in solved.rests.iter().filter(|contact| !contact.is_expected && contact.row.is_none())
            {
                if let Some(pair) = self.sim.pairs.get_mut(&(contact.a, contact.b))
                    && let Some(kept) = pair.contacts.iter_mut().find(|c| c.feature == contact.feature)
                {
                    *kept = *contact;
                }
            }
        }
        append(&mut self.impulses, solved.impacts);
        append(&mut self.undoable, solved.rests);
    }
}

/// Appends contacts to others. They are large: they are not copied if there are no others.
fn append(contacts: &mut Vec<ContactPoint>, mut others: Vec<ContactPoint>) {
    if contacts.is_empty() {
        *contacts = others;
    } else {
        contacts.append(&mut others);
    }
}

/// The velocities of the solutions, by body.
pub(super) fn found_velocities(solved: &[Solved]) -> BTreeMap<usize, Velocity> {
    solved.iter().flat_map(|part| &part.bodies).map(|push| (push.body, push.velocity)).collect()
}
