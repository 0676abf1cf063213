//! A crowd, very many node pairs that may be as close as the closest pair: planes between the hulls of what is below them.
//!
//! Where n triangles of one body and m of the other have a vertex each, and these two vertices are the closest points, all n·m
//! pairs are equally far apart; so are copies of a face, and faces that lie parallel. Boxes never prove it: they
//! are wider than what they hold, and rounded to 24 bits. The vertices below the boxes do: along a direction n let h be the most
//! that n·p is for any vertex p below a box of A, and l the least n·q of one of B; then all triangles below the two boxes are at
//! least l − h apart. A pair for which that is no less than the best distance, up to the width of its enclosure, needs no
//! more search: the lower bound of the answer holds for it, too. Each pair of nodes gets a plane of its own, so crowds
//! that no common plane parts fall apart into some that have one.

use super::best::EXPECTED_WIDTH;
use crate::margin::UNIT_F64;
use crate::meter::{Exhausted, Meter};
use crate::nearest_point::Simplex;
use crate::resting::node_pair::RestingScene;
use crate::tree::node::{Below, WIDTH};
use glam::DVec3;
use std::ops::Range;

/// Triangles of both bodies for each step of the search so far, at most, that vertices are placed of.
const TRIANGLES_A_STEP: u64 = 8;
/// Vertices that are projected for each step of the search, at most: about as long as the step itself takes.
const VERTICES_A_STEP: u64 = 64;
/// Vertices that are projected in the time of one node test.
const VERTICES_A_TEST: usize = 32;
/// Directions that are tried for one pair of nodes, at most. The usual number is two to six.
const MOST_DIRECTIONS: u32 = 12;
/// Makes computed unit vectors no longer than one.
const SHORTENED: f64 = 1.0 - 4.0 * UNIT_F64;

/// What a plane proves of a pair of nodes.
#[derive(Clone, Copy, Debug)]
pub(super) enum Parting {
    /// All pairs of triangles below are further apart than the best upper bound less the width that is expected of its enclosure.
    Beyond,
    /// They are at least this far apart as placed; rounded down.
    AtLeast(f32),
}

/// The closest pair of triangles so far, as planes are measured against it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measure {
    /// Upper bound of its distance, working units.
    pub(super) upper: f64,
    /// From A to B in B's axes, of any length.
    pub(super) direction: DVec3,
}

/// The vertices of both bodies in the order of their trees.
pub(super) struct Hulls {
    bodies: [Vertices; 2],
    /// Bound on the rounding of a projected gap.
    projection: f64,
    /// How many vertices were projected so far.
    projected: u64,
}

impl Hulls {
    /// Are the bodies small enough for a search of so many steps?
    pub(super) fn pay_off(scene: &RestingScene<'_>, steps: u64) -> bool {
        let triangles: usize = scene.trees.iter().map(|tree| tree.mesh().triangle_count()).sum();
        triangles as u64 <= TRIANGLES_A_STEP * steps
    }

    pub(super) fn new(scene: &RestingScene<'_>, meter: &mut Meter) -> Result<Self, Exhausted> {
        let bodies = [Vertices::new(scene, 0, meter)?, Vertices::new(scene, 1, meter)?];
        Ok(Self { bodies, projection: scene.projection, projected: 0 })
    }

