//! Which contacts the velocities of a flight have to obey, and the least rates at which these may close or
//! open.

use d2m_contact::{ContactPoint, SolverBody, Velocity};
use d2m_feature::FeaturePair;
use glam::DVec3;

/// The distances that contacts keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Room {
    /// The gap; what is missing to it is restored.
    Kept,
    /// A part of the distance that there is: where bodies are squeezed, all contacts give way.
    Shared,
}

/// Times and speeds of a flight that is to be solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Span {
    /// From now to the end of the flight.
    pub(crate) remaining: f64,
    /// The length of a step.
    pub(crate) step: f64,
    /// Contacts that close faster may bounce.
    pub(crate) resting_speed: f64,
    pub(crate) room: Room,
}

/// A contact has been hit within this part of the gap: the distance at which a flight ends, plus the slack of
/// its query.
pub(crate) const HIT: f64 = 0.625;
/// Contacts without restitution count within so many gaps, however fast they close. Flights that are braked
/// by an expected contact end at the gap; and of the vertices of a face that lands flat, all or none have to
/// be met.
pub(crate) const NEAR: f64 = 1.5;
/// The part of the gap to which rotation may bring a contact within a flight.
const KEPT: f64 = 0.45;
/// Where room is shared, contacts that are this many times closer than the widest one close by a smaller part
/// of their room, but by this part of it at least. Otherwise a body that presses would come ever closer to
/// what it moves while there is room behind.
const MUCH: f64 = 4.0;
const LEAST_SHARE: f64 = 0.25;
/// Hardly any room is left within this part of the gap.
pub(crate) const LAST: f64 = 1.0 / 64.0;
/// Rates that make room for rotation there are at most this part of the speeds of the points that meet: a
/// 256th of their energy.
const OF_SPEED: f64 = 1.0 / 16.0;
/// Bodies turn in common where their spins differ by no more than this part of the greater one.
const IN_COMMON: f64 = 0.25;
/// The most of a missing gap that a step restores, as a part of the gap.
const RESTORED: f64 = 0.25;

/// A contact that counts, and the least rate along its normal in the flight. The momenta need no more than a
/// rate of zero: restoring the gap, or making room for rotation, adds no momentum.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// Index in the list of contacts.
    pub(crate) contact: usize,
    pub(crate) target: f64,
    /// The rate that impulses bring about.
    pub(crate) pushing: f64,
}

