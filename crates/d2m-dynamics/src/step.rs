//! One step: a velocity solve, then flights from contact to contact.

use crate::broad_phase::{Aabb, candidates};
use crate::contact::ContactPoint;
use crate::group::{Clock, Solved, islands, solve};
use crate::pairs::{Outcome, Pair, fly, measure, remember};
use crate::rigid_body::{RigidBody, Velocity};
use crate::simulation::query_error;
use crate::{BodyId, ContactImpulse, Simulation, StepError, StepReport, parallel};
use d2m_bvh::{QueryError, Window};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};

/// Events of one pair at one and the same time, after which it is held.
const MOST_AT_ONCE: u32 = 8;

/// Features within this many gaps are measured in any case.
const AROUND: f64 = 1.5;
/// And those within this many times the way that two bodies come closer in what is left of the step.
const APPROACH: f64 = 2.0;

/// Flights of a body are planned anew at most so often before something happens to it.
const MOST_REPLANS: u32 = 3;
/// Part of a body's speed that a flight's early end may leave in it from gravity to come.
const LOST_SPEED: f64 = 1e-3;
/// How much later than expected a flight that is planned anew ends, as a part of what it was cut by: the body should meet
/// what it meets before that.
const SPARE_TIME: f64 = 0.02;

/// Something that ends flights: at `time`, of bodies that have not begun another flight since.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Event {
    time: f64,
    /// Until when the bodies have certainly met.
    by: f64,
    bodies: [usize; 2],
    versions: [u64; 2],
    cause: Cause,
    /// From the first body to the second, and how fast they close along it.
    normal: DVec3,
    closing: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Cause {
    /// The bodies meet.
    Contact,
    /// The end of what the query could certify.
    Budget,
    /// Too close for any query.
    Stuck,
    /// A flight that was planned to end; both bodies are the same.
    Horizon,
}

impl Eq for Event {}

impl Ord for Event {
    fn cmp(&self, other: &Self) -> core::cmp::Ordering {
        let rest = |e: &Self| (e.bodies, e.versions, e.cause);
        self.time.total_cmp(&other.time).then_with(|| rest(self).cmp(&rest(other)))
    }
}

impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<core::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// A step in progress.
pub(crate) struct Step<'s> {
    sim: &'s mut Simulation,
    start: f64,
    end: f64,
    /// Features up to this distance are contacts that a flight may have to heed.
    margin: f64,
    heap: BinaryHeap<Reverse<Event>>,
    report: StepReport,
    holding: bool,
}

type Key = (usize, usize);

impl<'s> Step<'s> {
    pub(crate) fn new(sim: &'s mut Simulation, end: f64) -> Self {
        let options = &sim.options;
        let slow = options.resting_speed().max(options.gap / options.step);
        let margin = options.gap + slow * options.step;
        let start = sim.time;
        Self {
            sim,
            start,
            end,
            margin,
            heap: BinaryHeap::new(),
            report: StepReport::default(),
            holding: false,
        }
    }

    pub(crate) fn run(mut self) -> Result<StepReport, StepError> {
        let outcome = self.fly_through();
        // Also after an error: what was flown until then is certified.
        let time = if outcome.is_ok() { self.end } else { self.sim.time };
        self.finish(time);
        outcome?;
        self.report.segments = self.sim.recorder.take();
        Ok(self.report)
    }

    fn fly_through(&mut self) -> Result<(), StepError> {
        let awake: Vec<usize> =
            (0..self.sim.bodies.len()).filter(|&i| self.sim.bodies[i].is_awake()).collect();
        if awake.is_empty() {
            return Ok(());
        }
        for &i in &awake {
            self.sim.bodies[i].time = self.start;
        }
        self.resolve(self.start, awake, true)?;
        let mut last = (f64::NEG_INFINITY, BTreeMap::<[usize; 2], u32>::new());
        while let Some(event) = self.next_event() {
            if self.plan_anew(&event)? {
                continue;
            }
            let (met, seeds) = self.gather(event);
            if event.time > last.0 {
                last = (event.time, BTreeMap::new());
            }
            self.sim.recorder.cut(event.time, self.holding);
            self.sim.time = event.time;
            let held = |i: usize| self.sim.bodies[i].held;
            let over = self.report.events >= self.sim.options.max_events;
            let (hold, go_on): (Vec<Event>, Vec<Event>) = met.into_iter().partition(|event| {
                let count = last.1.entry(event.bodies).or_default();
                *count += 1;
                let again = *count > MOST_AT_ONCE;
                event.cause != Cause::Horizon
                    && (over || again || event.cause == Cause::Stuck || event.bodies.into_iter().any(held))
            });
            if hold.is_empty() {
                self.report.events +=
                    go_on.iter().filter(|event| event.cause != Cause::Horizon).count() as u32;
                self.resolve(event.time, seeds, false)?;
            } else {
                self.hold(event.time, &hold)?;
                // Those whose bodies fly on as before are next.
                self.heap.extend(go_on.into_iter().map(Reverse));
            }
        }
        Ok(())
    }

