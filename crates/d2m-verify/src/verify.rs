//! Claims, as what the other modules prove.
use crate::instant::Instant;
use crate::moved::Moved;
use crate::prove::clear;
use crate::solid::{is_held, overlap};
use crate::{Body, Claim, Query, Reason, TimeSpan, Verdict};
use d2m_interval::Interval;
use glam::DVec3;

/// Proves a claim, or refutes it, or says why it did neither, in at most so many steps (a microsecond each).
///
/// `Verified`: the claim is true, if the motions' enclosures are. `Refuted`: it is false. `Unproven` says nothing about it.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_verify::{Body, Claim, Mesh, Query, Solid, TimeSpan, Verdict, verify};
/// use glam::DVec3;
/// let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
/// let mesh = Mesh::try_new(&[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], &faces)?;
/// // Falls by 4 from a height of 2 onto the tip of the other one: they meet at 0.25.
/// let falling = ConstantTwist::REST.with_position(DVec3::Z * 2.0).with_linear_velocity(DVec3::Z * -4.0);
/// let body = |motion| Body { mesh: &mesh, motion, solid: Solid::Filled, radius: 0.0 };
/// let query = Query { bodies: [body(&falling), body(&ConstantTwist::REST)], window: TimeSpan { from: 0.0, to: 1.0 } };
/// let clear = |distance: f64, steps: u64| {
///     verify(&query, &Claim::Clear { span: TimeSpan { from: 0.0, to: 0.24 }, distance }, steps)
/// };
/// assert!(matches!(clear(0.0, 10_000), Verdict::Verified { .. }));
/// assert!(matches!(clear(0.5, 10_000), Verdict::Refuted { .. })); // they come nearer than that
/// assert!(matches!(clear(0.0, 0), Verdict::Unproven { .. })); // no step: nothing is said
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
pub fn verify(query: &Query<'_>, claim: &Claim, most_steps: u64) -> Verdict {
    let mut steps = most_steps;
    let verdict = match query.bodies.map(|body| body.motion.chain()) {
        [Some(a), Some(b)] if a.common_joints(b) > 0 && !claim.has_direction() => {
            // Two links of one arm, seen from the last joint that they share: no distance changes, but directions do.
            let (a, b) = (a.without_first(a.common_joints(b)), b.without_first(a.common_joints(b)));
            let [of_a, of_b] = query.bodies;
            let bodies = [Body { motion: &a, ..of_a }, Body { motion: &b, ..of_b }];
            Case { bodies, window: query.window }.judge(claim, &mut steps)
        }
        _ => Case { bodies: query.bodies, window: query.window }.judge(claim, &mut steps),
    };
    verdict.err().unwrap_or(Verdict::Verified { steps: most_steps - steps })
}

/// What is not verified.
type Proof<T = ()> = Result<T, Verdict>;

struct Case<'q> {
    bodies: [Body<'q>; 2],
    window: TimeSpan,
}

/// How much longer a meeting is taken to last at first than the one before did at last.
const AGAIN: f64 = 8.0;

/// Times of a span at which a meeting is looked for first, as parts of it: the end, the start, and between.
const TIMES: [f64; 5] = [1.0, 0.0, 0.5, 0.25, 0.75];

/// Parts of a way that bodies are parted by, one after the other: none of it, and then less and less.
const PARTS: [f64; 5] = [0.0, 1.0, 0.25, 0.0625, 0.015_625];

