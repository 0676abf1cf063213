//! How far a body reaches along a direction, by its boxes.
//!
//! A point of a box is y from the box's center, |y| ≤ r, and z = A y has |zᵢ| ≤ hᵢ, A the box's axes as rows. With d a direction
//! d·y = (A Aᵀ)⁻¹A d·z, and |A Aᵀ − 1| ≤ δ = 3·5.2·2⁻²⁴ as a norm, since each entry is within a third of that. So
//!
//! d·y ≤ Σ |aᵢ·d| hᵢ + δ (1 + δ)/(1 − δ) |d| r,
//!
//! and the last term is less than 2⁻²⁰ |d| r. A box that reaches no further by that than a vertex that is known is left out, so what is found
//! is at least the value at every vertex in real arithmetic, but for the roundings of the values at those that are computed.

use crate::MeshTree;
use d2m_lanes::{Lanes, Task, UP, run};
use d2m_mesh::margin::length;
use d2m_mesh::node::{Below, WIDTH, WideNode};
use glam::DVec3;

/// Covers what axes of boxes are off from orthonormal ones, 2⁻²⁰ of a radius, and the roundings of a few doubles beside it.
const TILTED: f64 = 1.0 / 524_288.0; // 2⁻¹⁹
/// Covers fewer than 32 roundings of the value at a box's center, in parts of the terms that are added.
const ROUNDINGS: f64 = 32.0 * f64::EPSILON;

/// A linear function of points of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Linear {
    /// Its value at `at`.
    pub(super) value: f64,
    pub(super) gradient: DVec3,
    pub(super) at: DVec3,
}

impl Linear {
    /// The value at a point.
    fn of(&self, point: DVec3) -> f64 {
        self.value + self.gradient.dot(point - self.at)
    }

    pub(super) fn opposite(self) -> Self {
        Self { value: -self.value, gradient: -self.gradient, ..self }
    }
}

/// When a search ends that looks for what is only about the furthest.
#[derive(Clone, Copy)]
pub(super) struct Patience {
    pub(super) slack: f64,
    pub(super) enough: f64,
}

/// The searches of one body for what reaches the furthest.
pub(super) struct Furthest<'t> {
    tree: &'t MeshTree,
    /// A triangle that reached the furthest in the last search: those of one body hardly differ.
    last: u32,
    /// Nodes whose boxes were examined.
    pub(super) nodes: u64,
    /// Boxes that wait, and a bound on what each reaches: the last one furthest among those below one node.
    waiting: Vec<(f64, u32)>,
}

impl<'t> Furthest<'t> {
    pub(super) fn new(tree: &'t MeshTree) -> Self {
        Self { tree, last: 0, nodes: 0, waiting: Vec::new() }
    }

    /// One that begins with this triangle.
    pub(super) fn beginning_with(tree: &'t MeshTree, triangle: u32) -> Self {
        Self { last: triangle, ..Self::new(tree) }
    }

    /// The value at the triangle that the next search begins with.
    pub(super) fn first(&self, along: &Linear) -> f64 {
        self.most_of(self.last, along)
    }

    /// The greatest value over the triangles' corners.
    pub(super) fn most(&mut self, along: &Linear) -> f64 {
        self.about_most(along, Patience { slack: 0.0, enough: f64::INFINITY })
    }

    /// A value at a corner, and at least the greatest one less the slack, or enough.
    pub(super) fn about_most(&mut self, along: &Linear, patience: Patience) -> f64 {
        run(AboutMost { search: self, along, patience })
    }

    fn most_of(&self, triangle: u32, along: &Linear) -> f64 {
        let [p, q, r] = self.tree.mesh().corners(triangle as usize);
        along.of(p).max(along.of(q)).max(along.of(r))
    }
}

/// One search, compiled for each instruction set: the loop over the boxes of a node becomes vectors of doubles.
struct AboutMost<'s, 't> {
    search: &'s mut Furthest<'t>,
    along: &'s Linear,
    patience: Patience,
}

impl Task for AboutMost<'_, '_> {
    type Output = f64;

    #[inline(always)]
    fn run<L: Lanes>(self) -> f64 {
        let Self { search, along, patience: Patience { slack, enough } } = self;
        let mut most = search.first(along);
        let bounds = Bounds::new(search.tree, along);
        search.waiting.clear();
        search.waiting.push((f64::INFINITY, 0));
        while let Some((bound, node)) = search.waiting.pop() {
            if bound <= most + slack || most > enough {
                continue;
            }
            search.nodes += 1;
            let first = search.waiting.len();
            let wide = &search.tree.nodes()[node as usize];
            let bounds = bounds.of_all(wide);
            for (lane, &bound) in bounds.iter().enumerate().take(wide.used as usize) {
                // What is not a number is no bound.
                if bound <= most + slack {
                    continue;
                }
                match wide.below(lane) {
                    Below::Node(node) => search.waiting.push((bound, node)),
                    Below::Triangle(triangle) => {
                        let reached = search.most_of(triangle, along);
                        if reached > most {
                            (most, search.last) = (reached, triangle);
                        }
                    }
                }
            }
            search.waiting[first..].sort_unstable_by(|x, y| x.0.total_cmp(&y.0));
        }
        most
    }
}

