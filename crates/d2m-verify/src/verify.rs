//! Claims, as what the other modules prove.
use crate::instant::Instant;
use crate::prove::{Obstacle, Proof, surfaces_clear};
use crate::solid::{clear, overlap};
use crate::units::Unit;
use crate::{Body, Claim, Query, Reason, TimeSpan, Verdict};
use d2m_interval::Interval;
use d2m_motion::{Composed, ConstantTwist, RigidMotion};
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
    // Two links of one arm are seen from the last joint that they share, bodies of one motion, or in one frame, from that: no distance changes, but
    // directions do.
    let links = match query.bodies.map(|body| body.motion.chain()) {
        [Some(a), Some(b)] => [a, b].map(|link| link.without_first(a.common_joints(b))).to_vec(),
        _ => Vec::new(),
    };
    let mut bodies = query.bodies;
    bodies.iter_mut().zip(&links).for_each(|(body, link)| body.motion = link);
    if let [Some(a), Some(b)] = query.bodies.map(|body| body.motion.composition())
        && is_one_motion([a.outer, b.outer])
    {
        bodies.iter_mut().zip([a.inner, b.inner]).for_each(|(body, inner)| body.motion = inner);
    }
    if is_one_motion(query.bodies.map(|body| body.motion)) {
        bodies = bodies.map(|body| Body { motion: &ConstantTwist::REST, ..body });
    }
    match Unit::of(query).and_then(|unit| verify_in(unit, query, &bodies, claim, most_steps)) {
        Some(verdict) => verdict,
        None => verify_here(query, bodies, claim, most_steps),
    }
}

/// The same in another unit of length. `None`: a length is not known exactly in that.
fn verify_in(
    unit: Unit,
    query: &Query<'_>,
    bodies: &[Body<'_>; 2],
    claim: &Claim,
    most_steps: u64,
) -> Option<Verdict> {
    let meshes = unit.try_meshes(bodies)?;
    let (motions, as_queried) = (unit.motions(bodies), unit.motions(&query.bodies));
    let queried = unit.try_bodies(&query.bodies, &meshes, &as_queried)?;
    let query = Query { bodies: queried, window: query.window };
    let bodies = unit.try_bodies(bodies, &meshes, &motions)?;
    let verdict = verify_here(&query, bodies, &unit.try_claim(claim)?, most_steps);
    Some(unit.verdict(verdict))
}

fn verify_here(query: &Query<'_>, bodies: [Body<'_>; 2], claim: &Claim, most_steps: u64) -> Verdict {
    let mut case = Case { query, bodies, left: most_steps };
    match case.judge(claim) {
        Ok(()) => Verdict::Verified { steps: most_steps - case.left },
        // A distance of bodies is that of their meshes less their radii.
        Err(Obstacle::Met { time, triangles, distance }) => Verdict::Refuted {
            time,
            triangles: triangles.unwrap_or_default(),
            distance: (distance - case.radii()).max(Interval::ZERO),
        },
        Err(Obstacle::Open { clear_until, reason, pair }) => Verdict::Unproven { clear_until, reason, pair },
    }
}

/// Do these two move as one for certain? Then no distance changes, whatever the motion.
fn is_one_motion([a, b]: [&dyn RigidMotion; 2]) -> bool {
    // By address and type: a part of a motion may have the address of the whole.
    core::ptr::eq::<dyn RigidMotion>(a, b)
        || a.constant_twist().is_some_and(|a| b.constant_twist() == Some(a))
}

/// How much longer a meeting is taken to last at first than the one before did at last.
const AGAIN: f64 = 8.0;

/// Times of a span at which a meeting is looked for first, as parts of it: the end, the start, and between.
const TIMES: [f64; 5] = [1.0, 0.0, 0.5, 0.25, 0.75];

/// Parts of a way that bodies are parted by, one after the other: none of it, and then less and less.
const PARTS: [f64; 5] = [0.0, 1.0, 0.25, 0.0625, 0.015_625];

/// Where triangles do not stay together, points inside of both bodies may: this part of the steps goes to finding them, so that the others
/// suffice for what needs none. So it is with what one body holds when a span begins.
const PART_FOR_POINTS: u64 = 4;

struct Case<'q> {
    query: &'q Query<'q>,
    /// As the query's, but for directions of the world.
    bodies: [Body<'q>; 2],
    /// Steps.
    left: u64,
}

fn at(time: f64) -> TimeSpan {
    TimeSpan { from: time, to: time }
}

