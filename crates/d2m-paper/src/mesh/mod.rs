//! The reference method: the paper's mesh query, readable first, with its errata repaired.
//!
//! Sphere trees ([`SphereTree`]), Test-Sphere-Pair, Traverse-Tree-Pair over a subdivided time domain, feature tests by
//! the second-order root finder, and a certified step back. It answers the same question as the default engine with
//! the same types and shares no search over time with it, so each is a check of the other. How the bodies stand at the start
//! of the window the paper does not ask: that is judged as by the default engine.

mod answer;
mod budget;
mod capoeira;
mod cross_check;
mod distance;
mod leaf_pair;
mod sphere_tree;
mod step_back;
mod stretch;
mod traverse;

pub use cross_check::{CrossCheck, cross_check};
pub use sphere_tree::SphereTree;

use crate::feature::{PaperOptions, RelativeMotion};
use d2m_bvh::{
    Answered, MeshTree, Meter, Mode, QueryError, QueryOptions, Solid, Start, TimeOfContact, Window,
    time_of_contact_counted,
};
use d2m_interval::Interval;
use traverse::Search;

/// A body with its sphere tree, and how it moves.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_paper::{Moving, SphereTree};
/// use glam::DVec3;
/// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = d2m_bvh::TriMesh::try_new(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = SphereTree::new(mesh);
/// let body = Moving::new(&tree, &ConstantTwist::REST);
/// assert_eq!(body.body.leaf_count(), 4);
/// # Ok::<(), d2m_bvh::MeshError>(())
/// ```
pub type Moving<'a> = d2m_bvh::Moving<'a, SphereTree>;

/// The first contact of two moving meshes, by the reference method.
///
/// Promise: as [`TimeOfContact`] says, for every motion whose enclosures are right. Separation left at `time_lo`: in
/// \[δ, 3δ\] (measured there), where doubles of time are fine enough to choose it. In [`Mode::Capoeira`](d2m_bvh::Mode)
/// the search stops at leaf spheres: `time_lo` is certified free, `separation` what is left there, and a true contact may be missing.
/// `time_hi` is the end of the root's bracket, or of the overlap of the two spheres, where the bodies are measured to be within δ of each other then, and
/// `time_lo` otherwise. [`Mode::Exists`](d2m_bvh::Mode) is answered
/// like the accurate mode. A positive `min_separation`, bodies with a radius and [`Start::Leave`] are not supported and answered
/// as undecided from the start.
///
/// # Errors
/// [`QueryError`] for a tolerance that is not positive and finite, a filled solid whose mesh does not close, or a
/// motion that is not finite over the window.
///
/// ```
/// use d2m_bvh::{QueryOptions, TimeOfContact, TriMesh, Window};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = d2m_paper::SphereTree::new(mesh);
/// let coming = ConstantTwist::REST.with_position(DVec3::Z * 3.0).with_linear_velocity(DVec3::Z * -4.0);
/// let answer = d2m_paper::time_of_contact(
///     d2m_paper::Moving::new(&tree, &coming),
///     d2m_paper::Moving::new(&tree, &ConstantTwist::REST),
///     Window::UNIT,
///     &QueryOptions::DEFAULT,
/// )?;
/// let contact = answer.contact().unwrap(); // its floor meets the tip of the other at t = 1/2
/// assert!(contact.time_lo < 0.5 && contact.time_lo > 0.5 - 1e-9);
/// assert!(contact.separation > 0.0 && contact.separation < 3.3e-10);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn time_of_contact(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
) -> Result<TimeOfContact, QueryError> {
    let bodies = [a, b];
    let tolerance = validate(&bodies, window, options)?;
    let relative = RelativeMotion::new(a.motion, b.motion);
    let undecided = |clear_until: f64| Ok(TimeOfContact::Undecided { clear_until });
    let (t0, t1) = (window.start(), window.end());
    let is_rounded = bodies.iter().any(|body| body.radius > 0.0);
    if options.min_separation > 0.0 || is_rounded || options.start == Start::Leave {
        return undecided(t0);
    }
    let mut meter = Meter::new(&options.budget).at_most(budget::MOST_TESTS);
    if meter.step().is_err() {
        return undecided(t0);
    }
    let span = Interval::new(t0, t1);
    let tolerance = tolerance.max(4.0 * stretch::bound_rounding(&bodies, &relative, span));
    let as_asked = options.with_tolerance(tolerance).with_mode(Mode::Accurate).with_budget(meter.rest());
    let at_start = start_of(bodies, t0, &as_asked)?;
    meter.spend(at_start.work.work());
    if !at_start.answer.is_separated() {
        return Ok(at_start.answer);
    }
    let features = PaperOptions::DEFAULT.with_tolerance(0.5 * tolerance);
    let mut search = Search::new(bodies, features, options.mode, meter);
    let stopped = search.search(span).err();
    match (search.best, stopped) {
        (None, None) => Ok(TimeOfContact::Separated),
        (best, Some(stopped)) => {
            undecided(best.map_or(stopped.clear_until, |b| b.bracket.lo().min(stopped.clear_until)))
        }
        (Some(best), None) if best.undecided => undecided(best.bracket.lo()),
        (Some(best), None) => {
            let found = if Search::stops_at_leaves(options.mode) {
                answer::early_contact(&bodies, &relative, &best, tolerance)
            } else {
                answer::certified_contact(&bodies, &relative, t0, &best, tolerance)
            };
            found.map_or_else(|| undecided(best.bracket.lo()), |contact| Ok(TimeOfContact::Contact(contact)))
        }
    }
}

/// How the bodies stand at this time: the answer of the default engine about a window that is nothing else.
fn start_of(
    bodies: [Moving<'_>; 2],
    time: f64,
    options: &QueryOptions,
) -> Result<Answered<TimeOfContact>, QueryError> {
    let [a, b] = bodies.map(in_boxes);
    let now = Window::try_new(time, time).expect("the start of a window is a time");
    time_of_contact_counted(a, b, now, options)
}

/// The body as the default engine has it.
fn in_boxes(body: Moving<'_>) -> d2m_bvh::Moving<'_, MeshTree> {
    let Moving { body, motion, solid, radius } = body;
    d2m_bvh::Moving { body: body.boxes(), motion, solid, radius }
}

/// Checks the input and returns the tolerance of the options, or the default one.
fn validate(bodies: &[Moving<'_>; 2], window: Window, options: &QueryOptions) -> Result<f64, QueryError> {
    if !(options.min_separation >= 0.0 && options.min_separation.is_finite()) {
        return Err(QueryError::BadMinSeparation { value: options.min_separation });
    }
    let radius = bodies.iter().map(|m| m.body.bounding_sphere().radius).fold(0.0, f64::max);
    let tolerance = options.tolerance_of(radius.max(f64::MIN_POSITIVE));
    if !(tolerance > 0.0 && tolerance.is_finite()) {
        return Err(QueryError::BadTolerance { value: tolerance });
    }
    for (body, moving) in bodies.iter().enumerate() {
        if moving.solid_in(options) == Solid::Filled && !moving.body.is_watertight() {
            return Err(QueryError::NotWatertight { body });
        }
        if !stretch::is_bounded(moving, Interval::new(window.start(), window.end())) {
            return Err(QueryError::BadMotion { body });
        }
    }
    Ok(tolerance)
}
