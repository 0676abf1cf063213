//! Bodies that contacts connect.

use super::{Key, Occasion, Step};
use crate::contact::ContactPoint;
use crate::pairs::{Measured, Pair, measure};
use crate::simulation::query_error;
use crate::{StepError, parallel};
use d2m_bvh::QueryError;
use std::collections::BTreeSet;

/// Features within this many gaps are measured in any case.
const AROUND: f64 = 1.5;
/// And those within this many times the way that two bodies come closer in what is left of the step.
const APPROACH: f64 = 2.0;

impl Step<'_> {
    /// The bodies that are connected with the seeds by contacts within the margin, moved to `time` and awake, and these
    /// contacts.
    pub(super) fn group(
        &mut self,
        time: f64,
        seeds: Vec<usize>,
        occasion: Occasion,
    ) -> Result<(Vec<usize>, Vec<ContactPoint>), StepError> {
        let gravity = self.sim.options.gravity;
        let mut member = vec![false; self.sim.bodies.len()];
        let mut group = Vec::new();
        let mut wave = seeds;
        let mut measured: BTreeSet<Key> = BTreeSet::new();
        let mut contacts = Vec::new();
        while !wave.is_empty() {
            for &i in &wave {
                member[i] = true;
                let body = &mut self.sim.bodies[i];
                if body.is_dynamic() {
                    if body.asleep {
                        body.asleep = false;
                        body.time = time;
                    }
                    if let Occasion::Plan { .. } = occasion {
                        body.undo(time);
                    }
                    body.advance(time, gravity);
                }
                group.push(i);
            }
            let new: Vec<Key> =
                self.partners(&wave).into_iter().filter(|key| !measured.contains(key)).collect();
            let sim = &*self.sim;
            let (most, step) = (self.margin, self.end - time);
            // Poses at one instant are the same however often flights from there are planned.
            let (known, new): (Vec<Key>, Vec<Key>) = new
                .into_iter()
                .partition(|key| sim.pairs.get(key).is_some_and(|pair| pair.measured == Some(time)));
            let mut found = parallel::map(new, |key| {
                let (gap, reach) =
                    sim.pairs.get(&key).map_or((sim.options.gap, 1.0), |pair| (pair.gap, pair.reach));
                // What is further apart than the present motion leads needs no row; if forces lead there all the same, the
                // flight ends at an event.
                let way = reach * APPROACH * sim.bodies[key.0].bound_approach(&sim.bodies[key.1]) * step;
                let margin = (AROUND * sim.options.gap + way).min(most);
                (key, Some(measure(&sim.bodies, key, time, margin, gap, sim.material(key.0, key.1))))
            });
            found.extend(known.into_iter().map(|key| (key, None)));
            found.sort_by_key(|(key, _)| *key);
            let mut next = Vec::new();
            for (key, answer) in found {
                measured.insert(key);
                let answer = match answer {
                    Some(Ok(points)) => Some(points),
                    None => None,
                    // Closer than rounding: the query of the flight says so, too.
                    Some(Err(QueryError::NotApart { .. })) => Some(Measured::default()),
                    Some(Err(error)) => {
                        let (a, b) = (&self.sim.bodies[key.0], &self.sim.bodies[key.1]);
                        return Err(query_error(a, b, error).into());
                    }
                };
                let gap = self.sim.options.gap;
                let pair = self.sim.pairs.entry(key).or_insert_with(|| Pair::new(gap));
                if let Some(measured) = answer {
                    pair.keep(measured, time, gap);
                }
                if pair.contacts.is_empty() {
                    continue;
                }
                // The impulses of the step's start are those of a whole one; an event adds to them.
                let part = match occasion {
                    Occasion::Start => 1.0,
                    Occasion::Plan { until } if time == self.start => (until - time) / (self.end - time),
                    Occasion::Plan { .. } | Occasion::Event => 0.0,
                };
                contacts.extend(pair.contacts.iter().map(|point| {
                    let mut point = *point;
                    point.impulse *= part;
                    point.sliding = point.sliding.map(|x| x * part);
                    point
                }));
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
        if occasion == Occasion::Start {
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
}
