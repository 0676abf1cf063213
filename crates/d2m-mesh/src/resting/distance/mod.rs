//! How far apart are two bodies at rest?

mod best;
mod hulls;
mod queue;
mod search;
#[cfg(test)]
mod tests;

use super::collide::{check_solids, crossing_pair_within};
use super::containment::one_holds_the_other;
use super::node_pair::RestingScene;
use super::touching::{Meeters, Meeting};
use crate::margin::UNIT_F64;
use crate::meter::{Exhausted, Meter};
use crate::{Budget, Posed, QueryError, Solid, StartState};
use best::{Best, EXPECTED_WIDTH};
use d2m_feature::triangle_distance;
use d2m_lanes::run;
use glam::DVec3;
use search::{Found, Search};

/// The distance of two bodies at rest, enclosed, with witnesses.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Posed, Solid, StartState, distance};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 1.5, ..Pose::IDENTITY });
/// let apart = distance(Posed::at_rest(&tree), above, Solid::Filled)?;
/// assert!(apart.lower <= apart.value && apart.value <= apart.upper && (apart.value - 0.5).abs() < 1e-12);
/// assert!((apart.point_a - DVec3::Z).length() < 1e-12 && (apart.normal - DVec3::Z).length() < 1e-12);
/// assert_eq!(apart.state, StartState::Apart);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    /// Unit direction from A to B, world frame: along which they are that far apart; of bodies that touch, along which they part. Zero
    /// for bodies that are not proven to do either.
    pub normal: DVec3,
    /// Triangle of A that holds `point_a`.
    pub triangle_a: u32,
    /// Triangle of B that holds `point_b`.
    pub triangle_b: u32,
    /// Barycentric coordinates of `point_a` in `triangle_a`; each in [0, 1], sum one.
    pub barycentric_a: [f64; 3],
    /// Barycentric coordinates of `point_b` in `triangle_b`.
    pub barycentric_b: [f64; 3],
    /// `Apart`: proven (`lower` > 0). `Touching`, `Overlapping`, `Undecided`: as [`StartState`] says; `value` and `lower` are zero, points
    /// and triangles those of one pair of many that touch or cross, which depends on bodies and poses only. `Contained`: the surfaces are
    /// apart and one body is inside the other; then `value` and `lower` are zero, and points and triangles are those where the surfaces are
    /// closest.
    pub state: StartState,
}

/// Options of [`distance_within`].
///
/// ```
/// use d2m_mesh::{DistanceOptions, Solid};
/// let options = DistanceOptions::default().with_cutoff(0.5).with_solid(Solid::Surface);
/// assert_eq!((options.cutoff, options.solids), (0.5, [Solid::Surface; 2]));
/// // A sheet may be inside of a filled body: then their distance is zero.
/// assert_eq!(options.with_solids([Solid::Filled, Solid::Surface]).solids[0], Solid::Filled);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct DistanceOptions {
    /// What A and B are: what a filled one holds has the distance zero of it.
    pub solids: [Solid; 2],
    /// Distances above this are of no interest, and the search ends when that is proven.
    pub cutoff: f64,
    /// Triangles of A and of B that are compared first, those of the last query of the pair, say: the search is shorter where they are
    /// close. The answer does not depend on them. Numbers that the bodies do not have count as none.
    pub first: Option<[u32; 2]>,
}

impl Default for DistanceOptions {
    fn default() -> Self {
        Self { solids: [Solid::Filled; 2], cutoff: f64::INFINITY, first: None }
    }
}

impl DistanceOptions {
    /// With this meaning of both bodies.
    pub const fn with_solid(self, solid: Solid) -> Self {
        self.with_solids([solid; 2])
    }

    /// With this meaning of A and of B.
    pub const fn with_solids(mut self, solids: [Solid; 2]) -> Self {
        self.solids = solids;
        self
    }

    /// With this largest distance of interest.
    pub const fn with_cutoff(mut self, cutoff: f64) -> Self {
        self.cutoff = cutoff;
        self
    }

