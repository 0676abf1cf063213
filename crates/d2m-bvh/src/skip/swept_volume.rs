//! Until when are two bodies apart, whatever the angle that each has turned by?
//!
//! A body that spins stays in its swept volume: each point e (from the reference point, axis k) stays on a circle. Along a
//! unit direction n that circle reaches n·k k·e + |n × k| ρ at most, ρ the distance of e from the axis. The reference points
//! move on straight lines, so the time until which a direction keeps two swept volumes apart is a quotient, for all the
//! rest of the query at once. Parts that no direction keeps apart are expanded, down to triangles; the earliest time at
//! which the swept volumes of two triangles may come within the level is the answer.
//!
//! See docs/theory/engine.md, "Sweeps".

use super::swept_body::{Distances, SweptBody, SweptPart};
use super::{Skip, SkipLimits, later_offset};
use crate::pair::scene::MovingScene;
use d2m_mesh::Meter;
#[cfg(feature = "audit")]
use d2m_mesh::margin::DOWN;
use d2m_mesh::margin::{UNIT_F64, UP};
use d2m_mesh::node::Below;
use glam::DVec3;

/// Factor of the scene's size that covers all roundings here. Lengths below the size come out of fewer than a hundred
/// operations each: placing a point errs by 64·2⁻⁵³, an axis by 4·2⁻⁵³ of itself, turning a point into the frame of the axis, its
/// distance from the axis, a reach and the gap by less than 200·2⁻⁵³ more.
const SWEEP_ERROR: f64 = 4096.0 * UNIT_F64;
/// A body that turns by less than this, in radians, is taken as at rest with an additional speed.
const STILL_ANGLE: f64 = 0.5;

/// Two bodies over the rest of the query.
struct Sweep<'a> {
    bodies: [SweptBody<'a>; 2],
    /// Reference point of B from that of A at the start, and its velocity.
    apart: DVec3,
    velocity: DVec3,
    level: f64,
    length: f64,
    #[cfg(feature = "audit")]
    scene: &'a MovingScene<'a>,
    #[cfg(feature = "audit")]
    start: f64,
}

/// Until when the swept volumes of the bodies stay further apart than the level, from `start` on. `direction` may separate
/// bodies at rest.
pub(crate) fn swept_clear_until(
    scene: &MovingScene<'_>,
    start: f64,
    limits: &SkipLimits,
    direction: DVec3,
) -> Skip {
    let end = scene.end;
    let mut sweep = Sweep::new(scene, start, direction);
    let [a, b] = [0, 1].map(|k| sweep.bodies[k].triangle(limits.witnesses[k]));
    if sweep.clear_for(&a, &b).is_shorter(limits.least_gain) {
        return Skip { clear_until: None, work: 1 };
    }
    let mut clock = Meter::until(limits.stop);
    let Nearest { gain, pairs: tried } = sweep.nearest(limits, &mut clock);
    if gain == Gain::TooShort {
        return Skip { clear_until: None, work: tried };
    }
    if sweep.bodies.iter_mut().any(|body| body.measure(&mut clock).is_err()) {
        return Skip { clear_until: None, work: tried };
    }
    let Earliest { clear, pairs } = sweep.earliest(limits, &mut clock);
    let clear_until = clear.and_then(|clear| later_offset(start, clear, sweep.length, end));
    Skip { clear_until, work: pairs + tried }
}

/// The least of the times for which two triangles are apart, and how many pairs were tested for that.
struct Earliest {
    clear: Option<f64>,
    pairs: u64,
}

