//! Which method solves an island.

use super::accuracy::{Accuracy, Company, LOOSE};
use super::block::Block;
use super::newton::{Effort, MOST_RATIO, Start};
use super::solver_body::SolverBody;
use super::sweeps::Pace;
use super::system::System;
use crate::moments::extreme_eigenvalues;
use crate::velocity::Velocity;
use core::ops::ControlFlow;
use glam::DVec3;

/// Up to so many movable bodies, not among many others, contacts are tried as sticking ones however fast they slide.
const COUPLE: usize = 4;
/// Up to so many solutions are exact, whatever the bodies do.
const FEW: usize = 20;
/// Up to so many jammed bodies that come to rest are tried with sticking contacts.
const SOME: usize = 64;
/// Up to so many contacts bodies that come to rest are solved exactly: errors of sweeps add up from level to level of a pile.
const SETTLING: usize = 1 << 14;
/// The most sweeps where they come first, and where they come last.
const FIRST: u32 = 192;
const SWEEPS: u32 = 60;
/// An exact solution of up to so many contacts ends with up to so many sweeps, and with as many that begin without impulses where these fail.
const FEW_BLOCKS: usize = 64;
const FEW_SWEEPS: u32 = 4096;
/// The residual may be so many times the tolerance for several moving bodies, and for a crowd.
const SEVERAL: f64 = 4.0;
const CROWDED: f64 = 16.0;
/// Normals with a cosine below this push from opposite sides. (Three that push from all sides of a plane have −1/2.)
const OPPOSITE: f64 = -0.25;
/// A body that follows its motion may take others along by friction at up to this many times the slow speed.
const TAKEN: f64 = 4.0;
/// A residual above this part of the slow speed means that no impulses obey the law.
pub(super) const GROSS: f64 = 0.25;
/// Sweeps of a crowd may leave these parts of the slow speed and of the mean speed: a contact that closes so fast is an event of two bodies,
/// which costs less than a direct solution of all.
const SWEPT: f64 = 0.5;
const OF_SPEED: f64 = 1.0 / 16.0;
/// A residual above this many times [`System::left`] is a failure, and other methods are tried: a direct solution of a crowd takes longer than sweeps, and
/// of a residual twice as large as allowed it rarely leaves less than half.
///
/// ```
/// use d2m_contact::{Accuracy, ContactPoint, LEFT_OVER, Material, SolverBody, Start, System, Velocity};
/// use glam::{DMat3, DVec3};
/// let velocity = Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO };
/// let ball = SolverBody { inverse_mass: 1.0, inverse_inertia: DMat3::IDENTITY, velocity };
/// let touching = ContactPoint::new([0, 1], [DVec3::Y, DVec3::NEG_Y], DVec3::Y, Material::new(0.0, 0.0));
/// let mut system = System::new(vec![SolverBody::FIXED, ball], &[touching], |body| body);
/// let accuracy = Accuracy::exact(1e-9);
/// let residual = system.solve(&[0.0], accuracy, Start::Present);
/// assert!(residual <= LEFT_OVER * system.left(accuracy)); // it is no failure
/// ```
pub const LEFT_OVER: f64 = 2.0;
/// Rounding of a rate, as a part of the largest change of it by an impulse: a few sums of such values, each rounded by 2⁻⁵³ of them.
const ROUNDED: f64 = 4.0 * f64::EPSILON;
/// Bodies whose mean speed is below this part of the slow speed come to rest.
const CALM: f64 = 0.25;

