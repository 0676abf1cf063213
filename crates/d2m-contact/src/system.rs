//! The contacts and joints of an island as one system of rows.

use super::ContactPoint;
use super::block::Block;
use super::lanes::{Numbers, Wide};
use super::law::Law;
use super::solver_body::SolverBody;
use crate::velocity::Velocity;
use d2m_cholesky::Factor;
use glam::{DMat3, DVec3};

/// Contacts between bodies: the impulses that they have, and the velocities with these.
///
/// ```
/// use d2m_contact::{ContactPoint, Material, SolverBody, System, Velocity};
/// use glam::{DMat3, DVec3};
/// let velocity = Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO };
/// let ball = SolverBody { inverse_mass: 0.5, inverse_inertia: DMat3::IDENTITY, velocity };
/// let mut touching = ContactPoint::new([0, 1], [DVec3::Y, DVec3::NEG_Y], DVec3::Y, Material::new(0.0, 0.5));
/// let system = System::new(vec![SolverBody::FIXED, ball], &[touching], |body| body);
/// assert_eq!((system.rate(0), system.residual(&[0.0])), (-1.0, 1.0)); // it closes, and nothing is solved yet
/// // The impulse that stops it obeys the law.
/// touching.impulse = 2.0;
/// let mut warm = System::new(vec![SolverBody::FIXED, ball], &[touching], |body| body);
/// warm.warm_start(&[touching]);
/// assert_eq!((warm.bodies[1].velocity, warm.residual(&[0.0])), (Velocity::default(), 0.0));
/// ```
#[derive(Debug)]
pub struct System {
    /// With their present velocities.
    pub bodies: Vec<SolverBody>,
    pub(super) blocks: Vec<Block>,
    pub(super) impulses: Vec<[f64; 3]>,
    /// How much below their targets the rates of blocks end a flight before its time; empty: no flight follows.
    pub(super) spares: Vec<f64>,
    /// Of each body, the longest arm of its contacts.
    pub(super) reach: Vec<f64>,
    /// Kept from solution to solution.
    pub(super) factor: Option<Factor>,
    pub(super) wide: Option<Wide>,
    /// More than eight contacts of one pair.
    pub(super) is_conforming: bool,
    pub(super) has_joints: bool,
    /// None of the moved bodies touches more than two others: they stand, or hang, in a row.
    pub(super) is_row: bool,
}

/// The impulses of the rows and the velocities of the bodies at one time, to go back to.
///
/// ```
/// use d2m_contact::{Accuracy, ContactPoint, Material, SolverBody, Start, System, Velocity};
/// use glam::{DMat3, DVec3};
/// let velocity = Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO };
/// let ball = SolverBody { inverse_mass: 1.0, inverse_inertia: DMat3::IDENTITY, velocity };
/// let touching = ContactPoint::new([0, 1], [DVec3::Y, DVec3::NEG_Y], DVec3::Y, Material::new(0.0, 0.0));
/// let mut system = System::new(vec![SolverBody::FIXED, ball], &[touching], |body| body);
/// let before = system.present();
/// system.solve(&[0.0], Accuracy::exact(1e-9), Start::Present);
/// assert!(system.rate(0).abs() < 1e-8);
/// system.take_back(before);
/// assert_eq!(system.rate(0), -1.0);
/// ```
#[derive(Clone, Debug)]
pub struct Present {
    impulses: Vec<[f64; 3]>,
    velocities: Vec<Velocity>,
}

/// Contacts of one pair from which on it is conforming: as of a pin in its hole.
const MANY: usize = 8;

/// Touches none of the moved bodies more than two others?
fn is_row(bodies: &[SolverBody], blocks: &[Block]) -> bool {
    let mut partners = vec![[None; 2]; bodies.len()];
    let mut is_second = |body: usize, other: usize| {
        let known = &mut partners[body];
        let place = known.iter().position(|&partner| partner.is_none_or(|partner| partner == other));
        place.map(|place| known[place] = Some(other)).is_some()
    };
    let mut holds = |body: usize, other: usize| bodies[body].inverse_mass == 0.0 || is_second(body, other);
    blocks.iter().all(|block| holds(block.a, block.b) && holds(block.b, block.a))
}

impl System {
    /// Bodies with the velocities that they have without impulses. `place` finds a body of a contact in the list.
    ///
    /// # Panics
    /// Where `place` finds no body.
    #[must_use]
    pub fn new(bodies: Vec<SolverBody>, contacts: &[ContactPoint], place: impl Fn(usize) -> usize) -> Self {
        let block = |contact: &ContactPoint| Block::new(contact, [contact.a, contact.b].map(&place), &bodies);
        let blocks: Vec<Block> = contacts.iter().map(block).collect();
        let mut reach = vec![0.0f64; bodies.len()];
        for (contact, block) in contacts.iter().zip(&blocks) {
            reach[block.a] = reach[block.a].max(contact.arm_a.length());
            reach[block.b] = reach[block.b].max(contact.arm_b.length());
        }
        let is_same = |x: &ContactPoint, y: &ContactPoint| (x.a, x.b) == (y.a, y.b);
        let is_conforming = contacts
            .chunk_by(is_same)
            .any(|of_pair| of_pair.iter().filter(|c| c.row.is_none()).count() > MANY);
        let has_joints = contacts.iter().any(|contact| contact.row.is_some());
        let impulses = vec![[0.0; 3]; blocks.len()];
        let (spares, is_row) = (Vec::new(), is_row(&bodies, &blocks));
        let (factor, wide) = (None, None);
        Self { bodies, blocks, impulses, spares, reach, factor, wide, is_conforming, has_joints, is_row }
    }

