//! A block: one contact (three rows) or one row of a joint, with the rates of its two bodies and the effect of impulses on them.

use super::ContactPoint;
use super::law::Law;
use super::solver_body::SolverBody;
use crate::velocity::Velocity;
use glam::DVec3;

/// Least part of the product of its diagonal that the determinant of the two tangents has: 2⁻²⁶. The difference of two products
/// as large as that is rounded by 2⁻⁵² of them, so half of its digits are left.
const LEAST_DETERMINANT: f64 = 1.0 / 67_108_864.0;

/// One contact (three rows), or one row. `a` and `b` are places in the list of bodies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) a: usize,
    pub(super) b: usize,
    /// The normal and the tangents; one row has only the first, which is zero if it only turns.
    pub(super) directions: [DVec3; 3],
    /// From the centers of a and b to the point of the contact; of one row, what turns them by it.
    pub(super) arms: [DVec3; 2],
    pub(super) law: Law,
    /// The largest diagonal entry of the block's matrix: an impulse of one along a row changes the row's rate by this at most. It turns
    /// impulses into rates.
    pub(super) scale: f64,
    /// The inverse of the first diagonal entry.
    pub(super) mass: f64,
    /// How the rates along the tangents change by an impulse of one along the normal.
    pub(super) coupling: [f64; 2],
    /// The inverse of the tangents' part of the matrix, symmetric: from rates to the impulses that stop them. None: it is singular.
    pub(super) stopping: Option<[f64; 3]>,
    /// One over the larger eigenvalue of the tangents' part. Sliding contacts take this one step in both directions, so that friction points
    /// against the velocity.
    pub(super) step: f64,
    /// What surfaces that run add to the rates along the tangents.
    pub(super) running: [f64; 2],
}

impl Block {
    pub(super) fn new(contact: &ContactPoint, [a, b]: [usize; 2], bodies: &[SolverBody]) -> Self {
        let (arms, n) = ([contact.arm_a, contact.arm_b], contact.normal);
        let friction = contact.material.friction;
        let across = arms.map(|arm| arm.cross(n));
        let (law, normal, arms) = match contact.row {
            Some(row) if row.is_angular => (row.law, DVec3::ZERO, [n; 2]),
            Some(row) => (row.law, n, across),
            None if friction == 0.0 => (Law::PUSH, n, across),
            None => (Law::Cone { friction }, n, arms),
        };
        let [t, u] = contact.tangents;
        let mut block = Self {
            a,
            b,
            directions: [normal, t, u],
            arms,
            law,
            scale: 0.0,
            mass: 0.0,
            coupling: [0.0; 2],
            stopping: None,
            step: 0.0,
            running: [0.0; 2],
        };
        block.run(contact.running);
        block.renew(bodies);
        block
    }

    /// Surfaces add this to the rates along the tangents, if these count.
    pub(super) fn run(&mut self, running: [f64; 2]) {
        self.running = if self.law.rows() == 3 { running } else { [0.0; 2] };
    }

    /// The bodies have other inertias.
    pub(super) fn renew(&mut self, bodies: &[SolverBody]) {
        let own = self.change([0, 0], bodies);
        (self.scale, self.mass) = (own, if own > 0.0 { 1.0 / own } else { 0.0 });
        if self.law.rows() == 3 {
            let [tt, tu, uu] = [[1, 1], [1, 2], [2, 2]].map(|rows| self.change(rows, bodies));
            let largest = 0.5 * (tt + uu) + (0.25 * (tt - uu) * (tt - uu) + tu * tu).sqrt();
            let determinant = tt * uu - tu * tu;
            self.scale = own.max(tt).max(uu);
            self.coupling = [[1, 0], [2, 0]].map(|rows| self.change(rows, bodies));
            self.stopping = (determinant > LEAST_DETERMINANT * tt * uu)
                .then(|| [uu / determinant, -tu / determinant, tt / determinant]);
            self.step = if largest > 0.0 { 1.0 / largest } else { 0.0 };
        }
    }

    /// How the rate of one row changes by an impulse of one along another.
    fn change(&self, [of, by]: [usize; 2], bodies: &[SolverBody]) -> f64 {
        let (a, b) = (&bodies[self.a], &bodies[self.b]);
        let ([of_a, of_b], [by_a, by_b]) = (self.turns(of), self.turns(by));
        (a.inverse_mass + b.inverse_mass) * self.directions[of].dot(self.directions[by])
            + of_a.dot(a.inverse_inertia * by_a)
            + of_b.dot(b.inverse_inertia * by_b)
    }

    /// What an impulse of one along a row adds to the angular momentum of b, and takes from that of a.
    #[inline]
    pub(super) fn turns(&self, row: usize) -> [DVec3; 2] {
        match self.law {
            Law::Cone { .. } => self.arms.map(|arm| arm.cross(self.directions[row])),
            Law::Range { .. } => self.arms,
        }
    }

    /// The same of impulses along all rows, and what they add to the momentum of b.
    #[inline]
    pub(super) fn pushes(&self, impulse: [f64; 3]) -> (DVec3, [DVec3; 2]) {
        let [n, t, u] = self.directions;
        match self.law {
            Law::Cone { .. } => {
                let push = n * impulse[0] + t * impulse[1] + u * impulse[2];
                (push, self.arms.map(|arm| arm.cross(push)))
            }
            Law::Range { .. } => (n * impulse[0], self.arms.map(|turn| turn * impulse[0])),
        }
    }

    /// Those of the surfaces against each other.
    #[inline]
    pub(super) fn rates(&self, velocity: impl Fn(usize) -> Velocity) -> [f64; 3] {
        let [along, first, second] = self.changes(velocity);
        [along, first + self.running[0], second + self.running[1]]
    }

    /// How the rates change with the velocities of the bodies.
    #[inline]
    pub(super) fn changes(&self, velocity: impl Fn(usize) -> Velocity) -> [f64; 3] {
        let (a, b) = (velocity(self.a), velocity(self.b));
        let [arm_a, arm_b] = self.arms;
        match self.law {
            Law::Cone { .. } => {
                let parts = b.of_point(arm_b) - a.of_point(arm_a);
                self.directions.map(|direction| direction.dot(parts))
            }
            Law::Range { .. } => {
                let turns = arm_b.dot(b.angular) - arm_a.dot(a.angular);
                [self.directions[0].dot(b.linear - a.linear) + turns, 0.0, 0.0]
            }
        }
    }

    #[inline]
    pub(super) fn push(&self, bodies: &mut [SolverBody], impulse: [f64; 3]) {
        let (push, [turn_a, turn_b]) = self.pushes(impulse);
        let body = &mut bodies[self.a];
        body.velocity.linear -= push * body.inverse_mass;
        body.velocity.angular -= body.inverse_inertia * turn_a;
        let body = &mut bodies[self.b];
        body.velocity.linear += push * body.inverse_mass;
        body.velocity.angular += body.inverse_inertia * turn_b;
    }

    /// How far an impulse is from what the law asks for at these rates, as a rate: see [`System::residual`](super::System::residual).
    #[inline]
    pub(super) fn natural_map(&self, mut rates: [f64; 3], impulse: [f64; 3], target: f64, shift: f64) -> f64 {
        rates[0] += shift - target + self.law.softness() * impulse[0];
        let nearest = self.law.project([0, 1, 2].map(|i| impulse[i] - rates[i] / self.scale));
        let off: f64 = (0..3).map(|i| (impulse[i] - nearest[i]) * (impulse[i] - nearest[i])).sum();
        off.sqrt() * self.scale
    }
}
