//! The exact Coulomb law, solved for the velocities of an island by a proximal Newton method.
//!
//! With multipliers λ₀ and shifts s the velocities v minimize the convex function
//!
//! ```text
//! ½ |v − v*|²_M + Σ ½ r |P(y)|²,     y = λ₀ − (J v − b + s e)/r,     λ = P(y)
//! ```
//!
//! (an augmented Lagrangian; P projects on the cone of each contact). Its Hessian M + Jᵀ (∂P/r) J is positive definite and sparse by pairs of
//! bodies, so Newton's method with an exact line search finds the minimum whatever the masses are. That is one *round*. After each round
//! λ₀ ← λ, and s ← μ |u_t| by Anderson's acceleration, as de Saxcé's form of the law asks for. Of the several solutions that friction may have,
//! rounds that begin with s = 0 find one in which contacts stick where they can. Every iterate is judged by the residual of the law itself
//! ([`System::residual`]), and the best one is kept.

use super::accuracy::Accuracy;
use super::block::Block;
use super::convex::Convex;
use super::law::Projected;
use super::solver_body::SolverBody;
use super::system::System;
use d2m_cholesky::{Anderson, Factor};
use glam::DMat3;

/// How many rounds and Newton steps a direct solution may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Effort {
    /// The most rounds.
    rounds: u32,
    /// The most Newton steps in a round.
    steps: u32,
    /// The solution ends after this many rounds in a row without a smaller residual.
    losses: u32,
}

impl Effort {
    /// For an exact solution.
    pub(super) const FULL: Self = Self { rounds: 20, steps: 80, losses: 3 };
    /// For many bodies that come to rest: of piles side by side the residual falls only in some of the rounds.
    pub(super) const PATIENT: Self = Self { rounds: 35, losses: 7, ..Self::FULL };
    /// For bodies of which every contact may stick: then four or five rounds, with ever harder rows, are enough.
    pub(super) const STUCK: Self = Self { rounds: 6, ..Self::FULL };
    /// For what sweeps have left of moving bodies: with soft rows a round takes three or four steps, even where many contacts slide, and the
    /// first rounds reduce the residual most.
    pub(super) const SHORT: Self = Self { rounds: 4, steps: 8, ..Self::FULL };

    fn is_short(self) -> bool {
        self.steps < Self::FULL.steps
    }
}

/// The ratio of masses beyond which sweeps converge too slowly, and so does Newton's method on rows as hard as that ratio asks for.
pub(super) const MOST_RATIO: f64 = 30.0;
/// With rows of softness r one round leaves r/(r + m/M) of the rate with which the heaviest body, of mass M, presses on the lightest one, of
/// mass m. So r is this part of m/M.
const SHARE: f64 = 1e-2;
/// The least softness, as a part of that one, and of any rows.
const HARDEST: f64 = 1e-4;
const LEAST_SOFT: f64 = 1e-11;
/// The softness is multiplied by the first factor where most of a round's residual comes from rows that yield, and by the second one where the
/// minimum of a round is not found, as happens where many contacts slide, the more the harder the rows are.
const HARDER: f64 = 0.05;
const SOFTER: f64 = 100.0;
/// Rows count as yielding where the residual with the round's own shifts exceeds this part of the residual. Below that the shifts have changed,
/// which converge no faster on harder rows, while Newton's method takes more steps there.
const YIELDED: f64 = 0.5;
/// The greatest softness at the start of a solution.
const MOST_SOFT: f64 = 1e-2;
/// The same where there are joints: errors of their rows add up from step to step.
const JOINED: f64 = 1e-5;
/// For moving bodies a round within the tolerance is the last one if its residual exceeds this part of that of the round before.
const GAINED: f64 = 1.0 / 16.0;
/// After sweeps a round is the last one if its residual exceeds this part of that of the round before.
const LITTLE: f64 = 0.8;
/// The softness of rows, relative to their scale, when multipliers are sought for a proof that no velocities obey them. Errors are of this order
/// relative to the rates, far above rounding.
const PRESSED: f64 = 1.0 / (1u64 << 30) as f64;
/// The minimum of a round is found to this part of the residual that is aimed at.
const INNER: f64 = 0.25;

