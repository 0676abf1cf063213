//! Proofs that no velocities keep contacts apart.
//!
//! Contacts at distances d keep apart in a flight of length τ only if their rates are J v + g ≥ −d/τ, with the velocities v of the bodies
//! that impulses move and the rates g of what follows its motion. By Farkas's lemma there are either such velocities, or multipliers λ ≥ 0 with
//!
//! ```text
//! Jᵀ λ = 0     and     Σ λ (g + d/τ) < 0
//! ```
//!
//! Such multipliers are the violations of the rows where these are least in the sum of their squares. They are found in rounded arithmetic,
//! so Jᵀ λ is zero only nearly; what is proven, with intervals, is that the left side of Σ λ (J v + g + d/τ) ≥ 0 is negative for all
//! velocities up to [`FAST`] times what closes in.
//!
//! Such velocities carry far: a body that stands on its tip turns out from under a press before that has closed a gap. So τ is so short that
//! arms and normals change little on the way, and what that may gain is counted. With the speed V_k of a body's points and the longest arm
//! ρ_k of its contacts its arms turn by V_k τ/ρ_k, the normal of a face as its body, and the points move against each
//! other by 2 (V_a + V_b) τ. Hence the rate of a contact is off by bend · t after the time t, and its distance by bend · τ²/2, where
//!
//! ```text
//! bend = V_a²/ρ_a + V_b²/ρ_b + 4 n (V_a + V_b) + n² d,     n = max(V_a/ρ_a, V_b/ρ_b), across edges TURNING times that
//! ```
//!
//! where how fast a body turns that follows its motion, at most V/ρ, is known.
//!
//! What is proven is proven of the features that were measured. So only contacts count whose closest points cannot slip off them meanwhile: those
//! that may slide by s, where
//!
//! ```text
//! s ≥ 2 (V_a + V_b) τ + 2 n d τ
//! ```
//!
//! and n τ is at most 1/32. Seen from one body a closest point of the other one moves no faster than (V_a + V_b) (1 + n τ) + n d, less than that.
//! It cannot leave what is flat and goes on by that around the other one's: it is on the outer side of it until the bodies meet. That is so of
//! any point of a surface over a flat part of the other one, closest or not. Nor can two edges pass each other while the points where they are closest are between their ends. These points move along
//! the edges, with directions u and w, by
//!
//! ```text
//! ((r·u) − (u·w) (r·w))/(1 − (u·w)²),     (r·w) likewise
//! ```
//!
//! with the vector r from what was the closest point of one to that of the other: at the start it is across both, so that its parts along them are
//! at most 2 (V_a + V_b) τ, what the points move against each other, and what the edges turn, n τ, times d. With sin² = 1 − (u·w)² ≥ 1/4, and at
//! least 1/5 after a turn of 1/32, it is less than ten times the sum: [`LEVER`].

use super::{ContactPoint, SolverBody, System};
use crate::velocity::Velocity;
use d2m_feature::FeaturePair;
use d2m_interval::{Interval, IntervalVec3};
use glam::DMat3;

/// Velocities beyond so many times the fastest rate at which something closes in count as none.
const FAST: f64 = 128.0;
/// The normal across two edges turns by what both turn over the sine of the angle between them, which is at least [`CROSSING`]: no faster than so
/// many times the faster body.
const TURNING: f64 = 2.0 / CROSSING;
/// Of edges that cross at less, as a sine, the normal turns faster than a [`Squeeze`] counts: such contacts have no place in it.
///
/// ```
/// use glam::DVec3;
/// let is_counted = |u: DVec3, w: DVec3| u.cross(w).length() >= d2m_contact::CROSSING; // of unit vectors along edges
/// assert!(is_counted(DVec3::X, DVec3::Y) && !is_counted(DVec3::X, DVec3::new(0.9, 0.4, 0.0).normalize()));
/// ```
pub const CROSSING: f64 = 0.5;
/// The direction of a contact is off the normal that turns so by this at most, 2⁻²⁴: then it is off its distance along it by less than twice
/// that part of it.
///
/// ```
/// assert!(d2m_contact::ASKEW < 1e-7);
/// ```
pub const ASKEW: f64 = 1.0 / (1u64 << 24) as f64;
/// How far a direction turns meanwhile, at most.
const MOST_TURN: f64 = 1.0 / 32.0;
/// How far the closest points of two edges that cross so slide for what the bodies move against each other, at most.
///
/// ```
/// // Two edges whose closest points are 0.2 from their nearest ends stay closest while the bodies move by less than this.
/// assert_eq!(0.2 / d2m_contact::LEVER, 0.02);
/// ```
pub const LEVER: f64 = 10.0;
/// What closes in goes on for at most this part of the least arm over [`FAST`]², 2⁻⁷. What bends is then less than a tenth of what closes in for
/// each contact of faces that takes part, a seventh across edges, and half of both where one of the bodies rests.
const STEADY: f64 = 1.0 / (1u64 << 7) as f64;
/// Rounding of a measured distance, of the sizes that it is computed from ([`ContactPoint::size`]): fewer than 64 operations of 2⁻⁵³ each, doubled.
///
/// ```
/// assert_eq!(d2m_contact::ROUNDED, 128.0 * 0.5f64.powi(53));
/// ```
pub const ROUNDED: f64 = 1.0 / (1u64 << 46) as f64;

