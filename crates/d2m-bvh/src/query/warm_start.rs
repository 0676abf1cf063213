//! Queries that use what earlier ones left in a cache, and give the same bits as without.

use super::at_start::judged;
use super::carried_pair::CarriedPair;
use super::constant_twist::{ask, scene_of, scene_of_twists};
use super::general_motion::{general_motion, rounding_tolerance, tolerance_of};
use super::leave::of_departing;
use super::rounded::Rounded;
use super::true_poses::Meeting;
use crate::covered_pair::CoveredPair;
use crate::pair::relative_trajectory::RelativeTrajectory;
use crate::pair::scene::{MovingScene, MovingTree};
use crate::pair::triangles::closest::closest;
use crate::pair::triangles::separating_axis::place_a;
use crate::{
    Answered, Mode, Moving, PairCache, QueryError, QueryOptions, SearchCounts, Start, TimeOfContact, Window,
};
use d2m_feature::triangles_intersect;
use d2m_interval::Interval;
use d2m_lanes::{F64x4, UP};
use d2m_motion::FittedTwists;

/// As [`time_of_contact`](crate::time_of_contact), with a cache that one pair of bodies keeps from query to query, for
/// instance from one step of a simulation to the next.
///
/// Promise: the answer has the same bits whatever the cache holds. What it saves: as long as bodies do not meet, a
/// search proves now and then that they stay further apart than the query needs, and the queries in between are answered by the
/// bound on how differently they move, in less than a microsecond each. A contact is always searched for, at the same cost as without
/// a cache; [`contact_exists`] decides faster whether there is one. For motions whose twists are not constant that holds where
/// one twist is near them for the whole window. Nothing is saved with a budget and in [`Mode::Capoeira`]. Only a search that would end
/// at the hard cap of [`Budget::HARD_NODE_TESTS`](crate::Budget::HARD_NODE_TESTS), after a minute, or because the enclosures of a user's motion become too
/// wide in the window, may be answered by the cache although it could not decide.
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, PairCache, QueryOptions, TriMesh, Window, time_of_contact, time_of_contact_with};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let still = Moving::new(&tree, &ConstantTwist::REST);
/// let options = QueryOptions::default();
/// let mut cache = PairCache::new();
/// for step in 0..100 {
///     // Passes above, each time a little lower, until it meets the other body.
///     let height = 1.5 - 0.007 * f64::from(step);
///     let passing = ConstantTwist::REST
///         .with_position(DVec3::new(-2.0, 0.0, height))
///         .with_linear_velocity(DVec3::X * 4.0)
///         .with_angular_velocity(DVec3::Z);
///     let moving = Moving::new(&tree, &passing);
///     let answer = time_of_contact_with(moving, still, Window::UNIT, &options, &mut cache)?;
///     assert_eq!(answer, time_of_contact(moving, still, Window::UNIT, &options)?);
///     assert_eq!(answer.is_separated(), height > 1.0);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`time_of_contact`](crate::time_of_contact).
pub fn time_of_contact_with(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> Result<TimeOfContact, QueryError> {
    let rounded = Rounded::try_new([&a, &b])?;
    let options = rounded.options([a.body, b.body], options)?;
    let carried = CarriedPair::new(&CoveredPair::try_new([a, b], window)?);
    let [a, b] = carried.seen();
    let answer = match options.start {
        Start::Leave => cache.counted(of_departing([a, b], window, &options)?).answer,
        Start::Report => {
            let before = cache.work();
            let answer = of_meshes_with([a, b], window, &options, cache)?;
            let work = SearchCounts { node_tests: cache.work() - before, ..SearchCounts::default() };
            let judged = judged(&Answered { answer, work }, &[a, b], window, &options)?;
            cache.spend(judged.work.work() - work.work());
            judged.answer
        }
    };
    Ok(rounded.answer(carried.in_world(answer)?))
}

/// The query of the meshes, without radii.
fn of_meshes_with(
    [a, b]: [Moving<'_>; 2],
    window: Window,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> Result<TimeOfContact, QueryError> {
    let pair = CoveredPair::try_new([a, b], window)?;
    let answer = match scene_of(&pair, options)? {
        Some(scene) => constant_twists_with(&scene, options, cache),
        None => general_motion_with(pair, options, cache)?,
    };
    #[cfg(feature = "audit")]
    super::concluded::conclude_answer(&[a, b], window, options, &answer);
    Ok(answer)
}

/// The query of constant twists.
fn constant_twists_with(
    scene: &MovingScene<'_>,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> TimeOfContact {
    if options.budget.is_limited() || options.mode == Mode::Capoeira {
        return cache.counted(ask(scene, options));
    }
    let trajectory = RelativeTrajectory::of(scene);
    if stay_apart(scene, &trajectory, options, cache) {
        return TimeOfContact::Separated;
    }
    let answer = cache.counted(ask(scene, options));
    remember(&answer, scene.window, cache);
    if answer == TimeOfContact::Separated {
        cache.found_apart(&trajectory, scene.solids, options.min_separation);
        #[cfg(feature = "audit")]
        conclude_room(scene, options.min_separation);
    }
    answer
}

/// What a cache knows of the bodies of a scene.
#[cfg(feature = "audit")]
fn conclude_room(scene: &MovingScene<'_>, room: f64) {
    use d2m_mesh::audit::{Part, Place};
    let window = crate::pair::concluded::OffsetSpan::of_query(0.0, scene.units.end_down());
    scene.conclude_at(Place::Cache, window, [Part::Whole; 2], room / scene.units.length());
}

/// Does the cache know that the bodies stay apart, or does a search for more separation than the query's prove it now?
fn stay_apart(
    scene: &MovingScene<'_>,
    trajectory: &RelativeTrajectory,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> bool {
    let room = cache.room_along(trajectory, scene.solids);
    #[cfg(feature = "audit")]
    if let Some(room) = room.filter(|&room| excludes_contact(scene, room)) {
        conclude_room(scene, room);
    }
    room.is_some_and(|room| excludes_contact(scene, room)) || more_room(scene, trajectory, options, cache)
}

/// Remembers a contact.
fn remember(answer: &TimeOfContact, window: Window, cache: &mut PairCache) {
    if let TimeOfContact::Contact(contact) = answer {
        cache.found_contact([contact.triangle_a, contact.triangle_b], contact.time_lo - window.start());
    }
}

/// The query of motions whose twists are not constant. What the cache knows is about the twists that are fitted to them over the
/// whole window: those differ from the motions by their deviation, which is taken from the separation.
fn general_motion_with(
    pair: CoveredPair<'_>,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> Result<TimeOfContact, QueryError> {
    if options.budget.is_limited() || options.mode == Mode::Capoeira {
        return Ok(cache.counted(general_motion(pair, options)?));
    }
    let fitted = WindowFit::try_new(&pair, options);
    if let Some(WindowFit { scene, trajectory, options, .. }) = &fitted
        && stay_apart(scene, trajectory, options, cache)
    {
        return Ok(TimeOfContact::Separated);
    }
    let answer = cache.counted(general_motion(pair, options)?);
    remember(&answer, pair.window(), cache);
    if let Some(WindowFit { scene, trajectory, off, .. }) = &fitted
        && answer == TimeOfContact::Separated
    {
        cache.found_apart(trajectory, scene.solids, options.min_separation - off);
        #[cfg(feature = "audit")]
        conclude_room(scene, options.min_separation - off);
    }
    Ok(answer)
}

/// Twists that follow two motions over a whole window, and what a query of them has to be.
struct WindowFit<'a> {
    scene: MovingScene<'a>,
    trajectory: RelativeTrajectory,
    /// With the separation that the fitted motions need.
    options: QueryOptions,
    /// By how much distances differ, at most.
    off: f64,
}

impl<'a> WindowFit<'a> {
    /// `None` where no twists follow the motions closely enough.
    fn try_new(pair: &CoveredPair<'a>, options: &QueryOptions) -> Option<Self> {
        let (bodies, window) = (pair.bodies(), pair.window());
        let fitted = fit_to_window(pair)?;
        let tolerance = tolerance_of(bodies, options).max(rounding_tolerance(&fitted));
        let off = (fitted.deviation + ROOM_FOR_WIDTH * fitted.floor) * UP;
        let separation = (options.min_separation + off) * UP;
        let options_of_fit = options.with_tolerance(tolerance).with_min_separation(separation);
        let twists = [0, 1].map(|k| MovingTree { tree: bodies[k].body, twist: fitted.twists[k] });
        let span = Window::try_from(fitted.clock.span(window.start(), window.end())).ok()?;
        let solids = bodies.map(|body| body.solid_in(options));
        let scene = scene_of_twists(twists, solids, span, &options_of_fit).ok()?;
        let trajectory = RelativeTrajectory::of(&scene);
        let close = fitted.deviation <= MOST_DEVIATION * trajectory.extent();
        close.then_some(Self { scene, trajectory, options: options_of_fit, off })
    }
}

/// Twists that follow the motions over all of a window in which both are smooth.
fn fit_to_window(pair: &CoveredPair<'_>) -> Option<FittedTwists> {
    let (bodies, window) = (pair.bodies(), pair.window());
    let joint = |body: &Moving<'_>| body.motion.smooth_until(window.start());
    if bodies.iter().filter_map(joint).any(|joint| joint.is_nan() || joint < window.end()) {
        return None;
    }
    let origin = bodies[1].motion.pose_and_twist(window.start()).0.translation;
    FittedTwists::new(&bodies.map(Moving::ball), Interval::new(window.start(), window.end()), origin)
}

/// Do the bodies meet anywhere in the window? The mode of the options does not matter.
///
/// | answer | proven |
/// |---|---|
/// | `Some(false)` | the distance is above `min_separation` at every time of the window |
/// | `Some(true)` | at some time of the window the distance is at most `min_separation` + 3.3 tolerances |
/// | `None` | nothing: the budget or a hard cap ended the search, or a motion's enclosures are too wide |
///
/// A yes is mostly one of at most `min_separation` + tolerance, or of bodies that share a point: that is
/// [`Evidence::Near`](crate::Evidence::Near) or [`Crossing`](crate::Evidence::Crossing). It is
/// [`Early`](crate::Evidence::Early) where bodies pass each other a little above that distance. A yes or no carries no evidence;
/// who needs it asks [`time_of_contact_with`] with [`Mode::Exists`], which gives the same answers with a
/// [`Contact`](crate::Contact) whose `evidence` and `tolerance` say which of these holds, at the cost of what a cache saves here.
/// (Where numbers for time are too far apart to resolve the tolerance, the distance is at most that of the contact's `tolerance`.)
///
/// As [`time_of_contact`](crate::time_of_contact) with [`Mode::Exists`], but only yes or no, so that a cache can do more:
/// when the two triangles that met last time are shown to meet again, the answer is yes without any search (Section
/// VI of the d2m paper). Promise: the same answer whatever the cache holds, with the exceptions of
/// [`time_of_contact_with`].
///
/// ```
/// use d2m_bvh::{MeshTree, Moving, PairCache, QueryOptions, TriMesh, Window, contact_exists};
/// use d2m_motion::ConstantTwist;
/// use glam::DVec3;
/// let vertices = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = TriMesh::try_new(vertices, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let tree = MeshTree::new(mesh);
/// let still = Moving::new(&tree, &ConstantTwist::REST);
/// let mut cache = PairCache::new();
/// for step in 0..20 {
///     let height = 2.0 + 0.2 * f64::from(step);
///     let falling = ConstantTwist::REST
///         .with_position(DVec3::Z * height)
///         .with_linear_velocity(DVec3::Z * -4.0);
///     let answer =
///         contact_exists(Moving::new(&tree, &falling), still, Window::UNIT, &QueryOptions::default(), &mut cache)?;
///     assert_eq!(answer, Some(height < 5.1));
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// As [`time_of_contact`](crate::time_of_contact).
pub fn contact_exists(
    a: Moving<'_>,
    b: Moving<'_>,
    window: Window,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> Result<Option<bool>, QueryError> {
    let options = Rounded::try_new([&a, &b])?.options([a.body, b.body], options)?.with_mode(Mode::Exists);
    let carried = CarriedPair::new(&CoveredPair::try_new([a, b], window)?);
    let [a, b] = carried.seen();
    let pair = CoveredPair::try_new([a, b], window)?;
    let scene = scene_of(&pair, &options)?;
    if !options.budget.is_limited()
        && let Some(triangles) = cache.within([&a, &b].map(|moving| moving.body.mesh().triangle_count()))
    {
        let after = match &scene {
            Some(scene) => meet_again(scene, triangles, cache.meeting),
            None => move_to_meet_again(&pair, &options, (triangles, cache.meeting)),
        };
        if let Some(after) = after {
            cache.found_contact(triangles, after);
            return Ok(Some(true));
        }
    }
    Ok(match of_meshes_with([a, b], window, &options, cache)? {
        TimeOfContact::Separated => Some(false),
        TimeOfContact::Contact(_) => Some(true),
        TimeOfContact::Undecided { .. } => None,
    })
}

/// As [`meet_again`], for any motions.
fn move_to_meet_again(
    pair: &CoveredPair<'_>,
    options: &QueryOptions,
    (triangles, after): ([u32; 2], f64),
) -> Option<f64> {
    let (bodies, window) = (pair.bodies(), pair.window());
    let tolerance = tolerance_of(bodies, options);
    let meeting = Meeting { bodies, window, separation: options.min_separation, tolerance };
    let found = meeting.found_near(triangles, window.start() + after);
    #[cfg(feature = "audit")]
    if let Some(time) = found {
        use d2m_mesh::audit::{Place, Promise};
        let distance = options.min_separation + 0.5 * tolerance;
        let claimed = super::concluded::Claimed { from: time, to: time, distance };
        super::concluded::conclude_of_triangles(Place::MeetAgain, Promise::Meets, bodies, triangles, claimed);
    }
    found.map(|time| time - window.start())
}

/// Does a search of this scene find no contact when the bodies are further apart than `room` all the time? A contact
/// ends at the stopping distance, up to the error of one test.
fn excludes_contact(scene: &MovingScene<'_>, room: f64) -> bool {
    room / scene.units.length() > scene.pair.stop + 2.0 * scene.pair.error
}

/// Searches with a larger separation than the query's, so that the next queries need no search. True: no contact now.
fn more_room(
    scene: &MovingScene<'_>,
    trajectory: &RelativeTrajectory,
    options: &QueryOptions,
    cache: &mut PairCache,
) -> bool {
    let Some(more) = cache.room_to_prove(trajectory, scene.tolerance * scene.units.length()) else {
        return false;
    };
    let room = options.min_separation + more;
    if !excludes_contact(scene, room) {
        return false;
    }
    let wider = options.with_min_separation(room);
    let proven = cache.counted(ask(&scene.with_options(&wider), &wider)) == TimeOfContact::Separated;
    if proven {
        cache.found_room(trajectory, scene.solids, room);
        #[cfg(feature = "audit")]
        conclude_room(scene, room);
    } else {
        cache.found_no_room();
    }
    proven
}

/// A deviation of more than this part of the bodies' reach leaves no room that is worth a proof.
const MOST_DEVIATION: f64 = 1.0 / 16.0;
/// Room for the width of enclosures at single times: motions that are known so badly are for the search to judge.
const ROOM_FOR_WIDTH: f64 = 16.0;
/// Steps towards the time at which two triangles meet.
const STEPS: u32 = 8;

/// A time after the start of the window at which two triangles are certainly within the level of each other; `None` when
/// a few steps of Newton's method from `after` find none.
fn meet_again(scene: &MovingScene<'_>, triangles: [u32; 2], after: f64) -> Option<f64> {
    // The closest points are on the triangles up to the error, and so are the vertices that are shown to cross.
    let level = scene.pair.level - scene.pair.error;
    let target = scene.pair.level - 0.5 * (scene.tolerance + scene.pair.error);
    let last = scene.units.end_down();
    let (a, b) = (scene.a.corners(triangles[0]), scene.b.corners(triangles[1]));
    let mut time = (after / scene.units.time()).clamp(0.0, last);
    for _ in 0..STEPS {
        let motion = scene.relative_motion(time);
        let frame = motion.frame::<F64x4>(0.0);
        let placed = place_a::<F64x4>(&frame, &a);
        let near = closest::<F64x4>(&placed, &b);
        let distance = near.distance_squared.sqrt();
        if distance <= level || triangles_intersect(&placed, &b) {
            #[cfg(feature = "audit")]
            scene.conclude_meeting(time, triangles);
            return Some(time * scene.units.time());
        }
        let normal = near.direction.normalize_or_zero();
        // Also backwards: triangles that have passed each other were together at some time.
        let next = (time + (distance - target) / frame.closing_speed(near.points, normal)).clamp(0.0, last);
        if next.is_nan() || next == time {
            return None;
        }
        time = next;
    }
    None
}
