//! All locally closest features of two bodies at rest: the contact manifold before reduction.
//!
//! **What is found.** A pair of points p of A and q of B is *locally closest* when the direction n = (q − p)/|q − p| is
//! in the normal cone of A at p and −n in that of B at q: no point of A next to p is nearer to q, and no point of B next
//! to q is nearer to p. Each point is on one *feature*, the vertex, the interior of an edge or the interior of a face.
//!
//! ```text
//!        n ↑  normal cone of a vertex: n·e ≤ 0 for each edge e at it
//!        \ | /                of an edge: n ⟂ edge, n·w ≤ 0 for each triangle's third corner, w from the edge
//!         \|/                 of a face: both directions of its normal (surfaces have no inside)
//!      ____•____
//! ```
//!
//! **Why no pair is lost.** The descent drops a pair of boxes only when they are proven further apart than the margin, or apart and
//! without a direction from one to the other that cones about the normals of both allow (`facing`). A
//! vertex or edge is tested by the lowest-numbered triangle that holds it, its *owner*; the owners of two features
//! within the margin are within the margin themselves, so the descent meets them, and exactly once. All tests are
//! relaxed by δ, the proven bound on where placed points are (`RestingScene::error`): a foot may be 8δ outside of its feature,
//! a direction may leave a cone by the angle 8δ/d + 16u, where d is the distance, and the ends of vectors may be off by
//! 2δ. Twins that the relaxed tests let through on neighbouring features have points within 32δ of each other; one
//! of them is kept.

mod candidate;
mod facing;
mod feature_test;
mod manifold;
#[cfg(test)]
mod tests;

pub use manifold::reduce_proximities;

use super::node_pair::{Directions, RestingScene, Step, Wanted, child, proven_apart};
use super::touching::{Meeters, Meeting};
use crate::margin::{UNIT_F64, round_up};
use crate::meter::Meter;
use crate::{Budget, Posed, QueryError, Solid};
use candidate::{Candidate, without_twins};
use d2m_feature::FeaturePair;
use d2m_lanes::{Lanes, Task, run};
use facing::Facing;
use feature_test::FeatureTest;
use glam::DVec3;

/// Two features of two bodies at rest that are locally closest to each other.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Posed, proximities};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 1.01, ..Pose::IDENTITY });
/// let near = proximities(Posed::at_rest(&tree), above, 0.1)?;
/// let closest = near.first().expect("the tip is 0.01 below the other body");
/// assert!((closest.distance - 0.01).abs() < 1e-12 && (closest.normal - DVec3::Z).length() < 1e-9);
/// assert!((closest.point_a - DVec3::Z).length() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Proximity {
    /// The features, by ids in the meshes; vertices by the lowest id at their position. A vertex closest to an edge or
    /// to another vertex is reported with the lowest-numbered face that holds it.
    pub feature: FeaturePair,
    /// Triangle of A that holds `point_a`.
    pub triangle_a: u32,
    /// Triangle of B that holds `point_b`.
    pub triangle_b: u32,
    /// Distance of the two points, to rounding.
    pub distance: f64,
    /// How far the direction is outside of the normal cones, the sine of an angle: zero for what is locally closest to
    /// rounding, at most [`ProximityOptions::cone_slack`] for what that lets in besides.
    pub tilt: f64,
    /// Unit direction from A to B, world frame.
    pub normal: DVec3,
    /// Point on A, world frame, rounded.
    pub point_a: DVec3,
    /// Point on B, world frame, rounded.
    pub point_b: DVec3,
}

/// Options of [`proximities_with`].
///
/// ```
/// let options = d2m_mesh::ProximityOptions::new(0.01).with_cone_slack(0.1);
/// assert_eq!((options.margin, options.cone_slack), (0.01, 0.1)); // a length; the sine of an angle
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct ProximityOptions {
    /// Features up to this distance are found.
    pub margin: f64,
    /// How far a direction may be outside of a normal cone, as the sine of an angle. Zero, the default: the locally
    /// closest pairs and those that rounding does not distinguish from them. A tenth of a radian, say: also the other corners of a
    /// box that rests on a face and is tilted by less.
    pub cone_slack: f64,
}

