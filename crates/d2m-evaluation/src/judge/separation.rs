//! Distance of two meshes over plain trees of axis-aligned boxes.
use super::placement::Placement;
use super::triangle::{self, Corners};
use glam::{DMat3, DVec3};

/// Triangles of a leaf, at most.
const LEAF: usize = 1;
/// Boxes are padded by this much of the mesh's size, far above the rounding of a box test.
const PAD: f64 = 1e-13;

/// A mesh with a median-split tree of boxes.
pub(crate) struct BoxTree {
    corners: Vec<Corners>,
    nodes: Vec<Node>,
    /// Farthest vertex from the origin.
    pub(crate) radius: f64,
}

struct Node {
    center: DVec3,
    half: DVec3,
    /// First triangle and count of a leaf; left child (the right one follows it) and 0 of an inner node.
    first: u32,
    count: u32,
}

impl BoxTree {
    pub(crate) fn build(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let corners: Vec<Corners> = triangles.iter().map(|t| t.map(|i| vertices[i as usize])).collect();
        let radius = corners.iter().flatten().map(|p| p.length()).fold(0.0, f64::max);
        let mut tree = Self { corners, nodes: Vec::new(), radius };
        tree.nodes.push(Node { center: DVec3::ZERO, half: DVec3::ZERO, first: 0, count: 0 });
        let count = tree.corners.len();
        tree.split(0, 0, count);
        tree
    }

    fn split(&mut self, node: usize, begin: usize, end: usize) {
        let part = &mut self.corners[begin..end];
        let lo = part.iter().flatten().fold(DVec3::INFINITY, |m, &p| m.min(p));
        let hi = part.iter().flatten().fold(DVec3::NEG_INFINITY, |m, &p| m.max(p));
        let mut first = begin;
        let mut count = end - begin;
        if count > LEAF {
            let size = hi - lo;
            let axis = (0..3).max_by(|&i, &j| size[i].total_cmp(&size[j])).unwrap_or(0);
            let key = |c: &Corners| c[0][axis] + c[1][axis] + c[2][axis];
            part.select_nth_unstable_by(count / 2, |s, t| key(s).total_cmp(&key(t)));
            let middle = begin + count / 2;
            first = self.nodes.len();
            count = 0;
            for _ in 0..2 {
                self.nodes.push(Node { center: DVec3::ZERO, half: DVec3::ZERO, first: 0, count: 0 });
            }
            self.split(first, begin, middle);
            self.split(first + 1, middle, end);
        }
        let half = (hi - lo) * 0.5 + DVec3::splat(PAD * self.radius);
        self.nodes[node] = Node { center: (lo + hi) * 0.5, half, first: first as u32, count: count as u32 };
    }
}

struct Search<'a> {
    a: &'a BoxTree,
    b: &'a BoxTree,
    /// B seen from A, and the matrices that its box tests need.
    place: Placement,
    back: DMat3,
    absolute: DMat3,
    absolute_back: DMat3,
    best: f64,
    /// What may be this part of the best closer is not visited.
    slack: f64,
    closest: (u32, u32),
    effort: u64,
}

impl<'a> Search<'a> {
    fn new(a: &'a BoxTree, b: &'a BoxTree, at_a: &Placement, at_b: &Placement, best: f64) -> Self {
        let place = at_a.relative(at_b);
        let m = place.matrix;
        let absolute = DMat3::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
        let (back, absolute_back) = (m.transpose(), absolute.transpose());
        Self { a, b, place, back, absolute, absolute_back, best, slack: 1.0, closest: (0, 0), effort: 0 }
    }
}

/// What one search leaves to the next at a time nearby.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hint {
    /// The closest pair of triangles, where the search begins.
    closest: (u32, u32),
    /// Pairs of boxes visited so far.
    pub(crate) effort: u64,
}

/// Distances below which the surfaces are searched one after the other, in units of the larger radius.
const CAPS: [f64; 3] = [1e-9, 1e-6, 1e-3];

