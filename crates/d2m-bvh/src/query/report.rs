//! From what the search found to the answer: witness points, normal, features in the meshes' numbers.

use crate::pair::motion::frame::{FRAME_REACH, Frame, RelativeMotion};
use crate::pair::scene::MovingScene;
use crate::pair::triangles::closest::{Closest, Place, closest};
use crate::pair::triangles::pair_scale::PairScale;
use crate::pair::triangles::separating_axis::place_a;
use crate::walk::state::Found;
use crate::{Contact, Evidence, MeshTree, Mode, StartState};
use d2m_feature::proven_crossing;
use d2m_feature::{FeaturePair, triangles_intersect};
use d2m_lanes::{Doubles, F64x4, Lanes, Task, run};
use d2m_mesh::at_rest::Held;
use glam::DVec3;

/// The contact with all its data, of a scene and its motion over the window of the search: but in Capoeira mode with a time by
/// which the tolerance was reached, if that cannot be shown for `time_lo`.
pub(super) fn contact(
    scene: &MovingScene<'_>,
    motion: &RelativeMotion,
    found: &Found,
    mode: Mode,
) -> Contact {
    run(Report { scene, motion, found, mode })
}

struct Report<'r> {
    scene: &'r MovingScene<'r>,
    motion: &'r RelativeMotion,
    found: &'r Found,
    mode: Mode,
}

impl Task for Report<'_> {
    type Output = Contact;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Contact {
        let Self { scene, motion, found, mode } = self;
        let (a, b) = (scene.a.corners(found.triangles[0]), scene.b.corners(found.triangles[1]));
        let pair = TrianglePair { motion, a, b };
        // What the clock of the caller has no number for is reported at the time before.
        let time = scene.units.time_down(found.in_query());
        let offset = scene.units.offset(time);
        // Frames hold for the window of the search only.
        let from = offset.max(found.start);
        let placed = pair.at::<L::Doubles>(from);
        let start = match (found.is_at_start(), found.crossing) {
            (false, _) => StartState::Apart,
            (true, false) => StartState::Touching,
            (true, true) => StartState::Overlapping,
        };
        // Pairs that were followed up to the stopping distance are above the level still.
        let evidence = if start == StartState::Apart && !found.crossing {
            Evidence::Early
        } else {
            pair.evidence::<L::Doubles>(scene, &placed)
        };
        let meeting = match evidence {
            Evidence::Early if mode != Mode::Capoeira => pair.reached_by::<L::Doubles>(scene, from, &placed),
            evidence => Meeting { offset: from, evidence },
        };
        let witness = |placed: PlacedPair| Witness {
            separation: match start {
                StartState::Overlapping => 0.0,
                _ => placed.near.distance_squared.sqrt(),
            },
            a: place_a::<L::Doubles>(&placed.frame, &a),
            b,
            placed,
            triangles: found.triangles,
            start,
            meeting,
        };
        let mut contact = if from == offset {
            describe(scene, motion, time, &witness(placed))
        } else {
            let motion = scene.relative_motion(offset);
            let placed = TrianglePair { motion: &motion, a, b }.at::<L::Doubles>(offset);
            describe(scene, &motion, time, &witness(placed))
        };
        if mode != Mode::Capoeira {
            cover_what_is_left(&mut contact, scene);
        }
        contact
    }
}

/// Where the resolution of time is coarser than the tolerance, more separation is left: then the tolerance is what is left.
fn cover_what_is_left(contact: &mut Contact, scene: &MovingScene<'_>) {
    let length = scene.units.length();
    let separation = (scene.pair.level - scene.tolerance) * length;
    let left = contact.separation - separation;
    if left > Contact::MOST_LEFT * contact.tolerance {
        // The closest points are on the triangles up to the error.
        contact.tolerance = left + scene.pair.error * length;
        contact.evidence = contact.evidence.max(Evidence::Near);
    }
}

/// Most evaluations for the end of a bracket.
const BRACKET_EVALUATIONS: u32 = 24;

/// What is proven of the meeting of two bodies, and for a time not after which offset.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    offset: f64,
    evidence: Evidence,
}

/// Two triangles, vertices relative to the trees' centers in body axes, and how they move.
struct TrianglePair<'r> {
    motion: &'r RelativeMotion,
    a: [DVec3; 3],
    b: [DVec3; 3],
}

/// The two triangles at one time.
struct PlacedPair {
    frame: Frame,
    near: Closest,
}

