//! Until when are two bodies apart that turn and slide along a common axis, as a screw in its nut does?
//!
//! Seen from B, a point of A with distance ρ from the axis, angle θ and height z moves by θ + wτ and z + vτ. So ρ and
//! φ = z − hθ, h = v/w, never change: in the plane of (ρ, φ) both bodies are at rest. Where their pictures there are
//! apart, they never meet; heights tell the rest apart for a time. φ is told up to multiples of the lead 2πh.
//!
//! See docs/theory/engine.md, "Screws".

use super::base_pose::{relative_position, rotation_at};
use super::scene::Scene;
use super::swept::{SWEEP_ERROR, nearest};
use super::window::corners;
use d2m_interval::Interval;
use glam::DVec3;

/// Directions (α, β) of F = αρ + βφ; any would do, in steps of about an eighth of half a turn.
const DIRECTIONS: [(f64, f64); 8] = [
    (1.0, 0.0),
    (0.92, 0.39),
    (0.71, 0.71),
    (0.39, 0.92),
    (0.0, 1.0),
    (-0.39, 0.92),
    (-0.71, 0.71),
    (-0.92, 0.39),
];
/// How much less differences of heights count than those of ρ and φ in the shape of cells.
const HEIGHT_WEIGHT: f64 = 0.1;
/// Times that a triangle may be divided by four.
const MOST_DIVISIONS: u32 = 5;
/// Larger pairs of meshes are not pictured: a picture takes about 500 bytes a triangle.
const MOST_TRIANGLES: usize = 1 << 18;
/// Most leads that two pictures may be shifted by.
const MOST_LEADS: f64 = 64.0;

/// Bounds of what a part of a body covers.
#[derive(Clone, Copy, Debug)]
struct Picture {
    /// Range of each F.
    slabs: [(f64, f64); 8],
    height: (f64, f64),
    /// Least distance from the axis.
    near: f64,
}

impl Picture {
    fn with(&self, other: &Self) -> Self {
        let both = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
        Self {
            slabs: std::array::from_fn(|j| both(self.slabs[j], other.slabs[j])),
            height: both(self.height, other.height),
            near: self.near.min(other.near),
        }
    }

    fn extents(&self) -> [f64; 3] {
        // Cells whose angles are not known differ by the rest only.
        let length = |(low, high): (f64, f64)| if high < f64::INFINITY { high - low } else { 0.0 };
        [length(self.slabs[0]), length(self.slabs[4]), HEIGHT_WEIGHT * length(self.height)]
    }

    fn middle(&self, dimension: usize) -> f64 {
        let (low, high) = [self.slabs[0], self.slabs[4], self.height][dimension];
        low + high
    }

    /// Is the angle of some point not known?
    fn is_wide(&self) -> bool {
        self.slabs[4].1 == f64::INFINITY
    }
}

/// The common axis, and how A moves along it as seen from B.
struct Screw {
    axis: DVec3,
    /// Directions of the angles 0 and π/2.
    across: [DVec3; 2],
    /// φ = z − hθ.
    h: f64,
    lead: f64,
    /// Speed of A's points along the axis.
    climb: f64,
    /// Distance of the two axes at the start, and how fast it grows.
    offset: f64,
    drift: f64,
}

impl Screw {
    /// None unless one body is at rest or both turn about parallel axes, and not alike.
    fn new(scene: &Scene<'_>, start: f64) -> Option<Self> {
        let [wa, wb] = [&scene.a, &scene.b].map(|body| body.1.angular_velocity());
        let axis = scene.spin_axis()?;
        let both = wa != DVec3::ZERO && wb != DVec3::ZERO;
        if both && wa.normalize().cross(wb.normalize()).length() > 1e-14 {
            return None;
        }
        let rate = axis.dot(wa - wb);
        let velocity = scene.a.1.linear_velocity() - scene.b.1.linear_velocity();
        let climb = axis.dot(velocity);
        let flat = |p: DVec3| (p - axis * axis.dot(p)).length();
        let offset = if both { flat(relative_position(&scene.a.1, &scene.b.1, start)) } else { 0.0 };
        let first = axis.any_orthonormal_vector();
        let h = climb / rate;
        let lead = 2.0 * std::f64::consts::PI * h.abs();
        (h.is_finite() && rate.abs() > 1e-9 * (wa.length() + wb.length())).then_some(Self {
            axis,
            across: [first, axis.cross(first)],
            h,
            lead,
            climb,
            offset: offset * (1.0 + 1e-12),
            drift: flat(velocity) * (1.0 + 1e-12),
        })
    }

