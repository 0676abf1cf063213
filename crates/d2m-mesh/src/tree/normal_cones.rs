//! Which directions the features below each box of a tree may be locally closest along.
//!
//! A feature is locally closest along n only if n is in its normal cone: of a vertex {n : n·e ≤ 0 for each edge e at it}, of an edge e
//! {n ⟂ e : n·w ≤ 0 for each third corner w}, of a face both directions of its normal. For each box a *double cone* holds all of these
//! for the features of its triangles: |n × a| ≤ s for unit n, about a unit axis a. With lines instead of directions, s = sin θ:
//!
//! * sin(α + β) ≤ sin α + sin β, and s ≥ 1 holds everything; so a cone about a that is seen from a′ has s + |a × a′|.
//! * Edge with two triangles: with u₁, u₂ the unit parts of the third corners across e, the directions are those of an arc from ±e × u₁
//!   to ±e × u₂. If u₁·u₂ < 0 it is shorter than a right angle, and its sine is |u₁ × u₂|. Else everything.
//! * Vertex: three of its edges suffice, as less conditions hold more. The directions n with n·eᵢ ≤ 0 are, up to one common sign,
//!   the non-negative combinations of r₁₂ = e₁ × e₂, r₂₃, r₃₁ (r₁₂·e₃ = r₂₃·e₁ = r₃₁·e₂ is the volume; where it is zero and the r point to
//!   one side they are multiples of each other, and n is on their line). If the r are less than a right angle apart, a cap about their sum
//!   that holds them is convex and holds all.
//!
//! Roundings: differences of doubles are exact to u in each coordinate; a cross product errs by 4u of the product of lengths, so by less
//! than 2⁻²⁸ of itself where the sine of the two is at least 2⁻²⁰ (else: everything). All that follows (unit vectors, sums, cross
//! products of unit vectors) errs by less than 2⁻⁴⁵ each. `ROUNDING` is added where cones are made and whenever they are joined.

use super::node::{Below, WIDTH, WideNode};
use crate::TriMesh;
use crate::mesh::{Adjacency, NONE};
use d2m_lanes::power_of_two;
use glam::DVec3;

/// Added to the sine of every cone for its roundings.
const ROUNDING: f64 = power_of_two(-26);
/// Sines and cosines of edges below this have directions that rounding may turn.
const LEAST: f64 = power_of_two(-20);
/// Edges of a vertex that are tried in threes.
const MOST_EDGES: usize = 10;

/// The directions of lines within an angle of an axis, and a sphere about the triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalCone {
    /// Unit.
    pub(crate) axis: DVec3,
    /// Sine of the angle; from one on everything.
    pub(crate) sine: f64,
    /// Body coordinates.
    pub(crate) center: DVec3,
    pub(crate) radius: f64,
}

/// One for each box of a tree.
#[derive(Debug)]
pub(crate) struct NormalCones(Vec<NormalCone>);

impl NormalCones {
    pub(super) fn new(mesh: &TriMesh, nodes: &[WideNode], adjacency: &Adjacency) -> Self {
        let nothing =
            NormalCone { axis: DVec3::X, sine: f64::INFINITY, center: DVec3::ZERO, radius: f64::INFINITY };
        let mut cones = Self(vec![nothing; nodes.len() * WIDTH]);
        cones.fill(0, &Source { mesh, nodes, adjacency });
        cones
    }

    /// Of a box, by node and lane.
    pub(crate) fn of(&self, index: u32) -> &NormalCone {
        &self.0[index as usize]
    }

    /// Resident bytes.
    pub(super) fn memory_bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    fn fill(&mut self, node: u32, source: &Source<'_>) {
        let wide = &source.nodes[node as usize];
        for lane in 0..(wide.used as usize).min(WIDTH) {
            let cone = match wide.below(lane) {
                Below::Triangle(triangle) => source.triangle(triangle),
                Below::Node(below) => {
                    self.fill(below, source);
                    let used = (source.nodes[below as usize].used as usize).min(WIDTH);
                    let first = below as usize * WIDTH;
                    NormalCone::joined(&self.0[first..first + used])
                }
            };
            self.0[node as usize * WIDTH + lane] = cone;
        }
    }
}

