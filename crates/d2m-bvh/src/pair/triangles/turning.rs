//! Directions that turn with one of the bodies.
//!
//! Where a tip stays near a face that turns fast, each direction that is fixed in space loses them as soon as the far end
//! of the face has come through it: after a time of the size of the gap over the speed of that end. The face's own normal,
//! which turns with it, keeps them apart for as long as the tip stays where it is.
//!
//! See docs/theory/engine.md, "Directions that turn".

use crate::gap::first_time::{PathAlong, first_time_of_paths};
use crate::gap::widest_gap::{greatest, least};
use d2m_mesh::margin::UP;
use glam::DVec3;

/// A triangle of a body and how the body moves, in an inertial frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct TurningTriangle {
    /// From the center of the body's tree.
    pub(super) corners: [DVec3; 3],
    /// The center of the body's tree, and its velocity.
    pub(super) center: DVec3,
    pub(super) velocity: DVec3,
    pub(super) omega: DVec3,
    /// From the reference point, which moves evenly, to the center of the tree.
    pub(super) arm: DVec3,
}

/// For how long a direction that turns with the body of `holder` keeps the triangles further apart than `need` (for the direction
/// as it is, not normalised); zero if it does not part them now. No time beyond `enough` matters.
pub(super) fn clear_along_turning(
    n: DVec3,
    holder: &TurningTriangle,
    mover: &TurningTriangle,
    need: f64,
    enough: f64,
) -> f64 {
    let held = holder.corners.map(|corner| n.dot(holder.center + corner));
    let at = mover.corners.map(|corner| n.dot(mover.center + corner));
    let (above, below) = (least(&at) - greatest(&held), least(&held) - greatest(&at));
    // Not when a number is none either.
    let is_apart = above.max(below) > need;
    if !is_apart {
        return 0.0;
    }
    // From the holder to the mover.
    let (out, level) = if above > below { (n, greatest(&held)) } else { (-n, -least(&held)) };
    let (w_h, w_m) = (holder.omega, mover.omega);
    let difference = w_m - w_h;
    let drift = mover.velocity - holder.velocity;
    // Velocity of the reference points against each other, which stays.
    let reference_drift = drift - w_m.cross(mover.arm) + w_h.cross(holder.arm);
    let (turn, drift_turned) = (out.cross(w_h), w_h.cross(reference_drift));
    let (turns, spin) = (turn.length() * UP, w_m.length() * UP);
    let apart = (out.cross(difference).length() + enough * turns * difference.length()) * UP;
    let paths = mover.corners.map(|corner| {
        let arm_velocity = w_m.cross(corner + mover.arm);
        let place = mover.center + corner - holder.center;
        // Velocity and acceleration as the holder sees them.
        let rate = drift + w_m.cross(corner) - w_h.cross(place);
        let change = difference.cross(arm_velocity) - drift_turned;
        let bend = out.dot(change - w_h.cross(rate));
        let most_change = difference.length() * arm_velocity.length() + drift_turned.length();
        let most_rate = rate.length() + enough * most_change;
        let jerk =
            apart * spin * arm_velocity.length() + turns * (2.0 * most_change + w_h.length() * most_rate);
        PathAlong {
            gap: out.dot(mover.center + corner) - level - need,
            rate: out.dot(rate),
            bend,
            jerk: jerk * UP,
        }
    });
    first_time_of_paths(&paths, enough)
}

#[cfg(test)]
mod tests {
    use super::*;
    use d2m_testing::{Draw, KnuthRandom};
    use glam::DQuat;

    /// Where a corner is at a time, from the holder's reference point, in the holder's axes.
    fn seen(holder: &TurningTriangle, mover: &TurningTriangle, corner: DVec3, s: f64) -> DVec3 {
        let turned = |body: &TurningTriangle, p: DVec3| DQuat::from_scaled_axis(body.omega * s) * p;
        let reference = |body: &TurningTriangle| {
            (body.center - body.arm) + (body.velocity - body.omega.cross(body.arm)) * s
        };
        let place = reference(mover) + turned(mover, corner + mover.arm);
        DQuat::from_scaled_axis(-holder.omega * s) * (place - reference(holder))
    }

    /// What rounding may hide from the judge below: places of up to about 4, rounded a few times, are known to some 1e-15, which is
    /// 1e-12 of the gap of 1e-3 that is needed; ten times that is granted.
    const ROUNDED_DOWN: f64 = 1.0 - 1e-11;