    /// Bound on |∇φ| at distances of at least `rho`.
    fn steepness(&self, rho: f64) -> f64 {
        (1.0 + (self.h / rho) * (self.h / rho)).sqrt()
    }

    /// Of a triangle, corners from the axis, at their heights, or of a part of one; `anchor`: the whole one's first
    /// corner, whose φ is taken from the first lead.
    fn picture(&self, corners: &[DVec3; 3], anchor: DVec3) -> Picture {
        let heights = corners.map(|p| self.axis.dot(p));
        let flat: [DVec3; 3] = std::array::from_fn(|i| corners[i] - self.axis * heights[i]);
        let near = nearest(&flat, self.axis);
        let rho = flat.map(DVec3::length);
        let range = |v: [f64; 3]| (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let (height, far) = (range(heights), range(rho).1);
        let mut picture = Picture { slabs: [(f64::NEG_INFINITY, f64::INFINITY); 8], height, near };
        picture.slabs[0] = (near, far);
        let turns = self.h != 0.0;
        // Near the axis the angle means nothing.
        if turns && near < 1e-2 * (far + self.h.abs()) {
            return picture;
        }
        let phi: [f64; 3] = if turns {
            let angle = |y: f64, x: f64| Interval::point(y).atan2(Interval::point(x)).mid();
            let [u, w] = self.across;
            let height = self.axis.dot(anchor);
            let from = anchor - self.axis * height;
            let first = angle(w.dot(from), u.dot(from));
            let leads = ((height - self.h * first) / self.lead).floor() * self.lead;
            // A triangle beside the axis turns by less than half a turn.
            std::array::from_fn(|i| {
                let turned = first + angle(self.axis.dot(from.cross(flat[i])), from.dot(flat[i]));
                heights[i] - self.h * turned - leads
            })
        } else {
            heights
        };
        // What ρ and θ may differ from their linear interpolation: half of the bound on the second derivative, 1/ρ and
        // 1/ρ², times the square of a radius that holds the corners. ρ is convex: never above.
        let radius = [0, 1, 2]
            .map(|i| {
                let middle = (corners[i] + corners[(i + 1) % 3]) * 0.5;
                corners.iter().map(|p| (*p - middle).length_squared()).fold(0.0, f64::max)
            })
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let bend_rho = if near > 0.0 { 0.5 * radius / near } else { far };
        let bend_phi = if turns { 0.5 * self.h.abs() * radius / (near * near) } else { 0.0 };
        for (slab, (alpha, beta)) in picture.slabs.iter_mut().zip(DIRECTIONS).skip(1) {
            let (low, high) = range(std::array::from_fn(|i| alpha * rho[i] + beta * phi[i]));
            let (below, above) = if alpha > 0.0 { (alpha * bend_rho, 0.0) } else { (0.0, -alpha * bend_rho) };
            let either = beta * bend_phi;
            *slab = (low - (below + either) * (1.0 + 1e-12), high + (above + either) * (1.0 + 1e-12));
        }
        picture
    }
}

/// A tree of pictures: the children of node i that is not a leaf are `first` and `first + 1`.
struct Pictures {
    nodes: Vec<(Picture, Below)>,
    triangles: Vec<[DVec3; 3]>,
}

#[derive(Clone, Copy)]
enum Below {
    Nodes(u32),
    Triangle(u32),
}

impl Pictures {
    fn new(mut parts: Vec<(Picture, u32)>, triangles: &[[DVec3; 3]]) -> Self {
        let mut tree = Self { nodes: Vec::with_capacity(2 * parts.len()), triangles: triangles.to_vec() };
        if let Some(&(picture, triangle)) = parts.first() {
            tree.nodes.push((picture, Below::Triangle(triangle)));
            tree.divide(0, &mut parts);
        }
        tree
    }