/// The distance of the surfaces: 0 when they cross, exact to rounding otherwise. The hint only saves time.
///
/// A search that begins with a small cap visits few pairs. One that begins with none may wander through all pairs of
/// millions of triangles that are merely near before it comes upon the nearest.
pub(crate) fn separation(
    a: &BoxTree,
    b: &BoxTree,
    at_a: &Placement,
    at_b: &Placement,
    hint: &mut Hint,
) -> f64 {
    let mut search = Search::new(a, b, at_a, at_b, f64::INFINITY);
    let size = a.radius.max(b.radius);
    for cap in CAPS.map(|cap| cap * size).into_iter().chain([f64::INFINITY]) {
        search.best = cap;
        search.run(hint);
        if search.best < cap {
            break;
        }
    }
    search.best
}

/// A lower bound of the distance, at least half of it, in a fraction of the time; 0 when the surfaces cross.
pub(crate) fn bound_separation(
    a: &BoxTree,
    b: &BoxTree,
    at_a: &Placement,
    at_b: &Placement,
    hint: &mut Hint,
) -> f64 {
    let mut search = Search::new(a, b, at_a, at_b, f64::INFINITY);
    search.slack = 0.5;
    search.run(hint);
    search.best * search.slack
}

/// Do the surfaces cross? Much cheaper than the distance: boxes that are apart need no test.
pub(crate) fn cross(a: &BoxTree, b: &BoxTree, at_a: &Placement, at_b: &Placement) -> bool {
    let mut search = Search::new(a, b, at_a, at_b, f64::MIN_POSITIVE);
    search.visit(0, 0, search.gap(0, 0));
    search.best == 0.0
}

impl Search<'_> {
    fn run(&mut self, hint: &mut Hint) {
        let (i, j) = hint.closest;
        self.triangles(i, j);
        self.visit(0, 0, self.gap(0, 0));
        *hint = Hint { closest: self.closest, effort: hint.effort + std::mem::take(&mut self.effort) };
    }

    /// A lower bound of the distance of two boxes: the largest gap along the six face normals.
    fn gap(&self, i: u32, j: u32) -> f64 {
        let (a, b) = (&self.a.nodes[i as usize], &self.b.nodes[j as usize]);
        let between = self.place.apply(b.center) - a.center;
        let on_a = (between.abs() - a.half - self.absolute * b.half).max_element();
        if on_a >= self.best {
            return on_a;
        }
        let on_b = ((self.back * between).abs() - b.half - self.absolute_back * a.half).max_element();
        on_a.max(on_b)
    }

    fn visit(&mut self, i: u32, j: u32, gap: f64) {
        self.effort += 1;
        if gap >= self.best * self.slack || self.best <= 0.0 {
            return;
        }
        let (a, b) = (&self.a.nodes[i as usize], &self.b.nodes[j as usize]);
        if a.count > 0 && b.count > 0 {
            self.leaves(i, j);
            return;
        }
        let open_a = b.count > 0 || (a.count == 0 && a.half.length_squared() >= b.half.length_squared());
        let pairs = if open_a { [(a.first, j), (a.first + 1, j)] } else { [(i, b.first), (i, b.first + 1)] };
        let gaps = pairs.map(|(i, j)| self.gap(i, j));
        let near = usize::from(gaps[1] < gaps[0]);
        for k in [near, 1 - near] {
            self.visit(pairs[k].0, pairs[k].1, gaps[k]);
        }
    }

    fn leaves(&mut self, i: u32, j: u32) {
        let range = |node: &Node| node.first..node.first + node.count;
        for j in range(&self.b.nodes[j as usize]) {
            for i in range(&self.a.nodes[i as usize]) {
                self.triangles(i, j);
            }
        }
    }

    fn triangles(&mut self, i: u32, j: u32) {
        let moved = self.b.corners[j as usize].map(|p| self.place.apply(p));
        let here = &self.a.corners[i as usize];
        if triangle::are_apart(here, &moved, self.best) {
            return;
        }
        let distance = triangle::distance(here, &moved);
        if distance < self.best {
            self.best = distance;
            self.closest = (i, j);
        }
    }
}
