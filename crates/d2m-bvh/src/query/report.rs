//! From what the search found to the answer: witness points, normal, features in the meshes' numbers.

use super::proven_crossing::proven_crossing;
use crate::search::{
    Closest, Doubles, Found, Frame, Lanes, PairScale, Place, Quad, RelativeMotion, Scene, Task, closest,
    corners, place_a, run,
};
use crate::{Contact, Evidence, MeshTree, StartState};
use d2m_feature::{FeaturePair, triangles_intersect};
use glam::DVec3;

/// The contact with all its data; `bracket`: look for a time by which the tolerance was reached, if that cannot be
/// shown for `time_lo`.
pub(super) fn contact(scene: &Scene<'_>, found: &Found, bracket: bool) -> Contact {
    run(Report { scene, found, bracket })
}

struct Report<'r> {
    scene: &'r Scene<'r>,
    found: &'r Found,
    bracket: bool,
}

impl Task for Report<'_> {
    type Output = Contact;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Contact {
        let Self { scene, found, bracket } = self;
        let time = crate::search::time_from(found.start, found.offset).max(scene.window.start());
        let motion = RelativeMotion::new(scene, found.start);
        let pair = TrianglePair {
            motion: &motion,
            a: corners(scene.a.0, found.triangles[0]),
            b: corners(scene.b.0, found.triangles[1]),
        };
        let (frame, near) = pair.at::<L::Doubles>(time);
        let start = match (time <= scene.window.start(), found.crossing) {
            (false, _) => StartState::Apart,
            (true, false) => StartState::Touching,
            (true, true) => StartState::Overlapping,
        };
        let separation = if start == StartState::Overlapping { 0.0 } else { near.square.sqrt() };
        let a = place_a::<L::Doubles>(&frame, &pair.a);
        // Pairs that were followed up to the stopping distance are above the level still.
        let evidence = if start == StartState::Apart && !found.crossing {
            Evidence::Early
        } else {
            pair.evidence::<L::Doubles>(scene, (&frame, &near))
        };
        let meeting = match evidence {
            Evidence::Early if bracket => pair.reached_by::<L::Doubles>(scene, time, (&frame, &near)),
            evidence => Meeting { time, evidence },
        };
        let witness = Witness { near, a, b: pair.b, triangles: found.triangles, separation, start, meeting };
        describe(scene, (&motion, &frame), time, &witness)
    }
}

/// Looks at most for the end of a bracket.
const BRACKET_LOOKS: u32 = 24;

/// What is proven of the meeting of two bodies, and for a time not after which one.
#[derive(Clone, Copy, Debug)]
struct Meeting {
    time: f64,
    evidence: Evidence,
}

/// What the pair of triangles proves about the meeting of the bodies at the start of the window.
pub(super) fn evidence_at_start(scene: &Scene<'_>, triangles: [u32; 2]) -> Evidence {
    let motion = RelativeMotion::new(scene, scene.window.start());
    let [a, b] = [corners(scene.a.0, triangles[0]), corners(scene.b.0, triangles[1])];
    let pair = TrianglePair { motion: &motion, a, b };
    let (frame, near) = pair.at::<Quad>(motion.start);
    pair.evidence::<Quad>(scene, (&frame, &near))
}

/// Two triangles, corners relative to the trees' centres in body axes, and how they move.
struct TrianglePair<'r> {
    motion: &'r RelativeMotion,
    a: [DVec3; 3],
    b: [DVec3; 3],
}

impl TrianglePair<'_> {
    #[inline(always)]
    fn at<D: Doubles>(&self, time: f64) -> (Frame, Closest) {
        let frame = self.motion.frame::<D>(time - self.motion.start);
        (frame, closest::<D>(&place_a::<D>(&frame, &self.a), &self.b))
    }

    /// What is proven of the meeting at the time of the frame.
    ///
    /// Placed corners of both bodies together are off by γ/2 at most (γ = `scene.pair.error`); the closest points are
    /// points of the placed triangles, and their distance and the time of the frame round by less than the other half. So
    /// a distance of at most L − γ is one of at most L in real arithmetic, and so is that of placed triangles that
    /// share a point.
    #[inline(always)]
    fn evidence<D: Doubles>(&self, scene: &Scene<'_>, (frame, near): (&Frame, &Closest)) -> Evidence {
        let PairScale { level, error, .. } = scene.pair;
        let a = place_a::<D>(frame, &self.a);
        if proven_crossing(&a, &self.b, error) {
            return Evidence::Crossing;
        }
        let is_near = near.square.sqrt() <= level - error;
        if is_near || triangles_intersect(&a, &self.b) { Evidence::Near } else { Evidence::Early }
    }

    /// A time by which the triangles were certainly within the level, or had met; `time_lo` when none is found: Newton's
    /// method along the normal, and bisection once the triangles have passed each other.
    #[inline(always)]
    fn reached_by<D: Doubles>(
        &self,
        scene: &Scene<'_>,
        time_lo: f64,
        (frame, near): (&Frame, &Closest),
    ) -> Meeting {
        // The closest points are on the triangles up to the error: a true upper bound of the distance. In the middle
        // between that and no distance at all there is as much room on either side as there can be.
        let level = scene.pair.level - scene.pair.error;
        let target = scene.pair.level - 0.5 * (scene.tolerance + scene.pair.error);
        // Frames hold for a little more than the longest window.
        let end = scene.window.end().min(self.motion.start + 1.1 * scene.longest);
        let (mut early, mut late) = (time_lo, None);
        let (mut distance, mut closing, first_normal) = course(frame, near);
        for _ in 0..BRACKET_LOOKS {
            let time = match late {
                None if closing > 0.0 => {
                    (early + (distance - target) / closing).max(early.next_up()).min(end)
                }
                None => break,
                Some(late) => early + 0.5 * (late - early),
            };
            if time.is_nan() || time <= early {
                break;
            }
            let (frame, near) = self.at::<D>(time);
            let (here, speed, normal) = course(&frame, &near);
            if here <= level {
                return Meeting { time, evidence: Evidence::Near };
            }
            if normal.dot(first_normal) < 0.0 {
                late = Some(time);
            } else {
                (early, distance, closing) = (time, here, speed);
            }
        }
        // Passed each other between two times that no time is between, or too fast for the steps.
        if let Some(late) = late {
            let (frame, near) = self.at::<D>(late);
            let evidence = self.evidence::<D>(scene, (&frame, &near));
            if evidence > Evidence::Early {
                return Meeting { time: late, evidence };
            }
        }
        Meeting { time: time_lo, evidence: Evidence::Early }
    }
}

