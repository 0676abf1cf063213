//! Brakes on jointed bodies that the forces of their joints turn to and fro faster than steps are long.
//!
//! A body with the moment of inertia I that hangs between forces F, which pull outwards at arms r, oscillates
//! across them at the rate ω with ω² = Σ F·r / I. Light bodies between heavy ones do so much faster than
//! steps are long, and impulses at the arms of a flight's start amplify each oscillation from ω h = 2 on.
//! There the change of their spin is braked by how much more the forces turn them back at the end of the
//! flight:
//!
//! ```text
//! I Δω = Σ r × F h − G Δω,     G = (2 − 1/s) h² K,     K = Σ (r·F)₊ (1 − F Fᵀ/F²),     s = h² tr(I⁻¹ K)
//! ```
//!
//! where s is above one half, so that slower oscillations hardly change. It is Newmark's rule (J. Eng. Mech.
//! Div. 85(3), 1959): with G, h² K/(I + G) would have to be above 4 for an instability, and it is some 1/2 at
//! most. A constant spin is not braked, so oscillations keep their energy; the error is of the second order
//! in h, as that of steps is anyway.

use crate::body::rigid_body::RigidBody;
use crate::body::turning::Pull;
use core::ops::Range;
use d2m_contact::{ContactPoint, System};
use glam::{DMat3, DVec3};
use std::borrow::Cow;

/// The factor 2 of the module's G: twice what forces turn back until the end of a flight, since they may be
/// twice as large then.
const BRAKING: f64 = 2.0;
/// Bodies are braked from this s of the module on: half of the mean of two directions, each of which could be
/// at 1 and is stable until 4.
const FAST: f64 = 0.5;

/// The rows of each joint that hold points together, which stand one after the other.
fn joints(contacts: &[ContactPoint]) -> impl Iterator<Item = Range<usize>> {
    let number = |contact: &ContactPoint| match contact.row {
        Some(row) if !row.is_angular && row.is_equation() => contact.joint(),
        _ => None,
    };
    let mut next = 0;
    core::iter::from_fn(move || {
        let first = next + contacts[next..].iter().position(|contact| number(contact).is_some())?;
        let joint = number(&contacts[first]);
        next = first + contacts[first..].iter().take_while(|contact| number(contact) == joint).count();
        Some(first..next)
    })
}

/// The angular impulse, for each radian by which an arm turns, with which an impulse at the arm turns it
/// back: alike in all directions across the impulse.
fn turned_back(arm: DVec3, impulse: DVec3) -> DMat3 {
    let square = impulse.length_squared();
    if square == 0.0 {
        return DMat3::ZERO;
    }
    let along = DMat3::from_cols(impulse * impulse.x, impulse * impulse.y, impulse * impulse.z);
    (DMat3::IDENTITY - along * (1.0 / square)) * arm.dot(impulse).max(0.0)
}

/// The pulls on the bodies in flights of a length, with the impulses of these contacts, where they are
/// stronger than those `before`. `free`: the spins without impulses, of those bodies that may be braked.
pub(crate) fn pulls(
    before: &[Option<Pull>],
    states: &[Cow<'_, RigidBody>],
    free: &[Option<DVec3>],
    contacts: &[ContactPoint],
    length: f64,
    place: impl Fn(usize) -> usize,
) -> Vec<Option<Pull>> {
    let mut sums = vec![DMat3::ZERO; states.len()];
    for rows in joints(contacts) {
        let first = contacts[rows.start];
        let impulse: DVec3 = contacts[rows].iter().map(ContactPoint::total).sum();
        sums[place(first.a)] += turned_back(first.arm_a, -impulse);
        sums[place(first.b)] += turned_back(first.arm_b, impulse);
    }
    let pull = |(k, sum): (usize, DMat3)| {
        // Impulses are forces times the length already.
        let squares = states[k].inverse_inertia_at(states[k].orientation) * sum * length;
        let speed = squares.x_axis.x + squares.y_axis.y + squares.z_axis.z;
        let stiffness = || sum * ((BRAKING - BRAKING * FAST / speed) * length);
        let pull = free[k].filter(|_| speed > FAST);
        let pull = pull.map(|free| Pull { speed, stiffness: stiffness(), free });
        let known = before.get(k).copied().flatten();
        if known.is_some_and(|known| known.speed >= speed) { known } else { pull.or(known) }
    };
    sums.into_iter().enumerate().map(pull).collect()
}

/// The couples that brake the bodies, with the velocities of a system.
pub(crate) fn couples(
    system: &System,
    members: &[usize],
    pulls: &[Option<Pull>],
) -> impl Iterator<Item = ContactPoint> {
    pulls.iter().enumerate().filter_map(|(k, pull)| {
        let pull = (*pull)?;
        let change = system.bodies[k].velocity.angular - pull.free;
        ContactPoint::couple(members[k], -(pull.stiffness * change))
    })
}
