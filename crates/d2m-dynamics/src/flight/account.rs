//! The energy account of a body: how far its energy is above the least value that it had before.
//!
//! Three things change the sum of kinetic and potential energy, and all of them are entered in the accounts.
//! When a body moves on, a negative account is set to zero (before that, impulses of the same instant may be
//! taken back):
//!
//! ```text
//! an impulse J on the momentum p        J·(2p + J)/2m
//! a flight of length s at velocity v       F·((p + F s/2)/m − v) s     zero if v is that of the middle
//! sleep                               the energy of the momenta is lost
//! ```
//!
//! An account may hold what time stepping needs, its limit. A body at rest has the momentum −F h/2 at the
//! start of a step and F h/2 at its end, with the energy W = (F h)²/8m; and it may be lifted by a gap. Where
//! the solution of an island would exceed the limits, its bodies' velocities against each other are reduced
//! (braked), down to zero, where they move as one rigid body.
//!
//! Then no account holds more than its limit and W. For among all momenta of an island with the same sums the
//! rigid motion has the least energy, and contacts alone do not change these sums: fully braked, an island
//! that touches nothing else gains nothing. One that is anchored to a static body stands still then, and its
//! momenta have the energy W. Flights that make room are entered before they begin. (Not counted: the energy
//! of rotation of bodies that tumble, which the midpoint rule keeps but for an oscillation, and the work of
//! kinematic bodies.)

use core::ops::Neg;
use d2m_contact::{Momenta, Velocity};
use glam::{DMat3, DVec3};

/// The relative rounding of an energy: differences of sums of fewer than 2¹² products, of 2⁻⁵³ each.
const ROUNDING: f64 = 1.0 / (1u64 << 40) as f64;

/// The part of the room that is made in any case. Without it a pair that has lost its distance would never
/// get it back. It lifts bodies by no more than the gaps that are missing.
pub(crate) const LEAST_PART: f64 = 0.25;

/// A body of an island whose velocities have been solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Entry {
    pub(crate) mass: f64,
    /// In world axes, at the instant of the solution.
    pub(crate) inertia: DMat3,
    pub(crate) inverse_inertia: DMat3,
    pub(crate) position: DVec3,
    /// The force of gravity and of the user.
    pub(crate) force: DVec3,
    pub(crate) torque: DVec3,
    /// What the account of the body holds, and its limit.
    pub(crate) gained: f64,
    pub(crate) limit: f64,
    /// The momenta without and with the impulses.
    pub(crate) before: Momenta,
    pub(crate) after: Momenta,
    /// The time for which forces act until the momenta have the velocity of the flight.
    pub(crate) lead: f64,
    /// The velocity that is added to make room, in this flight alone.
    pub(crate) room: Velocity,
}

/// How an island's solution is changed so that its accounts keep their limits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Balance {
    /// The velocity that is added to that of each body; none: all are zero.
    pub(crate) braking: Option<Vec<Velocity>>,
    /// The part of the room that is made.
    pub(crate) part: f64,
    /// What the accounts of all bodies hold together before this flight, and their limit.
    pub(crate) gained: f64,
    pub(crate) limit: f64,
}

impl Entry {
    fn kinetic(&self, p: &Momenta) -> f64 {
        0.5 * (p.linear.length_squared() / self.mass + p.angular.dot(self.inverse_inertia * p.angular))
    }

    /// The energy that the velocity for room adds in a flight of length `h`.
    fn lift(&self, h: f64) -> f64 {
        -(self.force.dot(self.room.linear) + self.torque.dot(self.room.angular)) * h
    }
}

/// Against what the velocities of an island's bodies are braked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    /// Against each other.
    Bodies,
    /// Against bodies at rest that impulses do not move.
    World,
}

