//! Claims, as what the other modules prove.
use crate::instant::Instant;
use crate::prove::{Steps, clear};
use crate::solid::{Held, held};
use crate::{Body, Claim, Query, Reason, TimeSpan, Verdict, meeting};
use d2m_interval::Interval;

/// Proves a claim, or refutes it, or says why it did neither, in at most so many steps (a microsecond each).
///
/// `Verified`: the claim is true, if the motions' enclosures are. `Refuted`: it is false. `Unproven` says nothing about it.
///
/// ```
/// use d2m_motion::ConstantTwist;
/// use d2m_verify::{Body, Claim, Mesh, Query, Solid, TimeSpan, Verdict, verify};
/// use glam::DVec3;
/// let tetrahedron = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let mesh = Mesh::try_new(&tetrahedron, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// // The base of a body that falls by 4 a unit of time meets the other body's tip after a quarter.
/// let falling = ConstantTwist::REST.with_position(DVec3::new(-0.1, -0.2, 2.0)).with_linear_velocity(-4.0 * DVec3::Z);
/// let body = |motion| Body { mesh: &mesh, motion, solid: Solid::Filled, radius: 0.0 };
/// let window = TimeSpan { from: 0.0, to: 1.0 };
/// let query = Query { bodies: [body(&falling), body(&ConstantTwist::REST)], window };
/// let clear = |to| Claim::Clear { span: TimeSpan { from: 0.0, to }, distance: 0.0 };
/// assert!(matches!(verify(&query, &clear(0.249), 1000), Verdict::Verified { .. }));
/// let Verdict::Refuted { time, .. } = verify(&query, &clear(1.0), 1000) else { panic!() };
/// assert!(time >= 0.25);
/// # Ok::<(), d2m_verify::MeshFault>(())
/// ```
pub fn verify(query: &Query<'_>, claim: &Claim, most_steps: u64) -> Verdict {
    let mut steps = Steps { taken: 0, most: most_steps };
    let verdict = match query.bodies.map(|body| body.motion.chain()) {
        [Some(a), Some(b)] if a.common_joints(b) > 0 => {
            // Two links of one arm, seen from the last joint that they share: no distance changes.
            let (a, b) = (a.without_first(a.common_joints(b)), b.without_first(a.common_joints(b)));
            let [of_a, of_b] = query.bodies;
            let bodies = [Body { motion: &a, ..of_a }, Body { motion: &b, ..of_b }];
            Case { bodies, window: query.window }.judge(claim, &mut steps)
        }
        _ => Case { bodies: query.bodies, window: query.window }.judge(claim, &mut steps),
    };
    verdict.err().unwrap_or(Verdict::Verified { steps: steps.taken })
}

/// What is not verified.
type Proof<T = ()> = Result<T, Verdict>;

struct Case<'q> {
    bodies: [Body<'q>; 2],
    window: TimeSpan,
}

/// Times of a span at which a meeting is looked for, as parts of it: the end, the start, and between.
const TIMES: [f64; 5] = [1.0, 0.0, 0.5, 0.25, 0.75];