    /// For flights of this length in which contacts have these least rates: what closes by more than the room that it has ends them.
    #[must_use]
    pub fn for_flights(mut self, contacts: &[ContactPoint], targets: &[f64], length: f64) -> Self {
        let spare = |(contact, target): (&ContactPoint, &f64)| match contact.row {
            Some(_) => f64::INFINITY,
            None => target + contact.shared_room() / length,
        };
        self.spares = contacts.iter().zip(targets).map(spare).collect();
        self
    }

    /// What lanes take over, with these targets.
    pub(super) fn numbers<'s>(&'s self, targets: &'s [f64]) -> Numbers<'s> {
        let Self { bodies, blocks, impulses, spares, .. } = self;
        Numbers { bodies, blocks, impulses, targets, spares }
    }

    /// With other rates of surfaces that run.
    #[must_use]
    pub fn with_running(mut self, running: &[[f64; 2]]) -> Self {
        for (block, running) in self.blocks.iter_mut().zip(running) {
            block.run(*running);
        }
        self
    }

    /// The bodies have other inertias and velocities, in which the impulses are contained.
    pub fn renew(&mut self) {
        for block in &mut self.blocks {
            block.renew(&self.bodies);
        }
    }

    /// The rate at which the distance of a contact grows.
    #[must_use]
    pub fn rate(&self, contact: usize) -> f64 {
        self.blocks[contact].rates(|i| self.bodies[i].velocity)[0]
    }

    /// Begins with impulses: those the contacts hold already.
    pub fn warm_start(&mut self, contacts: &[ContactPoint]) {
        for (k, contact) in contacts.iter().enumerate() {
            let block = &self.blocks[k];
            let impulse = block.law.project(contact.impulses());
            block.push(&mut self.bodies, impulse);
            self.impulses[k] = impulse;
        }
    }

    /// The impulse of a row, of whatever sign, is no larger than this.
    pub fn bound(&mut self, row: usize, most: f64) {
        if let Law::Range { lo, hi, .. } = &mut self.blocks[row].law {
            (*lo, *hi) = (lo.max(-most), hi.min(most));
        }
        self.wide = None;
    }

    /// Writes the impulses to the contacts.
    pub fn store(&self, contacts: &mut [ContactPoint]) {
        for (contact, [along, first, second]) in contacts.iter_mut().zip(&self.impulses) {
            (contact.impulse, contact.sliding) = (*along, [*first, *second]);
        }
    }

    /// Begins anew: these velocities, and no impulses.
    pub(super) fn begin(&mut self, velocities: &[Velocity]) {
        for (body, velocity) in self.bodies.iter_mut().zip(velocities) {
            body.velocity = *velocity;
        }
        self.impulses.fill([0.0; 3]);
    }

    pub(super) fn velocities(&self) -> Vec<Velocity> {
        self.bodies.iter().map(|body| body.velocity).collect()
    }

    /// The impulses and the velocities, to go back to.
    #[must_use]
    pub fn present(&self) -> Present {
        Present { impulses: self.impulses.clone(), velocities: self.velocities() }
    }

    /// Goes back to them.
    pub fn take_back(&mut self, Present { impulses, velocities }: Present) {
        self.impulses = impulses;
        for (body, velocity) in self.bodies.iter_mut().zip(velocities) {
            body.velocity = velocity;
        }
    }

    /// The velocities without the impulses.
    pub(super) fn free(&self) -> Vec<Velocity> {
        let mut bodies = self.bodies.clone();
        for (block, impulse) in self.blocks.iter().zip(&self.impulses) {
            block.push(&mut bodies, impulse.map(|x| -x));
        }
        bodies.iter().map(|body| body.velocity).collect()
    }

    /// Takes these impulses instead.
    pub(super) fn set(&mut self, free: &[Velocity], impulses: &[[f64; 3]]) {
        for (body, velocity) in self.bodies.iter_mut().zip(free) {
            body.velocity = *velocity;
        }
        for (block, impulse) in self.blocks.iter().zip(impulses) {
            block.push(&mut self.bodies, *impulse);
        }
        self.impulses.copy_from_slice(impulses);
    }