    fn divide(&mut self, node: usize, parts: &mut [(Picture, u32)]) {
        let all = parts[1..].iter().fold(parts[0].0, |all, part| all.with(&part.0));
        if parts.len() == 1 {
            self.nodes[node] = (all, Below::Triangle(parts[0].1));
            return;
        }
        let extents = all.extents();
        let dimension = (0..3).max_by(|&i, &j| extents[i].total_cmp(&extents[j])).unwrap_or(0);
        let half = parts.len() / 2;
        parts.select_nth_unstable_by(half, |p, q| p.0.middle(dimension).total_cmp(&q.0.middle(dimension)));
        let first = self.nodes.len();
        self.nodes[node] = (all, Below::Nodes(first as u32));
        self.nodes.extend([(all, Below::Triangle(0)); 2]);
        let (left, right) = parts.split_at_mut(half);
        self.divide(first, left);
        self.divide(first + 1, right);
    }
}

/// A node of a tree, or a part of a triangle.
enum Cell {
    Node(usize),
    Part { corners: [DVec3; 3], anchor: DVec3, divisions: u32 },
}

/// The search through two trees of pictures.
struct Walk<'s> {
    screw: &'s Screw,
    trees: [&'s Pictures; 2],
    /// What is added to φ of A.
    shift: f64,
    /// How many of the directions count: only ρ where angles are not known.
    directions: usize,
    level: f64,
    length: f64,
    /// The earliest time at which parts may meet; at most `gain` ends the walk.
    clear: f64,
    gain: f64,
    left: u64,
}

/// The time (≥ `start`, ≤ the end of the scene's window) up to which the pictures stay further apart than the level,
/// and the number of pairs that were looked at; `start` when the motion is no common screw, when less than `gain` would
/// be won, or when more than `most` pairs are needed.
pub(crate) fn screw_clear_until(scene: &Scene<'_>, start: f64, limits: (f64, u64)) -> (f64, u64) {
    screw_clear_mutated(scene, start, limits, &|_| ())
}

/// The same with a change to the screw, for tests.
fn screw_clear_mutated(
    scene: &Scene<'_>,
    start: f64,
    (gain, most): (f64, u64),
    mutate: &dyn Fn(&mut Screw),
) -> (f64, u64) {
    if scene.a.0.mesh.triangle_count() + scene.b.0.mesh.triangle_count() > MOST_TRIANGLES {
        return (start, 0);
    }
    let Some(mut screw) = Screw::new(scene, start) else { return (start, 0) };
    mutate(&mut screw);
    let end = scene.window.end();
    let apart = relative_position(&scene.a.1, &scene.b.1, start);
    let [spins_a, spins_b] = [&scene.a, &scene.b].map(|body| body.1.angular_velocity() != DVec3::ZERO);
    // Heights count from B's followed point if it turns, else from A's; distances from the own axis, or the other's.
    let (from_a, from_b) = match (spins_a, spins_b) {
        (true, true) => (screw.axis * screw.axis.dot(apart), DVec3::ZERO),
        (true, false) => (DVec3::ZERO, -apart),
        _ => (apart, DVec3::ZERO),
    };
    let trees = [(&scene.a, from_a), (&scene.b, from_b)].map(|((tree, motion), from)| {
        let rotation = rotation_at(motion, start);
        let arm = tree.center() - motion.at();
        let place = |p: DVec3| rotation[0] * p.x + rotation[1] * p.y + rotation[2] * p.z + from;
        let triangles: Vec<[DVec3; 3]> = (0..tree.mesh.triangle_count() as u32)
            .map(|t| corners(tree, t).map(|p| place(p + arm)))
            .collect();
        let pictures = triangles.iter().zip(0..).map(|(corners, t)| (screw.picture(corners, corners[0]), t));
        let (wide, narrow): (Vec<_>, Vec<_>) = pictures.partition(|(picture, _)| picture.is_wide());
        [Pictures::new(narrow, &triangles), Pictures::new(wide, &triangles)]
    });
    let mut walk = Walk {
        screw: &screw,
        trees: [&trees[0][0], &trees[1][0]],
        shift: 0.0,
        directions: DIRECTIONS.len(),
        level: scene.pair.level + SWEEP_ERROR * (scene.size + scene.pair.level),
        length: end - start,
        clear: end - start,
        gain,
        left: most,
    };
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        walk.trees = [&trees[0][i], &trees[1][j]];
        walk.directions = if i + j == 0 { DIRECTIONS.len() } else { 1 };
        let [Some(a), Some(b)] = walk.trees.map(|tree| tree.nodes.first().map(|node| node.0.slabs[4])) else {
            continue;
        };
        let leads = if i + j == 0 && screw.lead > 0.0 {
            (((b.0 - a.1) / screw.lead).floor(), ((b.1 - a.0) / screw.lead).ceil())
        } else {
            (0.0, 0.0)
        };
        let count = leads.1 - leads.0;
        if count.is_nan() || count > MOST_LEADS {
            return (start, most - walk.left);
        }
        if i + j == 0 && screw.lead > 0.0 {
            // Shifted by more, the whole pictures are a lead apart in φ.
            let near = walk.trees.map(|tree| tree.nodes[0].0.near);
            let rho = 0.5 * near[0].max(near[1]);
            walk.clear = walk.clear.min(walk.clear_while(screw.lead / screw.steepness(rho), rho));
        }
        for lead in leads.0 as i64..=leads.1 as i64 {
            walk.shift = lead as f64 * screw.lead;
            if !walk.visit(&Cell::Node(0), &Cell::Node(0)) {
                return (start, most - walk.left);
            }
        }
    }
    let clear = walk.clear;
    let time = if clear >= walk.length {
        end
    } else {
        (start + clear * (1.0 - 1e-12)).next_down().clamp(start, end)
    };
    (time, most - walk.left)
}