impl ProximityOptions {
    /// Locally closest features within this distance.
    pub const fn new(margin: f64) -> Self {
        Self { margin, cone_slack: 0.0 }
    }

    /// With this slack of the normal cones, the sine of an angle.
    pub const fn with_cone_slack(mut self, sine: f64) -> Self {
        self.cone_slack = sine;
        self
    }
}

/// Every locally closest pair of features of two bodies at rest within `margin`, ordered by distance.
///
/// Promise: complete with respect to rounding. Each pair of points p of A and q of B, |p − q| ≤ `margin`, whose direction
/// is in both normal cones is found, once, whichever triangles hold it, and each pair of features once; what is found besides is locally closest up to
/// the rounding of the poses. Where faces or edges are parallel, the places of equal distance are
/// represented by the vertices over faces and by the crossings of edges among them, so the corners of the patch of
/// contact are all there. Only surfaces count: both sides of a face are outside. Bodies whose radius is below 2⁻⁵¹ of the
/// scene's size are one point.
///
/// Surfaces that touch are answered as those of the same bodies parted by some roundings along the normal of the contact, with
/// distances as they were.
///
/// The first call for a tree finds the neighbors of its vertices and edges, about 0.1 µs a triangle; the tree and its clones keep
/// them (they count in [`MeshTree::memory_bytes`](crate::MeshTree::memory_bytes)), so later calls do not pay for them.
///
/// ```
/// use d2m_mesh::{MeshTree, Posed, TriMesh, proximities};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let quad = |half: f64| {
///     let corner = |x: f64, y: f64| DVec3::new(x * half, y * half, 0.0);
///     let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
///     MeshTree::new(TriMesh::try_new(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap())
/// };
/// let (floor, card) = (quad(5.0), quad(1.0));
/// let above = Pose { translation: DVec3::new(0.25, 0.0, 0.001), ..Pose::IDENTITY };
/// let near = proximities(Posed::at_rest(&floor), Posed::new(&card, above), 0.01)?;
/// // The four corners of the card; its sides that cross the floor's diagonal, and diagonals alike.
/// let corners = near.iter().filter(|p| (p.point_b - above.translation).abs().min_element() < 1e-3
///     && ((p.point_b.x - 0.25).abs() - 1.0).abs() < 1e-12 && (p.point_b.y.abs() - 1.0).abs() < 1e-12);
/// assert_eq!(corners.count(), 4);
/// assert!(near.iter().all(|p| (p.distance - 0.001).abs() < 1e-14 && (p.normal - DVec3::Z).length() < 1e-14));
/// assert_eq!(d2m_mesh::reduce_proximities(&near, 0.1).len(), 4);
/// # Ok::<(), d2m_mesh::QueryError>(())
/// ```
///
/// # Errors
/// [`QueryError::BadPose`]; [`QueryError::BadMinSeparation`] for a margin that is negative or not finite;
/// [`QueryError::NotApart`] when the surfaces cross, or are apart by no more than rounding and not found to touch.
pub fn proximities(a: Posed<'_>, b: Posed<'_>, margin: f64) -> Result<Vec<Proximity>, QueryError> {
    proximities_with(a, b, &ProximityOptions::new(margin))
}

/// As [`proximities`], with normal cones as wide as wanted.
///
/// ```
/// use d2m_mesh::{MeshTree, Posed, ProximityOptions, TriMesh, proximities_with};
/// use d2m_motion::Pose;
/// use glam::{DQuat, DVec3};
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
/// let card = MeshTree::new(TriMesh::try_new(corners.clone(), vec![[0, 1, 2]])?);
/// let floor = corners.iter().map(|p| p * 50.0 - DVec3::new(9.0, 9.0, 0.0)).collect();
/// let floor = MeshTree::new(TriMesh::try_new(floor, vec![[0, 1, 2]])?);
/// let tilted = Pose { rotation: DQuat::from_xyzw(1e-3, 2e-3, 0.0, 1.0), translation: DVec3::Z * 0.1, at: DVec3::ZERO };
/// let near = |slack: f64| {
///     let options = ProximityOptions::new(1.0).with_cone_slack(slack);
///     proximities_with(Posed::at_rest(&floor), Posed::new(&card, tilted), &options)
/// };
/// assert_eq!(near(0.0)?.len(), 1);
/// assert_eq!(near(0.05)?.len(), 3);
/// assert_eq!(near(0.05)?.iter().filter(|p| p.tilt == 0.0).count(), 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`proximities`]; [`QueryError::BadMinSeparation`] for a bad `cone_slack` too.
pub fn proximities_with(
    a: Posed<'_>,
    b: Posed<'_>,
    options: &ProximityOptions,
) -> Result<Vec<Proximity>, QueryError> {
    // Without a limit there always is an answer.
    Ok(proximities_within(a, b, options, &Budget::UNLIMITED)?.unwrap_or_default())
}

