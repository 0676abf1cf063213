//! Construction from the top: split by count across the longest axis, eight boxes a node.

use super::fit::{Moments, dot, sub, triangle_axes};
use super::margin::{UNIT_F64, round_up};
use super::mesh_tree::MeshTree;
use super::node::{Below, OrientedBox, WIDTH, WideNode};
use crate::{Topology, TriMesh};
use glam::DVec3;

/// Triangles that a tree can number.
const MOST_TRIANGLES: usize = 1 << 29;

struct Builder<'a> {
    /// Local coordinates of the vertices.
    points: Vec<[f64; 3]>,
    triangles: &'a [[u32; 3]],
    nodes: Vec<WideNode>,
    /// Scratch of the selection.
    keyed: Vec<(f32, u32)>,
}

/// A run of triangles that becomes one box.
struct Part {
    start: usize,
    end: usize,
    axes: [[f64; 3]; 3],
}

impl Part {
    fn count(&self) -> usize {
        self.end - self.start
    }
}

/// Builds the tree.
pub(super) fn build(mesh: TriMesh) -> MeshTree {
    assert!(mesh.triangle_count() <= MOST_TRIANGLES, "more triangles than a tree can number");
    let (center, radius) = enclose(&mesh);
    let unit = unit_of(radius);
    let inverse = 1.0 / unit;
    let points = mesh.vertices().iter().map(|&p| ((p - center) * inverse).to_array()).collect();
    let mut builder = Builder {
        points,
        triangles: mesh.triangles(),
        nodes: Vec::with_capacity(mesh.triangle_count() / 6 + 2),
        keyed: Vec::new(),
    };
    let mut order: Vec<u32> = (0..mesh.triangle_count() as u32).collect();
    let mut root = WideNode::empty([0.0; 3], 0);
    let part = builder.part(&order, 0, order.len());
    let (boxed, size) = builder.enclose(&order, &part, [0.0; 3]);
    root.set_box(0, &boxed, size);
    root.used = 1;
    builder.nodes.push(root);
    let below = builder.below(&mut order, &part, &boxed, [0.0; 3], 0);
    builder.nodes[0].set_below(0, below);
    if matches!(below, Below::Triangle(_)) {
        builder.nodes[0].size[0] = 0.0;
    }
    let mut nodes = builder.nodes;
    nodes.shrink_to_fit();
    let watertight = Topology::new(&mesh).is_watertight();
    let components = component_vertices(&mesh);
    MeshTree { mesh, nodes, center, unit, radius, watertight, components }
}

/// The lowest vertex of each set of triangles that hang together through shared vertices.
fn component_vertices(mesh: &TriMesh) -> Vec<u32> {
    fn root(parent: &mut [u32], mut i: u32) -> u32 {
        while parent[i as usize] != i {
            parent[i as usize] = parent[parent[i as usize] as usize];
            i = parent[i as usize];
        }
        i
    }
    let mut parent: Vec<u32> = (0..mesh.vertex_count() as u32).collect();
    for &[i, j, k] in mesh.triangles() {
        for other in [j, k] {
            let (x, y) = (root(&mut parent, i), root(&mut parent, other));
            parent[x.max(y) as usize] = x.min(y);
        }
    }
    let mut seen: Vec<u32> = mesh.triangles().iter().map(|t| root(&mut parent, t[0])).collect();
    seen.sort_unstable();
    seen.dedup();
    seen
}

/// Middle of the bounding box of the used vertices, and a bound on the distance from it.
fn enclose(mesh: &TriMesh) -> (DVec3, f64) {
    let used = || mesh.triangles().iter().flatten().map(|&i| mesh.vertices()[i as usize]);
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for p in used() {
        (low, high) = (low.min(p), high.max(p));
    }
    let center = low * 0.5 + high * 0.5;
    let square = used().map(|p| (p - center).length_squared()).fold(0.0, f64::max);
    // Differences, squares, sum, root: relative error below 6v.
    (center, square.sqrt() * (1.0 + 16.0 * UNIT_F64))
}

/// The least power of two that is not below `radius`, within the range where nothing over- or underflows.
fn unit_of(radius: f64) -> f64 {
    if radius < 2f64.powi(-600) {
        return if radius == 0.0 { 1.0 } else { 2f64.powi(-600) };
    }
    let power = f64::from_bits(radius.to_bits() & (0x7ff << 52));
    if power < radius { 2.0 * power } else { power }
}

