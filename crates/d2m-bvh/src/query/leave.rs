//! What holds at the start counts no more once the bodies have parted: the first contact after that.

use super::at_start::judged;
use super::carried_pair::CarriedPair;
use super::general_motion::tolerance_of;
use super::meshes::of_meshes;
use super::rounded::Rounded;
use super::staying_walk::{FINER, Next, Walk};
use crate::covered_pair::CoveredPair;
use crate::{
    Answered, Contact, Meter, Moving, QueryError, QueryOptions, SearchCounts, StartState, TimeBracket,
    TimeOfContact, Window,
};
use d2m_lanes::power_of_two;

/// The first step away from bodies that were just proven apart, as a part of that.
const LEAST_STEP: f64 = power_of_two(-30);

/// How two bodies part, and when they meet after that.
///
/// ```
/// # use d2m_bvh::{MeshTree, TriMesh};
/// # use glam::DVec3;
/// # let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// # let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// # let tree = MeshTree::new(TriMesh::try_new(vertices.clone(), faces.clone())?);
/// use d2m_bvh::{Moving, QueryOptions, StartState, Window, departure};
/// use d2m_motion::ConstantTwist;
/// // Overlaps the other one by a half, and is pulled out along x at speed 1.
/// let pulled = ConstantTwist::REST.with_position(DVec3::X * 0.5).with_linear_velocity(DVec3::X);
/// let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &pulled)];
/// let parting = departure(a, b, Window::UNIT, &QueryOptions::default())?;
/// assert_eq!(parting.start, StartState::Overlapping);
/// let left = parting.left.expect("they part");
/// assert!(left.lo <= 0.5 + 1e-5 && left.hi >= 0.5 && parting.answer.is_separated());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
#[must_use = "it is a certificate: what is not read is not known to be safe"]
pub struct Departure {
    /// How the bodies stand at the start of the window.
    pub start: StartState,
    /// The bodies are within L = `min_separation` + δ at `lo` (or that is the start), and proven further apart than that at `hi`. Bodies that
    /// begin apart: the start, twice. `None`: they are never proven to have left in the window.
    pub left: Option<TimeBracket>,
    /// The first contact after `left.hi`, with the promises of [`time_of_contact`](crate::time_of_contact) from there on; where the bodies
    /// never part the contact at the start.
    pub answer: TimeOfContact,
}

/// First contact after two bodies have parted: what touches, overlaps or holds the other at the start is let go.
///
/// Promise: `left.hi` is a time at which the distance is proven to be more than L = `min_separation` + δ, and from there on the answer is
/// that of [`time_of_contact`](crate::time_of_contact). As long as the bodies are proven to stay within L of each other – in spans, and
/// where no span is proven at times that are 1e-6 of the window apart – they have not left; nor have they for certain where they part by no more than
/// 13 δ and come back. With [`Mode::Exists`](crate::Mode::Exists) the answer is some contact after that, not the first one.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, QueryOptions, StartState, TriMesh, Window, departure};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// // Stands on the tip of the other one, and is lifted.
/// let lifted = ConstantTwist::REST.with_position(DVec3::Z).with_linear_velocity(DVec3::Z);
/// let [a, b] = [Moving::new(&tree, &ConstantTwist::REST), Moving::new(&tree, &lifted)];
/// let parting = departure(a, b, Window::UNIT, &QueryOptions::default())?;
/// assert!(parting.answer.is_separated() && parting.start != StartState::Apart);
/// let left = parting.left.expect("they part");
/// assert!(left.lo >= 0.0 && left.hi < 1e-8);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of [`time_of_contact`](crate::time_of_contact).
pub fn departure(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
) -> Result<Departure, QueryError> {
    let carried = CarriedPair::new(&CoveredPair::try_new([a, b], window)?);
    let rounded = Rounded::try_new([&a, &b])?;
    let options = rounded.options([a.body, b.body], options)?;
    let Departure { start, left, answer } = of_departing(carried.seen(), window, &options)?.answer;
    Ok(Departure { start, left, answer: rounded.answer(carried.in_world(answer)?) })
}

