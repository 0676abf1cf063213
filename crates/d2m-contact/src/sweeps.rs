//! Projected Gauss–Seidel: one block after the other, each with the velocities that the blocks before it have left.

use super::accuracy::{Accuracy, Company};
use super::lanes::{Descent, Ends, Off, Wide};
use super::system::System;

/// How sweeps follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Pace {
    /// Plain sweeps.
    Steady,
    /// After each two sweeps a step along the direction of the steps before, as conjugate gradients make it.
    Conjugate,
}

impl System {
    /// Sweeps over all blocks until the residual is small enough, `most` times at most. Returns the residual.
    pub(super) fn sweep_until(&mut self, targets: &[f64], accuracy: Accuracy, pace: Pace, most: u32) -> f64 {
        let mut wide = self.wide.take().unwrap_or_else(|| Wide::new(&self.bodies, &self.blocks));
        wide.fill(self.numbers(targets));
        let mut off = wide.sweep(0, None);
        let (mut best, mut kept) = (off.most, wide.kept());
        let ends = if self.mean_speed() <= accuracy.slow { Ends::Grown } else { Ends::Back };
        let mut descent = (pace == Pace::Conjugate).then(|| Descent::new(ends));
        let mut done = 0;
        while !self.is_swept(off, accuracy) && done < most {
            off = wide.sweep(BETWEEN / 2, descent.as_mut());
            wide.move_bodies(&mut self.bodies);
            done += BETWEEN;
            if off.most < best || pace == Pace::Steady {
                best = off.most;
                wide.keep(&mut kept);
            }
        }
        // Along a conjugate direction the residual may grow for a while.
        if off.most > best && !self.is_swept(off, accuracy) {
            wide.take_back(kept);
        }
        wide.move_bodies(&mut self.bodies);
        wide.write(&mut self.impulses);
        self.wide = Some(wide);
        self.residual(targets)
    }

    /// Is the residual small enough? In crowds single blocks may have larger ones if the quadratic mean is small. In a [`Company::Heap`] no contact may
    /// close so fast that it ends its flight: that event would solve the same bodies again, no better than now.
    fn is_swept(&self, off: Off, accuracy: Accuracy) -> bool {
        let enough = self.enough(accuracy);
        let may_be_left = || off.most <= self.left(accuracy) && off.mean <= MEAN * enough;
        let has_room = accuracy.company != Company::Heap || off.has_room;
        off.most <= enough || has_room && may_be_left()
    }
}

