//! Which contacts the velocities of a flight have to heed, and how.

use super::ContactPoint;
use crate::velocity::Velocity;
use glam::DVec3;

/// What distances contacts keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Room {
    /// The gap, and what is missing to it comes back.
    Kept,
    /// A part of what there is: where bodies are squeezed, all give way.
    Shared,
}

/// Times and speeds of a flight that is to be solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// From now to the end of the step.
    pub(crate) remaining: f64,
    /// The length of a step.
    pub(crate) step: f64,
    /// Contacts that close faster may bounce.
    pub(crate) resting_speed: f64,
    pub(crate) room: Room,
}

/// Contacts that have been hit: what a flight ends at, plus the slack of its query.
pub(crate) const HIT: f64 = 0.625;
/// Contacts that nothing bounces off and that are this near, in gaps, count however fast they close: flights that are braked by an
/// expected contact end at the gap, and of the vertices of a face that lands flat all or none must be met.
pub(crate) const NEAR: f64 = 1.5;
/// The part of the gap to which curvature may bring a contact within a flight.
const KEPT: f64 = 0.45;
/// Where room is shared, contacts that are this many times closer than the widest ones close by less of what they have, but at least by a part of
/// it: what presses would come ever closer to what it moves, while there is room behind.
const MUCH: f64 = 4.0;
const LEAST_SHARE: f64 = 0.25;
/// The part of the gap that a step restores at most where it is missing.
const RESTORED: f64 = 0.25;

/// A contact that counts, and the rate along its normal that the velocities of the flight have at least. The momenta need
/// no more than zero: what restores the gap or makes room for rotation adds no energy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// Place in the list of contacts.
    pub(crate) contact: usize,
    pub(crate) target: f64,
    /// What impulses see to of that.
    pub(crate) pushing: f64,
}

/// Contacts that close slower than the resting speed, and those that have been hit. The others are left to fly and to
/// bounce: a row would brake them before they meet.
///
/// With distance d, gap g, time τ and the bound m on the acceleration along the normal by rotation,
///
/// ```text
/// rate ≥ (g − d)/τ + m τ/2                        beyond the gap
/// rate ≥ max(0, (0.45 g − d)/τ + m τ/2)        within it; and what is missing to the gap, a quarter of it a step
/// rate ≥ p (5/8 min(g, d) − d)/τ + m τ/2       if room is shared: p = 4 min(g, d) over the greatest of these, from 1/4 to 1
/// ```
pub(crate) fn select(found: &[&ContactPoint], span: Span, velocity: impl Fn(usize) -> Velocity) -> Vec<Row> {
    let mut rows = Vec::new();
    let widest = found.iter().filter(|c| c.row.is_none()).map(|c| near(c)).fold(0.0, f64::max);
    for (k, contact) in found.iter().enumerate() {
        if let Some(row) = contact.row {
            rows.push(Row { contact: k, target: row.target, pushing: row.pushing });
            continue;
        }
        let closing = -contact.rate(velocity(contact.a), velocity(contact.b));
        let (d, gap, tau) = (contact.distance, contact.gap, span.remaining);
        let bounces = contact.material.restitution > 0.0;
        let slow = if bounces { span.resting_speed } else { span.resting_speed.max(gap / span.step) };
        let hit = d <= HIT * gap || (!bounces && d <= NEAR * gap);
        if closing > slow && !hit && !contact.is_expected {
            continue;
        }
        let bend = |body: usize, arm: DVec3| {
            let omega = velocity(body).angular;
            omega.cross(contact.normal).length() * omega.length() * arm.length()
        };
        let curved = 0.5 * tau * (bend(contact.a, contact.arm_a) + bend(contact.b, contact.arm_b));
        // A gap in a step: in a short rest of one, making room at once would be a jerk.
        let most = gap / span.step;
        let target = if span.room == Room::Shared {
            curved - share(contact, widest) / tau
        } else if contact.is_expected {
            (curved - (d - gap) / tau).min(0.0)
        } else if d > gap {
            (curved - (d - gap) / tau).min(most)
        } else {
            let restore = (gap - d).min(RESTORED * gap) / span.step;
            let room = curved - (d - KEPT * gap) / tau;
            restore.max(room).clamp(0.0, most)
        };
        rows.push(Row { contact: k, target, pushing: target.min(0.0) });
    }
    rows
}

/// The distance, at most the gap.
fn near(contact: &ContactPoint) -> f64 {
    contact.distance.min(contact.gap)
}

/// By how much a contact may close where room is shared; at most zero, so that it stays or opens, where flights would lead too close.
fn share(contact: &ContactPoint, widest: f64) -> f64 {
    let room = contact.shared_room();
    if room > 0.0 { room * (MUCH * near(contact) / widest).clamp(LEAST_SHARE, 1.0) } else { room }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::point::upright;

    /// The closest contact closes by a quarter of its share, one half as far as the widest by all of it; what touches or is too close is left as
    /// it is, also where nothing is apart.
    #[test]
    fn contacts_much_closer_than_others_close_by_less() {
        let at = |distance: f64| ContactPoint { distance, ..upright([0, 1]) };
        let span = Span { remaining: 1.0, step: 1.0, resting_speed: 1.0, room: Room::Shared };
        let targets = |distances: &[f64]| -> Vec<f64> {
            let contacts: Vec<ContactPoint> = distances.iter().map(|&d| at(d)).collect();
            let contacts: Vec<&ContactPoint> = contacts.iter().collect();
            select(&contacts, span, |_| Velocity::default()).iter().map(|row| row.target).collect()
        };
        assert_eq!(targets(&[1.0, 0.5, 0.125, 0.015625]), [-0.375, -0.1875, -0.0234375, -0.00146484375]);
        assert_eq!(targets(&[0.0, 0.0]), [0.0, 0.0]);
        assert_eq!(targets(&[0.5, -0.5]), [-0.1875, 0.1875]);
    }
}