/// The same of the meshes, without radii.
pub(super) fn of_departing(
    bodies: [Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
) -> Result<Answered<Departure>, QueryError> {
    let [a, b] = bodies;
    let at_start = Window::try_new(window.start(), window.start())?;
    let found = judged(&of_meshes([a, b], at_start, options)?, &bodies, at_start, options)?;
    let work = found.work;
    let first = match found.answer {
        TimeOfContact::Separated => {
            let left = Some(TimeBracket { lo: window.start(), hi: window.start() });
            let found = of_meshes([a, b], window, options)?;
            let work = work.with(&found.work);
            let found = match stopped_at_start(&found, window, &bodies, options, &work) {
                Some(finer) => of_meshes([a, b], window, &finer)?,
                None => Answered { work: SearchCounts::default(), ..found },
            };
            let answer = with_left(found.answer, left);
            let answer = Departure { start: StartState::Apart, left, answer };
            return Ok(Answered { answer, work: work.with(&found.work) });
        }
        undecided @ TimeOfContact::Undecided { .. } => {
            let answer = Departure { start: StartState::Undecided, left: None, answer: undecided };
            return Ok(Answered { answer, work });
        }
        TimeOfContact::Contact(contact) => contact,
    };
    let tolerance = tolerance_of(&bodies, options).max(first.tolerance);
    // While the bodies stay in contact, they are watched at this where no longer span is proven.
    let resolution = window.default_resolution();
    let mut walk = Walk::new([a, b], window, options, tolerance, resolution);
    let (left, answer) = parting(&mut walk, &first)?;
    let spent = SearchCounts { node_tests: walk.meter.spent(), ..SearchCounts::default() };
    let start = Rounded { radii: bodies.map(|body| body.radius) }.start(&first);
    Ok(Answered { answer: Departure { start, left, answer }, work: work.with(&spent) })
}

/// The options of another search, with a smaller tolerance, where one stopped at the start of the window although the bodies are proven
/// further apart than the level there: searches stop up to two tolerances above the separation, whether bodies come or go.
fn stopped_at_start(
    found: &Answered<TimeOfContact>,
    window: Window,
    bodies: &[Moving<'_>; 2],
    options: &QueryOptions,
    work: &SearchCounts,
) -> Option<QueryOptions> {
    let contact = found.answer.contact().filter(|contact| contact.time_lo == window.start())?;
    let tolerance = tolerance_of(bodies, options).max(contact.tolerance);
    let mut meter = Meter::new(&options.budget);
    meter.spend(work.work() + 1);
    let rest = options.with_budget(meter.rest()).with_tolerance(FINER * tolerance);
    (!meter.is_exhausted()).then_some(rest)
}

/// When the bodies part that are in this contact at the start, and the answer after that.
fn parting(walk: &mut Walk<'_>, first: &Contact) -> Result<(Option<TimeBracket>, TimeOfContact), QueryError> {
    let (start, end) = (walk.window.start(), walk.window.end());
    let mut last = start;
    // The start counts whether or not it is proven to be within the level.
    let _ = walk.is_within(last);
    loop {
        match walk.next(last)? {
            Next::Unknown { .. } if walk.meter.is_exhausted() => {
                return Ok((None, TimeOfContact::Undecided { clear_until: start }));
            }
            Next::End | Next::Unknown { .. } => return Ok((None, TimeOfContact::Contact(*first))),
            Next::Within { at, .. } => last = at,
            Next::Apart { last: lo, at } => match clear_of(walk, lo, at)? {
                Parted::At(hi) => {
                    #[cfg(feature = "audit")]
                    {
                        use super::concluded::{Claimed, conclude_apart};
                        let claimed = Claimed { from: hi, to: hi, distance: walk.level };
                        conclude_apart(d2m_mesh::audit::Place::Departure, &walk.bodies, claimed);
                    }
                    let left = Some(TimeBracket { lo, hi });
                    let answer = walk.contact_from(hi, end)?;
                    let answer = answer.unwrap_or(TimeOfContact::Undecided { clear_until: hi });
                    return Ok((left, with_left(answer, left)));
                }
                Parted::WithinAgain(time) => last = time,
            },
        }
    }
}

/// What becomes of bodies that were just proven apart.
enum Parted {
    /// So far apart that a search from here on does not stop at once.
    At(f64),
    /// Within the level again before that.
    WithinAgain(f64),
}

fn clear_of(walk: &mut Walk<'_>, last: f64, at: f64) -> Result<Parted, QueryError> {
    let end = walk.window.end();
    let mut step = (at - last).max(LEAST_STEP * walk.resolution);
    let mut time = at;
    while !walk.is_clearly_apart(time)? {
        // Apart by little more than the level to the end: the search begins where that was proven first.
        if time >= end || walk.meter.is_exhausted() {
            return Ok(Parted::At(at));
        }
        time = (time + step).max(time.next_up()).min(end);
        if walk.is_within(time) {
            return Ok(Parted::WithinAgain(time));
        }
        step *= 2.0;
    }
    Ok(Parted::At(time))
}

fn with_left(answer: TimeOfContact, left: Option<TimeBracket>) -> TimeOfContact {
    match answer {
        TimeOfContact::Contact(contact) => TimeOfContact::Contact(Contact { left, ..contact }),
        other => other,
    }
}