/// The residual is computed after this many sweeps, an even number; it costs about as much as one of them.
const BETWEEN: u32 = 6;
/// The quadratic mean of a crowd's residuals may be this part of what a single one may be. With a half twice as many contacts are expected
/// afterwards; an eighth takes longer than it saves.
const MEAN: f64 = 0.25;
#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::point::Material;
    use crate::point::upright;
    use crate::velocity::Velocity;
    use crate::{ContactPoint, SolverBody, tangents};
    use d2m_testing::{Draw, KnuthRandom};
    use glam::{DMat3, DVec3};

    const ACCURACY: Accuracy = Accuracy {
        precision: 1e-7,
        relative: 1.0 / 1024.0,
        aim: 1e-3,
        company: Company::Crowd,
        slow: 1.0,
        still: None,
        beside_sleepers: false,
    };

    /// So many bodies of mass one on each other, the lowest one on the ground, which is the last body; all fall at one speed.
    pub(crate) fn column(count: usize, speed: f64) -> System {
        let body = |mass: f64, speed: f64| SolverBody {
            inverse_mass: mass,
            inverse_inertia: DMat3::IDENTITY * mass,
            velocity: Velocity { linear: DVec3::NEG_Y * speed, angular: DVec3::ZERO },
        };
        let mut bodies = vec![body(1.0, speed); count];
        bodies.push(body(0.0, 0.0));
        let contact = |upper: usize| {
            let lower = upper.checked_sub(1).unwrap_or(count);
            upright([lower, upper])
        };
        let contacts: Vec<_> = (0..count).map(contact).collect();
        // Taken for a crowd, and for no row, which is not swept.
        System { is_row: false, ..System::new(bodies, &contacts, |body| body) }
    }

    /// Sweeps of a column pass on what is at one end by a body each; along a way they gain more than three times as much.
    #[test]
    fn sweeps_that_go_on_along_their_way_gain_more() {
        let left = |pace: Pace| {
            let mut system = column(24, 0.01);
            let residual = system.sweep_until(&[0.0; 24], ACCURACY, pace, 48);
            assert_eq!(residual, system.residual(&[0.0; 24]));
            residual
        };
        let (steady, conjugate) = (left(Pace::Steady), left(Pace::Conjugate));
        assert!(3.0 * conjugate < steady, "{conjugate} {steady}");
    }

    /// A way that sweeps go on along against what they change themselves leads off. Of a wall of 24 by 24 bodies that move, each with four rough contacts
    /// that are askew, with the two below it or with the ground.
    #[test]
    fn ways_end_where_sweeps_lead_back() {
        let (mut bodies, state) = (column(576, 0.01).bodies, &mut KnuthRandom(5));
        for body in &mut bodies {
            body.velocity.linear.x = 10.0;
        }
        let askew = |k: usize| {
            let below = (k / 4).checked_sub(24);
            let lower = below.map_or(576, |body| body - body % 24 + (body + k % 4 / 2) % 24);
            let normal = (DVec3::Y + 0.5 * state.vector()).normalize();
            ContactPoint {
                normal,
                tangents: tangents(normal),
                arm_a: 0.5 * DVec3::Y + 0.4 * state.vector(),
                arm_b: -0.5 * DVec3::Y + 0.4 * state.vector(),
                material: Material::new(0.0, 0.5),
                ..upright([lower, k / 4])
            }
        };
        let mut contacts: Vec<ContactPoint> = (0..4 * 576).map(askew).collect();
        contacts.sort_by_key(|contact| (contact.a, contact.b));
        let mut wall = System { is_row: false, ..System::new(bodies, &contacts, |body| body) };
        let accuracy = Accuracy { relative: 0.0, precision: 1e-9, ..ACCURACY };
        let left = wall.sweep_until(&vec![0.0; contacts.len()], accuracy, Pace::Conjugate, 192);
        assert!(left < 2e-3, "{left}");
    }

    /// A crowd that moves may leave more at one place, if little is left of all; a few bodies may not, unless they are of a crowd.
    #[test]
    fn single_blocks_of_crowds_may_be_further_from_their_law() {
        let crowd = column(64, 10.0);
        let enough = crowd.enough(ACCURACY);
        let is_swept = |crowd: &System, (most, mean): (f64, f64), accuracy: Accuracy| {
            let mut wide = Wide::new(&crowd.bodies, &crowd.blocks);
            wide.fill(crowd.numbers(&[0.0; 64]));
            crowd.is_swept(Off { most, mean, has_room: wide.sweep(0, None).has_room }, accuracy)
        };
        let swept = |most: f64, mean: f64| is_swept(&crowd, (most, mean), ACCURACY);
        assert!(swept(enough, enough) && swept(40.0 * enough, 0.2 * enough));
        assert!(!swept(40.0 * enough, 0.3 * enough) && !swept(1.0, 0.0));
        // The lowest contact closes at 10, which ends a flight of this length unless it has that much room.
        let heap = Accuracy { company: Company::Heap, ..ACCURACY };
        for (distance, lasts) in [(0.0, false), (1.0, false), (20.0, true)] {
            let contact = ContactPoint { distance, ..upright([64, 0]) };
            let crowd = column(64, 10.0).for_flights(&[contact], &[0.0], 1.0);
            let off = (40.0 * enough, 0.2 * enough);
            assert!(is_swept(&crowd, off, ACCURACY));
            assert_eq!(is_swept(&crowd, off, heap), lasts, "{distance}");
            assert!(is_swept(&crowd, (enough, enough), heap));
        }
        let alone = Accuracy { company: Company::Few, ..ACCURACY };
        assert!(!is_swept(&crowd, (2.0 * enough, 0.0), alone));
        // Two at rest are solved exactly, unless others are connected with them.
        let calm = column(2, 0.0);
        assert!(calm.enough(ACCURACY) < 0.1 * calm.enough(heap));
        let pair = column(2, 10.0);
        assert!(pair.enough(alone) < 0.1 * pair.enough(ACCURACY) && pair.enough(ACCURACY) == enough);
    }
}
