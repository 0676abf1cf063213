//! One step: velocities are solved for, then bodies fly from event to event.

mod connected;
mod event;
mod expect;
mod flights;
mod hold;
mod impulses;
mod plan;
mod resolve;
mod sense;
mod sleepers;
mod slide;

use crate::body::rigid_body::RigidBody;
use crate::flight::rows::HIT;
use crate::{ContactImpulse, ContactListener, Simulation, StepError, StepReport};
use connected::Sleepers;
use d2m_contact::{ContactPoint, Momenta};
use event::{Cause, Event};
use expect::Expected;
use glam::DVec3;
use plan::Replans;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet, BinaryHeap};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

/// Up to this number of pairs, events or islands threads cost more than they save.
const FEW_ITEMS: usize = 7;

/// A pair with more events than this at one time is held.
const MOST_AT_ONCE: u32 = 8;

/// Kinematic bodies may have this many events for each that a step may have: a body that is held in their way
/// would be crushed.
const DRIVEN: u32 = 16;

/// Bounces may have this many events for each that a step may have. A body between a wall and a body r times
/// as heavy that comes towards it bounces π √r times until that has turned back, 31 416 times at 10⁸, and
/// nearly all of that may be in one step.
const BOUNCES: u32 = 256;

/// Friction has locked what a kinematic body pushes where no more than this part of the gap is left: the room
/// has been halved twenty times, and can be halved ten times more.
const LOCKED: f64 = 1.0 / 1_048_576.0;

/// The reason why velocities are solved.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Occasion {
    /// The step begins.
    Start,
    /// Bodies meet, or flights end.
    Event,
    /// Bodies meet closer than they stopped before: all bodies that contacts connect with them are solved, to
    /// make room.
    Cramped,
    /// Flights that have just begun lead to contacts, which are solved together with them.
    Expected,
    /// Flights that have just begun have to end at `until` at the latest.
    Plan { until: f64 },
}

impl Occasion {
    /// Does it end flights?
    fn is_event(self) -> bool {
        matches!(self, Self::Event | Self::Cramped)
    }
}

/// A step in progress.
pub(crate) struct Step<'s> {
    sim: &'s mut Simulation,
    listener: &'s mut dyn ContactListener,
    start: f64,
    end: f64,
    /// Features up to this distance are contacts that a flight may have to obey.
    margin: f64,
    heap: BinaryHeap<Reverse<Event>>,
    report: StepReport,
    holding: bool,
    /// Bodies that friction has locked in the way of a kinematic body: they slide freely until the step ends.
    slips: BTreeSet<usize>,
    /// The number of events so far at which bodies bounced.
    bounces: u32,
    /// The impulses of motors so far in this step, by joint, with those that they owe from the last one.
    spent: BTreeMap<usize, f64>,
    replans: Replans,
    /// How often pairs of bodies that are not driven have met closer than they stopped before, in this step.
    cramped: BTreeMap<Key, u32>,
    /// The time at which flights end that were planned again.
    planned: Option<f64>,
    expected: Expected,
    /// The instant from which these are seen.
    expected_from: f64,
    /// The impulses of the present instant. `undoable`: those of resting contacts, which are taken back if
    /// flights are planned again.
    impulses: Vec<ContactPoint>,
    undoable: Vec<ContactPoint>,
    /// Impulses that are reported, and that the listener has not heard of.
    unheard: Vec<ContactImpulse>,
    /// Pairs between which impulses have acted, and what these added to the momenta of each body.
    pressed: BTreeMap<Key, [Momenta; 2]>,
    /// The time until which sensors have been evaluated.
    sensed: f64,
    /// When each body that slept was woken in this step.
    woken: Vec<Option<f64>>,
    /// The number of bodies, and whether there are joints, without places of removed ones.
    count: usize,
    has_joints: bool,
    sleepers: Sleepers,
    /// Sleeping bodies that will wake when the step ends.
    disturbed: BTreeSet<usize>,
}

type Key = (usize, usize);

