//! Four pairs of bodies.

use super::super::solver_body::SolverBody;
use crate::velocity::Velocity;
use core::ops::Range;
use d2m_lanes::{Doubles, Quad, QuadVec};
use glam::DVec3;

/// How impulses move the bodies of four pairs, and which blocks are between them.
#[derive(Clone, Debug)]
pub(super) struct Batch {
    /// The first and the second bodies, by their places in the system; none in empty lanes.
    pairs: [Option<[usize; 2]>; 4],
    /// The same in the list of velocities, where empty lanes have the one behind the others.
    bodies: [[u32; 4]; 2],
    inverse_masses: [Quad; 2],
    /// By columns.
    inverse_inertias: [[Quad; 9]; 2],
    /// The blocks side by side, one of each pair, that sweeps relax one after the other.
    pub(super) rows: Range<usize>,
}

/// The velocities of the bodies of a batch.
#[derive(Clone, Copy)]
pub(super) struct Ends<D> {
    pub(super) linear: [QuadVec<D>; 2],
    pub(super) angular: [QuadVec<D>; 2],
}

/// What impulses add to the momenta of the second bodies, and take from those of the first ones: one linear momentum, and the angular
/// ones of the first and the second bodies.
#[derive(Clone, Copy)]
pub(super) struct Pushes<D> {
    pub(super) linear: QuadVec<D>,
    pub(super) angular: [QuadVec<D>; 2],
}

impl Batch {
    pub(super) fn new(pairs: [Option<[usize; 2]>; 4], rows: Range<usize>) -> Self {
        let none = Quad::default();
        Self { pairs, bodies: [[0; 4]; 2], inverse_masses: [none; 2], inverse_inertias: [[none; 9]; 2], rows }
    }

    /// How impulses move the bodies now.
    pub(super) fn fill(&mut self, bodies: &[SolverBody]) {
        self.bodies = [[bodies.len() as u32; 4]; 2];
        for (lane, pair) in self.pairs.iter().enumerate() {
            for (side, &number) in pair.iter().flatten().enumerate() {
                let body = &bodies[number];
                self.bodies[side][lane] = number as u32;
                self.inverse_masses[side].0[lane] = body.inverse_mass;
                let entries = body.inverse_inertia.to_cols_array();
                for (quad, value) in self.inverse_inertias[side].iter_mut().zip(entries) {
                    quad.0[lane] = value;
                }
            }
        }
    }

    #[inline(always)]
    pub(super) fn load<D: Doubles>(&self, velocities: &[Velocity]) -> Ends<D> {
        let (a, b) = (of_lanes::<D>(velocities, &self.bodies[0]), of_lanes::<D>(velocities, &self.bodies[1]));
        Ends { linear: [a[0], b[0]], angular: [a[1], b[1]] }
    }

    #[inline(always)]
    pub(super) fn store<D: Doubles>(&self, ends: &Ends<D>, velocities: &mut [Velocity]) {
        for side in 0..2 {
            let (linear, angular) = (stored(&ends.linear[side]), stored(&ends.angular[side]));
            for lane in 0..4 {
                velocities[self.bodies[side][lane] as usize] =
                    Velocity { linear: vector(&linear, lane), angular: vector(&angular, lane) };
            }
        }
    }

    #[inline(always)]
    pub(super) fn push<D: Doubles>(&self, ends: &mut Ends<D>, pushes: &Pushes<D>) {
        let [a, b] = &self.inverse_masses;
        ends.linear[0] = ends.linear[0] - pushes.linear * D::load(a);
        ends.linear[1] = ends.linear[1] + pushes.linear * D::load(b);
        let [a, b] = &self.inverse_inertias;
        ends.angular[0] = ends.angular[0] - turned::<D>(a, &pushes.angular[0]);
        ends.angular[1] = ends.angular[1] + turned::<D>(b, &pushes.angular[1]);
    }
}

/// Linear and angular velocities.
#[inline(always)]
fn of_lanes<D: Doubles>(velocities: &[Velocity], bodies: &[u32; 4]) -> [QuadVec<D>; 2] {
    let (first, second) = (velocities[bodies[0] as usize], velocities[bodies[1] as usize]);
    let (third, fourth) = (velocities[bodies[2] as usize], velocities[bodies[3] as usize]);
    [
        QuadVec::new([first.linear, second.linear, third.linear, fourth.linear]),
        QuadVec::new([first.angular, second.angular, third.angular, fourth.angular]),
    ]
}

#[inline(always)]
fn stored<D: Doubles>(v: &QuadVec<D>) -> [Quad; 3] {
    [v.0[0].store(), v.0[1].store(), v.0[2].store()]
}

#[inline(always)]
fn vector(coordinates: &[Quad; 3], lane: usize) -> DVec3 {
    DVec3::new(coordinates[0].0[lane], coordinates[1].0[lane], coordinates[2].0[lane])
}

/// The products with matrices.
#[inline(always)]
fn turned<D: Doubles>(columns: &[Quad; 9], v: &QuadVec<D>) -> QuadVec<D> {
    let [x, y, z] = v.0;
    let [a, b, c, d, e, f, g, h, i] = columns;
    QuadVec([
        D::load(a) * x + D::load(d) * y + D::load(g) * z,
        D::load(b) * x + D::load(e) * y + D::load(h) * z,
        D::load(c) * x + D::load(f) * y + D::load(i) * z,
    ])
}