impl System {
    /// Finds impulses with which the rates of all contacts obey the law, above these targets (one for each contact; −∞: none), beginning with
    /// the impulses that there are. Returns the residual that is left.
    ///
    /// Which method comes when: crowds of like masses are swept first, which costs least; what sweeps leave of moving bodies is solved
    /// directly on soft rows. Few bodies, masses far apart, joints, bodies that come to rest and bodies in a row are solved directly and
    /// exactly; many that come to rest are first tried as if all contacts stuck. Where that leaves more than the tolerance plain sweeps
    /// follow, and of all results the one with the smallest residual is taken. The numbers are those of `docs/theory/dynamics.md`.
    ///
    /// ```
    /// use d2m_contact::{Accuracy, ContactPoint, Material, SolverBody, Start, System, Velocity};
    /// use glam::{DMat3, DVec3};
    /// // A ball of a hundred million kilograms on one of a kilogram on the floor, after a step in which both have fallen.
    /// let ball = |mass: f64| SolverBody {
    ///     inverse_mass: 1.0 / mass,
    ///     inverse_inertia: DMat3::IDENTITY / mass,
    ///     velocity: Velocity { linear: DVec3::NEG_Y, angular: DVec3::ZERO },
    /// };
    /// let arms = [DVec3::Y, DVec3::NEG_Y];
    /// let touching = |pair: [usize; 2]| ContactPoint::new(pair, arms, DVec3::Y, Material::new(0.0, 0.5));
    /// let contacts = [touching([0, 1]), touching([1, 2])];
    /// let mut system = System::new(vec![SolverBody::FIXED, ball(1.0), ball(1e8)], &contacts, |body| body);
    /// let residual = system.solve(&[0.0; 2], Accuracy::exact(1e-9), Start::Sticking);
    /// assert!(residual < 1e-7); // what rounding of such impulses leaves of rates
    /// let mut solved = contacts;
    /// system.store(&mut solved);
    /// assert!((solved[0].impulse / (1e8 + 1.0) - 1.0).abs() < 1e-7);
    /// ```
    pub fn solve(&mut self, targets: &[f64], accuracy: Accuracy, start: Start) -> f64 {
        if self.is_conforming
            && !self.is_crowd()
            && let Some(residual) = self.solve_chosen(targets, accuracy, start)
        {
            return residual;
        }
        let residual = self.residual(targets);
        if accuracy.still.is_some_and(|still| residual <= still) {
            return residual;
        }
        let has_like_masses = self.mass_ratio() <= MOST_RATIO && !self.has_joints;
        let begun = if has_like_masses {
            self.solve_roughly(targets, accuracy, start, residual)
        } else {
            ControlFlow::Continue((residual, start))
        };
        match begun {
            ControlFlow::Break(residual) => residual,
            ControlFlow::Continue((residual, _))
                if self.is_uneven_crowd(accuracy) && residual <= self.enough(accuracy) =>
            {
                residual
            }
            ControlFlow::Continue((residual, start)) => {
                self.solve_exactly(targets, accuracy, start, residual)
            }
        }
    }

    /// What costs less than an exact solution and may be enough for bodies of like masses: sweeps, and a short direct solution of moving bodies.
    /// Breaks with a residual that is small enough; continues with the residual and the start of the exact solution.
    fn solve_roughly(
        &mut self,
        targets: &[f64],
        accuracy: Accuracy,
        start: Start,
        mut residual: f64,
    ) -> ControlFlow<f64, (f64, Start)> {
        if self.is_crowd() {
            residual = self.sweep_until(targets, accuracy, Pace::Conjugate, FIRST);
        }
        let could_stick = start == Start::Sticking && self.could_stick(accuracy);
        let is_swept = accuracy.in_crowd()
            && !could_stick
            && !self.is_crowd()
            && !self.is_long()
            && (!self.is_calm(accuracy) || accuracy.still.is_some());
        if is_swept {
            residual = self.better(residual, 0.0, |system| {
                system.sweep_until(targets, accuracy, Pace::Conjugate, FIRST)
            });
        }
        if accuracy.still.is_some() && residual <= self.aim(accuracy) {
            return ControlFlow::Break(residual);
        }
        if self.moved() > COUPLE && !self.is_calm(accuracy) && !could_stick && !self.is_long() {
            if residual <= self.enough(accuracy).max(LEFT_OVER * self.swept(accuracy)) {
                return ControlFlow::Break(residual);
            }
            let short =
                |system: &mut Self| system.solve_direct(targets, accuracy, Start::Present, Effort::SHORT);
            residual = self.better(residual, 0.0, short);
            let most = if is_swept { CROWDED * self.tolerance(accuracy) } else { self.enough(accuracy) };
            if residual <= most || self.is_crowd() {
                return ControlFlow::Break(residual);
            }
        }
        if could_stick {
            return ControlFlow::Continue((residual, start));
        }
        if is_swept && residual <= self.enough(accuracy) {
            return ControlFlow::Break(residual);
        }
        ControlFlow::Continue((residual, Start::Present))
    }