    /// How far the impulses are from what the laws ask for, as a rate: the largest natural map
    ///
    /// ```text
    /// d |λ − P(λ − (u − b + s e)/d)|,     s = μ |u_t| (de Saxcé), d: the scale of the block
    /// ```
    ///
    /// which is zero in a solution and nowhere else. It is infinite where numbers are none or too large for an answer, or a friction is negative.
    /// The velocities follow from the impulses to rounding.
    #[must_use]
    pub fn residual(&self, targets: &[f64]) -> f64 {
        let own = |(k, &target): (usize, &f64)| {
            let own = self.own_residual(k, target);
            // The maximum of numbers would leave out what is none.
            if own.is_nan() { f64::INFINITY } else { own }
        };
        targets.iter().enumerate().map(own).fold(0.0, f64::max)
    }

    /// The natural map of one block.
    #[inline]
    pub(super) fn own_residual(&self, k: usize, target: f64) -> f64 {
        let (block, impulse) = (&self.blocks[k], &self.impulses[k]);
        if block.scale == 0.0 || target == f64::NEG_INFINITY {
            return 0.0;
        }
        // Negative, or none: there is no such law.
        let friction = block.law.friction();
        if friction.is_nan() || friction < 0.0 {
            return f64::INFINITY;
        }
        // A contact without an impulse that opens obeys the law however it slides.
        let rates = block.rates(|i| self.bodies[i].velocity);
        if rates[0] >= target && *impulse == [0.0; 3] && matches!(block.law, Law::Cone { .. }) {
            return 0.0;
        }
        let [_, t, u] = rates;
        block.natural_map(rates, *impulse, target, block.law.friction() * (t * t + u * u).sqrt())
    }

    /// That of one block with another shift s.
    pub(super) fn natural_map(&self, k: usize, target: f64, shift: f64) -> f64 {
        let (block, impulse) = (&self.blocks[k], &self.impulses[k]);
        if block.scale == 0.0 || target == f64::NEG_INFINITY {
            return 0.0;
        }
        block.natural_map(block.rates(|i| self.bodies[i].velocity), *impulse, target, shift)
    }

    /// Twice the kinetic energy of the bodies that impulses move.
    #[must_use]
    pub fn doubled_energy(&self, inertia: &[(f64, DMat3)]) -> f64 {
        self.bodies
            .iter()
            .zip(inertia)
            .map(|(body, (mass, inertia))| {
                let v = &body.velocity;
                mass * v.linear.length_squared() + v.angular.dot(*inertia * v.angular)
            })
            .sum()
    }

    /// Do impulses move this body?
    pub(super) fn is_moved(&self, body: usize) -> bool {
        self.bodies[body].inverse_mass > 0.0
    }

    /// No rate: of a body that nothing drives.
    pub(super) fn zero() -> Velocity {
        Velocity { linear: DVec3::ZERO, angular: DVec3::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Accuracy, Material, Start};
    use glam::{DMat3, DVec3};

    /// A ball that falls on the floor, with one number that is of no use: no solution is claimed.
    #[test]
    fn what_has_no_answer_has_an_infinite_residual() {
        let velocity = Velocity { linear: DVec3::new(0.5, -1.0, 0.0), angular: DVec3::ZERO };
        let ball = SolverBody { inverse_mass: 1.0, inverse_inertia: DMat3::IDENTITY, velocity };
        let contact = ContactPoint::new([0, 1], [DVec3::Y, DVec3::NEG_Y], DVec3::Y, Material::new(0.0, 0.5));
        let residual = |ball: SolverBody, contact: ContactPoint, target: f64| {
            let mut system = System::new(vec![SolverBody::FIXED, ball], &[contact], |body| body);
            let solved = system.solve(&[target], Accuracy::exact(1e-9), Start::Sticking);
            let found = system.residual(&[target]);
            assert!(solved >= found || found <= 1e-9 || solved.is_infinite(), "{solved} {found}");
            found
        };
        assert!(residual(ball, contact, 0.0) <= 1e-9);
        for useless in [f64::NAN, f64::INFINITY, 1e200] {
            let linear = DVec3::new(0.0, -useless, 0.0);
            let fast = SolverBody { velocity: Velocity { linear, ..velocity }, ..ball };
            let light = SolverBody { inverse_mass: useless, ..ball };
            let thin = SolverBody { inverse_inertia: DMat3::IDENTITY * useless, ..ball };
            let long = ContactPoint { arm_b: DVec3::new(useless, -1.0, 0.0), ..contact };
            let askew = ContactPoint { normal: DVec3::Y * useless, ..contact };
            let found = [
                residual(light, contact, 0.0),
                residual(thin, contact, 0.0),
                residual(ball, long, 0.0),
                residual(ball, askew, 0.0),
                residual(fast, contact, 0.0),
                residual(ball, contact, useless),
            ];
            // What has an answer is found, however large its numbers are.
            assert!(found.iter().all(|&found| found.is_infinite() || found <= 1e-9), "{useless}: {found:?}");
            assert!(
                useless == 1e200 || found.iter().all(|found| found.is_infinite()),
                "{useless}: {found:?}"
            );
        }
        for friction in [-1.0, f64::NAN] {
            let material = Material::new(0.0, friction);
            assert!(residual(ball, ContactPoint { material, ..contact }, 0.0).is_infinite());
        }
    }
}
