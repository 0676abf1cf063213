//! How far apart are two bodies at rest?

use super::collide::{check_solid, crossing_pair};
use super::containment::one_holds_the_other;
use super::node_pair::{Scene, Step, child, gap_exceeds};
use crate::allowance::Allowance;
use crate::lanes::{Lanes, Task, run};
use crate::tree::margin::{UNIT_F64, round_up};
use crate::{PairCache, Posed, QueryError, Solid, StartState};
use d2m_feature::{TriangleDistance, triangle_distance};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Width of the enclosures of triangle distances that is expected, relative to the size of the scene; wider ones are
/// met and cost only the width of the answer.
const EXPECTED_WIDTH: f64 = 128.0 * UNIT_F64;

/// The distance of two bodies at rest, enclosed, with witnesses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Distance {
    /// The distance to rounding, in [`lower`, `upper`](Self::upper); 0 if the bodies are not proven apart.
    pub value: f64,
    /// Proven: the distance is at least this.
    pub lower: f64,
    /// Proven: the distance of the surfaces is at most this, and so is that of the bodies.
    pub upper: f64,
    /// Closest point on the surface of A, world frame, rounded.
    pub point_a: DVec3,
    /// Closest point on the surface of B, world frame, rounded.
    pub point_b: DVec3,
    /// Unit direction from A to B, world frame, along which they are that far apart; zero when `lower` is zero.
    pub normal: DVec3,
    /// Triangle of A that holds `point_a`.
    pub triangle_a: u32,
    /// Triangle of B that holds `point_b`.
    pub triangle_b: u32,
    /// `point_a` in the corners of `triangle_a`; each in [0, 1], sum one.
    pub barycentric_a: [f64; 3],
    /// `point_b` in the corners of `triangle_b`.
    pub barycentric_b: [f64; 3],
    /// `Apart`: proven (`lower` > 0). `Touching`: apart by less than can be proven, or just touching. `Overlapping`:
    /// the surfaces cross, up to rounding; points and triangles are those of one pair of many that cross, which depends on
    /// bodies and poses only. `Contained`: the surfaces are apart and one body is inside the other; then
    /// `value` and `lower` are zero, and points and triangles are those where the surfaces are closest.
    pub state: StartState,
}

/// Options of [`distance_within`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DistanceOptions {
    /// What the bodies are.
    pub solid: Solid,
    /// Distances above this are of no interest, and the search ends when that is proven.
    pub cutoff: f64,
}

impl Default for DistanceOptions {
    fn default() -> Self {
        Self { solid: Solid::Filled, cutoff: f64::INFINITY }
    }
}

impl DistanceOptions {
    /// With this meaning of the bodies.
    pub const fn with_solid(mut self, solid: Solid) -> Self {
        self.solid = solid;
        self
    }

    /// With this largest distance of interest.
    pub const fn with_cutoff(mut self, cutoff: f64) -> Self {
        self.cutoff = cutoff;
        self
    }
}

/// The distance of two bodies at rest, with witnesses. No tolerance: the enclosure is as tight as double precision
/// allows, usually within 300·2⁻⁵³ of the largest length.
///
/// ```
/// use d2m_bvh::{MeshTree, Posed, Solid, StartState, TriMesh, distance};
/// use d2m_motion::Pose;
/// use glam::{DQuat, DVec3};
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let above = Pose { translation: DVec3::Z * 1.25, ..Pose::IDENTITY };
/// let apart = distance(Posed::at_rest(&tree), Posed::new(&tree, above), Solid::Filled)?;
/// assert!(apart.lower <= 0.25 && 0.25 <= apart.upper && apart.upper - apart.lower < 2e-13);
/// assert_eq!(apart.state, StartState::Apart);
/// assert!((apart.point_a - DVec3::Z).length() < 1e-15 && (apart.normal - DVec3::Z).length() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QueryError::BadPose`], and [`QueryError::NotWatertight`] with [`Solid::Filled`].
pub fn distance(a: Posed<'_>, b: Posed<'_>, solid: Solid) -> Result<Distance, QueryError> {
    let options = DistanceOptions::default().with_solid(solid);
    let found = distance_within(a, b, &options, &mut PairCache::new())?;
    // Without a cutoff there is always a closest pair of triangles.
    found.ok_or(QueryError::BadPose { body: 0 })
}