    /// Direct solutions, with plain sweeps where these fail.
    fn solve_exactly(&mut self, targets: &[f64], accuracy: Accuracy, start: Start, mut residual: f64) -> f64 {
        // Impulses that slip may obey the law as well as those that stick: within the tolerance the new ones are taken.
        let tolerance = self.tolerance(accuracy);
        let is_pile = start == Start::Present && self.moved() > SOME && self.is_calm(accuracy);
        if is_pile {
            residual = self.better(residual, tolerance, |system| {
                system.solve_direct(targets, accuracy, Start::Stuck, Effort::STUCK)
            });
            if residual <= self.aim(accuracy) {
                return residual;
            }
        }
        let effort = if is_pile { Effort::PATIENT } else { Effort::FULL };
        residual =
            self.better(residual, tolerance, |system| system.solve_direct(targets, accuracy, start, effort));
        if residual <= self.tolerance(accuracy).max(self.enough(accuracy)) {
            return residual;
        }
        let is_few = self.blocks.len() <= FEW_BLOCKS && accuracy.is_exact();
        let sweeps = if is_few { FEW_SWEEPS } else { SWEEPS };
        residual =
            self.better(residual, 0.0, |system| system.sweep_until(targets, accuracy, Pace::Steady, sweeps));
        if is_few && residual > self.tolerance(accuracy).max(self.enough(accuracy)) {
            residual = self.better(residual, 0.0, |system| {
                system.sweep_anew(targets, accuracy, sweeps);
                system.solve_direct(targets, accuracy, Start::Present, Effort::FULL)
            });
        }
        if residual <= GROSS * accuracy.slow {
            return residual;
        }
        // No velocities obey the law, as when a body is crushed. Direct solutions may find large ones then, where normals are askew; sweeps from
        // zero impulses stay bounded.
        self.sweep_anew(targets, accuracy, SWEEPS)
    }

    /// Plain sweeps that begin without impulses.
    fn sweep_anew(&mut self, targets: &[f64], accuracy: Accuracy, most: u32) -> f64 {
        let none = vec![[0.0; 3]; self.blocks.len()];
        self.set(&self.free(), &none);
        self.sweep_until(targets, accuracy, Pace::Steady, most)
    }

    /// The residual that is aimed at. Bodies at rest, whose errors add up from step to step, are solved far below the precision where possible;
    /// one that moves alone to the precision; others to the tolerance.
    pub(super) fn aim(&self, accuracy: Accuracy) -> f64 {
        let tolerance = self.tolerance(accuracy);
        let aim = if tolerance <= accuracy.precision {
            accuracy.aim * accuracy.precision
        } else if self.moved() == 1 && !accuracy.in_crowd() {
            accuracy.precision
        } else {
            tolerance
        };
        aim.max(accuracy.still.filter(|_| accuracy.beside_sleepers).unwrap_or(0.0)).max(self.rounding())
    }

    /// Rounding of the rates: between heavy bodies the impulses change the rates of a light one by far more than it moves.
    fn rounding(&self) -> f64 {
        let change = |(block, impulse): (&Block, &[f64; 3])| block.scale * impulse[0].abs();
        ROUNDED * self.blocks.iter().zip(&self.impulses).map(change).fold(0.0, f64::max)
    }

    /// A residual that is small enough.
    pub(super) fn enough(&self, accuracy: Accuracy) -> f64 {
        let (tolerance, moved) = (self.tolerance(accuracy), self.moved());
        let is_exact = self.has_joints || self.is_calm(accuracy);
        let several = if is_exact || moved <= COUPLE && !accuracy.in_crowd() {
            0.0
        } else if self.is_long() || moved <= FEW && !accuracy.in_crowd() {
            SEVERAL
        } else {
            CROWDED
        };
        self.aim(accuracy).max(several * tolerance)
    }

    /// Do many bodies move whose masses are far apart?
    pub(super) fn is_uneven_crowd(&self, accuracy: Accuracy) -> bool {
        let is_uneven = self.mass_ratio() > MOST_RATIO && !self.has_joints;
        is_uneven && accuracy.in_crowd() && self.is_crowd() && !self.is_calm(accuracy)
    }

    /// The residual that solutions of moving bodies may leave.
    #[must_use]
    pub fn left(&self, accuracy: Accuracy) -> f64 {
        self.enough(accuracy).max(self.swept(accuracy))
    }

    /// The residual that sweeps of a crowd may leave.
    fn swept(&self, accuracy: Accuracy) -> f64 {
        let may_sweep =
            accuracy.in_crowd() && !self.is_long() && (self.is_crowd() || !self.is_calm(accuracy));
        if may_sweep { (SWEPT * accuracy.slow).min(OF_SPEED * self.mean_speed()) } else { 0.0 }
    }