/// As [`proximities_with`] within a budget; `None`: it ran out, and nothing is known.
///
/// ```
/// use d2m_mesh::{Budget, MeshTree, Posed, ProximityOptions, TriMesh, proximities_within};
/// use glam::DVec3;
/// let card = |height: f64| {
///     let corners = [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p + DVec3::Z * height).to_vec();
///     TriMesh::try_new(corners, vec![[0, 1, 2]]).map(MeshTree::new)
/// };
/// let (low, high) = (card(0.0)?, card(0.1)?);
/// let near = |tests: u64| {
///     let budget = Budget::UNLIMITED.with_node_tests(tests);
///     proximities_within(Posed::at_rest(&low), Posed::at_rest(&high), &ProximityOptions::new(0.2), &budget)
/// };
/// assert_eq!(near(0)?, None);
/// assert!(near(100)?.is_some_and(|near| near.len() >= 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`proximities_with`].
pub fn proximities_within(
    a: Posed<'_>,
    b: Posed<'_>,
    options: &ProximityOptions,
    budget: &Budget,
) -> Result<Option<Vec<Proximity>>, QueryError> {
    for value in [options.margin, options.cone_slack] {
        if !(value.is_finite() && value >= 0.0) {
            return Err(QueryError::BadMinSeparation { value });
        }
    }
    let scene = RestingScene::try_new(a, b)?;
    // Placed points of features within the margin are no further apart than this; 1 + 4u for its own roundings.
    let limit = (options.margin / scene.unit + scene.error) * (1.0 + 4.0 * UNIT_F64);
    let test = FeatureTest::new(&scene, limit, options.cone_slack);
    let meter = &mut Meter::new(budget);
    let search = Search {
        scene: &scene,
        test,
        limit,
        cone_slack: options.cone_slack,
        meter,
        #[cfg(feature = "audit")]
        asked: ([a, b], options.margin),
    };
    match run(search) {
        Found::Exhausted => Ok(None),
        Found::NotApart(triangles) => of_touching([a, b], options, meter, triangles),
        Found::Candidates(found) => {
            let found = without_twins(found, TWIN_ERRORS * scene.error);
            Ok(Some(found.iter().map(|candidate| describe(&scene, [a, b], candidate)).collect()))
        }
    }
}

/// Node tests of each part of the decision whether bodies touch.
const PATIENCE: u64 = 1 << 14;

