//! Do two bodies at rest touch?

use super::containment::one_holds_the_other;
use super::node_pair::{RestingScene, Step, child, proven_apart};
use crate::meter::{Exhausted, Meter};
use crate::{Budget, Posed, QueryError, Solid};
use d2m_feature::proven_crossing;
use d2m_feature::triangles_intersect;
use d2m_lanes::{Lanes, Task, run};
use glam::DVec3;

/// Do two bodies at rest share a point?
///
/// Promise: `false` is proven, in real arithmetic, for the poses as given. `true` is said whenever that cannot be
/// proven: when the bodies touch, and when they are apart by less than the roundings of placing them, at most about
/// 64·2⁻⁵³ times the largest length (radii, distance of the centers, offsets from the reference points), more where lengths are below
/// 2⁻⁴⁵⁰ and underflow takes a part of them.
///
/// ```
/// use d2m_mesh::{MeshTree, Posed, Solid, TriMesh, collide};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let at = |x: f64| Posed::new(&tree, Pose { translation: DVec3::X * x, ..Pose::IDENTITY });
/// assert!(collide(at(0.0), at(0.9), Solid::Filled)?);
/// assert!(!collide(at(0.0), at(1.0 + 1e-13), Solid::Filled)?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QueryError::BadPose`], and [`QueryError::NotWatertight`] with [`Solid::Filled`].
#[doc(alias = "intersects")]
pub fn collide(a: Posed<'_>, b: Posed<'_>, solids: impl Into<[Solid; 2]>) -> Result<bool, QueryError> {
    let solids = solids.into();
    check_solids(a, b, solids)?;
    let scene = RestingScene::try_new(a, b)?;
    // What a budget without limits leaves open is not proven apart.
    Ok(may_collide(&scene, solids, &mut Meter::unlimited()).unwrap_or(true))
}

/// As [`collide`] within a budget; `None`: it ran out, and nothing is known.
///
/// ```
/// use d2m_mesh::{Budget, MeshTree, Posed, Solid, TriMesh, collide_within};
/// use glam::DVec3;
/// use std::time::Duration;
/// let mesh = TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?;
/// let tree = MeshTree::new(mesh);
/// let (a, b) = (Posed::at_rest(&tree), Posed::at_rest(&tree));
/// let budget = Budget::UNLIMITED.with_wall_clock(Duration::from_millis(10));
/// assert_eq!(collide_within(a, b, Solid::Surface, &budget)?, Some(true));
/// assert_eq!(collide_within(a, b, Solid::Surface, &Budget::UNLIMITED.with_node_tests(0))?, None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`collide`].
pub fn collide_within(
    a: Posed<'_>,
    b: Posed<'_>,
    solids: impl Into<[Solid; 2]>,
    budget: &Budget,
) -> Result<Option<bool>, QueryError> {
    let solids = solids.into();
    check_solids(a, b, solids)?;
    let scene = RestingScene::try_new(a, b)?;
    Ok(may_collide(&scene, solids, &mut Meter::new(budget)).ok())
}

fn may_collide(scene: &RestingScene<'_>, solids: [Solid; 2], meter: &mut Meter) -> Result<bool, Exhausted> {
    let found = search(scene, Wanted { most: 1, counts: may_touch }, meter)?;
    Ok(!found.pairs.is_empty() || !found.boxes_apart && one_holds_the_other(scene, solids, meter)?.is_some())
}

/// A pair of triangles, one of each body, that is not proven apart; `None` is a proof that the surfaces are disjoint.
/// Which pair of several it is depends on the bodies and poses only. Says nothing about one body inside the other.
///
/// ```
/// # use d2m_mesh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_mesh::{Posed, try_colliding_pair};
/// use d2m_motion::Pose;
/// let above = Posed::new(&tree, Pose { translation: DVec3::Z * 1.5, ..Pose::IDENTITY });
/// assert_eq!(try_colliding_pair(Posed::at_rest(&tree), above)?, None); // a proof
/// assert!(try_colliding_pair(Posed::at_rest(&tree), Posed::at_rest(&tree))?.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QueryError::BadPose`].
pub fn try_colliding_pair(a: Posed<'_>, b: Posed<'_>) -> Result<Option<[u32; 2]>, QueryError> {
    let scene = RestingScene::try_new(a, b)?;
    Ok(search_all(&scene, Wanted { most: 1, counts: may_touch }).first().copied())
}

