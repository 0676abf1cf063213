//! The query for the first contact of two bodies.

use super::containment::contains_point;
use super::distance::distance;
use super::report::{contact, evidence_at_start};
use crate::search::{
    Outcome, Quad, RelativeMotion, Scene, SceneBody, Scratch, Search, given_relative_position, run,
};
use crate::{Mode, Moving, Posed, QueryError, QueryOptions, Solid, StartState, TimeOfContact, Window};
use core::cell::RefCell;
use d2m_motion::Pose;
use glam::DVec3;

thread_local! {
    /// Memory of the last search of this thread.
    static SCRATCH: RefCell<Option<Box<Scratch>>> = const { RefCell::new(None) };
}

/// First time in `window` at which the two bodies touch.
///
/// Constant twists (linear and screw motions) are searched as they are, keyframes span by span. Any other motion is
/// followed by constant twists on spans of time, with a proven deviation that is taken from the gap: usually three to
/// five searches, most of them over short spans.
///
/// Promise: never a missed contact, never a late one. See [`TimeOfContact`] and [`Contact`](crate::Contact) for what
/// each answer certifies, and [`QueryOptions`] for what can be asked.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, QueryOptions, TriMesh, Window, time_of_contact};
/// use d2m_motion::Pose;
/// use glam::{DQuat, DVec3};
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
/// let tree = MeshTree::new(mesh);
/// let falling = ConstantTwist::try_new(DVec3::Z * 2.0, DQuat::IDENTITY, -DVec3::Z * 4.0, DVec3::ZERO).unwrap();
/// let answer = time_of_contact(
///     Moving::new(&tree, &falling),
///     Moving::new(&tree, &ConstantTwist::REST),
///     Window::UNIT,
///     &QueryOptions::default(),
/// ).unwrap();
/// let contact = answer.contact().unwrap();
/// assert!(contact.time_lo <= 0.25 && contact.time_lo > 0.25 - 1e-10);
/// assert!((contact.closing_speed - 4.0).abs() < 1e-9);
/// ```
///
/// # Errors
/// Bad input only: a tolerance, separation or motion that is not finite, a filled solid that does not close.
pub fn time_of_contact(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
) -> Result<TimeOfContact, QueryError> {
    match scene_of(a, b, window, options)? {
        Some(scene) => ask(&scene, options),
        None => super::general_motion::general_motion([a, b], window, options),
    }
}

/// The scene of a query that may be asked; `None` when a motion has no constant twist.
pub(super) fn scene_of<'a>(
    a: Moving<'a>,
    b: Moving<'a>,
    window: Window,
    options: &QueryOptions,
) -> Result<Option<Scene<'a>>, QueryError> {
    check(options)?;
    for (index, moving) in [&a, &b].into_iter().enumerate() {
        if options.solid == Solid::Filled && !moving.body.is_watertight() {
            return Err(QueryError::NotWatertight { body: index });
        }
    }
    let (Some(motion_a), Some(motion_b)) = (a.motion.constant_twist(), b.motion.constant_twist()) else {
        return Ok(None);
    };
    Scene::try_new((a.body, motion_a), (b.body, motion_b), window, options).map(Some)
}

/// Searches.
pub(super) fn ask(scene: &Scene<'_>, options: &QueryOptions) -> Result<TimeOfContact, QueryError> {
    let mut scratch = SCRATCH.take().unwrap_or_else(|| Box::new(Scratch::new()));
    let outcome = run(Search::new(scene, options, &mut scratch));
    SCRATCH.set(Some(scratch));
    let start_decided = match outcome {
        Outcome::Found(found) => !found.is_at_start(),
        Outcome::OutOfBudget(until) => until > 0.0,
        Outcome::Separated => true,
    };
    if options.solid == Solid::Filled
        && start_decided
        && let Some(contained) = containment(scene)
    {
        return Ok(contained);
    }
    Ok(match outcome {
        Outcome::Separated => TimeOfContact::Separated,
        Outcome::OutOfBudget(until) => TimeOfContact::Undecided { clear_until: scene.units.time_down(until) },
        Outcome::Found(found) => {
            let mut contact = contact(scene, &found, options.mode != Mode::Capoeira);
            if contact.start == StartState::Touching
                && let Some(triangles) = crossing_at_start(scene)?
            {
                (contact.start, contact.separation) = (StartState::Overlapping, 0.0);
                let evidence = evidence_at_start(scene, triangles);
                if evidence >= contact.evidence {
                    (contact.evidence, contact.time_hi) = (evidence, contact.time_lo);
                }
            }
            TimeOfContact::Contact(contact)
        }
    })
}

/// Counts of the last search of this thread.
#[doc(hidden)]
pub fn last_search_counts() -> crate::SearchCounts {
    SCRATCH.with_borrow(|scratch| scratch.as_ref().map(|s| s.counts).unwrap_or_default())
}

fn check(options: &QueryOptions) -> Result<(), QueryError> {
    if let Some(value) = options.tolerance
        && !(value.is_finite() && value > 0.0)
    {
        return Err(QueryError::BadTolerance { value });
    }
    let value = options.min_separation;
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(QueryError::BadMinSeparation { value }) }
}

/// A pair of triangles that cross at the start (up to rounding). The search stops at the first pair that is near.
fn crossing_at_start(scene: &Scene<'_>) -> Result<Option<[u32; 2]>, QueryError> {
    // As seen from B's reference point, which may be far from the origin.
    let apart = given_relative_position(&scene.a.motion, &scene.b.motion, 0.0) * scene.units.length();
    let posed = [(&scene.a, apart), (&scene.b, DVec3::ZERO)].map(|(body, translation)| {
        let m = body.given.rebase(scene.window.start());
        Posed::new(body.tree, Pose { rotation: m.orientation(), translation, at: m.at() })
    });
    let found = distance(posed[0], posed[1], Solid::Surface)?;
    Ok((found.state == StartState::Overlapping).then_some([found.triangle_a, found.triangle_b]))
}

/// The answer when one body is inside the other at the start; the surfaces are known not to cross then.
fn containment(scene: &Scene<'_>) -> Option<TimeOfContact> {
    let motion = RelativeMotion::new(scene, 0.0);
    let frame = motion.frame::<Quad>(0.0);
    let place = |p: DVec3, of_b: bool| {
        if of_b {
            frame
                .rotation
                .transposed::<Quad>()
                .times::<Quad>((Quad::from_vec(p) - frame.apart).to_vec())
                .to_vec()
        } else {
            (frame.rotation.times::<Quad>(p) + frame.apart).to_vec()
        }
    };
    let inside = |outer: &SceneBody<'_>, inner: &SceneBody<'_>, of_b: bool| -> Option<(u32, DVec3)> {
        let (outer, length) = (outer.tree, scene.units.length());
        inner.tree.component_vertices().iter().find_map(|&vertex| {
            let p = inner.place(inner.tree.mesh().vertices()[vertex as usize]);
            let q = place(p, of_b) * length + outer.center();
            contains_point(outer, q).then_some((vertex, q))
        })
    };
    let (a, b) = (&scene.a, &scene.b);
    let hit = inside(a, b, true)
        .map(|(vertex, _)| (false, vertex))
        .or_else(|| inside(b, a, false).map(|(vertex, _)| (true, vertex)));
    let (a_is_inside, vertex) = hit?;
    Some(TimeOfContact::Contact(super::report::contained(
        scene,
        &motion,
        a_is_inside,
        vertex,
        StartState::Contained,
    )))
}
