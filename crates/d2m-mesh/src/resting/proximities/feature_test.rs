//! Distance and normal cones of one pair of features. The slacks are those of the module's notes: δ is `RestingScene::error`.

use super::candidate::{Candidate, Place};
use crate::margin::UNIT_F64;
use crate::mesh::{Adjacency, NONE};
use crate::resting::node_pair::RestingScene;
use d2m_feature::FeaturePair;
use glam::DVec3;

/// A squared distance of two points takes some ten roundings of 2⁻⁵³ each; 2⁻⁴⁰ is far more than they add up to, and
/// only lets candidates pass.
const DISTANCE_ROUNDING: f64 = 1.0 + 1.0 / 1_099_511_627_776.0;

/// A foot may be this many δ outside of its feature: two for the points it is made from on either body, as much for
/// its own roundings.
const FOOT_ERRORS: f64 = 8.0;
/// A direction between points δ off is off by 2δ/d; as much again for each of the vectors that it is compared with.
const DIRECTION_ERRORS: f64 = 8.0;
/// Roundings of a normalised direction and of its scalar products, relative to their factors.
const DIRECTION_ROUNDING: f64 = 16.0 * UNIT_F64;

/// Tests pairs of features of two bodies and keeps those that are locally closest.
pub(super) struct FeatureTest<'a> {
    scene: &'a RestingScene<'a>,
    adjacency: [&'a Adjacency; 2],
    limit_squared: f64,
    limit: f64,
    cone_slack: f64,
    found: Vec<Candidate>,
}

/// What decides about the normal cone.
#[derive(Clone, Copy)]
enum Feature {
    Vertex(u32),
    Edge(u32),
    Face,
}

/// One end of a candidate, before it is accepted.
#[derive(Clone, Copy)]
struct End {
    feature: Feature,
    point: DVec3,
    place: Place,
}

/// A vertex as one end.
#[derive(Clone, Copy)]
struct Vertex {
    vertex: u32,
    end: End,
}

impl Vertex {
    fn new(vertex: u32, placed: &[DVec3; 3], triangle: u32, k: usize) -> Self {
        let mut weights = [0.0; 3];
        weights[k] = 1.0;
        let end =
            End { feature: Feature::Vertex(vertex), point: placed[k], place: Place { triangle, weights } };
        Self { vertex, end }
    }
}

/// The names of two features, and their dimensions together.
#[derive(Clone, Copy)]
struct Kind {
    feature: FeaturePair,
    dimension: u8,
}

impl Kind {
    /// A vertex of body `body` with what the other body's triangle `face` holds.
    fn vertex(body: usize, vertex: u32, face: u32, dimension: u8) -> Self {
        let feature = match body {
            0 => FeaturePair::VertexFace { vertex, face },
            _ => FeaturePair::FaceVertex { face, vertex },
        };
        Self { feature, dimension }
    }
}

/// A direction with a bound on its error.
#[derive(Clone, Copy)]
struct Direction {
    unit: DVec3,
    error: f64,
}

/// The box about placed points, along the axes of B.
#[derive(Clone, Copy)]
struct Box3 {
    lo: DVec3,
    hi: DVec3,
}

impl Box3 {
    fn at(point: DVec3) -> Self {
        Self { lo: point, hi: point }
    }

    #[inline]
    fn of_triangle(&[a, b, c]: &[DVec3; 3]) -> Self {
        Self { lo: a.min(b).min(c), hi: a.max(b).max(c) }
    }

    #[inline]
    fn of_edges(&[a, b, c]: &[DVec3; 3]) -> [Self; 3] {
        [Self::of(a, b), Self::of(b, c), Self::of(c, a)]
    }

    #[inline]
    fn of(one: DVec3, other: DVec3) -> Self {
        Self { lo: one.min(other), hi: one.max(other) }
    }

    /// False: along an axis the boxes are further apart than the limit, by more than one rounding of 2⁻⁵³, as [`FeatureTest::limit`] is greater
    /// than that of its points by [`DISTANCE_ROUNDING`]. What is not a number is within any limit.
    fn is_within(&self, limit: f64, other: &Self) -> bool {
        let between = (other.lo - self.hi).max(self.lo - other.hi);
        !(between.x > limit || between.y > limit || between.z > limit)
    }
}

/// Weights at a parameter along a side.
fn side(k: usize, parameter: f64) -> [f64; 3] {
    let mut weights = [0.0; 3];
    (weights[k], weights[(k + 1) % 3]) = (1.0 - parameter, parameter);
    weights
}

impl<'a> FeatureTest<'a> {
    pub(super) fn new(scene: &'a RestingScene<'a>, limit: f64, cone_slack: f64) -> Self {
        Self {
            scene,
            adjacency: scene.trees.map(crate::MeshTree::adjacency),
            // Distances come from points that are rounded once more.
            limit_squared: limit * limit * DISTANCE_ROUNDING,
            limit: limit * DISTANCE_ROUNDING,
            cone_slack,
            found: Vec::new(),
        }
    }