    /// With these triangles first.
    pub const fn with_first(mut self, triangles: Option<[u32; 2]>) -> Self {
        self.first = triangles;
        self
    }
}

/// The distance of two bodies at rest, with witnesses. No tolerance: the enclosure is as tight as the roundings of placing
/// the bodies allow. With L the sum of the lengths that enter – the radii of both bodies, the distances of their centers from the
/// reference points of their poses, and the distance between the two reference points in the world – its width is below
/// 2200·2⁻⁵³ L, and below 700·2⁻⁵³ L where both rotations are the same (measured; a test holds it to that). So a mesh whose
/// coordinates are 1500 away from the origin of its frame has an enclosure of some 1e-10 however small it is, unless the pose's
/// reference point is near it. Where in the world both bodies are does not matter. Of lengths below 2⁻⁴⁵⁰ underflow takes a part: the
/// enclosure is wider there, and still holds.
///
/// ```
/// use d2m_mesh::{MeshTree, Posed, Solid, StartState, TriMesh, distance};
/// use d2m_motion::Pose;
/// use glam::{DQuat, DVec3};
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
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
pub fn distance(a: Posed<'_>, b: Posed<'_>, solids: impl Into<[Solid; 2]>) -> Result<Distance, QueryError> {
    let options = DistanceOptions::default().with_solids(solids.into());
    let found = distance_within(a, b, &options)?;
    // Without a cutoff there is always a closest pair of triangles.
    found.ok_or(QueryError::BadPose { body: 0 })
}

/// As [`distance`], with a largest distance of interest and a warm start. `None` is a proof that the distance is more
/// than the cutoff.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{DistanceOptions, Posed, distance_within};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 1.5, ..Pose::IDENTITY });
/// let near = DistanceOptions::default().with_cutoff(0.25);
/// assert_eq!(distance_within(Posed::at_rest(&tree), above, &near)?, None); // it is 0.5
/// let far = DistanceOptions::default().with_cutoff(1.0);
/// assert!(distance_within(Posed::at_rest(&tree), above, &far)?.is_some_and(|found| found.upper < 0.51));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`distance`]; also [`QueryError::BadMinSeparation`] when the cutoff is negative or not a number.
pub fn distance_within(
    a: Posed<'_>,
    b: Posed<'_>,
    options: &DistanceOptions,
) -> Result<Option<Distance>, QueryError> {
    check_solids(a, b, options.solids)?;
    if options.cutoff.is_nan() || options.cutoff < 0.0 {
        return Err(QueryError::BadMinSeparation { value: options.cutoff });
    }
    let scene = RestingScene::try_new(a, b)?;
    let counts = [a.body, b.body].map(|tree| tree.mesh().triangle_count());
    // Placed triangles with an upper bound above this are further apart than the cutoff, unless their enclosure is
    // wider than expected.
    let limit = (options.cutoff / scene.unit + scene.error + EXPECTED_WIDTH) * (1.0 + 4.0 * UNIT_F64);
    // Of a body that is one point up to rounding the first triangle stands for all, whichever comes first.
    let first = options
        .first
        .filter(|triangles| [0, 1].iter().all(|&k| (triangles[k] as usize) < counts[k]))
        .map(|triangles| [0, 1].map(|k| if scene.is_point_like(k) { 0 } else { triangles[k] }));
    let unlimited = &mut Meter::unlimited();
    let mut search = |limit: f64| run(Search { scene: &scene, first, limit, slack: 0.0, meter: unlimited });
    let found = match search(limit) {
        Found::Unclear => search(f64::INFINITY),
        found => found,
    };
    let found = crossing(&scene, found, unlimited);
    let meeting = match &found {
        Found::Pair(best) if !best.is_apart(&scene) => Some(meeting(&[a, b], options.solids, unlimited)?),
        _ => None,
    };
    let state = match &meeting {
        Some(meeting) => meeting.state(),
        None if holds(&scene, options.solids, unlimited) != Ok(false) => StartState::Contained,
        None => StartState::Apart,
    };
    let found = match (found, state) {
        // The bodies meet although their surfaces are far from each other: search again without a limit.
        (Found::Beyond, StartState::Contained) => {
            run(Search { scene: &scene, first, limit: f64::INFINITY, slack: 0.0, meter: unlimited })
        }
        (found, _) => found,
    };
    let Found::Pair(best) = found else {
        #[cfg(feature = "audit")]
        conclude([a, b], options.cutoff, None);
        return Ok(None);
    };
    let answer = describe(&scene, [a, b], &best, state);
    let answer = meeting.map_or(answer, |meeting| answer.meeting_so(&scene, [a, b], &meeting));
    #[cfg(feature = "audit")]
    conclude([a, b], answer.lower.next_down(), Some(&answer));
    Ok((answer.lower <= options.cutoff).then_some(answer))
}