    /// Do the bodies come to rest, all of those that contacts connect, and are they few enough for an exact solution?
    fn is_calm(&self, accuracy: Accuracy) -> bool {
        let is_small = self.moved() <= SOME || !accuracy.beside_sleepers && self.blocks.len() <= SETTLING;
        accuracy.company != Company::Heap && is_small && self.mean_speed() <= CALM * accuracy.slow
    }

    /// Are bodies jammed with a contact that slides so slowly that it might as well stick? A body that follows its motion may also take along, and
    /// at higher speeds, what it does not press on yet. In crowds sweeps come first.
    fn could_stick(&self, accuracy: Accuracy) -> bool {
        let is_driven = |body: &SolverBody| body.inverse_mass == 0.0 && body.velocity != Velocity::default();
        let drives = !accuracy.in_crowd() && self.moved() <= FEW && self.bodies.iter().any(is_driven);
        let is_whole = accuracy.company != Company::Heap;
        let slow = if accuracy.in_crowd() { CALM * accuracy.slow } else { accuracy.slow };
        let is_slow = is_whole && self.moved() <= SOME && self.mean_speed() <= slow;
        let is_couple = self.moved() <= COUPLE && !accuracy.in_crowd();
        if !(drives || is_slow || is_couple) {
            return false;
        }
        let (tolerance, most) = (self.tolerance(accuracy), if drives { TAKEN } else { 1.0 } * accuracy.slow);
        let presses = |impulse: &[f64; 3]| drives || impulse[0] > 0.0;
        // With the impulses of the last step, and without any: both count, since the new ones may be others.
        let free = self.free();
        let creeps = |(block, impulse): (&Block, &[f64; 3])| {
            let is_slow = |[_, t, u]: [f64; 3]| {
                let slides = (t * t + u * u).sqrt();
                slides > tolerance && slides <= most
            };
            let slides =
                || is_slow(block.rates(|i| self.bodies[i].velocity)) || is_slow(block.rates(|i| free[i]));
            presses(impulse) && block.law.friction() > 0.0 && slides()
        };
        let creep = || self.blocks.iter().zip(&self.impulses).any(creeps);
        creep() && self.is_jammed(presses)
    }

    /// Is a body pressed on from opposite sides? Only such a body can be held by more than its load.
    fn is_jammed(&self, presses: impl Fn(&[f64; 3]) -> bool) -> bool {
        let mut pressed = vec![Vec::new(); self.bodies.len()];
        for (block, _) in self.blocks.iter().zip(&self.impulses).filter(|(_, impulse)| presses(impulse)) {
            let normal = block.directions[0];
            for (body, normal) in [(block.a, -normal), (block.b, normal)] {
                if self.is_moved(body) && !pressed[body].contains(&normal) {
                    pressed[body].push(normal);
                }
            }
        }
        let opposite = |n: &[DVec3]| n.iter().any(|x| n.iter().any(|y| x.dot(*y) < OPPOSITE));
        pressed.iter().any(|normals| opposite(normals))
    }

    /// The residual that these bodies may have at their speeds.
    #[must_use]
    pub fn tolerance(&self, accuracy: Accuracy) -> f64 {
        // The mean by mass counts, too: heavy bodies at rest have no error because a light one between them moves fast. Joints are solved far below
        // that anyway.
        let speed = self.mean_speed();
        let speed = if self.has_joints {
            speed
        } else {
            speed.min(self.mean_speed_by(|body| 1.0 / body.inverse_mass))
        };
        (accuracy.relative * speed).min(LOOSE * accuracy.precision).max(accuracy.precision)
    }

    /// The quadratic mean of the speeds of the movable bodies, each where it touches.
    #[must_use]
    pub fn mean_speed(&self) -> f64 {
        self.mean_speed_by(|_| 1.0)
    }

    fn mean_speed_by(&self, weight: impl Fn(&SolverBody) -> f64) -> f64 {
        let bodies = self.bodies.iter().zip(&self.reach).filter(|(body, _)| body.inverse_mass > 0.0);
        let part = |(body, reach): (&SolverBody, &f64)| {
            [weight(body) * body.velocity.surface_speed(*reach).powi(2), weight(body)]
        };
        let [square, sum] = bodies.map(part).fold([0.0; 2], |[x, y], [s, w]| [x + s, y + w]);
        if sum > 0.0 { (square / sum).sqrt() } else { 0.0 }
    }