    pub(super) fn into_candidates(self) -> Vec<Candidate> {
        self.found
    }

    /// Tests all features that the two triangles own, and the two faces against the vertices.
    pub(super) fn compare(&mut self, triangles: [u32; 2], placed: &[[DVec3; 3]; 2]) {
        let owned = [0, 1].map(|body| *self.adjacency[body].owned(triangles[body]));
        // Mapped as an array these were copied twice: 3 % of the time of a heap.
        let faces = [Box3::of_triangle(&placed[0]), Box3::of_triangle(&placed[1])];
        let edges = [Box3::of_edges(&placed[0]), Box3::of_edges(&placed[1])];
        let limit = self.limit;
        let has_vertex = |body: usize, k: usize| {
            owned[body].vertices[k] != NONE && faces[1 - body].is_within(limit, &Box3::at(placed[body][k]))
        };
        let has_edge = |body: usize, k: usize| {
            owned[body].edges[k] != NONE && faces[1 - body].is_within(limit, &edges[body][k])
        };
        let vertices = [0, 1].map(|body| [0, 1, 2].map(|k| has_vertex(body, k)));
        let sides = [0, 1].map(|body| [0, 1, 2].map(|k| has_edge(body, k)));
        for body in 0..2 {
            let other = 1 - body;
            for k in (0..3).filter(|&k| vertices[body][k]) {
                let vertex = Vertex::new(owned[body].vertices[k], &placed[body], triangles[body], k);
                let point = Box3::at(placed[body][k]);
                self.vertex_face(body, vertex, triangles[other], &placed[other]);
                for l in (0..3).filter(|&l| sides[other][l] && edges[other][l].is_within(limit, &point)) {
                    let edge = Feature::Edge(owned[other].edges[l]);
                    self.vertex_edge(body, vertex, edge, (triangles[other], l), &placed[other]);
                }
                if body == 0 {
                    for l in (0..3).filter(|&l| vertices[1][l]) {
                        let end = Vertex::new(owned[1].vertices[l], &placed[1], triangles[1], l).end;
                        let kind = Kind::vertex(0, vertex.vertex, triangles[1], 0);
                        self.accept([vertex.end, end], kind, None);
                    }
                }
            }
        }
        for k in (0..3).filter(|&k| sides[0][k]) {
            for l in (0..3).filter(|&l| sides[1][l] && edges[1][l].is_within(limit, &edges[0][k])) {
                let ids = [owned[0].edges[k], owned[1].edges[l]];
                self.edge_edge(ids, triangles, [k, l], placed);
            }
        }
    }

    /// A vertex of body `body` over the inside of a face of the other.
    fn vertex_face(&mut self, body: usize, vertex: Vertex, triangle: u32, face: &[DVec3; 3]) {
        let [a, b, c] = *face;
        let normal = (b - a).cross(c - a);
        let area = normal.length();
        if !(area > 0.0 && area.is_finite()) {
            return;
        }
        let unit = normal / area;
        let height = unit.dot(vertex.end.point - a);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let delta = self.scene.error;
        // The normal is off by 2δ over the triangle's own height, area/longest.
        let tilt = 4.0 * delta * longest / area;
        if height.abs() > self.limit * (1.0 + tilt) + tilt {
            return;
        }
        let slack = FOOT_ERRORS * (delta + tilt * height.abs());
        let mut weights = [0.0; 3];
        for k in 0..3 {
            let (from, to) = (face[(k + 1) % 3], face[(k + 2) % 3]);
            let along = to - from;
            // |along| times the signed distance of the foot from this side, inwards positive.
            let inside = unit.dot(along.cross(vertex.end.point - from));
            if inside < -slack * along.length() {
                return;
            }
            weights[k] = inside.max(0.0);
        }
        let sum = weights[0] + weights[1] + weights[2];
        if sum.is_nan() || sum <= 0.0 {
            return;
        }
        let weights = weights.map(|weight| weight / sum);
        let foot = a * weights[0] + b * weights[1] + c * weights[2];
        let end = End { feature: Feature::Face, point: foot, place: Place { triangle, weights } };
        // From A to B: up from the face if the face is A's and the vertex is above it.
        let outward = if (height > 0.0) == (body == 1) { unit } else { -unit };
        let direction = Direction { unit: outward, error: tilt };
        let kind = Kind::vertex(body, vertex.vertex, triangle, 2);
        self.accept(if body == 0 { [vertex.end, end] } else { [end, vertex.end] }, kind, Some(direction));
    }

