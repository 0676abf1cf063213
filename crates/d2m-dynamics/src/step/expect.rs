//! Expected contacts: those that flights are certain to lead to are solved before they are met.

use super::event::{Cause, Event};
use super::{FEW_ITEMS, Key, Occasion, Step};
use crate::StepError;
use crate::body::rigid_body::RigidBody;
use crate::numbers::LEEWAY;
use crate::pairs::closest_features::{AROUND, measure};
use d2m_contact::ContactPoint;
use d2m_mesh::parallel::map_owned;
use glam::DVec3;
use std::collections::BTreeMap;

/// The most solutions from one instant, each with the contacts to which the flights of the last one led; four
/// times as many as long as the bodies of these contacts are no more than half of the first ones. A contact
/// beyond that is an event, after which all bodies whose flights it cuts are solved again. Where constraints
/// contradict each other, as at a body that is crushed, no round gets closer.
const MOST_ROUNDS: u32 = 4;

/// Expected contacts make no body faster than this many times the fastest speed before. A crushed body would
/// obey their rows by a rotation as fast as the arms of rows so far from their contact are wrong: then they
/// are left to events.
const RUNAWAY: f64 = 8.0;

/// Expected contacts, by pair, as they are seen from one instant.
pub(super) type Expected = BTreeMap<Key, Vec<ContactPoint>>;

/// A contact to which two flights lead, and when.
struct View<'s> {
    bodies: [&'s RigidBody; 2],
    /// When the flights begin, meet, and would end.
    time: f64,
    met: f64,
    end: f64,
}

impl View<'_> {
    /// The contact at which the flights meet, as a row for the velocities with which they begin.
    ///
    /// The points that will meet are d − rate (met − time) apart now, along the normal. Impulses that act at
    /// two points would add angular momentum, so both arms reach to one point: the middle of the two, or, if
    /// only one body moves, the point of that. This changes the rate along the normal by ω times the way by
    /// which the bodies slide along each other before they meet; the distance makes up for it.
    fn seen_now(&self, point: &ContactPoint) -> ContactPoint {
        let [va, vb] = self.bodies.map(RigidBody::present_velocity);
        let rate = |arm_a, arm_b| point.normal.dot(vb.of_point(arm_b) - va.of_point(arm_a));
        let centers = self.bodies.map(|body| body.pose_at(self.time).translation);
        let (arm_a, arm_b) = to_one_point(point, centers, self.bodies);
        let met = rate(point.arm_a, point.arm_b);
        let differs = rate(arm_a, arm_b) - met;
        let distance = point.distance - met * (self.met - self.time) - differs * (self.end - self.time);
        ContactPoint { arm_a, arm_b, distance, is_expected: true, ..*point }
    }

    /// Have these contacts other features, or do they differ in what they require of flights by as much as
    /// counts?
    fn differ(&self, old: &ContactPoint, new: &ContactPoint) -> bool {
        let [a, b] = self.bodies;
        let way = a.bound_approach(b) * (self.end - self.time);
        let off = (new.distance - old.distance).abs() + (new.normal - old.normal).length() * way;
        new.feature != old.feature || off > LEEWAY * new.gap
    }
}

/// The arms of a contact that both reach to one point: the middle of the two, or, if only one body moves, the
/// point of that.
fn to_one_point(point: &ContactPoint, centers: [DVec3; 2], [a, b]: [&RigidBody; 2]) -> (DVec3, DVec3) {
    let apart = (centers[1] + point.arm_b) - (centers[0] + point.arm_a);
    let share = match (a.is_dynamic(), b.is_dynamic()) {
        (true, true) => 0.5,
        (true, false) => 0.0,
        (false, _) => 1.0,
    };
    (point.arm_a + apart * share, point.arm_b - apart * (1.0 - share))
}