    /// Applies a method, and takes it back if its residual is larger than before and exceeds the tolerance.
    fn better(&mut self, residual: f64, tolerance: f64, go_on: impl FnOnce(&mut Self) -> f64) -> f64 {
        let begun = self.present();
        let other = go_on(self);
        if other <= residual.max(tolerance) {
            return other;
        }
        self.take_back(begun);
        residual
    }

    /// More bodies than can be solved exactly whatever they do?
    #[must_use]
    pub fn is_crowd(&self) -> bool {
        self.moved() > FEW && !self.is_long()
    }

    /// Many bodies in a row, like the links of a chain? What is left at each contact adds up along it, and direct solutions cost little: their factors
    /// have nothing that the matrix has not.
    pub(super) fn is_long(&self) -> bool {
        self.is_row && self.moved() > FEW
    }

    fn moved(&self) -> usize {
        self.bodies.iter().filter(|body| body.inverse_mass > 0.0).count()
    }

    /// The greatest mass that impulses move, over the least one.
    pub(super) fn mass_ratio(&self) -> f64 {
        let inverses = self.bodies.iter().map(|body| body.inverse_mass).filter(|x| *x > 0.0);
        let (least, most) =
            inverses.fold((f64::INFINITY, 0.0f64), |(least, most), x| (least.min(x), most.max(x)));
        if most > 0.0 { most / least } else { 1.0 }
    }

    /// The same of masses, and of moments of inertia where rows hold turns.
    pub(super) fn ratio(&self) -> f64 {
        let holds_turns = self.blocks.iter().any(|block| block.directions[0] == DVec3::ZERO);
        let moved = self.bodies.iter().filter(|body| holds_turns && body.inverse_mass > 0.0);
        let inverses = moved.map(|body| extreme_eigenvalues(body.inverse_inertia));
        let extremes = |[least, most]: [f64; 2], [x, y]: [f64; 2]| [least.min(x), most.max(y)];
        let [least, most] = inverses.fold([f64::INFINITY, 0.0], extremes);
        if least > 0.0 && most > 0.0 { (most / least).max(self.mass_ratio()) } else { self.mass_ratio() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ContactPoint;
    use crate::point::{Material, upright};
    use crate::sweeps::tests::column;
    use glam::DMat3;

    const EXACT: Accuracy = Accuracy {
        precision: 1e-6,
        relative: 0.0,
        aim: 1e-3,
        company: Company::Few,
        slow: 1.0,
        still: None,
        beside_sleepers: false,
    };

    /// Of a tall column sweeps leave something: a direct solution follows where that is more than twice what may be left.
    #[test]
    fn crowds_are_solved_directly_where_sweeps_fail() {
        let (count, speed) = (200, 10.0);
        // All move across without friction, so that what may be left is a part of the slow speed.
        let crossing = || {
            let mut crowd = column(count, speed);
            crowd.bodies.iter_mut().for_each(|body| body.velocity.linear.x = 1e4);
            crowd
        };
        let accuracy = |slow: f64| {
            let (precision, relative) = (1e-9, 1.0 / 1024.0);
            Accuracy { precision, relative, aim: 1.0, company: Company::Crowd, slow, ..EXACT }
        };
        let targets = vec![0.0; count];
        let left = crossing().sweep_until(&targets, accuracy(0.0), Pace::Conjugate, FIRST);
        let solved = |part: f64| crossing().solve(&targets, accuracy(part * left / SWEPT), Start::Present);
        assert!(left > 1e-3 && solved(0.6) == left && solved(0.4) < 0.5 * left, "{left}");
    }

    /// What sweeps leave at each link of a chain adds up along it: of a long row that is solved directly, also where it would do for a crowd.
    #[test]
    fn long_rows_are_solved_directly() {
        let count = 200;
        let left = |is_row: bool| {
            let mut column = System { is_row, ..column(count, 10.0) };
            column.bodies.iter_mut().for_each(|body| body.velocity.linear.x = 1e4);
            let (precision, relative, slow) = (1e-9, 1.0 / 1024.0, 1e4);
            let accuracy = Accuracy { precision, relative, aim: 1.0, company: Company::Crowd, slow, ..EXACT };
            column.solve(&vec![0.0; count], accuracy, Start::Present)
        };
        let (row, crowd) = (left(true), left(false));
        assert!(crowd > 1e-3 && row < 0.1 * crowd, "{row} {crowd}");
    }

    /// A heavy body that stands is held to the precision however fast light ones are: what is left of it leans on them.
    #[test]
    fn light_bodies_that_move_leave_heavy_ones_no_more() {
        let body = |mass: f64, speed: f64| SolverBody {
            inverse_mass: 1.0 / mass,
            inverse_inertia: DMat3::IDENTITY / mass,
            velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::ZERO },
        };
        let accuracy = Accuracy { relative: 1.0 / 1024.0, ..EXACT };
        let tolerance = |mass: f64, speed: f64| {
            let bodies = vec![body(mass, speed), body(1.0, 1.0)];
            System::new(bodies, &[upright([0, 1])], |i| i).tolerance(accuracy)
        };
        assert!(tolerance(1e8, 0.0) == 1e-6 && tolerance(1e8, 1.0) > 9e-4 && tolerance(1.0, 0.0) > 6e-4);
    }

    /// No solution is sought beyond what rounding leaves of it.
    #[test]
    fn aims_are_no_less_than_rounding() {
        let mut system = column(2, 0.0);
        assert_eq!(system.aim(EXACT), 1e-9);
        system.impulses[0][0] = 1e8;
        assert!(system.aim(EXACT) > 1e8 * f64::EPSILON);
    }

    /// Many bodies of which one is a hundred times as heavy as the others are solved no further than flights need as they move, and only then.
    #[test]
    fn uneven_crowds_are_solved_as_far_as_flights_need() {
        let is_uneven = |(count, ratio, speed): (usize, f64, f64), company: Company| {
            let mut crowd = column(count, speed);
            crowd.bodies[0].inverse_mass /= ratio;
            crowd.bodies.iter_mut().for_each(|body| body.velocity.linear.x = speed);
            crowd.is_uneven_crowd(Accuracy { company, ..EXACT })
        };
        assert!(
            is_uneven((100, 100.0, 10.0), Company::Crowd) && is_uneven((100, 100.0, 10.0), Company::Heap)
        );
        assert!(
            !is_uneven((100, 100.0, 10.0), Company::Few) && !is_uneven((10, 100.0, 10.0), Company::Crowd)
        );
        assert!(
            !is_uneven((100, 10.0, 10.0), Company::Crowd) && !is_uneven((100, 100.0, 0.1), Company::Crowd)
        );
    }

    /// What lies between two bodies of which one follows a motion may be taken along, by a few bodies; of a crowd sweeps come first.
    #[test]
    fn crowds_are_swept_before_anything_sticks() {
        let body = |inverse_mass: f64, speed: f64| SolverBody {
            inverse_mass,
            inverse_inertia: DMat3::IDENTITY * inverse_mass,
            velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::ZERO },
        };
        let bodies = vec![body(0.0, 2.0), body(1.0, 4.0), body(0.0, 0.0)];
        let rough = |pair| ContactPoint { material: Material::new(0.0, 0.5), ..upright(pair) };
        let system = System::new(bodies, &[rough([0, 1]), rough([1, 2])], |i| i);
        let among =
            |company: Company| system.could_stick(Accuracy { precision: 1e-7, aim: 1.0, company, ..EXACT });
        assert!(among(Company::Few) && !among(Company::Crowd) && !among(Company::Heap));
    }