/// As [`distance`], with a largest distance of interest and a warm start. `None` is a proof that the distance is more
/// than the cutoff.
///
/// # Errors
/// As [`distance`]; also [`QueryError::BadMinSeparation`] when the cutoff is negative or not a number.
pub fn distance_within(
    a: Posed<'_>,
    b: Posed<'_>,
    options: &DistanceOptions,
    cache: &mut PairCache,
) -> Result<Option<Distance>, QueryError> {
    check_solid(a, b, options.solid)?;
    if options.cutoff.is_nan() || options.cutoff < 0.0 {
        return Err(QueryError::BadMinSeparation { value: options.cutoff });
    }
    let scene = Scene::try_new(a, b)?;
    let counts = [a.body, b.body].map(|tree| tree.mesh().triangle_count());
    // Placed triangles with an upper bound above this are further apart than the cutoff, unless their enclosure is
    // wider than expected.
    let limit = (options.cutoff / scene.unit + scene.error + EXPECTED_WIDTH) * (1.0 + 4.0 * UNIT_F64);
    let first = cache.within(counts);
    let without_limit = || run(Search { scene: &scene, first, limit: f64::INFINITY });
    let found = match run(Search { scene: &scene, first, limit }) {
        Found::Unclear => without_limit(),
        Found::Pair(best) if best.distance.upper == 0.0 => Found::Pair(crossing(&scene, best)),
        found => found,
    };
    let state = match &found {
        Found::Pair(best) if best.distance.upper == 0.0 => StartState::Overlapping,
        Found::Pair(best) if best.lower <= scene.error => StartState::Touching,
        _ if options.solid == Solid::Filled && holds(&scene) => StartState::Contained,
        _ => StartState::Apart,
    };
    let found = match (found, state) {
        // The bodies meet although their surfaces are far from each other: look again without a limit.
        (Found::Beyond, StartState::Contained) => without_limit(),
        (found, _) => found,
    };
    let Found::Pair(best) = found else { return Ok(None) };
    cache.remember(best.triangles);
    let answer = describe(&scene, [a, b], &best, state);
    Ok((answer.lower <= options.cutoff).then_some(answer))
}

/// Does one body hold a part of the other? Without a limit on the work.
fn holds(scene: &Scene<'_>) -> bool {
    one_holds_the_other(scene, &mut Allowance::unlimited()) != Ok(None)
}

/// The closest pair of triangles, working units.
#[derive(Clone, Copy, Debug)]
struct Best {
    distance: TriangleDistance,
    triangles: [u32; 2],
    /// Lower bound over all pairs of placed triangles.
    lower: f64,
}

/// The pair that stands for all that cross, whichever of them was met first.
fn crossing(scene: &Scene<'_>, met: Best) -> Best {
    let [a, b] = crossing_pair(scene).unwrap_or(met.triangles);
    let distance = triangle_distance(&scene.place(0, a), &scene.place(1, b));
    Best { distance, triangles: [a, b], lower: 0.0 }
}

fn describe(scene: &Scene<'_>, bodies: [Posed<'_>; 2], best: &Best, state: StartState) -> Distance {
    let near = &best.distance;
    let apart = state == StartState::Apart;
    let lower = if apart { (best.lower - scene.error) * (1.0 - 2.0 * UNIT_F64) * scene.unit } else { 0.0 };
    let upper = (near.upper + scene.error) * (1.0 + 2.0 * UNIT_F64) * scene.unit;
    let point = |body: usize, weights: [f64; 3]| {
        let corners = bodies[body].body.mesh().corners(best.triangles[body] as usize);
        let mut pose = bodies[body].pose;
        pose.rotation = pose.rotation.normalize();
        pose.transform_point(corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2])
    };
    let normal = if apart {
        (bodies[1].pose.rotation.normalize() * near.direction).normalize_or_zero()
    } else {
        DVec3::ZERO
    };
    Distance {
        value: if apart { (0.5 * (near.lower + near.upper) * scene.unit).clamp(lower, upper) } else { 0.0 },
        lower,
        upper,
        point_a: point(0, near.barycentric_a),
        point_b: point(1, near.barycentric_b),
        normal,
        triangle_a: best.triangles[0],
        triangle_b: best.triangles[1],
        barycentric_a: near.barycentric_a,
        barycentric_b: near.barycentric_b,
        state,
    }
}

/// What a search finds.
#[derive(Clone, Copy, Debug)]
enum Found {
    Pair(Best),
    /// Every pair is proven to be further apart than the limit less the expected width.
    Beyond,
    /// The enclosure of a pair straddles the limit: without a limit there is an answer.
    Unclear,
}

/// Best first over pairs of boxes.
///
/// The answer is the pair of triangles with the least (computed upper bound, numbers). A pair is left out only when it
/// is proven that its computed bound is more than the best one so far; so neither the order of the search nor the pair
/// that is looked at first has any influence on the answer. Where triangles cross, their bound is zero: the search ends with the first
/// such pair, and another, in a fixed order, chooses the one that is told.
struct Search<'a> {
    scene: &'a Scene<'a>,
    first: Option<[u32; 2]>,
    limit: f64,
}