impl TrianglePair<'_> {
    #[inline(always)]
    fn at<D: Doubles>(&self, offset: f64) -> PlacedPair {
        let frame = self.motion.frame::<D>(offset - self.motion.start);
        PlacedPair { near: closest::<D>(&place_a::<D>(&frame, &self.a), &self.b), frame }
    }

    /// What is proven of the meeting at the time of the frame.
    ///
    /// Placed vertices of both bodies together are off by γ/2 at most (γ = `scene.pair.error`); the closest points are
    /// points of the placed triangles, and their distance and the time of the frame round by less than the other half. So
    /// a distance of at most L − γ is one of at most L in real arithmetic, and so is that of placed triangles that
    /// share a point.
    #[inline(always)]
    fn evidence<D: Doubles>(&self, scene: &MovingScene<'_>, placed: &PlacedPair) -> Evidence {
        let PairScale { level, error, .. } = scene.pair;
        let a = place_a::<D>(&placed.frame, &self.a);
        if proven_crossing(&a, &self.b, error) {
            return Evidence::Crossing;
        }
        let is_near = placed.near.distance_squared.sqrt() <= level - error;
        if is_near || triangles_intersect(&a, &self.b) { Evidence::Near } else { Evidence::Early }
    }

    /// An offset by which the triangles were certainly within the level, or had met; `from` when none is found: Newton's
    /// method along the normal, and bisection once the triangles have passed each other.
    #[inline(always)]
    fn reached_by<D: Doubles>(&self, scene: &MovingScene<'_>, from: f64, placed: &PlacedPair) -> Meeting {
        // The closest points are on the triangles up to the error: a true upper bound of the distance. In the middle
        // between that and no distance at all there is as much room on either side as there can be.
        let level = scene.pair.level - scene.pair.error;
        let target = scene.pair.level - 0.5 * (scene.tolerance + scene.pair.error);
        // Frames hold for a little more than the longest window.
        let end = scene.units.end_down().min(self.motion.start + FRAME_REACH * scene.longest);
        let (mut early, mut late) = (from, None);
        let first = Approach::new(placed);
        let (mut distance, mut closing) = (first.distance, first.closing);
        for _ in 0..BRACKET_EVALUATIONS {
            let offset = match late {
                None if closing > 0.0 => {
                    (early + (distance - target) / closing).max(early.next_up()).min(end)
                }
                None => break,
                Some(late) => early + 0.5 * (late - early),
            };
            if offset.is_nan() || offset <= early {
                break;
            }
            let here = Approach::new(&self.at::<D>(offset));
            if here.distance <= level {
                return Meeting { offset, evidence: Evidence::Near };
            }
            if here.normal.dot(first.normal) < 0.0 {
                late = Some(offset);
            } else {
                (early, distance, closing) = (offset, here.distance, here.closing);
            }
        }
        // Passed each other between two times that no time is between, or too fast for the steps.
        if let Some(late) = late {
            let evidence = self.evidence::<D>(scene, &self.at::<D>(late));
            if evidence > Evidence::Early {
                return Meeting { offset: late, evidence };
            }
        }
        Meeting { offset: from, evidence: Evidence::Early }
    }
}

/// How the closest points of two triangles approach each other.
struct Approach {
    distance: f64,
    /// The speed at which they come together.
    closing: f64,
    /// The unit direction from A to B.
    normal: DVec3,
}

impl Approach {
    #[inline(always)]
    fn new(PlacedPair { frame, near }: &PlacedPair) -> Self {
        let normal = near.direction.normalize_or_zero();
        let closing = frame.closing_speed(near.points, normal);
        Self { distance: near.distance_squared.sqrt(), closing, normal }
    }
}

struct Witness {
    placed: PlacedPair,
    a: [DVec3; 3],
    b: [DVec3; 3],
    triangles: [u32; 2],
    separation: f64,
    start: StartState,
    meeting: Meeting,
}

