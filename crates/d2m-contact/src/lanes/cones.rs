//! Contacts with friction: Coulomb's cone in each lane.

use super::super::block::Block;
use super::batch::{Ends, Pushes};
use super::group::{Asked, Side};
use d2m_lanes::{Doubles, Quad, QuadVec};
use glam::DVec3;

/// As [`Block`], lane by lane.
#[derive(Clone, Debug, Default)]
pub(super) struct Cones {
    directions: [[Quad; 3]; 3],
    arms: [[Quad; 3]; 2],
    friction: Quad,
    mass: Quad,
    coupling: [Quad; 2],
    stopping: [Quad; 3],
    /// One where impulses along both tangents stop what slides, zero where a direction cannot be moved.
    stops: Quad,
    step: Quad,
    running: [Quad; 2],
}

impl Side for Cones {
    fn put(&mut self, lane: usize, block: &Block) {
        for (direction, vector) in self.directions.iter_mut().zip(block.directions) {
            put(direction, lane, vector);
        }
        for (arm, vector) in self.arms.iter_mut().zip(block.arms) {
            put(arm, lane, vector);
        }
        let stopping = block.stopping.unwrap_or_default();
        let numbers = [
            (&mut self.friction, block.law.friction()),
            (&mut self.mass, block.mass),
            (&mut self.step, block.step),
            (&mut self.stops, if block.stopping.is_some() { 1.0 } else { 0.0 }),
        ];
        for (quad, value) in numbers {
            quad.0[lane] = value;
        }
        for k in 0..2 {
            (self.coupling[k].0[lane], self.running[k].0[lane]) = (block.coupling[k], block.running[k]);
        }
        for (quad, value) in self.stopping.iter_mut().zip(stopping) {
            quad.0[lane] = value;
        }
    }

    #[inline(always)]
    fn rates<D: Doubles>(&self, ends: &Ends<D>) -> [D; 3] {
        let (arm_a, arm_b) = (vectors::<D>(&self.arms[0]), vectors::<D>(&self.arms[1]));
        let of_a = ends.linear[0] + ends.angular[0].crossed(&arm_a);
        let of_b = ends.linear[1] + ends.angular[1].crossed(&arm_b);
        let parts = of_b - of_a;
        [
            vectors::<D>(&self.directions[0]).dots(&parts),
            vectors::<D>(&self.directions[1]).dots(&parts) + D::load(&self.running[0]),
            vectors::<D>(&self.directions[2]).dots(&parts) + D::load(&self.running[1]),
        ]
    }

    /// Along the normal what the target asks for; along the tangents what stops sliding, or that of Coulomb's length nearest to it.
    #[inline(always)]
    fn relaxed<D: Doubles>(&self, asked: &Asked, rates: &[D; 3], own: &[D; 3]) -> [D; 3] {
        let zero = D::splat(0.0);
        let along = (own[0] - (rates[0] - D::load(&asked.target)) * D::load(&self.mass)).max(zero);
        let added = along - own[0];
        let t = rates[1] + D::load(&self.coupling[0]) * added;
        let u = rates[2] + D::load(&self.coupling[1]) * added;
        let limit = D::load(&self.friction) * along;
        let [tt, tu, uu] =
            [D::load(&self.stopping[0]), D::load(&self.stopping[1]), D::load(&self.stopping[2])];
        let stopped = [own[1] - (tt * t + tu * u), own[2] - (tu * t + uu * u)];
        let length = stopped[0] * stopped[0] + stopped[1] * stopped[1];
        // One where they hold.
        let holds = D::if_greater(length, limit * limit, zero, D::load(&self.stops));
        let step = D::load(&self.step);
        let wanted = [own[1] - t * step, own[2] - u * step];
        let shorten = (limit / (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt()).min(D::splat(1.0));
        let slides = [wanted[0] * shorten, wanted[1] * shorten];
        [
            along,
            D::if_greater(holds, zero, stopped[0], slides[0]),
            D::if_greater(holds, zero, stopped[1], slides[1]),
        ]
    }

    #[inline(always)]
    fn projected<D: Doubles>(&self, impulses: &[D; 3]) -> [D; 3] {
        let (zero, friction) = (D::splat(0.0), D::load(&self.friction));
        let [n, t, u] = *impulses;
        let length = (t * t + u * u).sqrt();
        let along = (n + friction * length) / (D::splat(1.0) + friction * friction);
        let across = friction * along / length;
        // The nearest one on the cone, or none.
        let (steep, against) = (friction * length, zero - n);
        let nearest = [
            D::if_greater(steep, against, along, zero),
            D::if_greater(steep, against, t * across, zero),
            D::if_greater(steep, against, u * across, zero),
        ];
        // Unless they are within it already.
        let within = friction * n;
        [
            D::if_greater(length, within, nearest[0], n),
            D::if_greater(length, within, nearest[1], t),
            D::if_greater(length, within, nearest[2], u),
        ]
    }

    #[inline(always)]
    fn natural_map<D: Doubles>(&self, asked: &Asked, rates: &[D; 3], own: &[D; 3]) -> D {
        let scale = D::load(&asked.scale);
        let shift = D::load(&self.friction) * (rates[1] * rates[1] + rates[2] * rates[2]).sqrt();
        let above = rates[0] + (shift - D::load(&asked.target));
        let aimed = [own[0] - above / scale, own[1] - rates[1] / scale, own[2] - rates[2] / scale];
        let nearest = self.projected(&aimed);
        let (n, t, u) = (own[0] - nearest[0], own[1] - nearest[1], own[2] - nearest[2]);
        (n * n + t * t + u * u).sqrt() * scale
    }

    #[inline(always)]
    fn pushes<D: Doubles>(&self, impulses: &[D; 3]) -> Pushes<D> {
        let linear = vectors::<D>(&self.directions[0]) * impulses[0]
            + vectors::<D>(&self.directions[1]) * impulses[1]
            + vectors::<D>(&self.directions[2]) * impulses[2];
        let (arm_a, arm_b) = (vectors::<D>(&self.arms[0]), vectors::<D>(&self.arms[1]));
        Pushes { linear, angular: [arm_a.crossed(&linear), arm_b.crossed(&linear)] }
    }
}

pub(super) fn put(coordinates: &mut [Quad; 3], lane: usize, vector: DVec3) {
    for (quad, value) in coordinates.iter_mut().zip(vector.to_array()) {
        quad.0[lane] = value;
    }
}

#[inline(always)]
pub(super) fn vectors<D: Doubles>(coordinates: &[Quad; 3]) -> QuadVec<D> {
    QuadVec([D::load(&coordinates[0]), D::load(&coordinates[1]), D::load(&coordinates[2])])
}