/// Distance of the closest points, the speed at which they come together, the unit direction from A to B.
#[inline(always)]
fn course(frame: &Frame, near: &Closest) -> (f64, f64, DVec3) {
    let normal = near.direction.normalize_or_zero();
    (near.square.sqrt(), frame.closing_speed(near.points, normal), normal)
}

struct Witness {
    near: Closest,
    a: [DVec3; 3],
    b: [DVec3; 3],
    triangles: [u32; 2],
    separation: f64,
    start: StartState,
    meeting: Meeting,
}

fn describe(
    scene: &Scene<'_>,
    (motion, frame): (&RelativeMotion, &Frame),
    time: f64,
    witness: &Witness,
) -> Contact {
    let Witness { near, a, b, triangles, separation, start, meeting } = witness;
    let rb = motion.rotation_b(frame.offset);
    let turn = |p: DVec3| rb.times::<Quad>(p).to_vec();
    let body = &scene.b;
    let base = body.1.position() + body.1.linear_velocity() * (time - body.1.reference_time());
    let world = |p: DVec3| base + turn(p + (body.0.center() - body.1.at()));
    let normal = near.direction.normalize_or(DVec3::X);
    let [pa, pb] = near.points;
    Contact {
        time_lo: time,
        time_hi: meeting.time,
        evidence: meeting.evidence,
        separation: *separation,
        tolerance: scene.tolerance,
        normal: turn(normal),
        point_a: world(pa),
        point_b: world(pb),
        feature: feature(scene, near, *triangles),
        triangle_a: triangles[0],
        triangle_b: triangles[1],
        barycentric_a: barycentric(a, pa, near.places[0]),
        barycentric_b: barycentric(b, pb, near.places[1]),
        closing_speed: frame.closing_speed(near.points, normal),
        start: *start,
    }
}

/// The contact of a body inside the other: the vertex that shows it, and the nearest data that mean something.
pub(super) fn contained(
    scene: &Scene<'_>,
    motion: &RelativeMotion,
    a_is_inside: bool,
    vertex: u32,
    start: StartState,
) -> Contact {
    let frame = motion.frame::<Quad>(0.0);
    let (tree_a, tree_b) = (scene.a.0, scene.b.0);
    let holder = |tree: &MeshTree| {
        tree.mesh().triangles().iter().position(|t| t.contains(&vertex)).unwrap_or(0) as u32
    };
    let triangles = if a_is_inside { [holder(tree_a), 0] } else { [0, holder(tree_b)] };
    let corners =
        |tree: &MeshTree, triangle: u32| tree.mesh().corners(triangle as usize).map(|p| p - tree.center());
    let b = corners(tree_b, triangles[1]);
    let a = place_a::<Quad>(&frame, &corners(tree_a, triangles[0]));
    let near = closest::<Quad>(&a, &b);
    let time = scene.window.start();
    // The surfaces are further apart than the level, so rounding moves no vertex to the other side of one.
    let meeting = Meeting { time, evidence: Evidence::Crossing };
    describe(
        scene,
        (motion, &frame),
        time,
        &Witness { near, a, b, triangles, separation: 0.0, start, meeting },
    )
}

fn feature(scene: &Scene<'_>, near: &Closest, triangles: [u32; 2]) -> FeaturePair {
    let a = scene.a.0.mesh().triangles()[triangles[0] as usize];
    let b = scene.b.0.mesh().triangles()[triangles[1] as usize];
    let edge = |t: [u32; 3], k: usize| {
        let (p, q) = (t[k], t[(k + 1) % 3]);
        [p.min(q), p.max(q)]
    };
    match near.places {
        [Place::Edge(i), Place::Edge(j)] => FeaturePair::EdgeEdge { edge_a: edge(a, i), edge_b: edge(b, j) },
        [Place::Corner(i), _] => FeaturePair::VertexFace { vertex: a[i], face: triangles[1] },
        [_, Place::Corner(j)] => FeaturePair::FaceVertex { face: triangles[0], vertex: b[j] },
        // Faces only meet at the corners or edges of one of them: never produced.
        [Place::Face, _] => FeaturePair::FaceVertex { face: triangles[0], vertex: b[0] },
        [_, Place::Face] => FeaturePair::VertexFace { vertex: a[0], face: triangles[1] },
    }
}

/// Weights of the corners: not negative, sum one up to rounding.
fn barycentric(corners: &[DVec3; 3], point: DVec3, place: Place) -> [f64; 3] {
    let mut weights = [0.0; 3];
    match place {
        Place::Corner(i) => weights[i] = 1.0,
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