/// What the nearest pairs of parts say of the whole, and how many pairs were tested for that.
struct Nearest {
    gain: Gain,
    pairs: u64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Gain {
    /// Two triangles are apart for less than the time that is wanted.
    TooShort,
    Open,
}

/// What the directions say of two swept volumes.
struct Apart {
    /// For how long they stay further apart than the level, at most the length of the span; none when nothing keeps them
    /// apart even now.
    until: Option<f64>,
    /// The widest gap above the level; negative where they may be within it.
    room: f64,
}

impl Apart {
    fn is_shorter(&self, gain: f64) -> bool {
        self.until.is_none_or(|until| until < gain)
    }
}

impl<'a> Sweep<'a> {
    fn new(scene: &'a MovingScene<'a>, start: f64, direction: DVec3) -> Self {
        let end = scene.end;
        let spins = [&scene.a, &scene.b].map(|body| body.turns_by(end - start) > STILL_ANGLE);
        let direction = if spins[0] || spins[1] { scene.spin_axis().unwrap_or(direction) } else { direction };
        let bodies = [(&scene.a, spins[0]), (&scene.b, spins[1])].map(|(body, spins)| {
            if spins { SweptBody::spinning(body, start) } else { SweptBody::resting(body, start, direction) }
        });
        Self {
            bodies,
            apart: -scene.track.at(start),
            velocity: scene.b.motion.linear_velocity() - scene.a.motion.linear_velocity(),
            level: scene.pair.level + SWEEP_ERROR * (scene.size + scene.pair.level),
            length: (end - start).next_up(),
            #[cfg(feature = "audit")]
            scene,
            #[cfg(feature = "audit")]
            start,
        }
    }

    /// Searches for two triangles whose swept volumes do not stay apart before the bodies are measured, with bounds from their boxes, of a box's
    /// parts the one with the least room first: where swept volumes meet, as those of a screw and its nut do, some hundred pairs show it.
    /// Nothing is proven by that: it spares the measuring.
    fn nearest(&self, limits: &SkipLimits, clock: &mut Meter) -> Nearest {
        let (mut waiting, mut pairs) = (vec![(0.0, [0u32; 2])], 0);
        let most = limits.most_before.min(limits.budget);
        while pairs < most
            && clock.step().is_ok()
            && let Some((_, boxes)) = waiting.pop()
        {
            let parts = [0, 1].map(|k| self.bodies[k].part(boxes[k]));
            let open = match (parts[0].below, parts[1].below) {
                (Below::Triangle(_), Below::Triangle(_)) => return Nearest { gain: Gain::TooShort, pairs },
                (_, Below::Triangle(_)) => 0,
                (Below::Triangle(_), _) => 1,
                _ => usize::from(parts[0].radius <= parts[1].radius),
            };
            let known = waiting.len();
            for child in parts[open].children() {
                pairs += 1;
                let part = self.bodies[open].part(child);
                let pair = if open == 0 { [&part, &parts[1]] } else { [&parts[0], &part] };
                let apart = self.clear_for(pair[0], pair[1]);
                if apart.is_shorter(limits.least_gain) {
                    let mut below = boxes;
                    below[open] = child;
                    waiting.push((apart.room, below));
                }
            }
            waiting[known..].sort_by(|a, b| b.0.total_cmp(&a.0));
        }
        Nearest { gain: Gain::Open, pairs }
    }

    fn earliest(&self, limits: &SkipLimits, clock: &mut Meter) -> Earliest {
        let (mut clear, mut pairs) = (self.length, 0);
        let mut stack = vec![(0u32, 0u32)];
        while let Some((a, b)) = stack.pop() {
            pairs += 1;
            let (part_a, part_b) = (self.bodies[0].part(a), self.bodies[1].part(b));
            let until = self.clear_for(&part_a, &part_b).until;
            #[cfg(feature = "audit")]
            self.conclude([a, b], until.map(|until| until.min(clear)));
            if until.is_some_and(|until| until >= clear) {
                continue;
            }
            let open_a = match (part_a.below, part_b.below) {
                (Below::Triangle(_), Below::Triangle(_)) => {
                    let Some(until) = until.filter(|until| *until >= limits.least_gain) else {
                        return Earliest { clear: None, pairs };
                    };
                    clear = until;
                    continue;
                }
                (Below::Node(_), Below::Triangle(_)) => true,
                (Below::Triangle(_), Below::Node(_)) => false,
                (Below::Node(_), Below::Node(_)) => part_a.size() > part_b.size(),
            };
            if pairs >= limits.most_work.min(limits.budget) || clock.step().is_err() {
                return Earliest { clear: None, pairs };
            }
            if open_a {
                stack.extend(part_a.children().map(|child| (child, b)));
            } else {
                stack.extend(part_b.children().map(|child| (a, child)));
            }
        }
        Earliest { clear: Some(clear), pairs }
    }

