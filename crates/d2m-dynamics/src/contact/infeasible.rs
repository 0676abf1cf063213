//! Proofs that no velocities keep contacts apart.
//!
//! Contacts at distances d keep apart in a flight of length τ only if their rates are J v + g ≥ −d/τ, with the velocities v of the bodies
//! that impulses move and the rates g of what follows its motion. By Farkas's lemma there are either such velocities, or multipliers λ ≥ 0
//! with
//!
//! ```text
//! Jᵀ λ = 0     and     Σ λ (g + d/τ) < 0
//! ```
//!
//! Such multipliers are the violations of the rows where these are least in the sum of their squares. They are found in rounded arithmetic,
//! so Jᵀ λ is zero only nearly; what is proven, with intervals, is that the left side of Σ λ (J v + g + d/τ) ≥ 0 is negative for all
//! velocities up to [`FAST`] times what closes in.

use super::{ContactPoint, SolverBody, System};
use crate::velocity::Velocity;
use d2m_interval::{Interval, IntervalVec3};
use glam::DMat3;

/// Velocities beyond so many times the fastest rate at which something closes in count as none.
const FAST: f64 = 1024.0;
/// Rounding of a measured distance, of the sizes that it is computed from: fewer than 64 operations of 2⁻⁵³ each, doubled.
const ROUNDED: f64 = 1.0 / (1u64 << 46) as f64;

/// Contacts, the bodies of which `place` finds in the list, without velocities but for what follows its motion.
pub(crate) struct Squeeze<'s, P: Fn(usize) -> usize + Copy> {
    pub(crate) bodies: &'s [SolverBody],
    pub(crate) contacts: &'s [ContactPoint],
    pub(crate) place: P,
}

impl<P: Fn(usize) -> usize + Copy> Squeeze<'_, P> {
    /// How fast the fastest contact closes if what impulses move stands still.
    pub(crate) fn closing(&self) -> f64 {
        let velocity = |body: usize| self.bodies[(self.place)(body)].velocity;
        let closing = |c: &ContactPoint| -c.rate(velocity(c.a), velocity(c.b));
        self.contacts.iter().map(closing).fold(0.0, f64::max)
    }

    /// The contact that presses most of those with what follows its motion, if no velocities keep the contacts apart for this time: a proof.
    /// None: there are some, or no proof was found.
    pub(crate) fn prove_infeasible(&self, length: f64) -> Option<&ContactPoint> {
        let fastest = self.closing();
        let is_driven = |body: usize| {
            let body = &self.bodies[(self.place)(body)];
            body.inverse_mass == 0.0 && body.velocity != Velocity::default()
        };
        if !(fastest > 0.0 && length > 0.0) {
            return None;
        }
        let multipliers = self.multipliers(length, fastest)?;
        if !self.is_negative(&multipliers, length, FAST * fastest) {
            return None;
        }
        let driven = self.contacts.iter().zip(&multipliers).filter(|(c, _)| is_driven(c.a) || is_driven(c.b));
        driven.max_by(|x, y| x.1.total_cmp(y.1)).map(|(contact, _)| contact)
    }

    /// The longest arm of the contacts of each body.
    fn reach(&self) -> Vec<f64> {
        let mut reach = vec![0.0f64; self.bodies.len()];
        for c in self.contacts {
            for (body, arm) in [(c.a, c.arm_a), (c.b, c.arm_b)] {
                let reach = &mut reach[(self.place)(body)];
                *reach = reach.max(arm.length());
            }
        }
        reach
    }

    /// What the rows press with if they are hard. Masses have no part in whether there are velocities: all are one here, so that none is
    /// heavy against another.
    fn multipliers(&self, length: f64, fastest: f64) -> Option<Vec<f64>> {
        let like = |(body, reach): (&SolverBody, f64)| {
            let is_moved = body.inverse_mass > 0.0 && reach > 0.0;
            let inverse_inertia = if is_moved { DMat3::IDENTITY / (reach * reach) } else { DMat3::ZERO };
            let inverse_mass = if body.inverse_mass > 0.0 { 1.0 } else { 0.0 };
            SolverBody { inverse_mass, inverse_inertia, velocity: body.velocity }
        };
        let bodies = self.bodies.iter().zip(self.reach()).map(like).collect();
        let smooth: Vec<ContactPoint> = self.contacts.iter().map(ContactPoint::without_friction).collect();
        let targets: Vec<f64> = smooth.iter().map(|c| -c.distance / length).collect();
        System::new(bodies, &smooth, self.place).press_hard(&targets, fastest)
    }

    /// Is Σ λ (J v + g + d/τ) negative for all velocities whose speeds, at the longest arm too, are up to this one?
    fn is_negative(&self, multipliers: &[f64], length: f64, speed: f64) -> bool {
        let mut pushes = vec![(IntervalVec3::ZERO, IntervalVec3::ZERO); self.bodies.len()];
        let mut sum = Interval::ZERO;
        for (c, weight) in self.contacts.iter().zip(multipliers).filter(|(_, weight)| **weight > 0.0) {
            let weight = Interval::point(*weight);
            let size = c.point.length() + c.arm_a.length() + c.arm_b.length() + c.distance;
            sum += weight * (Interval::around(c.distance, ROUNDED * size) / Interval::point(length));
            let force = IntervalVec3::point(c.normal) * weight;
            for (body, arm, force) in [(c.a, c.arm_a, -force), (c.b, c.arm_b, force)] {
                let place = (self.place)(body);
                let torque = IntervalVec3::point(arm).cross(force);
                let velocity = self.bodies[place].velocity;
                if self.bodies[place].inverse_mass > 0.0 {
                    let (forces, torques) = pushes[place];
                    pushes[place] = (forces + force, torques + torque);
                } else {
                    sum += force.dot_point(velocity.linear) + torque.dot_point(velocity.angular);
                }
            }
        }
        let speed = Interval::point(speed);
        for ((force, torque), reach) in pushes.into_iter().zip(self.reach()).filter(|(_, reach)| *reach > 0.0)
        {
            sum += (force.norm() + torque.norm() / Interval::point(reach)) * speed;
        }
        sum.certainly_negative()
    }
}