    /// The next event before the end of the step whose bodies still fly as they did.
    fn next_event(&mut self) -> Option<Event> {
        while let Some(Reverse(event)) = self.heap.pop() {
            if self.is_current(&event) {
                return (event.time < self.end).then_some(event);
            }
        }
        None
    }

    fn is_current(&self, event: &Event) -> bool {
        (0..2).all(|k| self.sim.bodies[event.bodies[k]].version == event.versions[k])
    }

    /// A flight that ends early has the velocity of the middle of a longer one: too fast for a body that falls, by what
    /// gravity adds in half of the rest. Bodies that nothing else touches get flights that were planned to end about when
    /// they meet. True if the flights are others now; then the event is none.
    ///
    /// With the acceleration g along the normal between the two bodies, a flight of length L closes at c₀ + g L/2, where the
    /// planned one, of length H, closed at c = c₀ + g H/2; they meet after s at c, so L (c + g (L − H)/2) = s c.
    fn plan_anew(&mut self, event: &Event) -> Result<bool, StepError> {
        if event.cause != Cause::Contact {
            return Ok(false);
        }
        let (now, gravity) = (self.sim.time, self.sim.options.gravity);
        let acceleration = |body: &RigidBody| {
            if body.is_dynamic() { gravity + body.force * body.inverse_mass } else { DVec3::ZERO }
        };
        let bodies = event.bodies.map(|i| &self.sim.bodies[i]);
        let horizon = bodies[0].horizon.min(bodies[1].horizon).min(self.end);
        let early = horizon - event.time;
        let planable = |body: &RigidBody| {
            let lost = acceleration(body).length() * early;
            body.is_dynamic()
                && body.free
                && !body.held
                && !body.asleep
                && body.horizon > event.time
                && body.replans < MOST_REPLANS
                && lost > LOST_SPEED * body.flight.linear_velocity().length()
        };
        if !event.bodies.into_iter().any(|i| planable(&self.sim.bodies[i]))
            || early <= 0.0
            || event.closing <= 0.0
        {
            return Ok(false);
        }
        let pull = event.normal.dot(acceleration(bodies[0]) - acceleration(bodies[1]));
        let (s, h) = (event.time - now, horizon - now);
        let rate = event.closing - 0.5 * pull * h;
        let root = rate * rate + 2.0 * pull * s * event.closing;
        // The root of L (rate + pull L/2) = s closing that stays finite without pull.
        let length = if root > 0.0 && rate + root.sqrt() > 0.0 {
            (2.0 * s * event.closing / (rate + root.sqrt())).clamp(s, h)
        } else {
            s
        };
        let planned = now + length + SPARE_TIME * (h - length);
        if !(planned > event.time && planned < horizon) {
            return Ok(false);
        }
        // All that fall, so that the energy of the segment is that of its own middle.
        let falling: Vec<usize> =
            (0..self.sim.bodies.len()).filter(|&i| planable(&self.sim.bodies[i])).collect();
        for &i in &falling {
            let body = &mut self.sim.bodies[i];
            body.advance(now, gravity);
            let until = planned.min(body.horizon);
            let velocity = body.flight_velocity(until, gravity);
            body.fly(velocity, until);
            body.replans += 1;
            self.sim.recorder.change(BodyId(i as u32), body.flight);
        }
        self.query(now, &falling)?;
        Ok(true)
    }

    /// All events whose brackets overlap the first one's, and the bodies of them.
    fn gather(&mut self, first: Event) -> (Vec<Event>, Vec<usize>) {
        let mut met = vec![first];
        while let Some(Reverse(event)) = self.heap.peek().copied() {
            if event.time > first.by || event.time >= self.end {
                break;
            }
            self.heap.pop();
            if self.is_current(&event) {
                met.push(event);
            }
        }
        let mut seeds: Vec<usize> = met.iter().flat_map(|event| event.bodies).collect();
        seeds.sort_unstable();
        seeds.dedup();
        (met, seeds)
    }