    /// Bodies that press on each other and move slowly may stick; of many others only where they are about to rest.
    #[test]
    fn islands_of_crowds_stick_where_they_are_about_to_rest() {
        let body = |inverse_mass: f64, speed: f64| SolverBody {
            inverse_mass,
            inverse_inertia: DMat3::IDENTITY * inverse_mass,
            velocity: Velocity { linear: DVec3::X * speed, angular: DVec3::ZERO },
        };
        let rough = |pair| ContactPoint { material: Material::new(0.0, 0.5), ..upright(pair) };
        // So many that they are no couple, between two that stand still.
        let bodies: Vec<SolverBody> =
            [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0].map(|mass| body(mass, mass)).to_vec();
        let contacts: Vec<ContactPoint> = (0..6).map(|i| rough([i, i + 1])).collect();
        let mut system = System::new(bodies, &contacts, |i| i);
        system.impulses.fill([1e-9, 0.0, 0.0]);
        let among = |company: Company, slow: f64| {
            system.could_stick(Accuracy { precision: 1e-7, aim: 1.0, company, slow, ..EXACT })
        };
        assert!(among(Company::Few, 2.0) && !among(Company::Few, 0.5));
        assert!(among(Company::Crowd, 8.0) && !among(Company::Crowd, 2.0) && !among(Company::Heap, 8.0));
    }
}