impl<'s> Step<'s> {
    pub(crate) fn new(sim: &'s mut Simulation, end: f64, listener: &'s mut dyn ContactListener) -> Self {
        let options = &sim.options;
        let slow = options.resting_speed().max(options.gap / options.step);
        let margin = options.gap + slow * options.step;
        let start = sim.time;
        let woken = vec![None; sim.bodies.len()];
        let (count, has_joints) = (sim.len(), sim.has_joints());
        let owing = sim.joints.iter().enumerate().filter(|(_, joined)| joined.owed != 0.0);
        let spent = owing.map(|(number, joined)| (number, joined.owed)).collect();
        let sleepers = if sim.sleeps_in_parts() { Sleepers::Bear } else { Sleepers::Wake };
        Self {
            sim,
            listener,
            start,
            end,
            margin,
            heap: BinaryHeap::new(),
            report: StepReport::default(),
            holding: false,
            slips: BTreeSet::new(),
            bounces: 0,
            spent,
            replans: Replans::default(),
            cramped: BTreeMap::new(),
            planned: None,
            expected: Expected::default(),
            expected_from: start,
            impulses: Vec::new(),
            undoable: Vec::new(),
            unheard: Vec::new(),
            pressed: BTreeMap::new(),
            sensed: start,
            woken,
            count,
            has_joints,
            sleepers,
            disturbed: BTreeSet::new(),
        }
    }

    /// Flies to the end of the step. `before`: the simulation before it, as which it is left by an error before
    /// anything has moved; none where all sleep.
    pub(crate) fn run(mut self, before: Option<Simulation>) -> Result<StepReport, StepError> {
        // Listeners and motions are foreign code: where one panics the step ends as after an error, then the
        // panic goes on.
        let flown = catch_unwind(AssertUnwindSafe(|| self.fly_through().and_then(|()| self.sense(self.end))));
        let is_flown = matches!(flown, Ok(Ok(())));
        let heard = catch_unwind(AssertUnwindSafe(|| {
            self.report_impulses();
            if is_flown {
                self.tell();
            }
        }));
        let has_moved = is_flown || self.sim.time > self.start;
        match before.filter(|_| !has_moved) {
            Some(before) => *self.sim = before,
            // Also after an error: the flights until then are certified.
            None => self.finish(if is_flown { self.end } else { self.sim.time }),
        }
        heard.and(flown).unwrap_or_else(|panic| resume_unwind(panic))?;
        self.report.segments = self.sim.recorder.take();
        self.report.touches = core::mem::take(&mut self.sim.touches);
        self.report.touches.sort_by(|one, other| one.time.total_cmp(&other.time));
        Ok(self.report)
    }