impl Walk<'_> {
    fn picture(&self, body: usize, cell: &Cell) -> Picture {
        match cell {
            Cell::Node(node) => self.trees[body].nodes[*node].0,
            Cell::Part { corners, anchor, .. } => self.screw.picture(corners, *anchor),
        }
    }

    /// Lowers `clear` to what the pair allows; false when the walk is to end.
    fn visit(&mut self, a: &Cell, b: &Cell) -> bool {
        if self.left == 0 {
            return false;
        }
        self.left -= 1;
        let pictures = [self.picture(0, a), self.picture(1, b)];
        let until = self.clear_for(&pictures[0], &pictures[1]);
        if until >= self.clear {
            return true;
        }
        let inner = |body: usize, cell: &Cell| match cell {
            Cell::Node(node) => matches!(self.trees[body].nodes[*node].1, Below::Nodes(_)),
            Cell::Part { .. } => false,
        };
        let size = pictures.map(|picture| picture.extents().iter().sum::<f64>());
        let open_a = match (inner(0, a), inner(1, b)) {
            (true, false) => true,
            (false, true) => false,
            _ => size[0] > size[1],
        };
        let Some(parts) = self.open(usize::from(!open_a), if open_a { a } else { b }) else {
            self.clear = until;
            return self.clear > self.gain;
        };
        parts.iter().all(|part| if open_a { self.visit(part, b) } else { self.visit(a, part) })
    }

    /// What a cell is made of; none when it is as small as cells get.
    fn open(&self, body: usize, cell: &Cell) -> Option<Vec<Cell>> {
        let (corners, anchor, divisions) = match cell {
            Cell::Node(node) => match self.trees[body].nodes[*node].1 {
                Below::Nodes(first) => return Some([0, 1].map(|k| Cell::Node(first as usize + k)).into()),
                Below::Triangle(triangle) => {
                    let corners = self.trees[body].triangles[triangle as usize];
                    (corners, corners[0], 0)
                }
            },
            Cell::Part { corners, anchor, divisions } => (*corners, *anchor, *divisions),
        };
        if divisions == MOST_DIVISIONS {
            return None;
        }
        let [a, b, c] = corners;
        let (p, q, r) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
        let part = |corners| Cell::Part { corners, anchor, divisions: divisions + 1 };
        Some([[a, p, r], [p, b, q], [r, q, c], [p, q, r]].map(part).into())
    }

    /// For how long the parts stay further apart than the level; at most the length of the span.
    fn clear_for(&self, a: &Picture, b: &Picture) -> f64 {
        let (screw, length) = (self.screw, self.length);
        let mut best: f64 = 0.0;
        // Heights: the gap changes by the climb.
        for (gap, rate) in [(b.height.0 - a.height.1, -screw.climb), (a.height.0 - b.height.1, screw.climb)] {
            let room = gap - self.level;
            if room > 0.0 {
                best = best.max(if -rate * length <= room { length } else { room / -rate });
            }
        }
        // Points that are within ℓ of each other, ℓ at most half of ρ there, differ in F by at most
        // (|α| + |β|√(1 + h²/(ρ/2)²))·ℓ.
        let rho = 0.5 * a.near.max(b.near);
        if rho > 0.0 {
            let steep = screw.steepness(rho);
            let mut apart: f64 = 0.0;
            for ((alpha, beta), (fa, fb)) in
                DIRECTIONS.iter().zip(a.slabs.iter().zip(&b.slabs)).take(self.directions)
            {
                let moved = beta * self.shift;
                let gap = (fb.0 - (fa.1 + moved)).max((fa.0 + moved) - fb.1);
                let distance = gap / ((alpha.abs() + beta * steep) * (1.0 + 1e-12));
                apart = if distance > apart { distance } else { apart };
            }
            best = best.max(self.clear_while(apart, rho));
        }
        best
    }

    /// For how long points whose pictures are `apart`, at least `rho` from the axis all the way, do not come within the
    /// level.
    fn clear_while(&self, apart: f64, rho: f64) -> f64 {
        let room = apart.min(rho) - self.level - self.screw.offset;
        let drift = self.screw.drift;
        if room.is_nan() || room <= 0.0 {
            0.0
        } else if drift * self.length <= room {
            self.length
        } else {
            room / drift
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MeshTree, QueryOptions, TriMesh, Window};
    use d2m_feature::triangle_distance;
    use d2m_motion::LinearMotion;
    use glam::DQuat;

    /// Random triangles, one a body, on random screws about z, some with a drift: the least distance at times called
    /// clear over the level, and how many were called clear for some time.
    fn least_ratio(rounds: u32, mutate: impl Fn(&mut Screw)) -> (f64, u32) {
        let mut seed = 9u64;
        let mut next = move || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / 4_503_599_627_370_496.0 - 1.0
        };
        let (level, mut least, mut won) = (0.02, f64::INFINITY, 0);
        let options = QueryOptions::default().with_tolerance(level);
        for round in 0..rounds {
            let mut vec = || DVec3::new(next(), next(), next());
            let mut body = |size: f64| {
                let middle = vec();
                let corners = vec![middle + vec() * size, middle + vec() * size, middle + vec() * size];
                MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2]]).unwrap())
            };
            let (a, b) = (body(0.5), body(0.5));
            let spins = [(4.0, 0.0), (0.0, -7.0), (5.0, 2.0), (9.0, 8.0)][round as usize % 4];
            let climb = [0.0, 0.3, 3.0][round as usize / 4 % 3];
            let drift = [0.0, 0.3][round as usize / 12 % 2];
            let mut motion = |spin: f64, v: DVec3, x: DVec3| {
                let turn = DQuat::from_xyzw(vec().x, vec().y, vec().z, 0.7);
                LinearMotion::try_new(x, turn, v, DVec3::Z * spin).unwrap()
            };
            let motions = [
                motion(spins.0, DVec3::new(drift, 0.0, climb), DVec3::X * drift),
                motion(spins.1, DVec3::ZERO, DVec3::ZERO),
            ];
            let scene = Scene::new((&a, motions[0]), (&b, motions[1]), Window::UNIT, &options);
            let (until, _) = screw_clear_mutated(&scene, 0.0, (0.0, 1 << 13), &mutate);
            won += u32::from(until > 0.0);
            let world = |tree: &MeshTree, motion: &LinearMotion, t: f64| {
                let (turn, x) = (rotation_at(motion, t), motion.position() + motion.linear_velocity() * t);
                tree.mesh().corners(0).map(|p| turn[0] * p.x + turn[1] * p.y + turn[2] * p.z + x)
            };
            for k in (0..=100).filter(|_| until > 0.0) {
                let t = until * f64::from(k) / 100.0;
                let found = triangle_distance(&world(&a, &motions[0], t), &world(&b, &motions[1], t)).lower;
                least = least.min(found / level);
            }
        }
        (least, won)
    }

    #[test]
    fn pictures_that_are_apart_mean_bodies_that_are_apart() {
        let (least, won) = least_ratio(2400, |_| ());
        assert!((1.0 - 1e-9..2.0).contains(&least), "{least}");
        assert!(won > 600, "{won}");
    }

    #[test]
    fn mutants_of_the_screw_die() {
        assert!(least_ratio(2400, |screw| screw.h *= 0.9).0 < 0.99, "another pitch");
        assert!(least_ratio(2400, |screw| screw.drift = 0.0).0 < 0.99, "no drift");
        assert!(least_ratio(2400, |screw| screw.climb *= 0.5).0 < 0.99, "half of the climb");
    }
}