/// All pairs of triangles, the first of A and the second of B, that are not proven apart, in ascending order. Every
/// pair that shares a point is among them; the others are apart by roundings only (see [`collide`]).
///
/// ```
/// use d2m_mesh::{MeshTree, Posed, TriMesh, colliding_pairs};
/// use glam::DVec3;
/// let one = |z: f64| TriMesh::try_new(vec![DVec3::Z * z, DVec3::X, DVec3::Y], vec![[0, 1, 2]]).unwrap();
/// let (low, high) = (MeshTree::new(one(0.0)), MeshTree::new(one(1.0)));
/// assert_eq!(colliding_pairs(Posed::at_rest(&low), Posed::at_rest(&high)).unwrap(), [[0, 0]]);
/// ```
///
/// # Errors
/// [`QueryError::BadPose`].
pub fn colliding_pairs(a: Posed<'_>, b: Posed<'_>) -> Result<Vec<[u32; 2]>, QueryError> {
    let scene = RestingScene::try_new(a, b)?;
    let found = search_all(&scene, Wanted { most: usize::MAX, counts: may_touch });
    // The first triangle of a body that is one point up to rounding stands for all.
    let all = |body: usize, triangle: u32| match scene.trees[body].mesh().triangle_count() as u32 {
        count if scene.is_point_like(body) => 0..count,
        _ => triangle..triangle + 1,
    };
    let mut pairs: Vec<[u32; 2]> = found
        .iter()
        .flat_map(|&[a, b]| all(0, a).flat_map(move |a| all(1, b).map(move |b| [a, b])))
        .collect();
    pairs.sort_unstable();
    Ok(pairs)
}

/// The first pair of triangles, in the order of the trees, that cross as they are placed. Which one it is depends on the bodies
/// and poses only.
pub(crate) fn crossing_pair_within(
    scene: &RestingScene<'_>,
    meter: &mut Meter,
) -> Result<Option<[u32; 2]>, Exhausted> {
    Ok(search(scene, Wanted { most: 1, counts: cross }, meter)?.pairs.first().copied())
}

/// A pair of triangles that share a point wherever their vertices are within the errors of placing them.
pub(crate) fn proven_crossing_pair(
    scene: &RestingScene<'_>,
    meter: &mut Meter,
) -> Result<Option<[u32; 2]>, Exhausted> {
    Ok(search(scene, Wanted { most: 1, counts: certainly_cross }, meter)?.pairs.first().copied())
}

/// Pairs of triangles that are not proven further apart than `scene.error`, the first in the order of the trees; those that were found,
/// too, where the budget runs out.
pub(crate) fn near_pairs(
    scene: &RestingScene<'_>,
    most: usize,
    meter: &mut Meter,
    pairs: &mut Vec<[u32; 2]>,
) -> Result<(), Exhausted> {
    let wanted = Wanted { most, counts: may_touch };
    run(Search { scene, wanted, meter, pairs }).map(|_| ())
}

/// Are no two triangles closer than `scene.error`? Proven where it says so.
pub(crate) fn surfaces_are_apart(scene: &RestingScene<'_>, meter: &mut Meter) -> Result<bool, Exhausted> {
    Ok(search(scene, Wanted { most: 1, counts: may_touch }, meter)?.pairs.is_empty())
}

/// Are the surfaces of two bodies apart, and does one of them that is filled hold a part of the other?
///
/// ```
/// use d2m_mesh::at_rest::is_contained;
/// use d2m_mesh::{MeshTree, Posed, Solid, TriMesh};
/// use glam::DVec3;
/// let (faces, corners) = (vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
/// let large = MeshTree::new(TriMesh::try_new(corners.to_vec(), faces.clone())?);
/// let small = MeshTree::new(TriMesh::try_new(corners.map(|p| 0.1 * p + 0.1).to_vec(), faces)?);
/// let [a, b] = [Posed::at_rest(&large), Posed::at_rest(&small)];
/// assert!(is_contained(a, b, [Solid::Filled, Solid::Surface])?);
/// assert!(!is_contained(a, b, [Solid::Surface, Solid::Filled])?);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`QueryError::BadPose`].
pub fn is_contained(a: Posed<'_>, b: Posed<'_>, solids: [Solid; 2]) -> Result<bool, QueryError> {
    if solids == [Solid::Surface; 2] {
        return Ok(false);
    }
    let (scene, meter) = (RestingScene::try_new(a, b)?, &mut Meter::unlimited());
    // Without a limit there always is an answer.
    let apart = surfaces_are_apart(&scene, meter).unwrap_or(false);
    Ok(apart && one_holds_the_other(&scene, solids, meter).is_ok_and(|held| held.is_some()))
}