impl Step<'_> {
    /// An expected contact for flights that begin at `time`, also if it was seen from an earlier instant: the arms
    /// of two bodies that impulses move reach to one point then, too, so that these add no angular momentum.
    pub(super) fn seen_at(&self, time: f64, point: &ContactPoint) -> ContactPoint {
        let bodies = [point.a, point.b].map(|i| &self.sim.bodies[i]);
        if self.expected_from == time || !bodies.into_iter().all(RigidBody::is_dynamic) {
            return *point;
        }
        let (arm_a, arm_b) = to_one_point(point, bodies.map(|body| body.at(time).position), bodies);
        ContactPoint { arm_a, arm_b, ..*point }
    }

    /// Solves the flights that begin at `time` again with the contacts that they are certain to lead to,
    /// where these have no restitution: a body that another one stops anyway is braked so that it reaches
    /// that at the end of the step. This is the non-penetration constraint of time stepping (Anitescu and
    /// Potra 1997), linearised where the query has found the contact. It needs no impulse where bodies would
    /// miss each other, and its targets only allow approach, so it takes energy and adds none. What the
    /// linearisation leaves is an event like others.
    pub(super) fn solve_expected(&mut self, time: f64) -> Result<(), StepError> {
        (self.expected, self.expected_from) = (Expected::default(), time);
        let mut first = None;
        for round in 0..4 * MOST_ROUNDS {
            let events: Vec<Event> = self.heap.iter().map(|event| event.0).collect();
            let mut events: Vec<Event> = events.into_iter().filter(|e| self.is_expected(e, time)).collect();
            if events.is_empty() {
                break;
            }
            events.sort_unstable();
            let bodies = self.measure_expected(events, time);
            let first = *first.get_or_insert(bodies.len());
            if bodies.is_empty() || (round >= MOST_ROUNDS && 2 * bodies.len() > first) {
                break;
            }
            let before = self.fastest(0..self.sim.bodies.len());
            self.resolve(time, bodies.clone(), Occasion::Expected)?;
            if self.fastest(bodies.iter().copied()) > RUNAWAY * before {
                self.expected = Expected::default();
                return self.resolve(time, bodies, Occasion::Expected);
            }
        }
        Ok(())
    }

    /// The largest speed of a surface point of these bodies.
    fn fastest(&self, of: impl Iterator<Item = usize>) -> f64 {
        let speed = |body: &RigidBody| body.present_velocity().surface_speed(body.radius);
        of.map(|i| speed(&self.sim.bodies[i])).fold(0.0, f64::max)
    }

    /// Does this event end flights that begin at `time`, by a contact without restitution?
    fn is_expected(&self, event: &Event, time: f64) -> bool {
        let [a, b] = event.bodies;
        let begins = |i: usize| {
            let body = &self.sim.bodies[i];
            !body.held && (!body.is_dynamic() || body.asleep || body.time == time)
        };
        event.cause == Cause::Contact
            && event.time > time
            && event.time < self.end
            && self.is_current(event)
            && begins(a)
            && begins(b)
            && self.sim.material(a, b).restitution == 0.0
    }

    /// Measures the contacts of these events where they happen. Returns the bodies of those that are new.
    fn measure_expected(&mut self, events: Vec<Event>, time: f64) -> Vec<usize> {
        let sim = &*self.sim;
        let (most, end) = (self.margin, self.end);
        let found = map_owned(events, FEW_ITEMS, |event| {
            let key = (event.bodies[0], event.bodies[1]);
            let [a, b] = event.bodies.map(|i| &sim.bodies[i]);
            let gap = sim.pairs.get(&key).map_or(sim.options.gap, |pair| pair.gap);
            let way = a.bound_approach(b) * (end - event.time);
            let margin = (AROUND * sim.options.gap + way).min(most);
            // Contacts too close to be measured are left to the event itself.
            let measured = measure(
                &sim.bodies,
                key,
                event.time,
                margin,
                gap,
                sim.material(key.0, key.1),
                sim.contacts(key),
            )
            .unwrap_or_default();
            let view = View { bodies: [a, b], time, met: event.time, end };
            let known = self.expected.get(&key).map_or(&[][..], Vec::as_slice);
            let seen = measured.contacts.iter().map(|point| view.seen_now(point));
            let is_new = |contact: &ContactPoint| known.iter().all(|old| view.differ(old, contact));
            (key, seen.filter(is_new).collect::<Vec<_>>())
        });
        let mut bodies = Vec::new();
        for (key, contacts) in found.into_iter().filter(|(_, contacts)| !contacts.is_empty()) {
            self.expected.entry(key).or_default().extend(contacts);
            bodies.extend([key.0, key.1].into_iter().filter(|&i| self.sim.bodies[i].is_dynamic()));
        }
        bodies
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::rows::upright;
    use crate::listener::Nobody;
    use crate::{Body, Simulation, SimulationOptions};
    use d2m_bvh::MeshTree;
    use d2m_feature::FeaturePair;
    use d2m_mesh::Faces;
    use std::sync::Arc;

    /// The arms of a contact that was expected at an earlier instant reach to one point between the bodies, where
    /// they are by now: opposite impulses there add no angular momentum.
    #[test]
    fn contacts_seen_earlier_reach_to_one_point() {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()));
        let mut sim = Simulation::new(SimulationOptions::default()).unwrap();
        let places = [DVec3::ZERO, DVec3::new(0.1, 3.0, 0.2)];
        for (name, place) in ["one", "other"].into_iter().zip(places) {
            sim.add(&Body::new(name, Arc::clone(&tree)).with_position(place)).unwrap();
        }
        let listener = &mut Nobody;
        let step = Step::new(&mut sim, 1.0, listener);
        let point = upright([0, 1]);
        let now = step.seen_at(0.0, &point);
        assert_eq!([now.arm_a, now.arm_b], [point.arm_a, point.arm_b]);
        let later = step.seen_at(0.5, &point);
        let ends = [(0, later.arm_a), (1, later.arm_b)].map(|(i, arm)| step.sim.bodies[i].position + arm);
        assert!(ends[0].distance(ends[1]) < 1e-15, "{ends:?}");
        let before = places[0].midpoint(places[1]) + 0.5 * (point.arm_a + point.arm_b);
        assert!(ends[0].distance(before) < 1e-15, "{ends:?}");
    }

    /// Where a round leads to a contact that it has obeyed already, the next round would find the same.
    #[test]
    fn contacts_that_ask_for_the_same_are_not_new() {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=1&z=1").unwrap()));
        let faces = Arc::new(Faces::new(tree.mesh()));
        let moving = Body::new("", Arc::clone(&tree)).with_linear_velocity(DVec3::NEG_Y);
        let mut bodies = [Body::new("", tree), moving]
            .map(|body| RigidBody::try_new(&body, Arc::clone(&faces), 0.0).unwrap());
        for body in &mut bodies {
            body.fly(body.velocity(), 1.0);
        }
        let [a, b] = &bodies;
        let view = View { bodies: [a, b], time: 0.0, met: 0.5, end: 1.0 };
        let old = ContactPoint { gap: 1e-3, ..upright([0, 1]) };
        let turned = |angle: f64| DVec3::new(angle.sin(), angle.cos(), 0.0);
        let little = ContactPoint { distance: 1e-5, normal: turned(1e-5), ..old };
        assert!(!view.differ(&old, &old) && !view.differ(&old, &little));
        assert!(view.differ(&old, &ContactPoint { distance: 1e-4, ..old }));
        assert!(view.differ(&old, &ContactPoint { normal: turned(1e-3), ..old }));
        let feature = FeaturePair::VertexFace { vertex: 1, face: 0 };
        assert!(view.differ(&old, &ContactPoint { feature, ..old }));
    }
}