    /// A vertex of body `body` beside the inside of an edge of the other, a side of the triangle `on`.
    fn vertex_edge(
        &mut self,
        body: usize,
        vertex: Vertex,
        edge: Feature,
        on: (u32, usize),
        placed: &[DVec3; 3],
    ) {
        let (triangle, k) = on;
        let (from, to) = (placed[k], placed[(k + 1) % 3]);
        let along = to - from;
        let length = along.length();
        let parameter = (vertex.end.point - from).dot(along) / (length * length);
        let slack = FOOT_ERRORS * self.scene.error / length;
        if !(parameter >= -slack && parameter <= 1.0 + slack) {
            return;
        }
        let parameter = parameter.clamp(0.0, 1.0);
        let point = from + along * parameter;
        let end = End { feature: edge, point, place: Place { triangle, weights: side(k, parameter) } };
        let kind = Kind::vertex(body, vertex.vertex, triangle, 1);
        self.accept(if body == 0 { [vertex.end, end] } else { [end, vertex.end] }, kind, None);
    }

    /// Two edges whose lines are closest inside of both.
    fn edge_edge(
        &mut self,
        edges: [u32; 2],
        triangles: [u32; 2],
        sides: [usize; 2],
        placed: &[[DVec3; 3]; 2],
    ) {
        let start = [0, 1].map(|body| placed[body][sides[body]]);
        let along = [0, 1].map(|body| placed[body][(sides[body] + 1) % 3] - start[body]);
        let lengths = along.map(DVec3::length);
        let cross = along[0].cross(along[1]);
        let square = cross.length_squared();
        let delta = self.scene.error;
        let sine = square.sqrt() / (lengths[0] * lengths[1]);
        // The edges leave each other by less than 4δ over the whole of the longer one: parallel up to
        // rounding, and the closest points next to an end of one of them stand for all.
        let spread = sine * lengths[0].max(lengths[1]);
        if spread.is_nan() || spread <= 4.0 * delta {
            return;
        }
        let between = start[1] - start[0];
        let parameters =
            [between.cross(along[1]).dot(cross) / square, between.cross(along[0]).dot(cross) / square];
        // Where two lines cross moves by their offset over the sine of their angle.
        let reach = FOOT_ERRORS * delta / sine;
        let inside = |body: usize| {
            let slack = reach / lengths[body];
            parameters[body] >= -slack && parameters[body] <= 1.0 + slack
        };
        if !(inside(0) && inside(1)) {
            return;
        }
        let ends = [0, 1].map(|body| {
            let parameter = parameters[body].clamp(0.0, 1.0);
            End {
                feature: Feature::Edge(edges[body]),
                point: start[body] + along[body] * parameter,
                place: Place { triangle: triangles[body], weights: side(sides[body], parameter) },
            }
        });
        let clamped = (0..2).any(|body| !(0.0..=1.0).contains(&parameters[body]));
        let direction = (!clamped).then(|| {
            let unit = cross / square.sqrt();
            let up = unit.dot(ends[1].point - ends[0].point) > 0.0;
            let error = 4.0 * delta / (sine * lengths[0].min(lengths[1]));
            Direction { unit: if up { unit } else { -unit }, error }
        });
        let [edge_a, edge_b] = [0, 1].map(|body| self.adjacency[body].ends(edges[body]));
        let kind = Kind { feature: FeaturePair::EdgeEdge { edge_a, edge_b }, dimension: 2 };
        self.accept(ends, kind, direction);
    }

    /// Keeps a pair of points if it is near enough and its direction in both cones. `exact` is a direction that is known
    /// better than that from point to point may be.
    fn accept(&mut self, ends: [End; 2], kind: Kind, exact: Option<Direction>) {
        let offset = ends[1].point - ends[0].point;
        let square = offset.length_squared();
        if !(square <= self.limit_squared && square > 0.0) {
            return;
        }
        let distance = square.sqrt();
        let from_points =
            Direction { unit: offset / distance, error: DIRECTION_ERRORS * self.scene.error / distance };
        let direction = exact.filter(|exact| exact.error < from_points.error).unwrap_or(from_points);
        let rounding = direction.error + DIRECTION_ROUNDING;
        let square_of = |sine: f64| sine * sine;
        let (slack_squared, rounding_squared) = (square_of(rounding + self.cone_slack), square_of(rounding));
        let mut tilt = 0.0f64;
        for (body, end) in ends.iter().enumerate() {
            let (adjacency, outward) =
                (self.adjacency[body], if body == 0 { direction.unit } else { -direction.unit });
            let next = match end.feature {
                Feature::Vertex(vertex) => adjacency.neighbours(vertex),
                Feature::Edge(edge) => adjacency.opposites(edge),
                Feature::Face => &[],
            };
            for &vertex in next {
                let to = self.scene.place_vertex(body, vertex) - end.point;
                let rise = outward.dot(to) - 2.0 * self.scene.error;
                let length_squared = to.length_squared();
                if rise > 0.0 && rise * rise > rounding_squared * length_squared {
                    if rise * rise > slack_squared * length_squared {
                        return;
                    }
                    tilt = tilt.max(rise / length_squared.sqrt() - rounding);
                }
            }
        }
        let Kind { feature, dimension } = kind;
        self.found.push(Candidate {
            feature,
            places: [ends[0].place, ends[1].place],
            points: [ends[0].point, ends[1].point],
            normal: direction.unit,
            normal_error: direction.error,
            distance,
            tilt,
            dimension,
        });
    }
}