    /// Seeks a plane between what is below two boxes, first across the best pair's direction, then across the line between the
    /// nearest points of the two hulls, as far as these are known. `steps`: of the search so far.
    #[cold]
    #[inline(never)]
    pub(super) fn part(
        &mut self,
        pair: [u32; 2],
        best: Measure,
        steps: u64,
        meter: &mut Meter,
    ) -> Result<Parting, Exhausted> {
        let [a, b] = [0, 1].map(|body| self.bodies[body].below(pair[body]));
        let cost = a.len() + b.len();
        let need = best.upper - EXPECTED_WIDTH + self.projection;
        let mut n = best.direction.normalize_or_zero() * SHORTENED;
        let mut simplex: Option<Simplex> = None;
        let mut widest = 0.0_f64;
        for _ in 0..MOST_DIRECTIONS {
            self.projected += cost as u64;
            if self.projected > VERTICES_A_STEP * steps {
                break;
            }
            for _ in 0..cost / VERTICES_A_TEST {
                meter.step()?;
            }
            let ((p, high), (q, low)) = (furthest(a, n), furthest(b, -n));
            // Not when it is not a number.
            let gap = -low - high;
            if gap > need {
                return Ok(Parting::Beyond);
            }
            widest = widest.max(gap);
            let next = simplex.map_or(Some(Simplex::new(q - p)), |simplex| simplex.with(q - p));
            let Some(next) = next else { break };
            simplex = Some(next);
            // The hulls come nearer than what is needed, or meet.
            if next.nearest().length_squared() <= need * need {
                break;
            }
            n = next.nearest().normalize_or_zero() * SHORTENED;
        }
        // Rounded down; the product and the difference err by far less than what is taken off.
        let proven = (widest - self.projection) * (1.0 - 4.0 * f64::from(f32::EPSILON));
        Ok(Parting::AtLeast(if proven > 0.0 { proven as f32 } else { 0.0 }))
    }
}

/// The vertices of one body as placed, each node's in one piece.
struct Vertices {
    points: Vec<DVec3>,
    /// Where the vertices below each node are.
    of_nodes: Vec<Range<usize>>,
    of_triangles: Vec<[DVec3; 3]>,
    /// What is below each box.
    below: Vec<Below>,
}

/// What to do at a node.
enum Visit {
    Enter(u32),
    Leave(u32),
}

impl Vertices {
    fn new(scene: &RestingScene<'_>, body: usize, meter: &mut Meter) -> Result<Self, Exhausted> {
        let nodes = &scene.trees[body].nodes;
        let count = scene.trees[body].mesh().triangle_count();
        let mut points = Vec::with_capacity(2 * count);
        let mut of_nodes = vec![0..0; nodes.len()];
        let mut of_triangles = vec![[DVec3::ZERO; 3]; count];
        let mut stack = vec![Visit::Enter(0)];
        while let Some(visit) = stack.pop() {
            let index = match visit {
                Visit::Leave(index) => {
                    of_nodes[index as usize].end = points.len();
                    continue;
                }
                Visit::Enter(index) => index,
            };
            let (node, first) = (&nodes[index as usize], points.len());
            of_nodes[index as usize].start = first;
            stack.push(Visit::Leave(index));
            for lane in 0..(node.used as usize).min(WIDTH) {
                meter.step()?;
                match node.below(lane) {
                    Below::Node(below) => stack.push(Visit::Enter(below)),
                    Below::Triangle(triangle) => {
                        let corners = scene.place(body, triangle);
                        of_triangles[triangle as usize] = corners;
                        for corner in corners {
                            if !points[first..].contains(&corner) {
                                points.push(corner);
                            }
                        }
                    }
                }
            }
        }
        let below = nodes.iter().flat_map(|node| (0..WIDTH).map(|lane| node.below(lane))).collect();
        Ok(Self { points, of_nodes, of_triangles, below })
    }

    fn below(&self, index: u32) -> &[DVec3] {
        match self.below[index as usize] {
            Below::Triangle(triangle) => &self.of_triangles[triangle as usize],
            Below::Node(node) => &self.points[self.of_nodes[node as usize].clone()],
        }
    }
}

/// The point that reaches the furthest along a direction, and how far. What is not a number wins.
fn furthest(points: &[DVec3], n: DVec3) -> (DVec3, f64) {
    let mut best = (points[0], n.dot(points[0]));
    for &point in &points[1..] {
        let along = n.dot(point);
        if along > best.1 || along.is_nan() {
            best = (point, along);
        }
    }
    best
}