/// Where a solution begins. Friction often allows several: a wedge may slip with a small normal force, or stick with any larger one.
///
/// ```
/// use d2m_contact::{Accuracy, ContactPoint, Material, SolverBody, Start, System, Velocity};
/// use glam::{DMat3, DVec3};
/// // A stone between the steep sides of a groove, with friction enough to hang there: nothing presses on it yet.
/// let stone = SolverBody {
///     inverse_mass: 1.0,
///     inverse_inertia: DMat3::ZERO,
///     velocity: Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO },
/// };
/// let side = |normal: DVec3| ContactPoint::new([0, 1], [DVec3::ZERO; 2], normal, Material::new(0.0, 10.0));
/// let sides = [DVec3::new(0.99, 0.1, 0.0), DVec3::new(-0.99, 0.1, 0.0)].map(|n| side(n.normalize()));
/// let mut system = System::new(vec![SolverBody::FIXED, stone], &sides, |body| body);
/// assert!(system.solve(&[0.0; 2], Accuracy::exact(1e-9), Start::Sticking) < 1e-9);
/// assert!(system.bodies[1].velocity.linear.length() < 1e-8);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Start {
    /// With all contacts sticking; the solution ends where one cannot.
    Stuck,
    /// With all contacts sticking; those that cannot begin to slide.
    Sticking,
    /// With the sliding that there is.
    Present,
}