/// Bounds of a linear function over boxes of a tree.
struct Bounds {
    gradient: DVec3,
    unit: f64,
    /// Its value at the tree's center.
    middle: f64,
    /// Its length, not too small.
    long: f64,
    /// What covers the roundings of `middle`.
    error: f64,
}

impl Bounds {
    fn new(tree: &MeshTree, &Linear { value, gradient, at }: &Linear) -> Self {
        let (from, long) = (tree.center() - at, length(gradient) * UP);
        Self {
            gradient,
            unit: tree.unit(),
            middle: value + gradient.dot(from),
            long,
            error: ROUNDINGS * (value.abs() + long * length(from) * UP),
        }
    }

    /// The bounds of all boxes of a node; of no meaning for lanes that are not used.
    #[inline(always)]
    fn of_all(&self, wide: &WideNode) -> [f64; WIDTH] {
        let mut bounds = [0.0; WIDTH];
        for (lane, bound) in bounds.iter_mut().enumerate() {
            *bound = self.of(wide, lane);
        }
        bounds
    }

    /// No point of the box has a greater value.
    #[inline(always)]
    fn of(&self, wide: &WideNode, lane: usize) -> f64 {
        let Self { gradient, unit, middle, long, error } = *self;
        let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
        let (origin, center) = (vector(wide.origin), vector([0, 1, 2].map(|k| wide.center[k][lane])));
        let radius = f64::from(wide.radius[lane]);
        let [x, y, z] = wide.axes_of(lane).map(|axis| gradient.dot(vector(axis)).abs());
        let [h, k, l] = [0, 1, 2].map(|axis| f64::from(wide.half_extent[axis][lane]));
        let reach = (x * h + y * k + z * l).min(long * radius) + TILTED * long * radius;
        let local = origin.abs().element_sum() + center.abs().element_sum();
        middle + (gradient.dot(origin + center) + reach + ROUNDINGS * long * local) * unit + error
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriMesh;
    use d2m_testing::{Draw, KnuthRandom, Surface};

    /// What going through all vertices finds, bit for bit, for far fewer nodes than the tree has.
    #[test]
    fn boxes_find_the_furthest_vertex() {
        let mut random = KnuthRandom(71);
        let ring = Surface::wavy_torus(64, 24, 0.3);
        let mut soup = Vec::new();
        for _ in 0..300 {
            let (middle, size) = (random.vector(), 10f64.powf(2.0 * random.signed() - 2.0));
            soup.extend([0; 3].map(|_| middle + random.vector() * size));
        }
        let meshes = [ring.clone(), ring.map(|p| p * 1e-3 + DVec3::splat(7.0)), Surface::soup(soup)];
        let (mut nodes, mut most_nodes) = (0, 0);
        for surface in meshes {
            let tree = MeshTree::new(surface.into_mesh(TriMesh::try_new));
            for round in 0..200 {
                let gradient = if round % 10 == 0 {
                    DVec3::AXES[round / 10 % 3]
                } else {
                    random.vector() * 10f64.powi(round as i32 % 7 - 3)
                };
                let along = Linear { value: random.signed(), gradient, at: tree.center() + random.vector() };
                let mut search = Furthest::new(&tree);
                for along in [along, along.opposite(), along] {
                    let all = tree.mesh().triangles().iter().flatten();
                    let wanted = all
                        .map(|&k| along.of(tree.mesh().vertices()[k as usize]))
                        .fold(f64::NEG_INFINITY, f64::max);
                    let found = search.most(&along);
                    assert!(found == wanted, "{round}: {found} instead of {wanted}");
                }
                nodes += search.nodes;
                most_nodes += 3 * tree.nodes().len() as u64;
            }
        }
        assert!(8 * nodes < most_nodes, "{nodes} of {most_nodes}");
    }

    /// The bound of each box, and of each box above it, against its points; and it is no more than a few parts in a million beyond the
    /// box's own planes.
    #[test]
    fn no_vertex_is_beyond_the_bound_of_a_box() {
        let mut random = KnuthRandom(72);
        let mut closest = f64::INFINITY;
        for round in 0..200 {
            let size = 10f64.powi(round % 5 - 2);
            let far = random.vector() * size * 10f64.powi(round % 3 * 2);
            let corners = (0..3 * 8).map(|_| random.vector() * size + far);
            let tree = MeshTree::new(Surface::soup(corners).into_mesh(TriMesh::try_new));
            let search = Furthest::new(&tree);
            for wide in tree.nodes() {
                for lane in 0..wide.used as usize {
                    let Below::Triangle(triangle) = wide.below(lane) else { continue };
                    let n = random.vector();
                    // Along the box's own axes the bound is attained.
                    let axes = wide.axes_of(lane).map(|axis| DVec3::from_array(axis.map(f64::from)));
                    for gradient in [n, axes[0], -axes[1], axes[2]] {
                        let along = Linear { value: random.signed(), gradient, at: tree.center() };
                        let (bound, reached) =
                            (Bounds::new(&tree, &along).of(wide, lane), search.most_of(triangle, &along));
                        assert!(reached <= bound, "{round}: {reached} beyond {bound}");
                        closest = closest.min((bound - reached) / (tree.unit() * gradient.length()));
                    }
                }
            }
        }
        assert!(closest < 4.0 * TILTED, "{closest:e}");
    }
}
