//! Groups: bodies that contacts connect, and their contacts.

use super::{FEW_ITEMS, Key, Occasion, Step};
use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::flight::solved_body::moves;
use crate::joint::rows::Ahead;
use crate::pairs::closest_features::{AROUND, Measured, measure};
use crate::pairs::known::Pair;
use d2m_bvh::QueryError;
use d2m_contact::ContactPoint;
use d2m_mesh::parallel::map_owned;

/// Contacts also count within this many times the distance by which two bodies approach in the rest of the
/// step.
const APPROACH: f64 = 2.0;

/// What sleeping bodies do when bodies that touch them are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Sleepers {
    /// They bear these as fixed bodies do, unless a kinematic body touches them.
    Bear,
    #[default]
    Wake,
}

/// Bodies whose flights begin anew, and their contacts.
#[derive(Debug, Default)]
pub(super) struct Group {
    /// By body number.
    pub(super) is_member: Vec<bool>,
    /// In ascending order after [`Group::sort`].
    pub(super) members: Vec<usize>,
    /// All contacts of the members within the margin; in order after [`Group::sort`].
    pub(super) contacts: Vec<ContactPoint>,
    /// Pairs whose contacts are among those, or that have none; in ascending order after [`Group::sort`].
    measured: Vec<Key>,
    /// Have all pairs of a body been measured? By body number.
    is_measured: Vec<bool>,
    /// Joints whose rows are among the contacts, ascending.
    joints: Vec<usize>,
    pub(super) sleepers: Sleepers,
}

impl Group {
    pub(super) fn new(bodies: usize, sleepers: Sleepers) -> Self {
        let (is_member, is_measured) = (vec![false; bodies], vec![false; bodies]);
        Self { is_member, is_measured, sleepers, ..Self::default() }
    }

    /// Could this body be a member whose velocity is solved? A sleeping one could where it wakes.
    pub(super) fn may_move(&self, body: &RigidBody) -> bool {
        let bears = body.asleep && self.sleepers == Sleepers::Bear;
        body.is_dynamic() && !body.held && !bears
    }

    pub(super) fn sort(&mut self) {
        self.members.sort_unstable();
        self.measured.sort_unstable();
        self.contacts.sort_by_key(|c| (c.a, c.b));
    }

    /// Warm start: gives the contacts a part of the impulses that they had at this instant, before these were
    /// taken back.
    pub(super) fn warm(&mut self, retracted: &[ContactPoint], part: f64) {
        for known in retracted {
            let key = (known.a, known.b);
            let first = self.contacts.partition_point(|c| (c.a, c.b) < key);
            let of_pair = self.contacts[first..].iter_mut().take_while(|c| (c.a, c.b) == key);
            let is_same = |c: &&mut ContactPoint| {
                c.feature == known.feature && c.is_expected == known.is_expected && c.normal == known.normal
            };
            if let Some(contact) = of_pair.into_iter().find(is_same) {
                contact.impulse = part * known.impulse;
                contact.sliding = known.sliding.map(|x| part * x);
            }
        }
    }

    pub(super) fn has_measured(&self, key: Key) -> bool {
        self.measured.binary_search(&key).is_ok()
    }
}

