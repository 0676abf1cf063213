//! What the tests of this crate, inside and outside, draw by lot: numbers that repeat, and a body that is nowhere convex.
#![allow(dead_code, reason = "each test uses a part")]

use glam::{DQuat, DVec3};

/// A linear congruential generator, Knuth's multiplier.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Uniform in [−1, 1).
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
    }

    /// Each coordinate in [−1, 1).
    pub(crate) fn vec(&mut self) -> DVec3 {
        DVec3::new(self.next(), self.next(), self.next())
    }

    /// A rotation, not normalised.
    pub(crate) fn turn(&mut self) -> DQuat {
        DQuat::from_xyzw(self.next(), self.next(), self.next(), self.next() + 1.5)
    }
}

/// Corners and triangles of a torus about z of radius 1 whose rings of radius `tube` are wavy: nowhere convex, nowhere
/// symmetric.
pub(crate) fn wavy_torus(rings: u32, sides: u32, tube: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let point = |k: u32| {
        let (i, j) = (f64::from(k / sides) / f64::from(rings), f64::from(k % sides) / f64::from(sides));
        let (u, v) = (i * core::f64::consts::TAU, j * core::f64::consts::TAU);
        let r = tube * (1.0 + 0.2 * (3.0 * u).sin());
        DVec3::new((1.0 + r * v.cos()) * u.cos(), (1.0 + r * v.cos()) * u.sin(), r * v.sin())
    };
    let at = |i: u32, j: u32| (i % rings) * sides + j % sides;
    let quads = (0..rings * sides).map(|k| (k / sides, k % sides));
    let triangles = quads.flat_map(|(i, j)| {
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    });
    ((0..rings * sides).map(point).collect(), triangles.collect())
}
