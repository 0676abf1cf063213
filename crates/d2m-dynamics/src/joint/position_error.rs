//! How far the flights of jointed bodies end from where their joints ask for.

use crate::SimulationOptions;
use crate::body::rigid_body::RigidBody;
use crate::flight::rows::Span;
use crate::joint::force::TAKEN_BACK;
use crate::joint::rows::Joined;
use crate::numbers::is_resolved;
use d2m_contact::{ContactPoint, JointPart, System};
use glam::{DQuat, DVec3};
use std::borrow::Cow;

/// Flights may end off their joints by this part of a gap a step. A larger error is not corrected but
/// diverges, as where the end of a long chain whips round, and shorter flights are solved for.
pub(crate) const OFF_JOINT: f64 = 1e-2;
/// Poses have digits down to 2⁻⁵³ of their size. Of a way that is as long as that in a step less than 2⁻¹² is
/// known in flights of this part of a step, 2⁻⁴⁰, and in the shortest ones nothing: what such a flight seems to lack
/// is the rounding of its ends, and it turns by too little to lag.
const UNSEEN: f64 = 1.0 / (1u64 << 40) as f64;

/// The ends of the flights of jointed bodies.
pub(crate) struct Ends<'s> {
    pub(crate) joints: &'s [Joined],
    pub(crate) states: &'s [Cow<'s, RigidBody>],
    pub(crate) span: Span,
    pub(crate) options: &'s SimulationOptions,
}

/// By how much the rate of a row differs from the one that leads to where its joint asks for.
pub(crate) struct Missed {
    pub(crate) row: usize,
    pub(crate) rate: f64,
    /// Does it keep the joint from being met? A limit that nothing leads beyond does not.
    pub(crate) counts: bool,
}

/// A joint in a flight.
struct Flown<'j> {
    joined: &'j Joined,
    number: usize,
    starts: [(DVec3, DQuat); 2],
    ends: [(DVec3, DQuat); 2],
    /// The value at the start.
    value: f64,
    /// Do its ends say more than their rounding?
    is_seen: bool,
    /// How fast the equations move away from what they should be at the end; without their own rates where that is
    /// not seen.
    rates: Vec<f64>,
}

impl Ends<'_> {
    /// The errors of all rows of joints, which have these rates so far.
    pub(crate) fn miss(
        &self,
        system: &System,
        contacts: &[ContactPoint],
        pushing: &[f64],
        place: impl Fn(usize) -> usize,
    ) -> Vec<Missed> {
        let mut missed = Vec::new();
        let mut known: Option<Flown<'_>> = None;
        for (row, contact) in contacts.iter().enumerate() {
            let Some(of) = contact.row else { continue };
            let (JointPart::Equation { joint, .. }
            | JointPart::Value { joint }
            | JointPart::Force { joint, .. }) = of.part
            else {
                continue;
            };
            let flown = match known.take().filter(|known| known.number == joint) {
                Some(flown) => flown,
                None => self.fly(joint, [contact.a, contact.b].map(&place), system),
            };
            missed.push(match of.part {
                JointPart::Equation { number, .. } => {
                    let own = if flown.is_seen { 0.0 } else { system.rate(row) };
                    Missed { row, rate: own + flown.rates[number], counts: true }
                }
                JointPart::Rate | JointPart::Value { .. } | JointPart::Force { .. } => {
                    let rate = system.rate(row);
                    let length = self.span.remaining;
                    let mean = || flown.mean_rate(contact.normal, rate, length);
                    let lag = if flown.is_seen { mean() - rate } else { 0.0 };
                    let wanted = of.pushing - lag;
                    let counts = contact.impulse != 0.0 || rate < wanted;
                    Missed { row, rate: pushing[row] - wanted, counts }
                }
            });
            known = Some(flown);
        }
        missed
    }

    fn fly(&self, number: usize, bodies: [usize; 2], system: &System) -> Flown<'_> {
        let tau = self.span.remaining;
        let joined = &self.joints[number];
        let starts = bodies.map(|k| (self.states[k].position, self.states[k].orientation));
        let ends = bodies.map(|k| {
            let (state, v) = (&self.states[k], &system.bodies[k].velocity);
            (state.position + v.linear * tau, state.turned(v.angular, tau))
        });
        let step = self.span.step;
        let is_seen = self.is_seen(joined.extent(starts));
        let rates = if is_seen {
            let aims = joined.aims(starts, tau, step);
            joined.offs(ends).into_iter().zip(aims).map(|(off, aim)| (off - aim) / tau).collect()
        } else {
            joined.offs(starts).into_iter().map(|off| TAKEN_BACK * off / step).collect()
        };
        let value = joined.value(bodies.map(|k| &*self.states[k]));
        Flown { joined, number, starts, ends, value, is_seen, rates }
    }

    /// Do the ends of a flight say by which rate it misses a joint that lies within this distance of the origin?
    fn is_seen(&self, extent: f64) -> bool {
        let length = self.span.remaining;
        length > UNSEEN * self.span.step && is_resolved(extent, length, OFF_JOINT, self.options)
    }
}

impl Flown<'_> {
    /// The mean rate of the value in the flight, along this direction, if this is the rate at its start.
    fn mean_rate(&self, direction: DVec3, rate: f64, length: f64) -> f64 {
        let sign = self.joined.axis(self.starts[0].1).dot(direction).signum();
        sign * (self.joined.value_at(self.ends, self.value + sign * rate * length) - self.value) / length
    }
}