    /// The least gap over what is needed, at times that are proven.
    fn least_ratio(n: DVec3, bodies: &[TurningTriangle; 2], need: f64, enough: f64) -> (f64, f64) {
        let [holder, mover] = bodies;
        let time = clear_along_turning(n, holder, mover, need, enough);
        let held = holder.corners.map(|corner| n.dot(corner + holder.arm));
        let ratio = |part: f64| {
            let at = mover.corners.map(|corner| n.dot(seen(holder, mover, corner, time * part)));
            (least(&at) - greatest(&held)).max(least(&held) - greatest(&at)) / need
        };
        let least = [0.2, 0.5, 0.8, 1.0].map(ratio).into_iter().fold(f64::INFINITY, f64::min);
        (if time > 0.0 { least } else { f64::INFINITY }, time)
    }

    /// Bodies of any kind, with arms, parallel and equal spins, nearly at rest or fast.
    #[test]
    fn directions_that_turn_keep_bodies_apart() {
        let mut random = KnuthRandom(21);
        let (mut least, mut proven, mut sharp) = (f64::INFINITY, 0, 0);
        for round in 0..40_000 {
            let mut body = |spin: f64, speed: f64| {
                let middle = random.vector();
                let size = 10f64.powf(2.0 * random.signed() - 1.5);
                TurningTriangle {
                    corners: [0; 3].map(|_| middle + random.vector() * size),
                    center: random.vector() * 0.5,
                    velocity: random.vector() * speed,
                    omega: random.vector() * spin,
                    arm: random.vector() * [0.0, 1.0][round % 2],
                }
            };
            let mut bodies =
                [body(1.0, 0.0), body([0.0, 0.3, 1.0][round % 3], [0.0, 0.1, 1.0][round / 3 % 3])];
            if round / 9 % 3 == 1 {
                bodies[1].omega = bodies[0].omega * [1.0, -0.5][round / 27 % 2];
            }
            let (need, n) = (1e-3, random.vector().normalize());
            let fastest = bodies[0].omega.length().max(bodies[1].omega.length());
            let (ratio, time) = least_ratio(n, &bodies, need, 0.35 / fastest);
            proven += u32::from(time > 0.0);
            sharp += u32::from(ratio < 1.1);
            least = least.min(ratio);
        }
        assert!(least >= ROUNDED_DOWN, "{:e}", least - 1.0);
        assert!(proven > 4000 && sharp > 400, "{proven} {sharp}");
    }

    /// A point whose path in the holder's axes is −s³/3 along n, up to higher orders: only the third derivative closes the gap.
    #[test]
    fn the_third_derivative_seen_from_a_body_is_needed() {
        let body = |corner: DVec3, omega: DVec3, velocity: DVec3| TurningTriangle {
            corners: [corner, corner + DVec3::X * 1e-5, corner + DVec3::new(1e-5, 0.0, 1e-5)],
            center: DVec3::ZERO,
            velocity,
            omega,
            arm: DVec3::ZERO,
        };
        let holder = TurningTriangle {
            corners: [DVec3::ZERO, -DVec3::X, DVec3::new(-1.0, 1.0, 0.0)],
            ..body(DVec3::ZERO, DVec3::Z, DVec3::ZERO)
        };
        let gap = 0.006;
        let mover = body(DVec3::new(gap, -1.0, 0.0), DVec3::ZERO, DVec3::new(1.0, 0.5 * gap, 0.0));
        let (ratio, time) = least_ratio(DVec3::X, &[holder, mover], 1e-3, 0.3);
        assert!((1.0..2.5).contains(&ratio) && time > 0.2, "{ratio} {time}");
    }

    /// A tip on the axis of its spin above a tilted plate that turns fast: the plate's normal lasts, none that is fixed does.
    #[test]
    fn a_normal_that_turns_lasts() {
        let plate = TurningTriangle {
            corners: [DVec3::new(-3.0, -2.0, 0.0), DVec3::new(3.0, -2.0, 0.0), DVec3::new(0.0, 3.0, 0.0)],
            center: DVec3::ZERO,
            velocity: DVec3::ZERO,
            omega: DVec3::new(1.0, 0.0, 10.0),
            arm: DVec3::ZERO,
        };
        let tip = TurningTriangle {
            corners: [DVec3::Z * 1e-9, DVec3::new(0.5, 0.0, 1.0), DVec3::new(0.4, 0.3, 1.0)],
            omega: DVec3::new(-7.0, 0.0, -70.0),
            ..plate
        };
        let time = clear_along_turning(DVec3::Z, &plate, &tip, 1e-10, 4e-3);
        assert!(time >= 4e-3, "{time}");
    }
}
