//! Two sets of points in motion, and planes between them.

use super::paths::{BodyPaths, Path, Side};
use crate::pair::motion::frame::Frame;
use crate::pair::scene::MovingScene;
use d2m_mesh::Meter;
use d2m_mesh::Simplex;
use glam::DVec3;

/// Points of both bodies over a span, in the frame of B at its first end.
pub(super) struct Moving<'f> {
    bodies: [BodyPaths<'f>; 2],
    /// Of the points of A, and of those of B.
    pub(super) paths: [Vec<Path>; 2],
}

/// The closest points of both bodies along a direction at one end of the span: from A to B, and the gap.
#[derive(Clone, Copy)]
pub(super) struct Gap {
    pub(super) along: f64,
    line: DVec3,
}

/// Whether a plane parts two sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Separation {
    /// One does, with this normal.
    Proven { along: DVec3 },
    /// None was found; the normal that was tried last, zero if there is none.
    Unknown { last: DVec3 },
}

/// A search for a plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneSearch {
    /// The direction that is tried first.
    pub(super) first: DVec3,
    /// What the plane has to leave between the sets, at both ends of the span.
    pub(super) level: f64,
    /// How many directions are tried at most.
    pub(super) most: u64,
}

/// What a search for a plane gave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Attempt {
    pub(super) separation: Separation,
    /// Directions that were tried.
    pub(super) directions: u64,
}

impl<'f> Moving<'f> {
    /// None: the time is over.
    pub(super) fn new(
        scene: &MovingScene<'_>,
        points: [&Vec<DVec3>; 2],
        frame: &'f Frame,
        span: f64,
        clock: &mut Meter,
    ) -> Option<Self> {
        let bodies = [Side::A, Side::B].map(|side| BodyPaths::new(scene, frame, side, span));
        let mut paths = [0, 1].map(|body| Vec::with_capacity(points[body].len()));
        for body in 0..2 {
            for &point in points[body] {
                clock.step().ok()?;
                paths[body].push(bodies[body].of(point));
            }
        }
        Some(Self { bodies, paths })
    }

    /// From the mean of A's points to that of B's, both ends together.
    pub(super) fn between(&self) -> DVec3 {
        let mean = |paths: &[Path]| {
            paths.iter().map(|path| path.now + path.later).sum::<DVec3>() / paths.len() as f64
        };
        mean(&self.paths[1]) - mean(&self.paths[0])
    }

    /// Is there a direction along which the points of A are below those of B by more than the level at both ends? Begins
    /// with a given one and goes on to the nearest point of the hull of all differences of B's points and A's at both ends, each
    /// where its acceleration may take it: that is the direction of the widest gap.
    pub(super) fn separation(&self, search: &PlaneSearch, clock: &mut Meter) -> Attempt {
        let mut n = search.first;
        let mut simplex: Option<Simplex> = None;
        let mut directions = 0;
        while directions < search.most && clock.read_clock().is_ok() {
            directions += 1;
            let length = n.length();
            // Also when something is not a number.
            let enough = |gap: Gap| length > 0.0 && gap.along > search.level * length;
            let [now, later] = self.gaps(n);
            if enough(now) && enough(later) {
                return Attempt { separation: Separation::Proven { along: n }, directions };
            }
            let worse = if later.along < now.along { later } else { now };
            let next = simplex.map_or(Some(Simplex::new(worse.line)), |simplex| simplex.with(worse.line));
            let Some(next) = next else { break };
            simplex = Some(next);
            n = next.nearest().normalize_or_zero();
            if n == DVec3::ZERO {
                break;
            }
        }
        Attempt { separation: Separation::Unknown { last: n }, directions }
    }

    /// The gaps at both ends of the span.
    pub(super) fn gaps(&self, n: DVec3) -> [Gap; 2] {
        let [a, b] = [(0, n), (1, -n)].map(|(body, n)| self.furthest(body, n));
        [0, 1].map(|end| {
            let ((p, high), (q, low)) = (a[end], b[end]);
            Gap { along: -low - high, line: q - p }
        })
    }

    /// How far each point of a body reaches at both ends of the span: A's along `n`, B's against it.
    pub(super) fn reaches(&self, side: Side, n: DVec3) -> Vec<[f64; 2]> {
        let (body, n) = match side {
            Side::A => (0, n),
            Side::B => (1, -n),
        };
        let turn = self.bodies[body].turn(n);
        self.paths[body].iter().map(|path| path.along(n, turn)).collect()
    }

    /// The point of a body that reaches the furthest along `n`, and how far, at both ends. What is not a number wins.
    fn furthest(&self, body: usize, n: DVec3) -> [(DVec3, f64); 2] {
        let (of, paths) = (&self.bodies[body], &self.paths[body]);
        let turn = of.turn(n);
        let mut best = paths[0].along(n, turn);
        let mut index = [0; 2];
        for (k, path) in paths.iter().enumerate() {
            let along = path.along(n, turn);
            for end in 0..2 {
                if along[end] > best[end] || along[end].is_nan() {
                    (best[end], index[end]) = (along[end], k);
                }
            }
        }
        [(paths[index[0]].now, best[0]), (of.furthest_end(&paths[index[1]], n), best[1])]
    }
}
