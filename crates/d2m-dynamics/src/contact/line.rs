//! Rates of two bodies along one direction, and what impulses along it do.

use super::solver_body::SolverBody;
use crate::velocity::Velocity;
use glam::DVec3;

/// How the velocities of two bodies change along one direction by an impulse of one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) direction: DVec3,
    pub(super) cross_a: DVec3,
    pub(super) cross_b: DVec3,
    pub(super) turn_a: DVec3,
    pub(super) turn_b: DVec3,
    /// Inverse of the change of the rate by a unit impulse.
    pub(super) mass: f64,
}

impl Line {
    /// Along a direction at points that are at these arms from the centers.
    pub(super) fn new(direction: DVec3, arms: [DVec3; 2], a: &SolverBody, b: &SolverBody) -> Self {
        Self::with_crosses(direction, arms.map(|arm| arm.cross(direction)), a, b)
    }

    /// Of a rate d·(v_b − v_a) + c_b·ω_b − c_a·ω_a.
    pub(super) fn with_crosses(
        direction: DVec3,
        [cross_a, cross_b]: [DVec3; 2],
        a: &SolverBody,
        b: &SolverBody,
    ) -> Self {
        let mut line =
            Self { direction, cross_a, cross_b, turn_a: DVec3::ZERO, turn_b: DVec3::ZERO, mass: 0.0 };
        line.renew(a, b);
        line
    }

    /// The bodies have other inertias.
    pub(super) fn renew(&mut self, a: &SolverBody, b: &SolverBody) {
        (self.turn_a, self.turn_b) = (a.inverse_inertia * self.cross_a, b.inverse_inertia * self.cross_b);
        let change = self.change(self, a, b);
        self.mass = if change > 0.0 { 1.0 / change } else { 0.0 };
    }

    /// How this rate changes by an impulse of one along another line of the same bodies.
    pub(super) fn change(&self, other: &Self, a: &SolverBody, b: &SolverBody) -> f64 {
        (a.inverse_mass + b.inverse_mass) * self.direction.dot(other.direction)
            + self.cross_a.dot(other.turn_a)
            + self.cross_b.dot(other.turn_b)
    }

    #[inline]
    pub(super) fn rate(&self, a: &Velocity, b: &Velocity) -> f64 {
        self.direction.dot(b.linear - a.linear) + self.cross_b.dot(b.angular) - self.cross_a.dot(a.angular)
    }

    /// Adds an impulse along the line to the velocities.
    #[inline]
    pub(super) fn push(&self, bodies: &mut [SolverBody], [a, b]: [usize; 2], impulse: f64) {
        let body = &mut bodies[a];
        body.velocity.linear -= self.direction * (body.inverse_mass * impulse);
        body.velocity.angular -= self.turn_a * impulse;
        let body = &mut bodies[b];
        body.velocity.linear += self.direction * (body.inverse_mass * impulse);
        body.velocity.angular += self.turn_b * impulse;
    }
}