/// Contacts, the bodies of which `place` finds in the list, without velocities but for what follows its motion: is there no motion of the others
/// that keeps them apart?
///
/// By Farkas's lemma there is none if multipliers λ ≥ 0 of the contacts, with the rates g of what follows its motion, the distances d and
/// the time τ, have
///
/// ```text
/// Jᵀ λ = 0     and     Σ λ (g + d/τ) < 0
/// ```
///
/// They are found in rounded arithmetic and proven with intervals, with all that turns and bends meanwhile, for all velocities up to 128 times what closes in.
///
/// ```
/// use d2m_contact::{ContactPoint, Material, SolverBody, Squeeze, Velocity};
/// use glam::{DMat3, DVec3};
/// // A floor, a stone, and a press that comes down at a speed of one.
/// let stone = SolverBody { inverse_mass: 1.0, inverse_inertia: DMat3::IDENTITY, ..SolverBody::FIXED };
/// let press = SolverBody { velocity: Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO }, ..SolverBody::FIXED };
/// let arms = [DVec3::Y * 0.5, DVec3::Y * -0.5];
/// let at = |pair: [usize; 2]| ContactPoint { distance: 1e-9, ..ContactPoint::new(pair, arms, DVec3::Y, Material::new(0.0, 0.0)) };
/// let contacts = [at([0, 1]), at([1, 2])];
/// let squeeze = Squeeze { bodies: &[SolverBody::FIXED, stone, press], contacts: &contacts, slides: &[1.0; 2], place: |body| body };
/// assert_eq!(squeeze.closing(), 1.0);
/// // There is room for two billionths, no more.
/// assert!(squeeze.prove_infeasible(1.9e-9).is_none());
/// assert_eq!(squeeze.prove_infeasible(2.1e-9).map(|contact| contact.b), Some(2));
/// ```
#[derive(Clone, Copy)]
pub struct Squeeze<'s, P: Fn(usize) -> usize + Copy> {
    /// What is between.
    pub bodies: &'s [SolverBody],
    /// Their distances are those that were measured.
    pub contacts: &'s [ContactPoint],
    /// By how much the bodies of each may move against each other until its features need not be the closest ones any more.
    pub slides: &'s [f64],
    /// The place of a contact's body in the list.
    pub place: P,
}