/// Some of the pairs of triangles that are not proven apart, the first in the order of the trees: `most` of them, or those that are found
/// in so many steps. None where a pose cannot be used.
///
/// ```
/// use d2m_mesh::at_rest::some_colliding_pairs;
/// use d2m_mesh::{MeshTree, Posed, TriMesh};
/// use glam::DVec3;
/// let plate = MeshTree::new(TriMesh::try_new(vec![DVec3::ZERO, DVec3::X, DVec3::Y], vec![[0, 1, 2]])?);
/// let post = MeshTree::new(TriMesh::segment(DVec3::new(0.25, 0.25, -1.0), DVec3::new(0.25, 0.25, 1.0))?);
/// assert_eq!(some_colliding_pairs(Posed::at_rest(&plate), Posed::at_rest(&post), 4, 100), [[0, 0]]);
/// # Ok::<(), d2m_mesh::MeshError>(())
/// ```
pub fn some_colliding_pairs(a: Posed<'_>, b: Posed<'_>, most: usize, steps: u64) -> Vec<[u32; 2]> {
    let Ok(scene) = RestingScene::try_new(a, b) else { return Vec::new() };
    let mut pairs = Vec::new();
    let _ = near_pairs(&scene, most, &mut Meter::unlimited().at_most(steps), &mut pairs);
    pairs
}

/// All that is wanted, without a limit on the work.
fn search_all(scene: &RestingScene<'_>, wanted: Wanted) -> Vec<[u32; 2]> {
    search(scene, wanted, &mut Meter::unlimited()).map_or_else(|Exhausted| Vec::new(), |found| found.pairs)
}

fn search(scene: &RestingScene<'_>, wanted: Wanted, meter: &mut Meter) -> Result<Found, Exhausted> {
    let mut pairs = Vec::new();
    let boxes_apart = run(Search { scene, wanted, meter, pairs: &mut pairs })?;
    Ok(Found { boxes_apart, pairs })
}

fn may_touch(scene: &RestingScene<'_>, a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    !proven_apart(a, b, scene.error, scene.need)
}

fn certainly_cross(scene: &RestingScene<'_>, a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    // Each vertex is within the error of both bodies together of where it is placed.
    proven_crossing(a, b, scene.error)
}

fn cross(_: &RestingScene<'_>, a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    triangles_intersect(a, b)
}

/// Refuses filled bodies that do not close.
pub(crate) fn check_solids(a: Posed<'_>, b: Posed<'_>, solids: [Solid; 2]) -> Result<(), QueryError> {
    let is_open = |k: usize, posed: Posed<'_>| solids[k] == Solid::Filled && !posed.body.is_watertight();
    match [a, b].into_iter().enumerate().position(|(k, posed)| is_open(k, posed)) {
        Some(body) => Err(QueryError::NotWatertight { body }),
        None => Ok(()),
    }
}

/// What a search is for.
#[derive(Clone, Copy)]
struct Wanted {
    /// How many pairs to find before stopping.
    most: usize,
    /// Which pairs of placed triangles are found.
    counts: fn(&RestingScene<'_>, &[DVec3; 3], &[DVec3; 3]) -> bool,
}

/// Depth first over the pairs of boxes that are not proven apart.
struct Search<'a> {
    scene: &'a RestingScene<'a>,
    wanted: Wanted,
    meter: &'a mut Meter,
    /// Takes what is found, also where the budget runs out.
    pairs: &'a mut Vec<[u32; 2]>,
}

struct Found {
    /// The boxes around the whole bodies are apart already.
    boxes_apart: bool,
    pairs: Vec<[u32; 2]>,
}

impl Task for Search<'_> {
    /// Are the boxes around the whole bodies apart already?
    type Output = Result<bool, Exhausted>;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Self::Output {
        let Self { scene, wanted: Wanted { most, counts }, meter, pairs } = self;
        if scene.overlaps::<L>(0, 0, 0) == 0 {
            return Ok(true);
        }
        let mut stack = Vec::with_capacity(256);
        stack.push([0u32; 2]);
        while let Some(pair) = stack.pop() {
            meter.step()?;
            match scene.step(pair) {
                Step::Expand { wide, node } => {
                    let mut lanes = scene.overlaps::<L>(wide, node, pair[1 - wide]);
                    while lanes != 0 {
                        stack.push(child(pair, wide, node, lanes.trailing_zeros() as usize));
                        lanes &= lanes - 1;
                    }
                }
                Step::Compare([a, b]) => {
                    if counts(scene, &scene.place(0, a), &scene.place(1, b)) {
                        pairs.push([a, b]);
                        if pairs.len() >= most {
                            break;
                        }
                    }
                }
            }
        }
        Ok(false)
    }
}
