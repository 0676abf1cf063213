//! Queries of when flights end.

use super::event::{Cause, Event};
use super::{FEW_ITEMS, Key, Step};
use crate::StepError;
use crate::pairs::clearance::are_spheres_apart;
#[cfg(feature = "audit")]
use crate::pairs::concluded::conclude;
use crate::pairs::known::{Outcome, Pair, fly};
use d2m_bvh::Window;
#[cfg(feature = "audit")]
use d2m_bvh::audit::Place;
use d2m_mesh::parallel::map_owned;
use glam::DVec3;
use std::cmp::Reverse;

impl Step<'_> {
    /// Finds when the flights of these bodies end: each pair with one of them that may meet before the end of
    /// the step is queried.
    pub(super) fn query(&mut self, time: f64, changed: &[usize]) -> Result<(), StepError> {
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
        // Two bodies are queried if boxes around their flights, grown by the distance that is kept, meet.
        let mut keys = self.partners(changed);
        let bodies = &self.sim.bodies;
        let gap = self.sim.options.gap;
        // Two bodies that stand still stay as far apart as they are.
        keys.retain(|&(a, b)| {
            let (a, b) = (&bodies[a], &bodies[b]);
            let stay_apart = a.stands_still() && b.stands_still();
            let spheres_apart = are_spheres_apart(a, b, time, end, gap);
            #[cfg(feature = "audit")]
            if spheres_apart {
                conclude(Place::DynamicsClearance, [a, b], [time, end], gap);
            }
            !(stay_apart || spheres_apart)
        });
        self.report.queries += keys.len() as u64;
        let sim = &mut *self.sim;
        for &key in &keys {
            sim.pairs.entry(key).or_insert_with(|| Box::new(Pair::new(gap)));
        }
        let (bodies, node_tests) = (&sim.bodies, sim.options.node_tests);
        // Both ascend.
        let mut wanted = keys.into_iter().peekable();
        let jobs: Vec<(Key, &mut Pair)> = sim
            .pairs
            .iter_mut()
            .filter_map(|(key, pair)| wanted.next_if_eq(key).map(|key| (key, &mut **pair)))
            .collect();
        let answers = map_owned(jobs, FEW_ITEMS, |(key, pair)| {
            let (a, b) = (&bodies[key.0], &bodies[key.1]);
            let until = end.min(a.horizon).min(b.horizon);
            let answer = Window::try_new(time, until).and_then(|window| fly(a, b, window, node_tests, pair));
            (key, answer)
        });
        let mut failed = None;
        for (key, answer) in answers {
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
                    failed = failed.or(Some(a.query_error(b, error)));
                    continue;
                }
            };
            self.heap.push(Reverse(event));
        }
        failed.map_or(Ok(()), |error| Err(error.into()))
    }

    /// For the audit: no two bodies that may meet do so on their present flights, until a time to which they
    /// fly.
    #[cfg(feature = "audit")]
    pub(super) fn conclude_flights(&self, until: f64) {
        let bodies = &self.sim.bodies;
        if !d2m_bvh::audit::is_heard() {
            return;
        }
        for (i, j) in (0..bodies.len()).flat_map(|i| (i + 1..bodies.len()).map(move |j| (i, j))) {
            let (a, b) = (&bodies[i], &bodies[j]);
            let flies = self.sim.meets(i, j) && !(a.stands_still() && b.stands_still());
            let from = a.flight.reference_time().max(b.flight.reference_time()).max(self.start);
            if flies {
                conclude(Place::Flight, [a, b], [from, until], 0.0);
            }
        }
    }

    /// The pairs, ascending, of one of these bodies and any other that may meet it and whose boxes around
    /// their flights meet. The boxes are grown by the gap and by half of the margin at least.
    pub(super) fn partners(&mut self, of: &[usize]) -> Vec<Key> {
        let margin = self.sim.options.gap.max(0.5 * self.margin);
        let sim = &mut *self.sim;
        sim.neighbors.update(&sim.bodies, self.end, margin);
        let sim = &*sim;
        sim.neighbors.pairs(of, |a, b| sim.meets(a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Body;
    use crate::body::rigid_body::RigidBody;
    use crate::flight::path::Splits;
    use d2m_bvh::MeshTree;
    use d2m_mesh::Faces;
    use std::sync::Arc;

    /// Flights of bodies that tumble at different rates end together: where those of one body end, those of
    /// the faster ones do, too.
    #[test]
    fn flights_of_many_bodies_end_at_common_times() {
        let tree = Arc::new(MeshTree::new(d2m_shapes::mesh("box?x=1&y=0.2&z=0.1").unwrap()));
        let faces = Arc::new(Faces::new(tree.mesh()));
        let ends = |spin: f64| {
            let turning =
                Body::new("", Arc::clone(&tree)).with_angular_velocity(DVec3::new(spin, spin, spin));
            let mut body = RigidBody::try_new(&turning, Arc::clone(&faces), 0.0).unwrap();
            let (mut ends, step) = (Vec::new(), 0.3);
            while body.time < step {
                let end = body.horizon_within(step, step, Splits::Common);
                assert!(end > body.time && end <= step);
                body.time = end;
                ends.push(end);
            }
            ends
        };
        let all: Vec<Vec<f64>> = [0.01, 0.3, 0.7, 1.7, 5.0, 9.0].map(ends).to_vec();
        assert!(all[0].len() == 1 && all[5].len() > 8, "{all:?}");
        for pair in all.windows(2) {
            assert!(pair[0].iter().all(|end| pair[1].contains(end)), "{pair:?}");
        }
    }
}