impl Case<'_> {
    fn not_proven<T>(&self, reason: Reason, pair: Option<[u32; 2]>) -> Proof<T> {
        Err(Verdict::Unproven { clear_until: self.window.from, reason, pair })
    }

    fn judge(&self, claim: &Claim, steps: &mut Steps) -> Proof {
        match *claim {
            Claim::Clear { span, distance } => {
                self.accept(span, distance)?;
                self.clear(span, self.of_meshes(distance), steps)
            }
            Claim::Within { span, distance, triangles } => {
                self.accept(span, distance)?;
                self.within(span, self.of_meshes(distance), triangles, steps)
            }
            Claim::Apart { time, triangles, least, most } => {
                self.accept(TimeSpan { from: time, to: time }, most.max(0.0))?;
                let found = self.distance(time, triangles)?;
                let [least, most] = [least, most].map(|x| self.of_meshes(x));
                if found.hi() < least.lo() || found.lo() > most.hi() {
                    return Err(self.refuted(time, triangles, found));
                }
                let is_proven = least.hi() <= found.lo() && found.hi() <= most.lo();
                if is_proven { Ok(()) } else { self.not_proven(Reason::Distance, Some(triangles)) }
            }
            Claim::Held { time } => {
                self.accept(TimeSpan { from: time, to: time }, 0.0)?;
                clear(&self.bodies, 0.0, TimeSpan { from: time, to: time }, steps)?;
                let is_held = held(&self.bodies, &self.instant(time)?) == Held::One;
                if is_held { Ok(()) } else { self.not_proven(Reason::Solid, None) }
            }
            Claim::All(ref claims) => claims.iter().try_for_each(|claim| self.judge(claim, steps)),
        }
    }

    /// Is this a claim about a span of the window, in which both motions are defined, and a distance?
    fn accept(&self, span: TimeSpan, distance: f64) -> Proof {
        let TimeSpan { from, to } = self.window;
        let is_span = from <= span.from && span.from <= span.to && span.to <= to && (to - from).is_finite();
        let lengths = [distance, self.bodies[0].radius, self.bodies[1].radius];
        if !is_span || !lengths.iter().all(|x| (0.0..f64::INFINITY).contains(x)) {
            return self.not_proven(Reason::Malformed, None);
        }
        let domains = self.bodies.map(|body| body.motion.domain());
        let is_inside = domains.iter().all(|domain| domain.contains(from) && domain.contains(to));
        if is_inside { Ok(()) } else { self.not_proven(Reason::OutsideMotion, None) }
    }

    fn radii(&self) -> Interval {
        Interval::point(self.bodies[0].radius) + Interval::point(self.bodies[1].radius)
    }

    /// What a distance of bodies is between their meshes.
    fn of_meshes(&self, distance: f64) -> Interval {
        self.radii() + Interval::point(distance)
    }

    fn instant(&self, time: f64) -> Proof<Instant> {
        Instant::new(&self.bodies, time).map_or_else(|| self.not_proven(Reason::Enclosure, None), Ok)
    }

    /// The surfaces are further apart all the time; and at the start no body holds a part of the other, so none ever does.
    fn clear(&self, span: TimeSpan, level: Interval, steps: &mut Steps) -> Proof {
        clear(&self.bodies, level.hi(), span, steps).map_err(|verdict| match verdict {
            Verdict::Refuted { time, triangles, distance } => self.refuted(time, triangles, distance),
            open => open,
        })?;
        match held(&self.bodies, &self.instant(span.from)?) {
            Held::Neither => Ok(()),
            Held::One => Err(self.refuted(span.from, [0, 0], Interval::ZERO)),
            Held::Unknown => self.not_proven(Reason::Solid, None),
        }
    }

    /// By a distance of meshes, which is that of the bodies less their radii.
    fn refuted(&self, time: f64, triangles: [u32; 2], distance: Interval) -> Verdict {
        Verdict::Refuted { time, triangles, distance: (distance - self.radii()).max(Interval::ZERO) }
    }

    /// Distance of two triangles.
    fn distance(&self, time: f64, triangles: [u32; 2]) -> Proof<Interval> {
        if (0..2).any(|k| triangles[k] as usize >= self.bodies[k].mesh.triangle_count()) {
            return self.not_proven(Reason::Malformed, Some(triangles));
        }
        let [s, t] = meeting::triangles(&self.bodies, triangles);
        Ok(meeting::distance(&self.instant(time)?, [&s, &t]))
    }

    /// Somewhere the bodies are proven close; or it is refuted, because they are apart all the time.
    fn within(&self, span: TimeSpan, level: Interval, pair: Option<[u32; 2]>, steps: &mut Steps) -> Proof {
        let times = TIMES.map(|part| (span.from + part * (span.to - span.from)).clamp(span.from, span.to));
        for (time, pair) in times.into_iter().filter_map(|time| Some((time, pair?))) {
            if self.distance(time, pair)?.hi() <= level.lo() {
                return Ok(());
            }
        }
        for time in times {
            let now = self.instant(time)?;
            let apart = clear(&self.bodies, level.lo(), TimeSpan { from: time, to: time }, steps);
            if matches!(apart, Err(Verdict::Refuted { .. })) || held(&self.bodies, &now) == Held::One {
                return Ok(());
            }
        }
        match self.clear(span, level, steps) {
            Ok(()) => {
                let triangles = pair.unwrap_or([0, 0]);
                Err(Verdict::Refuted {
                    time: span.to,
                    triangles,
                    distance: self.distance(span.to, triangles)?,
                })
            }
            // A time at which they are close after all.
            Err(Verdict::Refuted { .. }) => Ok(()),
            Err(_) => self.not_proven(Reason::NoMeeting, pair),
        }
    }
}