/// The surfaces are further apart than this; and those of two triangles no further than their distance.
#[cfg(feature = "audit")]
fn conclude(bodies: [Posed<'_>; 2], lower: f64, found: Option<&Distance>) {
    use super::concluded::conclude_at_rest;
    use crate::audit::{Part, Place, Promise};
    conclude_at_rest(Place::Resting, Promise::Apart, bodies, [Part::Whole; 2], lower);
    if let Some(found) = found {
        let parts = [found.triangle_a, found.triangle_b].map(Part::Triangle);
        conclude_at_rest(Place::Resting, Promise::Meets, bodies, parts, found.upper);
    }
}

/// What is proven of a distance: all of it, or what a budget allowed.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Budget, Posed, Solid, bound_distance};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 1.5, ..Pose::IDENTITY });
/// let budget = Budget::UNLIMITED.with_node_tests(1);
/// let bounds = bound_distance(Posed::at_rest(&tree), above, Solid::Filled, &budget)?;
/// assert!(0.0 <= bounds.lower && bounds.lower <= 0.5 && 0.5 <= bounds.upper && bounds.upper.is_finite());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct DistanceBounds {
    /// Proven: the distance is at least this.
    pub lower: f64,
    /// Proven: the distance is at most this; finite.
    pub upper: f64,
    /// Point on the surface of A, world frame, rounded. Of the closest pair met so far: `upper` is their distance to rounding.
    pub point_a: DVec3,
    /// Point on the surface of B, world frame, rounded.
    pub point_b: DVec3,
    /// Triangle of A that holds `point_a`.
    pub triangle_a: u32,
    /// Triangle of B that holds `point_b`.
    pub triangle_b: u32,
    /// The distance with witnesses, when the budget sufficed; `lower`, `upper`, points and triangles are its own then.
    pub distance: Option<Distance>,
}

/// As [`distance`] within a budget. When it runs out, what is proven so far is the answer: an interval that holds the
/// distance, with a `lower` of zero where it is not even proven that the bodies are apart, and the two points that prove `upper`.
///
/// ```
/// use d2m_mesh::{Budget, MeshTree, Posed, Solid, TriMesh, bound_distance};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 1.25, ..Pose::IDENTITY });
/// let within = |tests: u64| {
///     let budget = Budget::UNLIMITED.with_node_tests(tests);
///     bound_distance(Posed::at_rest(&tree), above, Solid::Filled, &budget)
/// };
/// let enough = within(1000)?;
/// assert!(enough.distance.is_some() && enough.upper - enough.lower < 2e-13);
/// let nothing = within(0)?;
/// assert!(nothing.distance.is_none() && nothing.lower <= 0.25 && 0.25 <= nothing.upper);
/// assert!((nothing.point_a.distance(nothing.point_b) - nothing.upper).abs() < 1e-13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`distance`].
pub fn bound_distance(
    a: Posed<'_>,
    b: Posed<'_>,
    solids: impl Into<[Solid; 2]>,
    budget: &Budget,
) -> Result<DistanceBounds, QueryError> {
    bound_distance_metered([a, b], solids.into(), &mut Meter::new(budget))
}