    /// The bodies of these events stand still until the end of the step.
    fn hold(&mut self, time: f64, events: &[Event]) -> Result<(), StepError> {
        let mut changed = Vec::new();
        for event in events {
            let [a, b] = event.bodies;
            let moving = |i: usize| {
                let body = &self.sim.bodies[i];
                body.is_kinematic() && body.surface_speed() > 0.0
            };
            let free = |body: &RigidBody| body.is_dynamic() && !body.held;
            let is_free = [a, b].map(|i| free(&self.sim.bodies[i]));
            if let Some((pushing, crushed)) = [(a, b, is_free[1]), (b, a, is_free[0])]
                .into_iter()
                .find_map(|(p, c, free)| (moving(p) && !free).then_some((p, c)))
            {
                return Err(self.crushed(pushing, crushed, time));
            }
            if is_free == [false, false] {
                return Err(self.crushed(a, b, time));
            }
            for (i, free) in [a, b].into_iter().zip(is_free) {
                if free {
                    let gravity = self.sim.options.gravity;
                    let body = &mut self.sim.bodies[i];
                    body.advance(time, gravity);
                    body.held = true;
                    body.asleep = false;
                    body.fly(Velocity::default(), self.end);
                    self.sim.recorder.change(BodyId(i as u32), body.flight);
                    changed.push(i);
                    self.holding = true;
                }
            }
        }
        // The other bodies of the events that were gathered fly on as they did: they are queried against those held.
        let others = events.iter().flat_map(|event| event.bodies).filter(|&i| !self.sim.bodies[i].held);
        let mut seeds: Vec<usize> = others.chain(changed).collect();
        seeds.sort_unstable();
        seeds.dedup();
        self.query(time, &seeds)
    }

    fn crushed(&self, pushing: usize, crushed: usize, time: f64) -> StepError {
        let name = |i: usize| self.sim.bodies[i].name.clone();
        // Whoever follows its motion against the body that is crushed is the one to name.
        let drives =
            |i: &usize| self.sim.bodies[*i].is_kinematic() && self.sim.bodies[*i].surface_speed() > 0.0;
        let partner = |(key, pair): (&Key, &Pair)| {
            let other = if key.0 == crushed { key.1 } else { key.0 };
            ((key.0 == crushed || key.1 == crushed) && pair.nearest.is_some()).then_some(other)
        };
        let driver = self.sim.pairs.iter().filter_map(partner).find(drives);
        let pushing = driver.unwrap_or(pushing);
        StepError::Crushed { pushing: name(pushing), crushed: name(crushed), time }
    }

    /// Solves the velocities of the seeds and of all that are in contact with them, and starts their flights.
    fn resolve(&mut self, time: f64, seeds: Vec<usize>, first: bool) -> Result<(), StepError> {
        let (group, contacts) = self.group(time, seeds, first)?;
        let gravity = self.sim.options.gravity;
        let end = self.end;
        for &i in &group {
            let body = &mut self.sim.bodies[i];
            if body.is_kinematic() && (first || body.horizon <= time) {
                body.time = time;
                body.follow(end, self.sim.options.gap);
                self.sim.recorder.change(BodyId(i as u32), body.flight);
            }
        }
        let clock = Clock { now: time, end };
        let found = islands(&self.sim.bodies, contacts);
        let (bodies, options) = (&self.sim.bodies, &self.sim.options);
        let solved = parallel::map(found, |island| solve(bodies, &island, clock, options));
        let mut flying = vec![false; self.sim.bodies.len()];
        for part in solved {
            for push in &part.bodies {
                let body = &mut self.sim.bodies[push.body];
                body.momentum += push.momentum;
                body.angular_momentum += push.angular_momentum;
                body.fly(push.velocity, push.horizon);
                body.free = false;
                flying[push.body] = true;
            }
            self.keep(part, time, first);
        }
        for &i in &group {
            let body = &mut self.sim.bodies[i];
            if body.is_dynamic() && !body.held && !flying[i] {
                let horizon = body.horizon_within(end, self.sim.options.step);
                let velocity = body.flight_velocity(horizon, gravity);
                body.fly(velocity, horizon);
                (body.free, body.replans) = (true, 0);
            }
            if body.is_dynamic() && !body.held {
                self.sim.recorder.change(BodyId(i as u32), body.flight);
            }
        }
        self.query(time, &group)
    }