impl NormalCone {
    fn joined(cones: &[Self]) -> Self {
        let axis = axis_of(cones.iter().map(|cone| cone.axis));
        let sine = cones.iter().map(|cone| cone.sine + cone.axis.cross(axis).length()).fold(0.0, f64::max);
        let (low, high) = cones.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), cone| {
            (low.min(cone.center - cone.radius), high.max(cone.center + cone.radius))
        });
        let center = low * 0.5 + high * 0.5;
        let radius = cones.iter().map(|cone| cone.center.distance(center) + cone.radius).fold(0.0, f64::max);
        Self { axis, sine: sine + ROUNDING, center, radius: radius * (1.0 + ROUNDING) }
    }
}

/// About the middle of some lines; any unit vector is right.
fn axis_of(lines: impl Iterator<Item = DVec3>) -> DVec3 {
    let sum = lines.reduce(|sum, line| if sum.dot(line) < 0.0 { sum - line } else { sum + line });
    sum.and_then(DVec3::try_normalize).unwrap_or(DVec3::X)
}

struct Source<'s> {
    mesh: &'s TriMesh,
    nodes: &'s [WideNode],
    adjacency: &'s Adjacency,
}

/// A double cone without a place.
#[derive(Clone, Copy)]
struct Lines {
    axis: DVec3,
    sine: f64,
}

const EVERYTHING: Lines = Lines { axis: DVec3::X, sine: f64::INFINITY };

impl Source<'_> {
    fn point(&self, vertex: u32) -> DVec3 {
        self.mesh.vertices()[vertex as usize]
    }

    /// The face and what else the triangle answers for.
    fn triangle(&self, triangle: u32) -> NormalCone {
        let [a, b, c] = self.mesh.corners(triangle as usize);
        let owned = self.adjacency.owned(triangle);
        let vertices = owned.vertices.into_iter().filter(|&v| v != NONE).map(|v| self.vertex(v));
        let edges = owned.edges.into_iter().filter(|&e| e != NONE).map(|e| self.edge(e));
        let face = across(b - a, c - a).map_or(EVERYTHING, |axis| Lines { axis, sine: 0.0 });
        let lines: Vec<Lines> = vertices.chain(edges).chain([face]).collect();
        let axis = axis_of(lines.iter().map(|lines| lines.axis));
        let sine = lines.iter().map(|lines| lines.sine + lines.axis.cross(axis).length()).fold(0.0, f64::max);
        let center = (a * 0.5 + b * 0.5) * 0.5 + c * 0.5;
        let radius = [a, b, c].map(|p| p.distance(center)).into_iter().fold(0.0, f64::max);
        NormalCone { axis, sine: sine + ROUNDING, center, radius: radius * (1.0 + ROUNDING) }
    }

    fn edge(&self, edge: u32) -> Lines {
        let [from, to] = self.adjacency.ends(edge).map(|v| self.point(v));
        let along = to - from;
        let thirds = self.adjacency.opposites(edge).iter().map(|&v| across(along, self.point(v) - from));
        // Across e a third corner and its normal are a quarter turn apart: their products and angles are equal.
        let [Some(n), Some(m)] = thirds.chain([None, None]).take(2).collect::<Vec<_>>()[..] else {
            return EVERYTHING;
        };
        if n.dot(m) < -LEAST { Lines { axis: n, sine: n.cross(m).length() + ROUNDING } } else { EVERYTHING }
    }

    fn vertex(&self, vertex: u32) -> Lines {
        let at = self.point(vertex);
        let neighbours = self.adjacency.neighbours(vertex).iter().take(MOST_EDGES);
        let edges: Vec<DVec3> = neighbours.map(|&v| self.point(v) - at).collect();
        let mut best = EVERYTHING;
        for i in 0..edges.len() {
            for j in i + 1..edges.len() {
                for k in j + 1..edges.len() {
                    let [Some(r), Some(s), Some(t)] =
                        [(i, j), (j, k), (k, i)].map(|(i, j)| across(edges[i], edges[j]))
                    else {
                        continue;
                    };
                    if r.dot(s).min(s.dot(t)).min(t.dot(r)) > LEAST {
                        let axis = (r + s + t).normalize();
                        let sine = [r, s, t].map(|r| r.cross(axis).length()).into_iter().fold(0.0, f64::max);
                        if sine + ROUNDING < best.sine {
                            best = Lines { axis, sine: sine + ROUNDING };
                        }
                    }
                }
            }
        }
        best
    }
}

/// The unit direction across two vectors, where rounding does not turn it.
fn across(a: DVec3, b: DVec3) -> Option<DVec3> {
    let (a, b) = (a.try_normalize()?, b.try_normalize()?);
    let cross = a.cross(b);
    let length = cross.length();
    (length >= LEAST).then(|| cross / length)
}
