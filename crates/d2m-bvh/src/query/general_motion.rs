//! First contact of motions whose twists are not constant.
//!
//! Spans of time on which both twists are constant are searched as they are. On any other span two constant twists are
//! fitted, whose distance differs by at most a proven D from that of the bodies, and the same search is given a
//! distance that is larger by D: what it proves free is free. Where it finds a contact the span is shortened, with D
//! like the square of the span, until D is a small part of the tolerance. docs/theory/motions.md, section 3.

mod furthest;
mod joints;
mod plane;
mod span_length;
mod true_contact;

#[cfg(feature = "audit")]
use super::concluded::{Claimed, conclude_apart, sum_of_distances};
use super::constant_twist::{ask, scene_of_twists};
use super::true_poses::Meeting;
use crate::covered_pair::CoveredPair;
use crate::pair::scene::MovingTree;
use crate::{
    Answered, Budget, Contact, Evidence, Mode, Moving, QueryError, QueryOptions, SearchCounts, Solid,
    TimeOfContact, Window,
};
use d2m_feature::MovingSphere;
use d2m_interval::Interval;
use d2m_mesh::Meter;
#[cfg(feature = "audit")]
use d2m_mesh::audit::Place;
use d2m_mesh::margin::length;
use d2m_motion::{ConstantTwist, FittedTwists, Pose, RigidMotion, Twist};
use plane::PlaneSearch;
use span_length::{Drifting, LastFit, Shortfall};

/// A span is shortened at most to this part of itself before it is measured again: ten such steps go from any window to
/// below the resolution of time. It chooses spans and proves nothing.
const LEAST_PART: f64 = 1.0 / 1024.0;

/// The deviation is a small part of the tolerance when it is at most this part: the search is given a tolerance
/// that is smaller by twice the deviation, so for at least three quarters.
const SMALL_PART: f64 = 0.125;
/// The same of what an early stop leaves above the minimum separation. That is at most the boxes of two triangles and the deviation,
/// so at most 16/15 of the boxes.
const PART_OF_EARLY_ROOM: f64 = 0.0625;
/// Radii of a motion's enclosures at a single time, in units in the last place of the lengths that they are about, that count
/// as rounding: then the tolerance is raised, as for constant twists. Wider enclosures end as undecided.
const ROUNDINGS: f64 = 512.0 * f64::EPSILON;
/// Covers the roundings of a body's reach about its reference point (a difference, a length, two sums) and of a level.
const REACH_UP: f64 = 1.0 + 16.0 * f64::EPSILON;
/// Longer by so much are spans after one that was free.
const GROWTH: f64 = 4.0;
/// A span is expected to deviate by this part of what it may.
const EXPECTED: f64 = 0.9;
/// Node tests that a fit counts for in a budget.
const TESTS_A_FIT: u64 = 256;