impl System {
    /// Solves from the present impulses; the residual. The bodies' velocities follow from the impulses exactly.
    pub(super) fn solve_direct(
        &mut self,
        targets: &[f64],
        accuracy: Accuracy,
        start: Start,
        effort: Effort,
    ) -> f64 {
        let (places, count) = self.moved_places(targets);
        let Some(mut factor) = self.take_factor(&places, count) else { return self.residual(targets) };
        let free = self.free();
        let inertia: Vec<DMat3> = self.bodies.iter().map(inertia_of).collect();
        let begun = (self.residual(targets), self.impulses.clone());
        let mut best: Option<(f64, Vec<[f64; 3]>)> = None;
        let mut tolerance = self.tolerance(accuracy);
        let aim_of = |of: &Self| {
            let is_rough = effort.is_short() || of.is_uneven_crowd(accuracy);
            if is_rough { of.enough(accuracy) } else { of.aim(accuracy) }
        };
        let mut aim = aim_of(self);
        let slides = |block: &Block, of: &System| {
            let [_, t, u] = block.rates(|i| of.bodies[i].velocity);
            block.law.friction() * (t * t + u * u).sqrt()
        };
        let shift = match start {
            Start::Stuck | Start::Sticking => vec![0.0; self.blocks.len()],
            Start::Present => self.blocks.iter().map(|block| slides(block, self)).collect(),
        };
        let mut state = (self.impulses.clone(), shift, self.velocities());
        let mut anderson = Anderson::default();
        let most_soft = if self.has_joints || self.is_long() { JOINED } else { MOST_SOFT };
        let mut soft = (SHARE / self.ratio()).clamp(LEAST_SOFT, most_soft);
        let is_uneven = self.ratio() > MOST_RATIO && !effort.is_short();
        // The softness that the masses ask for, and the least one for rounds whose shifts are new.
        let (hard, mut softest) = (soft, 0.0_f64);
        let hardest = (HARDEST * SHARE / self.ratio()).max(LEAST_SOFT);
        let (mut last, mut losses) = (f64::INFINITY, 0);
        for _ in 0..effort.rounds {
            let (center, shift, velocity) = state;
            let kept = (center.clone(), shift.clone(), velocity.clone());
            let found = vec![Projected { impulse: [0.0; 3], slope: None }; self.blocks.len()];
            let mut round = Convex {
                system: self,
                targets,
                free: &free,
                inertia: &inertia,
                places: &places,
                soft,
                center,
                shift,
                velocity,
                found,
            };
            let is_found = round.minimize(&mut factor, INNER * aim, effort.steps);
            let impulses: Vec<[f64; 3]> = round.found.iter().map(|found| found.impulse).collect();
            let Convex { shift, velocity, .. } = round;
            self.set(&free, &impulses);
            let residual = self.residual(targets);
            // Impulses mean nothing where the minimum is not found. The same round is tried on softer rows, and from what that finds on harder ones
            // again; meanwhile the shifts stay as they are, because bodies that sink into soft rows do not slide.
            let is_lost = is_uneven && !is_found && soft < MOST_SOFT;
            let is_on_way = is_uneven && is_found && soft > hard;
            losses += u32::from(!is_lost && !is_on_way);
            if best.as_ref().is_none_or(|best| residual < best.0) {
                best = Some((residual, impulses.clone()));
                losses = 0;
            }
            tolerance = self.tolerance(accuracy);
            aim = aim_of(self);
            let stops = losses == effort.losses || effort.is_short() && residual > LITTLE * last;
            // Within the tolerance of moving bodies another round is worth it only if this one reduced the residual by much.
            let is_left = tolerance > accuracy.precision && residual <= tolerance && residual > GAINED * last;
            if residual <= aim || stops || is_left {
                break;
            }
            if is_lost {
                soft = (SOFTER * soft).min(MOST_SOFT);
                softest = softest.max(soft);
                state = kept;
                continue;
            }
            last = residual;
            if is_on_way {
                soft = (HARDER * soft).max(hard);
                state = (impulses, shift, velocity);
                continue;
            }
            let yielded = |of: &Self| {
                let own = |k: usize| of.natural_map(k, targets[k], shift[k]);
                (0..targets.len()).map(own).fold(0.0, f64::max)
            };
            // Contacts that creep because rows yield do not slide: the shifts stay as they are until rows are hard enough. Rows of joints begin so
            // hard that they hardly yield, and on harder ones rounding would count.
            let may_harden = is_found && !effort.is_short() && !self.has_joints;
            if may_harden && yielded(self) > YIELDED * residual {
                soft = (HARDER * soft).max(hardest);
                state = (impulses, shift, velocity);
                continue;
            }
            if start == Start::Stuck {
                break;
            }
            soft = if is_found { soft.max(softest) } else { (SOFTER * soft).min(MOST_SOFT) };
            let answer: Vec<f64> = self.blocks.iter().map(|block| slides(block, self)).collect();
            state = (impulses, anderson.next(&shift, answer), velocity);
        }
        // The impulses at the start may obey the law as well, but with contacts that slip: they count only where nothing else does.
        let best = best.filter(|best| best.0 <= tolerance.max(begun.0)).unwrap_or(begun);
        self.set(&free, &best.1);
        self.factor = Some(factor);
        best.0
    }

    /// Multipliers of frictionless contacts with rows so hard that they hardly yield, of bodies without other impulses: where no velocities obey
    /// the targets, those that violate them least. None: they are not found.
    pub(super) fn press_hard(mut self, targets: &[f64], fastest: f64) -> Option<Vec<f64>> {
        let (places, count) = self.moved_places(targets);
        let mut factor = self.take_factor(&places, count)?;
        let free = self.velocities();
        let inertia: Vec<DMat3> = self.bodies.iter().map(inertia_of).collect();
        let none = Projected { impulse: [0.0; 3], slope: None };
        let mut round = Convex {
            system: &self,
            targets,
            free: &free,
            inertia: &inertia,
            places: &places,
            soft: PRESSED,
            center: self.impulses.clone(),
            shift: vec![0.0; self.blocks.len()],
            velocity: free.clone(),
            found: vec![none; self.blocks.len()],
        };
        round.minimize(&mut factor, PRESSED * fastest, Effort::FULL.steps);
        Some(round.found.iter().map(|found| found.impulse[0]).collect())
    }