    fn fly_through(&mut self) -> Result<(), StepError> {
        let awake: Vec<usize> =
            (0..self.sim.bodies.len()).filter(|&i| self.sim.bodies[i].is_awake()).collect();
        if awake.is_empty() {
            return Ok(());
        }
        for &i in &awake {
            let body = &mut self.sim.bodies[i];
            body.time = self.start;
            body.damp(self.end);
        }
        let sim = &mut *self.sim;
        for joined in sim.joints.iter_mut().filter(|joined| !joined.is_gone()) {
            joined.look(joined.bodies.map(|i| &sim.bodies[i]));
        }
        self.resolve(self.start, awake, Occasion::Start)?;
        self.solve_expected(self.start)?;
        let mut last = (f64::NEG_INFINITY, BTreeMap::<[usize; 2], u32>::new());
        while let Some(event) = self.next_event() {
            if self.plan_anew(&event)? {
                continue;
            }
            let (met, seeds) = self.gather(event);
            if event.time > last.0 {
                last = (event.time, BTreeMap::new());
            }
            self.report_impulses();
            #[cfg(feature = "audit")]
            self.conclude_flights(event.time);
            self.sense(event.time)?;
            self.cut(event.time);
            self.sim.time = event.time;
            let held = |i: usize| self.sim.bodies[i].held;
            let most = self.sim.options.max_events;
            let others = self.report.events - self.bounces;
            let over = [most, most.saturating_mul(DRIVEN)].map(|most| others >= most);
            let has_bounced = self.bounces >= most.saturating_mul(BOUNCES);
            let (hold, go_on): (Vec<Event>, Vec<Event>) = met.into_iter().partition(|event| {
                let count = last.1.entry(event.bodies).or_default();
                *count += 1;
                // This holds flights, too, that end again and again at one time, so that each step comes to
                // its end.
                let again = *count > MOST_AT_ONCE;
                let is_driven = event.bodies.into_iter().any(|i| self.sim.bodies[i].is_driven());
                let over = if self.bounces_at(event) { has_bounced } else { over[usize::from(is_driven)] };
                let over = over || !is_driven && event.bodies.into_iter().any(held);
                let stops = over || event.cause == Cause::Stuck;
                again || event.cause != Cause::Horizon && stops
            });
            if hold.is_empty() {
                self.release(event.time, &seeds);
                self.report.events +=
                    go_on.iter().filter(|event| event.cause != Cause::Horizon).count() as u32;
                self.bounces += go_on.iter().filter(|event| self.bounces_at(event)).count() as u32;
                self.let_slip(&go_on);
                let cramped: Vec<&Event> = go_on.iter().filter(|event| self.is_cramped(event)).collect();
                let occasion = if cramped.is_empty() { Occasion::Event } else { Occasion::Cramped };
                // What a driven body presses into a corner meets closer and closer anyway.
                let is_free =
                    |event: &&Event| !event.bodies.into_iter().any(|i| self.sim.bodies[i].is_driven());
                for event in cramped.into_iter().filter(is_free) {
                    *self.cramped.entry((event.bodies[0], event.bodies[1])).or_default() += 1;
                }
                self.resolve(event.time, seeds, occasion)?;
                self.solve_expected(event.time)?;
            } else {
                self.hold(event.time, &hold)?;
                // Events whose bodies fly on as before are next.
                self.heap.extend(go_on.into_iter().map(Reverse));
            }
        }
        Ok(())
    }

    /// The next event before the end of the step whose bodies have not begun other flights since.
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

    /// Do bodies bounce at this event, without a kinematic one among them?
    fn bounces_at(&self, event: &Event) -> bool {
        let [a, b] = event.bodies;
        event.cause == Cause::Contact
            && !event.bodies.into_iter().any(|i| self.sim.bodies[i].is_driven())
            && event.closing > self.sim.options.resting_speed()
            && self.sim.material(a, b).restitution > 0.0
    }

    /// Do these bodies meet closer than they stopped before?
    fn is_cramped(&self, event: &Event) -> bool {
        let key = (event.bodies[0], event.bodies[1]);
        event.cause == Cause::Contact
            && self.sim.pairs.get(&key).is_some_and(|pair| pair.nearest.is_some_and(|d| d <= HIT * pair.gap))
    }

    /// Dynamic bodies that friction locks in the way of a kinematic body until hardly any room is left slide
    /// freely for the rest of the step: the kinematic body does not yield, and no velocities obey the law of
    /// friction.
    fn let_slip(&mut self, events: &[Event]) {
        for event in events.iter().filter(|event| event.cause == Cause::Contact) {
            let key = (event.bodies[0], event.bodies[1]);
            let is_locked =
                self.sim.pairs.get(&key).is_some_and(|p| p.nearest.is_some_and(|d| d <= LOCKED * p.gap));
            let follows = event.bodies.into_iter().any(|i| self.sim.bodies[i].is_driven());
            if is_locked && follows {
                self.slips.extend(event.bodies.into_iter().filter(|&i| self.sim.bodies[i].is_dynamic()));
            }
        }
    }