/// The difference of each velocity to that of one rigid body with the same momenta; to zero if the island is
/// anchored to the world.
fn towards_rigid(entries: &[Entry], anchor: Anchor) -> Vec<Velocity> {
    let velocity = |e: &Entry| Velocity {
        linear: (e.after.linear + e.force * e.lead) / e.mass,
        angular: e.inverse_inertia * (e.after.angular + e.torque * e.lead),
    };
    let velocities: Vec<Velocity> = entries.iter().map(velocity).collect();
    if anchor == Anchor::World {
        return velocities.into_iter().map(Neg::neg).collect();
    }
    let mass: f64 = entries.iter().map(|e| e.mass).sum();
    let center = entries.iter().map(|e| e.position * e.mass).sum::<DVec3>() / mass;
    let linear = entries.iter().zip(&velocities).map(|(e, v)| v.linear * e.mass).sum::<DVec3>() / mass;
    let (mut inertia, mut angular) = (DMat3::ZERO, DVec3::ZERO);
    for (e, v) in entries.iter().zip(&velocities) {
        let r = e.position - center;
        let square = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
        inertia += e.inertia + (DMat3::from_diagonal(DVec3::splat(r.length_squared())) - square) * e.mass;
        angular += e.inertia * v.angular + r.cross((v.linear - linear) * e.mass);
    }
    let spin = inertia.inverse() * angular;
    let rigid = |e: &Entry| Velocity { linear: linear + spin.cross(e.position - center), angular: spin };
    entries.iter().zip(velocities).map(|(e, v)| rigid(e) - v).collect()
}