    /// The places among each other of the bodies that move and that these targets ask something of, and how many there are.
    fn moved_places(&self, targets: &[f64]) -> (Vec<Option<usize>>, usize) {
        let mut is_asked = vec![false; self.bodies.len()];
        for (block, _) in self.blocks.iter().zip(targets).filter(|(_, target)| **target > f64::NEG_INFINITY) {
            (is_asked[block.a], is_asked[block.b]) = (true, true);
        }
        let mut count = 0;
        let place = |body: usize| {
            (is_asked[body] && self.is_moved(body)).then(|| {
                count += 1;
                count - 1
            })
        };
        let places = (0..self.bodies.len()).map(place).collect();
        (places, count)
    }

    /// The factorization for the pairs of bodies that blocks connect.
    fn take_factor(&mut self, places: &[Option<usize>], count: usize) -> Option<Factor> {
        let of = |block: &Block| {
            let (a, b) = (places[block.a]?, places[block.b]?);
            (a != b).then_some([a.min(b), a.max(b)])
        };
        let mut pairs: Vec<[usize; 2]> = self.blocks.iter().filter_map(of).collect();
        pairs.sort_unstable();
        pairs.dedup();
        match self.factor.take().filter(|factor| factor.is_for(count, &pairs)) {
            Some(factor) => Some(factor),
            None if count > 0 => Factor::try_new(count, pairs),
            None => None,
        }
    }
}

/// Of a body that moves; symmetric.
fn inertia_of(body: &SolverBody) -> DMat3 {
    if body.inverse_mass == 0.0 {
        return DMat3::ZERO;
    }
    let inertia = body.inverse_inertia.inverse();
    (inertia + inertia.transpose()) * 0.5
}

#[cfg(test)]
mod tests {
    use super::super::ContactPoint;
    use super::super::point::{Material, upright};
    use super::super::sweeps::tests::column;
    use super::*;
    use crate::Company;
    use crate::velocity::Velocity;
    use glam::DVec3;

    const EXACT: Accuracy = Accuracy {
        precision: 1e-9,
        relative: 0.0,
        aim: 1.0,
        company: Company::Few,
        slow: 1.0,
        still: None,
        beside_sleepers: false,
    };

    /// Of ten in a column, of which only the lowest two are asked to keep apart, those two have places.
    #[test]
    fn what_is_asked_nothing_has_no_place() {
        let mut targets = [f64::NEG_INFINITY; 10];
        targets[1] = 0.0;
        let (places, count) = column(10, 0.0).moved_places(&targets);
        assert_eq!((places.iter().flatten().count(), count), (2, 2));
        assert_eq!(column(10, 0.0).moved_places(&[0.0; 10]).1, 10);
    }

    /// In one round soft rows of a column yield by far more than that under all that lies on them.
    #[test]
    fn rows_get_harder_under_tall_columns() {
        let (count, speed) = (100, 0.01);
        let mut system = column(count, speed);
        let residual = system.solve_direct(&vec![0.0; count], EXACT, Start::Sticking, Effort::FULL);
        assert!(residual < EXACT.precision, "{residual}");
    }

    /// What slides does not lift: without the shift by what it slides it would, as fast as friction times that.
    #[test]
    fn what_slides_stays_on_the_ground() {
        let body = |inverse_mass: f64, velocity: DVec3| SolverBody {
            inverse_mass,
            inverse_inertia: DMat3::IDENTITY,
            velocity: Velocity { linear: velocity, angular: DVec3::ZERO },
        };
        let bodies = vec![body(0.0, DVec3::ZERO), body(0.5, DVec3::new(3.0, -1.0, 0.0))];
        let mut contact = ContactPoint { arm_a: DVec3::ZERO, arm_b: DVec3::ZERO, ..upright([0, 1]) };
        contact.material = Material::new(0.0, 0.3);
        let mut system = System::new(bodies, &[contact], |i| i);
        let residual = system.solve_direct(&[0.0], EXACT, Start::Sticking, Effort::FULL);
        assert!(residual < EXACT.precision, "{residual}");
        let off = system.bodies[1].velocity.linear - DVec3::X * 2.7;
        assert!(off.length() < 1e-8, "{off}");
    }
}