#[cfg(test)]
mod tests {
    use super::super::point::upright;
    use super::*;
    use glam::DVec3;

    fn with_squeeze<T>(rooms: [f64; 2], answer: impl Fn(&Squeeze<'_, fn(usize) -> usize>) -> T) -> T {
        let body = |inverse_mass: f64, rate: f64| SolverBody {
            inverse_mass,
            inverse_inertia: DMat3::IDENTITY * inverse_mass,
            velocity: Velocity { linear: DVec3::Y * rate, angular: DVec3::ZERO },
        };
        // A floor, a stone, and a press that comes down at a speed of one.
        let bodies = [body(0.0, 0.0), body(0.5, 0.0), body(0.0, -1.0)];
        let contact = |pair: [usize; 2], distance: f64| ContactPoint { distance, ..upright(pair) };
        let contacts = [contact([0, 1], rooms[0]), contact([1, 2], rooms[1])];
        answer(&Squeeze { bodies: &bodies, contacts: &contacts, place: |i| i })
    }

    fn squeezed(rooms: [f64; 2], length: f64) -> bool {
        with_squeeze(rooms, |squeeze| squeeze.prove_infeasible(length).is_some())
    }

    /// A press has used up the room of a stone after as much time as both gaps are wide, however it gives way.
    #[test]
    fn what_has_no_room_is_proven_to_have_none() {
        assert!(squeezed([1e-6, 3e-6], 5e-6) && squeezed([0.0, 1e-3], 1.001e-3));
        assert!(!squeezed([1e-6, 3e-6], 3.9e-6) && !squeezed([1e-3, 1e-3], 1e-9));
        // The same multiplier of both contacts moves the stone nowhere: what they prove depends on the distances alone.
        let proven =
            |length| with_squeeze([1e-3, 1e-3], |squeeze| squeeze.is_negative(&[1.0; 2], length, 1e3));
        assert!(proven(2.1e-3) && !proven(1.9e-3));
    }

    /// Where a press meets a stone that could slip out, no multipliers are a proof.
    #[test]
    fn what_could_slip_out_is_not_crushed() {
        let body = |inverse_mass: f64, rate: f64| SolverBody {
            inverse_mass,
            inverse_inertia: DMat3::IDENTITY * inverse_mass,
            velocity: Velocity { linear: DVec3::Y * rate, angular: DVec3::ZERO },
        };
        let bodies = [body(0.0, 0.0), body(0.5, 0.0), body(0.0, -1.0)];
        for tilt in [1e-2, -0.3] {
            let normal = DVec3::new(tilt, 1.0, 0.0).normalize();
            let contacts = [upright([0, 1]), ContactPoint { normal, ..upright([1, 2]) }];
            let squeeze = Squeeze { bodies: &bodies, contacts: &contacts, place: |i| i };
            assert!(squeeze.prove_infeasible(1.0).is_none());
        }
    }
}
