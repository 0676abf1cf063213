//! Do two bodies at rest touch?

use super::containment::one_holds_the_other;
use super::static_pair::{Scene, Step, child, proven_apart};
use crate::search::{Lanes, Task, run};
use crate::{Posed, QueryError, Solid};
use d2m_feature::triangle_distance;
use glam::DVec3;

/// Do two bodies at rest share a point?
///
/// Promise: `false` is proven, in real arithmetic, for the poses as given. `true` is said whenever that cannot be
/// proven: when the bodies touch, and when they are apart by less than the roundings of placing them, at most about
/// 64·2⁻⁵³ times the largest length (radii, distance of the centres, offsets from the followed points).
///
/// ```
/// use d2m_bvh::{MeshTree, Posed, Solid, TriMesh, collide};
/// use d2m_motion::Pose;
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
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
pub fn collide(a: Posed<'_>, b: Posed<'_>, solid: Solid) -> Result<bool, QueryError> {
    check_solid(a, b, solid)?;
    let scene = Scene::try_new(a, b)?;
    Ok(match run(Search { scene: &scene, most: 1, counts: may_touch }) {
        Found { boxes_apart: true, .. } => false,
        found => !found.pairs.is_empty() || (solid == Solid::Filled && one_holds_the_other(&scene).is_some()),
    })
}

/// A pair of triangles, one of each body, that is not proven apart; `None` is a proof that the surfaces are disjoint.
/// Which pair of several it is depends on the bodies and poses only. Says nothing about one body inside the other.
///
/// # Errors
/// [`QueryError::BadPose`].
pub fn try_colliding_pair(a: Posed<'_>, b: Posed<'_>) -> Result<Option<[u32; 2]>, QueryError> {
    let scene = Scene::try_new(a, b)?;
    Ok(run(Search { scene: &scene, most: 1, counts: may_touch }).pairs.first().copied())
}

/// All pairs of triangles, the first of A and the second of B, that are not proven apart, in ascending order. Every
/// pair that shares a point is among them; the others are apart by roundings only (see [`collide`]).
///
/// ```
/// use d2m_bvh::{MeshTree, Posed, TriMesh, colliding_pairs};
/// use glam::DVec3;
/// let one = |z: f64| TriMesh::try_new(vec![DVec3::Z * z, DVec3::X, DVec3::Y], vec![[0, 1, 2]]).unwrap();
/// let (low, high) = (MeshTree::new(one(0.0)), MeshTree::new(one(1.0)));
/// assert_eq!(colliding_pairs(Posed::at_rest(&low), Posed::at_rest(&high)).unwrap(), [[0, 0]]);
/// ```
///
/// # Errors
/// [`QueryError::BadPose`].
pub fn colliding_pairs(a: Posed<'_>, b: Posed<'_>) -> Result<Vec<[u32; 2]>, QueryError> {
    let scene = Scene::try_new(a, b)?;
    let mut pairs = run(Search { scene: &scene, most: usize::MAX, counts: may_touch }).pairs;
    pairs.sort_unstable();
    Ok(pairs)
}

/// The first pair of triangles, in the order of the trees, that cross as they are placed. Which one it is depends on the bodies
/// and poses only.
pub(super) fn crossing_pair(scene: &Scene<'_>) -> Option<[u32; 2]> {
    run(Search { scene, most: 1, counts: cross }).pairs.first().copied()
}

fn may_touch(scene: &Scene<'_>, a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    !proven_apart(a, b, scene.error, scene.need)
}

fn cross(scene: &Scene<'_>, a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    may_touch(scene, a, b) && triangle_distance(a, b).upper == 0.0
}

/// Refuses filled bodies that do not close.
pub(super) fn check_solid(a: Posed<'_>, b: Posed<'_>, solid: Solid) -> Result<(), QueryError> {
    match [a, b].iter().position(|posed| solid == Solid::Filled && !posed.body.is_watertight()) {
        Some(body) => Err(QueryError::NotWatertight { body }),
        None => Ok(()),
    }
}

/// Depth first over the pairs of boxes that are not proven apart.
struct Search<'a> {
    scene: &'a Scene<'a>,
    /// How many pairs to find before stopping.
    most: usize,
    /// Which pairs of placed triangles are found.
    counts: fn(&Scene<'_>, &[DVec3; 3], &[DVec3; 3]) -> bool,
}

struct Found {
    /// The boxes around the whole bodies are apart already.
    boxes_apart: bool,
    pairs: Vec<[u32; 2]>,
}

impl Task for Search<'_> {
    type Output = Found;

    #[inline(always)]
    fn run<L: Lanes>(self) -> Found {
        let Self { scene, most, counts } = self;
        let mut pairs = Vec::new();
        if scene.overlaps::<L>(0, 0, 0) == 0 {
            return Found { boxes_apart: true, pairs };
        }
        let mut stack = Vec::with_capacity(256);
        stack.push([0u32; 2]);
        while let Some(pair) = stack.pop() {
            match scene.step(pair) {
                Step::Open(wide, node) => {
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
        Found { boxes_apart: false, pairs }
    }
}