/// As [`bound_distance`], with what a meter has left.
///
/// ```
/// use d2m_mesh::at_rest::bound_distance_metered;
/// use d2m_mesh::{Budget, MeshTree, Meter, Posed, Solid, TriMesh};
/// use glam::DVec3;
/// let points = [0.0, 2.0].map(|x| TriMesh::point(DVec3::X * x).map(MeshTree::new));
/// let [a, b] = points;
/// let (a, b) = (a?, b?);
/// let mut meter = Meter::new(&Budget::UNLIMITED);
/// let found = bound_distance_metered([Posed::at_rest(&a), Posed::at_rest(&b)], [Solid::Surface; 2], &mut meter)?;
/// assert!(found.lower <= 2.0 && 2.0 <= found.upper && found.distance.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`distance`].
pub fn bound_distance_metered(
    [a, b]: [Posed<'_>; 2],
    solids: [Solid; 2],
    meter: &mut Meter,
) -> Result<DistanceBounds, QueryError> {
    check_solids(a, b, solids)?;
    let scene = RestingScene::try_new(a, b)?;
    // Some pair is compared before the budget counts, so there always is an upper bound.
    let first = Some([0, 0]);
    let found = run(Search { scene: &scene, first, limit: f64::INFINITY, slack: 0.0, meter });
    let found = crossing(&scene, found, meter);
    let is_apart = match &found {
        Found::Pair(best) | Found::Exhausted(best) if best.is_apart(&scene) => holds(&scene, solids, meter),
        _ => Ok(false),
    };
    let (best, is_complete) = match found {
        Found::Pair(best) => (best, is_apart.is_ok()),
        Found::Exhausted(best) => (best, false),
        // Without a limit there is always a closest pair of triangles.
        Found::Beyond | Found::Unclear => return Err(QueryError::BadPose { body: 0 }),
    };
    let meeting = if best.is_apart(&scene) { None } else { Some(meeting(&[a, b], solids, meter)?) };
    let state = match (&meeting, is_apart) {
        (Some(meeting), _) => meeting.state(),
        (None, Ok(true)) => StartState::Contained,
        // Not known to be apart: nothing is said of it but the bounds.
        (None, Err(Exhausted)) => StartState::Undecided,
        (None, Ok(false)) => StartState::Apart,
    };
    let answer = describe(&scene, [a, b], &best, state);
    let answer = meeting.map_or(answer, |meeting| answer.meeting_so(&scene, [a, b], &meeting));
    let Distance { lower, upper, point_a, point_b, triangle_a, triangle_b, .. } = answer;
    let is_decided = answer.state != StartState::Undecided || !meter.is_exhausted();
    let distance = (is_complete && is_decided).then_some(answer);
    Ok(DistanceBounds { lower, upper, point_a, point_b, triangle_a, triangle_b, distance })
}

/// How close a pair is sought.
///
/// ```
/// // In at most 32 steps a pair that is the closest one but for an eighth of its distance.
/// let nearness = d2m_mesh::at_rest::Nearness { steps: 32, slack: 0.125 };
/// assert!(nearness.slack < 1.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Nearness {
    /// Steps at most.
    pub steps: u64,
    /// The part of its distance by which another pair may be closer; zero: the closest one is sought.
    pub slack: f64,
}