    /// The parts are apart for so long, as far as it matters.
    #[cfg(feature = "audit")]
    fn conclude(&self, [a, b]: [u32; 2], clear: Option<f64>) {
        use crate::pair::concluded::OffsetSpan;
        use d2m_mesh::audit::{Part, Place};
        if let Some(to) = clear {
            let span = OffsetSpan { base: self.start, from: 0.0, to: to * DOWN };
            self.scene.conclude(Place::Sweep, span, [Part::Boxes(&[a]), Part::Boxes(&[b])]);
        }
    }

    /// How far the swept volumes of the parts are apart, and for how long.
    fn clear_for(&self, a: &SweptPart<'_>, b: &SweptPart<'_>) -> Apart {
        let (mut best, mut widest) = (None, f64::NEG_INFINITY);
        // `gap` at the start, which changes at `rate`, less the speed that parts of bodies at rest have along n or at all.
        let mut take = |gap: f64, rate: f64, speed: f64| {
            let room = gap - self.level;
            widest = if room > widest { room } else { widest };
            if room > 0.0 {
                let closing = speed * UP - rate;
                let until = if closing * UP * self.length <= room { self.length } else { room / closing };
                if best.is_none_or(|best| until > best) {
                    best = Some(until);
                }
            }
        };
        // |n·(ω × e)| = |(n × ω)·e|, and what e has along ω does not count.
        let speed_along = |part: &SweptPart<'_>, n: DVec3| n.cross(part.body.turning).length() * part.reach;
        let mut along = |n: DVec3| {
            let forward = n.dot(self.apart);
            let drift = n.dot(self.velocity);
            let speed = speed_along(a, n) + speed_along(b, n);
            take(forward - b.reach(-n) - a.reach(n), drift, speed);
            take(-forward - b.reach(n) - a.reach(-n), -drift, speed);
        };
        let unit = |v: DVec3| v.normalize_or_zero();
        for part in [a, b] {
            along(part.body.axis);
            if !part.body.spins {
                match &part.corners {
                    Some(c) => along(unit((c[1] - c[0]).cross(c[2] - c[0]))),
                    None => part.axes.iter().for_each(|&axis| along(unit(axis))),
                }
            }
        }
        let center = |part: &SweptPart<'_>| {
            if part.body.spins {
                part.body.axis * (0.5 * (part.annulus.low + part.annulus.high))
            } else {
                part.center
            }
        };
        let line = center(b) + self.apart - center(a);
        along(unit(line));
        for part in [a, b] {
            if part.body.spins {
                along(unit(line - part.body.axis * line.dot(part.body.axis)));
            }
        }
        // One inside the hole of the other: distances from the other's axis.
        for (inner, outer, from) in [(a, b, self.apart), (b, a, -self.apart)] {
            if outer.body.spins {
                let axis = outer.body.axis;
                let Distances { near, far } = inner.distances(from, axis);
                let drift = (self.velocity - axis * axis.dot(self.velocity)).length() * UP;
                let speed = inner.body.turning.length() * inner.reach;
                take(outer.annulus.near - far, -drift, speed);
                take(near - outer.annulus.far, -drift, speed);
            }
        }
        Apart { until: best, room: widest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pair::motion::local_motion::LocalMotion;
    use crate::{MeshTree, QueryOptions, TriMesh, Window};
    use d2m_feature::triangle_distance;
    use d2m_mesh::Stop;
    use d2m_motion::ConstantTwist;
    use d2m_testing::{Draw, KnuthRandom, Surface};
    use glam::DQuat;
    use std::f64::consts::PI;

    const LIMITS: SkipLimits = SkipLimits {
        least_gain: 0.0,
        most_work: 1 << 20,
        most_a_triangle: 0,
        most_before: 1 << 10,
        budget: u64::MAX,
        stop: Stop::NEVER,
        witnesses: [0, 0],
    };

    /// A closed box.
    fn cuboid(half: DVec3) -> MeshTree {
        MeshTree::new(Surface::cuboid(-half, half).into_mesh(TriMesh::try_new))
    }

    /// The time up to which the sweeps are apart, from 0 in the window [0, 1].
    fn clear(a: (&MeshTree, ConstantTwist), b: (&MeshTree, ConstantTwist), direction: DVec3) -> f64 {
        let options = QueryOptions::default().with_tolerance(1e-10);
        let scene = MovingScene::new(a, b, Window::UNIT, &options);
        swept_clear_until(&scene, 0.0, &LIMITS, direction).clear_until.unwrap_or(0.0)
    }

    fn at(x: DVec3, v: DVec3, w: DVec3) -> ConstantTwist {
        ConstantTwist::try_new(x, DQuat::IDENTITY, v, w).unwrap()
    }

    /// Each bound of the reach of a sweep, at a millionth on either side of a touch.
    #[test]
    fn sweeps_reach_exactly_as_far_as_the_bodies() {
        let (cube, thin) = (cuboid(DVec3::ONE), cuboid(DVec3::new(0.1, 3.0, 3.0)));
        let (fast, o) = (DVec3::Z * 300.0, DVec3::ZERO);
        let far = 2f64.sqrt() + 0.1;
        for (gap, apart) in [(1e-6, true), (-1e-6, false)] {
            // The corners of a spinning cube along a wall, the cube's top below a plate, and the other body spinning.
            let wall = |x: DVec3| (&thin, at(x, o, o));
            let cases = [
                clear((&cube, at(o, o, fast)), wall(DVec3::X * (far + gap)), DVec3::Y),
                clear(wall(DVec3::X * (far + gap)), (&cube, at(o, o, fast)), DVec3::Y),
                clear((&cube, at(o, o, DVec3::X * 40.0)), wall(DVec3::X * (1.1 + gap)), DVec3::Y),
            ];
            for (case, until) in cases.into_iter().enumerate() {
                assert_eq!(until == 1.0, apart, "case {case}, gap {gap}: {until}");
            }
        }
    }

    /// A post that spins in a square hole, and the frame of the hole that spins about a post.
    #[test]
    fn sweeps_inside_a_hole() {
        let (bar, post) = (cuboid(DVec3::new(1.0, 0.1, 1.0)), cuboid(DVec3::new(0.5, 0.5, 2.0)));
        let (spin, o) = (DVec3::Z * 50.0, DVec3::ZERO);
        for (gap, apart) in [(1e-6, true), (-1e-6, false)] {
            let out = 0.5f64.sqrt() + 0.1 + gap;
            // The bar's inner wall at the post's corner; B's axis is A's.
            let beside = ConstantTwist::try_new(o, DQuat::IDENTITY, o, spin)
                .unwrap()
                .try_with_at(DVec3::Y * -out)
                .unwrap();
            for other in [o, spin * 0.5] {
                let until = clear((&bar, beside), (&post, at(o, o, other)), DVec3::X);
                assert_eq!(until == 1.0, apart, "gap {gap}, the other turns by {other}: {until}");
            }
        }
    }

    /// Drift of a spinning body, and what a slow turn adds, end a sweep's time where they should.
    #[test]
    fn sweeps_end_in_time() {
        let (cube, thin) = (cuboid(DVec3::ONE), cuboid(DVec3::new(0.1, 3.0, 3.0)));
        let o = DVec3::ZERO;
        let wall = DVec3::X * (2f64.sqrt() + 0.1 + 0.25);
        let until =
            clear((&cube, at(o, DVec3::X * 0.5, DVec3::Z * 100.0)), (&thin, at(wall, o, o)), DVec3::Y);
        assert!(until < 0.5 && until > 0.5 - 1e-6, "{until}");
        // The wall turns by 0.1 about its middle: its end, 3 away, comes closer by 0.3.
        let far = wall + DVec3::X * 0.02;
        let until = clear((&cube, at(o, o, DVec3::Z * 100.0)), (&thin, at(far, o, DVec3::Z * 0.1)), DVec3::Y);
        assert!(until < 0.95 && until > 0.5, "{until}");
    }

    /// A thread and the one around it, whose swept volumes meet: few pairs of boxes show it, and no body is measured.
    #[test]
    fn sweeps_that_meet_are_found_before_bodies_are_measured() {
        let thread = |base: f64, crest: f64, lift: f64| {
            let point = |k: u32, rho: f64, z: f64| {
                let angle = f64::from(k) * PI / 18.0;
                DVec3::new(rho * angle.cos(), rho * angle.sin(), 0.2 * f64::from(k) / 36.0 + lift + z)
            };
            let flank = |k: u32, z: f64| {
                let corners = [k, k + 1].map(|k| [point(k, base, z), point(k, crest, 0.0)]);
                [corners[0][0], corners[0][1], corners[1][0], corners[1][0], corners[0][1], corners[1][1]]
            };
            let corners = (0..360).flat_map(|k| [flank(k, -0.08), flank(k, 0.08)].concat());
            MeshTree::new(Surface::soup(corners).into_mesh(TriMesh::try_new))
        };
        let (screw, nut) = (thread(0.8, 1.0, 0.0), thread(1.2, 0.9, 0.1));
        let turn = at(DVec3::ZERO, DVec3::Z * 0.2, DVec3::Z * 2.0 * PI);
        let options = QueryOptions::default();
        let scene = MovingScene::new((&screw, turn), (&nut, ConstantTwist::REST), Window::UNIT, &options);
        let sweep = Sweep::new(&scene, 0.0, DVec3::Y);
        let Nearest { gain, pairs } = sweep.nearest(&LIMITS, &mut Meter::until(Stop::NEVER));
        assert_eq!(gain, Gain::TooShort);
        assert!(pairs < 100, "{pairs}");
        // Far apart nothing is found, and nothing is claimed.
        let far = at(DVec3::Z * 9.0, DVec3::ZERO, DVec3::Z);
        let scene = MovingScene::new((&screw, far), (&nut, ConstantTwist::REST), Window::UNIT, &options);
        let sweep = Sweep::new(&scene, 0.0, DVec3::Y);
        assert_eq!(sweep.nearest(&LIMITS, &mut Meter::until(Stop::NEVER)).gain, Gain::Open);
    }

    #[test]
    fn nothing_meets_while_sweeps_are_apart() {
        let mut random = KnuthRandom(5);
        let (mut won, mut least) = (0, f64::INFINITY);
        for round in 0..600 {
            let mut vec = || random.vector();
            let (a, b) = (cuboid(vec().abs() * 0.5 + 0.05), cuboid(vec().abs() * 0.5 + 0.05));
            let spin = [0.2, 3.0, 30.0];
            let mut motion = |place: f64, spin: f64| {
                let q = DQuat::from_xyzw(vec().x, vec().x, vec().y, 1.2);
                ConstantTwist::try_new(vec() * place, q, vec() * 0.5, vec() * spin)
                    .unwrap()
                    .try_with_at(vec() * 0.3)
                    .unwrap()
            };
            let motions = [motion(2.5, spin[round % 3]), motion(0.0, spin[round / 3 % 3])];
            let until = clear((&a, motions[0]), (&b, motions[1]), DVec3::Y);
            won += u32::from(until > 0.0);
            let world = |tree: &MeshTree, motion: &ConstantTwist, t: f64| -> Vec<[DVec3; 3]> {
                let turn = LocalMotion::unscaled(motion).rotation(t);
                let x = motion.position() + motion.linear_velocity() * t;
                let place = |p: DVec3| turn[0] * p.x + turn[1] * p.y + turn[2] * p.z + x;
                (0..12).map(|k| tree.mesh().corners(k).map(|p| place(p - motion.at()))).collect()
            };
            for k in 0..12 {
                let t = until * f64::from(k) / 11.0;
                let (ta, tb) = (world(&a, &motions[0], t), world(&b, &motions[1], t));
                for (s, t) in ta.iter().flat_map(|s| tb.iter().map(move |t| (s, t))) {
                    let found = triangle_distance(s, t).lower;
                    if until > 0.0 {
                        least = least.min(found);
                    }
                }
            }
        }
        assert!(least > 1e-10 - 1e-13 && won > 150, "{least} {won}");
    }
}