    /// All events whose brackets overlap the first one's, and their bodies.
    fn gather(&mut self, first: Event) -> (Vec<Event>, Vec<usize>) {
        let (mut met, mut later) = (vec![first], Vec::new());
        while let Some(Reverse(event)) = self.heap.peek().copied() {
            if event.time > first.by || event.time >= self.end {
                break;
            }
            self.heap.pop();
            if !self.is_current(&event) {
                continue;
            }
            // A kinematic body begins its next flight where the present one ends, and not before.
            let follows = event.cause == Cause::Horizon && self.sim.bodies[event.bodies[0]].is_kinematic();
            if follows && event.time > first.time { later.push(event) } else { met.push(event) }
        }
        self.heap.extend(later.into_iter().map(Reverse));
        let mut seeds: Vec<usize> = met.iter().flat_map(|event| event.bodies).collect();
        // Flights that were planned to end here end with the event: their short rest would be a segment whose
        // velocity is far from that of its middle.
        if let Some(planned) = self.planned.take() {
            let ends = |body: &RigidBody| body.is_dynamic() && !body.held && body.horizon == planned;
            seeds.extend((0..self.sim.bodies.len()).filter(|&i| ends(&self.sim.bodies[i])));
        }
        seeds.sort_unstable();
        seeds.dedup();
        (met, seeds)
    }

    /// Ends the recorded segment.
    fn cut(&mut self, time: f64) {
        if self.holding {
            self.sim.recorder.cut_skipped(time);
        } else {
            self.sim.recorder.cut(time);
        }
    }

    /// Moves all bodies to the end of the step, and puts to sleep or wakes what has to be.
    fn finish(&mut self, time: f64) {
        let gravity = self.sim.options.gravity;
        #[cfg(feature = "audit")]
        self.conclude_flights(time);
        self.cut(time);
        let length = time - self.start;
        for body in self.sim.bodies.iter_mut().filter(|body| RigidBody::is_awake(body)) {
            body.advance(time, gravity);
            body.time = time;
            body.held = false;
        }
        self.settle_motors(time);
        self.sim.end_touches(self.start, &self.pressed);
        for body in &mut self.sim.bodies {
            (body.force, body.torque) = (DVec3::ZERO, DVec3::ZERO);
            if time == self.end {
                body.target = None;
            }
        }
        let energy: f64 = self.sim.bodies.iter().map(RigidBody::flight_energy).sum();
        self.sim.greatest_energy = self.sim.greatest_energy.max(energy);
        self.sim.time = time;
        self.weigh(time);
        self.sim.put_to_sleep(length);
        for i in core::mem::take(&mut self.disturbed) {
            self.sim.bodies[i].wake(time);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::listener::Nobody;
    use crate::{Body, Kind, SimulationOptions};
    use d2m_bvh::MeshTree;
    use d2m_motion::ConstantTwist;
    use std::sync::Arc;

    /// An event whose bracket holds the end of a kinematic flight does not end that flight: otherwise it
    /// would be queried past its end.
    #[test]
    fn kinematic_flights_end_where_they_end() {
        let cube = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()));
        let driven = Kind::Kinematic(Arc::new(ConstantTwist::REST));
        let mut sim = Simulation::new(SimulationOptions::default()).unwrap();
        sim.add(&Body::new("driven", Arc::clone(&cube)).with_kind(driven)).unwrap();
        sim.add(&Body::new("free", cube).with_position(DVec3::X * 5.0)).unwrap();
        let listener = &mut Nobody;
        let mut step = Step::new(&mut sim, 1.0, listener);
        let versions = [0, 1].map(|i| step.sim.bodies[i].version);
        let contact = Event {
            time: 0.1,
            by: 0.3,
            bodies: [0, 1],
            versions,
            cause: Cause::Contact,
            normal: DVec3::X,
            closing: 1.0,
        };
        let ends = |i: usize, time: f64| {
            let (bodies, versions) = ([i; 2], [versions[i]; 2]);
            Event { time, by: time, bodies, versions, cause: Cause::Horizon, ..contact }
        };
        step.heap.extend([ends(0, 0.2), ends(1, 0.2)].map(Reverse));
        assert_eq!(step.gather(contact), (vec![contact, ends(1, 0.2)], vec![0, 1]));
        assert_eq!(step.next_event(), Some(ends(0, 0.2)));
        step.heap.push(Reverse(ends(0, 0.1)));
        assert_eq!(step.gather(contact).0, [contact, ends(0, 0.1)]);
    }
}