    /// Reports impulses and keeps those of the step's own solve for the next one to begin with.
    fn keep(&mut self, solved: Solved, time: f64, first: bool) {
        for contact in solved.impacts.iter().chain(&solved.rests) {
            let impulse = contact.total();
            if impulse != DVec3::ZERO {
                self.sim.recorder.contact(ContactImpulse {
                    a: BodyId(contact.a as u32),
                    b: BodyId(contact.b as u32),
                    point: contact.point,
                    normal: contact.normal,
                    impulse: -impulse,
                    time,
                });
            }
        }
        if first {
            for contact in solved.rests {
                if let Some(pair) = self.sim.pairs.get_mut(&(contact.a, contact.b))
                    && let Some(kept) = pair.contacts.iter_mut().find(|c| c.feature == contact.feature)
                {
                    *kept = contact;
                }
            }
        }
    }

    /// The bodies that are connected with the seeds by contacts within the margin, moved to `time` and awake, and these
    /// contacts.
    fn group(
        &mut self,
        time: f64,
        seeds: Vec<usize>,
        first: bool,
    ) -> Result<(Vec<usize>, Vec<ContactPoint>), StepError> {
        let gravity = self.sim.options.gravity;
        let boxes: Vec<Aabb> =
            self.sim.bodies.iter().map(|body| Aabb::at(body, time, 0.5 * self.margin)).collect();
        let mut member = vec![false; boxes.len()];
        let mut group = Vec::new();
        let mut wave = seeds;
        let mut measured: BTreeSet<Key> = BTreeSet::new();
        let mut contacts = Vec::new();
        let mut near: Vec<Key> = Vec::new();
        while !wave.is_empty() {
            for &i in &wave {
                member[i] = true;
                let body = &mut self.sim.bodies[i];
                if body.is_dynamic() {
                    if body.asleep {
                        body.asleep = false;
                        body.time = time;
                    }
                    body.advance(time, gravity);
                }
                group.push(i);
            }
            let new: Vec<Key> =
                self.partners(&boxes, &wave).into_iter().filter(|key| !measured.contains(key)).collect();
            let sim = &*self.sim;
            let (most, step) = (self.margin, self.end - time);
            let found = parallel::map(new, |key| {
                let gap = sim.pairs.get(&key).map_or(sim.options.gap, |pair| pair.gap);
                // What is further apart than the present motion leads needs no row; if forces lead there all the same, the
                // flight ends at an event.
                let way = APPROACH * sim.bodies[key.0].bound_approach(&sim.bodies[key.1]) * step;
                let margin = (AROUND * sim.options.gap + way).min(most);
                (key, measure(&sim.bodies, key, time, margin, gap, sim.material(key.0, key.1)))
            });
            let mut next = Vec::new();
            for (key, answer) in found {
                measured.insert(key);
                let mut points = match answer {
                    Ok(points) => points,
                    // Closer than rounding: the query of the flight says so, too.
                    Err(QueryError::NotApart { .. }) => Vec::new(),
                    Err(error) => {
                        let (a, b) = (&self.sim.bodies[key.0], &self.sim.bodies[key.1]);
                        return Err(query_error(a, b, error).into());
                    }
                };
                if points.is_empty() {
                    if let Some(pair) = self.sim.pairs.get_mut(&key) {
                        pair.contacts.clear();
                        (pair.nearest, pair.gap) = (None, self.sim.options.gap);
                    }
                    continue;
                }
                near.push(key);
                let gap = self.sim.options.gap;
                let pair = self.sim.pairs.entry(key).or_insert_with(|| Pair::new(gap));
                remember(&mut points, &pair.contacts);
                pair.nearest = Some(points.iter().map(|p| p.distance).fold(f64::INFINITY, f64::min));
                pair.contacts.clone_from(&points);
                if !first {
                    // An event adds to the impulses of the step.
                    for point in &mut points {
                        (point.impulse, point.sliding) = (0.0, [0.0; 2]);
                    }
                }
                contacts.extend(points);
                for i in [key.0, key.1] {
                    let body = &self.sim.bodies[i];
                    if !member[i] && body.is_dynamic() && !body.held {
                        member[i] = true;
                        next.push(i);
                    }
                }
            }
            wave = next;
        }
        if first {
            let measured = &measured;
            let bodies = &self.sim.bodies;
            self.sim.pairs.retain(|key, _| {
                measured.contains(key) || !(bodies[key.0].is_awake() || bodies[key.1].is_awake())
            });
        }
        group.sort_unstable();
        contacts.sort_by_key(|c| (c.a, c.b));
        Ok((group, contacts))
    }