/// State of a search: the best pair so far.
struct Closest<'a> {
    scene: &'a Scene<'a>,
    best: Option<Best>,
    /// Upper bound of the best pair, or the limit.
    upper: f64,
    /// Rounded up: pairs of boxes at more than this are left out.
    upper_key: f32,
    /// Least lower bound of a pair whose enclosure was wider than expected.
    loose: f64,
    /// The best pair's own direction; before there is one, from centre to centre.
    along: [[f32; 3]; 2],
}

impl Closest<'_> {
    #[inline(always)]
    /// True if the pair is closer than all so far.
    fn compare(&mut self, triangles: [u32; 2]) -> bool {
        let (a, b) = (self.scene.place(0, triangles[0]), self.scene.place(1, triangles[1]));
        if let Some(best) = &self.best {
            // Along the best pair's own direction: most of its neighbours are left out by this.
            if gap_exceeds(best.distance.direction, &a, &b, self.upper + self.scene.projection) {
                return false;
            }
        }
        let distance = triangle_distance(&a, &b);
        if distance.upper - distance.lower > EXPECTED_WIDTH {
            self.loose = self.loose.min(distance.lower);
        }
        let better = match &self.best {
            _ if distance.upper > self.upper => false,
            None => true,
            Some(best) => (distance.upper, triangles) < (best.distance.upper, best.triangles),
        };
        if better {
            self.best = Some(Best { distance, triangles, lower: 0.0 });
            self.upper = distance.upper;
            self.upper_key = round_up(distance.upper);
            if distance.lower > 0.0 {
                self.along = self.scene.directions(distance.direction);
            }
        }
        better
    }
}

/// A pair of boxes in the queue: keys are not negative, so their bits are in the order of the numbers.
#[inline(always)]
fn item(key: f32, pair: [u32; 2]) -> Reverse<u128> {
    Reverse(u128::from(key.to_bits()) << 64 | u128::from(pair[0]) << 32 | u128::from(pair[1]))
}

impl Task for Search<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Found {
        let scene = self.scene;
        let upper = self.limit;
        let along = scene.directions(scene.pose.offset);
        let upper_key = round_up(upper);
        let mut closest = Closest { scene, best: None, upper, upper_key, loose: f64::INFINITY, along };
        if let Some(triangles) = self.first {
            closest.compare(triangles);
        }
        let mut queue = BinaryHeap::with_capacity(512);
        let mut next = Some((0.0f32, [0u32; 2]));
        // Descend greedily to a pair of triangles, as long as that is closer than the one before; then best first.
        let mut descending = closest.best.is_none();
        loop {
            let (key, pair) = match next.take() {
                Some(found) => found,
                None => match queue.pop() {
                    Some(Reverse(packed)) => {
                        (f32::from_bits((packed >> 64) as u32), [(packed >> 32) as u32, packed as u32])
                    }
                    None => break,
                },
            };
            if key > closest.upper_key || closest.upper == 0.0 {
                break;
            }
            match scene.step(pair) {
                Step::Open(wide, node) => {
                    let (bounds, used) = scene.bounds::<L>(wide, node, pair[1 - wide], &closest.along);
                    let mut least: Option<(f32, [u32; 2])> = None;
                    for (lane, &bound) in bounds[..used].iter().enumerate() {
                        // Also when the bound is not a number.
                        let bound = if bound > key { bound } else { key };
                        if bound > closest.upper_key {
                            continue;
                        }
                        let found = (bound, child(pair, wide, node, lane));
                        match &mut least {
                            Some(so_far) if descending => {
                                let (keep, push) =
                                    if found.0 < so_far.0 { (found, *so_far) } else { (*so_far, found) };
                                *so_far = keep;
                                queue.push(item(push.0, push.1));
                            }
                            _ if descending => least = Some(found),
                            _ => queue.push(item(found.0, found.1)),
                        }
                    }
                    next = least;
                }
                Step::Compare(triangles) => {
                    // On as long as it pays: each closer pair has a better direction for all that follow.
                    descending = closest.compare(triangles);
                }
            }
        }
        let loose = closest.loose;
        match closest.best {
            Some(best) => {
                let lower = (best.distance.upper - EXPECTED_WIDTH).min(loose).max(0.0);
                Found::Pair(Best { lower: lower * (1.0 - 2.0 * UNIT_F64), ..best })
            }
            None if loose <= self.limit => Found::Unclear,
            None => Found::Beyond,
        }
    }
}
