//! How far the flights of jointed bodies end from where their joints ask for.

use crate::body::rigid_body::RigidBody;
use crate::flight::rows::Span;
use crate::joint::rows::Joined;
use d2m_contact::{ContactPoint, System};
use std::borrow::Cow;

/// The ends of the flights of jointed bodies.
pub(crate) struct Ends<'s> {
    pub(crate) joints: &'s [Joined],
    pub(crate) states: &'s [Cow<'s, RigidBody>],
    pub(crate) span: Span,
}

/// By how much the rate of a row differs from the one that leads to where its joint asks for.
pub(crate) struct Missed {
    pub(crate) row: usize,
    pub(crate) rate: f64,
}

impl Ends<'_> {
    pub(crate) fn miss(
        &self,
        system: &System,
        contacts: &[ContactPoint],
        place: impl Fn(usize) -> usize,
    ) -> Vec<Missed> {
        let tau = self.span.remaining;
        let mut missed = Vec::new();
        let mut known: Option<(usize, Vec<f64>)> = None;
        for (row, contact) in contacts.iter().enumerate() {
            let Some([number, equation]) = contact.row.and_then(|row| row.equation) else { continue };
            let joined = &self.joints[number];
            if known.as_ref().is_none_or(|known| known.0 != number) {
                let bodies = [contact.a, contact.b].map(&place);
                let starts = bodies.map(|k| (self.states[k].position, self.states[k].orientation));
                let ends = bodies.map(|k| {
                    let (state, v) = (&self.states[k], &system.bodies[k].velocity);
                    (state.position + v.linear * tau, state.turned(v.angular, tau))
                });
                let aims = joined.aims(starts, tau, self.span.step);
                let off = joined.offs(ends).into_iter().zip(aims).map(|(off, aim)| (off - aim) / tau);
                known = Some((number, off.collect()));
            }
            if let Some((_, rates)) = &known {
                missed.push(Missed { row, rate: rates[equation] });
            }
        }
        missed
    }
}
