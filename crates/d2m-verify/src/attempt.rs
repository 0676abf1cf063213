//! One step: is a direction proven to separate two parts over a span?
use crate::Body;
use crate::directions::{across_boxes, between, faces_and_sides};
use crate::instant::{Direction, Instant, Part};
use crate::prove::Span;
use crate::span::{Level, Turning, lowest};
use d2m_interval::Interval;

/// Two parts over a span, and what was found of the directions that were tried.
pub(crate) struct Attempt<'s> {
    bodies: &'s [Body<'s>; 2],
    span: &'s Span,
    parts: [&'s Part; 2],
    /// What is to be proven: further apart than this.
    distance: f64,
    /// L²/2.
    half_square: Interval,
    /// About K L²/2 of a direction that is fixed in the base, and of another one.
    guess_bend: [f64; 2],
    /// |x − p| is at most this.
    far: Interval,
    /// The best direction if nothing bent.
    straight: Option<Candidate>,
}

/// A direction that seems to separate, by how much at the end where it is less.
#[derive(Clone, Copy)]
struct Candidate {
    direction: Direction,
    level: Level,
    gap: f64,
}

impl<'s> Attempt<'s> {
    pub(crate) fn new(
        bodies: &'s [Body<'s>; 2],
        span: &'s Span,
        parts: [&'s Part; 2],
        distance: f64,
    ) -> Self {
        let length = Interval::point(span.time.to) - Interval::point(span.time.from);
        let (reach, half_square) = (parts[1].reach(), length.sqr() * 0.5);
        let far = span.ends[0].map_or(Interval::ENTIRE, |now| {
            let apart = now.turn.mul_vec(parts[1].bounds()) + now.offset - parts[0].bounds();
            apart.norm() + span.bounds.speed(reach) * length
        });
        let guess_bend = span.bounds.curvatures(reach, far).map(|k| (half_square * k).hi());
        Self { bodies, span, parts, distance, half_square, guess_bend, far, straight: None }
    }

    /// How far a point of the other part may move in the span.
    pub(crate) fn moves(&self) -> f64 {
        (self.span.bounds.speed(self.parts[1].reach()) * (self.span.time.to - self.span.time.from)).hi()
    }

    pub(crate) fn separates_boxes(&mut self) -> bool {
        let Some(now) = &self.span.ends[0] else { return false };
        across_boxes(now, self.parts).any(|direction| self.separates(direction))
    }

    pub(crate) fn separates_triangles(&mut self) -> bool {
        faces_and_sides(self.parts).into_iter().any(|direction| self.separates(direction))
            || self
                .span
                .ends
                .iter()
                .flatten()
                .any(|now| between(now, self.parts).into_iter().any(|direction| self.separates(direction)))
    }

    /// By plain numbers first: most directions separate nothing.
    fn separates(&mut self, direction: Direction) -> bool {
        let [Some(start), Some(end)] = &self.span.ends else { return false };
        let n = direction.guess(start);
        let length = n.length();
        let [ahead, behind] = start.guess_gaps(n, self.parts).map(|gap| gap - self.distance * length);
        // What is no number separates nothing.
        if ahead.max(behind) <= 0.0 || ahead.is_nan() {
            return false;
        }
        let n_end = direction.guess(end);
        let length_end = n_end.length();
        let [ahead_end, behind_end] = end.guess_gaps(n_end, self.parts);
        let (direction, first, last) = if ahead >= behind {
            (direction, ahead, ahead_end)
        } else {
            (direction.reversed(), behind, behind_end)
        };
        let last = last - self.distance * length_end;
        let gap = first.min(last);
        if gap <= 0.0 || gap.is_nan() {
            return false;
        }
        let level = Level { distance: self.distance, about: 0.5 * (length + length_end) };
        let found = Candidate { direction, level, gap };
        let bend = self.guess_bend[usize::from(!matches!(direction, Direction::Base(_)))];
        let short = (bend - (first - last).abs()).max(0.0);
        if gap > short * short / (4.0 * bend) && self.proven(&found, self.bend_by_lengths(&found)) {
            return true;
        }
        if self.straight.is_none_or(|best| gap > best.gap) {
            self.straight = Some(found);
        }
        false
    }

    fn bend_by_lengths(&self, found: &Candidate) -> f64 {
        let k = self.span.bounds.curvature(found.direction, self.parts[1].reach(), self.far, &found.level);
        (self.half_square * k).hi()
    }

    /// The best direction again, with the second derivative bounded by its own terms.
    pub(crate) fn second_try(&self) -> bool {
        let Some(found) = self.straight else { return false };
        Turning::new(self.bodies, self.span.time).is_some_and(|turning| {
            let k = turning.curvature(found.direction, self.parts, &found.level);
            self.proven(&found, (self.half_square * k).hi())
        })
    }

    /// The proof: in intervals, from both ends and K L²/2.
    fn proven(&self, found: &Candidate, bend: f64) -> bool {
        let [Some(start), Some(end)] = &self.span.ends else { return false };
        let [first, last] = [start, end].map(|now| self.above(now, found.direction, &found.level));
        lowest(first, last, bend) > 0.0
    }

    /// Is a direction proven to separate two triangles at the first end, and at the last?
    pub(crate) fn clear_ends(&self) -> [bool; 2] {
        let separates = |now: &Instant, direction: Direction| {
            let n = direction.guess(now);
            let level = Level { distance: self.distance, about: n.length() };
            now.guess_gaps(n, self.parts).into_iter().any(|gap| gap > self.distance * n.length())
                && [direction, direction.reversed()].into_iter().any(|d| self.above(now, d, &level) > 0.0)
        };
        [0, 1].map(|k| {
            self.span.ends[k].as_ref().is_some_and(|now| {
                let mut directions = faces_and_sides(self.parts).into_iter().chain(between(now, self.parts));
                directions.any(|direction| separates(now, direction))
            })
        })
    }

    /// How much the gap along a direction is certainly above what it has to be at a time.
    fn above(&self, now: &Instant, direction: Direction, level: &Level) -> f64 {
        let n = direction.at(now);
        (now.gap(n, self.parts) - level.needed(direction, n[0])).lo()
    }
}