/// A pair of triangles that are close to each other, as far as the steps suffice. `first`: a pair that is compared first.
///
/// ```
/// use d2m_mesh::at_rest::{Nearness, near_pair};
/// use d2m_mesh::{MeshTree, Posed, TriMesh};
/// use glam::DVec3;
/// // Two plates at heights 0 and 1, and a point above them.
/// let plates = [0.0, 1.0].map(|z| [DVec3::Z * z, DVec3::X + DVec3::Z * z, DVec3::Y + DVec3::Z * z]).concat();
/// let plates = MeshTree::new(TriMesh::try_new(plates, vec![[0, 1, 2], [3, 4, 5]])?);
/// let point = MeshTree::new(TriMesh::point(DVec3::Z * 3.0)?);
/// let closest = Nearness { steps: 100, slack: 0.0 };
/// assert_eq!(near_pair(Posed::at_rest(&plates), Posed::at_rest(&point), None, closest)?, Some([1, 0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QueryError::BadPose`].
pub fn near_pair(
    a: Posed<'_>,
    b: Posed<'_>,
    first: Option<[u32; 2]>,
    Nearness { steps, slack }: Nearness,
) -> Result<Option<[u32; 2]>, QueryError> {
    let scene = RestingScene::try_new(a, b)?;
    let first = first.map(|pair| [0, 1].map(|k| if scene.is_point_like(k) { 0 } else { pair[k] }));
    let meter = &mut Meter::unlimited().at_most(steps);
    Ok(match run(Search { scene: &scene, first, limit: f64::INFINITY, slack, meter }) {
        Found::Pair(best) | Found::Exhausted(best) => Some(best.triangles),
        Found::Beyond | Found::Unclear => None,
    })
}

/// How bodies meet that are not proven apart. What is apart by little more than that is still not proven to touch.
fn meeting<'a>(
    bodies: &[Posed<'a>; 2],
    solids: [Solid; 2],
    meter: &mut Meter,
) -> Result<Meeting<'a>, QueryError> {
    let meeters = Meeters { bodies: *bodies, solids, blur: 0.0, patience: MOST_TESTS_BESIDE_A_CROWD };
    let meeting = meeters.meeting(meter)?;
    Ok(meeting.unwrap_or(Meeting::Undecided))
}

/// Does one body that is filled hold a part of the other?
fn holds(scene: &RestingScene<'_>, solids: [Solid; 2], meter: &mut Meter) -> Result<bool, Exhausted> {
    Ok(one_holds_the_other(scene, solids, meter)?.is_some())
}

/// Tests for a crossing beside a crowd of pairs that touch: some milliseconds. More of them, and the bodies count as touching.
const MOST_TESTS_BESIDE_A_CROWD: u64 = 1 << 16;

/// Where triangles cross, the pair that stands for all that do, whichever of them was met first.
fn crossing(scene: &RestingScene<'_>, found: Found, meter: &mut Meter) -> Found {
    let Found::Pair(met) = found else { return found };
    if met.distance.upper > 0.0 {
        return found;
    }
    let [a, b] = match crossing_pair_within(scene, meter) {
        Ok(pair) => pair.unwrap_or(met.triangles),
        Err(Exhausted) => return Found::Exhausted(met),
    };
    let distance = triangle_distance(&scene.place(0, a), &scene.place(1, b));
    Found::Pair(Best { distance, triangles: [a, b], lower: 0.0 })
}

impl Distance {
    /// Of bodies that meet so: the normal, points and triangles where they touch, or triangles that are proven to cross.
    fn meeting_so(self, scene: &RestingScene<'_>, bodies: [Posed<'_>; 2], meeting: &Meeting<'_>) -> Self {
        let (triangles, normal) = match meeting {
            Meeting::Touching(touch) => (touch.triangles, touch.normal),
            Meeting::Overlapping(Some(triangles)) => (*triangles, DVec3::ZERO),
            Meeting::Overlapping(None) | Meeting::Holding(_) | Meeting::Undecided => return self,
        };
        let [a, b] = triangles;
        let distance = triangle_distance(&scene.place(0, a), &scene.place(1, b));
        let best = Best { distance, triangles, lower: 0.0 };
        Self { normal, upper: self.upper, ..describe(scene, bodies, &best, self.state) }
    }
}

fn describe(scene: &RestingScene<'_>, bodies: [Posed<'_>; 2], best: &Best, state: StartState) -> Distance {
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