impl Step<'_> {
    /// Takes back the impulses of this instant at resting contacts between the members, or with bodies that
    /// impulses do not move. A part of them is the warm start. Returns the bodies that had some.
    pub(super) fn retract(&mut self, group: &mut Group, part: f64) -> Vec<usize> {
        let bodies = &mut self.sim.bodies;
        let is_inner = |c: &mut ContactPoint| {
            [c.a, c.b].into_iter().all(|i| group.is_member[i] || !group.may_move(&bodies[i]))
                && (group.is_member[c.a] || group.is_member[c.b])
        };
        let inner: Vec<ContactPoint> = self.undoable.extract_if(.., is_inner).collect();
        for contact in &inner {
            let parts =
                [(contact.a, -contact.momenta(contact.arm_a)), (contact.b, contact.momenta(contact.arm_b))];
            for (i, pushed) in parts {
                if moves(&bodies[i]) {
                    bodies[i].retract(pushed);
                }
            }
        }
        group.warm(&inner, part);
        inner.iter().flat_map(|contact| [contact.a, contact.b]).filter(|&i| moves(&bodies[i])).collect()
    }

    /// Admits bodies, and all bodies that contacts connect with them.
    pub(super) fn admit_connected(
        &mut self,
        group: &mut Group,
        time: f64,
        seeds: Vec<usize>,
        occasion: Occasion,
    ) -> Result<(), StepError> {
        let mut ring = seeds;
        while !ring.is_empty() {
            ring = self.admit(group, time, &ring, occasion)?;
        }
        Ok(())
    }

    /// Adds the joint rows of some bodies. Returns the bodies that these connect with the group and that are
    /// not members yet.
    fn admit_joints(&mut self, group: &mut Group, of: &[usize], time: f64, occasion: Occasion) -> Vec<usize> {
        let sim = &mut *self.sim;
        let end = if let Occasion::Plan { until } = occasion { until } else { self.end };
        let (step, passed) = (sim.options.step, time - self.start);
        let ahead = Ahead { length: end - time, step, passed, spent: 0.0 };
        let is_solved_again = matches!(occasion, Occasion::Expected | Occasion::Plan { .. });
        let mut next = Vec::new();
        for (number, joined) in sim.joints.iter_mut().enumerate() {
            let Err(place) = group.joints.binary_search(&number) else { continue };
            if !of.iter().any(|&i| joined.has(i)) {
                continue;
            }
            group.joints.insert(place, number);
            let pair = joined.bodies.map(|i| sim.bodies[i].at(time));
            joined.look([&pair[0], &pair[1]]);
            let may_move = |i: usize| sim.bodies[i].is_dynamic() && !sim.bodies[i].held;
            // No impulse of a joint moves its bodies where none of them is dynamic any more: they may part.
            if !joined.bodies.into_iter().any(may_move) {
                continue;
            }
            joined.acted.begin(time, is_solved_again);
            let ahead = Ahead { spent: self.spent.get(&number).copied().unwrap_or_default(), ..ahead };
            group.contacts.extend(joined.rows(number, [&pair[0], &pair[1]], ahead));
            let is_new = |i: &usize| !group.is_member[*i] && may_move(*i);
            next.extend(joined.bodies.into_iter().filter(is_new));
        }
        next
    }

    /// Admits bodies, moved to `time` and awake, with their contacts. Returns the bodies that these connect
    /// with the group and that are not members yet.
    pub(super) fn admit(
        &mut self,
        group: &mut Group,
        time: f64,
        ring: &[usize],
        occasion: Occasion,
    ) -> Result<Vec<usize>, StepError> {
        let gravity = self.sim.options.gravity;
        for &i in ring {
            if core::mem::replace(&mut group.is_member[i], true) {
                continue;
            }
            if self.sim.bodies[i].is_dynamic() {
                if self.sim.bodies[i].asleep {
                    self.wake(i, time, occasion);
                }
                let body = &mut self.sim.bodies[i];
                let begins = body.time == time;
                body.advance(time, gravity);
                // The flight for the rest of the step keeps its plan if that is near enough to what its own
                // middle needs.
                let body = &self.sim.bodies[i];
                let goes_on = match occasion {
                    Occasion::Start | Occasion::Plan { .. } => false,
                    Occasion::Expected if begins => true,
                    Occasion::Expected | Occasion::Event | Occasion::Cramped => {
                        body.horizon >= self.end && self.is_balanced(body, time)
                    }
                };
                if !goes_on {
                    self.sim.bodies[i].lead = None;
                }
            }
            group.members.push(i);
        }
        // A body that stands still, or a kinematic one in its present flight, leads to no contact of its own.
        let begins = |&i: &usize| {
            let body = &self.sim.bodies[i];
            let follows = body.is_kinematic() && (occasion == Occasion::Start || body.horizon <= time);
            body.is_dynamic() || follows
        };
        let ring: Vec<usize> = ring.iter().copied().filter(begins).collect();
        let mut new = self.partners(&ring);
        new.retain(|&(a, b)| !(group.is_measured[a] || group.is_measured[b]));
        for &i in &ring {
            group.is_measured[i] = true;
        }
        group.measured.extend(&new);
        let sim = &*self.sim;
        let (most, step) = (self.margin, self.end - time);
        // Poses at one instant are the same however often flights from there are planned.
        let mut known = Vec::new();
        let mut unknown = Vec::new();
        for key in new {
            match sim.pairs.get(&key) {
                Some(pair) if pair.measured == Some(time) => {
                    if !pair.contacts.is_empty() || self.expected.contains_key(&key) {
                        known.push(key);
                    }
                }
                pair => unknown.push((key, pair)),
            }
        }
        let mut found = map_owned(unknown, FEW_ITEMS, |(key, pair)| {
            let (gap, reach) = pair.map_or((sim.options.gap, 1.0), |pair| (pair.gap, pair.reach));
            // Pairs that are further apart than they approach by their present motion need no row; if forces
            // bring them together all the same, the flight ends at an event.
            let way = reach * APPROACH * sim.bodies[key.0].bound_approach(&sim.bodies[key.1]) * step;
            let margin = (AROUND * sim.options.gap + way).min(most);
            let (a, b) = (&sim.bodies[key.0], &sim.bodies[key.1]);
            let is_far = pair.is_some_and(|pair| pair.is_beyond(margin, [a, b], time));
            let measured = if is_far {
                Ok(Measured { apart: margin, ..Measured::default() })
            } else {
                let before = pair.map_or(&[][..], |pair| &pair.contacts);
                measure(&sim.bodies, key, time, margin, gap, sim.material(key.0, key.1), before)
            };
            (key, Some(measured))
        });
        found.extend(known.into_iter().map(|key| (key, None)));
        found.sort_by_key(|(key, _)| *key);
        let mut next = self.admit_joints(group, &ring, time, occasion);
        for (key, answer) in found {
            let answer = match answer {
                Some(Ok(points)) => Some(points),
                None => None,
                // Closer than rounding: the query of the flight will say so, too.
                Some(Err(QueryError::NotApart { .. })) => Some(Measured::default()),
                Some(Err(error)) => {
                    let (a, b) = (&self.sim.bodies[key.0], &self.sim.bodies[key.1]);
                    return Err(a.query_error(b, error).into());
                }
            };
            // The step begins with the impulses of the last one; a body that has just woken with those that
            // it had; contacts that are solved again with those that were taken back.
            let part = match occasion {
                Occasion::Start => 1.0,
                _ if self.has_woken(key.0, time) || self.has_woken(key.1, time) => {
                    (self.end - time) / self.sim.options.step
                }
                _ => 0.0,
            };
            let seen =
                |points: &Vec<ContactPoint>| points.iter().map(|point| self.seen_at(time, point)).collect();
            let expected: Option<Vec<ContactPoint>> = self.expected.get(&key).map(seen);
            let gap = self.sim.options.gap;
            let pair = self.sim.pairs.entry(key).or_insert_with(|| Box::new(Pair::new(gap)));
            if let Some(measured) = answer {
                pair.keep(measured, time, gap);
            }
            if pair.contacts.is_empty() && expected.is_none() {
                continue;
            }
            let slips = self.slips.contains(&key.0) || self.slips.contains(&key.1);
            let with_friction = |point: &ContactPoint| {
                let mut point = *point;
                if slips {
                    point.material.friction = 0.0;
                }
                point
            };
            group.contacts.extend(expected.iter().flatten().map(with_friction));
            group.contacts.extend(pair.contacts.iter().map(with_friction).map(|mut point| {
                point.impulse *= part;
                point.sliding = point.sliding.map(|x| x * part);
                point
            }));
            for (i, other) in [key, (key.1, key.0)] {
                let body = &self.sim.bodies[i];
                // A kinematic body presses on others whether they sleep or not.
                let is_driven = || self.sim.bodies[other].is_kinematic() && body.is_dynamic() && !body.held;
                if !group.is_member[i] && (group.may_move(body) || is_driven()) {
                    next.push(i);
                }
            }
        }
        next.sort_unstable();
        next.dedup();
        Ok(next)
    }
}
