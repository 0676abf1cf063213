//! The first contact of two bodies that move with constant twists.

use super::report::{contact, contained};
use crate::covered_pair::CoveredPair;
use crate::pair::scene::{MovingScene, MovingTree};
use crate::walk::scratch::Scratch;
use crate::walk::state::{Outcome, Search};
use crate::{Answered, MeshTree, QueryError, QueryOptions, SearchCounts, Solid, TimeOfContact, Window};
use core::cell::RefCell;
use d2m_lanes::F64x4;
use d2m_mesh::at_rest::{Held, held_vertex};
use d2m_mesh::{Exhausted, Meter};
use glam::DVec3;

thread_local! {
    /// Memory of the last search of this thread.
    static SCRATCH: RefCell<Option<Box<Scratch>>> = const { RefCell::new(None) };
}

/// The scene of a query whose input is valid; `None` when a motion has no constant twist.
pub(super) fn scene_of<'a>(
    pair: &CoveredPair<'a>,
    options: &QueryOptions,
) -> Result<Option<MovingScene<'a>>, QueryError> {
    let [a, b] = *pair.bodies();
    let solids = [a.solid_in(options), b.solid_in(options)];
    check([a.body, b.body], solids, options)?;
    let (Some(motion_a), Some(motion_b)) = (a.motion.constant_twist(), b.motion.constant_twist()) else {
        return Ok(None);
    };
    let (a, b) = (MovingTree { tree: a.body, twist: motion_a }, MovingTree { tree: b.body, twist: motion_b });
    let mut scene = MovingScene::try_new(a, b, pair.window(), options)?;
    scene.solids = solids;
    Ok(Some(scene))
}

/// The scene of a query of constant twists of bodies with these meanings.
pub(super) fn scene_of_twists<'a>(
    [a, b]: [MovingTree<'a>; 2],
    solids: [Solid; 2],
    window: Window,
    options: &QueryOptions,
) -> Result<MovingScene<'a>, QueryError> {
    check([a.tree, b.tree], solids, options)?;
    let mut scene = MovingScene::try_new(a, b, window, options)?;
    scene.solids = solids;
    Ok(scene)
}

/// Searches.
pub(super) fn ask(scene: &MovingScene<'_>, options: &QueryOptions) -> Answered<TimeOfContact> {
    let mut meter = Meter::new(&options.budget);
    // Decided first: what the budget leaves open at the start would leave everything open.
    let Ok(held) = held_at_start(scene, &mut meter) else {
        let answer = TimeOfContact::Undecided { clear_until: scene.window.start() };
        return Answered { answer, work: steps(&meter) };
    };
    let options = &options.with_budget(meter.rest());
    let mut scratch = SCRATCH.take().unwrap_or_else(|| Box::new(Scratch::new()));
    let mut search = Search::new(scene, options, &mut scratch);
    if held.is_some() {
        // The surfaces at the start decide the rest.
        search = search.of_start();
    }
    let outcome = search.run();
    let answer = answer(scene, options, &Searched { outcome, held, scratch: &scratch });
    let work = scratch.counts.with(&steps(&meter));
    SCRATCH.set(Some(scratch));
    Answered { answer, work }
}

/// Steps beside a search.
fn steps(meter: &Meter) -> SearchCounts {
    SearchCounts { node_tests: meter.spent(), ..SearchCounts::default() }
}

/// What a search found with this memory, and what holds at the start.
struct Searched<'a> {
    outcome: Outcome,
    held: Option<Held>,
    scratch: &'a Scratch,
}

/// From what a search found to the answer.
fn answer(scene: &MovingScene<'_>, options: &QueryOptions, searched: &Searched<'_>) -> TimeOfContact {
    let Searched { outcome, held, scratch } = *searched;
    let surfaces_are_apart = match outcome {
        Outcome::Found(found) => !found.is_at_start(),
        Outcome::OutOfBudget(until) => until > 0.0,
        Outcome::Separated => true,
    };
    if let Some(held) = held
        && surfaces_are_apart
    {
        return TimeOfContact::Contact(contained(scene, &held));
    }
    match outcome {
        Outcome::Separated => TimeOfContact::Separated,
        Outcome::OutOfBudget(until) => TimeOfContact::Undecided { clear_until: scene.units.time_down(until) },
        Outcome::Found(found) => {
            let known = scratch.found_in.filter(|motion| motion.start == found.start);
            let motion = known.unwrap_or_else(|| scene.relative_motion(found.start));
            TimeOfContact::Contact(contact(scene, &motion, &found, options.mode))
        }
    }
}

fn check(bodies: [&MeshTree; 2], solids: [Solid; 2], options: &QueryOptions) -> Result<(), QueryError> {
    if let Some(value) = options.tolerance
        && !(value.is_finite() && value > 0.0)
    {
        return Err(QueryError::BadTolerance { value });
    }
    let value = options.min_separation;
    if !(value.is_finite() && value >= 0.0) {
        return Err(QueryError::BadMinSeparation { value });
    }
    for (index, body) in bodies.into_iter().enumerate() {
        if solids[index] == Solid::Filled && !body.is_watertight() {
            return Err(QueryError::NotWatertight { body: index });
        }
    }
    Ok(())
}

/// A part of a body in the other one, if that is solid, at the start; if the surfaces do not touch then.
fn held_at_start(scene: &MovingScene<'_>, meter: &mut Meter) -> Result<Option<Held>, Exhausted> {
    let filled = scene.solids.map(|solid| solid == Solid::Filled);
    if filled == [false; 2] || scene.spheres_are_apart_at_start() {
        return Ok(None);
    }
    let frame = scene.relative_motion(0.0).frame::<F64x4>(0.0);
    let (a, b, unit) = (scene.a.tree, scene.b.tree, scene.units.length());
    // Spheres that are apart by more than places and this sum are rounded.
    if frame.apart.to_vec().length() > (a.radius() + b.radius()) / unit + scene.pair.error {
        return Ok(None);
    }
    let back = frame.rotation.transposed::<F64x4>();
    // The unit is a power of two.
    let to_a = |p: DVec3| back.transform(p / unit - frame.apart.to_vec()) * unit;
    let to_b = |p: DVec3| (frame.rotation.transform(p / unit) + frame.apart.to_vec()) * unit;
    let in_a = if filled[0] { held_vertex(a, b, to_a, meter)? } else { None };
    if let Some(vertex) = in_a {
        return Ok(Some(Held { by: 0, vertex }));
    }
    let in_b = if filled[1] { held_vertex(b, a, to_b, meter)? } else { None };
    Ok(in_b.map(|vertex| Held { by: 1, vertex }))
}