/// The tolerance of a query.
pub(super) fn tolerance_of(bodies: &[Moving<'_>; 2], options: &QueryOptions) -> f64 {
    options.tolerance_of(bodies[0].body.radius().max(bodies[1].body.radius()))
}

/// The query; options were checked before.
pub(super) fn general_motion(
    pair: CoveredPair<'_>,
    options: &QueryOptions,
) -> Result<Answered<TimeOfContact>, QueryError> {
    Advance::new(pair, *options).run()
}

/// One query on its way through time.
struct Advance<'a> {
    bodies: [Moving<'a>; 2],
    window: Window,
    options: QueryOptions,
    tolerance: f64,
    meter: Meter,
    work: SearchCounts,
    /// Proven free until here.
    now: f64,
    /// The next span is at most so long and deviates by at most so much.
    longest: f64,
    largest: f64,
    drifting: Drifting,
    /// The last span that was fitted.
    last: Option<LastFit>,
    /// A plane between the bodies.
    plane: PlaneSearch,
    /// Poses and twists at the time that was queried last.
    poses: Option<(f64, [(Pose, Twist); 2])>,
}

/// Fitted twists from now until a time.
struct FittedSpan {
    fitted: FittedTwists,
    until: f64,
    resolution: Resolution,
}

/// Is a span short enough for its fitted twists?
#[derive(Clone, Copy, PartialEq, Eq)]
enum Resolution {
    /// They deviate by as little as they should.
    Enough,
    /// They deviate by more, but no number lies between the ends of the span.
    OfTime,
}

/// How a span ended.
#[expect(clippy::large_enum_variant, reason = "one at a time, taken apart at once")]
enum Step {
    /// Free from here on again.
    FreeUntil(f64),
    /// The answer of the whole query.
    Answer(TimeOfContact),
}

impl<'a> Advance<'a> {
    fn new(pair: CoveredPair<'a>, options: QueryOptions) -> Self {
        let (bodies, window) = (*pair.bodies(), pair.window());
        Self {
            bodies,
            window,
            options,
            tolerance: tolerance_of(&bodies, &options),
            meter: Meter::new(&options.budget).at_most(Budget::HARD_NODE_TESTS),
            work: SearchCounts::default(),
            now: window.start(),
            longest: window.length(),
            largest: f64::INFINITY,
            drifting: Drifting { spans: 0, since: window.start() },
            last: None,
            plane: PlaneSearch::START,
            poses: None,
        }
    }

    fn run(mut self) -> Result<Answered<TimeOfContact>, QueryError> {
        let answer = self.advance()?;
        Ok(Answered { answer, work: self.work })
    }

    fn advance(&mut self) -> Result<TimeOfContact, QueryError> {
        loop {
            // Also a budget of nothing answers what costs nothing.
            let begun = self.meter.spent() > 0;
            if self.meter.read_clock().is_err() || begun && self.meter.is_exhausted() {
                return Ok(TimeOfContact::Undecided { clear_until: self.now });
            }
            let pieces = self.bodies.map(|body| body.motion.constant_twist_from(self.now));
            let step = if let [Some(a), Some(b)] = pieces {
                let ends = [a.until, b.until].into_iter().flatten();
                let until = ends.fold(self.window.end(), f64::min);
                self.exact_span([&a.motion, &b.motion], until)?
            } else if let Some(until) = self.behind_the_plane() {
                Step::FreeUntil(until)
            } else {
                self.fitted_span()?
            };
            match step {
                Step::Answer(answer) => return Ok(answer),
                Step::FreeUntil(time) => {
                    let is_later = time > self.now;
                    self.now = time;
                    if is_later
                        && self.begins_a_piece()
                        && let Some(answer) = self.over_joint()?
                    {
                        return Ok(answer);
                    }
                    if time >= self.window.end() {
                        return Ok(TimeOfContact::Separated);
                    }
                }
            }
        }
    }

    /// What counts as contact in a span: bodies that are free of each other stay so until they touch, so that the inside of
    /// the one is tested for the other only at the start, and where pieces of a motion may miss each other by rounding.
    fn solids_of_span(&self) -> [Solid; 2] {
        let starts = self.now == self.window.start() || self.begins_a_piece();
        self.bodies.map(|body| if starts { body.solid_in(&self.options) } else { Solid::Surface })
    }

    fn options_of_span(&self) -> QueryOptions {
        QueryOptions { budget: self.meter.rest(), tolerance: Some(self.tolerance), ..self.options }
    }

    fn begins_a_piece(&self) -> bool {
        let before = self.now.next_down();
        self.bodies.iter().any(|body| body.motion.smooth_until(before) == Some(self.now))
    }

    /// A span on which both twists are constant, on the closed form.
    fn exact_span(&mut self, motions: [&ConstantTwist; 2], until: f64) -> Result<Step, QueryError> {
        if self.spheres_apart([motions[0], motions[1]], until) {
            #[cfg(feature = "audit")]
            self.conclude(Place::Spheres, until, self.tolerance, 0.0);
            return Ok(Step::FreeUntil(until));
        }
        let options = QueryOptions { tolerance: self.options.tolerance, ..self.options_of_span() };
        let answer = self.ask(motions, Window::try_new(self.now, until)?, &options)?;
        #[cfg(feature = "audit")]
        if let Some(until) = answer.free_until(until) {
            self.conclude(Place::ExactSpan, until, self.tolerance, 0.0);
        }
        Ok(match answer {
            TimeOfContact::Separated => Step::FreeUntil(until),
            TimeOfContact::Contact(contact) => Step::Answer(TimeOfContact::Contact(self.with_start(contact))),
            undecided @ TimeOfContact::Undecided { .. } => Step::Answer(undecided),
        })
    }

    /// Are the spheres about the reference points apart over the span, whatever the bodies' turns? They move straight.
    fn spheres_apart(&self, motions: [&dyn RigidMotion; 2], until: f64) -> bool {
        let spheres = [0, 1].map(|k| {
            let (body, state) = (self.bodies[k].body, motions[k].enclose_state(self.now));
            let reach = body.radius() + length(body.center() - state.at) + state.position_radius;
            MovingSphere { center: state.position, velocity: state.linear, radius: reach * REACH_UP }
        });
        let level = self.options.min_separation + self.tolerance;
        spheres[0].stays_apart(&spheres[1], level * REACH_UP, until - self.now)
    }

    fn ask(
        &mut self,
        [a, b]: [&ConstantTwist; 2],
        span: Window,
        options: &QueryOptions,
    ) -> Result<TimeOfContact, QueryError> {
        let [tree_a, tree_b] = self.bodies.map(|moving| moving.body);
        let twists = [MovingTree { tree: tree_a, twist: *a }, MovingTree { tree: tree_b, twist: *b }];
        let asked = ask(&scene_of_twists(twists, self.solids_of_span(), span, options)?, options);
        self.count(&asked.work);
        // Also a search of nothing costs something.
        self.count(&SearchCounts { node_tests: 1, ..SearchCounts::default() });
        Ok(asked.answer)
    }

    /// Free from now until a time, by so much more than the minimum separation; `beside`: what else entered the sum.
    #[cfg(feature = "audit")]
    fn conclude(&self, place: Place, to: f64, above: f64, beside: f64) {
        let distance = sum_of_distances(self.options.min_separation, above, beside);
        conclude_apart(place, &self.bodies, Claimed { from: self.now, to, distance });
    }

    fn count(&mut self, work: &SearchCounts) {
        self.meter.spend(work.work());
        self.work = self.work.with(work);
    }

    /// A span with fitted twists: free up to its end or up to where they come near.
    fn fitted_span(&mut self) -> Result<Step, QueryError> {
        let undecided = Step::Answer(TimeOfContact::Undecided { clear_until: self.now });
        let Some(span) = self.fit()? else { return Ok(undecided) };
        if span.resolution == Resolution::OfTime {
            return self.unresolved_span(&span);
        }
        let FittedSpan { fitted, until, .. } = span;
        let FittedTwists { twists, clock, deviation, floor, .. } = fitted;
        let tolerance = self.tolerance.max(rounding_tolerance(&fitted));
        let small = deviation <= SMALL_PART * tolerance;
        let inner = if small { tolerance - 2.0 * deviation } else { deviation.max(tolerance) };
        let mut options = self.options_of_span();
        options.tolerance = Some(inner);
        options.min_separation = (self.options.min_separation + deviation).next_up();
        if options.mode == Mode::Exists {
            options.mode = Mode::Accurate;
        }
        let window = Window::try_from(clock.span(self.now, until))?;
        let answer = self.ask([&twists[0], &twists[1]], window, &options)?;
        #[cfg(feature = "audit")]
        if let Some(by_clock) = answer.free_until(f64::INFINITY) {
            let until =
                if by_clock < f64::INFINITY { clock.time_down(by_clock, self.now).min(until) } else { until };
            self.conclude(Place::FittedTwists, until, inner, deviation);
        }
        let contact = match answer {
            TimeOfContact::Separated => {
                self.longest = GROWTH * (until - self.now);
                self.largest *= GROWTH;
                return Ok(Step::FreeUntil(until));
            }
            TimeOfContact::Undecided { clear_until } => {
                let clear_until = clock.time_down(clear_until, self.now).min(until);
                return Ok(Step::Answer(TimeOfContact::Undecided { clear_until }));
            }
            TimeOfContact::Contact(contact) => {
                let time_lo = clock.time_down(contact.time_lo, self.now).min(until);
                let time_hi = match contact.evidence {
                    Evidence::Early => time_lo,
                    _ => clock.time_up(contact.time_hi, until).max(time_lo),
                };
                Contact { time_lo, time_hi, ..contact }
            }
        };
        let room = contact.separation - self.options.min_separation;
        let early = options.mode == Mode::Capoeira && deviation <= PART_OF_EARLY_ROOM * room;
        if small {
            let tolerance = tolerance.max(contact.tolerance.max(inner) + 2.0 * deviation);
            let contact = Contact { tolerance, ..contact };
            return Ok(Step::Answer(TimeOfContact::Contact(self.true_contact(contact))));
        }
        if early {
            let found = self.of_same_triangles(contact.time_lo, &contact);
            let evidence = Evidence::Early;
            return Ok(Step::Answer(TimeOfContact::Contact(Contact { evidence, tolerance, ..found })));
        }
        if self.options.mode == Mode::Exists
            && let Some(time) = self.time_of_meeting(&contact)
        {
            return Ok(Step::Answer(TimeOfContact::Contact(self.met_at(time, &contact, tolerance))));
        }
        self.shorten(&contact, &Shortfall { deviation, floor, tolerance, until });
        if contact.time_lo <= self.now && self.longest <= 0.0 {
            return Ok(undecided);
        }
        self.seek_plane(&contact);
        Ok(Step::FreeUntil(contact.time_lo.max(self.now)))
    }

    /// Fits over a span that begins now and deviates by little enough; `None` when no span does.
    fn fit(&mut self) -> Result<Option<FittedSpan>, QueryError> {
        let Some(end) = self.end_of_piece() else { return Ok(None) };
        let poses = self.poses_at(self.now).map(|(pose, _)| pose);
        for (body, Pose { rotation, translation, .. }) in poses.iter().enumerate() {
            if !(rotation.is_finite() && translation.is_finite()) {
                return Err(QueryError::BadMotion { body });
            }
        }
        let largest = self.largest.min(self.usual_deviation(&poses));
        let longest = self.expected_span(largest);
        let mut until = (self.now + longest).min(end).max(self.now.next_up().min(end));
        loop {
            self.count(&SearchCounts { node_tests: TESTS_A_FIT, ..SearchCounts::default() });
            let fitted = FittedTwists::new(
                &self.bodies.map(Moving::ball),
                Interval::new(self.now, until),
                poses[1].translation,
            );
            let shortest = until <= self.now.next_up();
            if let Some(fitted) = fitted {
                let tolerance = self.tolerance.max(rounding_tolerance(&fitted));
                let enough = largest.max(SMALL_PART * tolerance).max(2.0 * fitted.floor);
                let length = until - self.now;
                self.last = Some(LastFit { length, bend: fitted.deviation - fitted.floor });
                if fitted.deviation <= enough {
                    let drifts = fitted.drift > 0.5 * fitted.deviation;
                    if drifts && self.drifting.is_hopeless(self.now, self.window.end()) {
                        return Ok(None);
                    }
                    return Ok(Some(FittedSpan { fitted, until, resolution: Resolution::Enough }));
                }
                if shortest {
                    // Enclosures that are this wide at single times are not for want of numbers.
                    let known = self.now < until && fitted.floor <= SMALL_PART * tolerance;
                    let span = FittedSpan { fitted, until, resolution: Resolution::OfTime };
                    return Ok(known.then_some(span));
                }
                // The deviation goes like the square of the span, or its root where a radius of a velocity rules.
                let part = (enough / fitted.deviation).sqrt().clamp(LEAST_PART, 0.5);
                until = (self.now + part * (until - self.now)).max(self.now.next_up()).min(end);
            } else {
                if shortest {
                    return Ok(None);
                }
                until = (self.now + 0.0625 * (until - self.now)).max(self.now.next_up()).min(end);
            }
        }
    }

    /// Poses and twists at a time; the last ones are kept, since a span begins where the one before came near.
    fn poses_at(&mut self, time: f64) -> [(Pose, Twist); 2] {
        match self.poses {
            Some((known, poses)) if known == time => poses,
            _ => {
                let poses = self.bodies.map(|body| body.motion.pose_and_twist(time));
                self.poses = Some((time, poses));
                poses
            }
        }
    }

    /// The end of the smooth pieces of both motions that hold the present; `None`: one that is not ahead, which is a fault of the
    /// motion, so that nothing is known.
    fn end_of_piece(&self) -> Option<f64> {
        let joints = self.bodies.map(|body| body.motion.smooth_until(self.now));
        let behind = |joint: f64| joint.is_nan() || joint <= self.now;
        if joints.into_iter().flatten().any(behind) && self.now < self.window.end() {
            return None;
        }
        Some(joints.into_iter().flatten().fold(self.window.end(), f64::min))
    }

    fn meeting(&self) -> Meeting<'_> {
        let Self { bodies, window, tolerance, options, .. } = self;
        Meeting { bodies, window: *window, separation: options.min_separation, tolerance: *tolerance }
    }
}

/// The tolerance that enclosures of a certain width at single times need; zero if they are wider than rounding explains.
pub(super) fn rounding_tolerance(fitted: &FittedTwists) -> f64 {
    if fitted.floor <= ROUNDINGS * fitted.size { 2.0 * fitted.floor / SMALL_PART } else { 0.0 }
}