    /// The pairs of one of these bodies and any other whose boxes meet, and that may meet.
    fn partners(&self, boxes: &[Aabb], of: &[usize]) -> Vec<Key> {
        let sim = &*self.sim;
        if of.len() * 4 > boxes.len() {
            let mut is_one = vec![false; boxes.len()];
            for &i in of {
                is_one[i] = true;
            }
            return candidates(boxes, |a, b| (is_one[a] || is_one[b]) && sim.meets(a, b));
        }
        let mut pairs = Vec::new();
        for &i in of {
            for j in (0..boxes.len()).filter(|&j| j != i) {
                if boxes[i].may_meet(&boxes[j]) && sim.meets(i, j) {
                    pairs.push((i.min(j), i.max(j)));
                }
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// When do the flights of these bodies end? Every pair with one of them that may meet until the end of the step is
    /// queried.
    fn query(&mut self, time: f64, changed: &[usize]) -> Result<(), StepError> {
        let end = self.end;
        for &i in changed {
            let body = &self.sim.bodies[i];
            if body.horizon < end {
                let (bodies, versions) = ([i, i], [body.version; 2]);
                let (normal, closing) = (DVec3::ZERO, 0.0);
                let (time, by, cause) = (body.horizon, body.horizon, Cause::Horizon);
                let event = Event { time, by, bodies, versions, cause, normal, closing };
                self.heap.push(Reverse(event));
            }
        }
        // Two bodies are queried if boxes that hold the separation between them meet.
        let margin = self.sim.options.gap;
        let boxes: Vec<Aabb> = self.sim.bodies.iter().map(|body| Aabb::swept(body, end, margin)).collect();
        let keys = self.partners(&boxes, changed);
        let gap = self.sim.options.gap;
        let jobs: Vec<(Key, Pair)> = keys
            .into_iter()
            .map(|key| (key, self.sim.pairs.remove(&key).unwrap_or_else(|| Pair::new(gap))))
            .collect();
        self.report.queries += jobs.len() as u64;
        let (bodies, node_tests) = (&self.sim.bodies, self.sim.options.node_tests);
        let answers = parallel::map(jobs, |(key, mut pair)| {
            let (a, b) = (&bodies[key.0], &bodies[key.1]);
            let until = end.min(a.horizon).min(b.horizon);
            let answer = Window::try_new(time, until).and_then(|window| {
                fly(a, b, window, pair.separation(), pair.gap, node_tests, &mut pair.cache)
            });
            (key, pair, answer)
        });
        let mut failed = None;
        for (key, pair, answer) in answers {
            self.sim.pairs.insert(key, pair);
            let (a, b) = (&self.sim.bodies[key.0], &self.sim.bodies[key.1]);
            let event = |time: f64, by: f64, cause: Cause| Event {
                time,
                by,
                bodies: [key.0, key.1],
                versions: [a.version, b.version],
                cause,
                normal: DVec3::ZERO,
                closing: 0.0,
            };
            let event = match answer {
                Ok(Outcome::Clear) => continue,
                Ok(Outcome::Meets { lo, hi, normal, closing }) => {
                    Event { normal, closing, ..event(lo, hi, Cause::Contact) }
                }
                Ok(Outcome::ClearUntil(until)) if until > time => event(until, until, Cause::Budget),
                Ok(Outcome::ClearUntil(_) | Outcome::Stuck) => event(time, time, Cause::Stuck),
                Err(error) => {
                    failed = failed.or(Some(query_error(a, b, error)));
                    continue;
                }
            };
            self.heap.push(Reverse(event));
        }
        failed.map_or(Ok(()), |error| Err(error.into()))
    }

    /// Everything to the end of the step.
    fn finish(&mut self, time: f64) {
        let gravity = self.sim.options.gravity;
        self.sim.recorder.cut(time, self.holding);
        let length = time - self.start;
        for body in self.sim.bodies.iter_mut().filter(|body| RigidBody::is_awake(body)) {
            body.advance(time, gravity);
            body.time = time;
            body.held = false;
        }
        for body in &mut self.sim.bodies {
            (body.force, body.torque) = (DVec3::ZERO, DVec3::ZERO);
        }
        self.sim.time = time;
        self.sim.put_to_sleep(length);
    }
}