/// The features of bodies that touch: those of the same bodies parted by some roundings, nearer by what they rise along the normals.
fn of_touching(
    bodies: [Posed<'_>; 2],
    options: &ProximityOptions,
    meter: &mut Meter,
    [triangle_a, triangle_b]: [u32; 2],
) -> Result<Option<Vec<Proximity>>, QueryError> {
    // Surfaces have no inside, and what is in the other body has closest features, too.
    let meeters = Meeters { bodies, solids: [Solid::Surface; 2], blur: 0.0, patience: PATIENCE };
    let meeting = meeters.meeting(meter)?;
    let Some(Meeting::Touching(touch)) = meeting else {
        return Err(QueryError::NotApart { triangle_a, triangle_b });
    };
    let parted = touch.parted_by;
    let within = ProximityOptions { margin: options.margin + parted, ..*options };
    let [a, b] = touch.moved;
    let Some(mut found) = proximities_within(a, b, &within, &meter.rest())? else { return Ok(None) };
    for proximity in &mut found {
        let nearer = parted * proximity.normal.dot(touch.normal);
        proximity.distance = (proximity.distance - nearer).max(0.0);
    }
    found.retain(|proximity| proximity.distance <= options.margin);
    Ok(Some(found))
}

/// Points of twins are this many errors apart at most: each foot is within 8δ of its feature, on either body, and both
/// are seen from each other's place.
const TWIN_ERRORS: f64 = 32.0;

fn describe(scene: &RestingScene<'_>, bodies: [Posed<'_>; 2], candidate: &Candidate) -> Proximity {
    let poses = bodies.map(|posed| {
        let mut pose = posed.pose;
        pose.rotation = pose.rotation.normalize();
        pose
    });
    let [point_a, point_b] = [0, 1].map(|body| {
        let place = &candidate.places[body];
        let corners = bodies[body].body.mesh().corners(place.triangle as usize);
        let weights = place.weights;
        poses[body]
            .transform_point(corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2])
    });
    Proximity {
        feature: candidate.feature,
        triangle_a: candidate.places[0].triangle,
        triangle_b: candidate.places[1].triangle,
        distance: candidate.distance * scene.unit,
        tilt: candidate.tilt,
        normal: (poses[1].rotation * candidate.normal).normalize_or_zero(),
        point_a,
        point_b,
    }
}

/// What is below a pair of boxes is further apart than the margin.
#[cfg(feature = "audit")]
fn conclude_dropped((bodies, margin): ([Posed<'_>; 2], f64), [a, b]: [u32; 2]) {
    use super::concluded::conclude_at_rest;
    use crate::audit::{Part, Place, Promise};
    let parts = [Part::Boxes(&[a]), Part::Boxes(&[b])];
    conclude_at_rest(Place::ProximityDropped, Promise::Apart, bodies, parts, margin);
}

enum Found {
    Candidates(Vec<Candidate>),
    /// Two triangles that are not proven apart.
    NotApart([u32; 2]),
    /// The meter ran out.
    Exhausted,
}

/// Depth first over the pairs of boxes that are not proven further apart than the limit.
struct Search<'a> {
    scene: &'a RestingScene<'a>,
    test: FeatureTest<'a>,
    limit: f64,
    cone_slack: f64,
    meter: &'a mut Meter,
    /// The bodies and the margin.
    #[cfg(feature = "audit")]
    asked: ([Posed<'a>; 2], f64),
}

impl Task for Search<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Found {
        #[cfg(feature = "audit")]
        let asked = self.asked;
        let Self { scene, mut test, limit, cone_slack, meter, .. } = self;
        let key = round_up(limit);
        let along = scene.direction(-scene.pose.offset);
        let mut stack = Vec::with_capacity(256);
        stack.push([0u32; 2]);
        let mut facing = Facing::new(scene, cone_slack);
        while let Some(pair) = stack.pop() {
            if meter.step().is_err() {
                return Found::Exhausted;
            }
            facing.count();
            match scene.step(pair) {
                Step::Expand { wide, node } => {
                    let wanted = Wanted { along: &along, enough: key, directions: Directions::Usual };
                    let bounds = scene.bounds::<L>((wide, node), pair[1 - wide], &wanted);
                    for (lane, &bound) in bounds.used().iter().enumerate() {
                        // A bound that is not a number drops nothing.
                        if bound.is_nan() || bound <= key {
                            let below = child(pair, wide, node, lane);
                            if facing.may_be_closest(below, f64::from(bound)) {
                                stack.push(below);
                            }
                        } else {
                            #[cfg(feature = "audit")]
                            conclude_dropped(asked, child(pair, wide, node, lane));
                        }
                    }
                }
                Step::Compare(triangles) => {
                    let placed = [scene.place(0, triangles[0]), scene.place(1, triangles[1])];
                    if !proven_apart(&placed[0], &placed[1], scene.error, scene.need) {
                        return Found::NotApart(triangles);
                    }
                    test.compare(triangles, &placed);
                }
            }
        }
        Found::Candidates(test.into_candidates())
    }
}
