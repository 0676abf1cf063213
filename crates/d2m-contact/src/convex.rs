//! The convex function of one round of the direct solution ([`super::newton`]), and its minimum by Newton's method with an exact line search.

use super::block::Block;
use super::law::{Projected, Slope};
use super::system::System;
use crate::velocity::Velocity;
use d2m_cholesky::{Factor, Square};
use glam::{DMat3, DVec3};

/// The slope along a line, of that at its start, with which a search ends.
const FLAT: f64 = 0.02;

/// The function of one round, where Newton's method is with it, and λ there.
pub(super) struct Convex<'s> {
    pub(super) system: &'s System,
    pub(super) targets: &'s [f64],
    pub(super) free: &'s [Velocity],
    pub(super) inertia: &'s [DMat3],
    /// Places among the bodies that move; none: the body does not.
    pub(super) places: &'s [Option<usize>],
    pub(super) soft: f64,
    pub(super) center: Vec<[f64; 3]>,
    pub(super) shift: Vec<f64>,
    pub(super) velocity: Vec<Velocity>,
    pub(super) found: Vec<Projected>,
}

impl Convex<'_> {
    /// Newton's method; λ of the last velocities is in `found`. True: they are those of the minimum.
    pub(super) fn minimize(&mut self, factor: &mut Factor, tolerance: f64, most_steps: u32) -> bool {
        let size = 6 * self.places.iter().flatten().count();
        let mut least = f64::INFINITY;
        let mut stalls = 0;
        for step in 0.. {
            let slope = self.gradient(size);
            let off = self.off(&slope);
            if off <= tolerance || step == most_steps {
                return off <= tolerance;
            }
            // Rounding: what is left gets no less.
            stalls = if off > 0.5 * least { stalls + 1 } else { 0 };
            least = least.min(off);
            if stalls > 4 && off < 1e-6 * self.fastest() {
                return true;
            }
            self.assemble(factor);
            let mut way: Vec<f64> = slope.iter().map(|x| -x).collect();
            if !factor.solve(&mut way) || way.iter().any(|x| !x.is_finite()) {
                break;
            }
            self.go(&way, &slope);
        }
        false
    }

    fn argument(&self, k: usize, rates: [f64; 3]) -> [f64; 3] {
        let block = &self.system.blocks[k];
        let (center, soft) = self.center_of(k, block);
        let above = [rates[0] - self.targets[k] + self.shift[k], rates[1], rates[2]];
        [0, 1, 2].map(|i| center[i] - above[i] / soft)
    }

    /// The multiplier λ₀ and the softness of a block; a row that is soft by its own law has its own softness, about zero.
    fn center_of(&self, k: usize, block: &Block) -> ([f64; 3], f64) {
        let softness = block.law.softness();
        if softness > 0.0 { ([0.0; 3], softness) } else { (self.center[k], self.soft * block.scale) }
    }

    fn counts(&self, k: usize) -> bool {
        self.system.blocks[k].scale > 0.0 && self.targets[k] > f64::NEG_INFINITY
    }

    /// The gradient, by body and row, and λ with its slope of each block.
    fn gradient(&mut self, size: usize) -> Vec<f64> {
        let mut gradient = vec![0.0; size];
        let bodies = &self.system.bodies;
        for (i, place) in self.places.iter().enumerate() {
            let Some(place) = place else { continue };
            let (body, off) = (&bodies[i], self.velocity[i] - self.free[i]);
            let linear = off.linear / body.inverse_mass;
            let angular = self.inertia[i] * off.angular;
            gradient[6 * place..6 * place + 6].copy_from_slice(&rows(linear, angular));
        }
        for k in 0..self.system.blocks.len() {
            if !self.counts(k) {
                self.found[k] = Projected { impulse: [0.0; 3], slope: None };
                continue;
            }
            let block = &self.system.blocks[k];
            let y = self.argument(k, block.rates(|i| self.velocity[i]));
            let found = block.law.project_with_slope(y);
            self.found[k] = found;
            if found.impulse == [0.0; 3] {
                continue;
            }
            let (push, [turn_a, turn_b]) = block.pushes(found.impulse);
            for (body, added) in [(block.a, rows(push, turn_a)), (block.b, rows(-push, -turn_b))] {
                if let Some(place) = self.places[body] {
                    for (own, added) in gradient[6 * place..6 * place + 6].iter_mut().zip(added) {
                        *own += added;
                    }
                }
            }
        }
        gradient
    }

    /// How far the velocities are from those that follow from the impulses.
    fn off(&self, gradient: &[f64]) -> f64 {
        let bodies = &self.system.bodies;
        let of = |(i, place): (usize, &Option<usize>)| {
            let place = 6 * (*place)?;
            let linear = DVec3::from_slice(&gradient[place..place + 3]) * bodies[i].inverse_mass;
            let angular = bodies[i].inverse_inertia * DVec3::from_slice(&gradient[place + 3..place + 6]);
            Some(linear.length() + angular.length() * self.system.reach[i])
        };
        self.places.iter().enumerate().filter_map(of).fold(0.0, f64::max)
    }

    fn fastest(&self) -> f64 {
        let speed = |(v, reach): (&Velocity, &f64)| v.surface_speed(*reach);
        self.velocity.iter().zip(&self.system.reach).map(speed).fold(0.0, f64::max)
    }

    /// The Hessian.
    fn assemble(&self, factor: &mut Factor) {
        factor.clear();
        let bodies = &self.system.bodies;
        for (i, place) in self.places.iter().enumerate() {
            let Some(place) = *place else { continue };
            let mut square = [[0.0; 6]; 6];
            let inertia = self.inertia[i];
            for k in 0..3 {
                square[k][k] = 1.0 / bodies[i].inverse_mass;
                for l in 0..3 {
                    square[3 + k][3 + l] = inertia.col(l)[k];
                }
            }
            factor.add(place, &square);
        }
        let of_pair = |x: &Block, y: &Block| (x.a, x.b) == (y.a, y.b);
        let mut first = 0;
        for blocks in self.system.blocks.chunk_by(of_pair) {
            let squares = self.squares(first, blocks);
            first += blocks.len();
            let Some([aa, bb, ab]) = squares else { continue };
            let (a, b) = (self.places[blocks[0].a], self.places[blocks[0].b]);
            if let Some(a) = a {
                factor.add(a, &aa);
            }
            if let Some(b) = b {
                factor.add(b, &bb);
            }
            if let (Some(a), Some(b)) = (a, b) {
                factor.add_between(a, b, &ab);
            }
        }
    }

    /// What the blocks of one pair add: for the first body, for the second, and with the rows of the first and the columns of the second.
    fn squares(&self, first: usize, blocks: &[Block]) -> Option<[Square; 3]> {
        let mut squares: Option<[Square; 3]> = None;
        for (k, block) in (first..).zip(blocks) {
            let Some(slope) = self.found[k].slope.filter(|_| self.counts(k)) else { continue };
            let [aa, bb, ab] = squares.get_or_insert([[[0.0; 6]; 6]; 3]);
            let (_, soft) = self.center_of(k, block);
            let count = block.law.rows();
            let weight = square_of(slope);
            let (mut ga, mut gb) = ([[0.0; 6]; 3], [[0.0; 6]; 3]);
            for (row, direction) in block.directions[..count].iter().enumerate() {
                let [turn_a, turn_b] = block.turns(row);
                (ga[row], gb[row]) = (rows(*direction, turn_a), rows(*direction, turn_b));
            }
            for l in 0..count {
                let (mut wa, mut wb) = ([0.0; 6], [0.0; 6]);
                for m in 0..count {
                    let w = weight[l][m] / soft;
                    for i in 0..6 {
                        wa[i] += w * ga[m][i];
                        wb[i] += w * gb[m][i];
                    }
                }
                for i in 0..6 {
                    for j in 0..6 {
                        aa[i][j] += ga[l][i] * wa[j];
                        bb[i][j] += gb[l][i] * wb[j];
                        ab[i][j] -= ga[l][i] * wb[j];
                    }
                }
            }
        }
        squares
    }

    /// Goes along the way as far as the function falls.
    fn go(&mut self, way: &[f64], gradient: &[f64]) {
        let moved = |place: &Option<usize>| {
            place.map_or_else(System::zero, |p| Velocity {
                linear: DVec3::from_slice(&way[6 * p..6 * p + 3]),
                angular: DVec3::from_slice(&way[6 * p + 3..6 * p + 6]),
            })
        };
        let ways: Vec<Velocity> = self.places.iter().map(moved).collect();
        // The quadratic part falls by s b + s² a /2.
        let (mut a, mut b) = (0.0, 0.0);
        for (i, way) in ways.iter().enumerate().filter(|(i, _)| self.places[*i].is_some()) {
            let body = &self.system.bodies[i];
            let off = self.velocity[i] - self.free[i];
            let inertia = self.inertia[i];
            a += way.linear.length_squared() / body.inverse_mass + way.angular.dot(inertia * way.angular);
            b += way.linear.dot(off.linear) / body.inverse_mass + way.angular.dot(inertia * off.angular);
        }
        // Of each block its law, y, what is added to that, and to the rates.
        let line = |k: usize| {
            let block = &self.system.blocks[k];
            let (y, added) =
                (self.argument(k, block.rates(|i| self.velocity[i])), block.changes(|i| ways[i]));
            let (_, soft) = self.center_of(k, block);
            (&block.law, y, added.map(|x| -x / soft), added)
        };
        let counted = (0..self.system.blocks.len()).filter(|&k| self.counts(k));
        let lines: Vec<_> = counted.map(line).collect();
        let slope = |s: f64| {
            let mut slope = b + s * a;
            for (law, y, moved, added) in &lines {
                let impulse = law.project([0, 1, 2].map(|i| y[i] + s * moved[i]));
                slope -= (0..3).map(|i| impulse[i] * added[i]).sum::<f64>();
            }
            slope
        };
        let start: f64 = gradient.iter().zip(way).map(|(g, w)| g * w).sum();
        let s = root(slope, start);
        for (velocity, way) in self.velocity.iter_mut().zip(&ways) {
            *velocity = *velocity + *way * s;
        }
    }
}

/// Where an increasing function, `start` (< 0) at zero, is about zero.
fn root(slope: impl Fn(f64) -> f64, start: f64) -> f64 {
    let most = FLAT * start.abs();
    let (mut low, mut high) = ((0.0, start), (1.0, slope(1.0)));
    for _ in 0..8 {
        if high.1 >= -most {
            break;
        }
        low = high;
        high = (2.0 * high.0, slope(2.0 * high.0));
    }
    if high.1 <= most {
        return high.0;
    }
    // Regula falsi, in which a value that stays counts half (Illinois).
    let mut side = 0;
    for _ in 0..24 {
        let s = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        let value = slope(s);
        if value.abs() <= most {
            return s;
        }
        if value > 0.0 {
            high = (s, value);
            low.1 *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            low = (s, value);
            high.1 *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    low.0
}

fn rows(linear: DVec3, angular: DVec3) -> [f64; 6] {
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}

fn square_of([nn, nt, nu, tt, tu, uu]: Slope) -> [[f64; 3]; 3] {
    [[nn, nt, nu], [nt, tt, tu], [nu, tu, uu]]
}
