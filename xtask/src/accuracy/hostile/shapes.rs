//! Small closed meshes of the hostile families.
use d2m_testing::Xoshiro256 as Random;
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;

/// Vertices and triangles, oriented outwards.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    pub(super) vertices: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Shape {
    /// A box with these half extents about a center.
    pub(super) fn cuboid(half: DVec3, center: DVec3) -> Self {
        let corner = |i: u32| {
            center
                + half * (DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0)
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        Self { vertices: (0..8).map(corner).collect(), triangles }
    }

    /// A polygon in the plane of x and z, counter-clockwise seen against y, drawn out over `y` in [−1, 1]·half. The
    /// polygon must be visible from its first corner.
    pub(super) fn extruded(profile: &[(f64, f64)], half: f64) -> Self {
        let n = profile.len() as u32;
        let at = |y: f64| profile.iter().map(move |(x, z)| DVec3::new(*x, y, *z));
        let vertices = at(-half).chain(at(half)).collect();
        let mut triangles = Vec::new();
        for i in 1..n - 1 {
            triangles.extend([[0, i, i + 1], [n, n + i + 1, n + i]]);
        }
        for i in 0..n {
            let j = (i + 1) % n;
            triangles.extend([[i, n + j, j], [i, n + i, n + j]]);
        }
        Self { vertices, triangles }
    }

    /// A plate whose upper side rises by `step` where x becomes positive.
    pub(super) fn stepped_plate(step: f64) -> Self {
        // From the corner at the foot of the step every other one is visible.
        let profile = [(0.0, 0.0), (-2.0, 0.0), (-2.0, -1.0), (2.0, -1.0), (2.0, step), (0.0, step)];
        let mut shape = Self::extruded(&profile, 1.0);
        shape.orient();
        shape
    }

    /// A cone with its apex at the origin that opens downwards.
    pub(super) fn cone(sides: u32, radius: f64, height: f64) -> Self {
        let mut vertices = vec![DVec3::ZERO, DVec3::Z * -height];
        for k in 0..sides {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(sides)).sin_cos();
            vertices.push(DVec3::new(radius * cos, radius * sin, -height));
        }
        let mut triangles = Vec::new();
        for k in 0..sides {
            let (i, j) = (2 + k, 2 + (k + 1) % sides);
            triangles.extend([[0, i, j], [1, j, i]]);
        }
        Self { vertices, triangles }
    }

    /// A square crowd of separate spikes of about this height on a base of 2 × 2, tips at z = height, slightly uneven.
    pub(super) fn spikes(random: &mut Random, side: u32, height: f64) -> Self {
        let mut crowd = Self::default();
        let pitch = 2.0 / f64::from(side);
        let uneven = if random.unit() < 0.5 { 0.0 } else { 10f64.powf(random.range(-6.0, -1.0)) };
        for k in 0..side * side {
            let place = DVec3::new(f64::from(k % side) + 0.5, f64::from(k / side) + 0.5, 0.0) * pitch;
            let tall = height * (1.0 - uneven * random.unit());
            let mut spike = Self::cone(3, 0.4 * pitch, tall);
            spike = spike.moved(place + DVec3::new(-1.0, -1.0, tall));
            crowd = crowd.with(&spike);
        }
        crowd
    }

    /// A closed tetrahedron of random corners.
    pub(super) fn tetrahedron(random: &mut Random, size: f64) -> Self {
        let vertices = (0..4).map(|_| random.direction() * (size * random.range(0.3, 1.0))).collect();
        let mut shape = Self { vertices, triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] };
        shape.orient();
        shape
    }

    /// A needle or blade: a tetrahedron stretched by `aspect`.
    pub(super) fn sliver(random: &mut Random, aspect: f64) -> Self {
        let mut shape = Self::tetrahedron(random, 1.0);
        let thin = if random.unit() < 0.5 {
            DVec3::new(1.0, 1.0 / aspect, 1.0 / aspect)
        } else {
            DVec3::new(1.0, 1.0, 1.0 / aspect)
        };
        for p in &mut shape.vertices {
            *p *= thin;
        }
        shape
    }

    /// Another shape beside this one, in one mesh.
    pub(super) fn with(mut self, other: &Self) -> Self {
        let first = self.vertices.len() as u32;
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + first)));
        self
    }

    /// Every triangle cut in four, so many times: the same surface with more to search.
    pub(super) fn refined(mut self, times: u32) -> Self {
        for _ in 0..times {
            let mut middles = BTreeMap::new();
            let mut triangles = Vec::with_capacity(4 * self.triangles.len());
            for t in &self.triangles {
                let mut middle = |i: u32, j: u32| {
                    *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                        self.vertices.push(self.vertices[i as usize].midpoint(self.vertices[j as usize]));
                        self.vertices.len() as u32 - 1
                    })
                };
                let [p, q, r] = [middle(t[0], t[1]), middle(t[1], t[2]), middle(t[2], t[0])];
                triangles.extend([[t[0], p, r], [p, t[1], q], [r, q, t[2]], [p, q, r]]);
            }
            self.triangles = triangles;
        }
        self
    }

    /// Turned in the mesh's own coordinates, up to rounding.
    pub(super) fn turned(mut self, turn: DQuat) -> Self {
        for p in &mut self.vertices {
            *p = turn * *p;
        }
        self
    }

    pub(super) fn inverted(mut self) -> Self {
        for t in &mut self.triangles {
            t.swap(1, 2);
        }
        self
    }

    pub(super) fn moved(mut self, by: DVec3) -> Self {
        for p in &mut self.vertices {
            *p += by;
        }
        self
    }

    /// Turned outwards if the volume is negative.
    fn orient(&mut self) {
        let volume: f64 = self
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|i| self.vertices[i as usize]);
                a.dot(b.cross(c))
            })
            .sum();
        if volume < 0.0 {
            for t in &mut self.triangles {
                t.swap(1, 2);
            }
        }
    }
}
