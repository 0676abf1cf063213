//! Where time has no more numbers, and where pieces of a motion do not quite meet.

use super::{Advance, FittedSpan, SMALL_PART, Step, rounding_tolerance};
use crate::moving::triangles_of;
use crate::{Contact, Evidence, Mode, Moving, QueryError, StartState, TimeOfContact, Window};
use d2m_feature::TrianglesAt;
use d2m_interval::{Interval, IntervalVec3};
use d2m_lanes::UP;
#[cfg(feature = "audit")]
use d2m_mesh::audit::Place;
use d2m_mesh::margin::length;
use d2m_motion::FittedTwists;

/// Bodies that sweep boxes of at most this times their travel and radius are known well enough for a contact where time has no
/// more numbers. It decides what is answered there, and proves nothing.
const MOST_SWEPT: f64 = 64.0;
/// Jumps of both bodies together of at most this part of the tolerance are within what searches prove.
const PART_OF_JUMP: f64 = 0.125;
/// What holds at a single time.
struct Still {
    answer: TimeOfContact,
    /// That the answer is for.
    tolerance: f64,
}

impl Advance<'_> {
    /// A span without a number between its ends, in which bodies move by more than the tolerance: free if the fitted
    /// twists stay apart by more than they deviate, or the boxes that the bodies sweep are apart. Otherwise the bodies come near
    /// for all that times can say, and the tolerance is what is left at the start of the span.
    pub(super) fn unresolved_span(&mut self, span: &FittedSpan) -> Result<Step, QueryError> {
        let &FittedSpan { fitted: FittedTwists { twists, clock, deviation, .. }, until, .. } = span;
        let undecided = Step::Answer(TimeOfContact::Undecided { clear_until: self.now });
        // What is at the start itself.
        let Some(Still { answer, tolerance }) = self.still(0.0)? else { return Ok(undecided) };
        match answer {
            TimeOfContact::Separated => {}
            TimeOfContact::Undecided { .. } => return Ok(undecided),
            TimeOfContact::Contact(contact) => {
                let contact = Contact { time_lo: self.now, time_hi: self.now, tolerance, ..contact };
                return Ok(Step::Answer(TimeOfContact::Contact(self.true_contact(contact))));
            }
        }
        let mut options = self.options_of_span();
        if options.mode == Mode::Exists {
            options.mode = Mode::Accurate;
        }
        options.tolerance = Some(deviation.max(tolerance));
        options.min_separation = (deviation + self.options.min_separation).next_up();
        match self.ask([&twists[0], &twists[1]], Window::try_from(clock.span(self.now, until))?, &options)? {
            TimeOfContact::Separated => {
                #[cfg(feature = "audit")]
                self.conclude(Place::FittedTwists, until, deviation.max(tolerance), deviation);
                Ok(Step::FreeUntil(until))
            }
            TimeOfContact::Undecided { .. } => Ok(undecided),
            TimeOfContact::Contact(_) if self.sweep_apart(until) => {
                #[cfg(feature = "audit")]
                self.conclude(Place::SweptBoxes, until, self.tolerance, 0.0);
                Ok(Step::FreeUntil(until))
            }
            // Bodies that hardly move are known too badly, whatever the time.
            TimeOfContact::Contact(_) if !self.sweep_is_known(until) => Ok(undecided),
            TimeOfContact::Contact(contact) => {
                let triangles = [contact.triangle_a, contact.triangle_b];
                let placed = TrianglesAt::new(&triangles_of(&self.bodies, triangles), self.now);
                let left = placed.bound_distance(&placed.distance()) - self.options.min_separation;
                if !left.is_finite() {
                    return Ok(undecided);
                }
                let contact = Contact {
                    time_lo: self.now,
                    time_hi: until,
                    evidence: Evidence::Near,
                    start: StartState::Apart,
                    tolerance: tolerance.max(left * UP),
                    ..contact
                };
                Ok(Step::Answer(TimeOfContact::Contact(self.true_contact(contact))))
            }
        }
    }

    /// The bodies as they are now, with so much more of minimum separation; `None` where their enclosures know too little.
    fn still(&mut self, more: f64) -> Result<Option<Still>, QueryError> {
        let origin = self.poses_at(self.now)[1].0.translation;
        let Some(still) =
            FittedTwists::new(&self.bodies.map(Moving::ball), Interval::point(self.now), origin)
        else {
            return Ok(None);
        };
        let tolerance = self.tolerance.max(rounding_tolerance(&still));
        if still.deviation > SMALL_PART * tolerance {
            return Ok(None);
        }
        let mut options = self.options_of_span();
        if options.mode == Mode::Exists {
            options.mode = Mode::Accurate;
        }
        options.tolerance = Some(tolerance - 2.0 * still.deviation);
        options.min_separation = (still.deviation + more + self.options.min_separation).next_up();
        let now = Window::try_from(still.clock.span(self.now, self.now))?;
        let answer = self.ask([&still.twists[0], &still.twists[1]], now, &options)?;
        Ok(Some(Still { answer, tolerance }))
    }

    /// Pieces of a motion meet up to rounding, or up to what its own checks let pass: what lies between their poses now must be
    /// free, too. Searches prove at least a quarter of the tolerance above the minimum separation at the end of the piece before, so
    /// that smaller jumps of both bodies together lead through nothing; where they are larger, the bodies have to be further apart
    /// now than the jumps, or they are in contact with a tolerance that says what is left.
    ///
    /// `None`: nothing is in the way.
    pub(super) fn over_joint(&mut self) -> Result<Option<TimeOfContact>, QueryError> {
        let jump = self.bound_jump();
        if jump <= PART_OF_JUMP * self.tolerance {
            return Ok(None);
        }
        let undecided = TimeOfContact::Undecided { clear_until: self.now };
        // What is not finite is not known.
        let still = if jump.is_finite() { self.still(jump)? } else { None };
        let Some(Still { answer, tolerance }) = still else { return Ok(Some(undecided)) };
        let contact = match answer {
            TimeOfContact::Separated => {
                #[cfg(feature = "audit")]
                self.conclude(Place::Joint, self.now, jump, tolerance);
                return Ok(None);
            }
            TimeOfContact::Undecided { .. } => return Ok(Some(undecided)),
            TimeOfContact::Contact(contact) => contact,
        };
        let triangles = [contact.triangle_a, contact.triangle_b];
        let placed = TrianglesAt::new(&triangles_of(&self.bodies, triangles), self.now);
        let left = placed.bound_distance(&placed.distance()) - self.options.min_separation;
        // Before this time only the piece before counts, which is free.
        let contact = Contact {
            time_lo: self.now.next_down().max(self.window.start()),
            time_hi: self.now,
            evidence: Evidence::Near,
            start: StartState::Apart,
            tolerance: tolerance.max(left * UP).max(jump),
            ..contact
        };
        Ok(Some(TimeOfContact::Contact(self.true_contact(contact))))
    }

    /// How far points of both bodies may jump now, together: what is between the enclosures of either side.
    fn bound_jump(&self) -> f64 {
        let before = Interval::new(self.now.next_down(), self.now);
        let jumps = self.bodies.iter().filter(|body| body.motion.smooth_until(before.lo()) == Some(self.now));
        let bounds = jumps.map(|moving| {
            let earlier = moving.motion.enclose_kinematics(before);
            let later = moving.motion.enclose_kinematics(Interval::point(self.now)).following(earlier.at);
            let body = moving.body;
            let reach = (body.radius() + length(body.center() - earlier.at)) * UP;
            let tails = earlier.position_tail - later.position_tail;
            let moved = (earlier.position - later.position).bound_length() + length(tails) * UP;
            let turn = earlier.rotation + later.rotation * -1.0;
            // The Frobenius norm of a difference bounds how far it takes a point of length one; 32 ε for its own rounding.
            let turned = turn.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt() + 32.0 * f64::EPSILON;
            moved + reach * (turned + earlier.rotation_radius + later.rotation_radius)
        });
        bounds.sum::<f64>() * UP
    }

    /// Boxes that the bodies never leave from now until a time.
    fn sweep(&self, until: f64) -> [IntervalVec3; 2] {
        let span = Interval::new(self.now, until);
        self.bodies.map(|moving| moving.body.enclose_placed(&moving.motion.enclose_pose(span)))
    }

    /// Are these boxes further apart than the minimum separation and the tolerance, as all that a search calls free is, along one axis? What
    /// is not a number, or empty, proves nothing.
    fn sweep_apart(&self, until: f64) -> bool {
        let [a, b] = self.sweep(until);
        let level = (self.options.min_separation + self.tolerance).next_up();
        let beyond = |high: Interval, low: Interval| {
            let gap = Interval::point(high.lo()) - Interval::point(low.hi());
            !gap.is_empty() && gap.lo() > level
        };
        let apart =
            |a: Interval, b: Interval| !a.is_empty() && !b.is_empty() && (beyond(a, b) || beyond(b, a));
        apart(a.x, b.x) || apart(a.y, b.y) || apart(a.z, b.z)
    }

    /// Are these boxes explained by the bodies and about how far they travel?
    fn sweep_is_known(&mut self, until: f64) -> bool {
        let (first, last) = (self.poses_at(self.now), self.poses_at(until));
        let sweep = self.sweep(until);
        (0..2).all(|k| {
            let body = self.bodies[k].body;
            let turn = first[k].0.rotation.normalize().conjugate() * last[k].0.rotation.normalize();
            let moved = last[k].0.transform_point(body.center()) - first[k].0.transform_point(body.center());
            let travel = moved.length() + 2.0 * turn.xyz().length() * body.radius();
            let width = (sweep[k].hi() - sweep[k].lo()).max_element();
            width <= MOST_SWEPT * (travel + body.radius())
        })
    }
}