impl Builder<'_> {
    fn corners(&self, triangle: u32) -> [[f64; 3]; 3] {
        self.triangles[triangle as usize].map(|i| self.points[i as usize])
    }

    fn part(&self, order: &[u32], start: usize, end: usize) -> Part {
        let axes = if end - start == 1 {
            triangle_axes(&self.corners(order[start]))
        } else {
            let mut moments = Moments::default();
            for &triangle in &order[start..end] {
                moments.add(&self.corners(triangle));
            }
            moments.axes()
        };
        Part { start, end, axes }
    }

    /// Splits a part in two across its longest axis; the first has a multiple of eight triangles.
    fn split(&mut self, order: &mut [u32], part: &Part) -> (Part, Part) {
        let count = part.count();
        let half = (count / 2).next_multiple_of(WIDTH).min(count - 1).max(1);
        let axis = part.axes[0];
        self.keyed.clear();
        for &triangle in &order[part.start..part.end] {
            let [a, b, c] = self.corners(triangle);
            self.keyed.push(((dot(a, axis) + dot(b, axis) + dot(c, axis)) as f32, triangle));
        }
        self.keyed.select_nth_unstable_by(half, |x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        for (slot, (_, triangle)) in order[part.start..part.end].iter_mut().zip(&self.keyed) {
            *slot = *triangle;
        }
        let middle = part.start + half;
        (self.part(order, part.start, middle), self.part(order, middle, part.end))
    }

    /// The box of a part with the given axes: centre relative to `origin`, outward in real arithmetic.
    fn enclose(&self, order: &[u32], part: &Part, origin: [f32; 3]) -> (OrientedBox, f32) {
        let axes = part.axes.map(|axis| axis.map(|c| c as f32));
        let wide = axes.map(|axis| axis.map(f64::from));
        let origin = origin.map(f64::from);
        let points = || order[part.start..part.end].iter().flat_map(|&t| self.corners(t));
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for p in points() {
            let p = sub(p, origin);
            for i in 0..3 {
                let along = dot(wide[i], p);
                (low[i], high[i]) = (low[i].min(along), high[i].max(along));
            }
        }
        // The centre may be anything: the extents are measured from what it was rounded to.
        let middle = [0, 1, 2].map(|i| 0.5 * (low[i] + high[i]));
        let center: [f32; 3] = [0, 1, 2].map(|k| (0..3).map(|i| wide[i][k] * middle[i]).sum::<f64>() as f32);
        let (mut half, mut square, mut reach) = ([0.0f64; 3], 0.0f64, 0.0f64);
        for p in points() {
            let q = sub(sub(p, origin), center.map(f64::from));
            for i in 0..3 {
                half[i] = half[i].max(dot(wide[i], q).abs());
            }
            square = square.max(dot(q, q));
            reach = reach.max(p[0].abs() + p[1].abs() + p[2].abs());
        }
        // p itself carries 2v relative, q two more roundings of the size of p, o or c, the dot product 3v|q|₁.
        let slack = 8.0
            * UNIT_F64
            * (reach
                + origin.iter().map(|c| c.abs()).sum::<f64>()
                + center.iter().map(|c| f64::from(c.abs())).sum::<f64>());
        let half_extent = half.map(|h| round_up(h + slack));
        let radius = round_up(square.sqrt() * (1.0 + 8.0 * UNIT_F64) + slack);
        let least = 1e-3 * radius;
        let size = half_extent.iter().map(|h| h.max(least)).product::<f32>();
        (OrientedBox { center, axes, half_extent, radius }, size)
    }

    /// Makes what is below a box: the triangle itself, or a node with up to eight parts.
    fn below(
        &mut self,
        order: &mut [u32],
        part: &Part,
        boxed: &OrientedBox,
        origin: [f32; 3],
        parent: u32,
    ) -> Below {
        if part.count() == 1 {
            return Below::Triangle(order[part.start]);
        }
        let mut parts = Vec::with_capacity(WIDTH);
        if part.count() <= WIDTH {
            parts.extend((part.start..part.end).map(|i| self.part(order, i, i + 1)));
        } else {
            parts.push(Part { start: part.start, end: part.end, axes: part.axes });
            while parts.len() < WIDTH {
                let largest =
                    (0..parts.len()).max_by_key(|&i| (parts[i].count(), usize::MAX - i)).unwrap_or(0);
                if parts[largest].count() <= WIDTH {
                    break;
                }
                let (first, second) = self.split(order, &parts.swap_remove(largest));
                parts.push(first);
                parts.push(second);
            }
        }
        let origin = [0, 1, 2].map(|k| origin[k] + boxed.center[k]);
        let index = self.nodes.len() as u32;
        let mut node = WideNode::empty(origin, parent);
        node.used = parts.len() as u32;
        let mut boxes = Vec::with_capacity(WIDTH);
        for (lane, part) in parts.iter().enumerate() {
            let (boxed, size) = self.enclose(order, part, origin);
            node.set_box(lane, &boxed, if part.count() == 1 { 0.0 } else { size });
            boxes.push(boxed);
        }
        self.nodes.push(node);
        for (lane, part) in parts.iter().enumerate() {
            let below = self.below(order, part, &boxes[lane], origin, index * WIDTH as u32 + lane as u32);
            self.nodes[index as usize].set_below(lane, below);
        }
        Below::Node(index)
    }
}