impl Case<'_> {
    fn judge(&mut self, claim: &Claim) -> Proof {
        match *claim {
            Claim::Clear { span, distance } => self.clear(span, distance),
            Claim::Within { span, distance, triangles } => self.within(span, distance, triangles),
            Claim::Often { span, distance, every } => self.often(span, distance, every),
            Claim::Apart { time, triangles, least, most } => self.apart(time, triangles, least, most),
            Claim::Held { time } => self.held(time),
            Claim::Overlapping { time, triangles } => self.overlapping(time, triangles),
            Claim::Parted { time, along, most } => self.parted(time, along * most),
            Claim::All(ref claims) => claims.iter().try_for_each(|claim| self.judge(claim)),
        }
    }

    fn open<T>(&self, reason: Reason, pair: Option<[u32; 2]>) -> Proof<T> {
        Err(Obstacle::Open { clear_until: self.query.window.from, reason, pair })
    }

    /// What a distance of bodies is between their meshes, if it and the span are such that something can be claimed of them: both motions
    /// are defined in all of the window, and the span is in it.
    fn level(&self, span: TimeSpan, distance: f64) -> Proof<Interval> {
        let TimeSpan { from, to } = self.query.window;
        let is_span = from <= span.from && span.from <= span.to && span.to <= to && (to - from).is_finite();
        let lengths = [distance, self.bodies[0].radius, self.bodies[1].radius];
        if !is_span || !lengths.iter().all(|x| (0.0..f64::INFINITY).contains(x)) {
            return self.open(Reason::Malformed, None);
        }
        let is_defined = |body: &Body<'_>| [from, to].iter().all(|&time| body.motion.domain().contains(time));
        if !self.query.bodies.iter().all(is_defined) {
            return self.open(Reason::OutsideMotion, None);
        }
        Ok(self.radii() + distance)
    }

    fn radii(&self) -> Interval {
        Interval::point(self.bodies[0].radius) + self.bodies[1].radius
    }

    /// Encloses the distance of two triangles.
    fn distance(&self, time: f64, pair: [u32; 2]) -> Proof<Interval> {
        let meshes = self.bodies.map(|body| body.mesh);
        if (0..2).any(|k| pair[k] as usize >= meshes[k].triangle_count()) {
            return self.open(Reason::Malformed, Some(pair));
        }
        let now = Instant::new(&self.bodies, time);
        let found = now.distance(&[0, 1].map(|k| meshes[k].corners(pair[k])));
        if found.hi() < f64::INFINITY { Ok(found) } else { self.open(Reason::Enclosure, None) }
    }

    fn clear(&mut self, span: TimeSpan, distance: f64) -> Proof {
        let level = self.level(span, distance)?.hi();
        clear(&self.bodies, span, level, &mut self.left)
    }

    /// Somewhere the bodies are proven close; or it is refuted, because they are apart all the time.
    fn within(&mut self, span: TimeSpan, distance: f64, pair: Option<[u32; 2]>) -> Proof {
        // Not below zero, as no distance is.
        let level = self.level(span, distance)?.lo().max(0.0);
        for (part, pair) in TIMES.into_iter().zip(pair.into_iter().cycle()) {
            let time = (span.from + part * (span.to - span.from)).clamp(span.from, span.to);
            if self.distance(time, pair)?.hi() <= level {
                return Ok(());
            }
        }
        // What one body holds at the start needs no time at which the surfaces are near.
        if span.from < span.to {
            let (before, mut some) = (self.left, self.left / PART_FOR_POINTS);
            let first = clear(&self.bodies, at(span.from), level, &mut some);
            self.left = before - (before / PART_FOR_POINTS - some);
            if matches!(first, Err(Obstacle::Met { .. })) {
                return Ok(());
            }
        }
        match clear(&self.bodies, span, level, &mut self.left) {
            Err(Obstacle::Met { .. }) => Ok(()),
            Err(Obstacle::Open { .. }) => self.open(Reason::NoMeeting, pair),
            Ok(()) => {
                let pair = pair.unwrap_or_default();
                let distance = self.distance(span.to, pair)?;
                Err(Obstacle::Met { time: span.to, triangles: Some(pair), distance })
            }
        }
    }

    fn apart(&self, time: f64, pair: [u32; 2], least: f64, most: f64) -> Proof {
        let _ = self.level(at(time), most.max(0.0))?;
        let distance = self.distance(time, pair)?;
        let [least, most] = [least, most].map(|distance| self.radii() + distance);
        if distance.strictly_precedes(least) || most.strictly_precedes(distance) {
            return Err(Obstacle::Met { time, triangles: Some(pair), distance });
        }
        let is_proven = least.precedes(distance) && distance.precedes(most);
        if is_proven { Ok(()) } else { self.open(Reason::Distance, Some(pair)) }
    }

    fn held(&mut self, time: f64) -> Proof {
        let _ = self.level(at(time), 0.0)?;
        match clear(&self.bodies, at(time), 0.0, &mut self.left) {
            Err(Obstacle::Met { triangles: None, .. }) => Ok(()),
            Ok(()) => self.open(Reason::Solid, None),
            other => other,
        }
    }

    /// Bodies with radii are nearer to each other than these; of others two triangles cross, or a point is inside of both.
    fn overlapping(&mut self, time: f64, pair: [u32; 2]) -> Proof {
        let _ = self.level(at(time), 0.0)?;
        if self.distance(time, pair)?.hi() < self.radii().lo() {
            return Ok(());
        }
        let now = Instant::new(&self.bodies, time);
        let overlaps = |pair: [u32; 2], left: &mut u64| overlap(&self.bodies, &now, pair, left);
        let is_proven = overlaps(pair, &mut self.left)
            || match clear(&self.bodies, at(time), 0.0, &mut self.left) {
                Err(Obstacle::Met { triangles: Some(others), .. }) => overlaps(others, &mut self.left),
                _ => false,
            };
        if is_proven { Ok(()) } else { self.open(Reason::NotOverlapping, Some(pair)) }
    }

    /// The bodies share no point, or none when B is moved so, or by a part of it: beyond that there may be something else of A.
    fn parted(&mut self, time: f64, by: DVec3) -> Proof {
        let level = self.level(at(time), 0.0)?.hi();
        let [a, b] = self.query.bodies;
        for part in PARTS.into_iter().filter(|_| by.is_finite()) {
            let moved = Composed::new(ConstantTwist::REST.with_position(by * part), b.motion);
            if clear(&[a, Body { motion: &moved, ..b }], at(time), level, &mut self.left).is_ok() {
                return Ok(());
            }
        }
        self.open(Reason::NotParted, None)
    }

    /// From one meeting to the next one, no later than `every`; each is taken along as far as it is proven to last.
    fn often(&mut self, span: TimeSpan, distance: f64, every: f64) -> Proof {
        let level = self.level(span, distance)?.lo().max(0.0);
        if !(0.0..f64::INFINITY).contains(&every) {
            return self.open(Reason::Malformed, None);
        }
        let (mut now, mut step) = (span.from, span.to - span.from);
        let mut for_points = self.left / PART_FOR_POINTS;
        while span.to - now > every {
            let end = (now + every).next_down().max(now);
            // As late as may be, so that something is gained.
            let mut late =
                [end, now + 0.5 * (end - now), now].into_iter().map(|from| TimeSpan { from, to: end });
            let met = late.find_map(|part| match clear(&self.bodies, part, level, &mut self.left) {
                Err(Obstacle::Met { time, triangles, .. }) => Some((time, triangles)),
                _ => None,
            });
            let Some((mut until, pair)) = met else {
                return self.open(if self.left == 0 { Reason::Steps } else { Reason::NoMeeting }, None);
            };
            step = step.max(every);
            while until < span.to && step > every && self.left > 0 {
                self.left -= 1;
                let part = TimeSpan { from: until, to: (until + step).min(span.to) };
                if self.lasts(pair, part, level, &mut for_points) {
                    (until, step) = (part.to, 2.0 * step);
                } else {
                    step *= 0.5;
                }
            }
            step *= AGAIN;
            if until <= now && end <= now {
                return self.open(Reason::TimeResolution, pair);
            }
            now = until.max(now);
        }
        Ok(())
    }

    /// Are the bodies within the level at every time of a span, at the begin of which these triangles meet, or one body holds the other?
    fn lasts(&mut self, pair: Option<[u32; 2]>, span: TimeSpan, level: f64, for_points: &mut u64) -> bool {
        let Some(pair) = pair else {
            // What is inside stays there until the surfaces meet.
            return surfaces_clear(&self.bodies, span, 0.0, &mut self.left).is_ok();
        };
        let over = Instant::over(&self.bodies, span);
        if over.most_distance(&[0, 1].map(|k| self.bodies[k].mesh.corners(pair[k]))) <= level {
            return true;
        }
        let before = *for_points;
        let is_found = before > 0 && overlap(&self.bodies, &over, pair, for_points);
        self.left = self.left.saturating_sub(before - *for_points);
        is_found
    }
}
