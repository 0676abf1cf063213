//! Sensors: which bodies they meet.

use super::{FEW_ITEMS, Step};
use crate::StepError;
use crate::body::rigid_body::{RigidBody, Role};
use crate::pairs::clearance::are_spheres_apart;
use d2m_bvh::{
    Budget, ContactSpan, QueryError, QueryOptions, SpanStatus, Window, contact_spans, time_of_contact,
};
use d2m_mesh::parallel::map_owned;

impl Step<'_> {
    /// Finds the bodies that sensors meet on the present flights of all bodies, until a time to which these
    /// fly. Outside of what is reported each pair is proven clear at every time.
    pub(super) fn sense(&mut self, until: f64) -> Result<(), StepError> {
        let from = core::mem::replace(&mut self.sensed, until);
        let sim = &*self.sim;
        let of = |role: Role| (0..sim.bodies.len()).filter(move |&i| sim.bodies[i].role == role);
        let pairs: Vec<(usize, usize)> = of(Role::Sensor)
            .flat_map(|sensor| of(Role::Body).map(move |body| (sensor.min(body), sensor.max(body))))
            .filter(|&(a, b)| sim.is_admitted(a, b))
            .collect();
        // A body that a sensor no longer looks for has left it.
        let is_left = |&&(a, b): &&(usize, usize)| {
            [a, b].into_iter().any(|i| sim.bodies[i].role == Role::Sensor) && !sim.is_admitted(a, b)
        };
        let left: Vec<(usize, usize)> = sim.touching.iter().filter(is_left).copied().collect();
        for pair in left {
            self.sim.end_touch(pair, from);
        }
        let Ok(window) = Window::try_new(from, until) else { return Ok(()) };
        if pairs.is_empty() || window.length() == 0.0 {
            return Ok(());
        }
        let node_tests = self.sim.options.node_tests;
        let sim = &*self.sim;
        let found = map_owned(pairs, FEW_ITEMS, |pair| {
            (pair, spans(&sim.bodies[pair.0], &sim.bodies[pair.1], window, node_tests))
        });
        for (pair, spans) in found {
            let (a, b) = (&self.sim.bodies[pair.0], &self.sim.bodies[pair.1]);
            for span in spans.map_err(|error| a.query_error(b, error))? {
                if span.status == SpanStatus::Clear {
                    self.sim.end_touch(pair, span.from);
                } else {
                    self.sim.begin_touch(pair, span.from);
                }
            }
        }
        Ok(())
    }
}

/// When two bodies are clear of each other in their flights, and when not.
fn spans(
    a: &RigidBody,
    b: &RigidBody,
    window: Window,
    node_tests: u64,
) -> Result<Vec<ContactSpan>, QueryError> {
    let all = |status| Ok(vec![ContactSpan::new(window.start(), window.end(), status)]);
    if are_spheres_apart(a, b, window.start(), window.end(), 0.0) {
        return all(SpanStatus::Clear);
    }
    // A body inside of a solid is in contact with it, even if it is a surface itself.
    let [one, two] = [a, b].map(|body| body.moving_on(&body.flight));
    let options = QueryOptions::default().with_budget(Budget::UNLIMITED.with_node_tests(node_tests));
    if a.stands_still() && b.stands_still() {
        let end = Window::try_new(window.end(), window.end())?;
        let is_clear = time_of_contact(one, two, end, &options)?.is_separated();
        return all(if is_clear { SpanStatus::Clear } else { SpanStatus::Contact });
    }
    contact_spans(one, two, window, &options, None)
}
