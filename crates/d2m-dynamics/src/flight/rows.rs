//! Which contacts the velocities of a flight have to heed, and how.

use d2m_contact::{ContactPoint, SolverBody, Velocity};
use d2m_feature::FeaturePair;
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
/// The part of the gap at which hardly any is left.
pub(crate) const LAST: f64 = 1.0 / 64.0;
/// The part of the speeds of points that meet that room for their turn may add where that is so: a 256th of their energy.
const OF_SPEED: f64 = 1.0 / 16.0;
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
///
/// The first two ask for no more than a gap in a step, or m τ/2 where what drives turns into others; the second one, where hardly any room is
/// left, for m τ, with what slips along what turns, up to a part of the speeds there are.
pub(crate) fn select<'b>(
    found: &[&ContactPoint],
    span: Span,
    body: impl Fn(usize) -> &'b SolverBody,
) -> Vec<Row> {
    let velocity = |i: usize| body(i).velocity;
    let mut rows = Vec::new();
    // The fastest spin of what impulses do not move.
    let spin = |i: usize| if body(i).inverse_mass > 0.0 { 0.0 } else { velocity(i).angular.length() };
    let drive = found.iter().flat_map(|c| [c.a, c.b]).map(spin).fold(0.0, f64::max);
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
        let spins = [contact.a, contact.b].map(|i| velocity(i).angular);
        let curved = 0.5 * tau * bend(contact, spins);
        // A gap in a step: in a short rest of one, making room at once would be a jerk. But there is room for what drives turn, and turn into, in any
        // case: not for other spins, which what is made with impulses could raise without end.
        let carried = spins.map(|spin| spin.clamp_length_max(drive));
        let led =
            if led_into(contact, carried, velocity) > 0.0 { 0.5 * tau * bend(contact, carried) } else { 0.0 };
        // And where hardly any room is left, for whatever else turns: flights would end at one half of what there is after the other.
        let turned = if d < LAST * gap { room_to_turn(contact, spins, velocity, tau) } else { 0.0 };
        let most = led.max(turned).max(gap / span.step);
        let target = if span.room == Room::Shared {
            curved - share(contact, widest) / tau
        } else if contact.is_expected {
            (curved - (d - gap) / tau).min(0.0)
        } else if d > gap {
            (curved - (d - gap) / tau).min(most)
        } else {
            let restore = (gap - d).min(RESTORED * gap) / span.step;
            let room = curved - (d - KEPT * gap) / tau;
            restore.max(room).max(turned).clamp(0.0, most)
        };
        rows.push(Row { contact: k, target, pushing: target.min(0.0) });
    }
    rows
}

/// A bound on the acceleration along the normal by these spins of the two bodies.
fn bend(contact: &ContactPoint, spins: [DVec3; 2]) -> f64 {
    let of = |spin: DVec3, arm: DVec3| spin.cross(contact.normal).length() * spin.length() * arm.length();
    of(spins[0], contact.arm_a) + of(spins[1], contact.arm_b)
}

/// The rate at which points part so far that what these spins do to them does not bring them together again in a flight: twice what
/// makes up for the acceleration, but no more than a part of the speeds at which they move, so that their energy changes by hardly anything. What slips
/// along a face that turns is known ([`led_into`]), of edges a bound is: their normal turns with both.
fn room_to_turn(
    contact: &ContactPoint,
    spins: [DVec3; 2],
    velocity: impl Fn(usize) -> Velocity,
    tau: f64,
) -> f64 {
    let [a, b] = [contact.a, contact.b].map(&velocity);
    let slips = b.of_point(contact.arm_b) - a.of_point(contact.arm_a);
    let slip = (slips - contact.normal * contact.normal.dot(slips)).length();
    let [spin_a, spin_b] = spins.map(DVec3::length);
    let of_edges = match contact.feature {
        FeaturePair::EdgeEdge { .. } => 2.0 * slip * (spin_a + spin_b),
        FeaturePair::FaceVertex { .. } | FeaturePair::VertexFace { .. } => 0.0,
    };
    let acceleration = (bend(contact, spins) + of_edges).max(led_into(contact, spins, velocity));
    let speed = spin_a * contact.arm_a.length() + spin_b * contact.arm_b.length() + slip;
    (tau * acceleration).min(OF_SPEED * speed)
}