/// Contacts that close slower than the resting speed, and those that have been hit. The others go on flying
/// until they meet, and bounce: a row would brake them before.
///
/// With distance d, gap g, time τ and the bound m on the acceleration along the normal by rotation,
///
/// ```text
/// rate ≥ (g − d)/τ + m τ/2                        beyond the gap
/// rate ≥ max(0, (0.45 g − d)/τ + m τ/2)        within it; and what is missing to the gap, a quarter of it a step
/// rate ≥ p (5/8 min(g, d) − d)/τ + m τ/2       if room is shared: p = 4 min(g, d) over the greatest of these, from 1/4 to 1
/// ```
///
/// The first two are at most a gap in a step, or m τ/2 where a driven body turns into others, and where both
/// turn in common. Where hardly any room is left the second is at least m τ, with the sliding along surfaces
/// that turn, up to a part of the speeds of the points.
pub(crate) fn select<'b>(
    found: &[&ContactPoint],
    span: Span,
    body: impl Fn(usize) -> &'b SolverBody,
) -> Vec<Row> {
    let velocity = |i: usize| body(i).velocity;
    let mut rows = Vec::new();
    // The fastest spin of the bodies that impulses do not move.
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
        let curved = 0.5 * tau * bend(contact, spins, span);
        // At most a gap in a step: in the short rest of one, making room at once would be a jerk. The
        // rotation of a drive gets its room in any case, and so does what both turn in common. Other spins do
        // not: impulses that make room could raise these without end.
        let carried =
            if turn_in_common(spins) { spins } else { spins.map(|spin| spin.clamp_length_max(drive)) };
        let is_led = led_into(contact, carried, velocity) > 0.0;
        let led = if is_led { 0.5 * tau * bend(contact, carried, span) } else { 0.0 };
        // Where hardly any room is left all rotation counts: otherwise each flight would end at half of the
        // distance that there is.
        let turned = if d < LAST * gap { room_to_turn(contact, spins, velocity, span) } else { 0.0 };
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

/// Do two bodies turn alike, as what lies in a tube that spins?
fn turn_in_common([of_a, of_b]: [DVec3; 2]) -> bool {
    (of_b - of_a).length() <= IN_COMMON * of_a.length().max(of_b.length())
}

/// A bound on the acceleration along the normal by these spins ω of the two bodies, whose centers fly straight.
/// With the arms r of the contact, the way c from one center to the other, and δ the spin of the second body
/// against the first,
///
/// ```text
/// |ω_a × n| |ω_a| |r_a| + |ω_b × n| |ω_b| |r_b|                      each for itself
/// |ω_a × n| |ω_a × c| + (|ω_a × n| |δ| + |δ × n| (|ω_a| + |δ|)) |r_b|       what both turn in common
/// ```
///
/// The second one, and the same with the bodies exchanged, is small for a wheel that turns with its axle, and
/// for a peg in a hole that turns, however far out it is. It counts where the first one asks for more than a
/// gap in a step, which is granted in any case, and where both turn in common and one lies about the axis of the
/// other: about the spin's axis their centers are nearer to each other than half of both arms.
fn bend(contact: &ContactPoint, [of_a, of_b]: [DVec3; 2], span: Span) -> f64 {
    let across = |spin: DVec3| spin.cross(contact.normal).length();
    let of = |spin: DVec3, arm: DVec3| across(spin) * spin.length() * arm.length();
    let apart = of(of_a, contact.arm_a) + of(of_b, contact.arm_b);
    let is_granted = 0.5 * span.remaining * apart <= contact.gap / span.step;
    if is_granted || !turn_in_common([of_a, of_b]) {
        return apart;
    }
    let way = contact.arm_a - contact.arm_b;
    let against = of_b - of_a;
    let common = |spin: DVec3, arm: DVec3| {
        let turned = |arm: DVec3| spin.cross(arm).length();
        let is_inside = 2.0 * turned(way) <= turned(contact.arm_a) + turned(contact.arm_b);
        if !is_inside {
            return apart;
        }
        let sliding = across(spin) * against.length() + across(against) * (spin.length() + against.length());
        across(spin) * turned(way) + sliding * arm.length()
    };
    apart.min(common(of_a, contact.arm_b)).min(common(of_b, contact.arm_a))
}

/// The rate at which points part so far that these spins do not bring them together again in a flight. It is
/// twice what makes up for the acceleration, but no more than a part of the speeds of the points, so that
/// their energy hardly changes. For sliding along a face that turns the acceleration is known ([`led_into`]);
/// for edges, whose normal turns with both bodies, it is bounded.
fn room_to_turn(
    contact: &ContactPoint,
    spins: [DVec3; 2],
    velocity: impl Fn(usize) -> Velocity,
    span: Span,
) -> f64 {
    let [a, b] = [contact.a, contact.b].map(&velocity);
    let slips = b.of_point(contact.arm_b) - a.of_point(contact.arm_a);
    let slip = (slips - contact.normal * contact.normal.dot(slips)).length();
    let [spin_a, spin_b] = spins.map(DVec3::length);
    let of_edges = match contact.feature {
        FeaturePair::EdgeEdge { .. } => 2.0 * slip * (spin_a + spin_b),
        FeaturePair::FaceVertex { .. } | FeaturePair::VertexFace { .. } => 0.0,
    };
    let acceleration = (bend(contact, spins, span) + of_edges).max(led_into(contact, spins, velocity));
    let speed = spin_a * contact.arm_a.length() + spin_b * contact.arm_b.length() + slip;
    (span.remaining * acceleration).min(OF_SPEED * speed)
}

/// The acceleration along the normal with which bodies with these spins approach while their centers fly
/// straight, as a drum approaches what it carries along. With the velocities v of the contact's points, and n
/// turning at ω with the body of the face,
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

/// By how much a contact may close where room is shared. It is negative, so that the contact opens, where it
/// is closer already than the part that it has to keep.
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
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DMat3;

    const STILL: SolverBody = SolverBody {
        inverse_mass: 0.0,
        inverse_inertia: DMat3::ZERO,
        velocity: Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO },
    };

    /// The closest contact closes by a quarter of its share, one half as far as the widest by all of it.
    /// Contacts that touch or are too close do not close, also where all of them touch.
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

    /// All vertices of a face that lands flat without bouncing count within one and a half gaps, however fast
    /// they close. Those that bounce have no rows.
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

    /// A drum approaches what it carries along, which flies straight, as their distance says; and it does not
    /// approach what it slides under.
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

    /// No two bodies approach faster than the bound says, whatever their spins and arms; and a wheel that turns
    /// with its axle needs next to nothing.
    #[test]
    fn what_two_bodies_turn_in_common_bends_nothing() {
        let random = &mut KnuthRandom(7);
        let span = Span { remaining: 1.0, step: 1e9, resting_speed: 1.0, room: Room::Kept };
        let mut vector = || DVec3::from_array([0; 3].map(|_| random.signed()));
        for k in 0..1000 {
            let (spin, arm, normal) = (vector(), vector(), vector().normalize());
            // From spins and centers that are nearly the same to any.
            let apart = 0.5f64.powi(k % 20);
            let (other, center) = (spin + apart * vector(), apart * vector());
            let contact =
                ContactPoint { normal, arm_a: arm, arm_b: arm - center, gap: 1e-9, ..upright([0, 1]) };
            let bound = bend(&contact, [spin, other], span);
            let pull = |spin: DVec3, arm: DVec3| spin.cross(spin.cross(arm));
            let approaches = normal.dot(pull(other, contact.arm_b) - pull(spin, contact.arm_a)).abs();
            assert!(approaches <= bound * (1.0 + 1e-9) + 1e-15, "{approaches} {bound}");
            assert!(bound <= 40.0 * apart, "{bound} {apart}");
            // However far from each other both centers lie on the axis of the spin that both have, unless the
            // contact lies near it, too.
            if apart < 0.1 * spin.cross(arm).length() {
                let far = ContactPoint { arm_b: arm - center - 9.0 * spin, ..contact };
                let along = bend(&far, [spin, spin], span);
                assert!(along <= 10.0 * apart, "{along} {apart}");
            }
        }
    }

    /// Rotation gets room up to a gap in a step, and the rotation of a drum in any case, also of one that nothing
    /// drives where the other body turns alike. A body that turns faster in the drum gets no more: that would
    /// make it faster still.
    #[test]
    fn room_is_made_for_what_drives_turn() {
        let body = |inverse_mass: f64, spin: f64, speed: f64| SolverBody {
            inverse_mass,
            velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::Z * spin },
            ..STILL
        };
        let drum = body(0.0, 3.0, 0.0);
        // The inner face of the drum, and a vertex of a body that turns alike.
        let feature = FeaturePair::FaceVertex { face: 0, vertex: 0 };
        let touching = ContactPoint { feature, distance: KEPT, arm_a: DVec3::NEG_Y, ..upright([0, 1]) };
        let span = Span { remaining: 0.01, step: 1e3, resting_speed: 1.0, room: Room::Kept };
        let target = |bodies: [SolverBody; 2]| select(&[&touching], span, |i| &bodies[i])[0].target;
        for (bodies, expected) in [
            // Carried along and turning by itself, no faster than the drum as far as that counts: only its
            // center, half as far out as its face, has to go round.
            ([drum, body(1.0, 3.0, 1.5)], 0.5 * 0.01 * 9.0 * 0.5),
            ([drum, body(1.0, 300.0, 0.0)], 0.5 * 0.01 * 9.0 * 0.5),
            // In a drum that nothing drives: turning like it, and twice as fast.
            ([body(1.0, 3.0, 0.0), body(1.0, 3.0, 1.5)], 0.5 * 0.01 * 9.0 * 0.5),
            ([body(1.0, 3.0, 0.0), body(1.0, 6.0, 1.5)], 1e-3),
            // Standing still, and without a drum.
            ([drum, body(1.0, 0.0, 0.0)], 1e-3),
            ([body(1.0, 300.0, 0.0), body(1.0, 300.0, 0.0)], 1e-3),
        ] {
            let target = target(bodies);
            assert!((target - expected).abs() < 1e-12, "{target} {expected}");
        }
    }
}