impl Case<'_> {
    fn not_proven<T>(&self, reason: Reason, pair: Option<[u32; 2]>) -> Proof<T> {
        Err(Verdict::Unproven { clear_until: self.window.from, reason, pair })
    }

    fn judge(&self, claim: &Claim, left: &mut u64) -> Proof {
        match *claim {
            Claim::Clear { span, distance } => self.clear(span, self.of_meshes(span, distance)?, left),
            Claim::Within { span, distance, triangles } => {
                self.within(span, self.of_meshes(span, distance)?, triangles, left)
            }
            Claim::Often { span, distance, every } => {
                self.often(span, self.of_meshes(span, distance)?, every, left)
            }
            Claim::Apart { time, triangles, least, most } => {
                let _ = self.of_meshes(TimeSpan { from: time, to: time }, most.max(0.0))?;
                let found = self.distance(time, triangles)?;
                let [least, most] = [least, most].map(|distance| self.radii() + Interval::point(distance));
                if found.hi() < least.lo() || found.lo() > most.hi() {
                    return Err(self.refuted(time, triangles, found));
                }
                let is_proven = least.hi() <= found.lo() && found.hi() <= most.lo();
                if is_proven { Ok(()) } else { self.not_proven(Reason::Distance, Some(triangles)) }
            }
            Claim::Held { time } => {
                let span = TimeSpan { from: time, to: time };
                let _ = self.of_meshes(span, 0.0)?;
                clear(&self.bodies, 0.0, span, left)?;
                let is_held = is_held(&self.bodies, &self.instant(time)?);
                if is_held == Some(true) { Ok(()) } else { self.not_proven(Reason::Solid, None) }
            }
            Claim::Overlapping { time, triangles } => self.overlapping(time, triangles, left),
            Claim::Parted { time, along, most } => self.parted(time, along * most, left),
            Claim::All(ref claims) => claims.iter().try_for_each(|claim| self.judge(claim, left)),
        }
    }

    /// What a distance of bodies is between their meshes, if it and the span are such that something can be claimed of them: both motions
    /// are defined in all of the window, and the span is in it.
    fn of_meshes(&self, span: TimeSpan, distance: f64) -> Proof<Interval> {
        let TimeSpan { from, to } = self.window;
        let is_span = from <= span.from && span.from <= span.to && span.to <= to && (to - from).is_finite();
        let lengths = [distance, self.bodies[0].radius, self.bodies[1].radius];
        if !is_span || !lengths.iter().all(|x| (0.0..f64::INFINITY).contains(x)) {
            return self.not_proven(Reason::Malformed, None);
        }
        let domains = self.bodies.map(|body| body.motion.domain());
        if !domains.iter().all(|domain| domain.contains(from) && domain.contains(to)) {
            return self.not_proven(Reason::OutsideMotion, None);
        }
        Ok(self.radii() + Interval::point(distance))
    }

    fn radii(&self) -> Interval {
        Interval::point(self.bodies[0].radius) + Interval::point(self.bodies[1].radius)
    }

    fn instant(&self, time: f64) -> Proof<Instant> {
        Instant::new(&self.bodies, time).map_or_else(|| self.not_proven(Reason::Enclosure, None), Ok)
    }

    /// The surfaces are further apart all the time; and at the start no body holds a part of the other, so none ever does.
    fn clear(&self, span: TimeSpan, level: Interval, left: &mut u64) -> Proof {
        clear(&self.bodies, level.hi(), span, left).map_err(|verdict| match verdict {
            Verdict::Refuted { time, triangles, distance } => self.refuted(time, triangles, distance),
            open => open,
        })?;
        match is_held(&self.bodies, &self.instant(span.from)?) {
            Some(false) => Ok(()),
            Some(true) => Err(self.refuted(span.from, [0, 0], Interval::ZERO)),
            None => self.not_proven(Reason::Solid, None),
        }
    }

    /// By a distance of meshes, which is that of the bodies less their radii.
    fn refuted(&self, time: f64, triangles: [u32; 2], distance: Interval) -> Verdict {
        Verdict::Refuted { time, triangles, distance: (distance - self.radii()).max(Interval::ZERO) }
    }

    /// Distance of two triangles.
    fn distance(&self, time: f64, triangles: [u32; 2]) -> Proof<Interval> {
        let meshes = self.bodies.map(|body| body.mesh);
        if (0..2).any(|k| triangles[k] as usize >= meshes[k].triangle_count()) {
            return self.not_proven(Reason::Malformed, Some(triangles));
        }
        Ok(self.instant(time)?.distance(&[0, 1].map(|k| meshes[k].corners(triangles[k]))))
    }

    /// Bodies with radii are nearer to each other than these; of others two triangles cross, or a point is inside of both.
    fn overlapping(&self, time: f64, triangles: [u32; 2], left: &mut u64) -> Proof {
        let span = TimeSpan { from: time, to: time };
        let _ = self.of_meshes(span, 0.0)?;
        let now = self.instant(time)?;
        let is_deep = self.distance(time, triangles)?.hi() < self.radii().lo();
        if is_deep || overlap(&self.bodies, &now, triangles, left) {
            return Ok(());
        }
        match self.meeting(span, 0.0, left) {
            Ok(Meeting { triangles: Some(others), .. }) if overlap(&self.bodies, &now, others, left) => {
                Ok(())
            }
            _ => self.not_proven(Reason::NotOverlapping, Some(triangles)),
        }
    }

    /// The bodies share no point, or none when B is moved so, or by a part of it: beyond that there may be something else of A.
    fn parted(&self, time: f64, by: DVec3, left: &mut u64) -> Proof {
        let span = TimeSpan { from: time, to: time };
        let level = self.of_meshes(span, 0.0)?;
        for part in PARTS {
            let moved = Moved { motion: self.bodies[1].motion, by: by * part };
            let bodies = [self.bodies[0], Body { motion: &moved, ..self.bodies[1] }];
            if (Case { bodies, window: self.window }).clear(span, level, left).is_ok() {
                return Ok(());
            }
        }
        self.not_proven(Reason::NotParted, None)
    }

    /// Somewhere the bodies are proven close; or it is refuted, because they are apart all the time.
    fn within(&self, span: TimeSpan, level: Interval, pair: Option<[u32; 2]>, left: &mut u64) -> Proof {
        // Not below zero, as no distance is.
        let level = level.lo().max(0.0);
        for part in TIMES {
            let time = (span.from + part * (span.to - span.from)).clamp(span.from, span.to);
            match pair {
                Some(pair) if self.distance(time, pair)?.hi() <= level => return Ok(()),
                _ => {}
            }
        }
        match self.meeting(span, level, left) {
            Ok(_) => Ok(()),
            Err(Verdict::Refuted { .. }) => {
                let triangles = pair.unwrap_or([0, 0]);
                Err(self.refuted(span.to, triangles, self.distance(span.to, triangles)?))
            }
            Err(_) => self.not_proven(Reason::NoMeeting, pair),
        }
    }

    /// What contradicts that the bodies are apart is a meeting. Refuted: they are apart all the time.
    fn meeting(&self, span: TimeSpan, level: f64, left: &mut u64) -> Proof<Meeting> {
        match clear(&self.bodies, level, span, left) {
            Err(Verdict::Refuted { time, triangles, .. }) => Ok(Meeting { time, triangles: Some(triangles) }),
            Err(open) => Err(open),
            Ok(()) => match is_held(&self.bodies, &self.instant(span.from)?) {
                Some(true) => Ok(Meeting { time: span.from, triangles: None }),
                Some(false) => Err(self.refuted(span.from, [0, 0], Interval::ENTIRE)),
                None => self.not_proven(Reason::Solid, None),
            },
        }
    }

    /// From one meeting to the next one, no later than `every`; each is taken along as far as it is proven to last.
    fn often(&self, span: TimeSpan, level: Interval, every: f64, left: &mut u64) -> Proof {
        let level = level.lo().max(0.0);
        if !(0.0..f64::INFINITY).contains(&every) {
            return self.not_proven(Reason::Malformed, None);
        }
        let (mut now, mut step) = (span.from, span.to - span.from);
        let mut for_points = *left / PART_FOR_POINTS;
        while span.to - now > every {
            let end = (now + every).next_down().max(now);
            // As late as may be, so that something is gained.
            let mut late = [end, now + 0.5 * (end - now), now].into_iter();
            let found = late.find_map(|from| self.meeting(TimeSpan { from, to: end }, level, left).ok());
            let Some(meeting) = found else {
                let reason = if *left == 0 { Reason::Steps } else { Reason::NoMeeting };
                return self.not_proven(reason, None);
            };
            let mut until = meeting.time;
            step = step.max(every);
            while until < span.to && step > every && *left > 0 {
                *left -= 1;
                let part = TimeSpan { from: until, to: (until + step).min(span.to) };
                let lasts = self.lasts(&meeting, part, level, left)
                    || self.overlaps_over(&meeting, part, &mut for_points, left);
                if lasts {
                    (until, step) = (part.to, 2.0 * step);
                } else {
                    step *= 0.5;
                }
            }
            step *= AGAIN;
            if until <= now && end <= now {
                return self.not_proven(Reason::TimeResolution, meeting.triangles);
            }
            now = until.max(now);
        }
        Ok(())
    }

    /// Are the bodies within the distance at every time of a span that begins with the meeting?
    fn lasts(&self, meeting: &Meeting, span: TimeSpan, level: f64, left: &mut u64) -> bool {
        let Some(triangles) = meeting.triangles else {
            // What is inside stays there until the surfaces meet.
            return clear(&self.bodies, 0.0, span, left).is_ok();
        };
        let corners = [0, 1].map(|k| self.bodies[k].mesh.corners(triangles[k]));
        Instant::over(&self.bodies, span).is_some_and(|over| over.most_distance(&corners) <= level)
    }

    /// Is a point found that is inside of both bodies over a span? That takes steps of both.
    fn overlaps_over(&self, meeting: &Meeting, span: TimeSpan, for_points: &mut u64, left: &mut u64) -> bool {
        let (Some(triangles), true) = (meeting.triangles, *for_points > 0) else { return false };
        let before = *for_points;
        let is_found = Instant::over(&self.bodies, span)
            .is_some_and(|over| overlap(&self.bodies, &over, triangles, for_points));
        *left = left.saturating_sub(before - *for_points);
        is_found
    }
}

/// Where triangles do not stay together, points inside of both bodies may: this part of the steps goes to finding them, so that the others
/// suffice for what needs none.
const PART_FOR_POINTS: u64 = 4;

/// A time at which the bodies are proven close, and triangles that are; none: one body holds the other.
struct Meeting {
    time: f64,
    triangles: Option<[u32; 2]>,
}