/// The acceleration with which bodies with these spins come closer along the normal while their centers fly straight: as a drum does to what it carries
/// along. With the rates v of the contact's points, and n turning with the body of the face at ω,
///
/// ```text
/// −(2 (ω × n)·(v_b − v_a) + n·(ω_b × (ω_b × r_b) − ω_a × (ω_a × r_a)))
/// ```
fn led_into(contact: &ContactPoint, [of_a, of_b]: [DVec3; 2], velocity: impl Fn(usize) -> Velocity) -> f64 {
    let [a, b] = [contact.a, contact.b].map(velocity);
    let slips = b.of_point(contact.arm_b) - a.of_point(contact.arm_a);
    let turning = match contact.feature {
        FeaturePair::FaceVertex { .. } => of_a,
        FeaturePair::VertexFace { .. } => of_b,
        FeaturePair::EdgeEdge { .. } => DVec3::ZERO,
    };
    let pull = |spin: DVec3, arm: DVec3| spin.cross(spin.cross(arm));
    -(2.0 * turning.cross(contact.normal).dot(slips)
        + contact.normal.dot(pull(of_b, contact.arm_b) - pull(of_a, contact.arm_a)))
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

/// A contact without friction of two bodies whose centers are one apart along y.
#[cfg(test)]
pub(crate) fn upright(bodies: [usize; 2]) -> ContactPoint {
    let arms = [DVec3::Y * 0.5, DVec3::Y * -0.5];
    let none = d2m_contact::Material::new(0.0, 0.0);
    ContactPoint { gap: 1.0, ..ContactPoint::new(bodies, arms, DVec3::Y, none) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_contact::{Material, Velocity};
    use glam::DMat3;

    const STILL: SolverBody = SolverBody {
        inverse_mass: 0.0,
        inverse_inertia: DMat3::ZERO,
        velocity: Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO },
    };

    /// The closest contact closes by a quarter of its share, one half as far as the widest by all of it; what touches or is too close is left as
    /// it is, also where nothing is apart.
    #[test]
    fn contacts_much_closer_than_others_close_by_less() {
        let at = |distance: f64| ContactPoint { distance, ..upright([0, 1]) };
        let span = Span { remaining: 1.0, step: 1.0, resting_speed: 1.0, room: Room::Shared };
        let targets = |distances: &[f64]| -> Vec<f64> {
            let contacts: Vec<ContactPoint> = distances.iter().map(|&d| at(d)).collect();
            let contacts: Vec<&ContactPoint> = contacts.iter().collect();
            select(&contacts, span, |_| &STILL).iter().map(|row| row.target).collect()
        };
        assert_eq!(targets(&[1.0, 0.5, 0.125, 0.015625]), [-0.375, -0.1875, -0.0234375, -0.00146484375]);
        assert_eq!(targets(&[0.0, 0.0]), [0.0, 0.0]);
        assert_eq!(targets(&[0.5, -0.5]), [-0.1875, 0.1875]);
    }

    /// Of a face that lands flat without bouncing all vertices within one and a half gaps count, however fast they close; what bounces is left to fly.
    #[test]
    fn what_lands_flat_is_met_with_all_of_its_vertices() {
        let falling =
            SolverBody { velocity: Velocity { linear: DVec3::NEG_Y * 9.0, ..STILL.velocity }, ..STILL };
        let span = Span { remaining: 1.0, step: 1.0, resting_speed: 1.0, room: Room::Kept };
        let count = |restitution: f64| {
            let material = Material::new(restitution, 0.0);
            let at = |distance: f64| ContactPoint { distance, material, ..upright([0, 1]) };
            let contacts = [0.99, 1.01, 1.49, 1.51].map(at);
            select(&contacts.each_ref(), span, |i| if i == 1 { &falling } else { &STILL }).len()
        };
        assert_eq!([count(0.0), count(0.5)], [3, 0]);
    }

    /// A drum comes closer to what it carries along, which flies straight, as their distance does; and no closer to what it slides under.
    #[test]
    fn a_drum_leads_into_what_it_carries_along() {
        let (rate, radius, tau) = (3.0, 2.0, 1e-3);
        let spin = DVec3::Z * rate;
        let feature = FeaturePair::FaceVertex { face: 0, vertex: 0 };
        let contact =
            ContactPoint { feature, arm_a: DVec3::NEG_Y * radius, arm_b: DVec3::ZERO, ..upright([0, 1]) };
        let of = |linear: DVec3| {
            let drum = Velocity { linear: DVec3::ZERO, angular: spin };
            let grain = Velocity { linear, angular: DVec3::ZERO };
            led_into(&contact, [spin, DVec3::ZERO], |i| [drum, grain][i])
        };
        let carried = DVec3::X * (rate * radius);
        // From the inside of a circle, along its tangent.
        let distance = radius - (DVec3::NEG_Y * radius + carried * tau).length();
        assert!((of(carried) + 2.0 * distance / (tau * tau)).abs() < 1e-4 * of(carried));
        assert!((of(carried) - rate * rate * radius).abs() < 1e-9);
        // Its face turns away from what stands still.
        assert!((of(DVec3::ZERO) + rate * rate * radius).abs() < 1e-9);
    }

    /// Room for turning of no more than a gap a step, and for what a drum turns: not for what turns faster in it, which would make it faster still.
    #[test]
    fn room_is_made_for_what_drives_turn() {
        let body = |inverse_mass: f64, spin: f64, speed: f64| SolverBody {
            inverse_mass,
            velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::Z * spin },
            ..STILL
        };
        let drum = body(0.0, 3.0, 0.0);
        // Its inner face, and the vertex of something that turns alike.
        let feature = FeaturePair::FaceVertex { face: 0, vertex: 0 };
        let touching = ContactPoint { feature, distance: KEPT, arm_a: DVec3::NEG_Y, ..upright([0, 1]) };
        let span = Span { remaining: 0.01, step: 1e3, resting_speed: 1.0, room: Room::Kept };
        let target = |bodies: [SolverBody; 2]| select(&[&touching], span, |i| &bodies[i])[0].target;
        for (bodies, expected) in [
            // Carried along, turning by itself and standing still.
            ([drum, body(1.0, 3.0, 1.5)], 0.5 * 0.01 * 9.0 * 1.5),
            ([drum, body(1.0, 300.0, 0.0)], 0.5 * 0.01 * 9.0 * 1.5),
            ([drum, body(1.0, 0.0, 0.0)], 1e-3),
            ([body(1.0, 300.0, 0.0), body(1.0, 300.0, 0.0)], 1e-3),
        ] {
            let target = target(bodies);
            assert!((target - expected).abs() < 1e-12, "{target} {expected}");
        }
    }
}