/// Brakes the velocities against each other, or against the anchor, by the least part with which the accounts
/// keep their limit. Where that is not enough, only a part of the room is made. `length`: of the flight; `most`:
/// of these brakes the greatest part that may be used.
pub(crate) fn balance(
    entries: &[Entry],
    anchor: Anchor,
    length: f64,
    most: impl Fn(&[Velocity]) -> f64,
) -> Balance {
    let sum = |value: &dyn Fn(&Entry) -> f64| entries.iter().map(value).sum::<f64>();
    let (before, after) = (sum(&|e| e.kinetic(&e.before)), sum(&|e| e.kinetic(&e.after)));
    let lift = sum(&|e| e.lift(length));
    let held = sum(&|e| e.gained);
    let limit = sum(&|e| e.limit) + ROUNDING * (before + after);
    let gained = held + (after - before);
    let excess = gained + lift - limit;
    if excess.is_nan() || excess <= 0.0 {
        return Balance { braking: None, part: 1.0, gained, limit };
    }
    let towards = towards_rigid(entries, anchor);
    // Braked by a part s of that, the energy grows by s b + s² a.
    let (mut a, mut b) = (0.0, 0.0);
    for (e, d) in entries.iter().zip(&towards) {
        let angular = e.inertia * d.angular;
        a += 0.5 * (e.mass * d.linear.length_squared() + angular.dot(e.inverse_inertia * angular));
        b += d.linear.dot(e.after.linear) + angular.dot(e.inverse_inertia * e.after.angular);
    }
    let added = |s: f64| s * b + s * s * a;
    let deepest = if a > 0.0 { (-0.5 * b / a).clamp(0.0, 1.0).min(most(&towards)) } else { 0.0 };
    let braked = if added(deepest) <= -excess {
        // The smaller root of a s² + b s + excess, in the form that does not cancel; b < 0 here.
        let root = (b * b - 4.0 * a * excess).max(0.0).sqrt();
        (2.0 * excess / (root - b)).clamp(0.0, deepest)
    } else {
        deepest
    };
    let gained = gained + added(braked);
    let left = gained + lift - limit;
    let part =
        if left > 0.0 && lift > 0.0 && braked == deepest { (1.0 - left / lift).max(LEAST_PART) } else { 1.0 };
    let braking = towards.into_iter().map(|to| to * braked).collect();
    Balance { braking: Some(braking), part, gained, limit }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A body of mass 2 with some inertia, on which `impulse` acts at `arm`.
    fn entry(position: DVec3, momentum: DVec3, arm: DVec3, impulse: DVec3) -> Entry {
        let inertia = DMat3::from_diagonal(DVec3::new(0.3, 0.4, 0.2));
        let before = Momenta { linear: momentum, angular: DVec3::new(0.1, -0.2, 0.3) };
        Entry {
            mass: 2.0,
            inertia,
            inverse_inertia: inertia.inverse(),
            position,
            force: DVec3::ZERO,
            torque: DVec3::ZERO,
            gained: 0.0,
            limit: 0.0,
            before,
            after: before + Momenta::of_impulse(impulse, arm),
            lead: 0.005,
            room: Velocity::default(),
        }
    }

    fn pair(impulse: DVec3) -> [Entry; 2] {
        let (a, b) = (DVec3::ZERO, DVec3::X);
        let point = DVec3::new(0.5, 0.3, 0.1);
        [entry(a, DVec3::Y, point - a, -impulse), entry(b, DVec3::Z, point - b, impulse)]
    }

    fn braked(entries: &[Entry], balance: &Balance) -> Vec<Momenta> {
        let braking = balance.braking.as_ref().unwrap();
        let of = |(e, v): (&Entry, &Velocity)| {
            e.after + Momenta { linear: v.linear * e.mass, angular: e.inertia * v.angular }
        };
        entries.iter().zip(braking).map(of).collect()
    }

    fn energy(entries: &[Entry], momenta: &[Momenta]) -> f64 {
        entries.iter().zip(momenta).map(|(e, p)| e.kinetic(p)).sum()
    }

    /// Whatever impulses act between two bodies, they add no energy, and the braking makes no momentum.
    #[test]
    fn impulses_between_two_bodies_add_none() {
        for k in 0..200 {
            let at = |n: u32| f64::from((k * 37 + n * 61) % 101) / 50.0 - 1.0;
            let entries = pair(DVec3::new(at(1), at(2), at(3)) * 4.0);
            let [before, after] = [entries.map(|e| e.before), entries.map(|e| e.after)];
            let balance = balance(&entries, Anchor::Bodies, 0.01, |_| 1.0);
            if energy(&entries, &after) <= energy(&entries, &before) {
                assert_eq!(balance.braking, None);
                continue;
            }
            let end = braked(&entries, &balance);
            assert!(energy(&entries, &end) <= energy(&entries, &before) * (1.0 + 1e-10), "{k}");
            let sum = |p: &[Momenta]| {
                let arms = entries.iter().zip(p).map(|(e, p)| e.position.cross(p.linear) + p.angular);
                (p.iter().map(|p| p.linear).sum::<DVec3>(), arms.sum::<DVec3>())
            };
            let (had, has) = (sum(&before), sum(&end));
            assert!((had.0 - has.0).length() < 1e-12 && (had.1 - has.1).length() < 1e-12, "{k}");
        }
    }

    /// An account above its limit is paid back before anything else is gained.
    #[test]
    fn accounts_are_paid_from_velocities_against_each_other() {
        let mut entries = pair(DVec3::ZERO);
        (entries[0].gained, entries[0].limit) = (0.15, 0.1);
        let balance = balance(&entries, Anchor::Bodies, 0.01, |_| 1.0);
        let end = braked(&entries, &balance);
        let taken = energy(&entries, &entries.map(|e| e.before)) - energy(&entries, &end);
        assert!((taken - 0.05).abs() < 1e-9 && (balance.gained - 0.1).abs() < 1e-9, "{taken}");
    }

    /// Where contacts have hardly any room, brakes take no more than a part, and what is left is owed.
    #[test]
    fn brakes_end_where_no_room_would_be_left() {
        let mut entries = pair(DVec3::ZERO);
        (entries[0].gained, entries[0].limit) = (0.15, 0.1);
        let full = balance(&entries, Anchor::Bodies, 0.01, |_| 1.0);
        let most = |braking: &[Velocity]| {
            assert_eq!(braking.len(), 2);
            0.01
        };
        let part = balance(&entries, Anchor::Bodies, 0.01, most);
        let [full_speed, part_speed] =
            [&full, &part].map(|b| b.braking.as_ref().map_or(0.0, |braking| braking[0].linear.length()));
        assert!(0.0 < part_speed && part_speed < 0.5 * full_speed, "{part_speed} {full_speed}");
        assert!(part.gained > part.limit, "{part:?}");
    }

    /// A body that stands on the floor cannot pay for a lift: it is lifted as far as the limit of its account
    /// allows.
    #[test]
    fn room_is_made_as_far_as_the_account_goes() {
        let weight = DVec3::Y * -20.0;
        let mut one = entry(DVec3::ZERO, weight * -0.005, DVec3::ZERO, DVec3::ZERO);
        (one.before.angular, one.after.angular) = (DVec3::ZERO, DVec3::ZERO);
        one.force = weight;
        one.room.linear = DVec3::Y * 0.1;
        // 0.1 for 0.01 s is a lift by 1e-3, which costs 0.02.
        one.limit = 0.015;
        let balance = balance(&[one], Anchor::World, 0.01, |_| 1.0);
        assert!((balance.part - 0.75).abs() < 1e-9, "{balance:?}");
        assert!(braked(&[one], &balance)[0].linear.distance(one.after.linear) < 1e-12);
    }
}