fn describe(scene: &MovingScene<'_>, motion: &RelativeMotion, time: f64, witness: &Witness) -> Contact {
    let Witness { placed: PlacedPair { frame, near }, a, b, triangles, separation, start, meeting } = witness;
    let rb = motion.rotation_b(frame.offset);
    let turn = |p: DVec3| rb.transform(p);
    let (length, seconds) = (scene.units.length(), scene.units.time());
    let base = scene.b.motion.estimate_position(motion.start + frame.offset);
    let world = |p: DVec3| (base + turn(p + scene.b.motion.arm())) * length;
    let normal = near.direction.normalize_or(DVec3::X);
    let [pa, pb] = near.points;
    Contact {
        time_lo: time,
        time_hi: match meeting.evidence {
            Evidence::Early => time,
            _ => scene.units.time_up(meeting.offset).clamp(time, scene.window.end()),
        },
        evidence: meeting.evidence,
        separation: *separation * length,
        tolerance: scene.tolerance * length,
        normal: turn(normal),
        point_a: world(pa),
        point_b: world(pb),
        feature: feature(scene, near, *triangles),
        triangle_a: triangles[0],
        triangle_b: triangles[1],
        barycentric_a: barycentric(a, pa, near.places[0]),
        barycentric_b: barycentric(b, pb, near.places[1]),
        closing_speed: frame.closing_speed(near.points, normal) * length / seconds,
        start: *start,
        left: None,
    }
}

/// A triangle of the vertex that shows that one body holds the other, and the first one of the body that holds it.
pub(super) fn triangles_of_held(held: &Held, trees: [&MeshTree; 2]) -> [u32; 2] {
    let inner = 1 - held.by;
    let of_vertex = trees[inner].mesh().triangles().iter().position(|t| t.contains(&held.vertex));
    let mut triangles = [0; 2];
    triangles[inner] = of_vertex.unwrap_or(0) as u32;
    triangles
}

/// The contact of a body inside the other: the vertex that shows it, and the nearest data that mean something.
pub(super) fn contained(scene: &MovingScene<'_>, held: &Held) -> Contact {
    let motion = &scene.relative_motion(0.0);
    let start = StartState::Contained;
    let frame = motion.frame::<F64x4>(0.0);
    let triangles = triangles_of_held(held, [scene.a.tree, scene.b.tree]);
    let b = scene.b.corners(triangles[1]);
    let a = place_a::<F64x4>(&frame, &scene.a.corners(triangles[0]));
    let near = closest::<F64x4>(&a, &b);
    let time = scene.window.start();
    // The surfaces are further apart than the level, so rounding moves no vertex to the other side of one.
    let meeting = Meeting { offset: 0.0, evidence: Evidence::Crossing };
    let placed = PlacedPair { frame, near };
    describe(scene, motion, time, &Witness { placed, a, b, triangles, separation: 0.0, start, meeting })
}

fn feature(scene: &MovingScene<'_>, near: &Closest, triangles: [u32; 2]) -> FeaturePair {
    let a = scene.a.tree.mesh().triangles()[triangles[0] as usize];
    let b = scene.b.tree.mesh().triangles()[triangles[1] as usize];
    let edge = |t: [u32; 3], k: usize| {
        let (p, q) = (t[k], t[(k + 1) % 3]);
        [p.min(q), p.max(q)]
    };
    match near.places {
        [Place::Edge(i), Place::Edge(j)] => FeaturePair::EdgeEdge { edge_a: edge(a, i), edge_b: edge(b, j) },
        [Place::Vertex(i), _] => FeaturePair::VertexFace { vertex: a[i], face: triangles[1] },
        [_, Place::Vertex(j)] => FeaturePair::FaceVertex { face: triangles[0], vertex: b[j] },
        // Faces only meet at the vertices or edges of one of them: never produced.
        [Place::Face, _] => FeaturePair::FaceVertex { face: triangles[0], vertex: b[0] },
        [_, Place::Face] => FeaturePair::VertexFace { vertex: a[0], face: triangles[1] },
    }
}

/// Weights of the vertices: not negative, sum one up to rounding.
fn barycentric(corners: &[DVec3; 3], point: DVec3, place: Place) -> [f64; 3] {
    let mut weights = [0.0; 3];
    match place {
        Place::Vertex(i) => weights[i] = 1.0,
        Place::Edge(i) => {
            let j = (i + 1) % 3;
            let edge = corners[j] - corners[i];
            let x = ((point - corners[i]).dot(edge) / edge.length_squared()).clamp(0.0, 1.0);
            (weights[i], weights[j]) = (1.0 - x, x);
        }
        Place::Face => {
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            for (k, weight) in weights.iter_mut().enumerate() {
                let (p, q) = (corners[(k + 1) % 3] - point, corners[(k + 2) % 3] - point);
                *weight = p.cross(q).dot(normal).max(0.0);
            }
            let sum: f64 = weights.iter().sum();
            weights = weights.map(|w| w / sum);
        }
    }
    weights
}