impl<P: Fn(usize) -> usize + Copy> Squeeze<'_, P> {
    /// How fast the fastest contact closes if what impulses move stands still.
    #[must_use]
    pub fn closing(&self) -> f64 {
        let velocity = |body: usize| self.bodies[(self.place)(body)].velocity;
        let closing = |c: &ContactPoint| -c.rate(velocity(c.a), velocity(c.b));
        self.contacts.iter().map(closing).fold(0.0, f64::max)
    }

    /// The contact that presses most of those with what follows its motion, if no motion of the others keeps the contacts apart for this time:
    /// a proof. Of the time as much counts as leaves arms and normals about as they are. None: there is such a motion, or no proof was found.
    #[must_use]
    pub fn prove_infeasible(&self, most: f64) -> Option<ContactPoint> {
        let fastest = self.closing();
        let length = most.min(self.steady(fastest));
        let stays = self.stay(length, FAST * fastest);
        if stays.contains(&false) {
            // Of the others alone: arms, speeds and times are others then.
            let kept = self.contacts.iter().zip(self.slides).zip(&stays).filter(|(_, stays)| **stays);
            let (contacts, slides): (Vec<_>, Vec<_>) =
                kept.map(|((contact, slide), _)| (*contact, *slide)).unzip();
            return Squeeze { contacts: &contacts, slides: &slides, ..*self }.prove_infeasible(most);
        }
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
        driven.max_by(|x, y| x.1.total_cmp(y.1)).map(|(contact, _)| *contact)
    }

    /// How long arms and normals stay about as they are, if this is how fast something closes in.
    fn steady(&self, fastest: f64) -> f64 {
        let arms = self.bodies.iter().zip(self.reach()).filter(|(body, _)| body.inverse_mass > 0.0);
        let arms = arms.map(|(_, reach)| reach).filter(|reach| *reach > 0.0);
        STEADY * arms.fold(f64::INFINITY, f64::min) / (FAST * FAST * fastest)
    }

    /// Do the features of each contact stay the closest ones for this time, with speeds up to this one?
    fn stay(&self, length: f64, speed: f64) -> Vec<bool> {
        let speeds = self.speeds(speed);
        let stays = |(c, slide): (&ContactPoint, &f64)| {
            let Rates { turn, both, .. } = self.rates(c, &speeds);
            let moved = Interval::point(2.0 * length) * (both + turn * Interval::point(c.distance));
            let room = Interval::point(*slide - ROUNDED * c.size()) - moved;
            room.certainly_positive() && (turn * Interval::point(length)).sup() <= MOST_TURN
        };
        self.contacts.iter().zip(self.slides).map(stays).collect()
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

    /// How fast points of each body are at most, and how fast it turns, where what impulses move is as fast as this: whatever is met at its
    /// center alone may turn at any rate.
    fn speeds(&self, speed: f64) -> Vec<(Interval, Interval)> {
        let speeds = |(body, reach): (&SolverBody, f64)| {
            let (speed, reach) = (Interval::point(speed), Interval::point(reach));
            let Velocity { linear, angular } = body.velocity;
            let [linear, angular] = [linear, angular].map(|v| IntervalVec3::point(v).norm());
            let turn = if reach == Interval::ZERO { Interval::ENTIRE } else { speed / reach };
            if body.inverse_mass > 0.0 { (speed, turn) } else { (linear.max(angular * reach), angular) }
        };
        self.bodies.iter().zip(self.reach()).map(speeds).collect()
    }

    /// How fast the bodies of a contact move, and its direction turns, at most.
    fn rates(&self, c: &ContactPoint, speeds: &[(Interval, Interval)]) -> Rates {
        let [(va, ta), (vb, tb)] = [c.a, c.b].map(|body| speeds[(self.place)(body)]);
        let turning = if matches!(c.feature, FeaturePair::EdgeEdge { .. }) { TURNING } else { 1.0 };
        Rates { turn: Interval::point(turning) * ta.max(tb), both: va + vb, inward: va * ta + vb * tb }
    }

    /// By how much the rate of a contact may change in a unit of time, and by how much it may be off since its normal is askew.
    fn bend(&self, c: &ContactPoint, speeds: &[(Interval, Interval)]) -> (Interval, Interval) {
        let Rates { turn, both, inward } = self.rates(c, speeds);
        let bend = inward + turn * (Interval::point(4.0) * both + turn * Interval::point(c.distance));
        (bend, Interval::point(2.0 * ASKEW) * both)
    }

    /// Is Σ λ (J v + g + d/τ) negative, with all that bends, for all velocities whose speeds, at the longest arm too, are up to this one?
    fn is_negative(&self, multipliers: &[f64], length: f64, speed: f64) -> bool {
        let mut pushes = vec![(IntervalVec3::ZERO, IntervalVec3::ZERO); self.bodies.len()];
        let (mut sum, speeds) = (Interval::ZERO, self.speeds(speed));
        for (c, weight) in self.contacts.iter().zip(multipliers).filter(|(_, weight)| **weight > 0.0) {
            let weight = Interval::point(*weight);
            let off = ROUNDED * c.size() + 2.0 * ASKEW * c.distance;
            sum += weight * (Interval::around(c.distance, off) / Interval::point(length));
            let (bend, askew) = self.bend(c, &speeds);
            sum += weight * (bend * Interval::point(0.5 * length) + askew);
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

/// Bounds on the motion of the bodies of a contact.
struct Rates {
    /// n: how fast its direction turns.
    turn: Interval,
    /// V_a + V_b.
    both: Interval,
    /// V_a²/ρ_a + V_b²/ρ_b: how fast their points are drawn inward.
    inward: Interval,
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
        answer(&Squeeze { bodies: &bodies, contacts: &contacts, slides: &[1.0; 2], place: |i| i })
    }

    fn squeezed(rooms: [f64; 2], length: f64) -> bool {
        with_squeeze(rooms, |squeeze| squeeze.prove_infeasible(length).is_some())
    }

    fn proven(rooms: [f64; 2], length: f64) -> bool {
        // The same multiplier of both contacts moves the stone nowhere: what they prove depends on the distances alone.
        with_squeeze(rooms, |squeeze| squeeze.is_negative(&[1.0; 2], length, FAST))
    }

    /// A press has used up the room of a stone after as much time as both gaps are wide, however it gives way.
    #[test]
    fn what_has_no_room_is_proven_to_have_none() {
        assert!(squeezed([1e-10, 3e-10], 5e-10) && squeezed([0.0, 1e-9], 1.01e-9));
        assert!(!squeezed([1e-10, 3e-10], 3.9e-10) && !squeezed([1e-9, 1e-9], 1e-15));
        assert!(proven([1e-9; 2], 2.1e-9) && !proven([1e-9; 2], 1.9e-9));
        // However long the press goes on.
        assert!(squeezed([1e-10, 3e-10], 1e-3));
    }

    /// While a press comes down by a thousandth of the size of a stone, one that is thirty times as fast turns out from under it, though no
    /// velocities at the start would: its contacts lie in one line.
    #[test]
    fn what_could_turn_out_is_not_crushed() {
        assert!(!squeezed([1e-6; 2], 1e-3) && !proven([1e-6; 2], 1e-3));
    }

    /// Of two contacts that leave no room one ends after a way that is shorter than what the bodies move meanwhile.
    #[test]
    fn what_slips_off_is_no_part_of_a_proof() {
        with_squeeze([1e-10, 3e-10], |squeeze| {
            let moved = 2.0 * 5e-10 * (2.0 * FAST + 1.0);
            for (slide, is_proven) in [(2.0 * moved, true), (0.4 * moved, false), (0.0, false)] {
                let slides = &[1.0, slide];
                assert_eq!(
                    Squeeze { slides, ..*squeeze }.prove_infeasible(5e-10).is_some(),
                    is_proven,
                    "{slide}"
                );
            }
        });
    }

    /// Where a press meets a stone that could slip out, no multipliers are a proof.
    #[test]
    fn what_could_slip_out_is_not_crushed() {
        for tilt in [1e-2, -0.3] {
            let normal = DVec3::new(tilt, 1.0, 0.0).normalize();
            with_squeeze([0.0; 2], |squeeze| {
                let contacts = [squeeze.contacts[0], ContactPoint { normal, ..squeeze.contacts[1] }];
                assert!(Squeeze { contacts: &contacts, ..*squeeze }.prove_infeasible(1.0).is_none());
            });
        }
    }

    /// What is met at its center alone may turn at any rate, and nothing is proven of it; what rests, or comes down without a turn, may be.
    #[test]
    fn what_is_met_at_its_center_may_turn_at_any_rate() {
        let zero = DVec3::ZERO;
        with_squeeze([1e-10, 3e-10], |squeeze| {
            let [lower, upper] = [squeeze.contacts[0], squeeze.contacts[1]];
            let at_others = [ContactPoint { arm_a: zero, ..lower }, ContactPoint { arm_b: zero, ..upper }];
            let at_stone = [ContactPoint { arm_b: zero, ..lower }, ContactPoint { arm_a: zero, ..upper }];
            let proof = |contacts| Squeeze { contacts, ..*squeeze }.prove_infeasible(5e-10);
            assert!(proof(&at_others).is_some() && proof(&at_stone).is_none());
        });
    }
}
