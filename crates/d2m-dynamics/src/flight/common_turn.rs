//! Bodies that turn with the body on which they lie, as on a turntable.

use d2m_contact::{ContactPoint, Velocity};
use glam::{DQuat, DVec3};

/// The rates that are added along a contact's tangents: those of running surfaces, and, where both bodies
/// turn about the normal the same way, the change of the rates from the start to the middle of a flight of
/// this length.
///
/// Centers fly straight in a flight. Along the tangent of their circle they would move away from the axis, by
/// (ω h)² r/2 in each flight, and a sticking body would creep outward at ω² r h/2. With the arms of the
/// middle of the flight the velocities are those of chords. Only the spin about the normal that both have in
/// common counts: a ball that rolls turns about an axis in the surface, and its arm does not turn with it.
pub(crate) fn in_common_turn(contact: &ContactPoint, [a, b]: [Velocity; 2], length: f64) -> [f64; 2] {
    let [of_a, of_b] = [a, b].map(|velocity| velocity.angular.dot(contact.normal));
    if contact.row.is_some() || of_a * of_b <= 0.0 {
        return contact.running;
    }
    let common = if of_a.abs() < of_b.abs() { of_a } else { of_b };
    // A turn by half of that spin in half of the flight, without functions that differ from platform to
    // platform: by 2 atan(φ/2), not φ.
    let half = contact.normal * (0.25 * common * length);
    let turn = DQuat::from_xyzw(half.x, half.y, half.z, 1.0).normalize();
    let changed = |velocity: Velocity, arm: DVec3| velocity.angular.cross(turn * arm - arm);
    let added = changed(b, contact.arm_b) - changed(a, contact.arm_a);
    let [first, second] = contact.tangents.map(|tangent| tangent.dot(added));
    [contact.running[0] + first, contact.running[1] + second]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flight::rows::upright;

    /// A body on a turntable: with the velocity of its chord it does not slide, with that of the tangent it does.
    #[test]
    fn what_turns_with_a_table_flies_along_the_chord() {
        let (rate, length, place) = (2.0, 0.05, DVec3::new(1.5, 0.5, 0.0));
        let spin = DVec3::Y * rate;
        let turned = ContactPoint { arm_a: place - DVec3::Y * 0.5, ..upright([0, 1]) };
        let table = Velocity { linear: DVec3::ZERO, angular: spin };
        let slides = |linear: DVec3| {
            let body = Velocity { linear, angular: spin };
            let running = in_common_turn(&turned, [table, body], length);
            let relative = body.of_point(turned.arm_b) - table.of_point(turned.arm_a);
            let along = [0, 1].map(|k| turned.tangents[k].dot(relative) + running[k]);
            along[0].hypot(along[1])
        };
        let middle = DQuat::from_rotation_y(0.5 * rate * length) * place;
        assert!(slides(spin.cross(middle)) < 1e-3 * slides(spin.cross(place)));
        // On a body that stands still, or turns the other way, the rates stay as they are.
        for angular in [DVec3::ZERO, -spin, DVec3::X * rate] {
            let other = Velocity { linear: DVec3::ZERO, angular };
            assert_eq!(in_common_turn(&turned, [table, other], length), [0.0; 2]);
        }
    }
}
